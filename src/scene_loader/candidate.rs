//! The orientations that a scene may be loaded with.

use serde::Serialize;

/// One of the orientations that a scene may be given.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct OrientationCandidate {
    /// Its format and files, in words.
    pub label: String,
    /// The path by which [`LoadOptions::orientation`](super::LoadOptions::orientation) chooses it.
    pub path: String,
}
