//! Small errors of the orientation, corrected by a bundle adjustment over matched lines.
//!
//! ```text
//! sum over lines, views  rho(r(line, pose))
//!    + sum over free views  |pose change / prior|^2  ->  min
//! ```
//!
//! r are the whitened offset and angle between a measured edge and the image of its line, and rho
//! is Cauchy's loss, both as in [`crate::lines::lines3d`]. A free view has six unknowns, a rotation
//! about its centre and a shift. The priors separate the two, which have nearly the same effect on
//! a crop of a frame.
//!
//! Common changes of all views that only deform the object space are nearly unobservable, and
//! adjusting all views at once would degrade sound orientations. Therefore views are freed one by
//! one, each time the one that lowers the cost most, as long as it lowers it much, and never more
//! than half of them: the others are the datum.
//!
//! Invariant: where no view stands out, the cameras stay as they are.

mod pose;
mod rounds;
mod system;

pub use self::rounds::AdjustmentRound;
pub(crate) use self::rounds::{next_round, shifts_back};

use nalgebra::Vector2;

use self::system::{AdjustmentState, BundleAdjustment};
use crate::base::math;
use crate::base::params::Lines3dParams;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::{Scene, ViewAdjustment};
use crate::photographs::camera::Camera;

/// Least share of the cost that freeing a view must remove. Assumption: sound scenes, rendered and
/// real, show at most 0.025.
const LEAST_GAIN: f64 = 0.05;

/// Least shift of a view's edges that is corrected, pixels: lines are located to about 0.1 px.
const LEAST_MOTION_PX: f64 = 0.15;

/// Fewest edges of a view that may be freed.
const FEWEST_EDGES: usize = 12;

/// Adjusts the cameras of a scene to its matched lines. Returns the cameras and one record for
/// each view; where no view stands out the cameras are those of the scene.
fn adjust_views(
    scene: &Scene,
    lines: &[Line3d],
    params: &Lines3dParams,
) -> (Vec<Camera>, Vec<ViewAdjustment>) {
    let stated: Vec<Camera> = scene.views.iter().map(|v| v.camera.clone()).collect();
    let bundle = BundleAdjustment::new(lines, stated.len(), params);
    let start = bundle.state(&stated);
    let best = free_views(&bundle, &stated, start.clone());
    let cameras: Vec<Camera> = (stated.iter().zip(&best.changes))
        .map(|(camera, change)| change.apply(camera))
        .collect();
    let records = (0..stated.len())
        .map(|view| record(&bundle, view, [&start, &best], [&stated, &cameras]))
        .collect();
    (cameras, records)
}

/// Frees views one by one.
fn free_views(
    bundle: &BundleAdjustment,
    stated: &[Camera],
    start: AdjustmentState,
) -> AdjustmentState {
    let mut best = start;
    while 2 * (best.free.len() + 1) <= stated.len() {
        let candidates = (0..stated.len())
            .filter(|v| !best.free.contains(v) && bundle.edges(*v) >= FEWEST_EDGES);
        let next = candidates
            .map(|view| bundle.freeing(view, &best, stated))
            .min_by(|a, b| a.cost.total_cmp(&b.cost));
        let helps = |next: &AdjustmentState| next.cost < (1.0 - LEAST_GAIN) * best.cost;
        match next.filter(helps) {
            Some(next) => best = next,
            None => break,
        }
    }
    let moves = |view: usize| rms(&bundle.motions(view, stated, &best)) > LEAST_MOTION_PX;
    match best.free.iter().all(|&view| moves(view)) {
        true => best,
        // Smaller changes only fit the noise.
        false => bundle.state(stated),
    }
}

fn record(
    bundle: &BundleAdjustment,
    view: usize,
    [start, best]: [&AdjustmentState; 2],
    [stated, cameras]: [&[Camera]; 2],
) -> ViewAdjustment {
    let motions = bundle.motions(view, stated, best);
    let count = motions.len().max(1) as f64;
    let change = &best.changes[view];
    let median =
        |state, cameras| math::median(&mut bundle.distances(view, cameras, state)).unwrap_or(0.0);
    ViewAdjustment {
        motion_px: (motions.iter().sum::<Vector2<f64>>() / count).into(),
        rms_motion_px: rms(&motions),
        turn_deg: change.turn.norm().to_degrees(),
        move_m: change.shift_m.norm(),
        before_px: median(start, stated),
        after_px: median(best, cameras),
        edges: bundle.edges(view),
    }
}

fn rms(motions: &[Vector2<f64>]) -> f64 {
    let squares: f64 = motions.iter().map(Vector2::norm_squared).sum();
    (squares / motions.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::pose::PoseChange;
    use super::*;
    use crate::base::execution::progress::silent;
    use crate::base::params::Params;
    use crate::orienting::synthetic::l_scene;
    use crate::pipeline::{Run, Stage};
    use nalgebra::{Point2, Vector3};

    /// Largest distance between the places where two cameras put points of the scene, pixels.
    fn difference_px(a: &Camera, b: &Camera) -> f64 {
        let corners = [-8.0, 0.0, 8.0].map(|x| [-8.0, 8.0].map(|y| Point2::new(x, y)));
        let points = corners.iter().flatten();
        let distances = points.map(|p| {
            let world = nalgebra::Point3::new(p.x, p.y, 6.0);
            (a.project(&world).unwrap() - b.project(&world).unwrap()).norm()
        });
        distances.fold(0.0, f64::max)
    }

    #[test]
    fn a_planted_turn_and_move_are_taken_back_and_nothing_else() {
        let mut run = Run::new(l_scene(320).0, Params::default());
        run.step(Stage::Lines, &silent());
        let lines = run.results().lines.as_ref().unwrap().value.clone();
        let params = Params::default().lines3d;
        let (sound, records) = adjust_views(run.scene(), &lines, &params);
        assert!(
            records.iter().all(|r| r.rms_motion_px == 0.0),
            "{records:?}"
        );
        assert_eq!(sound[2], run.scene().views[2].camera);

        let error = PoseChange {
            turn: Vector3::new(3e-5, -2e-5, 2e-3),
            shift_m: Vector3::new(0.1, -0.05, 0.1),
        };
        let mut scene = run.scene().clone();
        scene.views[2].camera = error.apply(&sound[2]);
        let planted = difference_px(&scene.views[2].camera, &sound[2]);
        let (found, records) = adjust_views(&scene, &lines, &params);
        let left = difference_px(&found[2], &sound[2]);
        assert!(
            planted > 0.8 && left < 0.05 * planted,
            "{planted} px, {left} px: {records:?}"
        );
        assert!(
            records[2].after_px < 0.5 * records[2].before_px,
            "{records:?}"
        );
        for view in [0, 1, 3, 4, 5] {
            assert_eq!(found[view], sound[view]);
        }
    }
}
