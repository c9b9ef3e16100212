//! A camera for the tests.

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use super::Camera;
use crate::base::geometry::rotation_from_axis_angle;

/// A slightly tilted camera with its principal point far outside the image.
pub(crate) fn crop_camera(x: f64, y: f64, kappa: f64) -> Camera {
    let k = Matrix3::new(
        15000.0,
        0.0,
        300.0 - x * 11.5,
        0.0,
        15000.0,
        300.0 + y * 11.5,
        0.0,
        0.0,
        1.0,
    );
    let down =
        Rotation3::from_matrix_unchecked(Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)));
    let [turn, tilt] = [[0.0, 0.0, kappa], [0.01, -0.02, 0.0]].map(Vector3::from);
    let r = rotation_from_axis_angle(&turn) * rotation_from_axis_angle(&tilt) * down;
    Camera::new(k, r, Point3::new(x, y, 1300.0), 600, 600)
}
