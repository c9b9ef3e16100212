//! Writes the synthetic scenes as images and orientation, a folder each:
//! `cargo run --release --example synthetic -- FOLDER`.

#[path = "../tests/common/scenes.rs"]
mod scenes;

use std::fs;
use std::io;
use std::path::Path;

use ridgeline::synthetic::to_files;

fn main() -> io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1) else {
        return Err(io::Error::other("give the folder to write to"));
    };
    for (name, scene) in scenes::scenes() {
        for (path, bytes) in to_files(&scene) {
            let path = Path::new(&folder).join(name).join(path);
            fs::create_dir_all(path.parent().expect("it lies in the scene's folder"))?;
            fs::write(path, bytes)?;
        }
    }
    Ok(())
}
