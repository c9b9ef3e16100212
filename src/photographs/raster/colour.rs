//! Colours between the pixels of a photograph.

use glam::Vec3;
use nalgebra::Point2;

/// Bilinear colour, 0 to 255, at an image position; `None` outside the centres of the border
/// pixels.
pub(crate) fn colour_at(rgb: &image::RgbImage, p: &Point2<f64>) -> Option<Vec3> {
    let (x, y) = (p.x - 0.5, p.y - 0.5);
    let (w, h) = (rgb.width() as usize, rgb.height() as usize);
    if !(x >= 0.0 && y >= 0.0 && x <= (w - 1) as f64 && y <= (h - 1) as f64) {
        return None;
    }
    let (column, row) = (
        (x as usize).min(w.max(2) - 2),
        (y as usize).min(h.max(2) - 2),
    );
    let (fx, fy) = ((x - column as f64) as f32, (y - row as f64) as f32);
    let (right, below) = ((column + 1).min(w - 1), (row + 1).min(h - 1));
    let raw = rgb.as_raw();
    let at = |x: usize, y: usize| {
        let first = (y * w + x) * 3;
        Vec3::from_array([0, 1, 2].map(|c| f32::from(raw[first + c])))
    };
    let top = at(column, row) * (1.0 - fx) + at(right, row) * fx;
    let bottom = at(column, below) * (1.0 - fx) + at(right, below) * fx;
    Some(top * (1.0 - fy) + bottom * fy)
}
