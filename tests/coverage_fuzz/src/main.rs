//! One reader under libFuzzer, which keeps the inputs that reach new code: `run.sh`.
//!
//! An input is the contents of all files of a sample, with [`BORDER`] between them;
//! `RIDGELINE_FUZZ_FOLDER` names the sample, whose file names are kept. Whatever the bytes are, the
//! answer is a value or a readable refusal. Images are read as images, all else as orientations.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use ridgeline::InputFile;
use ridgeline::orientation::{detect, orientation_sets};
use ridgeline::raster::{image_header, load_image, load_window};

/// Two record separators: what hardly stands in a file.
const BORDER: &[u8] = b"\x1e\x1e";

/// The paths of the sample's files, sorted by name.
static PATHS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let folder = PathBuf::from(std::env::var("RIDGELINE_FUZZ_FOLDER").expect("a folder is named"));
    let mut paths: Vec<String> = std::fs::read_dir(&folder)
        .expect("the folder can be read")
        .map(|entry| {
            entry
                .expect("it can be listed")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    paths.sort();
    paths
});

/// The input as files; what has no name of its own is left over.
fn files(mut input: &[u8]) -> Vec<InputFile> {
    let mut files = Vec::new();
    for path in PATHS.iter() {
        let border = input
            .windows(BORDER.len())
            .position(|bytes| bytes == BORDER);
        let end = border.unwrap_or(input.len());
        files.push(InputFile::new(path, input[..end].to_vec()));
        input = input.get(end + BORDER.len()..).unwrap_or_default();
    }
    files
}

/// A refusal is one line that says what to do.
fn check<T>(outcome: ridgeline::Result<T>) {
    if let Err(error) = outcome {
        let message = error.to_string();
        assert!(
            message.contains("; ") && !message.contains('\n'),
            "{message}"
        );
        assert!(message.len() < 2000, "{message}");
    }
}

fuzz_target!(|input: &[u8]| {
    let files = files(input);
    if std::env::var_os("RIDGELINE_FUZZ_IMAGES").is_some() {
        for file in &files {
            check(load_image(&file.path, &file.bytes));
            if let Ok(header) = image_header(&file.path, &file.bytes) {
                let part = [
                    header.width / 3,
                    header.height / 3,
                    header.width.div_ceil(3),
                    header.height.div_ceil(3),
                ];
                check(load_window(&file.path, &file.bytes, part));
            }
        }
        return;
    }
    let kinds: Vec<_> = files.iter().map(detect).collect();
    let (sets, _) = orientation_sets(&files, &kinds);
    for set in sets {
        set.reference(&files, None);
        check(set.read(&files, &mut Vec::new()));
    }
});
