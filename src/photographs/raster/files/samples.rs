//! Samples as an image file stores them, and the photograph they make.
//!
//! The conversions of crate `image` bring in those between all its pixel types and colour spaces
//! (30 kB of wasm); a photograph needs two depths of grey or RGB.

use image::ColorType;

use crate::photographs::raster::gray::Gray;
use crate::photographs::raster::photograph::{Photograph, PixelWindow};

/// The samples of all pixels, row by row.
pub(crate) struct Samples {
    pub width: u32,
    pub height: u32,
    /// Samples of a pixel: grey, grey and alpha, RGB, or RGB and alpha.
    pub channels: usize,
    pub values: Values,
}

/// Samples of 8 or 16 bits.
pub(crate) enum Values {
    Eight(Vec<u8>),
    Sixteen(Vec<u16>),
}

impl Samples {
    /// From what a decoder wrote; `None` for floating-point values.
    pub(super) fn from_bytes(
        (width, height): (u32, u32),
        color: ColorType,
        bytes: Vec<u8>,
    ) -> Option<Self> {
        let values = match color {
            ColorType::L8 | ColorType::La8 | ColorType::Rgb8 | ColorType::Rgba8 => {
                Values::Eight(bytes)
            }
            ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => {
                let pairs = bytes.chunks_exact(2);
                Values::Sixteen(pairs.map(|b| u16::from_ne_bytes([b[0], b[1]])).collect())
            }
            _ => return None,
        };
        Some(Self {
            width,
            height,
            channels: color.channel_count().into(),
            values,
        })
    }

    /// The window at column, row of this width and height; it must lie inside.
    pub(super) fn crop(&self, window: PixelWindow) -> Self {
        let [_, _, width, height] = window;
        let (across, channels) = (self.width as usize, self.channels);
        let values = match &self.values {
            Values::Eight(all) => Values::Eight(cut(all, across, channels, window)),
            Values::Sixteen(all) => Values::Sixteen(cut(all, across, channels, window)),
        };
        Self {
            width,
            height,
            channels,
            values,
        }
    }

    /// The brightest value, of whichever colour, of samples of 16 bits; 0 for others.
    pub(super) fn brightest(&self) -> u16 {
        match &self.values {
            Values::Eight(_) => 0,
            Values::Sixteen(values) => brightest(values, self.channels),
        }
    }

    /// Colours and grey values; `brightest` is that of the whole image, where it has 16 bits.
    pub(super) fn photograph(self, brightest: u16) -> Photograph {
        let (width, height, channels) = (self.width, self.height, self.channels);
        match self.values {
            Values::Eight(values) => {
                let rgb = rgb_image(width, height, channels, values);
                let gray = Gray::from_rgb(&rgb);
                Photograph { rgb, gray }
            }
            Values::Sixteen(values) => scale_16_bits([width, height], channels, &values, brightest),
        }
    }
}

/// The brightest of the colours; alpha does not count.
fn brightest(values: &[u16], channels: usize) -> u16 {
    let colours = values
        .chunks(channels)
        .flat_map(|pixel| &pixel[..colours_of(channels).min(pixel.len())]);
    colours.copied().max().unwrap_or(0)
}

/// How many of the samples of a pixel are colours.
fn colours_of(channels: usize) -> usize {
    if channels < 3 { 1 } else { 3 }
}

/// The three colours of a pixel.
fn rgb<T: Copy>(pixel: &[T]) -> [T; 3] {
    match *pixel {
        [r, g, b, ..] => [r, g, b],
        _ => [pixel[0]; 3],
    }
}

fn cut<T: Copy>(all: &[T], across: usize, channels: usize, window: PixelWindow) -> Vec<T> {
    let [column, row, width, height] = window.map(|v| v as usize);
    (row..row + height)
        .flat_map(|y| {
            let start = (y * across + column) * channels;
            &all[start..start + width * channels]
        })
        .copied()
        .collect()
}

fn rgb_image(width: u32, height: u32, channels: usize, values: Vec<u8>) -> image::RgbImage {
    let colours = if channels == 3 {
        values
    } else {
        values.chunks_exact(channels).flat_map(rgb).collect()
    };
    image::RgbImage::from_raw(width, height, colours).expect("there are three values a pixel")
}

fn scale_16_bits(
    [width, height]: [u32; 2],
    channels: usize,
    values: &[u16],
    brightest: u16,
) -> Photograph {
    let bits = (u16::BITS - brightest.leading_zeros()).max(8);
    let white = ((1u32 << bits) - 1) as f32;
    let colours = values
        .chunks_exact(channels)
        .flat_map(|p| rgb(p).map(|v| (f32::from(v) * 255.0 / white).round() as u8))
        .collect();
    let grey = |p: [u16; 3]| {
        (0.299 * f32::from(p[0]) + 0.587 * f32::from(p[1]) + 0.114 * f32::from(p[2])) / white
    };
    Photograph {
        rgb: image::RgbImage::from_raw(width, height, colours)
            .expect("there are three values a pixel"),
        gray: Gray {
            width: width as usize,
            height: height as usize,
            data: values
                .chunks_exact(channels)
                .map(|p| grey(rgb(p)))
                .collect(),
        },
    }
}
