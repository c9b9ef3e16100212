//! Facets narrower than the window by which views are compared.

use nalgebra::{Point2, Vector2};

use super::box_sum::HALF_WINDOW;
use crate::texture::raster::mark_inside;

/// Do the rings (in plan, metres, holes too) hold a window of the comparison of views, at positions `step` metres apart?
///
/// Along an edge every plane through it is as good as the next within half a window, so what is narrower than a window
/// is shown by nothing but its edges.
pub fn holds_a_window(rings: &[Vec<Point2<f64>>], step: f64) -> bool {
    const SIDE: usize = 2 * HALF_WINDOW + 1;
    let bounds = |axis: usize| {
        let at = rings.iter().flatten().map(|p| p[axis]);
        at.fold((f64::MAX, f64::MIN), |(low, high), t| {
            (low.min(t), high.max(t))
        })
    };
    let ((x0, x1), (y0, y1)) = (bounds(0), bounds(1));
    let [width, height] = [x1 - x0, y1 - y0].map(|size| (size / step).ceil().max(0.0) as usize);
    let pixels = |ring: &Vec<Point2<f64>>| {
        let to_pixels = ring
            .iter()
            .map(|p| Point2::from((p - Vector2::new(x0, y0)).coords / step));
        to_pixels.collect()
    };
    let rings: Vec<Vec<Point2<f64>>> = rings.iter().map(pixels).collect();
    let mut mask = vec![false; width * height];
    mark_inside(&rings, width, height, &mut mask);
    // How many rows up to this one hold a whole side of a window that ends in the column.
    let mut rows = vec![0; width];
    mask.chunks_exact(width.max(1)).any(|row| {
        let mut run = 0;
        row.iter().zip(&mut rows).any(|(inside, rows)| {
            run = if *inside { run + 1 } else { 0 };
            *rows = if run >= SIDE { *rows + 1 } else { 0 };
            *rows >= SIDE
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.1;

    fn strip(width: f64) -> Vec<Point2<f64>> {
        let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, width), (0.0, width)];
        corners.map(|(x, y)| Point2::new(x + 3.0, y - 5.0)).to_vec()
    }

    #[test]
    fn a_strip_holds_a_window_when_it_is_as_wide() {
        assert!(holds_a_window(&[strip(1.15)], STEP));
        assert!(!holds_a_window(&[strip(1.05)], STEP));
        assert!(!holds_a_window(&[], STEP));
    }

    #[test]
    fn holes_and_notches_leave_less_room() {
        let hole = |x: f64, y: f64, size: f64| {
            let corners = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)];
            corners
                .map(|(a, b)| Point2::new(x + 3.0 + a, y - 5.0 + b))
                .to_vec()
        };
        let holes = (0..9).map(|i| hole(f64::from(i) + 0.1, 0.3, 0.8));
        let rings: Vec<_> = std::iter::once(strip(1.4)).chain(holes).collect();
        assert!(!holds_a_window(&rings, STEP));
        assert!(
            holds_a_window(&rings[..9], STEP),
            "the last one was in the way"
        );
    }
}
