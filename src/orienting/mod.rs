//! From files to a scene: where each photograph was taken, and whether that can be true.
//!
//! ```text
//! orientation             nineteen formats into one form
//! structure_from_motion   photographs alone into their orientation
//! known                   terrain models, footprints, point clouds
//! scene                   oriented views in one local frame
//! orientation_check       do images and orientation agree; which usual mistake fits
//! scene_loader            from files to a scene, with all refusals
//! synthetic               drawn scenes for tests and examples
//! ```

pub mod known;
pub mod orientation;
pub mod orientation_check;
pub mod scene;
pub mod scene_loader;
pub mod structure_from_motion;
pub mod synthetic;
