//! A patch: a small piece of a surface around one place of the plan.

use nalgebra::{Point2, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::base::geometry::Plane;

/// A plane around one place of the plan, and how well the views agree on it there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Patch {
    /// The place, metres.
    pub middle: Point2<f64>,
    /// Height there, metres.
    pub z: f64,
    /// Rise per metre along x and y.
    pub gradient: Vector2<f64>,
    /// Mean of the better half of the pairwise correlations of the views, -1 to 1.
    pub correlation: f32,
    /// Texture weight of the window, 0 to 1.
    pub weight: f32,
}

impl Patch {
    /// Its plane.
    pub fn plane(&self) -> Plane {
        plane_through(&self.middle, self.z, &self.gradient)
    }

    /// The height of its plane at a place, metres.
    pub fn z_at(&self, p: &Point2<f64>) -> f64 {
        self.z + self.gradient.dot(&(p - self.middle))
    }
}

/// The plane of a height and a gradient at a place.
pub(super) fn plane_through(middle: &Point2<f64>, z: f64, gradient: &Vector2<f64>) -> Plane {
    let normal = Vector3::new(-gradient.x, -gradient.y, 1.0).normalize();
    let at = Vector3::new(middle.x, middle.y, z);
    Plane {
        normal,
        d: -normal.dot(&at),
    }
}

/// Rise per metre of a plane along x and y.
pub(super) fn gradient_of(plane: &Plane) -> Vector2<f64> {
    -plane.normal.xy() / plane.normal.z
}
