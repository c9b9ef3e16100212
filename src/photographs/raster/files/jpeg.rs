//! JPEG, as a file and as a strip or tile of a TIFF, decoded as crate `image` does it, but by one
//! instance of the decoder: `image` would add two more, for other ways to hold the same bytes
//! (100 kB of wasm).

use image::error::{DecodingError, ImageFormatHint, LimitError, LimitErrorKind};
use image::{ColorType, ImageDecoder, ImageError, ImageFormat, ImageResult};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// A JPEG whose header has been read.
pub(super) struct Jpeg {
    decoder: JpegDecoder<ZCursor<Vec<u8>>>,
    width: u32,
    height: u32,
    color_type: ColorType,
}

impl Jpeg {
    /// Reads the header.
    pub(super) fn new(bytes: &[u8]) -> ImageResult<Self> {
        let mut decoder = decoder(bytes.to_vec());
        decoder.decode_headers().map_err(image_error)?;
        let info = decoder.info().expect("the header was decoded");
        let (colours, color_type) = match decoder.input_colorspace() {
            Some(ColorSpace::Luma) => (ColorSpace::Luma, ColorType::L8),
            _ => (ColorSpace::RGB, ColorType::Rgb8),
        };
        decoder.set_options(options().jpeg_set_out_colorspace(colours));
        Ok(Self {
            decoder,
            width: info.width.into(),
            height: info.height.into(),
            color_type,
        })
    }
}

fn options() -> DecoderOptions {
    DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX)
}

fn decoder(bytes: Vec<u8>) -> JpegDecoder<ZCursor<Vec<u8>>> {
    JpegDecoder::new_with_options(ZCursor::new(bytes), options())
}

/// What a strip or tile of a TIFF should hold.
pub(super) struct JpegPart {
    pub width: usize,
    pub height: usize,
    /// Samples of a pixel.
    pub samples: usize,
    /// Are they to become RGB? Others stay as they are, whatever the JPEG takes them for.
    pub is_ycbcr: bool,
}

/// Decodes a strip or tile, tables in front.
pub(super) fn decode_part(bytes: Vec<u8>, wanted: &JpegPart) -> Result<Vec<u8>, String> {
    if !is_complete(&bytes) {
        return Err("the JPEG ends too early".to_owned());
    }
    let length = bytes.len();
    let mut decoder = decoder(bytes);
    decoder.decode_headers().map_err(|e| e.to_string())?;
    let info = decoder.info().expect("the header was decoded");
    let found = [info.width, info.height].map(usize::from);
    let samples = usize::from(info.components);
    // More rows than the last strip needs do no harm.
    if found[0] != wanted.width || found[1] < wanted.height || samples != wanted.samples {
        return Err(format!(
            "its JPEG has {} x {} pixels of {samples} samples, not {} x {} of {}",
            found[0], found[1], wanted.width, wanted.height, wanted.samples
        ));
    }
    if found[0] * found[1] / MOST_PIXELS_PER_BYTE > length {
        return Err("its JPEG is too short for its size".to_owned());
    }
    let stored = decoder.input_colorspace();
    let colours = match (samples, stored) {
        (1, _) => ColorSpace::Luma,
        (2, _) => ColorSpace::LumaA,
        (3, Some(ColorSpace::YCbCr)) if wanted.is_ycbcr => ColorSpace::RGB,
        (3 | 4, Some(stored)) => stored,
        _ => return Err(format!("its JPEG has {samples} samples")),
    };
    decoder.set_options(options().jpeg_set_out_colorspace(colours));
    let mut out = vec![0; found[0] * found[1] * samples];
    decoder.decode_into(&mut out).map_err(|e| e.to_string())?;
    Ok(out)
}

/// No encoding packs more pixels into a byte (deflate: a thousand), so that a file which claims
/// more is refused before memory is taken.
pub(super) const MOST_PIXELS_PER_BYTE: usize = 4096;

/// Does the entropy-coded data of a JPEG run to its end-of-image marker?
///
/// Segments are skipped by their lengths, so that the marker of a thumbnail inside one does not
/// count.
pub(super) fn is_complete(bytes: &[u8]) -> bool {
    let mut i = 2;
    while let Some(&[a, marker]) = bytes.get(i..i + 2) {
        match (a, marker) {
            (0xff, 0xd9) => return true,
            // Fill bytes, markers without a segment, and entropy-coded data.
            (0xff, 0x00 | 0x01 | 0xd0..=0xd8) => i += 2,
            (0xff, 0xff) => i += 1,
            (0xff, _) => match bytes.get(i + 2..i + 4) {
                Some(&[high, low]) => i += 2 + usize::from(high) * 256 + usize::from(low),
                _ => return false,
            },
            _ => i += 1,
        }
    }
    false
}

impl ImageDecoder for Jpeg {
    fn dimensions(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn color_type(&self) -> ColorType {
        self.color_type
    }

    fn exif_metadata(&mut self) -> ImageResult<Option<Vec<u8>>> {
        Ok(self.decoder.exif().cloned())
    }

    fn read_image(mut self, buf: &mut [u8]) -> ImageResult<()> {
        self.decoder.decode_into(buf).map_err(image_error)
    }

    fn read_image_boxed(self: Box<Self>, buf: &mut [u8]) -> ImageResult<()> {
        // Without the asterisk this method would call itself.
        (*self).read_image(buf)
    }
}

fn image_error(error: DecodeErrors) -> ImageError {
    match error {
        DecodeErrors::LargeDimensions(_) => {
            ImageError::Limits(LimitError::from_kind(LimitErrorKind::DimensionError))
        }
        error => {
            let format = ImageFormatHint::Exact(ImageFormat::Jpeg);
            ImageError::Decoding(DecodingError::new(format, error))
        }
    }
}
