//! Edges drawn in one photograph.

use super::*;
use crate::base::geometry::{Segment3, contains, sides};
use crate::orienting::scene::Scene;
use crate::orienting::synthetic::{SyntheticTruth, hip_scene};
use nalgebra::{Point2, Vector2};

/// The model of the truth of a scene.
fn model_of(truth: &SyntheticTruth) -> RoofModel {
    let rings: Vec<Facet> = truth.facets.iter().map(|(_, ring)| facet(ring)).collect();
    let (model, trace) = close_buildings(&rings, |_| truth.ground_z);
    assert_eq!(trace.rejected, []);
    model
}

/// The edge as somebody draws it in a photograph, two pixels off at either end.
fn drawn(scene: &Scene, view: usize, edge: &Segment3) -> Correction {
    let seen = &scene.views[view];
    let pixel = |p, off: [f64; 2]| seen.camera.project(p).expect("seen") + Vector2::from(off);
    Correction::AddEdge {
        photograph: seen.name.clone(),
        pixels: [pixel(&edge.p0, [1.2, -1.6]), pixel(&edge.p1, [-1.4, 1.4])],
        sigma_px: 2.0,
    }
}

fn in_scene(
    scene: &Scene,
    model: &RoofModel,
    corrections: &[Correction],
) -> (RoofModel, CorrectionTrace) {
    let found = correct(scene, model, corrections, &Params::default());
    assert_eq!(check_invariants(&found.0), []);
    assert_eq!(found.1.lines.len(), corrections.len());
    found
}

/// The highest edge.
fn ridge(truth: &SyntheticTruth) -> Segment3 {
    let height = |e: &&Segment3| e.p0.z + e.p1.z;
    let highest = (truth.edges.iter()).max_by(|a, b| height(a).total_cmp(&height(b)));
    *highest.expect("edges")
}

/// Two facets as one, on the plane of the first.
fn merged(scene: &Scene, model: &RoofModel, [kept, gone]: [usize; 2]) -> RoofModel {
    let place = |i: usize| FacetPlace {
        at: mean_point(&model.facets[i].outer),
        normal: model.facets[i].plane.normal,
    };
    let merge = Correction::Merge {
        facet: place(kept),
        with: place(gone),
    };
    let (found, trace) = in_scene(scene, model, &[merge]);
    assert_eq!(trace.outcomes, [None]);
    assert_eq!(found.facets.len(), model.facets.len() - 1);
    found
}

/// The largest angle of a facet from the one of the truth that is nearest to its slope, degrees.
fn turned_deg(found: &RoofModel, truth: &RoofModel) -> f64 {
    let of = |f: &Facet| {
        let angles = truth.facets.iter().map(|t| t.plane.angle_to(&f.plane));
        angles.fold(f64::MAX, f64::min).to_degrees()
    };
    found.facets.iter().map(of).fold(0.0, f64::max)
}

#[test]
fn a_missing_ridge_returns_from_every_photograph() {
    let (scene, truth) = gable_scene(320);
    let right = model_of(&truth);
    for facets in [[0, 1], [1, 0]] {
        let wrong = merged(&scene, &right, facets);
        for view in 0..scene.views.len() {
            let add = drawn(&scene, view, &ridge(&truth));
            let (found, trace) = in_scene(&scene, &wrong, &[add]);
            assert_eq!(trace.outcomes, [None], "view {view}");
            let line = trace.lines[0].expect("a line");
            let off = [line.p0, line.p1].map(|p| ridge(&truth).line_distance(&p));
            assert!(off[0].max(off[1]) < 0.05, "view {view}: {off:?}");
            assert_is(&found, &right, 0.1);
            let turned = turned_deg(&found, &right);
            assert!(turned < 1.0, "view {view}: {turned} degrees");
        }
    }
}

#[test]
fn a_ridge_returns_where_the_roof_was_thought_level() {
    let (scene, truth) = gable_scene(320);
    let right = model_of(&truth);
    let eaves = right.facets.iter().flat_map(|f| &f.outer);
    let low = eaves.map(|p| p.z).fold(f64::MAX, f64::min);
    let whole = merged(&scene, &right, [0, 1]).facets[0].outer.clone();
    let level: Vec<Point3<f64>> = whole.iter().map(|p| Point3::new(p.x, p.y, low)).collect();
    let (wrong, _) = close_buildings(&[facet(&level)], |_| truth.ground_z);
    let (found, trace) = in_scene(&scene, &wrong, &[drawn(&scene, 2, &ridge(&truth))]);
    assert_eq!(trace.outcomes, [None]);
    assert_is(&found, &right, 0.1);
}

#[test]
fn a_missing_hip_returns_and_the_other_facets_keep_their_bits() {
    let (scene, truth) = hip_scene(320);
    let right = model_of(&truth);
    let shared = |i: usize, j: usize| {
        let of =
            |f: usize, p: &Point3<f64>| right.facets[f].outer.iter().any(|q| (p - q).norm() < 1e-3);
        let on = |e: &&Segment3| [i, j].iter().all(|&f| of(f, &e.p0) && of(f, &e.p1));
        truth.edges.iter().find(on).copied()
    };
    let pairs = (0..4).flat_map(|i| (0..4).map(move |j| [i, j]));
    let is_hip = |[i, j]: &[usize; 2]| {
        i != j && shared(*i, *j).is_some_and(|e| (e.p0.z - e.p1.z).abs() > 1.0)
    };
    for [kept, gone] in pairs.filter(is_hip) {
        let wrong = merged(&scene, &right, [kept, gone]);
        let hip = shared(kept, gone).expect("a hip");
        let (found, trace) = in_scene(&scene, &wrong, &[drawn(&scene, 4, &hip)]);
        assert_eq!(trace.outcomes, [None], "{kept} {gone}");
        assert_is(&found, &right, 0.15);
        let kept_bits = right
            .facets
            .iter()
            .filter(|f| found.facets.iter().any(|g| g.plane == f.plane));
        assert!(kept_bits.count() >= 2);
    }
}

#[test]
fn an_edge_in_the_plane_of_a_facet_divides_it_in_that_plane() {
    let (scene, truth) = gable_scene(320);
    let right = model_of(&truth);
    // The ridge is an edge of the model already.
    let again = in_scene(&scene, &right, &[drawn(&scene, 0, &ridge(&truth))]);
    assert_eq!(again.1.outcomes, [Some(NotApplied::NotDivided)]);
    assert!(again.1.lines[0].is_some(), "the line is there all the same");
    assert_eq!(again.0, right);
}

#[test]
fn a_later_correction_leaves_a_drawn_edge_where_it_is() {
    let (scene, truth) = gable_scene(320);
    let right = model_of(&truth);
    let wrong = merged(&scene, &right, [0, 1]);
    let eave = (right.facets[0].outer.iter())
        .min_by(|p, q| p.z.total_cmp(&q.z))
        .copied()
        .expect("corners");
    let corrections = [
        drawn(&scene, 1, &ridge(&truth)),
        Correction::MoveCorner {
            from: eave,
            to: eave + Vector3::new(0.1, 0.0, 0.0),
            sigma_m: 0.02,
        },
    ];
    let (found, trace) = in_scene(&scene, &wrong, &corrections);
    assert_eq!(trace.outcomes, [None, None]);
    let top = found.facets.iter().flat_map(|f| &f.outer);
    let top = top.max_by(|p, q| p.z.total_cmp(&q.z)).expect("corners");
    assert!(ridge(&truth).line_distance(top) < 0.06);
}

#[test]
fn what_is_no_edge_in_a_photograph_says_why() {
    let (scene, truth) = gable_scene(320);
    let model = model_of(&truth);
    let why = |photograph: &str, pixels: [[f64; 2]; 2]| {
        let add = Correction::AddEdge {
            photograph: photograph.to_owned(),
            pixels: pixels.map(Point2::from),
            sigma_px: 2.0,
        };
        let (found, trace) = in_scene(&scene, &model, &[add]);
        assert_eq!(found, model, "a refused correction changes nothing");
        trace.outcomes[0].expect("a refusal")
    };
    let name = scene.views[0].name.as_str();
    let there = [[100.0, 100.0], [200.0, 120.0]];
    assert_eq!(why("another.jpg", there), NotApplied::NoPhotograph);
    for outside in [
        [[100.0, 100.0], [320.5, 120.0]],
        [[-1.0, 100.0], [200.0, 120.0]],
        [[100.0, f64::NAN], [200.0, 120.0]],
        [[100.0, 100.0], [f64::INFINITY, 120.0]],
        [[100.0, 100.0], [100.0, 100.0]],
        [[100.0, 100.0], [103.0, 101.0]],
    ] {
        assert_eq!(
            why(name, outside),
            NotApplied::NotInPhotograph,
            "{outside:?}"
        );
    }
    assert_eq!(why(name, [[2.0, 2.0], [30.0, 2.0]]), NotApplied::NoBuilding);
    for (sigma_px, expected) in [
        (0.0, NotApplied::Implausible),
        (f64::NAN, NotApplied::Implausible),
        // Half as long as a hand misses it.
        (60.0, NotApplied::NotInPhotograph),
        (f64::INFINITY, NotApplied::NotInPhotograph),
    ] {
        let add = Correction::AddEdge {
            photograph: name.to_owned(),
            pixels: there.map(Point2::from),
            sigma_px,
        };
        let trace = in_scene(&scene, &model, &[add]).1;
        assert_eq!(trace.outcomes, [Some(expected)], "{sigma_px}");
    }
    // The other photographs show nothing.
    let mut blank = scene.clone();
    for view in &mut blank.views[1..] {
        view.gray.data.fill(0.5);
        view.red_blue = None;
    }
    let wrong = merged(&scene, &model, [0, 1]);
    let (found, trace) = in_scene(&blank, &wrong, &[drawn(&scene, 0, &ridge(&truth))]);
    assert_eq!(trace.outcomes, [Some(NotApplied::NoLine)]);
    assert_eq!(found, wrong);
}

/// Every roof facet in one grey value, as its photographs would show it; they differ by a step.
fn painted(scene: &Scene, truth: &SyntheticTruth, step: f32) -> Scene {
    let mut plain = scene.clone();
    for view in &mut plain.views {
        let image = |p: &Point3<f64>| view.camera.project(p).expect("seen");
        for (i, (_, ring)) in truth.facets.iter().enumerate() {
            let ring: Vec<Point2<f64>> = ring.iter().map(image).collect();
            let grey = 0.35 + step * i as f32;
            let width = view.gray.width;
            for (k, value) in view.gray.data.iter_mut().enumerate() {
                let at = Point2::new((k % width) as f64 + 0.5, (k / width) as f64 + 0.5);
                if contains(sides(&ring), &at) {
                    *value = grey;
                }
            }
        }
        view.red_blue = None;
    }
    plain
}

#[test]
fn the_halves_of_a_plain_roof_turn_to_their_eaves() {
    let (scene, truth) = gable_scene(320);
    let (scene, right) = (painted(&scene, &truth, 0.15), model_of(&truth));
    for facets in [[0, 1], [1, 0]] {
        let wrong = merged(&scene, &right, facets);
        for view in 0..scene.views.len() {
            let (found, trace) = in_scene(&scene, &wrong, &[drawn(&scene, view, &ridge(&truth))]);
            assert_eq!(trace.outcomes, [None], "view {view}");
            let turned = turned_deg(&found, &right);
            assert!(turned < 1.5, "view {view}: {turned} degrees");
        }
    }
}

#[test]
fn a_ridge_that_no_other_photograph_shows_lies_on_its_facet() {
    let (scene, truth) = gable_scene(320);
    let (scene, right) = (painted(&scene, &truth, 0.0), model_of(&truth));
    let wrong = merged(&scene, &right, [0, 1]);
    for view in 0..scene.views.len() {
        let (found, trace) = in_scene(&scene, &wrong, &[drawn(&scene, view, &ridge(&truth))]);
        assert_eq!(trace.outcomes, [None], "view {view}");
        let line = trace.lines[0].expect("a line");
        let own = &right.facets[0].plane;
        let off = [line.p0, line.p1].map(|p| own.signed_distance(&p).abs());
        assert!(off[0].max(off[1]) < 0.01, "view {view}: {off:?}");
        // As well as it is drawn, two pixels off.
        let turned = turned_deg(&found, &right);
        assert!(turned < 5.0, "view {view}: {turned} degrees");
    }
    // The facets without the step between them are one: nothing turns.
    let again = in_scene(&scene, &right, &[drawn(&scene, 0, &ridge(&truth))]);
    assert_eq!(again.0, right);
}
