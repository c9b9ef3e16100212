//! The readers against the small files in `tests/fixtures`, and against damaged ones.
//!
//! The fixtures are the gable house of `ridgeline::orienting::synthetic` at 48 x 48 pixels in every
//! orientation format (`tests/fixtures/make.py` writes most of them); the photogrammetric list is
//! in map coordinates. All must put the truth at the same pixels.

#![allow(clippy::print_stdout)]

use nalgebra::{Vector2, Vector3};
use proptest::prelude::*;
use ridgeline::Error;
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::orientation::{FileKind, orientation_sets};
use ridgeline::orienting::scene_loader::{LoadOptions, inspect_files, load_scene};
use ridgeline::orienting::synthetic::gable_scene;

macro_rules! fixtures {
    ($($path:literal),* $(,)?) => {
        vec![$(InputFile::new($path, include_bytes!(concat!("../fixtures/", $path)).to_vec())),*]
    };
}

fn images() -> Vec<InputFile> {
    fixtures![
        "images/s1_01.png",
        "images/s1_02.png",
        "images/s1_03.png",
        "images/s2_01.png",
        "images/s2_02.png",
        "images/s2_03.png",
    ]
}

fn colmap() -> Vec<InputFile> {
    fixtures!["colmap/cameras.txt", "colmap/images.txt"]
}

fn photogrammetric() -> Vec<InputFile> {
    fixtures!["photogrammetric/camera.txt", "photogrammetric/exterior.txt"]
}

fn projection() -> Vec<InputFile> {
    fixtures![
        "projection/s1_01.P",
        "projection/s1_02.P",
        "projection/s1_03.P",
        "projection/s2_01.P",
        "projection/s2_02.P",
        "projection/s2_03.P",
    ]
}

/// The formats that `tests/fixtures/make.py` writes, with all that they say.
fn written() -> Vec<Vec<InputFile>> {
    vec![
        fixtures!["colmap_binary/cameras.bin", "colmap_binary/images.bin"],
        fixtures!["krc/cameras.json"],
        fixtures!["opensfm/reconstruction.json"],
        fixtures!["nerfstudio/transforms.json"],
        fixtures![
            "bundler/bundle.out",
            "bundler/list.txt",
            "bundler/principal_points.txt"
        ],
        fixtures!["metashape/cameras.xml"],
        fixtures!["blocks/block.xml"],
        fixtures!["pix4d/gable_calibrated_camera_parameters.txt"],
        fixtures!["pmatrix/gable_pmatrix.txt", "pmatrix/gable_offset.xyz"],
        fixtures!["middlebury/gable_par.txt"],
        fixtures!["inpho/gable.prj"],
        fixtures!["patb/camera.txt", "patb/gable.ori"],
        fixtures!["shots/cameras.json", "shots/shots.geojson"],
        fixtures![
            "micmac/Orientation-s1_01.png.xml",
            "micmac/Orientation-s1_02.png.xml",
            "micmac/Orientation-s1_03.png.xml",
            "micmac/Orientation-s2_01.png.xml",
            "micmac/Orientation-s2_02.png.xml",
            "micmac/Orientation-s2_03.png.xml",
            "micmac/AutoCal_s1_02.png.xml",
            "micmac/AutoCal_s2_01.png.xml",
            "micmac/AutoCal_s2_03.png.xml",
        ],
        fixtures![
            "strecha/s1_01.png.camera",
            "strecha/s1_02.png.camera",
            "strecha/s1_03.png.camera",
            "strecha/s2_01.png.camera",
            "strecha/s2_02.png.camera",
            "strecha/s2_03.png.camera",
        ],
    ]
}

/// VisualSFM knows no principal point: the same cameras, but for theirs.
fn nvm() -> Vec<InputFile> {
    fixtures!["nvm/model.nvm"]
}

fn with_images(orientation: Vec<InputFile>) -> Vec<InputFile> {
    images().into_iter().chain(orientation).collect()
}

#[test]
fn all_formats_put_the_truth_at_the_same_pixels() {
    let (planted, truth) = gable_scene(48);
    let map = Vector3::new(432_100.0, 5_412_300.0, 0.0);
    let local = (written().into_iter().chain([colmap(), projection()]))
        .map(|files| (files, Vector3::zeros(), Vector3::zeros()));
    // The origin is the mean projection centre, rounded: 432100.5 and 5412299.7.
    for (files, world, origin) in local.chain([(photogrammetric(), map, map)]) {
        let name = files[0].path.clone();
        let scene = load_scene(&with_images(files), &LoadOptions::default()).unwrap();
        assert_eq!(scene.origin, origin);
        assert_eq!(scene.views.len(), 6);
        let mut largest_px: f64 = 0.0;
        for (found, expected) in scene.views.iter().zip(&planted.views) {
            assert_eq!(found.name, expected.name);
            assert_eq!(found.rgb, expected.rgb);
            assert_eq!(found.gray, expected.gray);
            for corner in truth.facets.iter().flat_map(|(_, ring)| ring) {
                let local = corner + world - scene.origin;
                let p = found.camera.project(&local).unwrap();
                let q = expected.camera.project(corner).unwrap();
                let message = format!("{name}, {}: {p} instead of {q}", found.name);
                assert!((p - q).norm() < 0.01, "{message}");
                largest_px = largest_px.max((p - q).norm());
            }
        }
        // For the table in docs/formats.md.
        println!("{name}: {largest_px:.1e} px");
    }
}

#[test]
fn a_format_without_principal_point_has_it_in_the_middle() {
    let (planted, truth) = gable_scene(48);
    let Err(error) = load_scene(&with_images(nvm()), &LoadOptions::default()) else {
        panic!("crops without their principal point cannot see the same place");
    };
    assert!(error.to_string().contains("do not overlap"), "{error}");
    let sets = orientation_sets(&nvm(), &[FileKind::Nvm]).0;
    let found = sets[0].read(&nvm(), &mut Vec::new()).unwrap();
    assert_eq!(found.len(), planted.views.len());
    let mut largest_px: f64 = 0.0;
    for (found, expected) in found.iter().zip(&planted.views) {
        assert!(found.from_middle && found.k[(0, 2)] == 0.0 && found.k[(1, 2)] == 0.0);
        let principal = Vector2::new(expected.camera.k[(0, 2)], expected.camera.k[(1, 2)]);
        for corner in truth.facets.iter().flat_map(|(_, ring)| ring) {
            let p = found.k * (found.r * (corner - found.center));
            let q = expected.camera.project(corner).unwrap().coords - principal;
            largest_px = largest_px.max((p.xy() / p.z - q).norm());
        }
    }
    println!("nvm/model.nvm: {largest_px:.1e} px");
    assert!(largest_px < 0.01, "{largest_px} px");
}

#[test]
fn among_several_orientations_the_documented_one_or_the_wanted_one_is_taken() {
    let mut files = with_images(projection());
    files.extend(photogrammetric());
    files.extend(colmap());
    let chosen = |wanted: Option<&str>| {
        let orientation = wanted.map(str::to_owned);
        let options = LoadOptions {
            orientation,
            ..LoadOptions::default()
        };
        load_scene(&files, &options)
    };
    let scene = chosen(None).unwrap();
    assert_eq!(scene.origin, Vector3::zeros());
    let expected = "3 times: colmap/cameras.txt + colmap/images.txt was taken";
    assert!(
        scene.warnings.iter().any(|w| w.contains(expected)),
        "{:?}",
        scene.warnings
    );
    assert!(chosen(Some("photogrammetric/")).unwrap().origin.norm() > 1e6);
    assert!(chosen(Some("projection")).unwrap().warnings.is_empty());
    let message = chosen(Some("bundler")).unwrap_err().to_string();
    assert!(
        message.contains("bundler") && message.contains("projection/"),
        "{message}"
    );

    let inspection = inspect_files(&files, &LoadOptions::default());
    assert_eq!((inspection.views, inspection.images.len()), (6, 6));
    assert_eq!(
        inspection.images[0].orientation.as_deref(),
        Some("colmap/images.txt, line 3")
    );
    assert!(inspection.errors.is_empty());
}

/// A refusal must be readable whatever the bytes were: one line, not empty, not endless.
fn check_refusal(error: &Error) -> Result<(), TestCaseError> {
    let message = error.to_string();
    prop_assert!(message.len() > 20 && message.len() < 2000, "{message}");
    prop_assert!(message.contains("; "), "nothing to do: {message}");
    Ok(())
}

fn check_files(files: &[InputFile]) -> Result<(), TestCaseError> {
    let inspection = inspect_files(files, &LoadOptions::default());
    match load_scene(files, &LoadOptions::default()) {
        Ok(scene) => {
            prop_assert!(inspection.errors.is_empty(), "{:?}", inspection.errors);
            prop_assert!(scene.views.len() >= 3);
            for view in &scene.views {
                let c = &view.camera;
                let numbers = c.k.iter().chain(c.r.iter()).chain(c.center.iter());
                prop_assert!(numbers.into_iter().all(|v| v.is_finite()));
                prop_assert_eq!(view.rgb.dimensions(), (c.width, c.height));
            }
        }
        Err(error) => check_refusal(&error)?,
    }
    Ok(())
}

/// One change to the bytes of a file.
#[derive(Clone, Debug)]
enum Damage {
    Flip(usize, u8),
    Cut(usize),
    Remove(usize, usize),
    Insert(usize, Vec<u8>),
    /// Replaces a blank-separated field.
    Field(usize, &'static str),
}

fn damage() -> impl Strategy<Value = Damage> {
    let words = prop::sample::select(vec![
        "nan",
        "inf",
        "-1",
        "0",
        "1e999",
        "1e300",
        "-1e-300",
        "99999999999999999999",
        "",
        "\u{feff}",
        "#",
        "OPENCV",
        "1 2 3",
        "\n",
        "0x10",
        "ü",
    ]);
    prop_oneof![
        (any::<usize>(), 1..=255u8).prop_map(|(at, bits)| Damage::Flip(at, bits)),
        any::<usize>().prop_map(Damage::Cut),
        (any::<usize>(), 1..200usize).prop_map(|(at, n)| Damage::Remove(at, n)),
        (any::<usize>(), prop::collection::vec(any::<u8>(), 1..20))
            .prop_map(|(at, bytes)| Damage::Insert(at, bytes)),
        (any::<usize>(), words).prop_map(|(at, word)| Damage::Field(at, word)),
    ]
}

fn apply(damage: &Damage, bytes: &mut Vec<u8>) {
    if bytes.is_empty() {
        return;
    }
    let size = bytes.len();
    match damage {
        Damage::Flip(at, bits) => bytes[at % size] ^= bits,
        Damage::Cut(at) => bytes.truncate(at % size),
        Damage::Remove(at, n) => {
            let at = at % size;
            bytes.drain(at..(at + n).min(size));
        }
        Damage::Insert(at, more) => {
            let at = at % size;
            bytes.splice(at..at, more.iter().copied());
        }
        Damage::Field(at, word) => {
            let text = String::from_utf8_lossy(bytes).into_owned();
            let count = text.split(' ').count();
            let fields: Vec<&str> = text
                .split(' ')
                .enumerate()
                .map(|(i, field)| if i == at % count { word } else { field })
                .collect();
            *bytes = fields.join(" ").into_bytes();
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_orientation_gives_a_scene_or_a_readable_refusal(
        format in 0..19usize, file in any::<usize>(), damages in prop::collection::vec(damage(), 1..4),
    ) {
        let mut all = written();
        all.extend([colmap(), photogrammetric(), projection(), nvm()]);
        let mut orientation = all.swap_remove(format);
        let count = orientation.len();
        for damage in &damages {
            apply(damage, &mut orientation[file % count].bytes);
        }
        check_files(&with_images(orientation))?;
    }

    #[test]
    fn damaged_images_give_a_scene_or_a_readable_refusal(
        file in 0..6usize, encoding in 0..3usize, damages in prop::collection::vec(damage(), 1..4),
    ) {
        let mut files = with_images(colmap());
        if encoding > 0 {
            let formats = [image::ImageFormat::Png, image::ImageFormat::Jpeg, image::ImageFormat::Tiff];
            let mut bytes = std::io::Cursor::new(Vec::new());
            let rgb = image::load_from_memory(&files[file].bytes).unwrap();
            rgb.write_to(&mut bytes, formats[encoding]).unwrap();
            files[file].bytes = bytes.into_inner();
        }
        for damage in &damages {
            apply(damage, &mut files[file].bytes);
        }
        check_files(&files)?;
    }

    #[test]
    fn any_bytes_under_any_known_name_are_survived(
        name in prop::sample::select(vec![
            "cameras.bin", "images.bin", "x.nvm", "x.camera", "x.xml", "cameras.txt", "images.txt", "camera.txt", "exterior.txt", "a.P", "a.jpg", "a.json", "README",
        ]),
        bytes in prop_oneof![
            prop::collection::vec(any::<u8>(), 0..2000),
            "[ 0-9.eE#+na\\n-]{0,400}".prop_map(String::into_bytes),
            (prop::sample::select(vec![&b"\xff\xd8\xff"[..], b"\x89PNG\r\n\x1a\n", b"II*\0", b"MM\0*"]),
             prop::collection::vec(any::<u8>(), 0..2000)).prop_map(|(magic, rest)| [magic, &rest[..]].concat()),
        ],
    ) {
        check_files(&[InputFile::new(name, bytes.clone())])?;
        let mut files = with_images(projection());
        files.push(InputFile::new(name, bytes));
        check_files(&files)?;
    }
}
