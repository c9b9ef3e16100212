//! What the tests of whole runs share, natively and in wasm.
#![allow(dead_code)] // Not every test uses all of it.

use std::fmt::Write as _;
use std::io::Write as _;

/// Hashes of the files that the synthetic scene gives, one line a file: FNV-1a, bytes, name.
/// Rewritten by `make golden`.
pub const GOLDEN: &str = include_str!("../golden/synthetic.txt");

/// Width and height of the synthetic views, pixels.
pub const SIZE_PX: u32 = 320;

/// The synthetic scene as files: path and bytes.
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

/// The golden text of these files.
pub fn golden_of(files: &[(String, Vec<u8>)]) -> String {
    let mut text = String::new();
    for (name, bytes) in files {
        writeln!(text, "{:016x} {:>7} {name}", fnv1a(bytes), bytes.len())
            .expect("a String takes all that is written");
    }
    text
}

/// The 64-bit Fowler-Noll-Vo hash, variant 1a: short, and the same everywhere.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
