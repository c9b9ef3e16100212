//! What the tags of a TIFF say, or the refusal of what is not read.

use serde::Serialize;

use super::super::excerpt::Excerpt;
use super::compression::Compression;
use super::directory::{Directory, tags};
use crate::base::error::{Error, Result};

/// Which bands of an image are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Bands {
    /// All that hold colours or grey; an alpha band is none of them.
    All,
    /// Not those from the first to the last, counted from one, whose meaning is not stated.
    Without(u16, u16),
    /// The first three of so many, taken for red, green and blue although the file names no
    /// colours.
    Unnamed(u16),
}

/// What the samples mean.
#[derive(Debug, PartialEq)]
pub(super) enum Colours {
    Grey,
    Rgb,
    YCbCr,
    /// The colours of the indices.
    Palette(Vec<[u8; 3]>),
}

/// One image of a TIFF: everything but its samples.
#[derive(Debug)]
pub(super) struct Layout {
    pub size: (u32, u32),
    /// As in EXIF, 1 to 8.
    pub orientation: u8,
    pub colours: Colours,
    /// Is zero the brightest?
    pub white_is_zero: bool,
    pub bands: Bands,
    pub bits: u8,
    /// Samples of a pixel as stored, and how many of them are used.
    pub samples: usize,
    pub used: usize,
    /// Does each band stand by itself?
    pub is_planar: bool,
    pub big_endian: bool,
    pub compression: Compression,
    pub predicted: bool,
    pub jpeg_tables: Option<Vec<u8>>,
    pub is_tiled: bool,
    /// Width and height of a strip or tile, pixels.
    pub chunk: (u32, u32),
    /// Place and length of each strip or tile.
    pub places: Vec<(u64, u64)>,
}

const CONVERT: &str =
    "convert it to a TIFF of 8 or 16 bits with LZW, Deflate or JPEG compression, or to PNG";

/// Largest strip or tile, samples.
const MOST_SAMPLES: u64 = 4_000_000_000;

impl Layout {
    /// Of the first image of full resolution. `file` is for messages.
    pub(super) fn read(file: &str, bytes: Excerpt) -> Result<Self> {
        let refuse = |problem: &str, advice: &str| Error::file(file, problem, advice);
        let mut directories = Directory::chain(bytes).peekable();
        if directories.peek().is_none() {
            let damage =
                "the image cannot be read: the directory of the TIFF is damaged or cut off";
            return Err(refuse(damage, "copy or convert it again"));
        }
        let Some(directory) = directories.find(is_full) else {
            return Err(refuse(
                "the TIFF holds only reduced copies of an image",
                "give the photograph at its full size",
            ));
        };
        Self::of(&directory).map_err(|(problem, advice)| refuse(&problem, advice))
    }

    fn of(directory: &Directory) -> std::result::Result<Self, (String, &'static str)> {
        let unread = |problem: String| (problem, CONVERT);
        let missing = |what: &str| {
            let problem = format!("the image cannot be read: the TIFF does not state {what}");
            (problem, "copy or convert it again")
        };
        let number = |tag: u16, default: u64| directory.number(tag).unwrap_or(default);
        let (width, height) =
            stated_size(directory).ok_or_else(|| missing("its width and height"))?;
        let not_read =
            |name: String| format!("its compression is {name}, which is not read in a TIFF");
        let compression = Compression::new(number(tags::COMPRESSION, 1))
            .map_err(|name| unread(not_read(name)))?;
        let bits = bits(directory).map_err(unread)?;
        let photometric = directory.number(tags::PHOTOMETRIC);
        let photometric = photometric.ok_or_else(|| missing("what its samples mean"))?;
        let palette = || palette(directory).ok_or_else(|| missing("its table of colours"));
        let is_jpeg = compression == Compression::Jpeg;
        let (colours, needed) = match photometric {
            3 if bits == 8 => (Colours::Palette(palette()?), 1),
            other => plain_colours(other, is_jpeg).map_err(unread)?,
        };
        let samples = usize::try_from(number(tags::SAMPLES_PER_PIXEL, 1)).unwrap_or(0);
        if samples < needed || samples > usize::from(u16::MAX) {
            return Err(missing("as many bands as its colours need"));
        }
        check_bits(directory, is_jpeg, bits).map_err(unread)?;
        let predicted = is_predicted(directory, &compression).map_err(unread)?;
        let (used, bands) = used_bands(directory, &colours, needed, samples);
        let is_planar = number(tags::PLANAR_CONFIGURATION, 1) == 2 && samples > 1;
        let colours = match (colours, used) {
            (Colours::Grey, 3) => Colours::Rgb,
            (Colours::YCbCr, _) if is_planar => {
                let problem = "its bands Y, Cb and Cr stand by themselves";
                return Err(unread(problem.to_owned()));
            }
            (colours, _) => colours,
        };
        let mut layout = Self {
            size: (width, height),
            orientation: u8::try_from(number(tags::ORIENTATION, 1)).unwrap_or(1),
            colours,
            white_is_zero: photometric == 0,
            bands,
            bits,
            samples,
            used,
            is_planar,
            big_endian: directory.big_endian(),
            compression,
            predicted,
            jpeg_tables: directory.raw(tags::JPEG_TABLES).map(<[u8]>::to_vec),
            is_tiled: false,
            chunk: (width, height),
            places: Vec::new(),
        };
        layout
            .find_chunks(directory)
            .ok_or_else(|| missing("where its strips or tiles stand"))?;
        Ok(layout)
    }

    /// Of an image whose one band holds numbers of so many bits, which are no colours; `None` where
    /// it is not stated whole.
    pub(super) fn of_numbers(
        directory: &Directory,
        bits: u8,
        compression: Compression,
    ) -> Option<Self> {
        let extent = |tag: u16| directory.number(tag).and_then(|v| u32::try_from(v).ok());
        let size = extent(tags::IMAGE_WIDTH).zip(extent(tags::IMAGE_LENGTH))?;
        let mut layout = Self {
            size,
            orientation: 1,
            colours: Colours::Grey,
            white_is_zero: false,
            bands: Bands::All,
            bits,
            samples: 1,
            used: 1,
            is_planar: false,
            big_endian: directory.big_endian(),
            compression,
            predicted: false,
            jpeg_tables: None,
            is_tiled: false,
            chunk: size,
            places: Vec::new(),
        };
        let has_size = size.0 > 0 && size.1 > 0;
        (has_size && layout.find_chunks(directory).is_some()).then_some(layout)
    }

    fn find_chunks(&mut self, directory: &Directory) -> Option<()> {
        let (width, height) = self.size;
        let extent = |tag: u16| directory.number(tag).and_then(|v| u32::try_from(v).ok());
        let tiles = directory.numbers(tags::TILE_OFFSETS);
        let (offsets, counts) = match tiles {
            Some(offsets) => {
                self.is_tiled = true;
                self.chunk = (extent(tags::TILE_WIDTH)?, extent(tags::TILE_LENGTH)?);
                // Some old programs call the lengths of tiles those of strips.
                let counts = directory.numbers(tags::TILE_BYTE_COUNTS);
                (
                    offsets,
                    counts.or_else(|| directory.numbers(tags::STRIP_BYTE_COUNTS)),
                )
            }
            None => {
                let rows = extent(tags::ROWS_PER_STRIP).unwrap_or(height);
                self.chunk = (width, rows.min(height));
                (
                    directory.numbers(tags::STRIP_OFFSETS)?,
                    directory.numbers(tags::STRIP_BYTE_COUNTS),
                )
            }
        };
        // Without lengths, each strip or tile may reach to the end of the file.
        let counts = counts.unwrap_or_else(|| vec![u64::MAX; offsets.len()]);
        self.places = offsets.into_iter().zip(counts).collect();
        let (w, h) = self.chunk;
        let pixels = u64::from(w) * u64::from(h);
        let is_sound = pixels > 0
            && pixels.saturating_mul(self.samples as u64) <= MOST_SAMPLES
            && self.places.len() as u64 >= self.chunks_of_a_plane() * self.planes() as u64;
        is_sound.then_some(())
    }

    /// Strips or tiles in a row.
    pub(super) fn across(&self) -> u32 {
        self.size.0.div_ceil(self.chunk.0)
    }

    /// Strips or tiles of all bands, or of one where each stands by itself.
    pub(super) fn chunks_of_a_plane(&self) -> u64 {
        u64::from(self.across()) * u64::from(self.size.1.div_ceil(self.chunk.1))
    }

    /// Planes that are used.
    pub(super) fn planes(&self) -> usize {
        if self.is_planar { self.used } else { 1 }
    }

    /// Samples of a pixel within a strip or tile.
    pub(super) fn samples_of_a_chunk(&self) -> usize {
        if self.is_planar { 1 } else { self.samples }
    }
}

fn stated_size(directory: &Directory) -> Option<(u32, u32)> {
    let extent = |tag: u16| directory.number(tag).and_then(|v| u32::try_from(v).ok());
    let size = extent(tags::IMAGE_WIDTH).zip(extent(tags::IMAGE_LENGTH));
    size.filter(|&(w, h)| w > 0 && h > 0)
}

fn check_bits(directory: &Directory, is_jpeg: bool, bits: u8) -> std::result::Result<(), String> {
    if directory.number(tags::FILL_ORDER).unwrap_or(1) != 1 {
        return Err("the bits of its bytes are in reverse order".to_owned());
    }
    if is_jpeg && bits != 8 {
        return Err(format!("it is compressed as JPEG of {bits} bits"));
    }
    Ok(())
}

/// Are samples stored as differences to the one before?
fn is_predicted(
    directory: &Directory,
    compression: &Compression,
) -> std::result::Result<bool, String> {
    let predictor = directory.number(tags::PREDICTOR).unwrap_or(1);
    match (compression.has_predictor(), predictor) {
        (false, _) | (true, 1) => Ok(false),
        (true, 2) => Ok(true),
        _ => Err(format!("its predictor is number {predictor}")),
    }
}

/// What the samples mean, and how many of them a pixel needs; or why that cannot be read. Numbers
/// are those of the photometric interpretation (TIFF 6.0, section 8).
fn plain_colours(photometric: u64, is_jpeg: bool) -> std::result::Result<(Colours, usize), String> {
    Err(match photometric {
        0 | 1 => return Ok((Colours::Grey, 1)),
        2 => return Ok((Colours::Rgb, 3)),
        6 if is_jpeg => return Ok((Colours::YCbCr, 3)),
        3 => "its table of colours is one of 16 bits".to_owned(),
        4 => "it is a mask, no photograph".to_owned(),
        5 => "its colours are those of a press (CMYK)".to_owned(),
        6 => "its colours are YCbCr without JPEG".to_owned(),
        8..=10 => "its colours are CIE Lab".to_owned(),
        32803 | 34892 => "it is a camera's raw file".to_owned(),
        other => format!("its samples mean number {other}"),
    })
}

/// Is it no reduced copy, and no mask?
pub(super) fn is_full(directory: &Directory) -> bool {
    // Bits of the subfile's type (TIFF 6.0, section 8).
    const REDUCED_COPY: u64 = 1;
    const MASK: u64 = 4;
    directory.number(tags::NEW_SUBFILE_TYPE).unwrap_or(0) & (REDUCED_COPY | MASK) == 0
}

/// Bits of a sample: 8 or 16, without sign.
fn bits(directory: &Directory) -> std::result::Result<u8, String> {
    // Formats of samples (TIFF 6.0, section 19).
    const UNSIGNED: u64 = 1;
    const SIGNED: u64 = 2;
    const UNDEFINED: u64 = 4;
    let bits = directory.numbers(tags::BITS_PER_SAMPLE).unwrap_or(vec![1]);
    let formats = directory.numbers(tags::SAMPLE_FORMAT).unwrap_or_default();
    if let Some(&format) = (formats.iter()).find(|f| ![UNSIGNED, UNDEFINED].contains(*f)) {
        return Err(match format {
            SIGNED => "it holds numbers with a sign, whose range is unknown".to_owned(),
            _ => "it holds floating-point values, whose range is unknown".to_owned(),
        });
    }
    match bits[..] {
        [8, ..] if bits.iter().all(|&b| b == 8) => Ok(8),
        [16, ..] if bits.iter().all(|&b| b == 16) => Ok(16),
        [1, ..] => Err("it has 1 bit a sample: black and white only".to_owned()),
        [first, ..] if bits.iter().all(|&b| b == first) => {
            Err(format!("it has {first} bits a sample"))
        }
        _ => Err("its bands have different numbers of bits".to_owned()),
    }
}

/// Red, green and blue of each index, of which the file holds 16 bits.
fn palette(directory: &Directory) -> Option<Vec<[u8; 3]>> {
    let table = directory.numbers(tags::COLOR_MAP)?;
    let count = table.len() / 3;
    // Some programs fill the low bytes only.
    let shift = if table.iter().any(|&v| v > 255) { 8 } else { 0 };
    let colour = |i: usize| [0, 1, 2].map(|band| (table[band * count + i] >> shift) as u8);
    (count > 0).then(|| (0..count).map(colour).collect())
}

/// How many bands are used, and what is to be said of them.
fn used_bands(
    directory: &Directory,
    colours: &Colours,
    needed: usize,
    samples: usize,
) -> (usize, Bands) {
    const ALPHA: [u64; 2] = [1, 2];
    let extra = directory.numbers(tags::EXTRA_SAMPLES).unwrap_or_default();
    let is_alpha = |i: usize| {
        let first = samples.saturating_sub(extra.len());
        let meaning = i.checked_sub(first).and_then(|i| extra.get(i));
        meaning.is_some_and(|m| ALPHA.contains(m))
    };
    let number = |i: usize| u16::try_from(i).unwrap_or(u16::MAX);
    let is_named = *colours != Colours::Grey || samples < 3 || is_alpha(1) || is_alpha(2);
    if !is_named {
        return (3, Bands::Unnamed(number(samples)));
    }
    let others: Vec<usize> = (needed..samples).filter(|&i| !is_alpha(i)).collect();
    let bands = match others[..] {
        [] => Bands::All,
        [first, ..] => Bands::Without(number(first + 1), number(others[others.len() - 1] + 1)),
    };
    (needed, bands)
}
