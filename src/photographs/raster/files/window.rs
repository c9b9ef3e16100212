//! A window of a photograph, read without holding all of it where the format allows.
//!
//! TIFF is stored in strips or tiles, and only those that touch the window are decoded. JPEG and
//! PNG are decoded whole and cropped at once. With 16 bits every strip or tile of a TIFF is read
//! once for the brightest value, which scales all windows of an image alike.

use super::excerpt::Excerpt;
use super::load::{decode, open_tiff, refusing_panics};
use super::tiff::{Tiff, is_tiff};
use crate::base::error::Result;
use crate::photographs::raster::photograph::{Photograph, PixelWindow};

/// Decodes a window of an image, inside which it must lie. `file` is for messages.
pub fn load_window<'a>(
    file: &str,
    bytes: impl Into<Excerpt<'a>>,
    window: PixelWindow,
) -> Result<Photograph> {
    let bytes = bytes.into();
    refusing_panics(file, || {
        if is_tiff(bytes.start()) {
            let tiff = open_tiff(file, bytes)?;
            let brightest = tiff.brightest()?;
            return Ok(tiff.window(window)?.photograph(brightest));
        }
        let whole = decode(file, bytes)?;
        let brightest = whole.brightest();
        Ok(whole.crop(window).photograph(brightest))
    })
}

/// Bytes that decoding a window takes beyond the window itself: the whole image, or one strip or
/// tile.
pub fn decoding_bytes<'a>(bytes: impl Into<Excerpt<'a>>, [width, height]: [u32; 2]) -> u64 {
    // Three bands of two bytes: the most that a pixel is decoded to.
    const BYTES_PER_PIXEL: u64 = 6;
    let bytes = bytes.into();
    match is_tiff(bytes.start()).then(|| Tiff::open("", bytes)) {
        Some(Ok(tiff)) => tiff.chunk_bytes(),
        _ => u64::from(width) * u64::from(height) * BYTES_PER_PIXEL,
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{DynamicImage, ImageFormat};

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
        assert_eq!(decoding_bytes(&files[0], [101, 83]), 16 * 16 * 3);
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
