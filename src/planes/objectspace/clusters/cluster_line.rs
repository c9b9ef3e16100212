//! A 3D line found by clustering, and the plot of a cluster plane.

use serde::{Deserialize, Serialize};

use crate::base::geometry::Segment3;
use crate::base::ids::ViewId;

/// A 3D line of a main direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClusterLine {
    /// Its end points, metres; it runs along the main direction.
    pub segment: Segment3,
    /// The image lines that support it, as indices into the image lines of all views.
    pub supports: Vec<usize>,
    /// By how many bits it shortens the description.
    pub gain_bits: f64,
    /// Share of the extent that each supporting view covers.
    pub coverage: Vec<(ViewId, f64)>,
    /// Standard deviation across the line, metres.
    pub sigma_m: f64,
}

/// The plot of a cluster plane (figures 7 and 8).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ClusterTrace {
    /// Azimuth of the direction, radians.
    pub azimuth: f64,
    /// The image lines of this direction: view, and two points (across, height) of their line in
    /// the cluster plane, metres.
    pub lines: Vec<(ViewId, [[f64; 2]; 2])>,
    /// Intersections proposed and, after those too near each other, looked at.
    pub proposals: [usize; 2],
    /// The selected clusters: (across, height) and gain in bits.
    pub selected: Vec<([f64; 2], f64)>,
    /// The best of the others: they contradict better ones or gain nothing.
    pub refused: Vec<([f64; 2], f64)>,
}
