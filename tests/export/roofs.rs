//! The roofs as JSON: the schema that is published, and places on the Earth.

use ridgeline::orienting::orientation::{Anchor, FrameSigma};
use ridgeline::orienting::scene::{Scene, Survey};
use serde_json::Value;

use crate::planted::{ORIGIN, files_of, scene};
use crate::report::known_models;

/// A scene in UTM zone 32, and one around a place.
fn placed() -> [Scene; 2] {
    let of = |survey: Survey, origin| Scene {
        survey,
        origin,
        ..scene()
    };
    let anchor = Anchor {
        lon_deg: 11.5,
        lat_deg: -33.25,
        height_m: 120.5,
    };
    let utm = Survey {
        epsg: Some(25832),
        ..Survey::default()
    };
    let local = Survey {
        anchor: Some(anchor),
        ..Survey::default()
    };
    [of(utm, ORIGIN), of(local, nalgebra::Vector3::zeros())]
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn every_file_is_as_its_schema_says() {
    let text = include_str!("../../docs/roofs.schema.json");
    let schema = jsonschema::JSONSchema::compile(&serde_json::from_str(text).unwrap()).unwrap();
    let check = |file: &Value| -> Vec<String> {
        let errors = schema.validate(file).err().into_iter().flatten();
        errors
            .map(|e| format!("{}: {e}", e.instance_path))
            .collect()
    };
    let [utm, mut local] = placed();
    local.survey.frame_sigma = Some(FrameSigma {
        length_of_10_m: Some(0.05),
        height_over_10_m: None,
    });
    for scene in [scene(), utm, local] {
        for (name, model, _) in known_models() {
            let bytes = &files_of(&scene, &model)["roofs.json"];
            let mut file: Value = serde_json::from_slice(bytes).unwrap();
            assert_eq!(check(&file), [""; 0], "{name}");
            assert_eq!(
                file["buildings"].as_array().unwrap().len(),
                model.buildings.len()
            );
            file["buildings"][0]["roofSegmentStats"][0]["pitchDegrees"] = "steep".into();
            assert_eq!(check(&file).len(), 1);
        }
    }
}

#[test]
fn faces_have_their_planted_numbers() {
    let (_, model, _) = known_models().remove(0);
    let file: Value = serde_json::from_slice(&files_of(&scene(), &model)["roofs.json"]).unwrap();
    let building = &file["buildings"][0];
    let south = &building["roofSegmentStats"][0];
    let near = |value: &Value, wanted: f64| {
        assert!(
            (number(value) - wanted).abs() < 1e-3,
            "{value} for {wanted}"
        );
    };
    near(&south["pitchDegrees"], 26.565);
    near(&south["azimuthDegrees"], 180.0);
    near(&south["planeHeightAtCenterMeters"], 6.0 + ORIGIN.z);
    near(&south["centerMeters"][0], ORIGIN.x + 5.0);
    near(&south["stats"]["groundAreaMeters2"], 40.0);
    near(&south["stats"]["areaMeters2"], 10.0 * 20f64.sqrt());
    assert_eq!(
        (&south["center"], &south["pvgis"]),
        (&Value::Null, &Value::Null)
    );
    let fire = &south["usable"][1];
    assert_eq!(fire["setbacks"], "ifc-1205");
    near(
        &fire["areaMeters2"],
        (10.0 - 2.0 * 0.914) * (20f64.sqrt() - 0.457),
    );
    // All corners lie on the face.
    for corner in fire["polygons"][0][0].as_array().unwrap() {
        let [y, z] = [1, 2].map(|i| number(&corner[i]) - ORIGIN[i]);
        assert!((z - 5.0 - 0.5 * y).abs() < 1e-3, "{corner}");
    }
    let kinds = building["edges"].as_array().unwrap().iter();
    assert_eq!(kinds.filter(|e| e["class"] == "rake").count(), 4);
}

#[test]
fn a_placed_face_leads_to_its_yield() {
    let (_, model, _) = known_models().remove(1);
    let [utm, local] = placed();
    // Meridian convergence: 0.926 degrees west of the central meridian, times the sine of 48.86.
    let convergence = -0.926 * 0.7531;
    for (scene, turn, [lat, lon]) in [
        (utm, convergence, [48.86, 8.07]),
        (local, 0.0, [-33.25, 11.5]),
    ] {
        let files = files_of(&scene, &model);
        let file: Value = serde_json::from_slice(&files["roofs.json"]).unwrap();
        let faces = file["buildings"][0]["roofSegmentStats"].as_array().unwrap();
        // The L falls to the south, the north, the east and the west.
        for (face, aspect) in faces.iter().zip([0.0, 180.0, -90.0, 90.0]) {
            let address = face["pvgis"].as_str().unwrap();
            let query = address.split_once("PVcalc?").unwrap().1;
            let of = |name: &str| -> f64 {
                let mut pairs = query.split('&').map(|pair| pair.split_once('=').unwrap());
                pairs
                    .find(|pair| pair.0 == name)
                    .unwrap()
                    .1
                    .parse()
                    .unwrap()
            };
            assert!(
                (of("lat") - lat).abs() < 0.01 && (of("lon") - lon).abs() < 0.01,
                "{address}"
            );
            assert!((of("lat") - number(&face["center"]["latitude"])).abs() < 1e-5);
            assert!((of("angle") - 26.6).abs() < 1e-9);
            let off = (of("aspect") - aspect - turn + 540.0).rem_euclid(360.0) - 180.0;
            assert!(off.abs() < 0.1, "{address}");
            let [sw, ne] = ["sw", "ne"].map(|end| number(&face["boundingBox"][end]["latitude"]));
            assert!((sw..=ne).contains(&of("lat")));
        }
        let page = std::str::from_utf8(&files["roof_report.html"]).unwrap();
        assert_eq!(
            page.matches("href=\"https://re.jrc.ec.europa.eu/").count(),
            faces.len()
        );
    }
}
