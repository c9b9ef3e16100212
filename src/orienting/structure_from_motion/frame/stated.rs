//! What is stated of photographs, and where the block has them.

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use crate::base::geometry::{mean_point, principal_axes, rotation_from_axis_angle};
use crate::base::math;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::similarity::Similarity;

/// What is stated of a photograph in a frame east, north, up.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct StatedPose {
    pub position: Option<Point3<f64>>,
    /// Is the height of the position not stated?
    pub lacks_height: bool,
    /// Standard deviation of the position, metres; `None` where it is not stated.
    pub sigma_m: Option<f64>,
    /// When it was taken, seconds; they differ rightly within a month.
    pub taken_s: Option<f64>,
    /// `cam_from_world`.
    pub rotation: Option<Rotation3<f64>>,
    /// The angles that give the rotation, degrees, pitch -90 down.
    pub yaw_pitch_roll: Option<[f64; 3]>,
}

/// The same, of which no height counts.
pub(super) fn without_heights(stated: &[StatedPose]) -> Vec<StatedPose> {
    let lacking = stated.iter().map(|s| StatedPose {
        lacks_height: true,
        ..s.clone()
    });
    lacking.collect()
}

pub(in super::super) fn centers(block: &Block) -> Vec<Point3<f64>> {
    let poses = block.photos.iter().filter_map(|p| p.pose.as_ref());
    poses.map(|pose| pose.center).collect()
}

pub(super) fn points(block: &Block) -> Vec<Point3<f64>> {
    block.tracks.iter().filter_map(|t| t.point).collect()
}

/// How far points spread along their main axes.
pub(in super::super) struct Spread {
    /// Standard deviations, the largest first.
    pub lengths: [f64; 3],
    /// Direction of the largest one.
    pub axis: Vector3<f64>,
    /// Direction of the least one.
    pub normal: Vector3<f64>,
}

pub(in super::super) fn spread(points: &[Point3<f64>]) -> Spread {
    let middle = mean_point(points);
    let square = points.iter().fold(Matrix3::zeros(), |sum, p| {
        let d = p - middle;
        sum + d * d.transpose()
    });
    let (squares, [normal, _, axis]) = principal_axes(square / points.len() as f64);
    let [least, middle, largest] = squares.map(|square| square.max(0.0).sqrt());
    Spread {
        lengths: [largest, middle, least],
        axis,
        normal,
    }
}

/// Turns a placement about an axis through a point until a direction is as steep as it can be.
pub(super) fn level(
    placed: &mut Similarity,
    middle: &Point3<f64>,
    axis: &Vector3<f64>,
    up: &Vector3<f64>,
) {
    let across = |v: &Vector3<f64>| v - axis * axis.dot(v);
    let (from, to) = (across(up), across(&Vector3::z()));
    let angle = math::atan2(from.cross(&to).dot(axis), from.dot(&to));
    let rotation = rotation_from_axis_angle(&(axis * angle));
    placed.rotation = rotation * placed.rotation;
    placed.shift = rotation * (placed.shift - middle.coords) + middle.coords;
}
