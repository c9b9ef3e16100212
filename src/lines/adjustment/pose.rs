//! Changes of the pose of a camera.

use nalgebra::Vector3;

use crate::base::geometry::rotation_from_axis_angle;
use crate::photographs::camera::Camera;

/// A change of a camera's pose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PoseChange {
    /// Turn about the projection centre: axis times angle, radians, world frame.
    pub turn: Vector3<f64>,
    /// Move of the projection centre, metres.
    pub shift_m: Vector3<f64>,
}

impl PoseChange {
    /// The camera turned and moved.
    pub(super) fn apply(&self, camera: &Camera) -> Camera {
        Camera {
            r: camera.r * rotation_from_axis_angle(&self.turn).inverse().matrix(),
            center: camera.center + self.shift_m,
            ..camera.clone()
        }
    }
}
