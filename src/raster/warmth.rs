//! The colour of an image in one number: warmth, the difference of red and blue.
//!
//! A red roof in the sun and the lawn beside it are often of the same grey, and so are a grey roof and dry grass. On the true
//! roof edges of three rendered scenes that edges in grey values miss (about a third of them), this difference exceeds 12 of 255 at
//! 32 to 55 %; red less green does at 14 to 45 %, and two differences add little to one. Skylight tints shadows blue, so that
//! a shadow has an edge here too, as in grey values.

use image::RgbImage;
use serde::Serialize;

use super::{Gray, noise_of};

/// Which number of a pixel is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Channel {
    /// Its grey value.
    Grey,
    /// Its warmth.
    Warmth,
}

impl Channel {
    /// The one that is not this.
    pub fn other(self) -> Self {
        match self {
            Self::Grey => Self::Warmth,
            Self::Warmth => Self::Grey,
        }
    }
}

/// The warmth of an image.
#[derive(Clone, Debug)]
pub struct Warmth {
    /// Half the difference of red and blue, around 1/2, 0 to 1; of the image's size.
    pub image: Gray,
    /// Standard deviation of the noise of one pixel.
    pub noise: f64,
}

impl Warmth {
    /// The warmth of a photograph; `None` for one without colour, whose bands differ nowhere by more than rounding.
    pub fn of(rgb: &RgbImage) -> Option<Self> {
        const ROUNDING: u8 = 2;
        (rgb.pixels().any(|p| p[0].abs_diff(p[2]) > ROUNDING)).then_some(())?;
        let (width, height) = rgb.dimensions();
        let mut image = Gray::new(width as usize, height as usize);
        for (value, pixel) in image.data.iter_mut().zip(rgb.pixels()) {
            *value = 0.5 + (f32::from(pixel[0]) - f32::from(pixel[2])) / 510.0;
        }
        let noise = noise_of(&image);
        Some(Self { image, noise })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn red_is_warm_and_blue_is_cool() {
        let mut rgb = RgbImage::from_pixel(3, 1, Rgb([90, 90, 90]));
        rgb.put_pixel(0, 0, Rgb([255, 40, 0]));
        rgb.put_pixel(2, 0, Rgb([0, 40, 255]));
        assert_eq!(Warmth::of(&rgb).unwrap().image.data, vec![1.0, 0.5, 0.0]);
    }

    #[test]
    fn grey_photographs_have_none() {
        let mut rgb = RgbImage::from_pixel(4, 4, Rgb([90, 90, 90]));
        rgb.put_pixel(1, 1, Rgb([200, 201, 202]));
        assert!(Warmth::of(&rgb).is_none());
    }
}
