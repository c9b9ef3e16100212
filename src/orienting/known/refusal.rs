//! Refusals of files of what is known.

use crate::base::error::Error;

/// A refusal of a file as a whole.
pub(super) fn refusal(file: &str, problem: &str, advice: &str) -> Error {
    Error::File {
        file: file.to_owned(),
        problem: problem.to_owned(),
        advice: advice.to_owned(),
    }
}
