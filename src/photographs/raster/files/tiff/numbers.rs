//! One band of numbers that are no colours: whole ones, with or without sign, and floating-point
//! ones, as rasters of heights hold them.
//!
//! Predictor 3 (Adobe's technical note on TIFF of 2005) stands the bytes of a row side by side, all
//! most significant ones first, and stores their differences.

use super::super::excerpt::Excerpt;
use super::chunks::Tiff;
use super::compression::Compression;
use super::directory::{Directory, is_tiff, tags};
use super::layout::{Layout, is_full};
use crate::base::error::{Error, Result};

/// A raster of numbers, row by row.
pub(crate) struct NumberRaster<'a> {
    pub width: usize,
    pub height: usize,
    pub values: Vec<f32>,
    /// The tags of the image.
    pub directory: Directory<'a>,
}

/// Most numbers that are read. Assumption: 100 square kilometres of one-metre cells.
const MOST_NUMBERS: u64 = 100_000_000;

/// How a number is stored.
#[derive(Clone, Copy)]
struct NumberFormat {
    kind: Kind,
    bytes: usize,
    predictor: u64,
    big_endian: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Unsigned,
    Signed,
    Float,
}

impl Kind {
    /// By the number of a sample's format (TIFF 6.0, section 19).
    fn of(format: u64) -> Option<Self> {
        match format {
            1 => Some(Self::Unsigned),
            2 => Some(Self::Signed),
            3 => Some(Self::Float),
            _ => None,
        }
    }
}

impl<'a> NumberRaster<'a> {
    /// Reads the first image of full resolution. `file` is for messages.
    pub(crate) fn read(file: &'a str, bytes: Excerpt<'a>) -> Result<Self> {
        let refuse = |problem: &str, advice: &str| Error::file(file, problem, advice);
        let convert = "convert it to a GeoTIFF of one band of 32-bit floating-point numbers";
        let unread = |problem: &str| refuse(problem, convert);
        let damaged = |problem: &str| refuse(problem, "copy or convert it again");
        let directory = Directory::chain(bytes).find(is_full);
        let directory =
            directory.ok_or_else(|| damaged("the directory of the TIFF is damaged or cut off"))?;
        let number = |tag: u16, default: u64| directory.number(tag).unwrap_or(default);
        if number(tags::SAMPLES_PER_PIXEL, 1) != 1 {
            return Err(unread("it has several bands, and heights are one"));
        }
        let kind = Kind::of(number(tags::SAMPLE_FORMAT, 1))
            .ok_or_else(|| unread("the kind of its numbers is not read"))?;
        let bits = number(tags::BITS_PER_SAMPLE, 1);
        let bits = match (kind, bits) {
            (Kind::Float, 32 | 64) | (Kind::Unsigned | Kind::Signed, 8 | 16 | 32) => bits as u8,
            _ => return Err(unread(&format!("its numbers have {bits} bits"))),
        };
        let compression = Compression::new(number(tags::COMPRESSION, 1));
        let compression = (compression.ok())
            .filter(|c| *c != Compression::Jpeg)
            .ok_or_else(|| unread("its compression is not read for heights"))?;
        let predictor = match compression.has_predictor() {
            true => number(tags::PREDICTOR, 1),
            false => 1,
        };
        if !(predictor < 3 || (predictor == 3 && kind == Kind::Float)) {
            return Err(unread(&format!("its predictor is number {predictor}")));
        }
        let layout = Layout::of_numbers(&directory, bits, compression)
            .ok_or_else(|| damaged("its size, or where its strips or tiles stand, is missing"))?;
        let (width, height) = layout.size;
        if u64::from(width) * u64::from(height) > MOST_NUMBERS {
            return Err(refuse(
                &format!("it has {width} x {height} cells, more than are read"),
                "cut it to the area of the photographs",
            ));
        }
        let format = NumberFormat {
            kind,
            bytes: usize::from(bits / 8),
            predictor: predictor.max(1),
            big_endian: directory.big_endian(),
        };
        let values = values(&Tiff::of_layout(file, bytes, layout), format)?;
        Ok(Self {
            width: width as usize,
            height: height as usize,
            values,
            directory,
        })
    }
}

/// Does a file hold one band of numbers with sign or fraction, and state where it lies?
pub(crate) fn is_height_raster<'a>(bytes: impl Into<Excerpt<'a>>) -> bool {
    let is_signed_or_fraction =
        |directory: Directory| matches!(directory.number(tags::SAMPLE_FORMAT), Some(2 | 3));
    placed_band(bytes.into()).is_some_and(is_signed_or_fraction)
}

/// Does a file hold one band, and state where it lies? It may be heights then, if it is said to be.
pub(crate) fn is_placed_band(bytes: Excerpt) -> bool {
    placed_band(bytes).is_some()
}

fn placed_band(bytes: Excerpt) -> Option<Directory> {
    let directory = is_tiff(bytes.start())
        .then(|| Directory::chain(bytes).find(is_full))
        .flatten();
    directory.filter(|directory| {
        let is_placed = directory.raw(tags::MODEL_TIEPOINT).is_some()
            || directory.raw(tags::MODEL_TRANSFORMATION).is_some();
        is_placed && directory.number(tags::SAMPLES_PER_PIXEL).unwrap_or(1) == 1
    })
}

/// All numbers; those of strips and tiles that the file leaves out are no numbers.
fn values(tiff: &Tiff, format: NumberFormat) -> Result<Vec<f32>> {
    let layout = tiff.layout();
    let (width, height) = layout.size;
    let (chunk_w, chunk_h) = layout.chunk;
    let mut values = vec![f32::NAN; width as usize * height as usize];
    let mut numbers = Vec::new();
    for j in 0..height.div_ceil(chunk_h) {
        for i in 0..layout.across() {
            let (left, top) = (i * chunk_w, j * chunk_h);
            let rows = match layout.is_tiled {
                true => chunk_h,
                false => chunk_h.min(height - top),
            };
            let index = u64::from(j) * u64::from(layout.across()) + u64::from(i);
            let Some(chunk) = tiff.chunk(index as usize, rows)? else {
                continue;
            };
            let used = chunk_w.min(width - left) as usize;
            let stored = chunk.data.chunks_exact(chunk.bytes_of_a_row.max(1));
            for (row, stored) in stored.take((height - top).min(rows) as usize).enumerate() {
                format.numbers(stored, &mut numbers);
                let at = (top as usize + row) * width as usize + left as usize;
                values[at..at + used].copy_from_slice(&numbers[..used]);
            }
        }
    }
    Ok(values)
}

impl NumberFormat {
    /// The numbers of a row.
    fn numbers(self, stored: &[u8], numbers: &mut Vec<f32>) {
        numbers.clear();
        if self.predictor == 3 {
            let mut bytes = stored.to_vec();
            for i in 1..bytes.len() {
                bytes[i] = bytes[i].wrapping_add(bytes[i - 1]);
            }
            let count = bytes.len() / self.bytes;
            let bits = |i: usize| {
                (0..self.bytes).fold(0, |sum, b| sum << 8 | u64::from(bytes[b * count + i]))
            };
            numbers.extend((0..count).map(|i| self.value(bits(i))));
            return;
        }
        let mask = u64::MAX >> (64 - 8 * self.bytes);
        let mut before = 0u64;
        numbers.extend(stored.chunks_exact(self.bytes).map(|number| {
            let join = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
            let mut bits = match self.big_endian {
                true => number.iter().fold(0, join),
                false => number.iter().rev().fold(0, join),
            };
            if self.predictor == 2 {
                bits = bits.wrapping_add(before) & mask;
                before = bits;
            }
            self.value(bits)
        }));
    }

    fn value(self, bits: u64) -> f32 {
        match (self.kind, self.bytes) {
            (Kind::Float, 4) => f32::from_bits(bits as u32),
            (Kind::Float, _) => f64::from_bits(bits) as f32,
            (Kind::Unsigned, _) => bits as f32,
            (Kind::Signed, bytes) => {
                let unused = 64 - 8 * bytes;
                ((bits << unused) as i64 >> unused) as f32
            }
        }
    }
}
