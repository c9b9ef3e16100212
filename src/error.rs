//! Why an input was refused: which file, which line, what was expected, what to do.

/// A refusal. Every message names the file and says what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A line of a text file is not what the format wants.
    #[error("{file}, line {line}: {problem}; expected {expected}")]
    Line {
        /// File name.
        file: String,
        /// Line number, from 1.
        line: usize,
        /// What stands there.
        problem: String,
        /// What should stand there.
        expected: String,
    },
    /// A file as a whole cannot be used.
    #[error("{file}: {problem}; {advice}")]
    File {
        /// File name.
        file: String,
        /// What is wrong.
        problem: String,
        /// What to do.
        advice: String,
    },
    /// The files do not make a scene.
    #[error("{problem}; {advice}")]
    Scene {
        /// What is wrong.
        problem: String,
        /// What to do.
        advice: String,
    },
}

/// Result of reading.
pub type Result<T> = std::result::Result<T, Error>;
