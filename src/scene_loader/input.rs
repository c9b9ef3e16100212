//! Files and wishes as the caller hands them over.

use std::borrow::Cow;

use serde::Serialize;

use crate::readable;

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
pub(super) fn base_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// A name without its folder and extension: by this, images and orientations find each other.
pub(super) fn stem(path: &str) -> &str {
    let name = base_name(path);
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}

readable! {
/// What the user asks for beyond the files.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LoadOptions {
    /// Part of the path of the orientation to take, where there are several.
    pub orientation: Option<String>,
    /// Names of the images to use, with or without extension; all when absent.
    pub views: Option<Vec<String>>,
    /// Region of interest x0, y0, x1, y1, metres, world frame of the input.
    pub roi: Option<[f64; 4]>,
    /// Height of the ground, metres, world frame of the input.
    pub ground_z: Option<f64>,
    /// EPSG's number of the reference system of the world; what the files say when absent.
    pub epsg: Option<u32>,
    /// Memory that may be taken, megabytes; 1500 in the browser and 32768 elsewhere when absent.
    pub memory_mb: Option<u32>,
    /// Undo the mistake in the orientation that the images give away, instead of refusing the scene.
    pub apply_fix: bool,
    /// Correct shifts of a few pixels between the views.
    pub adjust: bool,
}
}
