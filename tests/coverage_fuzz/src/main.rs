//! One reader under libFuzzer, which keeps the inputs that reach new code: `run.sh`.
//!
//! An input is the contents of all files of a sample, with [`BORDER`] between them;
//! `RIDGELINE_FUZZ_FOLDER` names the sample, whose file names are kept. With `RIDGELINE_FUZZ_ONE`
//! an input is one `image`, one `archive`, the description of one `project`, or one file of what
//! may be `known` of a place. Whatever the bytes are, the answer is a value or a readable refusal.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use ridgeline::InputFile;
use ridgeline::orienting::known::{Register, Terrain, WorldSystem};
use ridgeline::orienting::orientation::{detect, orientation_sets};
use ridgeline::photographs::raster::{image_header, load_image, load_window};
use ridgeline::orienting::scene_loader::{open_project, unpack};

/// Two record separators: what hardly stands in a file.
const BORDER: &[u8] = b"\x1e\x1e";

/// What an input is.
enum Kind {
    Image,
    Archive,
    Project,
    /// A terrain model, a point cloud, or footprints.
    Known,
    /// The files of a sample, by their names.
    Orientation(Vec<String>),
}

static KIND: LazyLock<Kind> = LazyLock::new(|| {
    match std::env::var("RIDGELINE_FUZZ_ONE").as_deref() {
        Ok("image") => return Kind::Image,
        Ok("archive") => return Kind::Archive,
        Ok("project") => return Kind::Project,
        Ok("known") => return Kind::Known,
        _ => {}
    }
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
    Kind::Orientation(paths)
});

/// The input as files; what has no name of its own is left over.
fn files(paths: &[String], mut input: &[u8]) -> Vec<InputFile> {
    let mut files = Vec::new();
    for path in paths {
        let border = input
            .windows(BORDER.len())
            .position(|bytes| bytes == BORDER);
        let end = border.unwrap_or(input.len());
        files.push(file(path, &input[..end]));
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

fn read_image(bytes: &[u8]) {
    check(load_image("a", bytes));
    if let Ok(header) = image_header("a", bytes) {
        let part = [
            header.width / 3,
            header.height / 3,
            header.width.div_ceil(3),
            header.height.div_ceil(3),
        ];
        check(load_window("a", bytes, part));
    }
}

fn read_known(file: &InputFile) {
    let system = WorldSystem {
        epsg: Some(25832),
        anchor: None,
    };
    let origin = [432_100.0, 5_412_300.0, 0.0].into();
    let terrain = Terrain::read(file, None, &system, origin, 0.3);
    if let Ok(terrain) = &terrain {
        assert!(terrain.z_at(3.0, -2.0).is_none_or(f64::is_finite));
    }
    check(terrain);
    check(Register::read(file, &system, origin, 0.5, &mut Vec::new()));
}

fn file(path: &str, input: &[u8]) -> InputFile {
    InputFile::new(path, input.to_vec())
}

fn read_orientation(files: &[InputFile]) {
    let kinds: Vec<_> = files.iter().map(detect).collect();
    let (sets, _) = orientation_sets(files, &kinds);
    for set in sets {
        set.reference(files, None);
        check(set.read(files, &mut Vec::new()));
    }
}

fuzz_target!(|input: &[u8]| {
    match &*KIND {
        Kind::Image => read_image(input),
        Kind::Archive => check(unpack(file("a.zip", input)).and_then(open_project)),
        Kind::Project => check(open_project(vec![file("project.json", input)])),
        Kind::Known => read_known(&file("known", input)),
        Kind::Orientation(paths) => read_orientation(&files(paths, input)),
    }
});
