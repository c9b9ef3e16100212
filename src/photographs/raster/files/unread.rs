//! Images that cannot be read, by their content: what they are and what to do.

use super::excerpt::Excerpt;
use super::tiff::{Directory, is_tiff, tags};

/// A format that is known by name only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnreadImageFormat {
    /// What such a file is, in a sentence after "it is".
    pub name: &'static str,
    /// What to do with it.
    pub advice: &'static str,
    /// Is it a photograph or another image? Documents and videos lie beside photographs often.
    pub is_image: bool,
}

const fn image(name: &'static str, advice: &'static str) -> UnreadImageFormat {
    UnreadImageFormat {
        name,
        advice,
        is_image: true,
    }
}

const PHONE: &str = "convert it to JPEG at its full size, with its metadata kept";
const DEVELOP: &str = "develop it to JPEG or TIFF at its full size as the images were that were \
                       oriented, without a correction of the lens";
const CONVERT: &str = "convert it to TIFF, PNG or JPEG at its full size";

const HEIC: UnreadImageFormat = image("a HEIC (HEIF) image", PHONE);
const AVIF: UnreadImageFormat = image("an AVIF image", PHONE);
const RAW: UnreadImageFormat = image("a camera's raw file", DEVELOP);
const DNG: UnreadImageFormat = image("a camera's raw file (DNG)", DEVELOP);
const CANON: UnreadImageFormat = image("a camera's raw file (Canon)", DEVELOP);
const PHASE_ONE: UnreadImageFormat = image("a camera's raw file (Phase One IIQ)", DEVELOP);
const JPEG_2000: UnreadImageFormat = image("a JPEG 2000 image", CONVERT);
const JPEG_XL: UnreadImageFormat = image("a JPEG XL image", CONVERT);
const VIDEO: UnreadImageFormat = UnreadImageFormat {
    name: "a video",
    advice: "give the single frames that were oriented, as JPEG or PNG",
    is_image: false,
};

/// Formats whose files begin with certain bytes.
const STARTS: [(&[u8], UnreadImageFormat); 18] = [
    (
        b"FUJIFILMCCD-RAW",
        image("a camera's raw file (Fujifilm)", DEVELOP),
    ),
    (b"IIRO", image("a camera's raw file (Olympus)", DEVELOP)),
    (b"IIRS", image("a camera's raw file (Olympus)", DEVELOP)),
    (b"MMOR", image("a camera's raw file (Olympus)", DEVELOP)),
    (b"IIU\0", image("a camera's raw file (Panasonic)", DEVELOP)),
    (b"II\x1a\0\0\0HEAPCCDR", CANON),
    (b"FOVb", image("a camera's raw file (Sigma)", DEVELOP)),
    (b"\0MRM", image("a camera's raw file (Minolta)", DEVELOP)),
    (b"\xff\x4f\xff\x51", JPEG_2000),
    (b"\xff\x0a", JPEG_XL),
    (b"GIF8", image("a GIF image", CONVERT)),
    (b"8BPS", image("a Photoshop image (PSD)", CONVERT)),
    (b"\x76\x2f\x31\x01", image("an OpenEXR image", CONVERT)),
    (b"msid", image("a MrSID image", CONVERT)),
    (
        b"EHFA_HEADER_TAG",
        image("an ERDAS Imagine image (.img)", CONVERT),
    ),
    (b"NITF0", image("a NITF image", CONVERT)),
    (
        b"%PDF-",
        UnreadImageFormat {
            name: "a PDF document",
            advice: "give the photographs themselves, as JPEG, PNG or TIFF",
            is_image: false,
        },
    ),
    (b"\x1a\x45\xdf\xa3", VIDEO),
];

/// What a file is that holds an image in a format that is not read; `None` for all others.
pub fn unread_image_format<'a>(
    path: &str,
    bytes: impl Into<Excerpt<'a>>,
) -> Option<UnreadImageFormat> {
    let excerpt = bytes.into();
    let bytes = excerpt.start();
    if is_tiff(bytes) {
        return raw_in_tiff(excerpt);
    }
    if let Some(format) = by_boxes(bytes) {
        return Some(format);
    }
    let is_video = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"AVI ");
    let is_webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    // Four bytes that are free stand after the length, and the length of the header further on.
    let is_bmp = bytes.starts_with(b"BM")
        && bytes.get(6..10) == Some(&[0; 4])
        && matches!(bytes.get(14), Some(12 | 40 | 52 | 56 | 64 | 108 | 124));
    let is_ecw = bytes.first() == Some(&b'e') && path.to_ascii_lowercase().ends_with(".ecw");
    let simple = STARTS.iter().find(|(start, _)| bytes.starts_with(start));
    [
        (is_video, VIDEO),
        (is_webp, image("a WebP image", CONVERT)),
        (is_bmp, image("a BMP image", CONVERT)),
        (is_ecw, image("an ECW image", CONVERT)),
    ]
    .into_iter()
    .find_map(|(is_it, format)| is_it.then_some(format))
    .or(simple.map(|(_, format)| *format))
}

/// The formats whose files are made of boxes: the first names the kind, others that it fits.
fn by_boxes(bytes: &[u8]) -> Option<UnreadImageFormat> {
    match bytes.get(4..12)? {
        b"jP  \r\n\x87\n" => return Some(JPEG_2000),
        b"JXL \r\n\x87\n" => return Some(JPEG_XL),
        _ => {}
    }
    // QuickTime of old has no box of kinds.
    if [b"moov", b"mdat"]
        .iter()
        .any(|kind| bytes.get(4..8) == Some(*kind))
    {
        return Some(VIDEO);
    }
    if bytes.get(4..8)? != b"ftyp" {
        return None;
    }
    let length = u32::from_be_bytes(bytes.get(..4)?.try_into().ok()?) as usize;
    let kinds = &bytes[8..length.clamp(12, 256).min(bytes.len())];
    let has = |kind: &[u8; 4]| kinds.chunks_exact(4).any(|k| k == kind);
    Some(if has(b"crx ") {
        CANON
    } else if has(b"avif") || has(b"avis") {
        AVIF
    } else if kinds.starts_with(b"jp2") || kinds.starts_with(b"jpx") {
        JPEG_2000
    } else if [
        b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1",
    ]
    .iter()
    .any(|kind| has(kind))
    {
        HEIC
    } else {
        VIDEO
    })
}

/// Raw files that are TIFFs: the first image in them is a thumbnail, or a sensor's pattern.
fn raw_in_tiff(excerpt: Excerpt) -> Option<UnreadImageFormat> {
    // Photometric interpretations of DNG, which others use too: a colour filter array, and linear
    // raw values.
    const PATTERN_OF_A_SENSOR: u64 = 32803;
    const LINEAR_RAW: u64 = 34892;
    // Directories that are looked at: raw files have a thumbnail, a preview and the sensor's
    // values, in any order. Assumption.
    const MOST_DIRECTORIES: usize = 8;
    let bytes = excerpt.start();
    if bytes.get(8..10) == Some(b"CR") {
        return Some(CANON);
    }
    if [b"IIII", b"MMMM"]
        .iter()
        .any(|mark| bytes.get(8..12) == Some(*mark))
    {
        return Some(PHASE_ONE);
    }
    let is_raw = |directory: &Directory| {
        let meaning = directory.number(tags::PHOTOMETRIC);
        meaning.is_some_and(|m| [PATTERN_OF_A_SENSOR, LINEAR_RAW].contains(&m))
    };
    for directory in Directory::chain(excerpt).take(MOST_DIRECTORIES) {
        if directory.raw(tags::DNG_VERSION).is_some() {
            return Some(DNG);
        }
        if is_raw(&directory)
            || directory
                .below(tags::SUB_IFDS)
                .take(MOST_DIRECTORIES)
                .any(|d| is_raw(&d))
        {
            return Some(RAW);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_by_content() {
        let boxes =
            |kinds: &[u8]| [&(8 + kinds.len() as u32).to_be_bytes(), b"ftyp", kinds].concat();
        let riff = |kind: &[u8]| [b"RIFF\x10\0\0\0", kind, b"VP8 "].concat();
        let bmp = [&b"BM\x46\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0"[..], &[0; 40]].concat();
        for (bytes, part) in [
            (boxes(b"heic\0\0\0\0mif1heic"), "HEIC"),
            (boxes(b"mif1\0\0\0\0mif1heix"), "HEIC"),
            (boxes(b"mif1\0\0\0\0mif1avifmiaf"), "AVIF"),
            (boxes(b"crx \0\0\0\x01crx isom"), "Canon"),
            (boxes(b"qt  \0\0\0\0qt  "), "video"),
            (boxes(b"isom\0\0\x02\0isomiso2avc1mp41"), "video"),
            (
                b"\0\0\0\x0cjP  \r\n\x87\n\0\0\0\x14ftypjp2 ".to_vec(),
                "JPEG 2000",
            ),
            (b"\0\0\0\x0cJXL \r\n\x87\n".to_vec(), "JPEG XL"),
            (riff(b"WEBP"), "WebP"),
            (riff(b"AVI "), "video"),
            (bmp, "BMP"),
            (b"GIF89a".to_vec(), "GIF"),
            (b"%PDF-1.7\n".to_vec(), "PDF"),
            (b"II*\0\x10\0\0\0CR\x02\0".to_vec(), "Canon"),
            (b"II*\0\x60\0\0\0IIIIwaR".to_vec(), "Phase One"),
            (b"FUJIFILMCCD-RAW 0201".to_vec(), "Fujifilm"),
        ] {
            let format = unread_image_format("a.jpg", &bytes).expect(part);
            assert!(format.name.contains(part), "{part}: {}", format.name);
            assert_eq!(format.is_image, !["video", "PDF"].contains(&part));
        }
        for other in [
            &b"\xff\xd8\xff\xe1"[..],
            b"\x89PNG\r\n\x1a\n",
            b"",
            b"BM 12 4.0",
            b"eac 1 2",
        ] {
            assert_eq!(unread_image_format("a.txt", other), None);
        }
    }
}
