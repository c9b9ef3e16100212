//! What the inside of a facet shows: the windows of comparison that lie wholly in it (B99 4.3, verification).
//!
//! Along an edge every plane through it is as good as the next within half a window. A plane that bridges two roofs
//! over shadow or a gap touches edges of both and is confirmed by them; only its inside can tell.

use nalgebra::Point2;

use super::box_sum::HALF_WINDOW;
use super::consistency::{ConsistencyMap, least_correlation};
use crate::texture::raster::mark_inside;

/// What the windows inside a facet say about its plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interior {
    /// Number of windows.
    pub windows: usize,
    /// Sum of their texture weights.
    pub weight: f64,
    /// Sum of weight x correlation.
    pub correlation: f64,
    /// The same for the correlation at which the plane is as good as none.
    pub least: f64,
}

impl Interior {
    /// Sums the map of a plane over the windows wholly inside `rings` (in plan, metres, holes too); `min_correlation` is
    /// what strong texture must reach.
    pub fn of(rings: &[Vec<Point2<f64>>], map: &ConsistencyMap, min_correlation: f64) -> Self {
        let grid = &map.grid;
        let mut interior = Self::default();
        for_each_window(
            rings,
            grid.origin,
            grid.step,
            [grid.width, grid.height],
            |k| {
                let weight = f64::from(map.weight(k));
                interior.windows += 1;
                interior.weight += weight;
                interior.correlation += weight * f64::from(map.correlation(k));
                interior.least += weight * least_correlation(weight, min_correlation);
            },
        );
        interior
    }

    /// Is there texture, and does it contradict the plane?
    pub fn speaks_against(&self) -> bool {
        self.correlation < self.least - TOLERANCE * self.weight
            && self.weight > TEXTURED * self.windows as f64
    }
}

/// How exactly the least correlation is known. Assumption.
const TOLERANCE: f64 = 0.02;
/// Mean texture weight from which on the inside of a facet has a say. Assumption: below it is mostly noise.
const TEXTURED: f64 = 0.1;

/// Calls `see` with the middle (row by row) of every window of a grid that lies inside the rings.
fn for_each_window(
    rings: &[Vec<Point2<f64>>],
    origin: Point2<f64>,
    step: f64,
    [width, height]: [usize; 2],
    mut see: impl FnMut(usize),
) {
    const SIDE: usize = 2 * HALF_WINDOW + 1;
    let pixels = |ring: &Vec<Point2<f64>>| {
        let pixel = |p: &Point2<f64>| Point2::from((p - origin) / step);
        ring.iter().map(pixel).collect()
    };
    let rings: Vec<Vec<Point2<f64>>> = rings.iter().map(pixels).collect();
    let mut mask = vec![false; width * height];
    mark_inside(&rings, width, height, &mut mask);
    // How many rows up to this one hold a whole side of a window that ends in the column.
    let mut rows = vec![0; width];
    for (y, row) in mask.chunks_exact(width.max(1)).enumerate() {
        let mut run = 0;
        for (x, (inside, rows)) in row.iter().zip(&mut rows).enumerate() {
            run = if *inside { run + 1 } else { 0 };
            *rows = if run >= SIDE { *rows + 1 } else { 0 };
            if *rows >= SIDE {
                see((y - HALF_WINDOW) * width + x - HALF_WINDOW);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::halfplane::plan::PlanGrid;

    /// Number of windows on a grid of 0.1 m.
    fn windows(rings: &[Vec<Point2<f64>>]) -> usize {
        let mut count = 0;
        for_each_window(rings, Point2::new(2.0, -6.0), 0.1, [110, 40], |_| {
            count += 1
        });
        count
    }

    fn strip(width: f64) -> Vec<Point2<f64>> {
        let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, width), (0.0, width)];
        corners.map(|(x, y)| Point2::new(x + 3.0, y - 5.0)).to_vec()
    }

    /// What a facet of 5 m by 3 m shows whose edges correlate, and whose inside correlates by `inside`.
    fn with_edges(inside: f32) -> Interior {
        let grid = PlanGrid {
            origin: Point2::new(-1.0, -1.0),
            step: 0.1,
            width: 70,
            height: 50,
        };
        let facet = [(0.0, 0.0), (5.0, 0.0), (5.0, 3.0), (0.0, 3.0)];
        let facet = facet.map(|(x, y)| Point2::new(x, y)).to_vec();
        let correlation = |k: usize| {
            let p = grid.center(k % grid.width, k / grid.width);
            let from_edge = p.x.min(5.0 - p.x).min(p.y.min(3.0 - p.y));
            if from_edge > 0.5 { inside } else { 0.9 }
        };
        let cells = grid.width * grid.height;
        let map = ConsistencyMap {
            grid,
            correlation: (0..cells).map(|k| (correlation(k) * 127.0) as i8).collect(),
            weight: vec![200; cells],
            common_weight: vec![200; cells],
        };
        Interior::of(&[facet], &map, 0.45)
    }

    #[test]
    fn edges_do_not_speak_for_the_inside() {
        // Over the whole facet both would correlate by more than 0.5.
        assert!(with_edges(0.2).speaks_against());
        assert!(!with_edges(0.6).speaks_against());
        assert_eq!(with_edges(0.6).windows, 40 * 20);
    }

    #[test]
    fn a_strip_holds_a_window_when_it_is_as_wide() {
        assert!(windows(&[strip(1.15)]) > 0);
        assert!(windows(&[strip(1.05)]) == 0);
        assert!(windows(&[]) == 0);
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
        assert!(windows(&rings) == 0);
        assert!(windows(&rings[..9]) > 0, "the last one was in the way");
    }
}
