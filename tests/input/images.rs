//! Images as people have them: in formats that are not read, turned by their EXIF header, with more
//! bands than colours.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageFormat};
use ridgeline::orienting::orientation::{FileKind, InputFile, detect};
use ridgeline::orienting::scene_loader::{LoadOptions, inspect_files, load_scene};

fn fixture(path: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    fs::read(folder.join(path)).unwrap()
}

const NAMES: [&str; 4] = ["s1_01", "s1_02", "s1_03", "s2_01"];

/// The house in COLMAP's text format, its images by `image`; four views of 48 x `height` pixels.
fn house(height: u32, image: impl Fn(&str, DynamicImage) -> InputFile) -> Vec<InputFile> {
    let text = |name: &str| String::from_utf8(fixture(&format!("colmap/{name}"))).unwrap();
    let cameras = text("cameras.txt").replace("48 48", &format!("48 {height}"));
    let mut files = vec![
        InputFile::new("cameras.txt", cameras.into_bytes()),
        InputFile::new("images.txt", text("images.txt").into_bytes()),
    ];
    for name in NAMES {
        let stored = image::load_from_memory(&fixture(&format!("images/{name}.png"))).unwrap();
        files.push(image(name, stored.crop_imm(0, 0, 48, height)));
    }
    files
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

fn png(name: &str, image: DynamicImage) -> InputFile {
    InputFile::new(&format!("{name}.png"), encoded(&image, ImageFormat::Png))
}

/// A JPEG with this EXIF orientation.
fn with_exif(image: &DynamicImage, orientation: u8) -> Vec<u8> {
    let mut jpeg = Cursor::new(Vec::new());
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, 100);
    image.write_with_encoder(encoder).unwrap();
    let mut exif =
        b"\xff\xe1\0\x22Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    exif.extend([orientation, 0, 0, 0, 0, 0, 0]);
    let jpeg = jpeg.into_inner();
    [&jpeg[..2], &exif, &jpeg[2..]].concat()
}

/// Turns the image so that a viewer which follows the EXIF orientation shows it upright.
fn stored_for(exif: u8, shown: &DynamicImage) -> DynamicImage {
    match exif {
        5 => shown.rotate90().fliph(),
        6 => shown.rotate270(),
        7 => shown.rotate270().fliph(),
        8 => shown.rotate90(),
        _ => shown.clone(),
    }
}

fn heic() -> Vec<u8> {
    b"\0\0\0\x18ftypheic\0\0\0\0mif1heic\0\0\0\x08mdat".to_vec()
}

#[test]
fn a_quarter_turn_is_applied_where_width_and_height_are_exchanged() {
    let upright = load_scene(&house(40, png), &LoadOptions::default()).unwrap();
    for exif in 5..=8 {
        let files = house(40, |name, shown| {
            let jpeg = with_exif(&stored_for(exif, &shown), exif);
            InputFile::new(&format!("{name}.jpg"), jpeg)
        });
        let scene = load_scene(&files, &LoadOptions::default()).unwrap();
        for (view, upright) in scene.views.iter().zip(&upright.views) {
            assert_eq!(view.rgb.dimensions(), (48, 40));
            let each = view.rgb.as_raw().iter().zip(upright.rgb.as_raw());
            let sum: u32 = each.map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
            let mean = f64::from(sum) / view.rgb.as_raw().len() as f64;
            assert!(mean < 4.0, "{exif}: {mean}");
        }
        let said = scene
            .warnings
            .iter()
            .any(|w| w.contains("turned as the EXIF header asks"));
        assert!(said, "{:?}", scene.warnings);
    }
}

#[test]
fn a_turn_that_the_size_does_not_prove_is_named_only() {
    for (height, exif) in [(40, 3), (48, 6)] {
        let files = house(height, |name, shown| {
            InputFile::new(&format!("{name}.jpg"), with_exif(&shown, exif))
        });
        let scene = load_scene(&files, &LoadOptions::default()).unwrap();
        assert_eq!(scene.views[0].rgb.dimensions(), (48, height));
        let said = scene
            .warnings
            .iter()
            .filter(|w| w.contains("EXIF"))
            .collect::<Vec<_>>();
        assert!(
            said.len() == 1 && said[0].contains("not applied") && said[0].contains("s1_02.jpg"),
            "{said:?}"
        );
    }
}

#[test]
fn exchanged_sizes_without_a_turn_in_the_header_are_refused() {
    let files = house(40, |name, shown| png(name, shown.rotate90()));
    let message = load_scene(&files, &LoadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("40 x 48") && message.contains("48 x 40"),
        "{message}"
    );
}

#[test]
fn images_of_a_format_that_is_not_read_are_the_reason_why_there_are_too_few() {
    let files = house(48, |name, _| {
        InputFile::new(&format!("{name}.HEIC"), heic())
    });
    let inspection = inspect_files(&files, &LoadOptions::default());
    assert!(
        inspection
            .files
            .iter()
            .any(|f| f.kind == FileKind::UnreadImage)
    );
    let message = load_scene(&files, &LoadOptions::default())
        .unwrap_err()
        .to_string();
    for part in [
        "4 files are not read",
        "HEIC",
        "s1_01.HEIC",
        "; convert each to JPEG",
    ] {
        assert!(message.contains(part), "{message}");
    }
    assert_eq!(inspection.errors[0], message);
    // Whatever they are called.
    let renamed = InputFile::new("s1_01.jpg", heic());
    assert_eq!(detect(&renamed), FileKind::UnreadImage);
    let message = load_scene(&[renamed], &LoadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(message.starts_with("s1_01.jpg: it is a HEIC"), "{message}");
}

#[test]
fn one_image_of_a_format_that_is_not_read_is_left_out_with_a_warning() {
    let files = house(48, |name, image| match name {
        "s1_02" => InputFile::new("s1_02.heic", heic()),
        _ => png(name, image),
    });
    let scene = load_scene(&files, &LoadOptions::default()).unwrap();
    assert_eq!(scene.views.len(), 3);
    let said = scene
        .warnings
        .iter()
        .any(|w| w.contains("s1_02.heic: it is a HEIC") && w.contains("left out"));
    assert!(said, "{:?}", scene.warnings);
}

#[test]
fn what_is_there_in_another_format_or_no_photograph_is_not_spoken_of() {
    let mut files = house(48, png);
    files.push(InputFile::new(
        "raw/s1_02.dng",
        fixture("tiff/refused/raw.tif"),
    ));
    files.push(InputFile::new("report.pdf", b"%PDF-1.7\n%more".to_vec()));
    let scene = load_scene(&files, &LoadOptions::default()).unwrap();
    assert_eq!(scene.views.len(), 4);
    let said = scene
        .warnings
        .iter()
        .any(|w| w.contains("dng") || w.contains("pdf"));
    assert!(!said, "{:?}", scene.warnings);
    // A video is named where nothing else is there.
    let video = InputFile::new(
        "flight.mp4",
        b"\0\0\0\x18ftypisom\0\0\x02\0isomavc1".to_vec(),
    );
    let message = load_scene(&[video], &LoadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(message.contains("flight.mp4: it is a video"), "{message}");
}

#[test]
fn bands_that_are_not_used_are_named() {
    // A band more than the colours, as GDAL leaves it without a meaning.
    let sample = fixture("tiff/rgbn_pixel_strips_lzw_8_classic_little.tif");
    let names = ["a.tif", "b.tif", "c.tif"];
    let mut files: Vec<_> = names
        .map(|name| InputFile::new(name, sample.clone()))
        .into();
    files.push(InputFile::new(
        "cameras.txt",
        b"1 PINHOLE 40 30 60 60 20 15\n".to_vec(),
    ));
    let images = names
        .iter()
        .enumerate()
        .map(|(i, name)| format!("{0} 0 1 0 0 {0} 0 40 1 {name}\n\n", i + 1));
    files.push(InputFile::new(
        "images.txt",
        images.collect::<String>().into_bytes(),
    ));
    let inspection = inspect_files(&files, &LoadOptions::default());
    let said = inspection.warnings.iter().find(|w| w.contains("band 4"));
    let said = said.unwrap_or_else(|| panic!("{inspection:?}"));
    assert!(said.starts_with("a.tif, b.tif, c.tif: band 4"), "{said}");
}
