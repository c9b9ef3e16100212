//! Photographs and the cameras that took them.
//!
//! ```text
//! raster   decoding, grey values, colours, light, noise, warping
//! camera   pinhole cameras, lens distortion, geometry of two and three views
//! ```

pub mod camera;
pub mod raster;
