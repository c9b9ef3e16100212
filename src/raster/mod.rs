//! Pixel rasters in f32 and the filters on them. Grey values run from 0 to 1.

pub(crate) mod fill;
mod filter;
mod jpeg;
mod light;
mod load;
mod noise;
mod part;
mod samples;
mod warmth;
mod warp;

pub(crate) use fill::{fill_gaps, mark_inside};
pub use filter::gaussian_blur;
pub use load::{ImageHeader, Photograph, image_format, image_header, load_image};
pub use noise::noise_of;
pub use part::{Part, decoding_bytes, load_part};
pub use warmth::{Channel, Warmth};
pub use warp::{Outside, Warp, corners};

use self::warp::bilinear;
use wide::bytemuck::cast;
use wide::{f32x4, f32x8};

/// A raster of grey values (or of anything else in f32), row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Gray {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` values, 0 (black) to 1 (white).
    pub data: Vec<f32>,
}

impl Gray {
    /// A raster of zeros.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            data: vec![0.0; width * height],
        }
    }

    /// A raster filled by `f(column, row)`.
    pub fn from_fn(width: usize, height: usize, mut f: impl FnMut(usize, usize) -> f32) -> Self {
        let mut data = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                data.push(f(x, y));
            }
        }
        Self {
            width,
            height,
            data,
        }
    }

    /// Luma (Rec. 601 weights) of an RGB image.
    pub fn from_rgb(rgb: &image::RgbImage) -> Self {
        let data = rgb
            .pixels()
            .map(|p| {
                (0.299 * f32::from(p[0]) + 0.587 * f32::from(p[1]) + 0.114 * f32::from(p[2]))
                    / 255.0
            })
            .collect();
        Self {
            width: rgb.width() as usize,
            height: rgb.height() as usize,
            data,
        }
    }

    /// The mean of each block of `factor` x `factor` pixels; rows and columns left over are dropped.
    pub fn reduced(&self, factor: usize) -> Self {
        let area = (factor * factor) as f32;
        Self::from_fn(self.width / factor, self.height / factor, |x, y| {
            let row = |dy: usize| {
                let start = (y * factor + dy) * self.width + x * factor;
                self.data[start..start + factor].iter().sum::<f32>()
            };
            (0..factor).map(row).sum::<f32>() / area
        })
    }

    /// The value at a column and row.
    pub fn get(&self, x: usize, y: usize) -> f32 {
        self.data[y * self.width + x]
    }

    /// Bilinear value at an image position (centre of the top-left pixel at (0.5, 0.5)); `None`
    /// where one of the four pixels is missing.
    pub fn sample(&self, x: f32, y: f32) -> Option<f32> {
        let (x, y) = (x - 0.5, y - 0.5);
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (column, row) = (x as usize, y as usize);
        if column + 1 >= self.width || row + 1 >= self.height {
            return None;
        }
        let (fx, fy) = (x - column as f32, y - row as f32);
        let i = row * self.width + column;
        let top = self.data[i] + (self.data[i + 1] - self.data[i]) * fx;
        let j = i + self.width;
        let bottom = self.data[j] + (self.data[j + 1] - self.data[j]) * fx;
        Some(top + (bottom - top) * fy)
    }

    /// Bilinear values at eight positions, counted from the centre of the top-left pixel, which must not lie outside the
    /// image by more than rounding.
    pub fn between(&self, x: f32x8, y: f32x8) -> f32x8 {
        // Rounding may lead before the first pixel or to the last, which has no right neighbour. Samples count from half a
        // pixel later.
        let within = |x: f32x8, size: usize| -> [f32x4; 2] {
            let last = f32x8::splat(((size - 1) as f32).next_down());
            cast(x.fast_max(f32x8::ZERO).fast_min(last) - f32x8::splat(0.5))
        };
        let ([x0, x1], [y0, y1]) = (within(x, self.width), within(y, self.height));
        cast([bilinear(self, 0, x0, y0), bilinear(self, 0, x1, y1)])
    }

    /// [`Self::sample`] at eight positions at once; NaN in place of `None`.
    pub fn sample_eight(&self, x: [f32; 8], y: [f32; 8]) -> f32x8 {
        let zero = f32x8::ZERO;
        let [x, y] = [x, y].map(|x| f32x8::from(x) - f32x8::splat(0.5));
        let [last_x, last_y] =
            [self.width, self.height].map(|n| f32x8::splat(n.saturating_sub(1) as f32));
        let inside = x.simd_ge(zero) & y.simd_ge(zero) & x.simd_lt(last_x) & y.simd_lt(last_y);
        if !inside.any() {
            return f32x8::splat(f32::NAN);
        }
        let [x, y] = [x, y].map(|x| inside.select(x, zero));
        inside.select(self.between(x, y), f32x8::splat(f32::NAN))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sampling_reproduces_a_plane() {
        let g = Gray::from_fn(9, 7, |x, y| {
            0.1 * (x as f32 + 0.5) + 0.02 * (y as f32 + 0.5)
        });
        let v = g.sample(3.3, 4.7).unwrap();
        assert!((v - (0.33 + 0.094)).abs() < 1e-5);
        assert!(g.sample(0.4, 3.0).is_none() && g.sample(8.6, 3.0).is_none());
        assert!(g.sample(f32::NAN, 3.0).is_none());
    }

    #[test]
    fn eight_samples_are_those_one_by_one() {
        let g = Gray::from_fn(9, 7, |x, y| ((x * 7 + y * 13) % 31) as f32 / 31.0);
        let x = [0.4, 0.5, 3.3, 8.499, 8.5, 2.0, f32::NAN, 6.999];
        for y in [
            [1.0; 8],
            [0.5, 6.499, 4.7, 5.2, 3.0, 6.5, 3.0, 0.499],
            [-3.0; 8],
        ] {
            let eight = g.sample_eight(x, y).to_array();
            for lane in 0..8 {
                let one = g.sample(x[lane], y[lane]);
                assert_eq!(
                    one.is_none(),
                    eight[lane].is_nan(),
                    "{} {}",
                    x[lane],
                    y[lane]
                );
                assert!(one.is_none_or(|v| v == eight[lane]));
            }
        }
    }
}
