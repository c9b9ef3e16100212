//! Bundle adjustment with self-calibration: poses, points, and the parameters that the photographs
//! of a camera share (Triggs et al. 2000, "Bundle adjustment - a modern synthesis").
//!
//! ```text
//! normal_equations   linearised observations; points eliminated by the Schur complement
//! cholesky           the solution of the reduced system
//! covariance         of the unknowns, in the datum of the projection centres
//! ```
//!
//! Levenberg-Marquardt, Cauchy's loss. Points are divided into a fixed number of shards, whose sums
//! are added in their order, so that threads never change a result.

mod cholesky;
mod covariance;
mod normal_equations;

pub(super) use covariance::{Covariance, covariance};

use nalgebra::{Point3, Vector6};

use self::cholesky::solve;
use self::normal_equations::{Layout, cost, point_steps, reduced_system};
use super::block::{Block, Pose};
use super::intrinsics::{Intrinsics, PARAMETERS};
use super::resection::moved;

/// What is free and how long it is adjusted.
#[derive(Clone, Debug)]
pub(super) struct BundleOptions {
    /// Steps at most.
    pub steps: usize,
    /// A step that lowers the cost by a smaller share is the last one.
    pub least_gain: f64,
    /// Prior standard deviations of f (a share of it), k1, k2, and of cx, cy (pixels); 0 where a
    /// parameter is held.
    pub prior: [f64; PARAMETERS],
}

/// The prior's mean: what a camera is before its first adjustment.
#[derive(Clone, Debug)]
pub(super) struct Prior {
    pub mean: Intrinsics,
    /// Standard deviations of the parameters; 0 holds one.
    pub sigma: [f64; PARAMETERS],
}

/// First damping, and its bounds.
const DAMPING: f64 = 1e-4;
const LEAST_DAMPING: f64 = 1e-10;
const MOST_DAMPING: f64 = 1e6;

/// Adjusts poses, points and cameras; the cost after it, a robust sum of squares.
pub(super) fn adjust(block: &mut Block, means: &[Intrinsics], options: &BundleOptions) -> f64 {
    let layout = Layout::new(block);
    let priors: Vec<Prior> = (means.iter())
        .map(|mean| {
            let mut sigma = options.prior;
            sigma[0] *= mean.focal;
            let mean = mean.clone();
            Prior { mean, sigma }
        })
        .collect();
    let mut current = cost(block, &layout, &priors);
    let mut damping = DAMPING;
    for _ in 0..options.steps {
        let system = reduced_system(block, &layout, &priors, damping);
        let Some(step) = solve(system.matrix, system.right, layout.unknowns()) else {
            damping *= 10.0;
            if damping > MOST_DAMPING {
                break;
            }
            continue;
        };
        let mut other = stepped(block, &layout, &step, damping);
        exchange(block, &layout, &mut other);
        let next = cost(block, &layout, &priors);
        if next < current {
            let gain = (current - next) / current;
            current = next;
            damping = (damping / 8.0).max(LEAST_DAMPING);
            if gain < options.least_gain {
                break;
            }
        } else {
            exchange(block, &layout, &mut other);
            damping *= 10.0;
            if damping > MOST_DAMPING {
                break;
            }
        }
    }
    current
}

/// Unknowns in the order of the layout.
struct State {
    poses: Vec<Option<Pose>>,
    cameras: Vec<Intrinsics>,
    points: Vec<Option<Point3<f64>>>,
}

/// Exchanges the unknowns of the block with others.
fn exchange(block: &mut Block, layout: &Layout, other: &mut State) {
    for (&photo, pose) in layout.photos.iter().zip(&mut other.poses) {
        std::mem::swap(&mut block.photos[photo].pose, pose);
    }
    std::mem::swap(&mut block.cameras, &mut other.cameras);
    for (&track, point) in layout.tracks.iter().zip(&mut other.points) {
        std::mem::swap(&mut block.tracks[track].point, point);
    }
}

/// The unknowns after a step.
fn stepped(block: &Block, layout: &Layout, step: &[f64], damping: f64) -> State {
    let poses = layout.photos.iter().enumerate().map(|(slot, &photo)| {
        let step = Vector6::from_column_slice(&step[6 * slot..6 * slot + 6]);
        block.photos[photo].pose.as_ref().map(|p| moved(p, &step))
    });
    let cameras = block
        .cameras
        .iter()
        .enumerate()
        .map(|(camera, intrinsics)| {
            let start = layout.of_camera(camera);
            let mut parameters = intrinsics.parameters();
            for (value, step) in parameters.iter_mut().zip(&step[start..start + PARAMETERS]) {
                *value += step;
            }
            intrinsics.with_parameters(parameters)
        });
    let points = point_steps(block, layout, step, damping);
    State {
        poses: poses.collect(),
        cameras: cameras.collect(),
        points: points.into_iter().map(Some).collect(),
    }
}

#[cfg(test)]
pub(super) mod tests;
