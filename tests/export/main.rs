//! Models written as files: valid for independent readers, and the same geometry as in memory.

#![cfg(not(target_arch = "wasm32"))] // The independent readers are native crates.
#![allow(clippy::unwrap_used)]

mod broken_solids;
mod city;
mod corrected;
mod glb;
mod ifc;
mod meshes;
mod obstructions;
mod planted;
mod report;
mod roofs;
#[path = "../common/solid_checks.rs"]
mod solid_checks;
mod tables;
mod texture;
mod tileset;
mod walls;

use ridgeline::roofs::model::RoofModel;

use planted::{files_of, planted_models, scene};

#[test]
fn planted_models_have_their_volumes() {
    for (name, model, volume) in planted_models() {
        let found: f64 = model.buildings.iter().map(|b| b.solid.volume()).sum();
        assert!(
            (found - volume).abs() < 1e-6,
            "{name}: {found} for {volume}"
        );
    }
}

#[test]
fn a_model_without_buildings_makes_valid_files() {
    let files = files_of(&scene(), &RoofModel::default());
    let text = std::str::from_utf8(&files["model.city.json"]).unwrap();
    assert!(cjval::CJValidator::from_str(text).is_valid());
    assert!(gltf::Gltf::from_slice(&files["model.glb"]).is_ok());
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let (_, model, _) = planted_models().remove(1);
    assert_eq!(files_of(&scene(), &model), files_of(&scene(), &model));
}
