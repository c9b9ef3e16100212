//! The image as ORIS reads it: grey and two colour differences.

use super::integrals::CHANNELS;
use crate::photographs::raster::{Gray, gaussian_blur};

/// Grey values and the differences of red and blue from them (half of them, around 1/2), 0 to 1,
/// sharp and blurred.
pub struct ColorImage {
    /// As photographed.
    pub sharp: [Gray; CHANNELS],
    /// After a Gaussian blur.
    pub smooth: [Gray; CHANNELS],
}

impl ColorImage {
    /// From grey values and colours of the same size; `smoothing_px` is the standard deviation of
    /// the blur.
    pub fn new(gray: &Gray, rgb: &image::RgbImage, smoothing_px: f64) -> Self {
        let difference = |band: usize| {
            let mut d = gray.clone();
            for (value, pixel) in d.data.iter_mut().zip(rgb.pixels()) {
                *value = 0.5 + 0.5 * (f32::from(pixel[band]) / 255.0 - *value);
            }
            d
        };
        Self::blurred([gray.clone(), difference(0), difference(2)], smoothing_px)
    }

    /// From grey values alone.
    #[cfg(test)]
    pub(super) fn from_gray(gray: &Gray, smoothing_px: f64) -> Self {
        let none = Gray::new(gray.width, gray.height);
        Self::blurred([gray.clone(), none.clone(), none], smoothing_px)
    }

    fn blurred(sharp: [Gray; CHANNELS], smoothing_px: f64) -> Self {
        let empty = sharp[0].data.is_empty();
        let smooth = sharp.each_ref().map(|g| {
            if empty {
                g.clone()
            } else {
                gaussian_blur(g, smoothing_px)
            }
        });
        Self { sharp, smooth }
    }
}
