//! 3D Tiles.

use libm::{cos, sin};
use nalgebra::{Matrix4, Point3, Vector3};
use ridgeline::model::RoofModel;
use ridgeline::orientation::Anchor;
use ridgeline::scene::Scene;
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
