//! A raster of grey values.

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

    /// The mean of each block of `factor` x `factor` pixels; rows and columns left over are
    /// dropped.
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

    /// Grey values that rise linearly with the position of the pixel's centre.
    #[cfg(test)]
    pub(crate) fn ramp(width: usize, height: usize) -> Self {
        Self::from_fn(width, height, |x, y| {
            0.01 * (x as f32 + 0.5) + 0.02 * (y as f32 + 0.5)
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
}
