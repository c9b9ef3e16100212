//! The examples do what their first lines promise. `cargo test` builds them before it runs this.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::synthetic_files;

/// Runs an example and returns what it printed.
fn run(example: &str, arguments: &[&Path]) -> String {
    let folder = Path::new(env!("CARGO_BIN_EXE_ridgeline")).parent().unwrap();
    let program: PathBuf = folder.join("examples").join(example);
    let output = Command::new(&program).args(arguments).output();
    let output = output.unwrap_or_else(|e| panic!("{}: {e}", program.display()));
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{example}: {complaint}");
    String::from_utf8(output.stdout).unwrap()
}

/// The number behind `before`, for example 12.5 in "theta = 12.5 degrees".
fn number_after(text: &str, before: &str) -> f64 {
    let rest = &text[text.find(before).unwrap() + before.len()..];
    let end = rest.find([' ', '\n', ',']).unwrap_or(rest.len());
    rest[..end].parse().unwrap()
}

#[test]
fn a_drawn_house_is_recovered() {
    let printed = run("recover_house", &[]);
    assert!(printed.starts_with("2 facets drawn, 2 found"), "{printed}");
    let facets: Vec<&str> = printed.lines().skip(1).collect();
    assert_eq!(facets.len(), 2, "{printed}");
    for facet in facets {
        assert!(number_after(facet, "plane within ") < 0.1, "{printed}");
        assert!(number_after(facet, "turned by ") < 1.0, "{printed}");
    }
}

#[test]
fn sim_theta_has_its_maximum_at_the_half_plane() {
    let printed = run("sim_theta", &[]);
    let theta = number_after(&printed, "theta = ");
    let curve = printed.lines().filter(|line| line.contains('#'));
    let samples = curve.map(|line| {
        let mut fields = line.split_whitespace();
        let mut number = || fields.next().unwrap().parse::<f64>().unwrap();
        (number(), number())
    });
    let best = samples.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    // The subdivision around a maximum ends at a step of one degree.
    assert!((best.0 - theta).abs() < 1.0, "{theta}, not {best:?}");
}

#[test]
fn a_folder_is_reconstructed() {
    let scene = tempfile::tempdir().unwrap();
    for (path, bytes) in synthetic_files() {
        let path = scene.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let out = tempfile::tempdir().unwrap();
    let printed = run("reconstruct_folder", &[scene.path(), out.path()]);
    assert!(printed.starts_with("building 1: slopes of "), "{printed}");
    assert!(out.path().join("model.city.json").exists());
}
