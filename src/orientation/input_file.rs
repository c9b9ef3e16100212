//! Files as the caller hands them over.

use std::borrow::Cow;

/// A file in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputFile {
    /// Its path within the scene, folders separated by slashes.
    pub path: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

impl InputFile {
    /// A file; backslashes in the path become slashes.
    pub fn new(path: &str, bytes: Vec<u8>) -> Self {
        Self {
            path: path.replace('\\', "/"),
            bytes,
        }
    }

    /// Its name without the folder.
    pub fn name(&self) -> &str {
        base_name(&self.path)
    }

    /// Its folder without a final slash; empty at the top.
    pub fn folder(&self) -> &str {
        self.path.rsplit_once('/').map_or("", |(folder, _)| folder)
    }

    /// Its content as text; what is no UTF-8 is replaced.
    pub(crate) fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.bytes)
    }
}

/// A path without its folder.
pub(crate) fn base_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// A name without its folder and extension: by this, images and orientations find each other.
pub(crate) fn stem(path: &str) -> &str {
    let name = base_name(path);
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}
