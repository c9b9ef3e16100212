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
        let expected = "the JSON that the program writes";
        Error::line(path, e.line().max(1), quoted_long(problem), expected)
    })
}

fn refuse(path: &str, problem: &str) -> Error {
    Error::file(
        path,
        quoted_long(problem),
        "export perspective cameras; images of other lenses undistorted",
    )
}
