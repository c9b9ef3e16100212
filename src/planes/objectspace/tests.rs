//! The whole method on synthetic houses, one for each of W96's restrictions.

use nalgebra::Point3;

use super::fixture::planted_lines;
use super::*;
use crate::base::params::{ObjectSpaceParams, Params};
use crate::orienting::scene::Scene;
use crate::orienting::synthetic::{
    SyntheticTruth, askew_scene, gable_scene, hip_scene, l_scene, row_scene, sheared_scene,
    tower_scene,
};
use crate::roofs::buildings::roofs_of_rectangles;
use crate::roofs::model::{Facet, RoofModel, check_invariants};

fn model(scene: &Scene) -> RoofModel {
    let params = Params::default();
    let of_regions = &params.objectspace;
    let (lines, _) = find_regions(scene, of_regions).unwrap();
    let (windows, _) = find_directions(scene, &lines, of_regions).unwrap();
    let (found, _) = find_clusters(scene, &lines, &windows, of_regions).unwrap();
    let (ground, trace) = find_rectangles(scene, &lines, &windows, &found, &params).unwrap();
    let model = roofs_of_rectangles(&trace, &ground);
    assert_eq!(check_invariants(&model), []);
    model
}

/// True facets whose plane a found facet has (to 2 degrees and 0.1 m), and found ones that have
/// none.
fn agreement(model: &RoofModel, truth: &SyntheticTruth) -> (usize, usize) {
    let agrees = |f: &Facet, (plane, ring): &(crate::base::geometry::Plane, Vec<Point3<f64>>)| {
        let middle = f
            .outer
            .iter()
            .fold(nalgebra::Vector3::zeros(), |s, p| s + p.coords)
            / f.outer.len() as f64;
        let bounds = |k: usize| {
            let values = || ring.iter().map(|p| p[k]);
            values().fold(f64::INFINITY, f64::min)..=values().fold(f64::NEG_INFINITY, f64::max)
        };
        (0..2).all(|k| bounds(k).contains(&middle[k]))
            && f.plane.angle_to(plane).to_degrees() < 2.0
            && plane.signed_distance(&middle.into()).abs() < 0.1
    };
    let found = truth
        .facets
        .iter()
        .filter(|t| model.facets.iter().any(|f| agrees(f, t)))
        .count();
    let wrong = model
        .facets
        .iter()
        .filter(|f| !truth.facets.iter().any(|t| agrees(f, t)))
        .count();
    (found, wrong)
}

/// The same for a scene, after its whole reconstruction.
fn found(scene: (Scene, SyntheticTruth)) -> (usize, usize) {
    agreement(&model(&scene.0), &scene.1)
}

#[test]
fn a_gable_is_two_rectangles() {
    let (mut scene, truth) = gable_scene(320);
    assert_eq!(agreement(&model(&scene), &truth), (2, 0));
    // The same with the roof hidden in one view of the six.
    let view = &mut scene.views[3];
    view.gray.data.fill(0.5);
    view.rgb
        .pixels_mut()
        .for_each(|p| *p = image::Rgb([128; 3]));
    assert_eq!(agreement(&model(&scene), &truth), (2, 0));
}

#[test]
fn an_l_shaped_house_has_slanted_ends() {
    let (scene, truth) = l_scene(320);
    let (found, wrong) = agreement(&model(&scene), &truth);
    assert!(found >= 3 && wrong == 0, "{found} found, {wrong} wrong");
}

#[test]
fn without_images_there_is_no_model() {
    let (mut scene, _) = gable_scene(64);
    for view in &mut scene.views {
        view.gray.data.fill(0.5);
    }
    assert!(model(&scene).facets.is_empty());
    scene.views.clear();
    assert!(model(&scene).facets.is_empty());
}

#[test]
fn planes_with_a_gap_are_two_pairs() {
    // Nothing spans the gap: a facet over it would be wrong by its middle.
    let (found, wrong) = found(row_scene(320));
    assert!(found >= 3 && wrong == 0, "{found} found, {wrong} wrong");
}

#[test]
fn houses_askew_have_directions_of_their_own() {
    assert_eq!(found(askew_scene(400)), (4, 0));
}

#[test]
fn parallelograms_are_found() {
    assert_eq!(found(sheared_scene(320)), (2, 0));
}

#[test]
fn a_hip_is_completed_by_triangles() {
    assert_eq!(found(hip_scene(320)), (4, 0));
}

#[test]
fn a_roof_that_a_tower_hides_in_part_is_found() {
    // The facet that turns to the tower is hidden from half of the views.
    let (found, wrong) = found(tower_scene(400));
    assert!(found >= 3 && wrong == 0, "{found} found, {wrong} wrong");
}

#[test]
fn the_best_plane_is_refused_where_the_images_do_not_agree() {
    let (mut scene, truth) = gable_scene(320);
    let lines = planted_lines(&scene, &truth.edges, 0.0, &[]);
    let mut params = Params::default();
    params.objectspace.windows.given_m = vec![[-12.0, -12.0, 12.0, 12.0]];
    params.objectspace.windows.z_range_m = Some([0.0, 12.0]);
    scene.ground_z = Some(truth.ground_z);
    let facets = |scene: &Scene| {
        let of_regions = &params.objectspace;
        let (windows, _) = find_directions(scene, &lines, of_regions).unwrap();
        let (found, _) = find_clusters(scene, &lines, &windows, of_regions).unwrap();
        let (_, trace) = find_rectangles(scene, &lines, &windows, &found, &params).unwrap();
        let weak = |p: &&PlaneTrace| p.rejection == Some(PlaneRejection::Weak);
        (trace.chosen.len(), trace.pairs.iter().filter(weak).count())
    };
    assert_eq!(facets(&scene).0, 2);
    for (k, view) in scene.views.iter_mut().enumerate() {
        for (i, gray) in view.gray.data.iter_mut().enumerate() {
            let hash = ((i * 31 + k * 7919) as u32).wrapping_mul(0x9e37_79b9) >> 16;
            *gray = (hash % 256) as f32 / 255.0;
        }
    }
    let (found, weak) = facets(&scene);
    assert!(found == 0 && weak > 0, "{found} found, {weak} weak");
}

#[test]
fn windows_are_found_around_each_house() {
    let (scene, truth) = askew_scene(400);
    let params = ObjectSpaceParams::default();
    let (lines, _) = find_regions(&scene, &params).unwrap();
    let (windows, _) = find_directions(&scene, &lines, &params).unwrap();
    for (_, ring) in &truth.facets {
        let holds = |w: &&Window| {
            ring.iter()
                .all(|p| (w.min.x..=w.max.x).contains(&p.x) && (w.min.y..=w.max.y).contains(&p.y))
        };
        let azimuth = |w: &Window| {
            let along = ring[1] - ring[0];
            w.directions.iter().any(|d| {
                let [u, v] = d.axes().map(|a| a.dot(&along.normalize()).abs());
                u.max(v) > 0.999
            })
        };
        assert!(windows.iter().filter(holds).any(azimuth), "{ring:?}");
    }
    // Of the lines around a house many are its own.
    for pair in windows.iter().flat_map(|w| &w.directions) {
        assert!(pair.share > 0.15 && pair.share <= 1.0, "{}", pair.share);
    }
}
