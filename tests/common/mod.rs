//! What the tests of whole runs share, natively and in wasm.
#![allow(dead_code)] // Not every test uses all of it.

#[cfg(not(target_arch = "wasm32"))]
pub mod clouds;
pub mod golden;
pub mod scenes;
#[cfg(not(target_arch = "wasm32"))]
pub mod solid_checks;

use std::fs;
use std::io::Write as _;
use std::path::Path;

pub use scenes::SIZE_PX;

/// The synthetic L-shaped house as files: path and bytes.
pub fn synthetic_files() -> Vec<(String, Vec<u8>)> {
    let (scene, _) = ridgeline::orienting::synthetic::l_scene(SIZE_PX);
    ridgeline::orienting::synthetic::to_files(&scene)
}

/// The names in a folder, in order.
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("it stays as it is").file_name())
        .map(|name| name.into_string().expect("names are UTF-8"))
        .collect();
    names.sort();
    names
}

/// The bytes of all files of a folder, in the order of their names.
pub fn contents_of(folder: &Path) -> Vec<Vec<u8>> {
    let read = |name: &String| fs::read(folder.join(name)).expect("a file");
    names_in(folder).iter().map(read).collect()
}

/// These files as an archive.
pub fn zipped(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (path, bytes) in files {
        let options = zip::write::SimpleFileOptions::default();
        archive
            .start_file(path.as_str(), options)
            .expect("the names differ");
        archive.write_all(bytes).expect("memory takes all");
    }
    archive.finish().expect("memory takes all").into_inner()
}
