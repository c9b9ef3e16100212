//! Levenberg's and Marquardt's steps of all unknowns.

use nalgebra::{Point3, Vector6};

use super::cholesky::solve;
use super::normal_equations::{Layout, cost, point_steps, reduced_system};
use super::options::BundleOptions;
use crate::orienting::structure_from_motion::block::{Block, Pose};
use crate::orienting::structure_from_motion::intrinsics::{Intrinsics, PARAMETERS};
use crate::orienting::structure_from_motion::resection::moved;

/// First damping, and its bounds.
const DAMPING: f64 = 1e-4;
const LEAST_DAMPING: f64 = 1e-10;
const MOST_DAMPING: f64 = 1e6;

/// Adjusts poses, points and cameras; the cost after it, a robust sum of squares.
pub(in super::super) fn adjust(
    block: &mut Block,
    means: &[Intrinsics],
    options: &BundleOptions,
) -> f64 {
    let layout = Layout::new(block);
    let priors = options.priors(means);
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
