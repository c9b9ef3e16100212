//! Solids of planted roofs, and what goes wrong with broken ones.

use super::*;
use crate::base::geometry::{Plane, sides};
use crate::roofs::model::{Violation, check_invariants};
use nalgebra::{Point2, Point3, Vector3};
use proptest::prelude::*;

/// A facet over plan rings on `z = z0 + gx x + gy y`.
fn facet(rings: &[&[(f64, f64)]], z0: f64, gx: f64, gy: f64) -> Facet {
    let plane =
        Plane::from_point_normal(&Point3::new(0.0, 0.0, z0), &Vector3::new(-gx, -gy, 1.0)).unwrap();
    let lift = |ring: &&[(f64, f64)]| ring.iter().map(|&(x, y)| plane.lift(x, y)).collect();
    Facet {
        building: BuildingId(0),
        plane,
        outer: lift(&rings[0]),
        holes: rings[1..].iter().map(lift).collect(),
        similarity: 0.0,
        real_ratio: 0.0,
        uncertainty: None,
        probability: 1.0,
        lines: Vec::new(),
        half_planes: Vec::new(),
        proposals: Vec::new(),
        obstructions: Vec::new(),
    }
}

fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64, z0: f64, gx: f64, gy: f64) -> Facet {
    facet(&[&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)]], z0, gx, gy)
}

/// Closes the facets over ground 0 and expects a model without violations.
fn closed(facets: &[Facet]) -> RoofModel {
    let (model, trace) = close_buildings(facets, |_| 0.0);
    assert_eq!(trace.rejected, []);
    assert_eq!(check_invariants(&model), []);
    model
}

fn count(solid: &Solid, what: fn(&Surface) -> bool) -> usize {
    solid.faces.iter().filter(|f| what(&f.surface)).count()
}

fn walls(solid: &Solid) -> usize {
    count(solid, |s| *s == Surface::Wall)
}

#[test]
fn a_gable_has_the_volume_of_the_formula() {
    // 10 m long, 8 m wide, eaves at 5 m, ridge at 7 m.
    let model = closed(&[
        rectangle(0.0, 0.0, 10.0, 4.0, 5.0, 0.0, 0.5),
        rectangle(0.0, 4.0, 10.0, 8.0, 9.0, 0.0, -0.5),
    ]);
    let solid = &model.buildings[0].solid;
    assert!((solid.volume() - 10.0 * 8.0 * (5.0 + 1.0)).abs() < 1e-9);
    // Two eave walls and two gable ends (pentagons), no corner below the ridge ends.
    assert_eq!(walls(solid), 4);
    assert_eq!(solid.vertices.len(), 10);
}

#[test]
fn a_step_between_two_roofs_is_one_wall_of_one_solid() {
    // The low roof is longer: its edge meets the high one's in a T-junction.
    let model = closed(&[
        rectangle(0.0, 0.0, 5.0, 6.0, 8.0, 0.0, 0.0),
        rectangle(5.0, -2.0, 9.0, 9.0, 4.0, 0.0, 0.0),
    ]);
    assert_eq!(model.buildings.len(), 1);
    let solid = &model.buildings[0].solid;
    assert!((solid.volume() - (5.0 * 6.0 * 8.0 + 4.0 * 11.0 * 4.0)).abs() < 1e-9);
    assert_eq!(walls(solid), 4 + 4 + 1 - 1 + 1);
}

#[test]
fn roofs_that_cross_in_height_get_a_corner_at_the_crossing() {
    let model = closed(&[
        rectangle(0.0, 0.0, 5.0, 8.0, 5.0, 0.0, 0.0),
        rectangle(5.0, 0.0, 9.0, 8.0, 4.0, 0.0, 0.25),
    ]);
    let solid = &model.buildings[0].solid;
    assert!((solid.volume() - (5.0 * 8.0 * 5.0 + 4.0 * 8.0 * 5.0)).abs() < 1e-9);
    let crossing = Point3::new(5.0, 4.0, 5.0);
    assert!(solid.vertices.iter().any(|p| (p - crossing).norm() < 1e-9));
}

#[test]
fn a_courtyard_is_a_hole_in_the_ground() {
    let model = closed(&[facet(
        &[
            &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
            &[(3.0, 3.0), (3.0, 7.0), (7.0, 7.0), (7.0, 3.0)],
        ],
        6.0,
        0.1,
        0.0,
    )]);
    let solid = &model.buildings[0].solid;
    assert_eq!(walls(solid), 8);
    let ground = solid
        .faces
        .iter()
        .find(|f| f.surface == Surface::Ground)
        .unwrap();
    assert_eq!(ground.rings.len(), 2);
    assert!((solid.volume() - (100.0 - 16.0) * 6.5).abs() < 1e-9);
}

#[test]
fn facets_that_touch_in_a_corner_are_two_buildings() {
    let model = closed(&[
        rectangle(0.0, 0.0, 4.0, 4.0, 5.0, 0.0, 0.0),
        rectangle(4.0, 4.0, 8.0, 8.0, 5.0, 0.0, 0.0),
    ]);
    assert_eq!(model.buildings.len(), 2);
}

#[test]
fn a_ring_of_roofs_that_meets_itself_in_a_corner_is_a_manifold() {
    // Seven of nine squares around an open middle; the two ends touch in a corner only, and
    // heights high, low, high, low meet in the corner (4, 2).
    let squares = [(0, 0), (1, 0), (2, 0), (0, 1), (0, 2), (1, 2), (2, 1)];
    let facets: Vec<_> = squares
        .iter()
        .enumerate()
        .map(|(i, &(x, y))| {
            let (x, y) = (2.0 * f64::from(x), 2.0 * f64::from(y));
            rectangle(
                x,
                y,
                x + 2.0,
                y + 2.0,
                if i % 2 == 0 { 6.0 } else { 4.0 },
                0.0,
                0.0,
            )
        })
        .collect();
    let model = closed(&facets);
    assert_eq!(model.buildings.len(), 1);
    let solid = &model.buildings[0].solid;
    let ground = solid
        .faces
        .iter()
        .find(|f| f.surface == Surface::Ground)
        .unwrap();
    assert_eq!(ground.rings.len(), 2);
    check_apart(&model.buildings[0]);
}

/// No two corners of the ground lie together.
fn check_apart(building: &Building) {
    let solid = &building.solid;
    let ground = solid.faces.iter().filter(|f| f.surface == Surface::Ground);
    let corners: Vec<u32> = ground.flat_map(|f| f.rings.concat()).collect();
    for (i, &a) in corners.iter().enumerate() {
        for &b in &corners[..i] {
            let [p, q] = [a, b].map(|c| solid.vertices[c as usize]);
            assert!((p - q).norm() > 2e-3, "{p} and {q}");
        }
    }
}

#[test]
fn a_courtyard_that_touches_the_outline_in_a_corner_is_drawn_back() {
    // One facet with a hole, and two around a hole.
    let whole = facet(
        &[
            &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
            &[(0.0, 0.0), (2.0, 6.0), (6.0, 2.0)],
        ],
        6.0,
        0.1,
        0.0,
    );
    let south = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (6.0, 2.0)];
    let north = [
        (0.0, 0.0),
        (2.0, 6.0),
        (6.0, 2.0),
        (10.0, 10.0),
        (0.0, 10.0),
    ];
    let parts = [
        facet(&[&south], 6.0, 0.1, 0.0),
        facet(&[&north], 4.0, 0.0, 0.2),
    ];
    for facets in [&[whole][..], &parts] {
        let model = closed(facets);
        let building = &model.buildings[0];
        check_apart(building);
        let solid = &building.solid;
        let ground = solid.faces.iter().filter(|f| f.surface == Surface::Ground);
        let area: f64 = ground.map(|f| -solid.vector_area(&f.rings).z).sum();
        assert!((area - 84.0).abs() < 0.05, "{area}");
    }
}

#[test]
fn a_jog_of_a_millimetre_is_no_part_of_a_long_wall() {
    let south = [(0.0, 0.0), (5.0, 0.0), (5.0012, 0.0004), (10.0, 0.0004)];
    let outline: Vec<(f64, f64)> = south.into_iter().chain([(10.0, 8.0), (0.0, 8.0)]).collect();
    let model = closed(&[facet(&[&outline], 5.0, 0.0, 0.0)]);
    let solid = &model.buildings[0].solid;
    for face in solid.faces.iter().filter(|f| f.surface == Surface::Wall) {
        let ring: Vec<_> = face.rings[0]
            .iter()
            .map(|&c| solid.vertices[c as usize].xy())
            .collect();
        let far = |from: Point2<f64>| {
            let apart = |p: &Point2<f64>| (p - from).norm();
            *ring
                .iter()
                .max_by(|p, q| apart(p).total_cmp(&apart(q)))
                .unwrap()
        };
        let start = far(ring[0]);
        let along = (far(start) - start).normalize();
        for [p, q] in sides(&ring) {
            let d = q - p;
            assert!(d.perp(&along).abs() <= 0.2 * d.norm(), "{p} to {q}");
        }
    }
}

#[test]
fn four_roofs_high_and_low_around_a_corner_are_a_manifold() {
    let model = closed(&[
        rectangle(0.0, 0.0, 3.0, 3.0, 8.0, 0.0, 0.0),
        rectangle(3.0, 0.0, 6.0, 3.0, 4.0, 0.0, 0.0),
        rectangle(3.0, 3.0, 6.0, 6.0, 9.0, 0.0, 0.0),
        rectangle(0.0, 3.0, 3.0, 6.0, 5.0, 0.0, 0.0),
    ]);
    assert!((model.buildings[0].solid.volume() - 9.0 * 26.0).abs() < 1e-9);
}

#[test]
fn a_low_roof_around_two_high_ones_that_touch_in_a_corner_is_a_manifold() {
    let model = closed(&[
        rectangle(7.0, 3.0, 11.0, 4.0, 42.0, 0.0, 0.0),
        rectangle(9.0, 1.0, 14.0, 6.0, 30.0, 0.0, 0.0),
        rectangle(11.0, 2.0, 12.0, 3.0, 37.0, 0.0, 0.0),
    ]);
    let volume = 4.0 * 42.0 + 22.0 * 30.0 + 37.0;
    assert!((model.buildings[0].solid.volume() - volume).abs() < 1e-6);
}

#[test]
fn the_higher_of_two_overlapping_facets_stays_whole() {
    let model = closed(&[
        rectangle(0.0, 0.0, 10.0, 10.0, 5.0, 0.0, 0.0),
        rectangle(4.0, 4.0, 6.0, 6.0, 7.0, 0.0, 0.0),
    ]);
    assert_eq!(model.facets[0].holes.len(), 1);
    assert!((model.buildings[0].solid.volume() - (96.0 * 5.0 + 4.0 * 7.0)).abs() < 1e-6);
}

#[test]
fn an_outline_that_folds_over_loses_the_fold_only() {
    // The last corner lies beyond the first side: a triangle of 4 x 4 / 2 and a fold, turned
    // inside out.
    let folded = facet(
        &[&[(30.0, 0.0), (34.0, 0.0), (34.0, 4.0), (33.0, -1.0)]],
        5.0,
        0.0,
        0.0,
    );
    let (model, trace) = close_buildings(&[folded], |_| 0.0);
    assert_eq!(trace.rejected, []);
    assert_eq!(check_invariants(&model), []);
    // Sides (34, 4) - (33, -1) and (30, 0) - (34, 0) cross at x = 33.2.
    assert!((model.buildings[0].solid.volume() - 5.0 * 0.5 * 0.8 * 4.0).abs() < 1e-3);
}

#[test]
fn an_outline_that_runs_along_itself_keeps_its_area() {
    // Around a square and then, along the same first side, around a triangle inside it.
    let (a, b) = ((0.0, 0.0), (4.0, 0.0));
    let twice = facet(
        &[&[a, b, (4.0, 4.0), (0.0, 4.0), a, b, (2.0, 2.0)]],
        5.0,
        0.0,
        0.0,
    );
    let beside = rectangle(4.0, 0.0, 8.0, 4.0, 5.0, 0.0, 0.0);
    let (model, trace) = close_buildings(&[twice, beside], |_| 0.0);
    assert_eq!(trace.rejected, []);
    assert_eq!(check_invariants(&model), []);
    assert!((model.buildings[0].solid.volume() - 5.0 * 32.0).abs() < 1e-6);
}

#[test]
fn hopeless_facets_are_rejected_with_a_reason() {
    let mut nan = rectangle(0.0, 0.0, 4.0, 4.0, 5.0, 0.0, 0.0);
    nan.outer[1].x = f64::NAN;
    let steep = rectangle(10.0, 0.0, 14.0, 4.0, 5.0, 50.0, 0.0);
    let sliver = rectangle(20.0, 0.0, 24.0, 1e-4, 5.0, 0.0, 0.0);
    let (model, trace) = close_buildings(&[nan, steep, sliver], |_| 0.0);
    assert!(model.buildings.is_empty() && model.facets.is_empty());
    let reasons: Vec<_> = trace.rejected.iter().map(|r| r.1).collect();
    assert_eq!(
        reasons,
        [
            SolidRejection::NoOutline,
            SolidRejection::TooSteep,
            SolidRejection::TooSmall
        ]
    );
}

#[test]
fn a_ground_above_the_eave_is_lowered_and_reported() {
    let roof = [rectangle(0.0, 0.0, 4.0, 4.0, 5.0, 0.0, 0.0)];
    for wrong in [6.0, f64::NAN] {
        let (model, trace) = close_buildings(&roof, |_| wrong);
        assert_eq!(trace.ground_lowered, [BuildingId(0)]);
        assert_eq!(model.buildings[0].ground_z, 4.5);
        assert_eq!(check_invariants(&model), []);
    }
}

#[test]
fn broken_models_are_noticed() {
    let good = closed(&[
        rectangle(0.0, 0.0, 10.0, 4.0, 5.0, 0.0, 0.5),
        rectangle(0.0, 4.0, 10.0, 8.0, 9.0, 0.0, -0.5),
    ]);
    let broken = |change: fn(&mut RoofModel)| {
        let mut model = good.clone();
        change(&mut model);
        check_invariants(&model)
    };
    use Violation as V;
    let found = broken(|m| drop(m.buildings[0].solid.faces.pop()));
    assert!(found.iter().any(|v| matches!(v, V::SolidNotClosed { .. })));
    let found = broken(|m| {
        for ring in m.buildings[0]
            .solid
            .faces
            .iter_mut()
            .flat_map(|f| &mut f.rings)
        {
            ring.reverse();
        }
    });
    assert!(found.iter().any(|v| matches!(v, V::InsideOut { .. })));
    assert!(found.iter().any(|v| matches!(v, V::FaceDirection { .. })));
    let found = broken(|m| m.buildings[0].solid.vertices[0].z += 0.5);
    assert!(found.iter().any(|v| matches!(v, V::FaceNotPlanar { .. })));
    let found = broken(|m| m.facets[0].outer[0].z += 0.5);
    assert!(found.iter().any(|v| matches!(v, V::FacetNotPlanar { .. })));
    let found = broken(|m| m.facets[0].outer.swap(0, 1));
    assert!(
        found
            .iter()
            .any(|v| matches!(v, V::FacetRingNotSimple { .. }))
    );
    let found = broken(|m| m.facets[0].outer.reverse());
    assert!(
        found
            .iter()
            .any(|v| matches!(v, V::FacetRingOrientation { .. }))
    );
    let found = broken(|m| m.facets[1] = m.facets[0].clone());
    assert!(found.iter().any(|v| matches!(v, V::FacetsOverlap { .. })));
    let found = broken(|m| m.buildings[0].facets.truncate(1));
    assert!(found.iter().any(|v| matches!(v, V::Membership { .. })));
    let found = broken(|m| m.facets[0].plane.normal *= -1.0);
    assert!(found.iter().any(|v| matches!(v, V::FacetPlane { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Any patchwork of rectangles of any heights and slopes, overlapping at will, closes.
    #[test]
    fn patchworks_close(
        patches in prop::collection::vec(
            (0..12i32, 0..12i32, 1..6i32, 1..6i32, 30..60i32, -2..3i32, -2..3i32, 0.0..1.0f64),
            1..12,
        ),
    ) {
        let facets: Vec<_> = patches
            .iter()
            .map(|&(x, y, w, h, z, gx, gy, jitter)| {
                // Some outlines lie on a common grid, some next to it.
                let x = f64::from(x) + if jitter > 0.7 { jitter } else { 0.0 };
                let (y, w, h) = (f64::from(y), f64::from(w), f64::from(h));
                let (gx, gy) = (f64::from(gx) * 0.25, f64::from(gy) * 0.25);
                rectangle(x, y, x + w, y + h, f64::from(z), gx, gy)
            })
            .collect();
        let (model, trace) = close_buildings(&facets, |_| 0.0);
        prop_assert_eq!(check_invariants(&model), []);
        prop_assert!(trace.rejected.iter().all(|r| r.1 == SolidRejection::TooSmall), "{:?}", trace);
        prop_assert!(!model.buildings.is_empty());
    }
}
