//! The tags of EXIF that say how a photograph was taken (CIPA DC-008, "Exif 2.32").

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

/// A directory's entry.
struct Entry<'a> {
    tag: u16,
    kind: u16,
    value: &'a [u8],
}

/// Bytes and their order.
struct Reader<'a> {
    bytes: &'a [u8],
    is_little: bool,
}

impl Tags {
    /// Reads a TIFF header and what it leads to; `None` where it is none.
    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let reader = Reader {
            bytes,
            is_little: match bytes.get(..2)? {
                b"II" => true,
                b"MM" => false,
                _ => return None,
            },
        };
        if reader.u16(2)? != 42 {
            return None;
        }
        let mut tags = Self::default();
        let (mut exif, mut gps) = (Vec::new(), Vec::new());
        for entry in reader.directory(reader.u32(4)?) {
            match entry.tag {
                0x010f => tags.make = text(entry.value),
                0x0110 => tags.model = text(entry.value),
                0x8769 => exif = reader.directory(reader.whole(&entry)?),
                0x8825 => gps = reader.directory(reader.whole(&entry)?),
                _ => {}
            }
        }
        // Inches unless stated.
        let mut unit_mm = 25.4;
        for entry in &exif {
            let number = reader.numbers(entry).first().copied();
            match entry.tag {
                0x9003 => tags.taken = Some(text(entry.value)),
                0x920a => tags.focal_mm = number,
                0xa405 => tags.focal_35mm = number.filter(|mm| *mm > 0.0),
                0xa20e => tags.pixels_per_mm = number,
                0xa002 => tags.width = number,
                0xa003 => tags.height = number,
                0xa210 => unit_mm = if number == Some(3.0) { 10.0 } else { 25.4 },
                _ => {}
            }
        }
        tags.pixels_per_mm = tags.pixels_per_mm.map(|n| n / unit_mm);
        tags.set_position(&reader, &gps);
        Some(tags)
    }
}

impl Tags {
    /// Longitude, latitude and height, each for itself: one that is no number leaves the others.
    fn set_position(&mut self, reader: &Reader, gps: &[Entry]) {
        let of = |tag: u16| gps.iter().find(|e| e.tag == tag);
        let angle = |tag: u16| {
            let numbers = reader.numbers(of(tag)?);
            // Decimal minutes leave 0/0 for the seconds, and decimal degrees for both.
            let finer = |i: usize| numbers.get(i).copied().filter(|v| v.is_finite());
            let parts = [finer(0)?, finer(1).unwrap_or(0.0), finer(2).unwrap_or(0.0)];
            Some(parts[0] + parts[1] / 60.0 + parts[2] / 3600.0)
        };
        let sign = |tag: u16, [positive, negative]: [u8; 2]| {
            let letter = of(tag)?.value.first()?.to_ascii_uppercase();
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
        let below = [1, 3, b'1'];
        let is_below = of(5)
            .and_then(|e| e.value.first())
            .is_some_and(|v| below.contains(v));
        let height = of(6).and_then(|e| reader.numbers(e).first().copied());
        // Drones write a height above the sea as one below it where its sign does not fit.
        let signed = height.map(|h| if is_below && h > 0.0 { -h } else { h });
        self.height_m = signed.filter(|h| h.is_finite());
    }
}

fn text(value: &[u8]) -> String {
    let end = value.iter().position(|&b| b == 0).unwrap_or(value.len());
    String::from_utf8_lossy(&value[..end]).trim().to_owned()
}

impl<'a> Reader<'a> {
    fn u16(&self, at: usize) -> Option<u16> {
        let b: [u8; 2] = self.bytes.get(at..at + 2)?.try_into().ok()?;
        Some(if self.is_little {
            u16::from_le_bytes(b)
        } else {
            u16::from_be_bytes(b)
        })
    }

    fn u32(&self, at: usize) -> Option<usize> {
        let b: [u8; 4] = self.bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        Some(if self.is_little {
            u32::from_le_bytes(b)
        } else {
            u32::from_be_bytes(b)
        } as usize)
    }

    /// The entries of a directory that lie within the bytes.
    fn directory(&self, at: usize) -> Vec<Entry<'a>> {
        let count = usize::from(self.u16(at).unwrap_or(0));
        (0..count)
            .filter_map(|i| self.entry(at + 2 + 12 * i))
            .collect()
    }

    fn entry(&self, at: usize) -> Option<Entry<'a>> {
        let (tag, kind) = (self.u16(at)?, self.u16(at + 2)?);
        let length = self.u32(at + 4)?.checked_mul(size_of_kind(kind)?)?;
        let start = if length <= 4 {
            at + 8
        } else {
            self.u32(at + 8)?
        };
        let value = self.bytes.get(start..start.checked_add(length)?)?;
        Some(Entry { tag, kind, value })
    }

    fn whole(&self, entry: &Entry) -> Option<usize> {
        self.numbers(entry).first().map(|n| *n as usize)
    }

    fn numbers(&self, entry: &Entry) -> Vec<f64> {
        let part = Reader {
            bytes: entry.value,
            is_little: self.is_little,
        };
        let size = size_of_kind(entry.kind).unwrap_or(1);
        let number = |at: usize| {
            let signed = |v: usize| f64::from(v as u32 as i32);
            match entry.kind {
                1 => part.bytes.get(at).map(|b| f64::from(*b)),
                3 => part.u16(at).map(f64::from),
                4 => part.u32(at).map(|v| v as f64),
                5 => Some(part.u32(at)? as f64 / part.u32(at + 4)? as f64),
                9 => part.u32(at).map(signed),
                10 => Some(signed(part.u32(at)?) / signed(part.u32(at + 4)?)),
                _ => None,
            }
        };
        (0..entry.value.len() / size)
            .map_while(|i| number(i * size))
            .collect()
    }
}

fn size_of_kind(kind: u16) -> Option<usize> {
    match kind {
        1 | 2 | 6 | 7 => Some(1),
        3 | 8 => Some(2),
        4 | 9 | 11 => Some(4),
        5 | 10 | 12 => Some(8),
        _ => None,
    }
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
