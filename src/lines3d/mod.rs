//! 3D lines from matched image segments (B99 3.2, figure 4).

use nalgebra::{Matrix3, Point3};
use serde::Serialize;

use crate::geometry::Segment3;
use crate::linematch::LineSupport;

/// A reconstructed 3D line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line3d {
    /// End points, metres, local frame. Every support's stretch runs the same way.
    pub segment: Segment3,
    /// Standard deviation of the line's position across itself, metres, the larger of both ends.
    pub sigma_m: f64,
    /// Covariance of the start and of the end point across the line, m^2 (3 x 3 each; zero along
    /// the line).
    pub covariance: [Matrix3<f64>; 2],
    /// The views that support it.
    pub supports: Vec<LineSupport>,
}

impl Line3d {
    /// A point of the line, `t` from 0 to 1.
    pub fn at(&self, t: f64) -> Point3<f64> {
        self.segment.at(t)
    }
}
