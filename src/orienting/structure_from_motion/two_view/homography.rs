//! Homographies of planes and of pure rotations between two views.

use nalgebra::{Matrix3, Rotation3, SMatrix, SymmetricEigen, Vector3};

use crate::orienting::structure_from_motion::linear::{null_space, rotation_between};
use crate::orienting::structure_from_motion::random::Random;
use crate::orienting::structure_from_motion::robust::Estimator;

/// Matches as rays, and their standard deviation.
pub(super) struct HomographyProblem<'a> {
    pub rays: &'a [(Vector3<f64>, Vector3<f64>)],
    pub sigma: f64,
}

/// Squared distance of the transferred first ray from the second one, which has the noise of both.
fn transfer2(h: &Matrix3<f64>, (a, b): &(Vector3<f64>, Vector3<f64>), sigma: f64) -> f64 {
    let p = h * a;
    if p.z.abs() <= 1e-12 {
        return f64::INFINITY;
    }
    let (dx, dy) = (p.x / p.z - b.x, p.y / p.z - b.y);
    (dx * dx + dy * dy) / (2.0 * sigma * sigma)
}

/// The two linear equations of a match (Hartley, Zisserman 2004, 4.1).
fn equations((a, b): &(Vector3<f64>, Vector3<f64>)) -> [[f64; 9]; 2] {
    let (u, v) = (b.x, b.y);
    [
        [a.x, a.y, a.z, 0.0, 0.0, 0.0, -u * a.x, -u * a.y, -u * a.z],
        [0.0, 0.0, 0.0, a.x, a.y, a.z, -v * a.x, -v * a.y, -v * a.z],
    ]
}

impl Estimator for HomographyProblem<'_> {
    type Model = Matrix3<f64>;

    fn len(&self) -> usize {
        self.rays.len()
    }

    fn sample_size(&self) -> usize {
        4
    }

    fn hypotheses(&self, random: &mut Random) -> Vec<Matrix3<f64>> {
        let sample = random.sample::<4>(self.len());
        let rows = sample.map(|i| equations(&self.rays[i]));
        let system = SMatrix::<f64, 8, 9>::from_fn(|r, c| rows[r / 2][r % 2][c]);
        let solution = null_space::<8, 9, 1>(&system);
        solution
            .map(|[h]| Matrix3::from_fn(|r, c| h[3 * r + c]))
            .into_iter()
            .collect()
    }

    fn residual2(&self, h: &Matrix3<f64>, i: usize) -> f64 {
        transfer2(h, &self.rays[i], self.sigma)
    }

    fn refined(&self, h: &Matrix3<f64>, weights: &[f64]) -> Option<Matrix3<f64>> {
        let mut normal = SMatrix::<f64, 9, 9>::zeros();
        for (rays, &weight) in self.rays.iter().zip(weights) {
            if weight < 1e-3 {
                continue;
            }
            // Divided by the depth, the algebraic distance becomes the geometric one.
            let depth = (h.row(2) * rays.0)[0];
            for row in equations(rays) {
                let row = SMatrix::<f64, 9, 1>::from(row);
                normal += row * row.transpose() * (weight / (depth * depth));
            }
        }
        let eigen = SymmetricEigen::new(normal);
        let least = eigen
            .eigenvectors
            .column(eigen.eigenvalues.imin())
            .into_owned();
        let refined = Matrix3::from_fn(|r, c| least[3 * r + c]);
        refined.iter().all(|v| v.is_finite()).then_some(refined)
    }
}

/// A rotation about the projection centre: the homography `R`.
pub(super) struct RotationProblem<'a> {
    pub rays: &'a [(Vector3<f64>, Vector3<f64>)],
    pub sigma: f64,
}

impl RotationProblem<'_> {
    fn rotation(&self, weighted: impl Iterator<Item = (usize, f64)>) -> Rotation3<f64> {
        let correlation = weighted.fold(Matrix3::zeros(), |sum, (i, weight)| {
            let (a, b) = &self.rays[i];
            sum + a.normalize() * b.normalize().transpose() * weight
        });
        rotation_between(&correlation)
    }
}

impl Estimator for RotationProblem<'_> {
    type Model = Rotation3<f64>;

    fn len(&self) -> usize {
        self.rays.len()
    }

    fn sample_size(&self) -> usize {
        2
    }

    fn hypotheses(&self, random: &mut Random) -> Vec<Rotation3<f64>> {
        let sample = random.sample::<2>(self.len());
        vec![self.rotation(sample.into_iter().map(|i| (i, 1.0)))]
    }

    fn residual2(&self, r: &Rotation3<f64>, i: usize) -> f64 {
        transfer2(r.matrix(), &self.rays[i], self.sigma)
    }

    fn refined(&self, _: &Rotation3<f64>, weights: &[f64]) -> Option<Rotation3<f64>> {
        Some(self.rotation(weights.iter().copied().enumerate()))
    }
}
