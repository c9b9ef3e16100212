//! CityJSON, and the reference system in all files.

use nalgebra::Vector3;
use serde_json::Value;

use crate::planted::{ORIGIN, files_of, planted_models, scene};
use crate::solid_checks::solid_errors;

#[test]
fn cityjson_is_valid_and_holds_the_model_in_the_world_frame() {
    for (name, model, volume) in planted_models() {
        let files = files_of(&scene(), &model);
        let text = std::str::from_utf8(&files["model.city.json"]).unwrap();
        let validator = cjval::CJValidator::from_str(text);
        for (criterion, summary) in validator.validate() {
            assert!(!summary.has_errors(), "{name}, {criterion}: {summary}");
        }
        let json: Value = serde_json::from_str(text).unwrap();
        for (solid, errors) in solid_errors(&json) {
            assert!(errors.is_empty(), "{name}: {solid}: {errors:?}");
        }
        let solids = solids_in_world(&json);
        assert_eq!(solids.len(), model.buildings.len());
        let found: f64 = solids.iter().map(volume_of).sum();
        // Corners move by half of 0.1 mm, over faces of about a hundred square metres.
        assert!(
            (found - volume).abs() < 0.05,
            "{name}: {found} for {volume}"
        );
        let roof = &json["CityObjects"]["building-1"]["geometry"][0]["semantics"];
        let types: Vec<_> = roof["surfaces"]
            .as_array()
            .unwrap()
            .iter()
            .map(|s| &s["type"])
            .collect();
        for kind in ["RoofSurface", "WallSurface", "GroundSurface"] {
            assert!(types.iter().any(|t| *t == kind), "{name}: {kind}");
        }
    }
}

#[test]
fn a_corner_is_as_likely_as_all_facets_that_meet_there() {
    let (_, mut model, _) = planted_models().remove(0);
    for (facet, probability) in model.facets.iter_mut().zip([0.9, 0.6]) {
        facet.probability = probability;
    }
    let json: Value =
        serde_json::from_slice(&files_of(&scene(), &model)["model.city.json"]).unwrap();
    let surfaces = &json["CityObjects"]["building-1"]["geometry"][0]["semantics"]["surfaces"];
    let of_facet = |facet: u64| -> Vec<f64> {
        let mut surfaces = surfaces.as_array().unwrap().iter();
        let surface = surfaces.find(|s| s["facet"] == facet).unwrap();
        let corners = surface["cornerProbability"].as_array().unwrap();
        corners.iter().map(|p| p.as_f64().unwrap()).collect()
    };
    // Two ends of the ridge, which both slopes share, and two of the eave.
    for (facet, own) in [(1, 0.9), (2, 0.6)] {
        let mut corners = of_facet(facet);
        corners.sort_by(f64::total_cmp);
        assert_eq!(corners, [0.54, 0.54, own, own]);
    }
}

/// Per building, per face, per ring the corners in the world frame, less [`ORIGIN`].
type Faces = Vec<Vec<Vec<Vector3<f64>>>>;

fn solids_in_world(json: &Value) -> Vec<Faces> {
    let number = |v: &Value| v.as_f64().unwrap();
    let corner = |index: &Value| {
        let v = &json["vertices"][index.as_u64().unwrap() as usize];
        let transform = &json["transform"];
        Vector3::from_fn(|axis, _| {
            number(&v[axis]) * number(&transform["scale"][axis])
                + number(&transform["translate"][axis])
        }) - ORIGIN
    };
    let list = |v: &Value| v.as_array().unwrap().clone();
    json["CityObjects"]
        .as_object()
        .unwrap()
        .values()
        .map(|object| {
            let shell = &object["geometry"][0]["boundaries"][0];
            list(shell)
                .iter()
                .map(|face| {
                    list(face)
                        .iter()
                        .map(|ring| list(ring).iter().map(corner).collect())
                        .collect()
                })
                .collect()
        })
        .collect()
}

fn volume_of(faces: &Faces) -> f64 {
    let mut volume = 0.0;
    for ring in faces.iter().flatten() {
        for i in 1..ring.len() - 1 {
            volume += ring[0].dot(&ring[i].cross(&ring[i + 1])) / 6.0;
        }
    }
    volume
}

#[test]
fn a_known_reference_system_is_written() {
    let (_, model, _) = &planted_models()[0];
    let mut scene = scene();
    scene.survey.epsg = Some(25832);
    let files = files_of(&scene, model);
    let text = |name: &str| String::from_utf8_lossy(&files[name]).into_owned();
    let city: Value = serde_json::from_slice(&files["model.city.json"]).unwrap();
    assert_eq!(
        city["metadata"]["referenceSystem"],
        "https://www.opengis.net/def/crs/EPSG/0/25832"
    );
    assert!(cjval::CJValidator::from_str(&text("model.city.json")).is_valid());
    let plan: Value = serde_json::from_slice(&files["footprints.geojson"]).unwrap();
    assert_eq!(
        plan["crs"]["properties"]["name"],
        "urn:ogc:def:crs:EPSG::25832"
    );
    for name in [
        "model.obj",
        "model.ply",
        "model.dxf",
        "model.glb",
        "model.ifc",
    ] {
        assert!(text(name).contains("EPSG:25832"), "{name}");
    }
    dxf::Drawing::load(&mut &files["model.dxf"][..]).unwrap();

    // A local frame on the Earth: footprints in longitude and latitude, within a metre of its zero
    // here.
    scene.survey.epsg = None;
    scene.origin = Vector3::zeros();
    scene.survey.anchor = Some(ridgeline::orienting::orientation::Anchor {
        lon_deg: 8.412,
        lat_deg: 49.013,
        height_m: 0.0,
    });
    let files = files_of(&scene, model);
    let plan: Value = serde_json::from_slice(&files["footprints.geojson"]).unwrap();
    let ring = plan["features"][0]["geometry"]["coordinates"][0]
        .as_array()
        .unwrap()
        .clone();
    let metres = |p: &Value| {
        // A degree of latitude is 111.2 km there, one of longitude 73.1 km.
        let [lon, lat] = [0, 1].map(|i| p[i].as_f64().unwrap());
        ((lon - 8.412) * 73_133.0, (lat - 49.013) * 111_214.0)
    };
    let width = ring.iter().map(|p| metres(p).0).fold(0.0, f64::max);
    let depth = ring.iter().map(|p| metres(p).1).fold(0.0, f64::max);
    assert!(
        (width - 10.0).abs() < 0.05 && (depth - 8.0).abs() < 0.05,
        "{width} {depth}"
    );
}
