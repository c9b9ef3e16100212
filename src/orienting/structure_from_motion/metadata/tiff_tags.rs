//! The tags of EXIF that say how a photograph was taken (CIPA DC-008, "Exif 2.32").

use crate::photographs::raster::{Directory, is_tiff, tiff_tags};

/// What the tags state.
#[derive(Debug, Default)]
pub(super) struct Tags {
    pub make: String,
    pub model: String,
    pub focal_mm: Option<f64>,
    /// The focal length that has the same field of view on 35 mm film.
    pub focal_35mm: Option<f64>,
    /// Pixels of the sensor, at the width and height that the camera recorded.
    pub pixels_per_mm: Option<f64>,
    pub width: Option<f64>,
    pub height: Option<f64>,
    pub taken: Option<String>,
    /// Longitude, latitude.
    pub position: Option<[f64; 2]>,
    /// Are the letters of both hemispheres stated?
    pub has_hemispheres: bool,
    pub height_m: Option<f64>,
}

impl Tags {
    /// Reads a TIFF header and what it leads to; `None` where it is none.
    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let main = Directory::chain(bytes.into()).next();
        let main = main.filter(|_| is_tiff(bytes))?;
        let below = |tag: u16| main.below(tag).next();
        let exif = below(tiff_tags::EXIF);
        let exif_text = |tag: u16| exif.as_ref()?.raw(tag).map(text);
        let number = |tag: u16| exif.as_ref()?.reals(tag).first().copied();
        // Inches unless stated.
        let unit_mm = if number(0xa210) == Some(3.0) {
            10.0
        } else {
            25.4
        };
        let mut tags = Self {
            make: main.raw(0x010f).map(text).unwrap_or_default(),
            model: main.raw(0x0110).map(text).unwrap_or_default(),
            taken: exif_text(0x9003),
            focal_mm: number(0x920a),
            focal_35mm: number(0xa405).filter(|mm| *mm > 0.0),
            pixels_per_mm: number(0xa20e).map(|n| n / unit_mm),
            width: number(0xa002),
            height: number(0xa003),
            ..Self::default()
        };
        if let Some(gps) = below(tiff_tags::GPS) {
            tags.set_position(&gps);
        }
        Some(tags)
    }

    /// Longitude, latitude and height, each for itself: one that is no number leaves the others.
    fn set_position(&mut self, gps: &Directory) {
        let angle = |tag: u16| {
            let numbers = gps.reals(tag);
            // Decimal minutes leave 0/0 for the seconds, and decimal degrees for both.
            let finer = |i: usize| numbers.get(i).copied().filter(|v| v.is_finite());
            let parts = [finer(0)?, finer(1).unwrap_or(0.0), finer(2).unwrap_or(0.0)];
            Some(parts[0] + parts[1] / 60.0 + parts[2] / 3600.0)
        };
        let first = |tag: u16| gps.raw(tag)?.first().copied();
        let sign = |tag: u16, [positive, negative]: [u8; 2]| {
            let letter = first(tag)?.to_ascii_uppercase();
            match letter {
                _ if letter == positive => Some(1.0),
                _ if letter == negative => Some(-1.0),
                _ => None,
            }
        };
        let signs = [sign(3, *b"EW"), sign(1, *b"NS")];
        self.has_hemispheres = signs.iter().all(Option::is_some);
        let [east, north] = signs.map(|sign| sign.unwrap_or(1.0));
        self.position = angle(4)
            .zip(angle(2))
            .map(|(lon, lat)| [lon * east, lat * north]);
        // 1 is below the sea, 3 below the ellipsoid (Exif 3.0); some write the digit.
        let is_below = first(5).is_some_and(|level| [1, 3, b'1'].contains(&level));
        let height = gps.reals(6).first().copied();
        // Drones write a height above the sea as one below it where its sign does not fit.
        let signed = height.map(|h| if is_below && h > 0.0 { -h } else { h });
        self.height_m = signed.filter(|h| h.is_finite());
    }
}

/// Text up to its final zero.
fn text(value: &[u8]) -> String {
    let end = value.iter().position(|&b| b == 0).unwrap_or(value.len());
    String::from_utf8_lossy(&value[..end]).trim().to_owned()
}

#[cfg(test)]
pub(super) mod tests {
    /// EXIF of a drone in a byte order ("II" or "MM").
    pub(in super::super) fn written(order: &[u8; 2]) -> Vec<u8> {
        let little = order == b"II";
        let u16s = |v: u16| {
            if little {
                v.to_le_bytes()
            } else {
                v.to_be_bytes()
            }
        };
        let u32s = |v: u32| {
            if little {
                v.to_le_bytes()
            } else {
                v.to_be_bytes()
            }
        };
        let rationals = |list: &[[u32; 2]]| -> Vec<u8> {
            list.iter().flatten().flat_map(|&v| u32s(v)).collect()
        };
        let mut bytes = order.to_vec();
        bytes.extend(u16s(42));
        bytes.extend(u32s(8));
        // Three directories of fixed places; values that do not fit follow them.
        type Written = Vec<(u16, u16, u32, Vec<u8>)>;
        let directories: [Written; 3] = [
            vec![
                (0x010f, 2, 4, b"DJI\0".to_vec()),
                (0x0110, 2, 7, b"FC300S\0".to_vec()),
                (0x8769, 4, 1, u32s(200).to_vec()),
                (0x8825, 4, 1, u32s(300).to_vec()),
            ],
            vec![
                (0x9003, 2, 20, b"2024:05:06 10:11:12\0".to_vec()),
                (0x920a, 5, 1, rationals(&[[361, 100]])),
                (0xa405, 3, 1, u16s(20).to_vec()),
            ],
            vec![
                (1, 2, 2, b"N\0".to_vec()),
                (2, 5, 3, rationals(&[[28, 1], [2, 1], [285, 10]])),
                (3, 2, 2, b"W\0".to_vec()),
                (4, 5, 3, rationals(&[[82, 1], [41, 1], [506_184, 10_000]])),
                (5, 1, 1, vec![0]),
                (6, 5, 1, rationals(&[[55, 10]])),
            ],
        ];
        for (start, entries) in [8, 200, 300].into_iter().zip(directories) {
            bytes.resize(start, 0);
            let mut apart = start + 2 + 12 * entries.len();
            let mut values = Vec::new();
            bytes.extend(u16s(entries.len() as u16));
            for (tag, kind, count, value) in entries {
                bytes.extend(u16s(tag));
                bytes.extend(u16s(kind));
                bytes.extend(u32s(count));
                if value.len() <= 4 {
                    let mut value = value;
                    value.resize(4, 0);
                    bytes.extend(value);
                } else {
                    bytes.extend(u32s(apart as u32));
                    apart += value.len();
                    values.extend(value);
                }
            }
            bytes.extend(values);
        }
        bytes
    }
}
