//! A border line in plan, and where it comes from.

use nalgebra::{Point2, Vector2};
use serde::Serialize;

/// Where a border line comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum BorderKind {
    /// A reconstructed 3D line.
    Real,
    /// A line found in a plane.
    InPlane,
    /// Two planes meet there.
    Intersection,
    /// Hypothesised across the end of a line.
    Closing,
    /// The side of a rectangle (W96 3.6).
    Rectangle,
}

/// A border line in plan, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Border {
    /// Where it comes from.
    pub kind: BorderKind,
    /// One end.
    pub a: Point2<f64>,
    /// The other end.
    pub b: Point2<f64>,
}

impl Border {
    /// Length in plan, metres.
    pub fn length(&self) -> f64 {
        (self.b - self.a).norm()
    }

    /// Both ends.
    pub(super) fn ends(&self) -> [Point2<f64>; 2] {
        [self.a, self.b]
    }

    /// Unit direction from a to b.
    pub(super) fn direction(&self) -> Vector2<f64> {
        (self.b - self.a) / self.length().max(1e-12)
    }

    /// The position on the infinite line that is nearest to a plan position.
    pub(super) fn foot(&self, p: &Point2<f64>) -> Point2<f64> {
        let d = self.direction();
        self.a + d * (p - self.a).dot(&d)
    }
}
