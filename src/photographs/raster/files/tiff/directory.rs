//! The directories of a TIFF: tags and their values.

use std::ops::Range;

use super::super::excerpt::Excerpt;

/// The tags that are looked at.
pub(crate) mod tags {
    // TIFF 6.0 and its supplements, Exif, GeoTIFF, GDAL, DNG.
    pub(crate) const NEW_SUBFILE_TYPE: u16 = 254;
    pub(crate) const IMAGE_WIDTH: u16 = 256;
    pub(crate) const IMAGE_LENGTH: u16 = 257;
    pub(crate) const BITS_PER_SAMPLE: u16 = 258;
    pub(crate) const COMPRESSION: u16 = 259;
    pub(crate) const PHOTOMETRIC: u16 = 262;
    pub(crate) const FILL_ORDER: u16 = 266;
    pub(crate) const STRIP_OFFSETS: u16 = 273;
    pub(crate) const ORIENTATION: u16 = 274;
    pub(crate) const SAMPLES_PER_PIXEL: u16 = 277;
    pub(crate) const ROWS_PER_STRIP: u16 = 278;
    pub(crate) const STRIP_BYTE_COUNTS: u16 = 279;
    pub(crate) const PLANAR_CONFIGURATION: u16 = 284;
    pub(crate) const PREDICTOR: u16 = 317;
    pub(crate) const COLOR_MAP: u16 = 320;
    pub(crate) const TILE_WIDTH: u16 = 322;
    pub(crate) const TILE_LENGTH: u16 = 323;
    pub(crate) const TILE_OFFSETS: u16 = 324;
    pub(crate) const TILE_BYTE_COUNTS: u16 = 325;
    pub(crate) const SUB_IFDS: u16 = 330;
    pub(crate) const EXTRA_SAMPLES: u16 = 338;
    pub(crate) const SAMPLE_FORMAT: u16 = 339;
    pub(crate) const JPEG_TABLES: u16 = 347;
    pub(crate) const EXIF: u16 = 34665;
    pub(crate) const GPS: u16 = 34853;
    pub(crate) const MODEL_PIXEL_SCALE: u16 = 33550;
    pub(crate) const MODEL_TIEPOINT: u16 = 33922;
    pub(crate) const MODEL_TRANSFORMATION: u16 = 34264;
    pub(crate) const GEO_KEY_DIRECTORY: u16 = 34735;
    pub(crate) const GDAL_METADATA: u16 = 42112;
    pub(crate) const GDAL_NO_DATA: u16 = 42113;
    pub(crate) const DNG_VERSION: u16 = 50706;
}

/// Does a file begin as a TIFF or a BigTIFF does?
pub(crate) fn is_tiff(bytes: &[u8]) -> bool {
    let starts = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
    starts.iter().any(|start| bytes.starts_with(*start))
}

/// Byte order and size of the offsets.
#[derive(Clone, Copy)]
struct Form {
    big_endian: bool,
    big_offsets: bool,
}

/// One directory: an image, or a reduced copy, a mask, a page.
pub(crate) struct Directory<'a> {
    bytes: Excerpt<'a>,
    form: Form,
    entries: Vec<Entry>,
    /// Where the next one stands; 0 for none.
    next: u64,
}

struct Entry {
    tag: u16,
    kind: u16,
    /// Where the values stand.
    place: Range<u64>,
}

/// Most directories that are followed: overviews and masks come by the dozen at most.
const MOST_DIRECTORIES: usize = 64;

impl<'a> Directory<'a> {
    /// The directories of the main chain, up to the first that is damaged.
    pub(crate) fn chain(bytes: Excerpt<'a>) -> impl Iterator<Item = Self> {
        let form = Form {
            big_endian: bytes.start().starts_with(b"MM"),
            big_offsets: bytes.get(2..4).is_some_and(|b| b.contains(&43)),
        };
        let at = match form.big_offsets {
            true => form.number_at(bytes, 8..16),
            false => form.number_at(bytes, 4..8),
        };
        let first = at.and_then(|at| Self::at(bytes, form, at));
        std::iter::successors(first, move |directory| {
            Self::at(bytes, form, directory.next)
        })
        .take(MOST_DIRECTORIES)
    }

    /// The directories that a tag refers to.
    pub(crate) fn below(&self, tag: u16) -> impl Iterator<Item = Self> {
        let offsets = self.numbers(tag).unwrap_or_default();
        let count = offsets.len().min(MOST_DIRECTORIES);
        (offsets.into_iter().take(count)).filter_map(|at| Self::at(self.bytes, self.form, at))
    }

    fn at(bytes: Excerpt<'a>, form: Form, at: u64) -> Option<Self> {
        let at = Some(at).filter(|&at| at > 0)?;
        let (count_size, entry_size, value_size) = if form.big_offsets {
            (8, 20, 8)
        } else {
            (2, 12, 4)
        };
        let start = at.checked_add(count_size)?;
        let count = form.number_at(bytes, at..start)?;
        let end = start.checked_add(count.checked_mul(entry_size)?)?;
        let entries = bytes.get(start..end)?.chunks_exact(entry_size as usize);
        let entry_starts = (start..end).step_by(entry_size as usize);
        let read = |entry_start: u64, entry: &[u8]| {
            let [tag, kind] = [form.number(entry, 0..2)?, form.number(entry, 2..4)?];
            let [tag, kind] = [tag as u16, kind as u16];
            let values = entry.len() - value_size as usize..entry.len();
            let count = form.number(entry, 4..values.start)?;
            let length = count.checked_mul(size_of(kind) as u64)?;
            let from = match length <= value_size {
                true => entry_start + values.start as u64,
                false => form.number(entry, values)?,
            };
            let place = from..from.checked_add(length)?;
            Some(Entry { tag, kind, place })
        };
        Some(Self {
            bytes,
            form,
            // An entry of a private tag may be damaged: only its own values are missing then.
            entries: (entry_starts.zip(entries))
                .filter_map(|(start, entry)| read(start, entry))
                .collect(),
            next: form
                .number_at(bytes, end..end.checked_add(value_size)?)
                .unwrap_or(0),
        })
    }

    /// Is the most significant byte first?
    pub(crate) fn big_endian(&self) -> bool {
        self.form.big_endian
    }

    /// The bytes of a tag's values.
    pub(crate) fn raw(&self, tag: u16) -> Option<&'a [u8]> {
        let entry = self.entries.iter().find(|e| e.tag == tag)?;
        self.bytes.get(entry.place.clone())
    }

    /// The whole numbers of a tag.
    pub(crate) fn numbers(&self, tag: u16) -> Option<Vec<u64>> {
        let is_whole = |e: &&Entry| matches!(e.kind, 1 | 3 | 4 | 6 | 7 | 13 | 16 | 18);
        let entry = (self.entries.iter()).find(|e| e.tag == tag && is_whole(e))?;
        let values = self.bytes.get(entry.place.clone())?;
        let size = size_of(entry.kind);
        let number = |value: &[u8]| self.form.number(value, 0..size);
        values.chunks_exact(size).map(number).collect()
    }

    /// The numbers of a tag, also those with a sign and quotients of two, which may be infinite.
    pub(crate) fn reals(&self, tag: u16) -> Vec<f64> {
        let kind = self.entries.iter().find(|e| e.tag == tag).map(|e| e.kind);
        let signed = |part: u64| f64::from(part as u32 as i32);
        let parts = |value: &[u8]| {
            Some([
                self.form.number(value, 0..4)?,
                self.form.number(value, 4..8)?,
            ])
        };
        let quotient = |value: &[u8]| match (kind, parts(value)?) {
            (Some(5), [a, b]) => Some(a as f64 / b as f64),
            (_, [a, b]) => Some(signed(a) / signed(b)),
        };
        let values = self.raw(tag).unwrap_or_default();
        match kind {
            Some(5 | 10) => values.chunks_exact(8).filter_map(quotient).collect(),
            Some(9) => (values.chunks_exact(4))
                .filter_map(|value| self.form.number(value, 0..4).map(signed))
                .collect(),
            _ => {
                let whole = self.numbers(tag).unwrap_or_default();
                whole.into_iter().map(|number| number as f64).collect()
            }
        }
    }

    /// The floating-point values of a tag, of 8 bytes each.
    pub(crate) fn doubles(&self, tag: u16) -> Option<Vec<f64>> {
        let values = self.raw(tag)?.chunks_exact(8);
        let double = |value: &[u8]| self.form.number(value, 0..8).map(f64::from_bits);
        values.map(double).collect()
    }

    /// The first number of a tag.
    pub(crate) fn number(&self, tag: u16) -> Option<u64> {
        self.numbers(tag)?.first().copied()
    }
}

/// Bytes of one value of a kind.
fn size_of(kind: u16) -> usize {
    match kind {
        1 | 2 | 6 | 7 => 1,
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        _ => 8,
    }
}

impl Form {
    fn number_at(self, bytes: Excerpt, place: Range<u64>) -> Option<u64> {
        let value = bytes.get(place)?;
        self.number(value, 0..value.len())
    }

    fn number(self, bytes: &[u8], place: Range<usize>) -> Option<u64> {
        let value = bytes.get(place)?;
        let join = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        Some(match self.big_endian {
            true => value.iter().fold(0, join),
            false => value.iter().rev().fold(0, join),
        })
    }
}
