//! Covariances of the adjusted unknowns.
//!
//! The observations leave seven things open: place, direction and scale of the world. The
//! covariance is that in the datum of the projection centres: their mean, turn and scale held, as
//! a similarity to stated positions holds them (inner constraints: Triggs et al. 2000, 9).

use nalgebra::{Matrix3, Point3, Vector3};

use super::normal_equations::{Layout, reduced_system};
use super::options::BundleOptions;
use crate::base::geometry::mean_point;
use crate::base::least_squares::Pattern;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::intrinsics::{Intrinsics, PARAMETERS};

/// Covariances, as far as the standard deviations of the keypoints are right.
pub(in super::super) struct Covariance {
    /// Of the projection centres of the registered photographs, units of the block.
    pub centers: Vec<Matrix3<f64>>,
    /// Of their rotations: turns of the camera's axes, radians.
    pub turns: Vec<Matrix3<f64>>,
    /// Standard deviations of f, k1, k2, cx, cy of each camera; 0 where held.
    pub cameras: Vec<[f64; PARAMETERS]>,
}

/// The covariances of an adjusted block; `None` where it does not determine its unknowns.
pub(in super::super) fn covariance(
    block: &Block,
    means: &[Intrinsics],
    options: &BundleOptions,
) -> Option<Covariance> {
    let layout = Layout::new(block);
    let priors = options.priors(means);
    let pattern = Pattern::dense(layout.unknowns());
    let mut matrix = reduced_system(block, &layout, &pattern, &priors, 0.0).matrix;
    let centers: Vec<Point3<f64>> = (layout.photos.iter())
        .filter_map(|&p| block.photos[p].pose.as_ref())
        .map(|pose| pose.center)
        .collect();
    let free = free_motions(block, &layout, &centers);
    // Constraints on the centres alone, as heavy as the system itself.
    let n = layout.unknowns();
    let size = centers.iter().enumerate().fold(0.0f64, |most, (slot, _)| {
        (3..6).fold(most, |most, k| {
            most.max(matrix[(6 * slot + k, 6 * slot + k)])
        })
    });
    let constraints: Vec<Vec<f64>> = free
        .iter()
        .map(|motion| on_centers(motion, n, centers.len()))
        .collect();
    for c in &constraints {
        for i in 0..n {
            if c[i] != 0.0 {
                for (value, other) in matrix.row_mut(i).iter_mut().zip(c) {
                    *value += size * c[i] * other;
                }
            }
        }
    }
    let mut inverse = matrix.cholesky()?.inverse();
    // What the constraints themselves left of the free motions: N (N^T C C^T N)^-1 N^T.
    let gram = nalgebra::SMatrix::<f64, 7, 7>::from_fn(|i, j| {
        let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        (constraints.iter())
            .map(|c| size * inner(c, &free[i]) * inner(c, &free[j]))
            .sum()
    });
    let left = gram.try_inverse()?;
    for (p, of_p) in free.iter().enumerate() {
        for (q, of_q) in free.iter().enumerate() {
            let factor = left[(p, q)];
            for (i, own) in of_p.iter().enumerate() {
                let scaled = factor * own;
                if scaled != 0.0 {
                    for (value, other) in inverse.row_mut(i).iter_mut().zip(of_q) {
                        *value -= scaled * other;
                    }
                }
            }
        }
    }
    let block3 = |start: usize| Matrix3::from_fn(|r, c| inverse[(start + r, start + c)]);
    let slots = 0..centers.len();
    let cameras = (0..block.cameras.len()).map(|camera| {
        let start = layout.of_camera(camera);
        std::array::from_fn(|i| match options.prior[i] > 0.0 {
            true => inverse[(start + i, start + i)].max(0.0).sqrt(),
            false => 0.0,
        })
    });
    Some(Covariance {
        centers: slots.clone().map(|s| block3(6 * s + 3)).collect(),
        turns: slots.map(|s| block3(6 * s)).collect(),
        cameras: cameras.collect(),
    })
}

/// The seven motions of everything that no observation sees, as steps of the unknowns.
fn free_motions(block: &Block, layout: &Layout, centers: &[Point3<f64>]) -> [Vec<f64>; 7] {
    let middle = mean_point(centers);
    let n = layout.unknowns();
    std::array::from_fn(|motion| {
        let mut step = vec![0.0; n];
        for (slot, &photo) in layout.photos.iter().enumerate() {
            let from_middle = centers[slot] - middle;
            let shift = match motion {
                0..3 => Vector3::ith(motion, 1.0),
                3..6 => Vector3::ith(motion - 3, 1.0).cross(&from_middle),
                _ => from_middle,
            };
            step[6 * slot + 3..6 * slot + 6].copy_from_slice(shift.as_slice());
            if let (3..6, Some(pose)) = (motion, &block.photos[photo].pose) {
                // Axes of the camera turn against the world.
                let turn = -(pose.rotation * Vector3::ith(motion - 3, 1.0));
                step[6 * slot..6 * slot + 3].copy_from_slice(turn.as_slice());
            }
        }
        step
    })
}

/// The part of a motion that moves projection centres, of length one.
fn on_centers(motion: &[f64], n: usize, photos: usize) -> Vec<f64> {
    let mut part = vec![0.0; n];
    for slot in 0..photos {
        part[6 * slot + 3..6 * slot + 6].copy_from_slice(&motion[6 * slot + 3..6 * slot + 6]);
    }
    let length = part.iter().map(|v| v * v).sum::<f64>().sqrt();
    part.iter_mut().for_each(|v| *v /= length);
    part
}
