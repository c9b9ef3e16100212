//! Interest points of a reduced image: corners, where the grey values change in two directions.

use nalgebra::Point2;

use crate::photographs::raster::Gray;

/// Cells along the longer side of the image; each gives its best point, so that points are spread
/// over it.
const CELLS: usize = 9;

/// Half the window of the structure tensor, pixels.
const REACH: usize = 2;

/// Least change of the grey value per pixel in the weaker direction (0 to 1). Assumption: above the
/// noise of eight-bit images.
const LEAST_CHANGE: f32 = 0.008;

/// The points, pixels of the reduced image, at least `margin` from its border.
pub(crate) fn interest_points(gray: &Gray, margin: usize) -> Vec<Point2<f64>> {
    let margin = margin.max(REACH + 1);
    let cell = gray.width.max(gray.height).div_ceil(CELLS).max(1);
    let mut points = Vec::new();
    for top in (margin..gray.height.saturating_sub(margin)).step_by(cell) {
        for left in (margin..gray.width.saturating_sub(margin)).step_by(cell) {
            let rows = top..(top + cell).min(gray.height - margin);
            let columns = left..(left + cell).min(gray.width - margin);
            let mut best = (LEAST_CHANGE * LEAST_CHANGE, None);
            for y in rows {
                for x in columns.clone() {
                    let change = weaker_change(gray, x, y);
                    if change > best.0 {
                        best = (change, Some((x, y)));
                    }
                }
            }
            points.extend(
                best.1
                    .map(|(x, y)| Point2::new(x as f64 + 0.5, y as f64 + 0.5)),
            );
        }
    }
    points
}

/// The smaller eigenvalue of the mean structure tensor around a pixel.
fn weaker_change(gray: &Gray, x: usize, y: usize) -> f32 {
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for v in y - REACH..=y + REACH {
        for u in x - REACH..=x + REACH {
            let dx = 0.5 * (gray.get(u + 1, v) - gray.get(u - 1, v));
            let dy = 0.5 * (gray.get(u, v + 1) - gray.get(u, v - 1));
            (xx, xy, yy) = (xx + dx * dx, xy + dx * dy, yy + dy * dy);
        }
    }
    let count = ((2 * REACH + 1) * (2 * REACH + 1)) as f32;
    let (half, difference) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    (half - (difference * difference + xy * xy).sqrt()) / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_found_and_edges_are_not() {
        let square = |x: usize, y: usize| f32::from((30..50).contains(&x) && (30..50).contains(&y));
        let corners = [(30.0, 30.0), (50.0, 30.0), (30.0, 50.0), (50.0, 50.0)];
        let points = interest_points(&Gray::from_fn(80, 80, square), 5);
        assert!(points.len() >= 4);
        for p in &points {
            let near = |&(x, y): &(f64, f64)| (p - Point2::new(x, y)).norm() < 5.0;
            assert!(corners.iter().any(near), "{p}");
        }
        let edge = Gray::from_fn(80, 80, |x, _| if x < 41 { 0.0 } else { 1.0 });
        assert!(interest_points(&edge, 5).is_empty());
    }
}
