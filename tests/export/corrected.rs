//! Files of anybody, corrected by hand: what no correction is about keeps its bytes.

use nalgebra::{Point2, Point3, Vector3};
use ridgeline::base::params::{Correction, FacetPlace, Params};
use ridgeline::pipeline::Run;
use ridgeline::results::export::ReportedModel;
use ridgeline::results::roof_report::SetbackRule;
use ridgeline::roofs::model::Obstruction;
use serde_json::Value;

use crate::planted::{ORIGIN, files_of, scene};
use crate::report::known_models;

/// Two boxes of 10 x 10 x 6 m, 30 m apart, written as no program of ours writes; the second is the
/// part of a building and has another geometry.
const FOREIGN: &str = r#"{
 "vertices" : [ [0,0,0],[1000,0,0], [1000,1000,0],[0,1000,0],[0,0,600],[1000,0,600],[1000,1000,600],[0,1000,600],
   [4000,0,0],[5000,0,0],[5000,1000,0],[4000,1000,0],[4000,0,600],[5000,0,600],[5000,1000,600],[4000,1000,600] ],
 "+surveyor": {"name": "Ann\u00e9", "number": 1.50e2},
 "type":"CityJSON","version":"1.1",
 "transform":{"translate":[432100.0,5412300.0,112],"scale":[0.01,0.01,0.01]},
 "CityObjects":{
  "tree":{"type":"SolitaryVegetationObject","geometry":[]},
  "b\u002d1":{"geometry":[{"type":"Solid","lod":2,"semantics":{"values":[[0,1,2,2,2,2]],
     "surfaces":[{"type":"GroundSurface"},{"cover":"tiles","type":"RoofSurface"},{"type":"WallSurface"}]},
     "boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]}],
     "attributes":{"year" : 1.950e3, "owner":"Bob"},"type":"Building"},
  "b-2":{"type":"BuildingPart","parents":["b"],"attributes":{"year":1960,"volume": 600},
     "geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[8,9,10,11]]]},{"type":"Solid","lod":"2.2",
     "semantics":{"values":[[0,1,2,2,2,2]],
     "surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"}]},
     "boundaries":[[[[8,11,10,9]],[[12,13,14,15]],[[8,9,13,12]],[[9,10,14,13]],[[10,11,15,14]],[[11,8,12,15]]]]}]}
 }
}
"#;

fn corrected(text: &str, corrections: &[Correction]) -> String {
    let params = Params {
        corrections: corrections.to_vec(),
        ..Params::default()
    };
    let mut run = Run::of_model(text.into(), params).unwrap();
    run.run_all();
    let trace = &run.results().corrections.as_ref().unwrap().trace;
    assert_eq!(trace.outcomes, vec![None; corrections.len()]);
    let (_, bytes) = (run.files(&[]).into_iter())
        .find(|(name, _)| name == "model.city.json")
        .unwrap();
    String::from_utf8(bytes).unwrap()
}

fn in_world([x, y, z]: [f64; 3]) -> Point3<f64> {
    Point3::new(432_100.0 + x, 5_412_300.0 + y, 112.0 + z)
}

fn numbers(text: &str) -> Value {
    let read = ReportedModel::read(text.as_bytes()).unwrap();
    let files = read.files(&SetbackRule::built_in());
    let roofs = files.iter().find(|(name, _)| name == "roofs.json").unwrap();
    serde_json::from_slice(&roofs.1).unwrap()
}

#[test]
fn without_a_correction_every_byte_stays() {
    assert_eq!(corrected(FOREIGN, &[]), FOREIGN);
    for (_, model, _) in known_models() {
        let file = &files_of(&scene(), &model)["model.city.json"];
        let text = std::str::from_utf8(file).unwrap();
        assert_eq!(corrected(text, &[]), text);
    }
}

#[test]
fn another_eave_changes_one_solid_and_appends_vertices() {
    let eave = Correction::SetEave {
        building: in_world([5.0, 5.0, 6.0]),
        height: 112.0 + 7.25,
    };
    let text = corrected(FOREIGN, &[eave]);
    // All before the solid, all between it and the end of the list of vertices.
    let solid = FOREIGN.find(r#"{"type":"Solid","lod":2"#).unwrap();
    let attributes = FOREIGN
        .find(
            r#"],
     "attributes":{"year" : 1.950e3"#,
        )
        .unwrap();
    let listed = FOREIGN
        .find(
            r#" ],
 "+surveyor""#,
        )
        .unwrap();
    assert!(text.starts_with(&FOREIGN[..listed]));
    assert!(text.contains(&FOREIGN[listed + 1..solid]));
    assert!(text.ends_with(&FOREIGN[attributes..]));
    assert_eq!(text.matches("[0,0,725]").count(), 1);
    let json: Value = serde_json::from_str(&text).unwrap();
    let geometry = &json["CityObjects"]["b-1"]["geometry"];
    assert_eq!(geometry.as_array().unwrap().len(), 1);
    assert_eq!(geometry[0]["lod"], 2);
    let surfaces = geometry[0]["semantics"]["surfaces"].as_array().unwrap();
    assert!(
        surfaces.iter().any(|s| s["cover"] == "tiles"),
        "{surfaces:?}"
    );
    let roofs = numbers(&text);
    for (building, height) in [(0, 7.25), (1, 6.0)] {
        let face = &roofs["buildings"][building]["roofSegmentStats"][0];
        let found = face["planeHeightAtCenterMeters"].as_f64().unwrap();
        assert!((found - 112.0 - height).abs() < 1e-6, "{found}");
    }
}

#[test]
fn a_deleted_building_keeps_its_attributes_and_an_added_one_is_there() {
    let corners = [[20.0, 0.0], [26.0, 0.0], [26.0, 4.0], [20.0, 4.0]];
    let text = corrected(
        FOREIGN,
        &[
            Correction::DeleteBuilding {
                building: in_world([45.0, 5.0, 6.0]),
            },
            Correction::AddFacet {
                outline: corners.map(|[x, y]| in_world([x, y, 3.0])).into(),
            },
        ],
    );
    let json: Value = serde_json::from_str(&text).unwrap();
    let deleted = &json["CityObjects"]["b-2"];
    assert_eq!(deleted["geometry"], serde_json::json!([]));
    assert_eq!(deleted["attributes"]["year"], 1960);
    let roofs = numbers(&text);
    let names: Vec<&str> = (roofs["buildings"].as_array().unwrap().iter())
        .map(|b| b["name"].as_str().unwrap_or_else(|| panic!("{b}")))
        .collect();
    assert_eq!(names, ["b-1", "added-1"]);
}

#[test]
fn what_was_said_of_another_shape_goes_and_the_rest_of_a_model_stays() {
    let (_, model, _) = known_models().remove(0);
    let file = &files_of(&scene(), &model)["model.city.json"];
    let text = std::str::from_utf8(file).unwrap();
    let facet = &model.facets[0];
    let middle =
        facet.outer.iter().map(|p| p.coords).sum::<Vector3<f64>>() / facet.outer.len() as f64;
    let steeper = Correction::SetSlope {
        facet: FacetPlace {
            at: (middle + ORIGIN).into(),
            normal: facet.plane.normal,
        },
        slope_deg: 30.0,
    };
    let after: Value = serde_json::from_str(&corrected(text, &[steeper])).unwrap();
    let before: Value = serde_json::from_str(text).unwrap();
    assert_eq!(after["metadata"], before["metadata"]);
    let building = &after["CityObjects"]["building-1"];
    assert_eq!(building["attributes"]["roofArea"], Value::Null);
    assert_eq!(
        building["attributes"]["groundHeight"],
        before["CityObjects"]["building-1"]["attributes"]["groundHeight"]
    );
    let surfaces = building["geometry"][0]["semantics"]["surfaces"].as_array();
    let roofs: Vec<&Value> = (surfaces.unwrap().iter())
        .filter(|surface| surface["type"] == "RoofSurface")
        .collect();
    assert_eq!(roofs.len(), model.facets.len());
    assert!(roofs.iter().all(|roof| roof["probability"].is_number()));
    assert!(roofs.iter().any(|roof| roof["slopeDeg"].is_null()));
}

#[test]
fn of_what_stands_on_a_face_the_rest_stays() {
    let (_, mut model, _) = known_models().remove(0);
    let box_at = |x: f64| Obstruction {
        outline: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(dx, dy)| Point2::new(x + dx, 1.0 + dy))
            .into(),
        height_m: 1.25,
        height_sigma_m: Some(0.5),
        probability: 0.75,
    };
    model.facets[0].obstructions = vec![box_at(2.0), box_at(5.0)];
    let file = &files_of(&scene(), &model)["model.city.json"];
    let text = std::str::from_utf8(file).unwrap();
    let delete = Correction::DeleteObstruction {
        at: Point3::new(2.5, 1.5, 0.0) + ORIGIN,
    };
    let after: Value = serde_json::from_str(&corrected(text, &[delete])).unwrap();
    let before: Value = serde_json::from_str(text).unwrap();
    let face = |json: &Value| -> Value {
        let surfaces = &json["CityObjects"]["building-1"]["geometry"][0]["semantics"]["surfaces"];
        let all = surfaces.as_array().unwrap();
        all.iter()
            .find(|s| s["obstructions"].is_array())
            .unwrap()
            .clone()
    };
    let (mut expected, found) = (face(&before), face(&after));
    expected["obstructions"].as_array_mut().unwrap().remove(0);
    assert_eq!(found, expected);
}

#[test]
fn what_holds_a_building_a_line_is_written_anew_and_what_is_no_model_is_refused() {
    let files = files_of(&scene(), &known_models().remove(0).1);
    let lines = std::str::from_utf8(&files["model.city.jsonl"]).unwrap();
    let again = corrected(lines, &[]);
    let names = |text: &str| -> Vec<String> {
        let roofs = numbers(text);
        let all = roofs["buildings"].as_array().unwrap().iter();
        all.map(|b| b["name"].as_str().unwrap().to_owned())
            .collect()
    };
    assert_eq!(names(&again), names(lines));
    for file in [&b"{}"[..], b""] {
        let refused = Run::of_model(file.to_vec(), Params::default());
        assert!(refused.err().unwrap().contains("is no CityJSON"));
    }
}
