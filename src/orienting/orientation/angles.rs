//! The photogrammetric rotation angles omega, phi, kappa.

use nalgebra::{Matrix3, Rotation3};

use crate::base::math;

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

/// Between image axes x right, y up, z back and those of our cameras, y down and z forward.
pub(crate) const Y_UP: Matrix3<f64> = Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0);

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
    Rotation3::from_matrix_unchecked(Y_UP * world_from_image.transpose())
}

/// `cam_from_world` of yaw, pitch, roll as Metashape and Pix4D define them, radians: those of a
/// body (x ahead, y right, z down) in north, east, down, under which the camera looks down with the
/// top of its image ahead (Bäumker and Heimes 2001).
///
/// In axes east, north, up that is `Rz(-yaw) Rx(pitch) Ry(roll)` from the image to the world.
pub fn rotation_from_yaw_pitch_roll(yaw: f64, pitch: f64, roll: f64) -> Rotation3<f64> {
    let [rx, ry, rz] = axis_rotations([pitch, roll, -yaw]);
    Rotation3::from_matrix_unchecked(Y_UP * (rz * rx * ry).transpose())
}

/// Rotations about the axes x, y and z by these angles, radians.
pub(crate) fn axis_rotations(angles: [f64; 3]) -> [Matrix3<f64>; 3] {
    let [(sx, cx), (sy, cy), (sz, cz)] = angles.map(math::sin_cos);
    [
        Matrix3::new(1.0, 0.0, 0.0, 0.0, cx, -sx, 0.0, sx, cx),
        Matrix3::new(cy, 0.0, sy, 0.0, 1.0, 0.0, -sy, 0.0, cy),
        Matrix3::new(cz, -sz, 0.0, sz, cz, 0.0, 0.0, 0.0, 1.0),
    ]
}

/// The rotation next to a matrix whose elements were rounded (six digits are usual, four occur);
/// the matrix itself where it is a rotation as it stands, or none.
pub(crate) fn without_rounding(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    let deviation = (matrix * matrix.transpose() - Matrix3::identity()).amax();
    let is_rounded = deviation > EXACT_ROTATION && deviation <= ROUNDED_DEVIATION;
    if !is_rounded || matrix.determinant() < 0.0 {
        return *matrix;
    }
    // Newton's iteration for the orthonormal polar factor doubles the correct digits each time: of
    // three, as [`ROUNDED_DEVIATION`] allows, four make more than a number holds.
    const NEWTON_STEPS: usize = 4;
    let mut r = *matrix;
    for _ in 0..NEWTON_STEPS {
        let Some(inverse) = r.try_inverse() else {
            return *matrix;
        };
        r = (r + inverse.transpose()) * 0.5;
    }
    r
}

/// Deviation of R R^T from the identity that is none.
pub(crate) const EXACT_ROTATION: f64 = 1e-6;

/// Deviation that rounding to four digits can leave; quaternions may miss a length of one by as
/// much.
pub(super) const ROUNDED_DEVIATION: f64 = 1e-3;

/// Omega, phi, kappa in radians of a rotation `cam_from_world`; the inverse of
/// [`rotation_from_omega_phi_kappa`] for |phi| < pi/2.
pub fn omega_phi_kappa_from_rotation(cam_from_world: &Matrix3<f64>) -> [f64; 3] {
    let r = (Y_UP * cam_from_world).transpose();
    [
        math::atan2(-r[(1, 2)], r[(2, 2)]),
        math::asin(r[(0, 2)].clamp(-1.0, 1.0)),
        math::atan2(-r[(0, 1)], r[(0, 0)]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;
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
    fn yaw_pitch_roll_are_those_of_the_body_below_which_the_camera_hangs() {
        let (yaw, pitch, roll) = (0.7, -0.2, 0.1);
        let about = |x: f64, y: f64, z: f64| rotation_from_axis_angle(&Vector3::new(x, y, z));
        let ned_from_body = about(0.0, 0.0, yaw) * about(0.0, pitch, 0.0) * about(roll, 0.0, 0.0);
        let swap = Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0);
        let enu_from_image = swap * ned_from_body.matrix() * swap;
        let axes = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        let found = rotation_from_yaw_pitch_roll(yaw, pitch, roll);
        assert!((found.matrix() - axes * enu_from_image.transpose()).norm() < 1e-12);
        // Flying east and looking a little ahead.
        let found = rotation_from_yaw_pitch_roll(std::f64::consts::FRAC_PI_2, 0.1, 0.0);
        let view = found.inverse() * Vector3::z();
        assert!(
            view.x > 0.09 && view.z < -0.9 && view.y.abs() < 1e-12,
            "{view}"
        );
    }

    #[test]
    fn pix4d_states_the_same_rotation_as_angles_and_as_a_matrix() {
        // DSC_0157.JPG of a public project: external parameters and calibrated camera parameters.
        let [omega, phi, kappa] = [-2.946680f64, 3.053212, 119.804001].map(f64::to_radians);
        let stated = Matrix3::new(
            -0.496329015759,
            0.867944364245,
            -0.018168343104,
            0.866499001519,
            0.494001457064,
            -0.071708024550,
            -0.053263387814,
            -0.051333624406,
            -0.997260181960,
        );
        let found = rotation_from_omega_phi_kappa(omega, phi, kappa);
        assert!((found.matrix() - stated).amax() < 1e-7);
    }

    #[test]
    fn opendronemap_finds_the_angles_that_a_gimbal_stated() {
        // Three photographs of a public project: yaw, pitch, roll of the flight and omega, phi,
        // kappa of its adjustment, which differ by the errors of the gimbal.
        for ([yaw, pitch], adjusted) in [
            ([92.9f64, 30.0f64], [-0.04761483, -0.52504779, -1.63587693]),
            ([-175.8, 30.0], [-0.52483425, 0.03283844, 3.07150185]),
            ([-90.3, 30.0], [-0.01392513, 0.50726734, 1.57133367]),
        ] {
            let [omega, phi, kappa] = adjusted;
            let adjusted = rotation_from_omega_phi_kappa(omega, phi, kappa);
            let flown = rotation_from_yaw_pitch_roll(yaw.to_radians(), pitch.to_radians(), 0.0);
            let turn = flown.inverse() * adjusted;
            let apart = math::acos((turn.matrix().trace() - 1.0) / 2.0).to_degrees();
            assert!(apart < 2.0, "{apart}");
        }
    }

    #[test]
    fn rounded_rotations_are_made_orthonormal_and_wrong_ones_are_left() {
        let exact = rotation_from_axis_angle(&Vector3::new(3.0, 0.2, -0.4)).into_inner();
        assert_eq!(without_rounding(&exact), exact);
        for scale in [1e4, 1e5, 1e6] {
            let rounded = exact.map(|v| (v * scale).round() / scale);
            let found = without_rounding(&rounded);
            // What is exact enough stays as it is.
            let deviation = (found * found.transpose() - Matrix3::identity()).amax();
            assert!(deviation < 1e-12 || found == rounded && deviation <= EXACT_ROTATION);
            assert!((found - exact).amax() < 1.0 / scale, "{scale}");
        }
        for wrong in [
            exact * 1.01,
            -exact,
            exact.map(|v| (v * 100.0).round() / 100.0),
        ] {
            assert_eq!(without_rounding(&wrong), wrong);
        }
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
