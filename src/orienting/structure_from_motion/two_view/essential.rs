//! The robust essential matrix of a pair, and the relative pose in it.

use nalgebra::{Matrix3, Rotation3, SMatrix, Vector1, Vector3};
use serde::{Deserialize, Serialize};

use super::five_point::essential_matrices;
use crate::base::geometry::rotation_from_axis_angle;
use crate::base::least_squares::{Equations, NormalEquations};
use crate::base::math;
use crate::orienting::structure_from_motion::random::Random;
use crate::orienting::structure_from_motion::robust::Estimator;

/// The second camera relative to the first: `x_second = R x_first + t`, |t| = 1.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in super::super) struct RelativePose {
    /// R.
    pub rotation: Rotation3<f64>,
    /// t.
    pub translation: Vector3<f64>,
}

impl RelativePose {
    fn essential(&self) -> Matrix3<f64> {
        self.translation.cross_matrix() * self.rotation.matrix()
    }

    /// Depths of the point nearest to two rays in both cameras.
    pub(in super::super) fn depths(&self, a: &Vector3<f64>, b: &Vector3<f64>) -> [f64; 2] {
        // lambda R a + t = mu b in the least squares sense.
        let p = self.rotation * a;
        let (pp, pb, bb) = (p.dot(&p), p.dot(b), b.dot(b));
        let (pt, bt) = (p.dot(&self.translation), b.dot(&self.translation));
        let determinant = pp * bb - pb * pb;
        [
            (pb * bt - bb * pt) / determinant,
            (pp * bt - pb * pt) / determinant,
        ]
    }

    /// Angle between two rays, radians.
    pub(in super::super) fn angle(&self, a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
        let p = self.rotation * a;
        math::atan2(p.cross(b).norm(), p.dot(b))
    }
}

/// Matches as rays, and their standard deviation.
pub(super) struct EssentialProblem<'a> {
    pub rays: &'a [(Vector3<f64>, Vector3<f64>)],
    pub sigma: f64,
}

impl EssentialProblem<'_> {
    /// Sampson's distance, and the length of the gradient in it.
    fn sampson(e: &Matrix3<f64>, (a, b): &(Vector3<f64>, Vector3<f64>)) -> (f64, f64) {
        let (ea, eb) = (e * a, e.tr_mul(b));
        let length = (ea.x * ea.x + ea.y * ea.y + eb.x * eb.x + eb.y * eb.y).sqrt();
        (b.dot(&ea) / length, length)
    }
}

impl Estimator for EssentialProblem<'_> {
    type Model = Matrix3<f64>;

    fn len(&self) -> usize {
        self.rays.len()
    }

    fn sample_size(&self) -> usize {
        5
    }

    fn hypotheses(&self, random: &mut Random) -> Vec<Matrix3<f64>> {
        essential_matrices(&random.sample::<5>(self.len()).map(|i| self.rays[i]))
    }

    fn residual2(&self, e: &Matrix3<f64>, i: usize) -> f64 {
        let r = Self::sampson(e, &self.rays[i]).0 / self.sigma;
        r * r
    }

    /// A step of Gauss and Newton of the five parameters of the pose, the gradient's length held.
    fn refined(&self, e: &Matrix3<f64>, weights: &[f64]) -> Option<Matrix3<f64>> {
        let [pose, ..] = decompositions(e);
        let r = pose.rotation.matrix();
        let t = pose.translation;
        let [b1, b2] = across(&t);
        let axis = |i: usize| Vector3::ith(i, 1.0).cross_matrix();
        let derivatives: [Matrix3<f64>; 5] = [
            t.cross_matrix() * r * axis(0),
            t.cross_matrix() * r * axis(1),
            t.cross_matrix() * r * axis(2),
            b1.cross_matrix() * r,
            b2.cross_matrix() * r,
        ];
        let e = pose.essential();
        let mut equations = NormalEquations::default();
        for (rays, &weight) in self.rays.iter().zip(weights) {
            if weight < 1e-3 {
                continue;
            }
            let (residual, length) = Self::sampson(&e, rays);
            let row = SMatrix::<f64, 1, 5>::from_fn(|_, i| {
                rays.1.dot(&(derivatives[i] * rays.0)) / length
            });
            equations.add_weighted(&Vector1::new(residual), &row, weight);
        }
        let step = equations.step(0.0)?;
        let turn = rotation_from_axis_angle(&Vector3::new(step[0], step[1], step[2]));
        let moved = RelativePose {
            rotation: pose.rotation * turn,
            translation: (t + b1 * step[3] + b2 * step[4]).normalize(),
        };
        Some(moved.essential())
    }
}

/// Two unit vectors across a unit vector and each other.
fn across(t: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let first = t.cross(&Vector3::ith(t.iamin(), 1.0)).normalize();
    [first, t.cross(&first)]
}

/// The four poses that an essential matrix allows (Horn 1990, "Recovering baseline and orientation
/// from essential matrix"): `|t|^2 R = cof(E) - [t]x E`.
fn decompositions(e: &Matrix3<f64>) -> [RelativePose; 4] {
    let square = e * e.transpose();
    let tt = Matrix3::identity() * (0.5 * square.trace()) - square;
    let largest = (0..3).fold(0, |k, i| if tt[(i, i)] > tt[(k, k)] { i } else { k });
    let t = tt.column(largest) / tt[(largest, largest)].max(1e-30).sqrt();
    let row = |i: usize| e.row(i).transpose();
    let cofactors = Matrix3::from_rows(&[
        row(1).cross(&row(2)).transpose(),
        row(2).cross(&row(0)).transpose(),
        row(0).cross(&row(1)).transpose(),
    ]);
    let crossed = t.cross_matrix() * e;
    let length2 = t.norm_squared();
    let pose = |sign_r: f64, sign_t: f64| RelativePose {
        rotation: orthonormal(&((cofactors - crossed * sign_r) / length2)),
        translation: t.normalize() * sign_t,
    };
    // The first belongs to E itself, not to its negative.
    [
        pose(1.0, 1.0),
        pose(-1.0, -1.0),
        pose(1.0, -1.0),
        pose(-1.0, 1.0),
    ]
}

/// The next rotation: Newton's iteration for the orthonormal polar factor.
pub(in super::super) fn orthonormal(matrix: &Matrix3<f64>) -> Rotation3<f64> {
    let mut r = *matrix;
    for _ in 0..6 {
        match r.try_inverse() {
            Some(inverse) => r = (r + inverse.transpose()) * 0.5,
            None => return Rotation3::identity(),
        }
    }
    Rotation3::from_matrix_unchecked(r)
}

/// The pose with the most inliers in front of both cameras, and these.
pub(super) fn pose_of(
    e: &Matrix3<f64>,
    rays: &[(Vector3<f64>, Vector3<f64>)],
    inliers: &[usize],
) -> Option<(RelativePose, Vec<usize>)> {
    let in_front = |pose: &RelativePose| -> Vec<usize> {
        let is_in_front = |&&i: &&usize| {
            let depths = pose.depths(&rays[i].0, &rays[i].1);
            depths.iter().all(|d| *d > 0.0)
        };
        inliers.iter().filter(is_in_front).copied().collect()
    };
    let candidates = decompositions(e).map(|pose| {
        let inliers = in_front(&pose);
        (pose, inliers)
    });
    let mut best: Option<(RelativePose, Vec<usize>)> = None;
    for candidate in candidates {
        if best.as_ref().is_none_or(|b| candidate.1.len() > b.1.len()) {
            best = Some(candidate);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_is_among_the_four_of_its_matrix() {
        let pose = RelativePose {
            rotation: rotation_from_axis_angle(&Vector3::new(0.3, -0.5, 1.2)),
            translation: Vector3::new(0.2, -0.9, 0.4).normalize(),
        };
        let four = decompositions(&pose.essential());
        assert!((four[0].essential() - pose.essential()).norm() < 1e-9);
        let off = |p: &RelativePose| {
            (p.rotation.matrix() - pose.rotation.matrix()).norm()
                + (p.translation - pose.translation).norm()
        };
        assert!(four.iter().any(|p| off(p) < 1e-9));
        for p in &four {
            let determinant = p.rotation.matrix().determinant();
            assert!((determinant - 1.0).abs() < 1e-9, "{determinant}");
        }
    }

    #[test]
    fn depths_and_angles_are_those_of_the_point() {
        let pose = RelativePose {
            rotation: rotation_from_axis_angle(&Vector3::new(0.1, -0.2, 0.5)),
            translation: Vector3::new(-1.0, 0.0, 0.0),
        };
        let point = Vector3::new(0.4, -0.3, 3.0);
        let seen = pose.rotation * point + pose.translation;
        let [first, second] = pose.depths(&(point / point.z), &(seen / seen.z));
        assert!((first - 3.0).abs() < 1e-9 && (second - seen.z).abs() < 1e-9);
        let (to_first, to_second) = (-point, pose.rotation.inverse() * -seen);
        let cos = to_first.normalize().dot(&to_second.normalize());
        assert!((pose.angle(&point, &seen) - math::acos(cos)).abs() < 1e-9);
    }
}
