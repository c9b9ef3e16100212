//! What stands on a roof, in every file that has it.

use nalgebra::{Point2, Vector3};
use ridgeline::results::export::ReportedModel;
use ridgeline::results::roof_report::SetbackRule;
use ridgeline::roofs::model::{Obstruction, RoofModel};
use serde_json::Value;

use crate::planted::{ORIGIN, files_of, scene};
use crate::report::known_models;

/// A chimney of 1.5 m by 1 m in the middle of the southern slope of the gable, which rises by one
/// half: it stands 2 m above the slope, with its top at 8 m.
fn chimney() -> Obstruction {
    let corners = [(4.25, 1.5), (5.75, 1.5), (5.75, 2.5), (4.25, 2.5)];
    Obstruction {
        outline: corners.map(|(x, y)| Point2::new(x, y)).into(),
        height_m: 2.0,
        height_sigma_m: Some(0.123_456),
        probability: 0.876_54,
    }
}

fn gable_with_chimney() -> RoofModel {
    let (_, mut model, _) = known_models().remove(0);
    model.facets[0].obstructions.push(chimney());
    model
}

fn near(value: &Value, wanted: f64) {
    let value = value.as_f64().unwrap();
    assert!((value - wanted).abs() < 1e-3, "{value} for {wanted}");
}

#[test]
fn a_chimney_is_stated_of_its_face_and_is_read_again() {
    let files = files_of(&scene(), &gable_with_chimney());
    let text = std::str::from_utf8(&files["model.city.json"]).unwrap();
    for (criterion, summary) in cjval::CJValidator::from_str(text).validate() {
        assert!(!summary.has_errors(), "{criterion}: {summary}");
    }
    let json: Value = serde_json::from_str(text).unwrap();
    let roof = &json["CityObjects"]["building-1"]["geometry"][0]["semantics"]["surfaces"];
    let roof = roof.as_array().unwrap().iter().find(|s| s["facet"] == 1);
    let found = &roof.unwrap()["obstructions"][0];
    near(&found["height"], 2.0);
    near(&found["outline"][0][0], ORIGIN.x + 4.25);
    near(&found["outline"][0][1], ORIGIN.y + 1.5);
    let again = ReportedModel::read(text.as_bytes()).unwrap();
    for (file, bytes) in again.files(&SetbackRule::built_in()) {
        assert!(files[&file] == bytes, "{file}");
    }
}

#[test]
fn usable_areas_leave_it_out() {
    let [with, without] = [gable_with_chimney(), known_models().remove(0).1];
    let usable = |model: &RoofModel| -> Vec<f64> {
        let file: Value = serde_json::from_slice(&files_of(&scene(), model)["roofs.json"]).unwrap();
        let face = &file["buildings"][0]["roofSegmentStats"][0];
        assert_eq!(
            face["obstructions"].as_array().unwrap().len(),
            model.facets[0].obstructions.len()
        );
        let rules = face["usable"].as_array().unwrap().iter();
        rules
            .map(|of| of["areaMeters2"].as_f64().unwrap())
            .collect()
    };
    // One square metre and a half in plan, on a slope of one half.
    let hidden = 1.5 * 1.25_f64.sqrt();
    for (less, whole) in usable(&with).into_iter().zip(usable(&without)) {
        assert!((whole - less - hidden).abs() < 1e-3, "{whole} {less}");
    }
    let rule = r#"{ "name": "own", "obstruction_m": 0.5, "setbacks_m": {} }"#;
    let own = [SetbackRule::read(rule).unwrap()];
    let files = ReportedModel::of(&scene(), &with, &[]).files(&own);
    let (_, roofs) = files.iter().find(|(name, _)| name == "roofs.json").unwrap();
    let file: Value = serde_json::from_slice(roofs).unwrap();
    let left = &file["buildings"][0]["roofSegmentStats"][0]["usable"][0];
    near(&left["areaMeters2"], (40.0 - 2.5 * 2.0) * 1.25_f64.sqrt());
}

#[test]
fn drawings_maps_and_meshes_have_it() {
    let files = files_of(&scene(), &gable_with_chimney());
    let map: Value = serde_json::from_slice(&files["obstructions.geojson"]).unwrap();
    let [feature] = &map["features"].as_array().unwrap()[..] else {
        panic!("{map}");
    };
    near(&feature["properties"]["height_m"], 2.0);
    near(
        &feature["geometry"]["coordinates"][0][0][0],
        ORIGIN.x + 4.25,
    );

    let drawing = dxf::Drawing::load(&mut &files["model.dxf"][..]).unwrap();
    let layer = |e: &&dxf::entities::Entity| e.common.layer == "OBSTRUCTION";
    assert_eq!(drawing.entities().filter(layer).count(), 10, "triangles");

    let (document, buffers, _) = gltf::import_slice(&files["model.glb"]).unwrap();
    let mesh = document.nodes().find(|n| n.name() == Some("obstructions"));
    let primitive = mesh.unwrap().mesh().unwrap().primitives().next().unwrap();
    assert!(primitive.material().index() == Some(1));
    let reader = primitive.reader(|b| Some(&buffers[b.index()]));
    let corners: Vec<Vector3<f32>> = reader
        .read_positions()
        .unwrap()
        .map(Vector3::from)
        .collect();
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    let area: Vector3<f32> = (indices.chunks_exact(3))
        .map(|t| [t[0], t[1], t[2]].map(|i| corners[i as usize]))
        .map(|[a, b, c]| (b - a).cross(&(c - a)) / 2.0)
        .sum();
    // The sides cancel but for the slope of the base, along y, which is -z there.
    assert!(
        (area - Vector3::new(0.0, 1.5, 0.75)).norm() < 1e-3,
        "{area}"
    );
}
