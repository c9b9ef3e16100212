//! `ridgeline report`: the roof report of a model that is there.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::names_in;
use crate::reconstruct::Scene;

#[test]
fn a_report_is_made_again_and_of_what_is_no_model_it_is_not() {
    let scene = Scene::new();
    assert!(scene.run(&[]).status.success());
    let page = scene.out().join("roof_report.html");
    let report = |arguments: &[&Path]| {
        let command = Command::new(env!("CARGO_BIN_EXE_ridgeline"))
            .arg("report")
            .args(arguments)
            .output();
        command.unwrap()
    };
    let first = fs::read(&page).unwrap();
    fs::remove_file(&page).unwrap();
    let output = report(&[&scene.out()]);
    assert!(output.status.success());
    assert!(String::from_utf8_lossy(&output.stdout).contains("roof_report.html"));
    assert!(fs::read(&page).unwrap() == first);
    // Of a file, into another folder.
    let other = scene.0.path().join("elsewhere/report");
    let city = scene.out().join("model.city.json");
    assert!(
        report(&[&city, Path::new("--out"), &other])
            .status
            .success()
    );
    assert_eq!(
        names_in(&other),
        [
            "buildings.csv",
            "edges.csv",
            "facets.csv",
            "roof_report.html",
            "roofs.json"
        ]
    );
    for (path, reason) in [
        (scene.out().join("report.json"), "is no CityJSON"),
        (scene.0.path().join("nothing"), "cannot be read"),
        (
            scene.0.path().join("scene"),
            "give the folder of a reconstruction",
        ),
    ] {
        let output = report(&[&path]);
        assert_eq!(output.status.code(), Some(2));
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(error.contains(reason), "{error}");
    }
}
