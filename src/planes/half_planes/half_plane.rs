//! A half-plane: one side of a 3D line, and the plane there (B99 4.1).

use serde::{Deserialize, Serialize};

use crate::base::geometry::Plane;
use crate::base::ids::{LineId, ViewId};
use crate::lines::lines3d::Side;

/// Is the plane too steep for a roof (75 degrees, the interval of B99 figure 15)?
pub(crate) fn is_wall(plane: &Plane) -> bool {
    /// The normal's z.
    const STEEPEST: f64 = 0.26;
    plane.normal.z < STEEPEST
}

/// A half-plane attached to one side of a 3D line, with the shape of Sim(theta) there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct HalfPlane {
    /// The line.
    pub line: LineId,
    /// Which side of it.
    pub side: Side,
    /// Angle of the maximum, radians, see [`ThetaFrame`](crate::lines::lines3d::ThetaFrame).
    pub theta: f64,
    /// Standard deviation of theta, radians.
    pub sigma_theta: f64,
    /// `Sim(theta_max)`, 0 to 1.
    pub similarity: f64,
    /// `|Sim''(theta_max)|`, per radian squared (B99 figure 12).
    pub curvature: f64,
    /// `Sim(theta_max) - Sim(theta_min)`.
    pub amplitude: f64,
    /// Posterior probability that there is a plane at theta, 0 to 1.
    pub probability: f64,
    /// The valid views.
    pub views: Vec<ViewId>,
    /// The plane at theta, oriented upwards.
    pub plane: Plane,
}

impl HalfPlane {
    /// Was it found by the sweep? Otherwise its plane is propagated from a neighbour.
    pub(crate) fn is_swept(&self) -> bool {
        !self.views.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn walls_are_steeper_than_75_degrees() {
        let inclined = |degrees: f64| {
            let (s, c) = crate::base::math::sin_cos(degrees.to_radians());
            Plane {
                normal: Vector3::new(s, 0.0, c),
                d: 0.0,
            }
        };
        assert!(!is_wall(&inclined(74.0)));
        assert!(is_wall(&inclined(76.0)));
    }
}
