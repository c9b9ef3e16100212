//! Pinhole cameras and the geometry of two and three of them.
//!
//! ```text
//! pinhole       K, R, C: projection, rays
//! projection    what lenses do with the angles of rays: pinholes and fisheyes
//! distortion    the lens: Brown's terms about a projection
//! undistort     photographs resampled to a pinhole
//! two_view      fundamental matrix, plane homographies (B99 3.1, 4.1), line transfer (3.2)
//! ```
//!
//! Invariant: the world is in metres, Z up, right-handed, reduced by the scene origin; in an image
//! x runs right and y down, and the centre of the top-left pixel is (0.5, 0.5). `x_cam = R (X -
//! C)` with z forward, and `P = K [R | -R C]`. K may have its principal point far outside the
//! image (a crop of a large frame).

mod distortion;
mod pinhole;
mod projection;
#[cfg(test)]
pub(crate) mod testing;
mod two_view;
mod undistort;

pub use distortion::Distortion;
pub use pinhole::Camera;
pub use projection::Projection;
pub use two_view::{
    Homography, fundamental, homography_of_plane, plane_of_image_line, transfer_line,
};
pub use undistort::undistort;

/// Fewest views of a place that are believed: what two show alike is true only if a third shows it
/// too (B99 2: multiple images, three or more).
pub(crate) const FEWEST_VIEWS: usize = 3;
