//! Plane candidates, and the outcome of each pair of parallel lines.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::ends::{Crossing, PlaneEnd};
use crate::geometry::Plane;

/// A polygon in a plane, with the evidence for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneCandidate {
    /// The plane.
    pub plane: Plane,
    /// Corners, metres, counter-clockwise seen from above.
    pub ring: Vec<Point3<f64>>,
    /// The two lines (one for a triangle), as indices into the clusters of the window.
    pub lines: Vec<usize>,
    /// Share of the outline that image lines cover, mean over the views.
    pub support: f64,
    /// Mean correlation of the views inside, weighted by texture.
    pub correlation: f64,
    /// By how much it exceeds the correlation on planes above and below it, median.
    pub rise: f64,
    /// The measure M, square metres.
    pub measure: f64,
}

/// Why a plane hypothesis gave no candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum PlaneRejection {
    /// Too steep, too narrow or too wide, or its lines stand beside each other.
    Shape,
    /// Not higher above the ground than a car.
    NearGround,
    /// Crossing lines make no two ends.
    NoEnds,
    /// The measure of its best polygon is not positive.
    Weak,
}

/// A pair of lines and its outcome (figure 11).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneTrace {
    /// The two lines.
    pub lines: [usize; 2],
    /// Why there is no candidate; `None` when there is.
    pub rejection: Option<PlaneRejection>,
    /// The image lines that cross the plane.
    pub crossings: Vec<Crossing>,
    /// Their clusters.
    pub ends: Vec<PlaneEnd>,
}
