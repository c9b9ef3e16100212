//! The command line as a user meets it: files out for a good scene, exit code 2 and a sentence for a bad one.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used)]

mod common;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use common::synthetic_files;

/// What a run writes.
const OUTPUTS: [&str; 13] = [
    "footprints.geojson",
    "halfplanes.json",
    "lines.csv",
    "lines.json",
    "model.city.json",
    "model.dxf",
    "model.glb",
    "model.mtl",
    "model.obj",
    "model.ply",
    "model_atlas.jpg",
    "report.json",
    "segments.json",
];

/// A scene's folder that a test may damage, with a folder for the results.
struct Scene(tempfile::TempDir);

impl Scene {
    fn new() -> Self {
        let scene = Self(tempfile::tempdir().unwrap());
        for (path, bytes) in synthetic_files() {
            scene.write(&path, &bytes);
        }
        scene
    }

    fn write(&self, path: &str, bytes: &[u8]) {
        let path = self.0.path().join("scene").join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    fn read(&self, path: &str) -> Vec<u8> {
        fs::read(self.0.path().join("scene").join(path)).unwrap()
    }

    fn edit(&self, path: &str, from: &str, to: &str) {
        let text = String::from_utf8(self.read(path)).unwrap();
        assert!(text.contains(from));
        self.write(path, text.replacen(from, to, 1).as_bytes());
    }

    fn out(&self) -> std::path::PathBuf {
        self.0.path().join("out")
    }

    fn run(&self, more: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_ridgeline"))
            .arg("reconstruct")
            .arg(self.0.path().join("scene"))
            .arg("--out")
            .arg(self.out())
            .args(more)
            .output()
            .unwrap()
    }

    /// Runs, and expects a refusal that names all of `words` and leaves no model behind.
    fn is_refused(&self, more: &[&str], words: &[&str]) {
        let output = self.run(more);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for word in words {
            assert!(message.contains(word), "'{word}' is not in: {message}");
        }
        assert!(!message.contains("panicked"), "{message}");
        assert!(!self.out().join("model.glb").exists());
    }
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_good_scene_gives_all_files() {
    let scene = Scene::new();
    let output = scene.run(&["--threads", "2", "--method", "lines"]);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(names_in(&scene.out()), OUTPUTS);
    for word in ["segments", "halfplanes", "facets", "model.glb"] {
        assert!(printed.contains(word), "'{word}' is not in: {printed}");
    }
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(scene.out().join("report.json")).unwrap()).unwrap();
    assert!(report["seconds"]["matches"].as_f64().unwrap() > 0.0);
    assert!(report["stages"][4]["counts"]["facets"].as_u64().unwrap() >= 4);
    assert_eq!(report["params"]["sweep"]["min_similarity"], 0.4);
}

#[test]
fn an_image_without_orientation_is_refused() {
    let scene = Scene::new();
    scene.write("images/stray.png", &scene.read("images/s1_01.png"));
    scene.is_refused(&[], &["stray.png", "orientation"]);
}

#[test]
fn a_truncated_jpeg_is_refused() {
    let scene = Scene::new();
    let png = image::load_from_memory(&scene.read("images/s1_02.png")).unwrap();
    let mut jpeg = std::io::Cursor::new(Vec::new());
    png.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
    let jpeg = jpeg.into_inner();
    fs::remove_file(scene.0.path().join("scene/images/s1_02.png")).unwrap();
    scene.edit("colmap/images.txt", "s1_02.png", "s1_02.jpg");
    scene.write("images/s1_02.jpg", &jpeg[..jpeg.len() / 2]);
    scene.is_refused(&[], &["s1_02.jpg"]);
}

#[test]
fn two_views_are_too_few() {
    let scene = Scene::new();
    scene.is_refused(&["--views", "s1_01,s1_02"], &["three"]);
}

#[test]
fn a_camera_that_is_not_a_number_is_refused() {
    let scene = Scene::new();
    let text = String::from_utf8(scene.read("colmap/images.txt")).unwrap();
    let line = text.lines().find(|l| l.contains("s2_02.png")).unwrap();
    let mut words: Vec<&str> = line.split(' ').collect();
    words[5] = "NaN";
    scene.edit("colmap/images.txt", line, &words.join(" "));
    scene.is_refused(&[], &["colmap/images.txt"]);
}

#[test]
fn bad_arguments_are_explained() {
    let scene = Scene::new();
    scene.is_refused(&["--method", "combined"], &["lines"]);
    scene.is_refused(&["--roi", "5,0,1,1"], &["x0 must be less than x1"]);
    scene.is_refused(&["--ground-z", "NaN"], &["not a number"]);
    scene.is_refused(&["--views", "nothing.png"], &["nothing.png"]);
    let params = scene.0.path().join("params.json");
    fs::write(&params, r#"{"sweep": {"min_simularity": 0.5}}"#).unwrap();
    let words = ["params.json", "min_simularity", "min_similarity"];
    scene.is_refused(&["--params", params.to_str().unwrap()], &words);
}

#[test]
fn a_folder_that_is_not_there_is_refused() {
    let nowhere = Command::new(env!("CARGO_BIN_EXE_ridgeline"))
        .args(["reconstruct", "no/such/folder", "--out"])
        .arg(tempfile::tempdir().unwrap().path())
        .output()
        .unwrap();
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&nowhere.stderr).contains("no/such/folder"));
}

#[test]
fn the_printed_parameters_are_accepted() {
    let output = Command::new(env!("CARGO_BIN_EXE_ridgeline"))
        .arg("params")
        .output()
        .unwrap();
    let params: ridgeline::params::Params = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(params, ridgeline::params::Params::default());
}
