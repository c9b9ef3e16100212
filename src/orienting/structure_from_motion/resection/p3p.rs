//! The pose from three points: Grunert 1841, in the form of Haralick et al. 1994 ("Review and
//! analysis of solutions of the three point perspective pose estimation problem"), the distances
//! refined by Newton's method.

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use crate::orienting::structure_from_motion::block::Pose;
use crate::orienting::structure_from_motion::linear::real_roots;

/// All poses that see three world points in three unit directions of the camera; four at most.
pub(super) fn poses_of_three(
    world: &[Point3<f64>; 3],
    directions: &[Vector3<f64>; 3],
) -> Vec<Pose> {
    let [p1, p2, p3] = world;
    let [j1, j2, j3] = directions;
    // Squared sides across from the points, cosines of the angles between the directions.
    let (a2, b2, c2) = (
        (p2 - p3).norm_squared(),
        (p1 - p3).norm_squared(),
        (p1 - p2).norm_squared(),
    );
    let (cos_a, cos_b, cos_c) = (j2.dot(j3), j1.dot(j3), j1.dot(j2));
    if a2.min(b2).min(c2) <= 0.0 {
        return Vec::new();
    }
    let (ab, cb) = (a2 / b2, c2 / b2);
    let (minus, plus) = (ab - cb, ab + cb);
    let coefficients = [
        (minus - 1.0) * (minus - 1.0) - 4.0 * cb * cos_a * cos_a,
        4.0 * (minus * (1.0 - minus) * cos_b - (1.0 - plus) * cos_a * cos_c
            + 2.0 * cb * cos_a * cos_a * cos_b),
        2.0 * (minus * minus - 1.0
            + 2.0 * minus * minus * cos_b * cos_b
            + 2.0 * (1.0 - cb) * cos_a * cos_a
            - 4.0 * plus * cos_a * cos_b * cos_c
            + 2.0 * (1.0 - ab) * cos_c * cos_c),
        4.0 * (-minus * (1.0 + minus) * cos_b + 2.0 * ab * cos_c * cos_c * cos_b
            - (1.0 - plus) * cos_a * cos_c),
        (1.0 + minus) * (1.0 + minus) - 4.0 * ab * cos_c * cos_c,
    ];
    let mut poses = Vec::new();
    for v in real_roots(&coefficients) {
        let denominator = 2.0 * (cos_c - v * cos_a);
        if v <= 0.0 || denominator.abs() < 1e-9 {
            continue;
        }
        let u = ((minus - 1.0) * v * v - 2.0 * minus * cos_b * v + 1.0 + minus) / denominator;
        let s1 = (b2 / (1.0 + v * v - 2.0 * v * cos_b)).sqrt();
        if !(u > 0.0 && s1.is_finite()) {
            continue;
        }
        let start = Vector3::new(s1, u * s1, v * s1);
        let Some(s) = refined(start, [a2, b2, c2], [cos_a, cos_b, cos_c]) else {
            continue;
        };
        poses.extend(pose_of(world, &[j1 * s[0], j2 * s[1], j3 * s[2]]));
    }
    poses
}

/// Newton's method for the three laws of cosines.
fn refined(start: Vector3<f64>, squares: [f64; 3], cosines: [f64; 3]) -> Option<Vector3<f64>> {
    let ([a2, b2, c2], [cos_a, cos_b, cos_c]) = (squares, cosines);
    let mut s = start;
    for _ in 0..3 {
        let residual = Vector3::new(
            s.y * s.y + s.z * s.z - 2.0 * s.y * s.z * cos_a - a2,
            s.x * s.x + s.z * s.z - 2.0 * s.x * s.z * cos_b - b2,
            s.x * s.x + s.y * s.y - 2.0 * s.x * s.y * cos_c - c2,
        );
        let jacobian = 2.0
            * Matrix3::new(
                0.0,
                s.y - s.z * cos_a,
                s.z - s.y * cos_a,
                s.x - s.z * cos_b,
                0.0,
                s.z - s.x * cos_b,
                s.x - s.y * cos_c,
                s.y - s.x * cos_c,
                0.0,
            );
        s -= jacobian.try_inverse()? * residual;
    }
    s.iter().all(|v| v.is_finite() && *v > 0.0).then_some(s)
}

/// The pose that brings three world points onto three points in the camera's axes.
fn pose_of(world: &[Point3<f64>; 3], camera: &[Vector3<f64>; 3]) -> Option<Pose> {
    let frame = |p: Vector3<f64>, q: Vector3<f64>| {
        let normal = p.cross(&q);
        let (x, z) = (p.try_normalize(1e-12)?, normal.try_normalize(1e-12)?);
        Some(Matrix3::from_columns(&[x, z.cross(&x), z]))
    };
    let of_world = frame(world[1] - world[0], world[2] - world[0])?;
    let of_camera = frame(camera[1] - camera[0], camera[2] - camera[0])?;
    let rotation = Rotation3::from_matrix_unchecked(of_camera * of_world.transpose());
    let center = world[0] - rotation.inverse() * camera[0];
    Some(Pose { rotation, center })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;
    use crate::orienting::structure_from_motion::random::Random;

    #[test]
    fn the_true_pose_is_among_the_solutions() {
        let mut random = Random::new(31);
        for _ in 0..100 {
            let mut any = || Vector3::from_fn(|_, _| random.signed());
            let pose = Pose {
                rotation: rotation_from_axis_angle(&(any() * 2.0)),
                center: Point3::from(any() * 3.0),
            };
            let seen: [Vector3<f64>; 3] = std::array::from_fn(|_| {
                any().component_mul(&Vector3::new(1.5, 1.5, 1.0)) + Vector3::z() * 4.0
            });
            let world = seen.map(|p| pose.center + pose.rotation.inverse() * p);
            let found = poses_of_three(&world, &seen.map(|p| p.normalize()));
            assert!(found.len() <= 4);
            let nearest = (found.iter())
                .map(|f| {
                    (f.center - pose.center).norm()
                        + (f.rotation.matrix() - pose.rotation.matrix()).norm()
                })
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-6, "{nearest}");
        }
    }

    #[test]
    fn points_on_a_line_give_no_pose() {
        let world = [0.0, 1.0, 2.0].map(|x| Point3::new(x, 0.0, 5.0));
        let directions = world.map(|p| p.coords.normalize());
        assert!(poses_of_three(&world, &directions).is_empty());
    }
}
