//! The pose of a photograph from known points: P3P, robustly, and its refinement.

mod p3p;

use nalgebra::{Matrix2x6, Point2, Point3, Vector2, Vector6};

use super::block::Pose;
use super::intrinsics::Intrinsics;
use super::random::Random;
use super::robust::{Estimate, Estimator, Likelihood, estimate};
use crate::base::geometry::rotation_from_axis_angle;
use crate::base::least_squares::{Equations, NormalEquations};
use p3p::poses_of_three;

/// Most samples of three points.
const MOST_SAMPLES: usize = 2000;

/// Points and where a photograph shows them.
pub(super) struct ResectionProblem<'a> {
    pub intrinsics: &'a Intrinsics,
    pub points: &'a [(Point3<f64>, Point2<f64>)],
    /// Standard deviation of the image points, pixels.
    pub sigma_px: f64,
}

/// The likeliest pose.
pub(super) fn resect(problem: &ResectionProblem, seed: u64) -> Option<Estimate<Pose>> {
    let size = f64::from(problem.intrinsics.size[0].max(problem.intrinsics.size[1]));
    let likelihood = Likelihood::new(2, size / problem.sigma_px);
    estimate(problem, &likelihood, &mut Random::new(seed), MOST_SAMPLES)
}

impl Estimator for ResectionProblem<'_> {
    type Model = Pose;

    fn len(&self) -> usize {
        self.points.len()
    }

    fn sample_size(&self) -> usize {
        3
    }

    fn hypotheses(&self, random: &mut Random) -> Vec<Pose> {
        let sample = random.sample::<3>(self.len()).map(|i| self.points[i]);
        let directions = sample.map(|(_, pixel)| self.intrinsics.ray(&pixel).push(1.0).normalize());
        poses_of_three(&sample.map(|(world, _)| world), &directions)
    }

    fn residual2(&self, pose: &Pose, i: usize) -> f64 {
        let (world, pixel) = &self.points[i];
        let p = pose.in_camera(world);
        if p.z <= 1e-9 {
            return f64::INFINITY;
        }
        let seen = self.intrinsics.project(&Vector2::new(p.x / p.z, p.y / p.z));
        (seen - pixel).norm_squared() / (self.sigma_px * self.sigma_px)
    }

    /// A step of Gauss and Newton.
    fn refined(&self, pose: &Pose, weights: &[f64]) -> Option<Pose> {
        let mut equations = NormalEquations::default();
        for ((world, pixel), &weight) in self.points.iter().zip(weights) {
            if weight < 1e-3 {
                continue;
            }
            let (residual, by_pose, _, _) = linearised(pose, self.intrinsics, world, pixel)?;
            equations.add_weighted(&residual, &by_pose, weight);
        }
        Some(moved(pose, &equations.step(0.0)?))
    }
}

/// The pose after a step: a turn of the camera's axes (radians), and a shift of its centre.
pub(super) fn moved(pose: &Pose, step: &Vector6<f64>) -> Pose {
    let turn = rotation_from_axis_angle(&step.fixed_rows::<3>(0).into_owned());
    Pose {
        rotation: turn * pose.rotation,
        center: pose.center + step.fixed_rows::<3>(3),
    }
}

/// What one observation says.
pub(super) type Linearised = (
    Vector2<f64>,
    Matrix2x6<f64>,
    nalgebra::Matrix2x5<f64>,
    nalgebra::Matrix2x3<f64>,
);

/// Residual (image of the point minus pixel) and its derivatives by the pose (as [`moved`] steps
/// it), by the parameters of the camera and by the point; `None` behind the camera.
pub(super) fn linearised(
    pose: &Pose,
    intrinsics: &Intrinsics,
    world: &Point3<f64>,
    pixel: &Point2<f64>,
) -> Option<Linearised> {
    let p = pose.in_camera(world);
    if p.z <= 1e-9 {
        return None;
    }
    let ray = Vector2::new(p.x / p.z, p.y / p.z);
    let (by_ray, by_parameters) = intrinsics.derivatives(&ray);
    let inverse = 1.0 / p.z;
    #[rustfmt::skip]
    let ray_by_camera = nalgebra::Matrix2x3::new(
        inverse, 0.0, -ray.x * inverse,
        0.0, inverse, -ray.y * inverse,
    );
    let by_camera = by_ray * ray_by_camera;
    let by_point = by_camera * pose.rotation.matrix();
    let by_turn = by_camera * -p.cross_matrix();
    let mut by_pose = Matrix2x6::zeros();
    by_pose.fixed_view_mut::<2, 3>(0, 0).copy_from(&by_turn);
    by_pose.fixed_view_mut::<2, 3>(0, 3).copy_from(&-by_point);
    let residual = intrinsics.project(&ray) - pixel;
    Some((residual, by_pose, by_parameters, by_point))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::base::least_squares::worst_derivative;

    type Setting = (Pose, Intrinsics, Vec<(Point3<f64>, Point2<f64>)>);

    fn setting() -> Setting {
        let pose = Pose {
            rotation: rotation_from_axis_angle(&Vector3::new(3.0, 0.1, -0.4)),
            center: Point3::new(4.0, -3.0, 60.0),
        };
        let intrinsics = Intrinsics {
            radial: [-0.1, 0.02],
            ..Intrinsics::new(800.0, [1000, 800])
        };
        let mut random = Random::new(17);
        let points = (0..120).map(|i| {
            let world = Point3::new(
                30.0 * random.signed(),
                25.0 * random.signed(),
                5.0 * random.signed(),
            );
            let p = pose.in_camera(&world);
            let mut pixel = intrinsics.project(&Vector2::new(p.x / p.z, p.y / p.z));
            pixel += Vector2::new(random.normal(), random.normal()) * 0.5;
            if i % 2 == 0 {
                pixel.x += 300.0 * random.signed();
            }
            (world, pixel)
        });
        let points = points.collect();
        (pose, intrinsics, points)
    }

    #[test]
    fn a_pose_is_found_though_half_of_the_points_are_wrong() {
        let (pose, intrinsics, points) = setting();
        let problem = ResectionProblem {
            intrinsics: &intrinsics,
            points: &points,
            sigma_px: 0.5,
        };
        let found = resect(&problem, 1).unwrap();
        let off = found.model.rotation.matrix() - pose.rotation.matrix();
        assert!(off.norm() < 3e-3, "{}", off.norm());
        assert!((found.model.center - pose.center).norm() < 0.15);
        assert!(found.inliers.len() >= 55, "{}", found.inliers.len());
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let (pose, intrinsics, points) = setting();
        let (world, pixel) = points[3];
        let (_, by_pose, by_parameters, by_point) =
            linearised(&pose, &intrinsics, &world, &pixel).unwrap();
        let residual = |pose: &Pose, camera: &Intrinsics, world: &Point3<f64>| {
            linearised(pose, camera, world, &pixel).unwrap().0
        };
        let off = worst_derivative(&by_pose, |step| {
            residual(&moved(&pose, step), &intrinsics, &world)
        });
        assert!(off < 1e-6, "{off}");
        let off = worst_derivative(&by_parameters, |step| {
            let parameters = std::array::from_fn(|i| intrinsics.parameters()[i] + step[i]);
            residual(&pose, &intrinsics.with_parameters(parameters), &world)
        });
        assert!(off < 1e-6, "{off}");
        let off = worst_derivative(&by_point, |step| {
            residual(&pose, &intrinsics, &(world + step))
        });
        assert!(off < 1e-6, "{off}");
    }
}
