//! What is asked of a model that is there: its roof report, a comparison, corrections.

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
    compared_with_itself_and_corrected(&scene, &city);
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

/// Raises a building of the model, which a comparison then says.
fn compared_with_itself_and_corrected(scene: &Scene, city: &Path) {
    let run = |arguments: &[&Path]| {
        let command = Command::new(env!("CARGO_BIN_EXE_ridgeline"))
            .args(arguments)
            .output();
        command.unwrap()
    };
    let compared = run(&[
        Path::new("compare"),
        &scene.out(),
        city,
        Path::new("--json"),
    ]);
    let compared: serde_json::Value = serde_json::from_slice(&compared.stdout).unwrap();
    let buildings = compared["buildings"].as_array().unwrap();
    assert!(!buildings.is_empty());
    for building in buildings {
        assert_eq!(building["first"], building["second"]);
        assert_eq!(building["above_m"], 0.0);
    }
    let model: serde_json::Value = serde_json::from_slice(&fs::read(city).unwrap()).unwrap();
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let object = &model["CityObjects"]["building-1"]["geometry"][0];
        let roof = (0..).find(|i| object["semantics"]["surfaces"][i]["type"] == "RoofSurface");
        let ring = object["boundaries"][0][roof.unwrap()][0]
            .as_array()
            .unwrap();
        let corners = ring.iter().map(|v| {
            let corner = &model["vertices"][v.as_u64().unwrap() as usize];
            let number = |name: &str| model["transform"][name][axis].as_f64().unwrap();
            corner[axis].as_f64().unwrap() * number("scale") + number("translate")
        });
        corners.sum::<f64>() / ring.len() as f64
    });
    let list = scene.0.path().join("corrections.json");
    let raised =
        format!(r#"[{{"correction": "set_eave", "building": [{x}, {y}, {z}], "height": {z}}}]"#);
    fs::write(&list, raised).unwrap();
    let corrected = scene.0.path().join("corrected");
    let output = run(&[
        Path::new("correct"),
        city,
        Path::new("--corrections"),
        &list,
        Path::new("--out"),
        &corrected,
    ]);
    let printed = crate::printed(&output);
    assert!(printed.contains("model.ifc"), "{printed}");
    let text = crate::printed(&run(&[Path::new("compare"), city, &corrected]));
    let both = format!(
        "buildings: {} in both models, 0 in the first alone",
        buildings.len()
    );
    assert!(text.starts_with(&both), "{text}");
    let row = text.lines().find(|line| line.starts_with("building-1"));
    let above: f64 = (row.and_then(|row| row.split_whitespace().nth_back(1)))
        .and_then(|above| above.parse().ok())
        .unwrap_or_else(|| panic!("{text}"));
    assert!(above < -0.1, "{text}");
}
