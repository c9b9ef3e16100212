//! 3D Tiles.

use libm::{cos, sin};
use nalgebra::{Matrix4, Point3, Vector3};
use ridgeline::orienting::orientation::Anchor;
use ridgeline::orienting::scene::Scene;
use ridgeline::results::export::{SquareContent, tileset_of_squares};
use ridgeline::roofs::model::RoofModel;
use serde_json::Value;

use crate::planted::{ORIGIN, files_of, planted_models, scene};

fn tileset_of(scene: &Scene, model: &RoofModel) -> Value {
    serde_json::from_slice(&files_of(scene, model)["tileset.json"]).unwrap()
}

fn transform_of(tileset: &Value) -> Matrix4<f64> {
    let numbers = tileset["root"]["transform"].as_array().unwrap();
    Matrix4::from_iterator(numbers.iter().map(|n| n.as_f64().unwrap()))
}

#[test]
fn a_grid_is_placed_within_a_centimetre_of_proj() {
    let (_, model, _) = planted_models().remove(0);
    let mut scene = scene();
    scene.survey.epsg = Some(25832);
    let transform = transform_of(&tileset_of(&scene, &model));
    // Of PROJ 9 (pyproj): EPSG:25832 with ellipsoidal heights to EPSG:4978, about `ORIGIN`.
    for (local, geocentric) in PROJ {
        let found = transform.transform_point(&Point3::from(local));
        let off = (found - Point3::from(geocentric)).norm();
        assert!(off < 0.01, "{local:?}: {off} m off");
    }
    // East on the grid is not east on the Earth: meridians converge, and 1 m is 0.99966 m.
    let east = transform.transform_vector(&Vector3::x());
    assert!((east.norm() - 1.000_343).abs() < 2e-5, "{}", east.norm());
}

#[test]
fn a_local_frame_on_the_earth_is_placed_exactly() {
    let (_, model, _) = planted_models().remove(0);
    let mut scene = scene();
    scene.origin = Vector3::zeros();
    let (lon_deg, lat_deg, height_m) = (8.073_85, 48.858_72, 123.0);
    scene.survey.anchor = Some(Anchor {
        lon_deg,
        lat_deg,
        height_m,
    });
    let transform = transform_of(&tileset_of(&scene, &model));
    // Of PROJ 9 (pyproj), EPSG:4979 to EPSG:4978.
    let zero = Point3::new(
        4_162_686.573_122_204,
        590_499.809_213_486,
        4_780_329.085_224_726,
    );
    let found = transform.transform_point(&Point3::origin());
    assert!((found - zero).norm() < 1e-4);
    // Up is away from the middle of the Earth, and nothing is enlarged or turned over.
    let up = transform.transform_vector(&Vector3::z());
    let (lon, lat) = (lon_deg.to_radians(), lat_deg.to_radians());
    let normal = Vector3::new(cos(lat) * cos(lon), cos(lat) * sin(lon), sin(lat));
    assert!((up - normal).norm() < 1e-9);
    assert!((transform.fixed_view::<3, 3>(0, 0).determinant() - 1.0).abs() < 1e-9);
}

#[test]
fn the_box_holds_the_content_once_it_is_turned_to_z_up() {
    for (name, model, _) in planted_models() {
        let files = files_of(&scene(), &model);
        let tileset: Value = serde_json::from_slice(&files["tileset.json"]).unwrap();
        assert_eq!(tileset["asset"]["version"], "1.1");
        assert!(tileset["root"].get("transform").is_none());
        assert!(
            tileset["extras"]["placement"]
                .as_str()
                .unwrap()
                .contains("not known")
        );
        assert_eq!(tileset["extras"]["origin"][1], ORIGIN.y);
        let uri = tileset["root"]["content"]["uri"].as_str().unwrap();
        let (document, buffers, _) = gltf::import_slice(&files[uri]).unwrap();
        let of_box = tileset["root"]["boundingVolume"]["box"].as_array().unwrap();
        let number = |i: usize| of_box[i].as_f64().unwrap();
        let mut reached = [false; 6];
        for primitive in document
            .meshes()
            .flat_map(|m| m.primitives().collect::<Vec<_>>())
        {
            let reader = primitive.reader(|buffer| Some(&buffers[buffer.index()]));
            for [x, y, z] in reader.read_positions().unwrap() {
                // As 3D Tiles turns glTF: (x, y, z) becomes (x, -z, y).
                let p = [x, -z, y].map(f64::from);
                for axis in 0..3 {
                    let off = p[axis] - number(axis);
                    let half = number(3 + 4 * axis);
                    assert!(off.abs() <= half + 1e-4, "{name}: {p:?}");
                    reached[2 * axis] |= off > half - 1e-3;
                    reached[2 * axis + 1] |= off < -half + 1e-3;
                }
            }
        }
        assert_eq!(reached, [true; 6], "{name}");
    }
}

#[test]
fn a_model_without_buildings_has_a_tile_without_content() {
    let tileset = tileset_of(&scene(), &RoofModel::default());
    assert!(tileset["root"].get("content").is_none());
    assert!(
        tileset["root"]["boundingVolume"]["box"][3]
            .as_f64()
            .unwrap()
            > 0.0
    );
}

#[test]
fn a_code_that_is_no_known_grid_places_nothing() {
    let (_, model, _) = planted_models().remove(0);
    let mut scene = scene();
    scene.survey.epsg = Some(2056);
    let tileset = tileset_of(&scene, &model);
    assert!(tileset["root"].get("transform").is_none());
    assert_eq!(tileset["extras"]["crs"], "EPSG:2056");
}

const PROJ: [([f64; 3], [f64; 3]); 4] = [
    ([0.0, 0.0, 0.0], [4162500.5021, 590504.0147, 4780326.1851]),
    ([10.0, 8.0, 7.0], [4162497.6130, 590513.6094, 4780336.8015]),
    (
        [200.0, -200.0, 30.0],
        [4162638.9517, 590728.1723, 4780218.7586],
    ),
    (
        [-180.0, 220.0, 5.0],
        [4162366.9690, 590300.5153, 4780473.2818],
    ),
];

/// A tile of a tree: its transform from its own frame to that of the root's parent.
fn visit(tile: &Value, above: &Matrix4<f64>, see: &mut dyn FnMut(&Value, &Matrix4<f64>)) {
    let own = match tile["transform"].as_array() {
        Some(numbers) => Matrix4::from_iterator(numbers.iter().map(|n| n.as_f64().unwrap())),
        None => Matrix4::identity(),
    };
    let placed = above * own;
    see(tile, &placed);
    for child in tile["children"].as_array().into_iter().flatten() {
        visit(child, &placed, see);
    }
}

/// Middle and half the sides of a tile's box.
fn box_of(tile: &Value) -> (Point3<f64>, Vector3<f64>) {
    let numbers = tile["boundingVolume"]["box"].as_array().unwrap();
    let n = |i: usize| numbers[i].as_f64().unwrap();
    (
        Point3::new(n(0), n(1), n(2)),
        Vector3::new(n(3), n(7), n(11)),
    )
}

fn is_in(p: &Point3<f64>, (middle, half): &(Point3<f64>, Vector3<f64>)) -> bool {
    (p - middle)
        .iter()
        .zip(half)
        .all(|(off, half)| off.abs() <= half + 1e-6)
}

#[test]
fn squares_of_a_flight_stand_in_a_tree_and_at_their_places_on_the_earth() {
    let (_, model, _) = planted_models().remove(0);
    // Houses along a flight of 4 km, one square far beside it.
    let places = [[0, 0], [1, 0], [1, 1], [-3, 2], [20, 1], [63, -2], [64, -2]];
    let moved = |[column, row]: [i64; 2]| {
        let mut building = model.buildings[0].clone();
        let by = Vector3::new(60.0 * column as f64, 60.0 * row as f64, row as f64);
        building.solid.vertices.iter_mut().for_each(|p| *p += by);
        building
    };
    let houses = places.map(|place| [moved(place)]);
    let uris = places.map(|[column, row]| format!("square_{column}_{row}.glb"));
    let squares: Vec<SquareContent> = (places.into_iter().zip(&houses).zip(&uris))
        .map(|((place, buildings), uri)| SquareContent {
            place,
            buildings,
            uri,
        })
        .collect();
    for epsg in [Some(25832), None] {
        let mut scene = scene();
        scene.survey.epsg = epsg;
        let tileset: Value = serde_json::from_slice(&tileset_of_squares(&scene, &squares)).unwrap();
        let root = &tileset["root"];
        assert_eq!(root["refine"], "REPLACE");
        assert_eq!(tileset["geometricError"], root["geometricError"]);
        let mut found = Vec::new();
        visit(root, &Matrix4::identity(), &mut |tile, placed| {
            let error = tile["geometricError"].as_f64().unwrap();
            let own = box_of(tile);
            let children = tile["children"].as_array();
            assert_eq!(children.is_none(), tile.get("content").is_some());
            for child in children.into_iter().flatten() {
                assert!(children.unwrap().len() > 1);
                assert!(child["geometricError"].as_f64().unwrap() < error);
                let by = match child["transform"].as_array() {
                    Some(n) => Matrix4::from_iterator(n.iter().map(|n| n.as_f64().unwrap())),
                    None => Matrix4::identity(),
                };
                let (middle, half) = box_of(child);
                for i in 0..8 {
                    let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
                    let signs = Vector3::new(sign(0), sign(1), sign(2));
                    let corner = by.transform_point(&(middle + half.component_mul(&signs)));
                    assert!(is_in(&corner, &own), "{corner} {own:?}");
                }
            }
            if let Some(uri) = tile["content"]["uri"].as_str() {
                assert_eq!(error, 0.0);
                let i = uris.iter().position(|own| own == uri).unwrap();
                found.push(i);
                for p in &houses[i][0].solid.vertices {
                    assert!(is_in(p, &own), "{p}");
                    let there = placed.transform_point(p);
                    let expected = match epsg {
                        Some(_) => scene.survey.geocentric(&(p + scene.origin)).unwrap(),
                        None => *p,
                    };
                    assert!((there - expected).norm() < 1e-3, "{there} {expected}");
                }
            }
        });
        found.sort_unstable();
        assert_eq!(found, [0, 1, 2, 3, 4, 5, 6]);
    }
    let empty: Value = serde_json::from_slice(&tileset_of_squares(&scene(), &[])).unwrap();
    assert!(empty["root"].get("content").is_none() && empty["root"].get("children").is_none());
}
