//! What the tests of whole runs share, natively and in wasm.
#![allow(dead_code)] // Not every test uses all of it.

pub mod golden;
pub mod scenes;

use std::io::Write as _;

pub use scenes::SIZE_PX;

/// The synthetic L-shaped house as files: path and bytes.
pub fn synthetic_files() -> Vec<(String, Vec<u8>)> {
    let (scene, _) = ridgeline::synthetic::l_scene(SIZE_PX);
    ridgeline::synthetic::to_files(&scene)
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
