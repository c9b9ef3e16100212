//! Photographs from JPEG, PNG and TIFF bytes.
//!
//! The format follows from the content. Alpha is dropped. 16-bit images, of which many cameras
//! fill only 10 to 14 bits, are divided by the smallest power of two that holds their brightest
//! value, and their grey values keep the full depth. An orientation in the EXIF header is
//! reported, not applied here: the orientation files mostly describe the pixels as they are stored.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use image::codecs::png::PngDecoder;
use image::error::{LimitError, LimitErrorKind};
use image::{ImageDecoder, ImageError, ImageFormat, ImageResult, Limits};

use super::excerpt::Excerpt;
use super::jpeg::{self, Jpeg};
use super::samples::Samples;
use super::tiff::{Bands, Tiff, is_tiff};
use super::unread::unread_image_format;
use crate::base::error::{Error, Result};
use crate::photographs::raster::photograph::Photograph;

/// The header of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageHeader {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// The EXIF orientation, 1 (upright) to 8.
    pub orientation: u8,
    /// Which bands are used.
    pub bands: Bands,
}

impl ImageHeader {
    /// Is the EXIF orientation other than upright?
    pub fn turned(&self) -> bool {
        self.orientation != 1
    }
}

/// Most pixels in one image: larger than the largest aerial frame camera (about 450 megapixels).
const MAX_PIXELS: u64 = 600_000_000;

/// The format of an image that can be read, by its first bytes.
pub fn image_format(bytes: &[u8]) -> Option<ImageFormat> {
    if is_tiff(bytes) {
        return Some(ImageFormat::Tiff);
    }
    image::guess_format(bytes)
        .ok()
        .filter(|f| matches!(f, ImageFormat::Jpeg | ImageFormat::Png))
}

/// Reads the size from the header alone. `file` is for messages.
pub fn image_header<'a>(file: &str, bytes: impl Into<Excerpt<'a>>) -> Result<ImageHeader> {
    let bytes = bytes.into();
    refusing_panics(file, || {
        if is_tiff(bytes.start()) {
            let tiff = open_tiff(file, bytes)?;
            let (width, height) = tiff.size();
            return Ok(ImageHeader {
                width,
                height,
                orientation: tiff.orientation(),
                bands: tiff.bands(),
            });
        }
        let mut decoder = decoder(file, bytes)?;
        let (width, height) = decoder.size();
        Ok(ImageHeader {
            width,
            height,
            orientation: decoder.exif_orientation(),
            bands: Bands::All,
        })
    })
}

/// Decodes an image. `file` is for messages.
pub fn load_image<'a>(file: &str, bytes: impl Into<Excerpt<'a>>) -> Result<Photograph> {
    let samples = decode(file, bytes.into())?;
    let brightest = samples.brightest();
    Ok(samples.photograph(brightest))
}

/// The samples as they are stored.
pub(super) fn decode(file: &str, bytes: Excerpt) -> Result<Samples> {
    refusing_panics(file, || {
        if is_tiff(bytes.start()) {
            let tiff = open_tiff(file, bytes)?;
            let (width, height) = tiff.size();
            return tiff.window([0, 0, width, height]);
        }
        let is_jpeg = image_format(bytes.start()) == Some(ImageFormat::Jpeg);
        if is_jpeg && !jpeg::is_complete(bytes.start()) {
            // The decoder would fill the missing part with grey.
            return Err(unreadable(file, "the JPEG is cut off before its end"));
        }
        let decoder = decoder(file, bytes)?;
        let samples = decoder
            .samples()
            .map_err(|e| unreadable(file, &e.to_string()))?;
        samples.ok_or_else(|| {
            Error::file(
                file,
                "it holds floating-point values, whose range is unknown",
                "convert it to 8 or 16 bits per channel",
            )
        })
    })
}

/// The tags of a TIFF, unless it is a camera's raw file or claims an impossible size.
pub(super) fn open_tiff<'a>(file: &'a str, bytes: Excerpt<'a>) -> Result<Tiff<'a>> {
    refuse_unread(file, bytes)?;
    let tiff = Tiff::open(file, bytes)?;
    check_size(file, bytes, tiff.size())?;
    Ok(tiff)
}

/// A decoder that fails in an unforeseen way refuses its file only, where panics can be caught.
pub(super) fn refusing_panics<T>(file: &str, read: impl FnOnce() -> Result<T>) -> Result<T> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        Err(unreadable(
            file,
            "its content makes no sense to the decoder",
        ))
    })
}

fn refuse_unread(file: &str, bytes: Excerpt) -> Result<()> {
    match unread_image_format(file, bytes) {
        None => Ok(()),
        Some(format) => Err(Error::file(
            file,
            format!("it is {}, which is not read", format.name),
            format.advice,
        )),
    }
}

/// The part of a decoder's interface that is used: the rest stays out of the wasm.
trait SampleSource {
    /// Width and height, pixels.
    fn size(&self) -> (u32, u32);
    /// The EXIF orientation, 1 (upright) to 8.
    fn exif_orientation(&mut self) -> u8;
    /// All samples; `None` for floating-point values.
    fn samples(self: Box<Self>) -> ImageResult<Option<Samples>>;
}

impl<D: ImageDecoder> SampleSource for D {
    fn size(&self) -> (u32, u32) {
        self.dimensions()
    }

    fn exif_orientation(&mut self) -> u8 {
        self.orientation().map_or(1, |o| o.to_exif())
    }

    fn samples(self: Box<Self>) -> ImageResult<Option<Samples>> {
        let (size, color) = (self.dimensions(), self.color_type());
        let mut bytes = zeroed_buffer(self.total_bytes())?;
        (*self).read_image(&mut bytes)?;
        Ok(Samples::from_bytes(size, color, bytes))
    }
}

fn zeroed_buffer(total_bytes: u64) -> ImageResult<Vec<u8>> {
    let most = isize::MAX as u64;
    if total_bytes > most {
        let kind = LimitErrorKind::InsufficientMemory;
        return Err(ImageError::Limits(LimitError::from_kind(kind)));
    }
    Ok(vec![0; total_bytes as usize])
}

fn decoder<'a>(file: &str, excerpt: Excerpt<'a>) -> Result<Box<dyn SampleSource + 'a>> {
    refuse_unread(file, excerpt)?;
    let bytes = excerpt.start();
    let format = image_format(bytes)
        .ok_or_else(|| unreadable(file, "its content is neither JPEG nor PNG nor TIFF"))?;
    let decoder = decoder_of(format, bytes).map_err(|e| unreadable(file, &e.to_string()))?;
    check_size(file, excerpt, decoder.size())?;
    Ok(decoder)
}

fn check_size(file: &str, bytes: Excerpt, (width, height): (u32, u32)) -> Result<()> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels > MAX_PIXELS || pixels == 0 {
        return Err(Error::file(
            file,
            format!("{width} x {height} pixels"),
            format!(
                "cut out the part of interest (at most {} megapixels an image)",
                MAX_PIXELS / 1_000_000
            ),
        ));
    }
    if pixels / jpeg::MOST_PIXELS_PER_BYTE as u64 > bytes.length() {
        let problem = format!(
            "{} bytes cannot hold {width} x {height} pixels",
            bytes.length()
        );
        return Err(unreadable(file, &problem));
    }
    Ok(())
}

fn decoder_of<'a>(format: ImageFormat, bytes: &'a [u8]) -> ImageResult<Box<dyn SampleSource + 'a>> {
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_PIXELS * 8);
    let file = Cursor::new(bytes);
    match format {
        ImageFormat::Jpeg => limited(Jpeg::new(bytes)?, limits),
        _ => limited(PngDecoder::with_limits(file, limits.clone())?, limits),
    }
}

fn limited<'a>(
    mut decoder: impl ImageDecoder + 'a,
    limits: Limits,
) -> ImageResult<Box<dyn SampleSource + 'a>> {
    decoder.set_limits(limits)?;
    Ok(Box::new(decoder))
}

fn unreadable(file: &str, problem: &str) -> Error {
    Error::file(
        file,
        format!("the image cannot be read: {problem}"),
        "save it as JPEG, PNG or TIFF (8 or 16 bits)",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photographs::raster::Gray;
    use image::{DynamicImage, ImageBuffer, Luma, Rgb, Rgba};

    fn encode(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    fn ramp() -> image::RgbImage {
        image::RgbImage::from_fn(40, 30, |x, y| Rgb([6 * x as u8, 8 * y as u8, 90]))
    }

    #[test]
    fn lossless_formats_return_the_same_pixels() {
        for format in [ImageFormat::Png, ImageFormat::Tiff] {
            let loaded = load_image("a", &encode(&ramp().into(), format)).unwrap();
            assert_eq!(loaded.rgb, ramp());
            assert_eq!(loaded.gray, Gray::from_rgb(&ramp()));
        }
        let jpeg = load_image("a", &encode(&ramp().into(), ImageFormat::Jpeg)).unwrap();
        for (a, b) in jpeg.rgb.as_raw().iter().zip(ramp().as_raw()) {
            assert!(a.abs_diff(*b) < 30);
        }
    }

    #[test]
    fn sixteen_bits_are_scaled_by_the_depth_in_use() {
        // 12 bits of 16: 4095 is white, and the grey value keeps the 12 bits.
        let deep = ImageBuffer::from_fn(16, 16, |x, _| Luma([if x == 3 { 4095u16 } else { 1001 }]));
        for format in [ImageFormat::Png, ImageFormat::Tiff] {
            let loaded = load_image("a", &encode(&deep.clone().into(), format)).unwrap();
            assert_eq!(loaded.rgb.get_pixel(3, 0).0, [255; 3]);
            assert_eq!(loaded.rgb.get_pixel(0, 0).0, [62; 3]);
            assert!((loaded.gray.get(0, 0) - 1001.0 / 4095.0).abs() < 1e-6);
        }
    }

    #[test]
    fn alpha_is_dropped_and_grey_becomes_three_channels() {
        let alpha = ImageBuffer::from_fn(8, 8, |_, _| Rgba([10u8, 20, 30, 0]));
        let loaded = load_image("a", &encode(&alpha.into(), ImageFormat::Png)).unwrap();
        assert_eq!(loaded.rgb.get_pixel(1, 1).0, [10, 20, 30]);
        let grey = ImageBuffer::from_fn(8, 8, |_, _| Luma([77u8]));
        let loaded = load_image("a", &encode(&grey.into(), ImageFormat::Tiff)).unwrap();
        assert_eq!(loaded.rgb.get_pixel(1, 1).0, [77; 3]);
    }

    #[test]
    fn a_cut_off_image_is_refused_by_name() {
        for format in [ImageFormat::Jpeg, ImageFormat::Png, ImageFormat::Tiff] {
            let bytes = encode(&ramp().into(), format);
            for part in [5, 4, 3, 2] {
                let cut = &bytes[..bytes.len() * (part - 1) / part];
                let message = load_image("b/a.jpg", cut).unwrap_err().to_string();
                assert!(
                    message.starts_with("b/a.jpg: the image cannot be read"),
                    "{message}"
                );
            }
        }
        assert!(load_image("a.jpg", b"").is_err());
    }

    #[test]
    fn absurd_sizes_are_refused_before_memory_is_taken() {
        let mut png = encode(&ramp().into(), ImageFormat::Png);
        png[16..24].copy_from_slice(&[0, 1, 0x86, 0xa0, 0, 1, 0x86, 0xa0]);
        // The decoder checks the checksum of the header chunk.
        let crc = crc32(&png[12..29]);
        png[29..33].copy_from_slice(&crc.to_be_bytes());
        let message = load_image("a.png", &png).unwrap_err().to_string();
        assert!(message.contains("100000 x 100000"), "{message}");
    }

    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0u32, |crc, &b| {
            (0..8).fold(crc ^ u32::from(b), |c, _| {
                if c & 1 == 1 {
                    (c >> 1) ^ 0xedb8_8320
                } else {
                    c >> 1
                }
            })
        })
    }
}
