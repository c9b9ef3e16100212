//! Corrections by hand on the command line: applied, kept in projects, and named where they are
//! wrong.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Value, json};

use crate::common::{names_in, synthetic_files};

/// Height to which the ground below the house is set, metres.
const GROUND_Z: f64 = -1.25;

struct Place(tempfile::TempDir);

impl Place {
    /// The folder of a scene, with room beside it.
    fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        for (path, bytes) in synthetic_files() {
            let path = place.path("scene").join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) -> String {
        fs::write(self.path(name), text).unwrap();
        self.path(name).to_string_lossy().into_owned()
    }

    fn run(&self, scene: &Path, out: &str, more: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_ridgeline"))
            .args([Path::new("reconstruct"), scene, Path::new("--out")])
            .arg(self.path(out))
            .args(more)
            .output()
            .unwrap()
    }
}

/// The ground of the house is elsewhere; a facet is confirmed 50 m above all roofs.
fn corrections() -> Value {
    let (_, truth) = ridgeline::orienting::synthetic::l_scene(crate::common::SIZE_PX);
    let (plane, ring) = &truth.facets[0];
    let middle = ridgeline::base::geometry::mean_point(ring);
    let [x, y, z]: [f64; 3] = middle.into();
    let normal: [f64; 3] = plane.normal.into();
    json!([
        {"correction": "set_ground", "building": [x, y, z], "height": GROUND_Z},
        {"correction": "confirm", "facet": {"at": [x, y, z + 50.0], "normal": normal}},
    ])
}

fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// The lowest height of a model.
fn lowest_m(model: &Value) -> f64 {
    let number = |value: &Value| value.as_f64().unwrap();
    let [scale, translate] = ["scale", "translate"].map(|key| number(&model["transform"][key][2]));
    let vertices = model["vertices"].as_array().unwrap();
    let heights = vertices.iter().map(|v| number(&v[2]) * scale + translate);
    heights.fold(f64::INFINITY, f64::min)
}

#[test]
fn corrections_are_applied_named_where_stale_and_kept_in_projects() {
    let place = Place::new();
    let list = place.write("corrections.json", &corrections().to_string());
    let project = place.path("house.zip");
    let project_option = project.to_str().unwrap();
    let output = place.run(
        &place.path("scene"),
        "out",
        &["--corrections", &list, "--project", project_option],
    );
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    let stale = "correction 2 is not applied: the facet there has another height now";
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(printed.contains(stale), "{printed}{message}");
    let report = read_json(&place.path("out/report.json"));
    assert_eq!(report["params"]["corrections"].as_array().unwrap().len(), 2);
    let stages = report["stages"].as_array().unwrap();
    let stage = stages.iter().find(|s| s["stage"] == "corrections").unwrap();
    assert_eq!(stage["counts"]["corrections"], 1);
    assert!(stage.to_string().contains(stale), "{stage}");
    let model = read_json(&place.path("out/model.city.json"));
    assert!((lowest_m(&model) - GROUND_Z).abs() < 1e-3);

    let again = place.run(&project, "again", &[]);
    assert!(again.status.success());
    assert_eq!(model, read_json(&place.path("again/model.city.json")));
    let again = read_json(&place.path("again/report.json"));
    assert_eq!(report["params"], again["params"]);
}

#[test]
fn what_is_no_list_is_refused_by_name() {
    let place = Place::new();
    let bad = [
        ("{}", "sequence"),
        ("[", "EOF"),
        (r#"[{"correction": "paint"}]"#, "paint"),
        (
            r#"[{"correction": "set_slope", "facet": {"at": [0, 0, 0], "normal": [0, 0, 1]}}]"#,
            "slope_deg",
        ),
        (
            r#"[{"correction": "delete_building", "building": [0, 0]}]"#,
            "[0]",
        ),
    ];
    for (text, word) in bad {
        let list = place.write("bad.json", text);
        is_refused(
            &place,
            &["--corrections", &list],
            &["bad.json", word, "the page saves"],
        );
    }
    is_refused(
        &place,
        &["--corrections", "none.json"],
        &["none.json", "cannot read"],
    );
}

#[test]
fn tiles_refuse_corrections() {
    let place = Place::new();
    let list = place.write("corrections.json", &corrections().to_string());
    let options = ["--roi", "-31,-31,31,31", "--tile", "60", "--corrections"];
    is_refused(
        &place,
        &[&options[..], &[&list]].concat(),
        &["corrections by hand", "tiles", "--roi"],
    );
}

/// Runs, and expects a refusal that names all of `words` and leaves no model behind.
fn is_refused(place: &Place, more: &[&str], words: &[&str]) {
    let output = place.run(&place.path("scene"), "out", more);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    for word in words {
        assert!(message.contains(word), "'{word}' is not in: {message}");
    }
    assert!(!message.contains("panicked"), "{message}");
    let written = place.path("out");
    assert!(!written.is_dir() || names_in(&written).is_empty());
}
