//! What a LAS file states of itself, at fixed places of its header and in its variable records.

use crate::orienting::known::geo_keys::{self, GeoKeys};
use crate::orienting::known::system::StatedSystem;

/// The header as far as it is used.
#[derive(Debug)]
pub(super) struct Header {
    /// Point format, 0 to 10.
    pub(super) format: u8,
    /// Are the records compressed by LASzip?
    pub(super) is_compressed: bool,
    /// Bytes of an uncompressed record.
    pub(super) record_length: u16,
    pub(super) count: u64,
    /// Where the records begin.
    pub(super) data: usize,
    scale: [f64; 3],
    pub(super) offset: [f64; 3],
    header_size: usize,
    /// Number of variable records behind the header.
    variable: u32,
    /// Where the extended variable records begin, and how many they are.
    extended: (u64, u32),
}

/// Shortest header, of versions 1.0 to 1.2, and that of 1.4.
const SHORTEST_HEADER: usize = 227;
const HEADER_OF_1_4: usize = 375;
/// Bytes of the shortest record of each point format.
const LENGTHS: [u16; 11] = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67];
/// Bytes of the heads of variable records and of extended ones (LAS 1.4).
const VARIABLE_HEAD: usize = 54;
const EXTENDED_HEAD: usize = 60;
/// Records of a projection, after GeoTIFF and as well-known text.
const PROJECTION: &str = "LASF_Projection";
const GEO_KEYS: u16 = 34_735;
const WELL_KNOWN_TEXT: u16 = 2112;

impl Header {
    /// The header, if what it states agrees with itself and with the file's length.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, String> {
        if bytes.len() < SHORTEST_HEADER {
            return Err(format!(
                "the file ends within its header of {SHORTEST_HEADER} bytes"
            ));
        }
        let [major, minor] = [bytes[24], bytes[25]];
        if major != 1 || minor > 4 {
            return Err(format!(
                "it is of LAS version {major}.{minor}, and 1.0 to 1.4 are read"
            ));
        }
        let header_size = usize::from(u16_at(bytes, 94));
        let shortest = if minor == 4 {
            HEADER_OF_1_4
        } else {
            SHORTEST_HEADER
        };
        if header_size < shortest || header_size > bytes.len() {
            return Err(format!("it states a header of {header_size} bytes"));
        }
        let stated = bytes[104];
        let (is_compressed, format) = (stated & 0x80 != 0, stated & 0x3f);
        let Some(shortest) = LENGTHS.get(usize::from(format)) else {
            return Err(format!(
                "it has point format {format}, and 0 to 10 are read"
            ));
        };
        let record_length = u16_at(bytes, 105);
        if record_length < *shortest {
            return Err(format!(
                "its records have {record_length} bytes, and those of point format {format} have \
                 at least {shortest}"
            ));
        }
        let data = u32_at(bytes, 96) as usize;
        if data < header_size || data > bytes.len() {
            return Err(format!("its points begin at byte {data}, which it has not"));
        }
        let (count, extended) = counts(bytes, minor);
        let three = |at: usize| [0, 8, 16].map(|k| f64_at(bytes, at + k));
        let (scale, offset) = (three(131), three(155));
        if !scale.iter().chain(&offset).all(|v| v.is_finite()) || scale.contains(&0.0) {
            return Err("the scale or the offset of its coordinates is no number".to_owned());
        }
        Ok(Self {
            format,
            is_compressed,
            record_length,
            count,
            data,
            scale,
            offset,
            header_size,
            variable: u32_at(bytes, 100),
            extended,
        })
    }

    /// What lies from the first record on.
    pub(super) fn records<'a>(&self, bytes: &'a [u8]) -> &'a [u8] {
        &bytes[self.data..]
    }

    /// Position of a record, world frame of the file.
    pub(super) fn position(&self, record: &[u8]) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            let stored = u32_at(record, 4 * k) as i32;
            f64::from(stored) * self.scale[k] + self.offset[k]
        })
    }

    /// Class of a record, and 1 if it is withheld.
    pub(super) fn class_of(&self, record: &[u8]) -> [u8; 2] {
        match self.format {
            0..6 => [record[15] & 0x1f, record[15] >> 7],
            _ => [record[16], record[15] >> 2 & 1],
        }
    }

    /// The coordinate system of the records; otherwise why they cannot be used.
    pub(super) fn system(&self, bytes: &[u8]) -> Result<StatedSystem, String> {
        let text = self.variable_record(bytes, PROJECTION, WELL_KNOWN_TEXT);
        if let Some(text) = text {
            let text = String::from_utf8_lossy(text);
            let text = text.trim_matches(['\0', ' ', '\n']);
            if !text.is_empty() {
                return Ok(StatedSystem::named(text));
            }
        }
        let record = |number| {
            self.variable_record(bytes, PROJECTION, number)
                .unwrap_or_default()
        };
        let directory: Vec<u64> = (record(GEO_KEYS).chunks_exact(2))
            .map(|pair| u64::from(u16_at(pair, 0)))
            .collect();
        geo_keys::stated(&GeoKeys {
            directory: &directory,
            texts: record(geo_keys::TEXTS),
        })
    }

    /// What a variable record of this owner and number holds, extended or not.
    pub(super) fn variable_record<'a>(
        &self,
        bytes: &'a [u8],
        owner: &str,
        number: u16,
    ) -> Option<&'a [u8]> {
        let is_wanted = |head: &[u8]| {
            let name = head[2..18].split(|&b| b == 0).next().unwrap_or_default();
            name == owner.as_bytes() && u16_at(head, 18) == number
        };
        let mut rest = &bytes[self.header_size..self.data];
        for _ in 0..self.variable {
            let (head, after) = rest.split_at_checked(VARIABLE_HEAD)?;
            let (content, after) = after.split_at_checked(usize::from(u16_at(head, 20)))?;
            if is_wanted(head) {
                return Some(content);
            }
            rest = after;
        }
        let (first, count) = self.extended;
        let mut rest = bytes.get(usize::try_from(first).ok()?..)?;
        for _ in 0..count {
            let (head, after) = rest.split_at_checked(EXTENDED_HEAD)?;
            let length = usize::try_from(u64_at(head, 20)).ok()?;
            let (content, after) = after.split_at_checked(length)?;
            if is_wanted(head) {
                return Some(content);
            }
            rest = after;
        }
        None
    }
}

/// The number of points, and where the extended variable records begin and how many they are.
fn counts(bytes: &[u8], minor: u8) -> (u64, (u64, u32)) {
    let count = u64::from(u32_at(bytes, 107));
    if minor < 4 {
        return (count, (0, 0));
    }
    let of_1_4 = u64_at(bytes, 247);
    let count = if of_1_4 == 0 { count } else { of_1_4 };
    (count, (u64_at(bytes, 235), u32_at(bytes, 243)))
}

fn taken<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    *bytes[at..].first_chunk().expect("the caller has looked")
}

pub(super) fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_le_bytes(taken(bytes, at))
}

pub(super) fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(taken(bytes, at))
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(taken(bytes, at))
}

fn f64_at(bytes: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(taken(bytes, at))
}
