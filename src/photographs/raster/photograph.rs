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
        Self {
            rgb: reduced_colours(&self.rgb, factor),
            gray: self.gray.reduced(factor as usize),
        }
    }
}

/// The mean colour of each block of `factor` x `factor` pixels; rows and columns left over are
/// dropped.
pub(crate) fn reduced_colours(rgb: &image::RgbImage, factor: u32) -> image::RgbImage {
    let (width, height) = rgb.dimensions();
    let area = factor * factor;
    image::RgbImage::from_fn(width / factor, height / factor, |x, y| {
        let block = (0..area).map(|i| (x * factor + i % factor, y * factor + i / factor));
        let sums = block.fold([0; 3], |sums: [u32; 3], (x, y)| {
            let pixel = rgb.get_pixel(x, y).0;
            [0, 1, 2].map(|c| sums[c] + u32::from(pixel[c]))
        });
        image::Rgb(sums.map(|sum| ((sum + area / 2) / area) as u8))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reduced_photograph_has_the_means_of_blocks() {
        let value = |x: u32, y: u32| (10 * x + 40 * y) as u8;
        let rgb = image::RgbImage::from_fn(5, 4, |x, y| image::Rgb([value(x, y), 0, 255]));
        let gray = Gray::from_rgb(&rgb);
        let half = Photograph { rgb, gray }.reduced(2);
        assert_eq!(half.rgb.dimensions(), (2, 2));
        assert_eq!(half.rgb.get_pixel(1, 1).0, [25 + 20 + 80, 0, 255]);
        let expected = Gray::from_rgb(&half.rgb);
        assert!((half.gray.get(1, 1) - expected.get(1, 1)).abs() < 1e-6);
    }
}
