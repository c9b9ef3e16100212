//! Edges drawn in one view of rendered roofs.

use nalgebra::Vector2;

use super::*;
use crate::orienting::synthetic::{gable_scene, hip_scene};

/// The line of an edge that is drawn in a view, its ends so many pixels off.
fn found(scene: &Scene, view: usize, edge: &Segment3, off: [[f64; 2]; 2]) -> Option<Line3d> {
    found_by(scene, view, edge, off, 2.0)
}

/// The same by a hand of this accuracy, pixels.
fn found_by(
    scene: &Scene,
    view: usize,
    edge: &Segment3,
    off: [[f64; 2]; 2],
    sigma_px: f64,
) -> Option<Line3d> {
    let camera = &scene.views[view].camera;
    let pixel = |p, off: [f64; 2]| camera.project(p).expect("in front") + Vector2::from(off);
    let drawn = DrawnEdge {
        view: ViewId::from_index(view),
        segment: Segment2::new(pixel(&edge.p0, off[0]), pixel(&edge.p1, off[1])),
        sigma_px,
    };
    let params = (&MatchParams::default(), &Lines3dParams::default());
    line_of_drawn(scene, &drawn, ([0.0, 14.0], &[]), params)
}

#[test]
fn every_edge_of_a_roof_is_found_from_every_view() {
    for (scene, truth) in [gable_scene(320), hip_scene(320)] {
        for edge in &truth.edges {
            for view in 0..scene.views.len() {
                let line = found(&scene, view, edge, [[1.2, -1.5], [-1.4, 1.0]]).expect("a line");
                let off = [line.segment.p0, line.segment.p1].map(|p| edge.line_distance(&p));
                assert!(off[0].max(off[1]) < 0.06, "{edge:?} from {view}: {off:?}");
                let longer = line.segment.length() - edge.length();
                assert!(
                    longer.abs() < 0.6,
                    "{edge:?} from {view}: {longer} m longer"
                );
                assert!(line.probability > 0.9, "{}", line.probability);
            }
        }
    }
}

#[test]
fn where_one_other_view_shows_an_edge_or_none_there_is_no_line() {
    let (mut scene, truth) = gable_scene(320);
    let edge = truth.edges[0];
    for shown in [2, 3] {
        let mut scene = scene.clone();
        for view in &mut scene.views[shown..] {
            view.gray.data.fill(0.5);
            view.red_blue = None;
        }
        let line = found(&scene, 0, &edge, [[0.0; 2]; 2]);
        assert_eq!(line.is_some(), shown > 2, "{shown} views");
    }
    scene.views.truncate(1);
    assert!(
        found(&scene, 0, &edge, [[0.0; 2]; 2]).is_none(),
        "no other view"
    );
}

#[test]
fn an_edge_is_sought_as_far_as_the_hand_may_miss_it() {
    let (scene, truth) = gable_scene(320);
    let height = |e: &&Segment3| e.p0.z + e.p1.z;
    let ridge = (truth.edges.iter()).max_by(|a, b| height(a).total_cmp(&height(b)));
    let ridge = ridge.expect("edges");
    let camera = &scene.views[0].camera;
    let image = [ridge.p0, ridge.p1].map(|p| camera.project(&p).expect("in front"));
    let off: [f64; 2] = (Segment2::new(image[0], image[1]).normal() * 7.0).into();
    let missed_m = |sigma_px: f64| {
        let line = found_by(&scene, 0, ridge, [off; 2], sigma_px)?;
        let off = [line.segment.p0, line.segment.p1].map(|p| ridge.line_distance(&p));
        Some(off[0].max(off[1]))
    };
    let [near, far] = [2.0, 6.0].map(missed_m);
    assert!(far.is_some_and(|m| m < 0.06), "{far:?}");
    assert!(near.is_none_or(|m| m > 0.1), "{near:?}");
}
