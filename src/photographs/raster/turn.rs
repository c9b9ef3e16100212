//! A photograph as its EXIF header wants it shown: the orientations that exchange width and height.

use super::gray::Gray;
use super::photograph::{Photograph, PixelWindow};

/// A quarter turn, perhaps with a mirror: EXIF orientations 5 to 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    /// Do the columns as shown run from the last stored row to the first?
    from_last_row: bool,
    /// Do the rows as shown run from the last stored column to the first?
    from_last_column: bool,
}

impl Turn {
    /// By the number in the EXIF header; `None` for those that keep width and height.
    pub fn from_exif(orientation: u8) -> Option<Self> {
        (5..=8).contains(&orientation).then_some(Self {
            from_last_row: matches!(orientation, 6 | 7),
            from_last_column: matches!(orientation, 7 | 8),
        })
    }

    /// The stored window of a window as shown; `stored` is the size of the whole image as stored.
    pub fn stored_window(
        self,
        [column, row, width, height]: PixelWindow,
        stored: [u32; 2],
    ) -> PixelWindow {
        let from = |start: u32, length: u32, size: u32, from_last: bool| match from_last {
            true => size - start - length,
            false => start,
        };
        [
            from(row, height, stored[0], self.from_last_column),
            from(column, width, stored[1], self.from_last_row),
            height,
            width,
        ]
    }

    /// Turns a stored photograph.
    pub fn apply(self, stored: &Photograph) -> Photograph {
        let (width, height) = stored.rgb.dimensions();
        let place = |x: u32, y: u32| {
            let [column, row, ..] = self.stored_window([x, y, 1, 1], [width, height]);
            (column, row)
        };
        let rgb = image::RgbImage::from_fn(height, width, |x, y| {
            let (column, row) = place(x, y);
            *stored.rgb.get_pixel(column, row)
        });
        let gray = Gray::from_fn(height as usize, width as usize, |x, y| {
            let (column, row) = place(x as u32, y as u32);
            stored.gray.get(column as usize, row as usize)
        });
        Photograph { rgb, gray }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stored() -> Photograph {
        let rgb = image::RgbImage::from_fn(5, 3, |x, y| image::Rgb([x as u8, y as u8, 7]));
        let gray = Gray::from_rgb(&rgb);
        Photograph { rgb, gray }
    }

    #[test]
    fn turned_as_every_viewer_does() {
        for exif in 1..=8 {
            let turn = Turn::from_exif(exif);
            assert_eq!(turn.is_some(), exif > 4);
            let mut shown = image::DynamicImage::ImageRgb8(stored().rgb);
            shown.apply_orientation(image::metadata::Orientation::from_exif(exif).unwrap());
            if let Some(turn) = turn {
                let turned = turn.apply(&stored());
                assert_eq!(turned.rgb, shown.into_rgb8(), "{exif}");
                assert_eq!(turned.gray, Gray::from_rgb(&turned.rgb));
            }
        }
    }

    #[test]
    fn a_window_turned_is_a_window_of_the_turned() {
        for turn in (5..=8).filter_map(Turn::from_exif) {
            let window = [1, 2, 2, 3];
            let of_stored = stored().crop(turn.stored_window(window, [5, 3]));
            assert_eq!(turn.apply(&of_stored), turn.apply(&stored()).crop(window));
        }
    }
}
