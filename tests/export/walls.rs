//! Walls inside the eaves: a second solid of each building, and what the report says of it.

use nalgebra::{Point3, Vector3};
use proptest::prelude::*;
use ridgeline::base::geometry::{Plane, Segment3};
use ridgeline::roofs::model::{BuildingWalls, Facet, RoofModel, Solid, Wall};
use ridgeline::roofs::solids::{Side, close_below_overhangs, close_buildings, outline_sides};
use serde_json::{Value, json};

use crate::planted::{files_of_walled, planted_models, quad, scene};
use crate::solid_checks::solid_errors;

/// The sides of a building, and its solid with its walls at these depths on ground that slopes.
fn sides_and_solid(
    model: &RoofModel,
    building: usize,
    depth: impl Fn(&Side) -> f64,
) -> (Vec<Side>, Option<Solid>) {
    let members: Vec<_> = (model.buildings[building].facets.iter())
        .map(|f| (*f, &model.facets[f.index()]))
        .collect();
    let sides = outline_sides(&members.iter().map(|(_, f)| *f).collect::<Vec<_>>());
    let depths: Vec<f64> = sides.iter().map(depth).collect();
    let slope = Vector3::new(-0.03, 0.05, 1.0);
    let ground = Plane::from_point_normal(&Point3::new(0.0, 0.0, -1.0), &slope).unwrap();
    let solid = close_below_overhangs(&members, &sides, &depths, &ground);
    (sides, solid)
}

/// The walls of the only building at these depths, the odd ones seen.
pub fn walls_at(model: &RoofModel, depth: impl Fn(&Side) -> f64) -> BuildingWalls {
    let (sides, solid) = sides_and_solid(model, 0, &depth);
    let wall = |(i, side): (usize, &Side)| Wall {
        side: Segment3::new(side.start(), side.end()),
        depth_m: depth(side),
        seen: i % 2 == 1,
        probability: Some(0.75),
        sigma_m: (i % 2 == 1).then_some(0.05),
    };
    BuildingWalls {
        walls: sides.iter().enumerate().map(wall).collect(),
        volume_m3: Some(123.4),
        solid: Some(solid.unwrap()),
    }
}

#[test]
fn solids_with_walls_inside_the_eaves_are_valid() {
    for (name, model, _) in planted_models() {
        let walls = walls_at(&model, |side| if side.is_level() { 0.6 } else { 0.35 });
        let files = files_of_walled(&scene(), &model, &[walls]);
        let text = std::str::from_utf8(&files["model.city.json"]).unwrap();
        for (criterion, summary) in cjval::CJValidator::from_str(text).validate() {
            assert!(!summary.has_errors(), "{name}, {criterion}: {summary}");
        }
        let city: Value = serde_json::from_str(text).unwrap();
        let geometry = city["CityObjects"]["building-1"]["geometry"].as_array();
        let lods: Vec<_> = geometry.unwrap().iter().map(|g| &g["lod"]).collect();
        assert_eq!(lods, ["2.2", "2.3"], "{name}");
        for (solid, errors) in solid_errors(&city) {
            assert!(errors.is_empty(), "{name}: {solid}: {errors:?}");
        }
    }
}

#[test]
fn the_report_states_walls_and_the_volume_within() {
    let (_, model, _) = planted_models().remove(0);
    let files = files_of_walled(&scene(), &model, &[walls_at(&model, |_| 0.5)]);
    let page = String::from_utf8_lossy(&files["roof_report.html"]);
    for cell in ["<td>2 of 4</td>", "<span class=\"m\">123</span>"] {
        assert!(page.contains(cell), "{cell}: {page}");
    }
}

/// Hips and valleys meet the mitres of walls whose depths differ by a hair.
#[test]
fn mitres_a_hair_beside_a_hip_do_not_bend_faces() {
    let (_, model, _) = planted_models().remove(1);
    for hair in [0.0003, 0.0008, 0.0012, 0.003, 0.01, 0.02, 0.05] {
        let depth = |side: &Side| 0.6 + hair * (1.0 + side.along().x);
        let files = files_of_walled(&scene(), &model, &[walls_at(&model, depth)]);
        let city: Value = serde_json::from_slice(&files["model.city.json"]).unwrap();
        let errors = &solid_errors(&city)["building-1"];
        assert!(errors.is_empty(), "{hair}: {errors:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Any patchwork of sloping rectangles, turned, with walls anywhere, makes a solid that is
    /// sound in a file, or none.
    #[test]
    fn patchworks_are_sound_in_files(
        patches in prop::collection::vec(
            (0..12i32, 0..12i32, 2..7i32, 2..7i32, 4..8i32, -2..3i32, -2..3i32),
            1..5,
        ),
        depths in prop::collection::vec(0..6usize, 4),
        cos in 0.0..1.0f64,
    ) {
        let sin = (1.0 - cos * cos).sqrt();
        let facets: Vec<Facet> = patches.iter().map(|&(x, y, w, h, z, gx, gy)| {
            let [x, y, w, h, z] = [x, y, w, h, z].map(f64::from);
            let (gx, gy) = (f64::from(gx) * 0.2, f64::from(gy) * 0.2);
            let at = |x: f64, y: f64| (cos * x - sin * y, sin * x + cos * y);
            let ring = [at(x, y), at(x + w, y), at(x + w, y + h), at(x, y + h)];
            quad(ring, [z, cos * gx - sin * gy, sin * gx + cos * gy])
        }).collect();
        let (model, _) = close_buildings(&facets, |_| -10.0);
        for building in 0..model.buildings.len() {
            let depth = |side: &Side| {
                let u = side.along();
                let (x, y) = (cos * u.x + sin * u.y, cos * u.y - sin * u.x);
                let quarter = if x.abs() > y.abs() { x > 0.0 } else { y > 0.0 };
                let i = usize::from(quarter) + 2 * usize::from(x.abs() > 0.5);
                [0.0, 0.3, 0.3012, 0.55, 0.9, 0.981][depths[i]]
            };
            if let (_, Some(solid)) = sides_and_solid(&model, building, depth) {
                let errors = solid_errors(&city_of(&solid));
                prop_assert!(errors["a"].is_empty(), "{:?}", errors);
            }
        }
    }
}

/// A file with a solid alone.
fn city_of(solid: &Solid) -> Value {
    let whole = |p: &Point3<f64>| [p.x, p.y, p.z].map(|c| (c * 1e4).round() as i64);
    let faces: Vec<_> = solid.faces.iter().map(|f| &f.rings).collect();
    json!({
        "transform": { "scale": [1e-4, 1e-4, 1e-4] },
        "vertices": solid.vertices.iter().map(whole).collect::<Vec<_>>(),
        "CityObjects": { "a": { "geometry": [{ "boundaries": [faces] }] } },
    })
}
