//! Orientations in JSON: OpenSfM's reconstruction, ODM's shots, nerfstudio's transforms, and lists
//! of K, R, C.

pub(crate) mod krc;
pub(crate) mod nerfstudio;
pub(crate) mod opensfm;

use serde::de::DeserializeOwned;

use super::text::quoted_long;
use crate::base::error::{Error, Result};

fn parse<T: DeserializeOwned>(path: &str, text: &str) -> Result<T> {
    serde_json::from_str(text).map_err(|e| {
        let message = e.to_string();
        let problem = message.split(" at line ").next().unwrap_or_default();
        Error::Line {
            file: path.to_owned(),
            line: e.line().max(1),
            problem: quoted_long(problem),
            expected: "the JSON that the program writes".to_owned(),
        }
    })
}

fn refuse(path: &str, problem: &str) -> Error {
    Error::File {
        file: path.to_owned(),
        problem: quoted_long(problem),
        advice: "export perspective cameras; images of other lenses undistorted".to_owned(),
    }
}
