//! A window of a photograph, read without holding all of it where the format allows.
//!
//! TIFF is stored in strips or tiles, and only those that touch the window are decoded. JPEG and
//! PNG are decoded whole and cropped at once, as are TIFFs with separate planes or in other
//! colours than grey, RGB and RGBA of 8 or 16 bits. With 16 bits every chunk is read once for the
//! brightest value, which scales all windows of an image alike.

use std::io::Cursor;

use image::ImageFormat;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

use super::load::{decode, image_format};
use super::photograph::{Photograph, PixelWindow};
use super::samples::{Samples, Values, brightest};
use crate::error::Result;

/// Decodes a window of an image, inside which it must lie. `file` is for messages.
pub fn load_window(file: &str, bytes: &[u8], window: PixelWindow) -> Result<Photograph> {
    let (samples, brightest) = match tiff_window(bytes, window) {
        Some(found) => found,
        None => {
            let whole = decode(file, bytes)?;
            (whole.crop(window), whole.brightest())
        }
    };
    Ok(samples.photograph(brightest))
}

/// Bytes that decoding a window takes beyond the window itself: the whole image, or one chunk.
pub fn decoding_bytes(bytes: &[u8], [width, height]: [u32; 2]) -> u64 {
    const BYTES_PER_PIXEL: u64 = 6;
    let chunk = open(bytes).map(|tiff| tiff.decoder.chunk_dimensions());
    let (w, h) = chunk.unwrap_or((width, height));
    u64::from(w.min(width)) * u64::from(h.min(height)) * BYTES_PER_PIXEL
}

struct Tiff<'a> {
    decoder: Decoder<Cursor<&'a [u8]>>,
    /// Samples a pixel.
    samples: usize,
    bits: u8,
    size: (u32, u32),
}

/// A TIFF that can be read chunk by chunk.
fn open(bytes: &[u8]) -> Option<Tiff<'_>> {
    if image_format(bytes) != Some(ImageFormat::Tiff) {
        return None;
    }
    let mut decoder = Decoder::new(Cursor::new(bytes)).ok()?;
    let (samples, bits) = match decoder.colortype().ok()? {
        ColorType::Gray(bits) => (1, bits),
        ColorType::RGB(bits) => (3, bits),
        ColorType::RGBA(bits) => (4, bits),
        _ => return None,
    };
    let tag = |decoder: &mut Decoder<_>, tag: Tag, default: u32| {
        let value = decoder.find_tag_unsigned::<u32>(tag).ok()?;
        Some(value.unwrap_or(default))
    };
    const CHUNKY: u32 = 1;
    const UNSIGNED: u32 = 1;
    let planes = tag(&mut decoder, Tag::PlanarConfiguration, CHUNKY)?;
    // Black is zero, or RGB.
    let photometric = tag(&mut decoder, Tag::PhotometricInterpretation, 0)?;
    let formats = decoder
        .find_tag_unsigned_vec::<u32>(Tag::SampleFormat)
        .ok()?;
    let is_plain = formats.iter().flatten().all(|&f| f == UNSIGNED);
    let size = decoder.dimensions().ok()?;
    let good =
        planes == CHUNKY && [1, 2].contains(&photometric) && is_plain && [8, 16].contains(&bits);
    good.then_some(Tiff {
        decoder,
        samples,
        bits,
        size,
    })
}

/// The window from the chunks that touch it, and the brightest value of the whole image where it
/// has 16 bits; `None` for a file that cannot be read chunk by chunk.
fn tiff_window(bytes: &[u8], window: PixelWindow) -> Option<(Samples, u16)> {
    let mut tiff = open(bytes)?;
    let [_, _, width, height] = window;
    let count = width as usize * height as usize * tiff.samples;
    let (values, brightest) = if tiff.bits == 8 {
        let mut pixels = vec![0u8; count];
        tiff.read(window, &mut pixels, |chunk| match chunk {
            DecodingResult::U8(values) => Some(values),
            _ => None,
        })?;
        (Values::Eight(pixels), 0)
    } else {
        let mut pixels = vec![0u16; count];
        tiff.read(window, &mut pixels, |chunk| match chunk {
            DecodingResult::U16(values) => Some(values),
            _ => None,
        })?;
        (Values::Sixteen(pixels), tiff.brightest()?)
    };
    let samples = Samples {
        width,
        height,
        channels: tiff.samples,
        values,
    };
    Some((samples, brightest))
}

impl Tiff<'_> {
    /// The brightest value of the whole image, chunk by chunk, so that every window of it is scaled
    /// alike. Alpha does not count.
    fn brightest(&mut self) -> Option<u16> {
        let (w, h) = self.decoder.chunk_dimensions();
        let count = self
            .size
            .0
            .div_ceil(w)
            .checked_mul(self.size.1.div_ceil(h))?;
        let mut most = 0;
        for index in 0..count {
            let DecodingResult::U16(values) = self.decoder.read_chunk(index).ok()? else {
                return None;
            };
            most = most.max(brightest(&values, self.samples));
        }
        Some(most)
    }

    /// Copies the window out of the chunks that touch it.
    fn read<T: Copy>(
        &mut self,
        [column, row, width, height]: PixelWindow,
        pixels: &mut [T],
        values: impl Fn(DecodingResult) -> Option<Vec<T>>,
    ) -> Option<()> {
        let (chunk_w, chunk_h) = self.decoder.chunk_dimensions();
        if chunk_w == 0 || chunk_h == 0 {
            return None;
        }
        let across = self.size.0.div_ceil(chunk_w);
        for j in row / chunk_h..(row + height).div_ceil(chunk_h) {
            for i in column / chunk_w..(column + width).div_ceil(chunk_w) {
                let index = j.checked_mul(across)?.checked_add(i)?;
                let (data_w, data_h) = self.decoder.chunk_data_dimensions(index);
                let chunk = values(self.decoder.read_chunk(index).ok()?)?;
                let (left, top) = (i * chunk_w, j * chunk_h);
                let columns = column.max(left)..(column + width).min(left + data_w);
                for y in row.max(top)..(row + height).min(top + data_h) {
                    let count = columns.len() * self.samples;
                    let from = ((y - top) as usize * data_w as usize
                        + (columns.start - left) as usize)
                        * self.samples;
                    let to = ((y - row) as usize * width as usize
                        + (columns.start - column) as usize)
                        * self.samples;
                    pixels
                        .get_mut(to..to + count)?
                        .copy_from_slice(chunk.get(from..from + count)?);
                }
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use image::DynamicImage;

    use super::super::load::load_image;
    use super::*;

    /// An RGB image whose pixels name their place.
    fn places(width: u32, height: u32) -> image::RgbImage {
        image::RgbImage::from_fn(width, height, |x, y| {
            image::Rgb([x as u8, y as u8, (x / 3 + y) as u8])
        })
    }

    /// The same as an uncompressed TIFF in tiles of 16 x 16 pixels, padded at the right and at the
    /// bottom.
    fn tiled(rgb: &image::RgbImage) -> Vec<u8> {
        let (w, h) = rgb.dimensions();
        let (across, down) = (w.div_ceil(16), h.div_ceil(16));
        let mut data = Vec::new();
        for tile in 0..across * down {
            for p in 0..256 {
                let (x, y) = ((tile % across) * 16 + p % 16, (tile / across) * 16 + p / 16);
                let inside = x < w && y < h;
                data.extend(if inside {
                    rgb.get_pixel(x, y).0
                } else {
                    [255, 0, 255]
                });
            }
        }
        let tiles = across * down;
        // Header, directory of ten entries, bits, offsets, counts, data.
        let (bits_at, offsets_at) = (8 + 2 + 10 * 12 + 4, 8 + 2 + 10 * 12 + 4 + 6);
        let counts_at = offsets_at + 4 * tiles;
        let data_at = counts_at + 4 * tiles;
        let mut out = b"II*\0\x08\0\0\0\x0a\0".to_vec();
        let mut entry = |tag: u16, kind: u16, count: u32, value: u32| {
            out.extend(tag.to_le_bytes());
            out.extend(kind.to_le_bytes());
            out.extend(count.to_le_bytes());
            out.extend(value.to_le_bytes());
        };
        for (tag, kind, count, value) in [
            (256, 3, 1, w),
            (257, 3, 1, h),
            (258, 3, 3, bits_at),
            (259, 3, 1, 1),
            (262, 3, 1, 2),
            (277, 3, 1, 3),
            (322, 3, 1, 16),
            (323, 3, 1, 16),
            (324, 4, tiles, offsets_at),
            (325, 4, tiles, counts_at),
        ] {
            entry(tag, kind, count, value);
        }
        out.extend([0; 4]);
        out.extend([8, 0, 8, 0, 8, 0]);
        (0..tiles).for_each(|t| out.extend((data_at + t * 768).to_le_bytes()));
        (0..tiles).for_each(|_| out.extend(768u32.to_le_bytes()));
        out.extend(data);
        out
    }

    fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_window_has_the_pixels_of_the_whole() {
        let rgb = places(101, 83);
        let deep = DynamicImage::ImageRgb8(rgb.clone()).into_rgb16();
        let files = [
            tiled(&rgb),
            encoded(&rgb.clone().into(), ImageFormat::Tiff),
            encoded(
                &DynamicImage::ImageRgb8(rgb.clone()).into_luma8().into(),
                ImageFormat::Tiff,
            ),
            encoded(&deep.into(), ImageFormat::Tiff),
            encoded(&rgb.clone().into(), ImageFormat::Png),
            encoded(&rgb.into(), ImageFormat::Jpeg),
        ];
        for bytes in &files {
            let whole = load_image("a", bytes).unwrap();
            for window in [
                [0, 0, 101, 83],
                [17, 30, 40, 33],
                [90, 70, 11, 13],
                [16, 16, 16, 16],
            ] {
                assert_eq!(
                    load_window("a", bytes, window).unwrap().rgb,
                    whole.crop(window).rgb,
                    "{window:?}"
                );
            }
        }
        assert!(
            tiff_window(&files[0], [17, 30, 40, 33]).is_some(),
            "tiles are read one by one"
        );
        assert_eq!(decoding_bytes(&files[0], [101, 83]), 16 * 16 * 6);
        assert_eq!(decoding_bytes(&files[4], [101, 83]), 101 * 83 * 6);
    }

    #[test]
    fn a_damaged_strip_is_refused_where_it_is_needed() {
        let mut bytes = tiled(&places(64, 64));
        let end = bytes.len();
        bytes.truncate(end - 100);
        assert!(load_window("a.tif", &bytes, [0, 0, 16, 16]).is_ok());
        let message = load_window("a.tif", &bytes, [50, 50, 10, 10])
            .unwrap_err()
            .to_string();
        assert!(
            message.starts_with("a.tif: the image cannot be read"),
            "{message}"
        );
    }
}
