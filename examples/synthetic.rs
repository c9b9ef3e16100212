//! Writes the synthetic scenes as images and orientation, a folder each, and one of them with a
//! point cloud besides:
//! `cargo run --release --example synthetic -- FOLDER`.

#[path = "../tests/common/clouds.rs"]
mod clouds;
#[path = "../tests/common/scenes.rs"]
mod scenes;

use std::fs;
use std::io;
use std::path::Path;

use nalgebra::Point3;
use ridgeline::orienting::synthetic::{gable_scene, to_files};

fn main() -> io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1) else {
        return Err(io::Error::other("give the folder to write to"));
    };
    for (name, scene) in scenes::scenes() {
        write(&Path::new(&folder).join(name), to_files(&scene))?;
    }
    let (scene, truth) = gable_scene(scenes::SIZE_PX);
    let is_ground = |p: &Point3<f64>| (p.z - truth.ground_z).abs() < 0.1;
    let cloud = clouds::laz(&clouds::points(&truth), is_ground);
    let mut files = to_files(&scene);
    files.push(("cloud.laz".to_owned(), cloud));
    write(&Path::new(&folder).join("cloud"), files)
}

fn write(folder: &Path, files: Vec<(String, Vec<u8>)>) -> io::Result<()> {
    for (path, bytes) in files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("it lies in the scene's folder"))?;
        fs::write(path, bytes)?;
    }
    Ok(())
}
