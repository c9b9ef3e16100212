//! Every TIFF of the matrix in docs/formats.md, whole and by windows, against the planted pixels.
//!
//! `tests/fixtures/make_tiff.py` wrote them by GDAL; with `--all FOLDER` it writes every
//! combination, which `RIDGELINE_TIFF_SAMPLES=FOLDER` reads.
#![allow(clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};

use ridgeline::orienting::orientation::{FileKind, InputFile, detect};
use ridgeline::photographs::raster::{
    Bands, Photograph, decoding_bytes, image_header, load_image, load_window,
};

/// Largest and mean difference that JPEG may make.
const MOST_OF_JPEG: [f64; 2] = [20.0, 4.0];

fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/tiff")
}

fn folder() -> PathBuf {
    match std::env::var("RIDGELINE_TIFF_SAMPLES") {
        Ok(folder) => folder.into(),
        Err(_) => fixtures(),
    }
}

fn samples(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let paths = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let mut files: Vec<_> = paths
        .filter(|p| p.extension().is_some_and(|e| e == "tif"))
        .map(|p| {
            let name = p.file_name().unwrap().to_string_lossy().into_owned();
            (name, fs::read(&p).unwrap())
        })
        .collect();
    files.sort();
    files
}

/// The planted pixels as a file of this name holds them.
fn planted(name: &str) -> Photograph {
    let read = |png: &str| load_image(png, &fs::read(folder().join(png)).unwrap()).unwrap();
    if name.starts_with("palette") {
        return read("palette.png");
    }
    let deep = image::open(folder().join("expected.png"))
        .unwrap()
        .into_rgb16();
    let is_grey = name.starts_with("grey") || name.starts_with("jpeg_grey");
    let mixed = |p: &image::Rgb<u16>| if is_grey { [p.0[0]; 3] } else { p.0 };
    let image = if name.contains("_16") {
        let (width, height) = deep.dimensions();
        image::ImageBuffer::<image::Rgb<u16>, _>::from_fn(width, height, |x, y| {
            image::Rgb(mixed(deep.get_pixel(x, y)))
        })
        .into()
    } else {
        image::DynamicImage::ImageRgb8(image::RgbImage::from_fn(40, 30, |x, y| {
            image::Rgb(mixed(deep.get_pixel(x, y)).map(|v| (v >> 8) as u8))
        }))
    };
    let mut png = std::io::Cursor::new(Vec::new());
    image.write_to(&mut png, image::ImageFormat::Png).unwrap();
    load_image("planted.png", &png.into_inner()).unwrap()
}

fn difference(a: &image::RgbImage, b: &image::RgbImage) -> [f64; 2] {
    assert_eq!(a.dimensions(), b.dimensions());
    let each = || {
        a.as_raw()
            .iter()
            .zip(b.as_raw())
            .map(|(a, b)| f64::from(a.abs_diff(*b)))
    };
    [
        each().fold(0.0, f64::max),
        each().sum::<f64>() / each().count() as f64,
    ]
}

#[test]
fn every_combination_has_its_pixels() {
    let files = samples(&folder());
    assert!(files.len() > 70, "{}", files.len());
    for (name, bytes) in &files {
        let header = image_header(name, bytes).unwrap();
        assert_eq!((header.width, header.height), (40, 30), "{name}");
        let loaded = load_image(name, bytes).unwrap();
        let planted = planted(name);
        let found = difference(&loaded.rgb, &planted.rgb);
        if name.contains("jpeg") {
            println!("{name}: {found:?}");
            assert!(
                found[0] < MOST_OF_JPEG[0] && found[1] < MOST_OF_JPEG[1],
                "{name}: {found:?}"
            );
        } else {
            assert!(loaded == planted, "{name}: {found:?}");
        }
        for window in [
            [0, 0, 40, 30],
            [3, 5, 20, 14],
            [30, 20, 10, 10],
            [16, 16, 16, 14],
            [39, 0, 1, 30],
        ] {
            let part = load_window(name, bytes, window).unwrap();
            assert!(part == loaded.crop(window), "{name}: {window:?}");
        }
    }
    println!("{} files", files.len());
}

#[test]
fn a_table_of_colours_may_fill_the_low_bytes_only() {
    let name = "palette_none.tif";
    let plain = fs::read(fixtures().join(name)).unwrap();
    let number = |at: usize| u32::from_le_bytes(plain[at..at + 4].try_into().unwrap()) as usize;
    let directory = number(4);
    let entries = number(directory) & 0xffff;
    let mut tags = (0..entries).map(|i| directory + 2 + 12 * i);
    const COLOR_MAP: usize = 320;
    let tag = tags.find(|&at| number(at) & 0xffff == COLOR_MAP).unwrap();
    let (count, place) = (number(tag + 4), number(tag + 8));
    let mut low = plain.clone();
    for value in low[place..place + 2 * count].chunks_exact_mut(2) {
        (value[0], value[1]) = (value[1], 0);
    }
    assert_ne!(low, plain);
    assert!(load_image(name, &low).unwrap() == load_image(name, &plain).unwrap());
}

#[test]
fn bands_that_are_not_used_are_told() {
    for (name, bytes) in samples(&folder()) {
        let expected = match name.split('_').next().unwrap() {
            "rgbn" => Bands::Without(4, 4),
            "rgbnx" => Bands::Without(4, 5),
            "unnamed" if name.contains("rgbn") => Bands::Unnamed(4),
            "unnamed" => Bands::Unnamed(3),
            "jpeg" if name.contains("rgbn") => Bands::Without(4, 4),
            _ => Bands::All,
        };
        let header = image_header(&name, &bytes).unwrap();
        assert_eq!(header.bands, expected, "{name}");
        assert_eq!(
            header.orientation,
            if name.contains("turned") { 6 } else { 1 },
            "{name}"
        );
    }
}

#[test]
fn what_is_not_read_is_named_with_what_to_do() {
    let named = [
        ("ccitt", "CCITT"),
        ("cmyk", "CMYK"),
        ("float", "floating-point"),
        ("jpeg2000", "JPEG 2000"),
        ("jpegxl", "JPEG XL"),
        ("lab", "Lab"),
        ("lerc", "LERC"),
        ("lzma", "LZMA"),
        ("one_bit", "1 bit a sample"),
        ("raw", "raw file"),
        ("signed", "sign"),
        ("twelve_bits", "12 bits a sample"),
        ("webp", "WebP"),
        ("wide", "32 bits a sample"),
    ];
    let files = samples(&folder().join("refused"));
    assert_eq!(files.len(), named.len());
    for ((file, bytes), (name, word)) in files.iter().zip(named) {
        assert!(file.starts_with(name), "{file}");
        let header = image_header(file, bytes).unwrap_err().to_string();
        assert!(header.contains(word) && header.contains("; "), "{header}");
        for whole in [
            load_image(file, bytes),
            load_window(file, bytes, [0, 0, 9, 9]),
        ] {
            assert_eq!(whole.unwrap_err().to_string(), header);
        }
        let kind = detect(&InputFile::new(file, bytes.clone()));
        let is_raw = name == "raw";
        assert_eq!(kind == FileKind::UnreadImage, is_raw, "{file}");
    }
}

#[test]
fn only_what_touches_a_window_is_decoded() {
    for (name, bytes) in samples(&fixtures()) {
        // The last strip or tile is damaged where it is the last in the file too.
        if !name.starts_with("rgb_pixel_strips_deflate")
            && !name.starts_with("rgb_pixel_strips_lzw")
        {
            continue;
        }
        let cut = &bytes[..bytes.len() - 40];
        // Sixteen bits need the brightest value of all.
        assert!(
            load_window(&name, cut, [0, 0, 40, 7]).is_ok() || name.contains("_16"),
            "{name}"
        );
        let message = load_image(&name, cut).unwrap_err().to_string();
        assert!(message.contains("strip 5 of 5"), "{message}");
        assert!(decoding_bytes(&bytes, [40, 30]) <= 40 * 7 * 6);
    }
}
