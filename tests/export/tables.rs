//! What is no mesh: lines and half-planes as JSON, footprints as GeoJSON, lines as CSV.

use std::collections::BTreeMap;

use nalgebra::{Point2, Vector3};
use ridgeline::base::geometry::signed_area;
use ridgeline::base::ids::LineId;
use ridgeline::lines::lines3d::LineContradiction;
use ridgeline::roofs::model::Surface;
use serde_json::Value;

use crate::planted::{ORIGIN, files_of, files_with, planted_evidence, planted_models, scene};

#[test]
fn evidence_is_written_in_the_world_frame_of_the_input() {
    let (_, model, _) = planted_models().remove(0);
    let files = files_of(&scene(), &model);
    let parse = |name: &str| serde_json::from_slice::<Value>(&files[name]).unwrap();
    let line = &parse("lines.json")["lines"][0];
    assert_eq!(
        line["p1"],
        serde_json::json!([432_104.0, 5_412_305.0, 6.1235])
    );
    assert_eq!(line["views"][0]["view"], "b.jpg");
    assert_eq!(
        line["views"][0]["segment"],
        serde_json::json!([1.0, 2.0, 30.25, 4.0])
    );
    let segments = parse("segments.json");
    assert_eq!(segments["views"][0]["segments"], serde_json::json!([]));
    assert_eq!(segments["views"][1]["segments"][0][2], 30.25);
    let half_plane = &parse("halfplanes.json")["half_planes"][0];
    assert_eq!(half_plane["side"], "left");
    let plane: Vec<f64> = half_plane["plane"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect();
    let world = ORIGIN + Vector3::new(2.0, 4.0, 3.8);
    let distance = Vector3::new(plane[0], plane[1], plane[2]).dot(&world) + plane[3];
    assert!(distance.abs() < 1e-6);
}

#[test]
fn what_spoke_for_candidates_is_written_with_their_places() {
    let (_, model, _) = planted_models().remove(0);
    let files = files_of(&scene(), &model);
    let evidence: Value = serde_json::from_slice(&files["evidence.json"]).unwrap();
    let (line, facet) = (&evidence["lines"][0], &evidence["facets"][0]);
    assert_eq!(
        line["p1"],
        serde_json::json!([432_104.0, 5_412_305.0, 6.1235])
    );
    // Half a nat for it and half a nat against it.
    assert_eq!(line["probability"], 0.5);
    assert_eq!(line["terms"][0]["feature"], "slope_deg");
    assert_eq!(line["terms"][0]["value"], 12.5);
    assert_eq!(&evidence["model_lines"][0], line);
    let surface = &evidence["surfaces"][0];
    assert_eq!(surface["patches"], facet["outline"]);
    for class in ["building", "vegetation"] {
        assert_eq!(surface[class], facet["terms"]);
    }
    assert_eq!(facet["accepted"], false);
    assert_eq!(facet["outline"][1][0], 432_104.0);
    assert_eq!(facet["plane"], serde_json::json!([0.0, 0.0, 1.0, -5.0]));
    let classes = &evidence["window_classes"];
    let count = |list: &Value| list.as_array().unwrap().len();
    let rows = &facet["windows"]["on"];
    assert_eq!(count(rows), count(&classes["weights_below"]));
    assert_eq!(count(&rows[0]), count(&classes["correlations_from"]));
}

#[test]
fn footprints_read_back_with_the_plan_area() {
    let scene = scene();
    let ring_area = |ring: &Vec<geojson::Position>| -> f64 {
        assert_eq!(ring.first(), ring.last(), "rings are closed");
        signed_area(ring.iter().map(|p| Point2::new(p[0], p[1])))
    };
    for (name, model, _) in planted_models() {
        let files = files_of(&scene, &model);
        let text = std::str::from_utf8(&files["footprints.geojson"]).unwrap();
        let collection: geojson::FeatureCollection = text
            .parse::<geojson::GeoJson>()
            .unwrap()
            .try_into()
            .unwrap();
        let mut area = 0.0;
        for feature in &collection.features {
            let Some(geojson::GeometryValue::Polygon { coordinates }) =
                feature.geometry.as_ref().map(|g| &g.value)
            else {
                panic!("{name}: no polygon");
            };
            // Outer rings counter-clockwise, holes clockwise (RFC 7946, 3.1.6).
            assert!(ring_area(&coordinates[0]) > 0.0);
            assert!(coordinates[1..].iter().all(|hole| ring_area(hole) < 0.0));
            area += coordinates.iter().map(ring_area).sum::<f64>();
            assert_eq!(feature.property("ground_m").unwrap().as_f64(), Some(0.0));
        }
        let plan: f64 = model
            .buildings
            .iter()
            .map(|b| {
                let ground = b
                    .solid
                    .faces
                    .iter()
                    .filter(|f| f.surface == Surface::Ground);
                ground
                    .map(|f| b.solid.vector_area(&f.rings).norm())
                    .sum::<f64>()
            })
            .sum();
        assert!(
            (area - plan).abs() < 1e-6,
            "{name}: {area} instead of {plan}"
        );
    }
}

#[test]
fn the_table_of_lines_reads_back() {
    let (_, lines, _) = planted_evidence();
    let files = files_of(&scene(), &planted_models()[0].1);
    let mut reader = csv::Reader::from_reader(&files["lines.csv"][..]);
    let rows: Vec<BTreeMap<String, String>> = reader.deserialize().map(Result::unwrap).collect();
    assert_eq!(rows.len(), lines.len());
    for (row, line) in rows.iter().zip(&lines) {
        assert_eq!(row["origin"], "matched");
        let row = |name: &str| row[name].parse::<f64>().unwrap();
        let p = Vector3::new(row("x1_m"), row("y1_m"), row("z1_m")) - ORIGIN;
        assert!((p - line.segment.p1.coords).norm() < 1e-4);
        assert!((row("length_m") - line.segment.length()).abs() < 1e-4);
        assert_eq!(row("views") as usize, line.supports.len());
        assert!((row("probability") - line.probability).abs() < 1e-4);
    }
}

#[test]
fn no_file_shows_what_the_model_refutes_and_ids_stay() {
    let (segments, mut lines, mut half_planes) = planted_evidence();
    let standing = lines[0].clone();
    lines.push(standing.clone());
    lines[0].contradiction = Some(LineContradiction::Improbable);
    lines[0].segment.p0.z += 1.0;
    half_planes.push(half_planes[0].clone());
    half_planes[1].line = LineId(1);
    let (_, model, _) = planted_models().remove(0);
    let all = files_of(&scene(), &model);
    let files = files_with(&scene(), &model, (segments, lines, half_planes));

    let parse = |name: &str| serde_json::from_slice::<Value>(&files[name]).unwrap();
    let ids = |file: &str, list: &str| -> Vec<i64> {
        let list = parse(file)[list].as_array().unwrap().clone();
        list.iter()
            .map(|item| item["id"].as_i64().unwrap())
            .collect()
    };
    assert_eq!(ids("lines.json", "lines"), [2]);
    assert_eq!(ids("halfplanes.json", "half_planes"), [2]);
    assert_eq!(parse("halfplanes.json")["half_planes"][0]["line"], 2);
    let text = |name: &str| String::from_utf8(files[name].clone()).unwrap();
    assert_eq!(
        text("lines.csv").lines().nth(1).unwrap().split(',').next(),
        Some("2")
    );
    // The meshes are those of the standing line alone.
    assert_eq!(files["model.ply"], all["model.ply"]);
    assert_eq!(files["model.dxf"], all["model.dxf"]);
}
