//! Fuzzing of everything that reads foreign bytes: `make fuzz` for long, `make test` for a moment.
//!
//! Each reader is a target: it takes its fixtures, damages them at random and reads them. Whatever
//! the bytes are, the answer is a value or a readable refusal, within time and memory.
//! `RIDGELINE_FUZZ_SECONDS` says how long each target runs, `RIDGELINE_FUZZ_SEED` where it starts.
//! What breaks is written to `target/fuzz-finds` and belongs into `tests/fixtures/finds`, which is
//! read again in every run.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::disallowed_methods)]

use std::fs;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Once;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use image::{DynamicImage, ImageFormat};
use ridgeline::base::params::{Correction, Params};
use ridgeline::orienting::known::{Register, Terrain, WorldSystem};
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::orientation::{detect, epsg_of, orientation_sets, units_of};
use ridgeline::orienting::scene_loader::{
    LoadOptions, Project, inspect_files, load_scene, open_project, unpack,
};
use ridgeline::orienting::structure_from_motion::{GeoList, GroundControl, PhotoMetadata};
use ridgeline::photographs::raster::{image_header, load_image, load_window};
use ridgeline::results::export::{ReportedModel, corrected_file};
use ridgeline::results::roof_report::SetbackRule;
use ridgeline::roofs::corrections::correct;

/// Longest time that one input may take: machines may be busy, but nothing hangs.
const SLOWEST: Duration = Duration::from_secs(60);

/// Most memory that the whole program may have taken, kilobytes.
const MOST_KB: u64 = 4 << 20;

fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures")
}

/// The files of a folder of the fixtures, by name.
fn files_of(folder: &str) -> Vec<InputFile> {
    let mut files: Vec<InputFile> = fs::read_dir(fixtures().join(folder))
        .map(|entries| entries.map(|e| e.unwrap().path()).collect::<Vec<_>>())
        .unwrap_or_default()
        .iter()
        .filter(|path| path.is_file())
        .map(|path| {
            let name = path.file_name().unwrap().to_string_lossy();
            InputFile::new(&format!("{folder}/{name}"), fs::read(path).unwrap())
        })
        .collect();
    files.sort_by(|a, b| a.path.cmp(&b.path));
    files
}

/// Marsaglia's xorshift: short, and the same everywhere.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

const WORDS: [&str; 24] = [
    "nan",
    "inf",
    "-1",
    "0",
    "1e999",
    "1e300",
    "-1e-300",
    "1e-320",
    "99999999999999999999",
    "4294967295",
    "4294967296",
    "\u{feff}",
    "#",
    "$",
    "OPENCV",
    "1 2 3",
    "\n",
    "0x10",
    "\u{fc}",
    "\"",
    "<",
    "]",
    "}",
    "; ",
];

/// Damages bytes in one place; `other` lends pieces.
fn damage(dice: &mut Dice, bytes: &mut Vec<u8>, other: &[u8]) {
    let at = dice.below(bytes.len() + 1);
    let length = 1 << dice.below(10);
    let end = (at + dice.below(length + 1)).min(bytes.len());
    match dice.below(9) {
        0 if at < bytes.len() => bytes[at] ^= 1 << dice.below(8),
        1 if at < bytes.len() => bytes[at] = [0, 1, 0x7f, 0x80, 0xfe, 0xff][dice.below(6)],
        2 => bytes.truncate(at),
        3 => drop(bytes.drain(at..end)),
        4 => {
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        5 if !other.is_empty() => {
            let from = dice.below(other.len());
            let to = (from + length).min(other.len());
            bytes.splice(at..end, other[from..to].iter().copied());
        }
        6 => {
            let word = WORDS[dice.below(WORDS.len())];
            bytes.splice(at..end, word.bytes());
        }
        7 => {
            // A word in place of a field.
            let is_blank = |b: &u8| b.is_ascii_whitespace() || b",<>\"[]:".contains(b);
            let start = bytes[..at].iter().rposition(is_blank).map_or(0, |i| i + 1);
            let stop = bytes[at..]
                .iter()
                .position(is_blank)
                .map_or(bytes.len(), |i| at + i);
            let word = WORDS[dice.below(WORDS.len())];
            bytes.splice(start..stop, word.bytes());
        }
        _ => {
            // Four bytes as a number: counts and offsets of binary formats.
            let value = [
                0u32,
                1,
                0x7fff_ffff,
                0xffff_ffff,
                0x10000,
                dice.next() as u32,
            ][dice.below(6)];
            if at + 4 <= bytes.len() {
                bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
            }
        }
    }
}

/// Readable: one line, not empty, not endless, with something to do.
fn check(outcome: ridgeline::Result<()>) {
    if let Err(error) = outcome {
        let message = error.to_string();
        assert!(message.len() > 20 && message.len() < 2000, "{message}");
        assert!(
            message.contains("; ") && !message.contains('\n'),
            "{message}"
        );
    }
}

/// Reads orientation files alone: quick.
fn read_orientation(files: &[InputFile]) {
    let kinds: Vec<_> = files.iter().map(detect).collect();
    let (sets, _) = orientation_sets(files, &kinds);
    for set in sets {
        let _ = set.reference(files, None);
        check(set.read(files, &mut Vec::new()).map(|_| ()));
    }
}

/// Reads a whole scene.
fn read_scene(files: &[InputFile]) {
    let options = LoadOptions::default();
    let inspection = inspect_files(files, &options);
    let outcome = load_scene(files, &options);
    if outcome.is_ok() {
        assert!(inspection.errors.is_empty(), "{:?}", inspection.errors);
    }
    check(outcome.map(|_| ()));
}

fn read_archive(files: &[InputFile]) {
    for file in files {
        check(unpack(file.clone()).and_then(open_project).map(|_| ()));
    }
}

fn read_image(files: &[InputFile]) {
    for file in files {
        let stated = PhotoMetadata::read(&file.bytes, [64, 48]);
        assert!(stated.height_m.is_none_or(f64::is_finite), "{stated:?}");
        check(image_header(&file.path, &file.bytes).map(|_| ()));
        check(load_image(&file.path, &file.bytes).map(|_| ()));
        if let Ok(header) = image_header(&file.path, &file.bytes) {
            let part = [
                header.width / 3,
                header.height / 3,
                header.width.div_ceil(3),
                header.height.div_ceil(3),
            ];
            check(load_window(&file.path, &file.bytes, part).map(|_| ()));
        }
    }
}

/// Panics so far: the readers turn those of decoders into refusals where they can be caught, but
/// in the browser they cannot.
static PANICS: AtomicU64 = AtomicU64::new(0);

fn count_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            PANICS.fetch_add(1, Ordering::Relaxed);
            usual(info);
        }));
    });
}

/// Runs a target for its time and says how many inputs it read, and how long the slowest took.
fn fuzz(target: &str, seeds: &[Vec<InputFile>], read: fn(&[InputFile])) {
    let number = |name: &str, default| {
        std::env::var(name)
            .ok()
            .and_then(|v| v.parse().ok())
            .unwrap_or(default)
    };
    let seconds: f64 = number("RIDGELINE_FUZZ_SECONDS", 0.5);
    let seed = number("RIDGELINE_FUZZ_SEED", 1.0) as u64;
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let start = Instant::now();
    let lenders: Vec<InputFile> = READERS.iter().flat_map(|f| files_of(f)).collect();
    let (mut inputs, mut slowest) = (0u64, Duration::ZERO);
    count_panics();
    let panics = PANICS.load(Ordering::Relaxed);
    while start.elapsed().as_secs_f64() < seconds {
        let mut files = seeds[dice.below(seeds.len())].clone();
        // Pieces of the same format fit, pieces of others confuse.
        let own = dice.below(2) == 0;
        let lender = match own {
            true => files[dice.below(files.len())].bytes.clone(),
            false => lenders[dice.below(lenders.len())].bytes.clone(),
        };
        for _ in 0..=dice.below(4) {
            let victim = dice.below(files.len());
            damage(&mut dice, &mut files[victim].bytes, &lender);
        }
        let begun = Instant::now();
        let survived = catch_unwind(AssertUnwindSafe(|| read(&files)));
        slowest = slowest.max(begun.elapsed());
        let panicked = PANICS.load(Ordering::Relaxed) > panics;
        if survived.is_err() || panicked || slowest > SLOWEST {
            let folder = keep(target, inputs, &files);
            panic!(
                "{target}: input {inputs} (seconds {:.1}) is kept in {}",
                begun.elapsed().as_secs_f64(),
                folder.display()
            );
        }
        inputs += 1;
    }
    println!(
        "{target}: {inputs} inputs in {seconds} s, slowest {:.3} s, {} MB at the peak",
        slowest.as_secs_f64(),
        peak_kb() >> 10
    );
    assert!(peak_kb() < MOST_KB, "{target}: {} MB", peak_kb() >> 10);
}

fn keep(target: &str, number: u64, files: &[InputFile]) -> PathBuf {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("target/fuzz-finds/{target}-{number}"));
    fs::create_dir_all(&folder).unwrap();
    for file in files {
        fs::write(folder.join(file.name()), &file.bytes).unwrap();
    }
    folder
}

/// Most memory that the program has taken so far; 0 where the system does not say.
fn peak_kb() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM:"));
    line.and_then(|l| l.split_whitespace().nth(1)?.parse().ok())
        .unwrap_or(0)
}

fn sets(folders: &[&str]) -> Vec<Vec<InputFile>> {
    folders.iter().map(|folder| files_of(folder)).collect()
}

/// A target for each reader, with the folders of its samples.
macro_rules! readers {
    ($($reader:ident: $folders:expr;)*) => {
        const READERS: &[&str] = &[$(stringify!($reader)),*];

        mod readers_survive_anything {
            $(#[test]
            fn $reader() {
                super::fuzz(stringify!($reader), &super::sets(&$folders), super::read_orientation);
            })*
        }
    };
}

readers! {
    blocks: ["blocks"];
    bundler: ["bundler"];
    colmap: ["colmap"];
    colmap_binary: ["colmap_binary"];
    inpho: ["inpho", "inpho_lens"];
    krc: ["krc"];
    metashape: ["metashape"];
    micmac: ["micmac"];
    middlebury: ["middlebury"];
    nerfstudio: ["nerfstudio"];
    nvm: ["nvm"];
    opensfm: ["opensfm"];
    patb: ["patb"];
    photogrammetric: ["photogrammetric"];
    pix4d: ["pix4d"];
    pmatrix: ["pmatrix"];
    projection: ["projection"];
    shots: ["shots"];
    strecha: ["strecha"];
}

#[test]
fn archives_and_projects_survive_anything() {
    let images = files_of("images");
    let all = [images, files_of("colmap")].concat();
    let packed = Project::new(LoadOptions::default(), Default::default())
        .pack(&all, &[])
        .unwrap();
    let project = open_project(unpack(InputFile::new("a.zip", packed.clone())).unwrap()).unwrap();
    assert!(project.1.is_some());
    fuzz(
        "archive",
        &[vec![InputFile::new("a.zip", packed)]],
        read_archive,
    );
}

/// The image of the fixtures in a file of this format, with 8 bits, 16 where the format can, and
/// grey.
fn encoded(format: ImageFormat) -> Vec<Vec<InputFile>> {
    let rgb = image::load_from_memory(&files_of("images")[0].bytes).unwrap();
    let kinds = [
        DynamicImage::ImageRgb16(rgb.to_rgb16()),
        DynamicImage::ImageLuma8(rgb.to_luma8()),
        rgb,
    ];
    let write = |image: &DynamicImage| {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).ok()?;
        Some(vec![InputFile::new("a", bytes.into_inner())])
    };
    let seeds: Vec<_> = kinds.iter().filter_map(write).collect();
    assert!(seeds.len() >= 2);
    seeds
}

#[test]
fn jpeg_survives_anything() {
    fuzz("jpeg", &encoded(ImageFormat::Jpeg), read_image);
}

#[test]
fn png_survives_anything() {
    fuzz("png", &encoded(ImageFormat::Png), read_image);
}

#[test]
fn tiff_survives_anything() {
    let mut seeds = encoded(ImageFormat::Tiff);
    for folder in ["tiff", "tiff/refused"] {
        let files = files_of(folder).into_iter();
        let files = files.filter(|f| f.path.ends_with(".tif"));
        seeds.extend(files.map(|file| vec![file]));
    }
    assert!(seeds.len() > 80);
    fuzz("tiff", &seeds, read_image);
}

/// Reads what may be known of a place.
fn read_known(files: &[InputFile]) {
    let system = WorldSystem {
        epsg: Some(25832),
        anchor: None,
    };
    let origin = nalgebra::Vector3::new(432_100.0, 5_412_300.0, 0.0);
    for file in files {
        let eave = Correction::SetEave {
            building: nalgebra::Point3::new(432_103.0, 5_412_298.0, 118.0),
            height: 121.0,
        };
        if let Ok(read) = ReportedModel::read(&file.bytes) {
            let (model, trace) = correct(&read.scene(), read.model(), &[eave], &Params::default());
            // What was read once is read again.
            let corrected = corrected_file(&file.bytes, &model, &trace.sources);
            let again = corrected.map(|bytes| ReportedModel::read(&bytes));
            assert!(again.is_err() || again.is_ok_and(|read| read.is_ok()));
            read.files(&SetbackRule::built_in());
        }
        let terrain = Terrain::read(file, None, &system, origin, 0.3);
        if let Ok(terrain) = &terrain {
            let z = terrain.z_at(3.0, -2.0);
            assert!(z.is_none_or(f64::is_finite), "{z:?}");
        }
        check(terrain.map(|_| ()));
        let register = Register::read(file, &system, origin, 0.5, &mut Vec::new());
        if let Ok(register) = &register {
            let place = nalgebra::Point2::new(3.0, -2.0);
            assert!(
                register
                    .footprints
                    .iter()
                    .all(|f| f.outline.depth(&place).is_finite())
            );
        }
        check(register.map(|_| ()));
    }
}

/// Reads lists of control points, and of the places of photographs.
fn read_control(files: &[InputFile]) {
    for file in files {
        let head = file.head();
        let text = String::from_utf8_lossy(&head);
        for line in text.lines() {
            let _ = (epsg_of(line), units_of(line));
        }
        check(GroundControl::read(&file.path, &text).map(|_| ()));
        check(GeoList::read(&file.path, &text).map(|_| ()));
    }
}

#[test]
fn lists_of_control_and_places_survive_anything() {
    let seeds: Vec<Vec<InputFile>> = files_of("control").into_iter().map(|f| vec![f]).collect();
    assert_eq!(seeds.len(), 4);
    fuzz("control", &seeds, read_control);
}

#[test]
fn terrain_and_footprints_survive_anything() {
    let seeds: Vec<Vec<InputFile>> = files_of("known").into_iter().map(|f| vec![f]).collect();
    assert!(seeds.len() >= 8);
    fuzz("known", &seeds, read_known);
}

/// What programs write of the system beside an orientation.
const SYSTEMS: [(&str, &str); 3] = [
    (
        "orientation.json",
        r#"{"is_metric":true,"anchor":{"lon_deg":8.4,"lat_deg":49.0,"height_m":0.0},"epsg":25832,
        "rays_a_point":3.1,"left_out":[]}"#,
    ),
    (
        "site.prj",
        r#"PROJCS["ETRS_1989_UTM_Zone_32N",GEOGCS["g",DATUM["D_ETRS_1989",SPHEROID["s",6378137,298]]],
        PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000],PARAMETER["False_Northing",0],
        PARAMETER["Central_Meridian",9],PARAMETER["Scale_Factor",0.9996],
        PARAMETER["Latitude_Of_Origin",0],UNIT["Foot_US",0.3048006096012192]]"#,
    ),
    (
        "reference_lla.json",
        r#"{"latitude":49.0,"longitude":8.4,"altitude":0.0}"#,
    ),
];

#[test]
fn whole_scenes_survive_anything() {
    let beside = |folder: &&str| -> Vec<InputFile> {
        let file = |(name, text): (&str, &str)| {
            InputFile::new(&format!("{folder}/{name}"), text.as_bytes().to_vec())
        };
        SYSTEMS.map(file).into()
    };
    let scenes: Vec<Vec<InputFile>> = READERS
        .iter()
        .map(|f| [files_of(f), files_of("images"), beside(f)].concat())
        .collect();
    fuzz("scene", &scenes, read_scene);
}

/// What once broke something stays readable.
#[test]
fn earlier_finds_are_read() {
    let folder = fixtures().join("finds");
    let mut count = 0;
    for entry in fs::read_dir(&folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let files = files_of(&format!("finds/{name}"));
        assert!(!files.is_empty(), "{name}");
        read_orientation(&files);
        read_archive(&files);
        read_image(&files);
        read_scene(&[files, files_of("images")].concat());
        count += 1;
    }
    assert!(count > 0);
}
