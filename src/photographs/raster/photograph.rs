//! A photograph in memory: its colours and its grey values.

use super::coverage::{Coverage, reduced_colours, reduced_gray};
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

    /// The photograph by what the pixels of a smaller one cover of it.
    pub(crate) fn reduced(&self, columns: &Coverage, rows: &Coverage) -> Self {
        Self {
            rgb: reduced_colours(&self.rgb, columns, rows),
            gray: reduced_gray(&self.gray, columns, rows),
        }
    }
}
