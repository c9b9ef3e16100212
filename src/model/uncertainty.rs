//! How well the geometry of a model is known.

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

/// Standard deviations of a facet, from the adjustment of its building to the image edges of all
/// views.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FacetUncertainty {
    /// Of its height in its middle, metres.
    pub height_m: f64,
    /// Of its slope along the steepest direction, degrees.
    pub slope_deg: f64,
    /// Of its corners, outer ring first.
    pub corners: Vec<CornerUncertainty>,
}

/// Standard deviations of a corner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CornerUncertainty {
    /// The corner, metres, local frame.
    pub at: Point3<f64>,
    /// Standard deviations of x, y and z, metres.
    pub sigma_m: Vector3<f64>,
}

impl FacetUncertainty {
    /// The standard deviations of the corner nearest to a place: closing a building may add corners
    /// to a ring, where a neighbour has one.
    pub fn at(&self, place: &Point3<f64>) -> Option<Vector3<f64>> {
        let distance = |corner: &&CornerUncertainty| (corner.at - place).norm_squared();
        let nearest = (self.corners.iter()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map(|corner| corner.sigma_m)
    }
}
