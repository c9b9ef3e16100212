//! A photograph at its working size: each pixel the mean of the area that it covers.

use crate::photographs::raster::{Coverage, Gray, reduced_gray};

/// The image reduced until its longer side has `longest_px`; the image itself where it is smaller.
pub(super) fn to_working_size(image: &Gray, longest_px: usize) -> Gray {
    let longest = image.width.max(image.height);
    if longest <= longest_px {
        return image.clone();
    }
    let size = |side: usize| (side * longest_px + longest / 2) / longest;
    let (width, height) = (size(image.width).max(1), size(image.height).max(1));
    let [columns, rows] = [(width, image.width), (height, image.height)]
        .map(|(short, long)| Coverage::new(0..short, long as f64 / short as f64, 0..long));
    reduced_gray(image, &columns, &rows)
}

/// The image at twice its size, bilinear: the centre of the first pixel comes to (0.5, 0.5) again.
pub(super) fn doubled(image: &Gray) -> Gray {
    let (w, h) = (image.width, image.height);
    let at = |i: usize, side: usize| {
        let p = ((i as f32 + 0.5) / 2.0 - 0.5).clamp(0.0, (side - 1) as f32);
        let first = (p as usize).min(side.saturating_sub(2));
        (first, (first + 1).min(side - 1), p - first as f32)
    };
    let columns: Vec<_> = (0..2 * w).map(|x| at(x, w)).collect();
    let mut large = Gray::new(2 * w, 2 * h);
    for (y, out) in large.data.chunks_exact_mut(2 * w).enumerate() {
        let (top, bottom, fy) = at(y, h);
        let (top, bottom) = (&image.data[top * w..][..w], &image.data[bottom * w..][..w]);
        for (value, &(left, right, fx)) in out.iter_mut().zip(&columns) {
            let above = top[left] + (top[right] - top[left]) * fx;
            let below = bottom[left] + (bottom[right] - bottom[left]) * fx;
            *value = above + (below - above) * fy;
        }
    }
    large
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_directions_keep_a_ramp_in_its_place() {
        let reduced = to_working_size(&Gray::ramp(50, 30), 20);
        assert_eq!((reduced.width, reduced.height), (20, 12));
        assert!((reduced.get(10, 6) - 2.5 * Gray::ramp(20, 12).get(10, 6)).abs() < 0.002);
        let large = doubled(&Gray::ramp(20, 12));
        assert!((large.get(10, 6) - 0.5 * (0.01 * 10.5 + 0.02 * 6.5)).abs() < 1e-6);
    }

    #[test]
    fn a_small_image_stays_as_it_is() {
        assert_eq!(to_working_size(&Gray::ramp(20, 12), 20), Gray::ramp(20, 12));
    }
}
