//! The strips and tiles that touch a window, to samples.

use std::borrow::Cow;
use std::ops::Range;

use super::super::excerpt::Excerpt;
use super::super::jpeg::JpegPart;
use super::super::samples::{Samples, Values};
use super::compression::{Compression, decompress, decompress_jpeg};
use super::layout::{Bands, Colours, Layout};
use crate::base::error::{Error, Result};
use crate::photographs::raster::photograph::PixelWindow;

/// A TIFF whose tags have been read.
pub(crate) struct Tiff<'a> {
    file: &'a str,
    bytes: Excerpt<'a>,
    layout: Layout,
}

/// The rows of one strip or tile.
pub(super) struct Chunk<'a> {
    pub data: Cow<'a, [u8]>,
    pub bytes_of_a_row: usize,
}

impl<'a> Tiff<'a> {
    /// Reads the tags. `file` is for messages.
    pub(crate) fn open(file: &'a str, bytes: Excerpt<'a>) -> Result<Self> {
        let layout = Layout::read(file, bytes)?;
        Ok(Self {
            file,
            bytes,
            layout,
        })
    }

    /// What the tags say is known already.
    pub(super) fn of_layout(file: &'a str, bytes: Excerpt<'a>, layout: Layout) -> Self {
        Self {
            file,
            bytes,
            layout,
        }
    }

    /// What the tags say.
    pub(super) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Width and height, pixels.
    pub(crate) fn size(&self) -> (u32, u32) {
        self.layout.size
    }

    /// As in EXIF, 1 to 8.
    pub(crate) fn orientation(&self) -> u8 {
        self.layout.orientation
    }

    /// Which bands are used.
    pub(crate) fn bands(&self) -> Bands {
        self.layout.bands
    }

    /// Bytes that a strip or tile takes.
    pub(crate) fn chunk_bytes(&self) -> u64 {
        let (w, h) = self.layout.chunk;
        let bytes = self.layout.samples_of_a_chunk() as u64 * u64::from(self.layout.bits / 8);
        u64::from(w.min(self.layout.size.0)) * u64::from(h.min(self.layout.size.1)) * bytes
    }

    /// The samples of a window, which must lie inside.
    pub(crate) fn window(&self, window: PixelWindow) -> Result<Samples> {
        let [_, _, width, height] = window;
        let values = match (self.layout.bits, &self.layout.colours) {
            (8, Colours::Palette(table)) => {
                let colour = |i: &u8| table.get(usize::from(*i)).copied().unwrap_or_default();
                Values::Eight(self.read::<u8>(window)?.iter().flat_map(colour).collect())
            }
            (8, _) => Values::Eight(self.read(window)?),
            _ => Values::Sixteen(self.read(window)?),
        };
        let is_grey = self.layout.colours == Colours::Grey;
        Ok(Samples {
            width,
            height,
            channels: if is_grey { 1 } else { 3 },
            values,
        })
    }

    /// The brightest value of the whole image where it has 16 bits, strip by strip, so that every
    /// window is scaled alike; 0 for 8 bits.
    pub(crate) fn brightest(&self) -> Result<u16> {
        let mut most = 0;
        if self.layout.bits == 16 {
            let (width, height) = self.layout.size;
            self.visit([0, 0, width, height], |_, _, used| {
                most = used.iter().copied().fold(most, u16::max)
            })?;
        }
        Ok(most)
    }

    /// The samples in use of a window, row by row.
    fn read<T: Sample>(&self, window: PixelWindow) -> Result<Vec<T>> {
        let [column, row, width, height] = window;
        let used = self.layout.used;
        let mut pixels = vec![T::default(); width as usize * height as usize * used];
        self.visit(window, |[x, y], band, samples: &[T]| {
            let at = (y - row) as usize * width as usize + (x - column) as usize;
            for (i, &sample) in samples.iter().enumerate() {
                pixels[at * used + band + i] = sample;
            }
        })?;
        Ok(pixels)
    }

    /// Shows each pixel of a window: column and row, the first band, and the samples in use from
    /// that on.
    fn visit<T: Sample>(
        &self,
        [column, row, width, height]: PixelWindow,
        mut show: impl FnMut([u32; 2], usize, &[T]),
    ) -> Result<()> {
        let layout = &self.layout;
        let (chunk_w, chunk_h) = layout.chunk;
        let per_pixel = layout.samples_of_a_chunk();
        let used = layout.used.min(per_pixel);
        let mut samples = Vec::new();
        for (band, [i, j], index) in self.touched([column, row, width, height]) {
            let (left, top) = (i * chunk_w, j * chunk_h);
            // Tiles are whole, the last strip is not.
            let rows = match layout.is_tiled {
                true => chunk_h,
                false => chunk_h.min(layout.size.1 - top),
            };
            // What is not stored at all is black.
            let Some(chunk) = self.chunk(index, rows)? else {
                continue;
            };
            let from = column.max(left);
            let to = (column + width).min(left.saturating_add(chunk_w));
            let bottom = (row + height).min(top.saturating_add(rows));
            for y in row.max(top)..bottom {
                let start = (y - top) as usize * chunk.bytes_of_a_row;
                let end = start + (to - left) as usize * per_pixel * T::BYTES;
                let stored = chunk.data.get(start..end).unwrap_or_default();
                self.unpack(stored, &mut samples);
                let pixels = samples.chunks_exact(per_pixel);
                for (x, pixel) in (from..to).zip(pixels.skip((from - left) as usize)) {
                    show([x, y], band, &pixel[..used]);
                }
            }
        }
        Ok(())
    }

    /// The strips or tiles that touch a window: the first band, column and row among them, index.
    fn touched(
        &self,
        [column, row, width, height]: PixelWindow,
    ) -> impl Iterator<Item = (usize, [u32; 2], usize)> {
        let layout = &self.layout;
        let (chunk_w, chunk_h) = layout.chunk;
        let columns = column / chunk_w..(column + width).div_ceil(chunk_w);
        let rows = row / chunk_h..(row + height).div_ceil(chunk_h);
        let of_band = move |band: usize| {
            let columns = columns.clone();
            rows.clone()
                .flat_map(move |j| columns.clone().map(move |i| (band, [i, j])))
        };
        (0..layout.planes())
            .flat_map(of_band)
            .map(|(band, [i, j])| {
                let index = band as u64 * layout.chunks_of_a_plane()
                    + u64::from(j) * u64::from(layout.across())
                    + u64::from(i);
                (band, [i, j], index as usize)
            })
    }

    /// The ranges of the file that decoding a window reads; `None` for all.
    pub(crate) fn ranges(&self, window: PixelWindow) -> Option<Vec<Range<u64>>> {
        if self.layout.bits == 16 {
            return None;
        }
        let places = self.touched(window).map(|(_, _, index)| {
            let (offset, count) = self.layout.places.get(index).copied().unwrap_or_default();
            match (offset, count) {
                (0, _) | (_, 0) => Some(0..0),
                (_, u64::MAX) => None,
                (offset, count) => Some(self.bytes.within(offset, count)),
            }
        });
        places.collect()
    }

    /// The samples of a row from its start, without the predictor.
    fn unpack<T: Sample>(&self, stored: &[u8], samples: &mut Vec<T>) {
        let read = |bytes| T::read(bytes, self.layout.big_endian);
        samples.clear();
        samples.extend(stored.chunks_exact(T::BYTES).map(read));
        if self.layout.predicted {
            let per_pixel = self.layout.samples_of_a_chunk();
            for i in per_pixel..samples.len() {
                samples[i] = samples[i].plus(samples[i - per_pixel]);
            }
        }
        if self.layout.white_is_zero {
            samples.iter_mut().for_each(|v| *v = v.inverted());
        }
    }

    /// A strip or tile; `None` where the file leaves it out.
    pub(super) fn chunk(&self, index: usize, rows: u32) -> Result<Option<Chunk<'a>>> {
        let layout = &self.layout;
        let (offset, count) = layout.places.get(index).copied().unwrap_or_default();
        if offset == 0 || count == 0 {
            return Ok(None);
        }
        let damaged = |problem: String| {
            let what = if layout.is_tiled { "tile" } else { "strip" };
            Error::file(
                self.file,
                format!(
                    "the image cannot be read: {what} {} of {} is damaged or cut off ({problem})",
                    index + 1,
                    layout.places.len()
                ),
                "copy or convert it again",
            )
        };
        let data = self.bytes.get(self.bytes.within(offset, count));
        let data = data.ok_or_else(|| damaged("it was not read".to_owned()))?;
        let pixels = (layout.chunk.0 as usize, rows as usize);
        let samples = layout.samples_of_a_chunk();
        if layout.compression == Compression::Jpeg {
            let part = JpegPart {
                width: pixels.0,
                height: pixels.1,
                samples,
                is_ycbcr: layout.colours == Colours::YCbCr,
            };
            let found = decompress_jpeg(layout.jpeg_tables.as_deref(), data, &part);
            return Ok(Some(Chunk {
                data: Cow::Owned(found.map_err(damaged)?),
                bytes_of_a_row: pixels.0 * samples,
            }));
        }
        // A directory may state any size, also beyond the addresses of 32 bits.
        let times = |a: usize, b: usize| {
            let product = a.checked_mul(b);
            product.ok_or_else(|| damaged("it states too many pixels".to_owned()))
        };
        let bytes_of_a_row = times(times(pixels.0, samples)?, usize::from(layout.bits / 8))?;
        let data = decompress(layout.compression, data, times(bytes_of_a_row, pixels.1)?);
        Ok(Some(Chunk {
            data: data.map_err(damaged)?,
            bytes_of_a_row,
        }))
    }
}

/// A sample of 8 or 16 bits.
trait Sample: Copy + Default {
    // What it takes in the file.
    const BYTES: usize = size_of::<Self>();

    fn read(bytes: &[u8], big_endian: bool) -> Self;
    fn plus(self, other: Self) -> Self;
    fn inverted(self) -> Self;
}

impl Sample for u8 {
    fn read(bytes: &[u8], _: bool) -> Self {
        bytes[0]
    }

    fn plus(self, other: Self) -> Self {
        self.wrapping_add(other)
    }

    fn inverted(self) -> Self {
        !self
    }
}

impl Sample for u16 {
    fn read(bytes: &[u8], big_endian: bool) -> Self {
        let pair = [bytes[0], bytes[1]];
        match big_endian {
            true => Self::from_be_bytes(pair),
            false => Self::from_le_bytes(pair),
        }
    }

    fn plus(self, other: Self) -> Self {
        self.wrapping_add(other)
    }

    fn inverted(self) -> Self {
        !self
    }
}
