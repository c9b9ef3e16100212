//! How lenses map directions to radii: pinholes, and the fisheyes of the usual programs.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Point2;

use crate::base::math;

/// What a lens does with the angle theta between a ray and its axis, before Brown's terms; the
/// radius is divided by the focal length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Projection {
    /// r = tan theta, a pinhole.
    #[default]
    Perspective,
    /// r = theta.
    Equidistant,
    /// r = 2 sin(theta / 2).
    Equisolid,
    /// r = atan(2 tan(theta) tan(w / 2)) / w, with the angle w (Devernay and Faugeras 2001).
    FieldOfView(f64),
    /// r = p0 + p1 t + p2 t^2 + p3 t^3 + p4 t^4 of t = 2 theta / pi.
    OfAngle([f64; 5]),
}

impl Projection {
    /// The image of a direction that a pinhole of focal length 1 sees at `ideal`.
    pub(super) fn project(&self, ideal: Point2<f64>) -> Point2<f64> {
        let r = match self {
            Self::Perspective => return ideal,
            _ => math::hypot(ideal.x, ideal.y),
        };
        // Nearer to the axis the tangent and its angle are one number.
        const LEAST_RADIUS: f64 = 1e-9;
        ideal * (self.radius(r.max(LEAST_RADIUS)) / r.max(LEAST_RADIUS))
    }

    /// The radius of a direction by its tangent.
    fn radius(&self, tangent: f64) -> f64 {
        let theta = math::atan(tangent);
        match self {
            Self::Perspective => tangent,
            Self::Equidistant => theta,
            Self::Equisolid => 2.0 * math::sin(theta / 2.0),
            Self::FieldOfView(w) => {
                let (s, c) = math::sin_cos(w / 2.0);
                math::atan(2.0 * tangent * s / c) / w
            }
            Self::OfAngle(p) => {
                let t = theta / FRAC_PI_2;
                p.iter().rev().fold(0.0, |sum, p| sum * t + p)
            }
        }
    }
}
