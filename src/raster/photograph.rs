//! A photograph in memory: its colours and its grey values.

use super::gray::Gray;

/// Column, row, width and height of a rectangle of an image, pixels.
pub type PixelWindow = [u32; 4];

/// A decoded photograph.
#[derive(Clone, Debug, PartialEq)]
pub struct Photograph {
    /// Colours; a grey image has three equal channels.
    pub rgb: image::RgbImage,
    /// Grey values, 0 to 1.
    pub gray: Gray,
}

impl Photograph {
    /// The window at column, row of this width and height; it must lie inside.
    pub fn crop(&self, [column, row, width, height]: PixelWindow) -> Self {
        let rgb = image::imageops::crop_imm(&self.rgb, column, row, width, height).to_image();
        let gray = Gray::from_fn(width as usize, height as usize, |x, y| {
            self.gray.get(x + column as usize, y + row as usize)
        });
        Self { rgb, gray }
    }

    /// The mean of each block of `factor` x `factor` pixels; rows and columns left over are
    /// dropped.
    pub fn reduced(&self, factor: u32) -> Self {
        let area = factor * factor;
        let (width, height) = self.rgb.dimensions();
        let rgb = image::RgbImage::from_fn(width / factor, height / factor, |x, y| {
            let mut sum = [area / 2; 3];
            for (dx, dy) in (0..area).map(|i| (i % factor, i / factor)) {
                let pixel = self.rgb.get_pixel(x * factor + dx, y * factor + dy);
                sum = [0, 1, 2].map(|i| sum[i] + u32::from(pixel[i]));
            }
            image::Rgb(sum.map(|s| (s / area) as u8))
        });
        let gray = self.gray.reduced(factor as usize);
        Self { rgb, gray }
    }
}
