//! The photogrammetric rotation angles omega, phi, kappa.

use nalgebra::{Matrix3, Rotation3};

use crate::math;

/// Units of angles; of equally good ones the first is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleUnit {
    /// 360 to a turn.
    Degrees,
    /// 400 to a turn.
    Gon,
    /// Two pi to a turn.
    Radians,
}

impl AngleUnit {
    /// All units.
    pub const ALL: [Self; 3] = [Self::Degrees, Self::Gon, Self::Radians];

    /// One of it in radians.
    pub fn radians(self) -> f64 {
        match self {
            Self::Degrees => std::f64::consts::PI / 180.0,
            Self::Gon => std::f64::consts::PI / 200.0,
            Self::Radians => 1.0,
        }
    }

    /// Its usual name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Degrees => "degrees",
            Self::Gon => "gon",
            Self::Radians => "radians",
        }
    }
}

/// `cam_from_world` (x right, y down, z forward) of the photogrammetric angles, radians.
///
/// `R = Rx(omega) Ry(phi) Rz(kappa)` turns image axes (x right, y up, z towards the viewer) into
/// world axes; its transpose goes back, and the signs of y and z change to our camera axes.
pub fn rotation_from_omega_phi_kappa(omega: f64, phi: f64, kappa: f64) -> Rotation3<f64> {
    let (so, co) = math::sin_cos(omega);
    let (sp, cp) = math::sin_cos(phi);
    let (sk, ck) = math::sin_cos(kappa);
    let world_from_image = Matrix3::new(
        cp * ck,
        -cp * sk,
        sp,
        co * sk + so * sp * ck,
        co * ck - so * sp * sk,
        -so * cp,
        so * sk - co * sp * ck,
        so * ck + co * sp * sk,
        co * cp,
    );
    let axes = Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, -1.0, -1.0));
    Rotation3::from_matrix_unchecked(axes * world_from_image.transpose())
}

/// Omega, phi, kappa in radians of a rotation `cam_from_world`; the inverse of
/// [`rotation_from_omega_phi_kappa`] for |phi| < pi/2.
pub fn omega_phi_kappa_from_rotation(cam_from_world: &Matrix3<f64>) -> [f64; 3] {
    let axes = Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, -1.0, -1.0));
    let r = (axes * cam_from_world).transpose();
    [
        math::atan2(-r[(1, 2)], r[(2, 2)]),
        math::asin(r[(0, 2)].clamp(-1.0, 1.0)),
        math::atan2(-r[(0, 1)], r[(0, 0)]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rotation_from_axis_angle;
    use nalgebra::Vector3;

    #[test]
    fn it_is_the_product_of_three_axis_rotations() {
        let (omega, phi, kappa) = (0.3, -0.2, 2.1);
        let product = rotation_from_axis_angle(&Vector3::new(omega, 0.0, 0.0))
            * rotation_from_axis_angle(&Vector3::new(0.0, phi, 0.0))
            * rotation_from_axis_angle(&Vector3::new(0.0, 0.0, kappa));
        let found = rotation_from_omega_phi_kappa(omega, phi, kappa);
        let flip = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        assert!((found.matrix() - flip * product.matrix().transpose()).norm() < 1e-12);
        let back = omega_phi_kappa_from_rotation(found.matrix());
        assert!((Vector3::from(back) - Vector3::new(omega, phi, kappa)).norm() < 1e-12);
    }

    #[test]
    fn an_axis_stays_and_what_is_across_turns_by_the_length() {
        let (axis, across) = (
            Vector3::new(2.0, -1.0, 2.0) / 3.0,
            Vector3::new(1.0, 2.0, 0.0),
        );
        let r = rotation_from_axis_angle(&(axis * 0.7));
        assert!((r * axis - axis).norm() < 1e-15);
        let expected = across * math::cos(0.7) + axis.cross(&across) * math::sin(0.7);
        assert!((r * across - expected).norm() < 1e-15);
        assert_eq!(
            rotation_from_axis_angle(&Vector3::zeros()),
            Rotation3::identity()
        );
    }

    #[test]
    fn zero_angles_look_down_with_north_at_the_top() {
        let r = rotation_from_omega_phi_kappa(0.0, 0.0, 0.0);
        assert_eq!(r * Vector3::z(), -Vector3::z());
        assert_eq!(r * Vector3::y(), -Vector3::y(), "north is up the image");
        // Kappa turns the image axes counter-clockwise in the world: for +90 degrees x is north.
        let r = rotation_from_omega_phi_kappa(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        assert!((r * Vector3::y() - Vector3::x()).norm() < 1e-12);
    }
}
