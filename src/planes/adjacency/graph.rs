//! The feature adjacency graph of an image (B99 2: Bonn): corners, the edges that meet at them in
//! cyclic order, and the regions between.
//!
//! Deviation: the corners are those of segments, not nodes of a partition into regions: a region is
//! what lies between two edges of a corner, and goes on along an edge to the corner at its other
//! end. So places have covariances, and no image has to be partitioned.

use nalgebra::{Matrix2, Point2, Vector2};
use serde::Serialize;

/// Corners, edges and regions of one view.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ImageGraph {
    /// The corners.
    pub corners: Vec<ImageCorner>,
    /// The regions.
    pub regions: Vec<GraphRegion>,
}

/// Where two or more segments meet.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ImageCorner {
    /// The place, pixels.
    pub at: Point2<f64>,
    /// Covariance of the place, px^2, 2 x 2.
    pub covariance: [[f64; 2]; 2],
    /// Its edges, clockwise as seen on the screen, two at least.
    pub edges: Vec<CornerEdge>,
    /// What speaks for its edges meeting, against chance, nats.
    pub nats: f64,
}

/// An edge of a corner, and what follows it clockwise.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CornerEdge {
    /// The segment.
    pub segment: u32,
    /// The far end, pixels: the corner there, if there is one.
    pub far: Point2<f64>,
    /// Unit direction away from the corner.
    pub direction: Vector2<f64>,
    /// Standard deviation of the direction, radians.
    pub sigma: f64,
    /// The corner at the far end and the place of this edge among its edges.
    pub neighbour: Option<[u32; 2]>,
    /// The region between this edge and the next one.
    pub region: u32,
}

impl ImageCorner {
    /// The covariance as a matrix.
    pub(super) fn covariance(&self) -> Matrix2<f64> {
        Matrix2::from(self.covariance)
    }
}

/// What lies between edges.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct GraphRegion {
    /// Its corners, each with the place of the edge that it follows clockwise.
    pub sectors: Vec<[u32; 2]>,
    /// Mean colour beside the corners: lightness, red - blue, green - half of both; 0 to 1. `None`
    /// outside the image.
    pub color: Option<[f64; 3]>,
    /// The regions across its edges, ascending.
    pub neighbours: Vec<u32>,
}
