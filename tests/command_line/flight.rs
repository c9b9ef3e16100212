//! A flight by one command.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

#[test]
fn a_flight_is_worked_off_in_squares_by_itself() {
    let folder = tempfile::tempdir().unwrap();
    let house = Path::new(env!("CARGO_MANIFEST_DIR")).join("www/test/fixtures/house");
    // Six photographs three times over: more than are used at once.
    for (name, bytes) in files_of(&house).chain(files_of(&house.join("orientation/projection"))) {
        for pass in ["a", "b", "c"] {
            fs::write(folder.path().join(format!("{pass}_{name}")), &bytes).unwrap();
        }
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_ridgeline"));
    command.arg("reconstruct").arg(folder.path());
    command.args(["--ground-z", "100", "--out"]);
    let out = folder.path().join("out");
    let said = crate::printed(&command.arg(&out).output().unwrap());
    assert!(
        said.contains("18 views; area") && said.contains("tile 4 of 4"),
        "{said}"
    );
    let model: Value =
        serde_json::from_slice(&fs::read(out.join("model.city.json")).unwrap()).unwrap();
    assert_eq!(model["CityObjects"].as_object().unwrap().len(), 1, "{said}");
}

/// The photographs and projection matrices in a folder.
fn files_of(folder: &Path) -> impl Iterator<Item = (String, Vec<u8>)> {
    let paths = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let inputs = paths.filter(|path| path.extension().is_some_and(|e| e == "jpg" || e == "P"));
    inputs.map(|path| {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, fs::read(&path).unwrap())
    })
}
