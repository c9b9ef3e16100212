//! The block as a problem of least squares: where a step of all unknowns leads.

use nalgebra::{Point3, Vector6};

use super::normal_equations::{Layout, cost, point_steps, reduced_system};
use super::options::{BundleOptions, Prior};
use crate::base::least_squares::{Pattern, Problem, Stop, minimise};
use crate::orienting::structure_from_motion::block::{Block, Pose};
use crate::orienting::structure_from_motion::intrinsics::{Intrinsics, PARAMETERS};
use crate::orienting::structure_from_motion::resection::moved;

/// Adjusts poses, points and cameras; the cost after it, a robust sum of squares.
pub(in super::super) fn adjust(
    block: &mut Block,
    means: &[Intrinsics],
    options: &BundleOptions,
) -> f64 {
    let layout = Layout::new(block);
    let priors = options.priors(means);
    let start = State {
        poses: (layout.photos.iter())
            .map(|&photo| block.photos[photo].pose.clone())
            .collect(),
        cameras: block.cameras.clone(),
        points: layout
            .tracks
            .iter()
            .map(|&t| block.tracks[t].point)
            .collect(),
        cost: cost(block, &layout, &priors),
    };
    let mut problem = BlockProblem {
        pattern: Pattern::dense(layout.unknowns()),
        block,
        layout,
        priors,
    };
    let stop = Stop {
        steps: options.steps,
        least_gain: options.least_gain,
    };
    let (state, done) = minimise(&mut problem, start, stop);
    problem.set(&state);
    done.cost
}

/// Unknowns in the order of the layout.
struct State {
    poses: Vec<Option<Pose>>,
    cameras: Vec<Intrinsics>,
    points: Vec<Option<Point3<f64>>>,
    cost: f64,
}

struct BlockProblem<'a> {
    block: &'a mut Block,
    layout: Layout,
    pattern: Pattern,
    priors: Vec<Prior>,
}

impl BlockProblem<'_> {
    /// Gives the block these unknowns.
    fn set(&mut self, state: &State) {
        for (&photo, pose) in self.layout.photos.iter().zip(&state.poses) {
            self.block.photos[photo].pose.clone_from(pose);
        }
        self.block.cameras.clone_from(&state.cameras);
        for (&track, point) in self.layout.tracks.iter().zip(&state.points) {
            self.block.tracks[track].point = *point;
        }
    }
}

impl Problem for BlockProblem<'_> {
    type State = State;

    fn cost(&self, state: &State) -> f64 {
        state.cost
    }

    fn stepped(&mut self, from: &State, damping: f64) -> Option<State> {
        self.set(from);
        let (block, layout) = (&*self.block, &self.layout);
        let system = reduced_system(block, layout, &self.pattern, &self.priors, damping);
        let step = system.matrix.cholesky()?.solve(&system.right);
        let poses = from.poses.iter().enumerate().map(|(slot, pose)| {
            let step = Vector6::from_column_slice(&step[6 * slot..6 * slot + 6]);
            pose.as_ref().map(|p| moved(p, &step))
        });
        let cameras = from.cameras.iter().enumerate().map(|(camera, intrinsics)| {
            let start = layout.of_camera(camera);
            let mut parameters = intrinsics.parameters();
            for (value, step) in parameters.iter_mut().zip(&step[start..start + PARAMETERS]) {
                *value += step;
            }
            intrinsics.with_parameters(parameters)
        });
        let points = point_steps(block, layout, &step, damping);
        let mut next = State {
            poses: poses.collect(),
            cameras: cameras.collect(),
            points: points.into_iter().map(Some).collect(),
            cost: f64::INFINITY,
        };
        self.set(&next);
        next.cost = cost(self.block, &self.layout, &self.priors);
        Some(next)
    }
}
