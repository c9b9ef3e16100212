//! JPEG, decoded as crate `image` does it, but by the instance of the decoder that crate `tiff`
//! brings along: `image` would add two more, for other ways to hold the same bytes (100 kB of
//! wasm).

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
        let options = DecoderOptions::default()
            .set_strict_mode(false)
            .set_max_width(usize::MAX)
            .set_max_height(usize::MAX);
        let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes.to_vec()), options);
        decoder.decode_headers().map_err(image_error)?;
        let info = decoder.info().expect("the header was decoded");
        let (colours, color_type) = match decoder.input_colorspace() {
            Some(ColorSpace::Luma) => (ColorSpace::Luma, ColorType::L8),
            _ => (ColorSpace::RGB, ColorType::Rgb8),
        };
        decoder.set_options(options.jpeg_set_out_colorspace(colours));
        Ok(Self {
            decoder,
            width: info.width.into(),
            height: info.height.into(),
            color_type,
        })
    }
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
