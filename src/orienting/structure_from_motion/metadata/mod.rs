//! What a photograph's file says of its camera: EXIF and XMP.
//!
//! ```text
//! tiff_tags   the tags of EXIF, which is a TIFF without pixels
//! xmp         attributes of drones' gimbals, by name
//! ```

mod tiff_tags;
mod xmp;

use serde::{Deserialize, Serialize};

use self::tiff_tags::Tags;

/// What is stated of a photograph.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PhotoMetadata {
    /// Maker and model of the camera; empty where not stated.
    pub camera: String,
    /// Focal length, millimetres.
    pub focal_mm: Option<f64>,
    /// Focal length in pixels of the photograph as it is stored, from whatever states it.
    pub focal_px: Option<f64>,
    /// When it was taken, "YYYY-MM-DD HH:MM:SS" by the camera's clock.
    pub taken: Option<String>,
    /// Longitude and latitude, degrees, WGS84.
    pub position: Option<[f64; 2]>,
    /// Is the position without the letters of its hemispheres? It counts as north and east then.
    pub lacks_hemispheres: bool,
    /// Height of the position, metres above whatever the receiver takes for zero.
    pub height_m: Option<f64>,
    /// Yaw (from north, clockwise), pitch (0 level, -90 down) and roll of the camera, degrees.
    pub yaw_pitch_roll: Option<[f64; 3]>,
}

/// Diagonal of a frame of 35 mm film, millimetres.
const FILM_DIAGONAL_MM: f64 = 43.266_615;

impl PhotoMetadata {
    /// Reads the header of a JPEG or TIFF of `size` pixels; what is damaged counts as not stated.
    pub fn read(bytes: &[u8], size: [u32; 2]) -> Self {
        let (exif, xmp) = if bytes.starts_with(&[0xff, 0xd8]) {
            (segment(bytes, EXIF), segment(bytes, XMP))
        } else {
            (Some(bytes), None)
        };
        let tags = exif.and_then(Tags::read).unwrap_or_default();
        let xmp = xmp.map(String::from_utf8_lossy).unwrap_or_default();
        // XMP states degrees with their sign.
        let signed = xmp::position(&xmp).filter(|_| !tags.has_hemispheres);
        let is_place = |p: &[f64; 2]| p[0].abs() <= 180.0 && p[1].abs() <= 90.0 && *p != [0.0, 0.0];
        let position = signed.or(tags.position).filter(is_place);
        Self {
            camera: [&tags.make, &tags.model]
                .map(|s| s.as_str())
                .join(" ")
                .trim()
                .to_owned(),
            focal_mm: tags.focal_mm.filter(is_positive),
            focal_px: focal_px(&tags, xmp::number(&xmp, "CalibratedFocalLength"), size),
            taken: tags.taken.as_deref().and_then(date_and_time),
            lacks_hemispheres: position.is_some() && signed.is_none() && !tags.has_hemispheres,
            height_m: (tags.height_m.filter(|h| *h != 0.0))
                .or_else(|| xmp::number(&xmp, "AbsoluteAltitude"))
                .or(tags.height_m)
                .filter(|_| position.is_some()),
            position,
            yaw_pitch_roll: xmp::yaw_pitch_roll(&xmp),
        }
    }
}

/// EXIF's "YYYY:MM:DD HH:MM:SS", which clocks that were never set fill with zeros or blanks.
fn date_and_time(text: &str) -> Option<String> {
    let has_form = |(byte, form): (u8, &u8)| match form {
        b'0' => byte.is_ascii_digit(),
        b'-' => matches!(byte, b':' | b'-'),
        _ => byte == *form,
    };
    let mut pairs = text.bytes().zip(b"0000-00-00 00:00:00");
    let is_stated = text.len() == 19 && pairs.all(has_form) && !text.starts_with("0000");
    is_stated.then(|| text[..10].replace(':', "-") + &text[10..])
}

fn is_positive(value: &f64) -> bool {
    value.is_finite() && *value > 0.0
}

/// The focal length in pixels: calibrated by the maker, else by the size of the sensor's pixels,
/// else by the field of view on film.
fn focal_px(tags: &Tags, calibrated: Option<f64>, [width, height]: [u32; 2]) -> Option<f64> {
    let (width, height) = (f64::from(width), f64::from(height));
    // A reduced copy keeps the numbers of the original, and one that a program has turned those
    // from before: the longer sides are comparable, the widths may not be.
    let of_recorded = match [tags.width, tags.height].map(|side| side.filter(is_positive)) {
        [Some(w), Some(h)] => Some(width.max(height) / w.max(h)),
        [recorded, _] => recorded.map(|w| width / w),
    };
    let of_maker = calibrated.filter(|_| of_recorded == Some(1.0));
    let of_pixels = match (tags.focal_mm, tags.pixels_per_mm) {
        (Some(mm), Some(density)) => of_recorded.map(|scale| mm * density * scale),
        _ => None,
    };
    let diagonal = (width * width + height * height).sqrt();
    let of_film = tags.focal_35mm.map(|mm| mm / FILM_DIAGONAL_MM * diagonal);
    // From fisheye to long telephoto lenses.
    let is_possible = |f: &f64| (0.2 * diagonal..20.0 * diagonal).contains(f);
    [of_maker, of_pixels, of_film]
        .into_iter()
        .flatten()
        .find(is_possible)
}

const EXIF: &[u8] = b"Exif\0\0";
const XMP: &[u8] = b"http://ns.adobe.com/xap/1.0/\0";

/// The content of a JPEG's application segment that starts like this.
fn segment<'a>(bytes: &'a [u8], start: &[u8]) -> Option<&'a [u8]> {
    let mut at = 2;
    loop {
        let header = bytes.get(at..at + 4)?;
        // Image data follow, or no marker.
        if header[0] != 0xff || header[1] == 0xda {
            return None;
        }
        let length = usize::from(u16::from_be_bytes([header[2], header[3]]));
        let content = bytes.get(at + 4..at + 2 + length)?;
        if header[1] == 0xe1 && content.starts_with(start) {
            return Some(&content[start.len()..]);
        }
        at += 2 + length;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A JPEG's head with EXIF of a drone (focal lengths, position) and gimbal angles.
    pub(super) fn head(order: &[u8; 2]) -> Vec<u8> {
        let exif = tiff_tags::tests::written(order);
        let xmp = br#"<x drone-dji:GimbalYawDegree="+91.5" drone-dji:GimbalPitchDegree="-89.90"
            drone-dji:GimbalRollDegree="+0.00"/>"#;
        let mut bytes = vec![0xff, 0xd8];
        for (start, content) in [(EXIF, &exif[..]), (XMP, &xmp[..])] {
            bytes.extend([0xff, 0xe1]);
            bytes.extend(((start.len() + content.len() + 2) as u16).to_be_bytes());
            bytes.extend(start);
            bytes.extend(content);
        }
        bytes.extend([0xff, 0xda, 0, 0]);
        bytes
    }

    #[test]
    fn what_a_drone_states_is_read_in_both_byte_orders() {
        for order in [b"II", b"MM"] {
            let stated = PhotoMetadata::read(&head(order), [800, 600]);
            assert_eq!(stated.camera, "DJI FC300S");
            assert_eq!(stated.focal_mm, Some(3.61));
            assert!((stated.focal_px.unwrap() - 20.0 / FILM_DIAGONAL_MM * 1000.0).abs() < 1e-9);
            assert_eq!(stated.taken.as_deref(), Some("2024-05-06 10:11:12"));
            let [lon, lat] = stated.position.unwrap();
            assert!((lon + 82.697_394).abs() < 1e-6 && (lat - 28.041_25).abs() < 1e-6);
            assert_eq!(stated.height_m, Some(5.5));
            assert!(!stated.lacks_hemispheres);
            assert_eq!(stated.yaw_pitch_roll, Some([91.5, -89.9, 0.0]));
        }
    }

    #[test]
    fn a_number_that_is_none_leaves_the_others() {
        let whole = head(b"II");
        let with = |old: &[u8], new: &[u8]| {
            let at = whole.windows(old.len()).position(|w| w == old).unwrap();
            let mut bytes = whole.clone();
            bytes[at..at + old.len()].copy_from_slice(new);
            PhotoMetadata::read(&bytes, [800, 600])
        };
        let numbers = |pair: [u32; 2]| pair.map(u32::to_le_bytes).concat();
        let none = numbers([0, 0]);
        let seconds = with(&numbers([285, 10]), &none).position.unwrap();
        assert!((seconds[1] - 28.0 - 2.0 / 60.0).abs() < 1e-9, "{seconds:?}");
        let height = with(&numbers([55, 10]), &none);
        assert_eq!(height.height_m, None);
        assert!(height.position.is_some());
        assert_eq!(with(&numbers([28, 1]), &none).position, None);
        // Another tag where the letter of the latitude was.
        let unnamed = with(b"\x01\0\x02\0\x02\0\0\0N", b"\xff\xee\x02\0\x02\0\0\0N");
        assert!(unnamed.lacks_hemispheres && unnamed.position.is_some());
    }

    #[test]
    fn positions_and_heights_are_read_as_cameras_write_them() {
        let numbers = |pairs: &[[u32; 2]]| -> Vec<u8> {
            pairs
                .iter()
                .flatten()
                .flat_map(|n| n.to_le_bytes())
                .collect()
        };
        let latitude = numbers(&[[28, 1], [2, 1], [285, 10]]);
        let height = numbers(&[[55, 10]]);
        let letter = |letter: u8| [&b"\x01\0\x02\0\x02\0\0\0"[..], &[letter]].concat();
        let level = |kind: u8, level: u8| [5, 0, kind, 0, 1, 0, 0, 0, level].to_vec();
        let gimbal = b"GimbalRollDegree=\"+0.00\"".to_vec();
        let xmp = |text: &str| format!("{text:25}").into_bytes();
        let (north, above) = (28.041_25, Some(5.5));
        for (old, new, lat, stated) in [
            (letter(b'N'), letter(b's'), Some(-north), above),
            (letter(b'N'), letter(b'S'), Some(-north), above),
            (letter(b'N'), letter(b' '), Some(north), above),
            (
                latitude.clone(),
                numbers(&[[28_041_250, 1_000_000], [0, 1], [0, 1]]),
                Some(north),
                above,
            ),
            (
                latitude.clone(),
                numbers(&[[28, 1], [2475, 1000], [0, 0]]),
                Some(north),
                above,
            ),
            (
                latitude.clone(),
                numbers(&[[28_041_250, 1_000_000], [0, 0], [0, 0]]),
                Some(north),
                above,
            ),
            (latitude.clone(), numbers(&[[0, 0]; 3]), None, None),
            (
                latitude.clone(),
                numbers(&[[91, 1], [0, 1], [0, 1]]),
                None,
                None,
            ),
            (latitude, numbers(&[[0, 1]; 3]), Some(0.0), above),
            (level(1, 0), level(1, 1), Some(north), Some(-5.5)),
            (level(1, 0), level(1, 3), Some(north), Some(-5.5)),
            (level(1, 0), level(1, 2), Some(north), above),
            (level(1, 0), level(2, b'1'), Some(north), Some(-5.5)),
            (height.clone(), numbers(&[[0, 1]]), Some(north), Some(0.0)),
            (height.clone(), numbers(&[[0, 0]]), Some(north), None),
            (height, numbers(&[[u32::MAX, 0]]), Some(north), None),
            (
                gimbal,
                xmp("AbsoluteAltitude=\"+77.25\""),
                Some(north),
                above,
            ),
        ] {
            let mut bytes = head(b"II");
            let at = bytes.windows(old.len()).position(|w| w == old).unwrap();
            bytes[at..at + new.len()].copy_from_slice(&new);
            let found = PhotoMetadata::read(&bytes, [800, 600]);
            let is_near = match (found.position, lat) {
                (Some([_, found]), Some(lat)) => (found - lat).abs() < 1e-6,
                (found, lat) => found.is_none() && lat.is_none(),
            };
            assert!(is_near && found.height_m == stated, "{new:?}: {found:?}");
        }
    }

    #[test]
    fn a_clock_that_was_never_set_states_no_time() {
        let texts = [
            "0000:00:00 00:00:00",
            "    :  :     :  :  ",
            "2024:05:06",
            "",
        ];
        assert_eq!(texts.map(date_and_time), [const { None }; 4]);
    }

    #[test]
    fn a_turned_or_reduced_copy_keeps_the_field_of_view() {
        let tags = Tags {
            focal_mm: Some(8.8),
            pixels_per_mm: Some(400.0),
            width: Some(4000.0),
            height: Some(3000.0),
            ..Tags::default()
        };
        let of = |calibrated, size| focal_px(&tags, calibrated, size).unwrap().round();
        assert_eq!(of(None, [4000, 3000]), 3520.0);
        assert_eq!(of(None, [3000, 4000]), 3520.0);
        assert_eq!(of(None, [1500, 2000]), 1760.0);
        assert_eq!(of(Some(3500.0), [3000, 4000]), 3500.0);
        assert_eq!(of(Some(3500.0), [2000, 1500]), 1760.0);
    }

    #[test]
    fn damaged_headers_state_nothing_and_do_no_harm() {
        let whole = head(b"II");
        for end in 0..whole.len() {
            PhotoMetadata::read(&whole[..end], [800, 600]);
        }
        for i in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[i] ^= 0xff;
            PhotoMetadata::read(&bytes, [800, 600]);
        }
        assert_eq!(PhotoMetadata::read(b"", [1, 1]), PhotoMetadata::default());
    }
}
