//! Overhangs whose volumes are known, and patchworks of roofs that must close or stay as they are.

use proptest::prelude::*;

use super::*;
use crate::roofs::buildings::gable;
use crate::roofs::model::{RoofModel, check_invariants};
use crate::roofs::solids::{close_buildings, outline_sides};
use crate::roofs::testing::facet;

/// The only building of some facets with its walls at the depths, or not.
fn walled(facets: &[Facet], depth: impl Fn(&Side) -> f64, ground: &Plane) -> Option<RoofModel> {
    let (mut model, _) = close_buildings(facets, |_| 0.0);
    let building = &model.buildings[0];
    let members: Vec<(FacetId, &Facet)> = (building.facets.iter())
        .map(|f| (*f, &model.facets[f.index()]))
        .collect();
    let sides = outline_sides(&members.iter().map(|(_, f)| *f).collect::<Vec<_>>());
    let depths: Vec<f64> = sides.iter().map(depth).collect();
    let solid = close_below_overhangs(&members, &sides, &depths, ground)?;
    model.buildings.truncate(1);
    model.buildings[0].solid = solid;
    model.facets.truncate(model.buildings[0].facets.len());
    Some(model)
}

fn count(model: &RoofModel, surface: Surface) -> usize {
    let faces = model.buildings[0].solid.faces.iter();
    faces.filter(|f| f.surface == surface).count()
}

#[test]
fn a_gable_house_has_its_walls_inside_the_eaves() {
    let depth = |side: &Side| if side.is_level() { 0.6 } else { 0.3 };
    let model = walled(&gable(), depth, &Plane::level(0.0)).unwrap();
    assert_eq!(check_invariants(&model), []);
    // 12 m by 8 m below 9 m - 0.75 |y|; walls around 11.4 m by 6.8 m.
    let inside = 11.4 * 2.0 * (9.0 * 3.4 - 0.375 * 3.4 * 3.4);
    let rim = (12.0 * 8.0 - 11.4 * 6.8) * RIM_M;
    let volume = model.buildings[0].solid.volume();
    assert!((volume - inside - rim).abs() < 1e-6, "{volume}");
    assert_eq!(count(&model, Surface::Wall), 4 + 4, "walls and the rim");
    assert_eq!(count(&model, Surface::Ground), 1);
    assert_eq!(count(&model, Surface::Ceiling), 2);
}

#[test]
fn without_overhang_it_is_the_solid_as_it_was() {
    let model = walled(&gable(), |_| 0.0, &Plane::level(0.0)).unwrap();
    let (plain, _) = close_buildings(&gable(), |_| 0.0);
    let volumes = [&model, &plain].map(|m| m.buildings[0].solid.volume());
    assert!((volumes[0] - volumes[1]).abs() < 1e-9);
    assert_eq!(count(&model, Surface::Ceiling), 0);
    assert_eq!(count(&model, Surface::Wall), 4);
}

#[test]
fn feet_follow_sloping_ground() {
    let slope = nalgebra::Vector3::new(-0.1, 0.05, 1.0);
    let ground = Plane::from_point_normal(&Point3::new(0.0, 0.0, 1.0), &slope).unwrap();
    let model = walled(&gable(), |_| 0.5, &ground).unwrap();
    assert_eq!(check_invariants(&model), []);
    let solid = &model.buildings[0].solid;
    let foot = solid.faces.iter().find(|f| f.surface == Surface::Ground);
    for corner in &foot.unwrap().rings[0] {
        let p = solid.vertices[*corner as usize];
        assert!((p.z - ground.z_at(p.x, p.y)).abs() < 1e-9);
    }
    // The plane is 1 m below the middle on average.
    let inside = 11.0 * 2.0 * (8.0 * 3.5 - 0.375 * 3.5 * 3.5);
    let rim = (12.0 * 8.0 - 11.0 * 7.0) * RIM_M;
    assert!((solid.volume() - inside - rim).abs() < 1e-6);
    let above_the_eave = Plane::level(6.5);
    assert!(walled(&gable(), |_| 0.5, &above_the_eave).is_none());
}

/// An L of two flat roofs of different heights: a step, and a corner that turns in.
#[test]
fn a_lower_wing_and_its_inner_corner() {
    let rectangle = |[x0, y0, x1, y1]: [f64; 4], z: f64| {
        facet(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| Point3::new(x, y, z)))
    };
    let facets = [
        rectangle([0.0, 0.0, 10.0, 6.0], 6.0),
        rectangle([6.0, 6.0, 10.0, 11.0], 4.0),
    ];
    let model = walled(&facets, |_| 0.5, &Plane::level(0.0)).unwrap();
    assert_eq!(check_invariants(&model), []);
    // The inner corner moves to (6.5, 5.5).
    let high = 9.0 * 5.0 + 3.0 * 0.5;
    let low = 3.0 * 4.5;
    let rim = (60.0 - high + 20.0 - low) * RIM_M;
    let volume = model.buildings[0].solid.volume();
    assert!(
        (volume - 6.0 * high - 4.0 * low - rim).abs() < 1e-6,
        "{volume}"
    );
}

/// The corner of two walls is a hair beside the hip between their roofs: no edge of a millimetre,
/// at whose ends the two roofs have different heights, bends them.
#[test]
fn a_corner_beside_a_hip_is_put_onto_it() {
    let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    // Slopes of 1 and 1, eaves at 4 m around 12 m by 8 m.
    let hip = [
        facet(&[
            at(0.0, 0.0, 4.0),
            at(12.0, 0.0, 4.0),
            at(8.0, 4.0, 8.0),
            at(4.0, 4.0, 8.0),
        ]),
        facet(&[at(12.0, 0.0, 4.0), at(12.0, 8.0, 4.0), at(8.0, 4.0, 8.0)]),
        facet(&[
            at(12.0, 8.0, 4.0),
            at(0.0, 8.0, 4.0),
            at(4.0, 4.0, 8.0),
            at(8.0, 4.0, 8.0),
        ]),
        facet(&[at(0.0, 8.0, 4.0), at(0.0, 0.0, 4.0), at(4.0, 4.0, 8.0)]),
    ];
    for hair in [0.0, 0.0009, 0.0013, 0.002, 0.005, 0.012, 0.05] {
        let depth = |side: &Side| {
            0.5 + if side.along().x.abs() > 0.5 {
                hair
            } else {
                0.0
            }
        };
        let model = walled(&hip, depth, &Plane::level(0.0)).unwrap();
        assert_eq!(check_invariants(&model), []);
        let solid = &model.buildings[0].solid;
        let corners = || solid.vertices.iter().enumerate();
        let shortest = corners()
            .flat_map(|(i, p)| corners().take(i).map(move |(_, q)| (p - q).xy().norm()))
            .filter(|d| *d > 0.0)
            .fold(f64::INFINITY, f64::min);
        assert!(shortest > 0.01, "{hair}: {shortest}");
    }
}

/// Bands leave a strip of 4 cm that touches the rest in a point: no house stands on it.
#[test]
fn a_strip_beside_the_footprint_carries_no_roof() {
    let at = |x: f64, y: f64| Point3::new(x, y, 5.0);
    // A nib of 1.04 m, whose west side continues the step of the wall to its north.
    let corners = [
        [0.0, 0.0],
        [10.0, 0.0],
        [10.0, 8.0],
        [6.54, 8.0],
        [6.54, 11.0],
        [5.5, 11.0],
        [5.5, 8.0],
        [0.0, 8.0],
    ];
    let roof = [facet(&corners.map(|[x, y]| at(x, y)))];
    let model = walled(&roof, |_| 0.5, &Plane::level(0.0)).unwrap();
    assert_eq!(check_invariants(&model), []);
    assert_eq!(count(&model, Surface::Ground), 1);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Any patchwork of sloping rectangles with walls anywhere closes soundly, or not at all.
    #[test]
    fn patchworks_close_or_stay(
        patches in prop::collection::vec(
            (0..12i32, 0..12i32, 2..7i32, 2..7i32, 4..8i32, -2..3i32, -2..3i32),
            1..5,
        ),
        depths in prop::collection::vec(0..4usize, 4),
    ) {
        let facets: Vec<Facet> = patches.iter().map(|&(x, y, w, h, z, gx, gy)| {
            let [x, y, w, h, z] = [x, y, w, h, z].map(f64::from);
            let (gx, gy) = (f64::from(gx) * 0.1, f64::from(gy) * 0.1);
            let at = |dx: f64, dy: f64| Point3::new(x + dx, y + dy, z + gx * dx + gy * dy);
            facet(&[at(0.0, 0.0), at(w, 0.0), at(w, h), at(0.0, h)])
        }).collect();
        let of = |side: &Side| {
            let u = side.along();
            let quarter = if u.x.abs() > u.y.abs() { u.x > 0.0 } else { u.y > 0.0 };
            [0.0, 0.3, 0.55, 0.9][depths[usize::from(quarter) + 2 * usize::from(u.x.abs() > 0.5)]]
        };
        if let Some(model) = walled(&facets, of, &Plane::level(0.0)) {
            prop_assert_eq!(check_invariants(&model), []);
        }
    }
}
