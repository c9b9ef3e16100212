//! The Gaussian scale space (Lowe 2004, section 3): octaves of images blurred more and more, each
//! octave at half the size of the one before.

use crate::base::math;
use crate::photographs::raster::{Gray, gaussian_blur};

use super::resample::doubled;

/// Scales of an octave (Lowe 2004, section 3.2).
pub(super) const SCALES: usize = 3;

/// Blur of the first image of each octave, pixels of the octave (section 3.3).
pub(crate) const FIRST_SIGMA: f64 = 1.6;

/// Blur that a photograph has anyway, pixels.
const CAMERA_SIGMA: f64 = 0.5;

/// Shorter images show no keypoint of their octave.
const LEAST_SIDE: usize = 24;

/// Images of one size, each blurred `2^(1/3)` times as much as the one before.
pub(super) struct Octave {
    /// `SCALES + 3` images.
    pub images: Vec<Gray>,
    /// Pixels of the working image for one of the octave.
    pub pixel: f64,
    /// Where the centre of its first pixel lies in the working image, in x and in y.
    pub first_center: f64,
}

/// All octaves of an image.
pub(super) struct ScaleSpace {
    /// The finest first.
    pub octaves: Vec<Octave>,
}

impl ScaleSpace {
    /// The octaves of an image, from its double size where `is_doubled`.
    pub(super) fn new(image: &Gray, is_doubled: bool) -> Self {
        let (base, blurred, mut pixel) = match is_doubled {
            true => (doubled(image), 2.0 * CAMERA_SIGMA, 0.5),
            false => (image.clone(), CAMERA_SIGMA, 1.0),
        };
        let first_center = 0.5 * pixel;
        let missing = (FIRST_SIGMA * FIRST_SIGMA - blurred * blurred).sqrt();
        let mut first = gaussian_blur(&base, missing);
        let mut octaves: Vec<Octave> = Vec::new();
        while first.width.min(first.height) >= LEAST_SIDE {
            let images = blurred_images(first);
            first = every_second(&images[SCALES]);
            octaves.push(Octave {
                images,
                pixel,
                first_center,
            });
            pixel *= 2.0;
        }
        Self { octaves }
    }
}

/// Blur of the image at a fractional index, pixels of its octave.
pub(super) fn sigma_at(scale: f64) -> f64 {
    FIRST_SIGMA * math::exp(scale / SCALES as f64 * std::f64::consts::LN_2)
}

fn blurred_images(first: Gray) -> Vec<Gray> {
    let mut images = vec![first];
    for i in 1..SCALES + 3 {
        let (before, after) = (sigma_at((i - 1) as f64), sigma_at(i as f64));
        let step = (after * after - before * before).sqrt();
        images.push(gaussian_blur(&images[i - 1], step));
    }
    images
}

fn every_second(image: &Gray) -> Gray {
    Gray::from_fn(image.width / 2, image.height / 2, |x, y| {
        image.get(2 * x, 2 * y)
    })
}
