//! The sides of a 3D line, and the angle theta of the half-planes through it (B99 4.1).

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::base::geometry::{Plane, Segment3};

/// A side of a directed 3D line, seen from above.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// To the left of the direction from `p0` to `p1`.
    Left,
    /// To the right.
    Right,
}

/// The frame in which theta is measured about a 3D line: `direction`, `outward` (horizontal, away
/// from the line to the chosen side) and `up` (perpendicular to both, upwards). theta = 0 is the
/// half-plane through `outward` (horizontal for a horizontal line); it rises away from the line
/// for theta > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThetaFrame {
    /// Unit direction of the line.
    pub direction: Vector3<f64>,
    /// Horizontal unit vector across the line, to the side.
    pub outward: Vector3<f64>,
    /// Unit vector perpendicular to both, pointing up.
    pub up: Vector3<f64>,
}

impl ThetaFrame {
    /// The frame of one side of a line; `None` for a line that is vertical within about half a
    /// degree.
    pub fn new(line: &Segment3, side: Side) -> Option<Self> {
        let direction = line.direction();
        let left = Vector3::z().cross(&direction);
        // |z x d| is the sine of the angle to the vertical.
        if left.norm() < 0.01 {
            return None;
        }
        let outward = match side {
            Side::Left => left.normalize(),
            Side::Right => -left.normalize(),
        };
        let up = direction.cross(&outward);
        Some(Self {
            direction,
            outward,
            up: if up.z < 0.0 { -up } else { up },
        })
    }

    /// Unit vector in the half-plane at `theta` (radians), perpendicular to the line, away from it.
    pub fn away(&self, theta: f64) -> Vector3<f64> {
        let (s, c) = crate::base::math::sin_cos(theta);
        self.outward * c + self.up * s
    }

    /// The plane through the line at `theta` (radians), oriented upwards.
    pub fn plane(&self, line: &Segment3, theta: f64) -> Plane {
        let normal = self.direction.cross(&self.away(theta));
        Plane::from_point_normal(&line.p0, &normal)
            .expect("direction and away are perpendicular")
            .upwards()
    }

    /// The theta (radians, -pi/2 to pi/2) of a plane that contains the line approximately.
    pub fn theta_of(&self, plane: &Plane) -> f64 {
        let mut away = plane.normal.cross(&self.direction);
        if away.dot(&self.outward) < 0.0 {
            away = -away;
        }
        crate::base::math::atan2(away.dot(&self.up), away.dot(&self.outward))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn theta_of_inverts_plane() {
        let line = Segment3::new(Point3::new(1.0, 2.0, 3.0), Point3::new(5.0, 4.0, 3.5));
        for side in [Side::Left, Side::Right] {
            let frame = ThetaFrame::new(&line, side).unwrap();
            for theta in [-1.2, -0.3, 0.0, 0.5, 1.2] {
                let plane = frame.plane(&line, theta);
                assert!((frame.theta_of(&plane) - theta).abs() < 1e-9);
                assert!(plane.signed_distance(&line.p1).abs() < 1e-9);
                let beyond = line.p0 + frame.away(theta) * 2.0;
                assert!(plane.signed_distance(&beyond).abs() < 1e-9);
                let left = Vector3::z()
                    .cross(&frame.direction)
                    .dot(&(beyond - line.p0))
                    > 0.0;
                assert_eq!(left, side == Side::Left);
                assert!((frame.away(theta).z > 0.0) == (theta > 0.0) || theta == 0.0);
            }
        }
    }

    #[test]
    fn vertical_lines_have_no_frame() {
        let line = Segment3::new(Point3::new(1.0, 2.0, 3.0), Point3::new(1.0, 2.0, 9.0));
        assert!(ThetaFrame::new(&line, Side::Left).is_none());
    }
}
