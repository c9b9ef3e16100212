//! A folder of photographs with their orientation in, a roof model out:
//! `cargo run --release --example reconstruct_folder -- SCENE OUT`.
#![allow(clippy::print_stdout, clippy::print_stderr, clippy::disallowed_methods)]

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use ridgeline::{InputFile, LoadOptions, Params, Run, load_scene};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [scene, out] = arguments.as_slice() else {
        return Err("give the scene's folder and the folder for the results".into());
    };
    let mut files = Vec::new();
    read_folder(scene, scene, &mut files)?;
    let scene = load_scene(&files, &LoadOptions::default())?;
    for warning in &scene.warnings {
        eprintln!("warning: {warning}");
    }

    let mut run = Run::new(scene, Params::default());
    run.run_all();
    fs::create_dir_all(out)?;
    for (name, bytes) in run.files(&[]) {
        fs::write(out.join(name), bytes)?;
    }

    let model = run.results().roof_model().expect("all stages have run");
    for (building, solid) in model.buildings.iter().enumerate() {
        let facets = solid.facets.iter().map(|id| &model.facets[id.index()]);
        let slopes: Vec<String> = facets
            .map(|facet| format!("{:.0}", facet.plane.normal.z.acos().to_degrees()))
            .collect();
        println!(
            "building {}: slopes of {} degrees",
            building + 1,
            slopes.join(", ")
        );
    }
    Ok(())
}

/// All files below a folder, by their paths within the scene.
fn read_folder(root: &Path, folder: &Path, files: &mut Vec<InputFile>) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            read_folder(root, &path, files)?;
        } else {
            let inside = path
                .strip_prefix(root)
                .expect("it was found below the root");
            files.push(InputFile::new(&inside.to_string_lossy(), fs::read(&path)?));
        }
    }
    Ok(())
}
