//! Photo-consistency inside a facet: the correlation windows that lie wholly in it (B99 4.3,
//! verification).
//!
//! Along an edge every plane through it is as good as the next within half a window. A plane that
//! bridges two roofs over shadow or a gap touches edges of both and is confirmed by them; only its
//! interior contradicts it.

use nalgebra::{Point2, Point3};

use crate::base::evidence::WindowHistogram;
use crate::base::geometry::Polygon;
use crate::base::ids::ViewId;
use crate::orienting::scene::Scene;
use crate::photographs::raster::mark_inside;
use crate::planes::photoconsistency::PlanGrid;
use crate::planes::photoconsistency::{ConsistencyMap, consistency_map_behind};
use crate::planes::photoconsistency::{HALF_WINDOW, WINDOW};
use crate::roofs::model::Facet;

/// The windows that lie wholly inside a facet.
pub(super) struct InteriorWindows<'m> {
    /// How the views agree on its plane.
    map: &'m ConsistencyMap,
    /// The middles of the windows, as cells of the map's grid.
    windows: Vec<usize>,
}

/// Photo-consistency map of a facet's plane over its part of the plan; `hidden` tells which views
/// do not see a point.
pub(super) fn interior_map(
    scene: &Scene,
    facet: &Facet,
    step: f64,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> ConsistencyMap {
    let [min, max] = facet.plan_bounds();
    let grid = PlanGrid::covering(min, max, step);
    consistency_map_behind(scene, &facet.plane, &grid, hidden)
}

impl<'m> InteriorWindows<'m> {
    /// The windows inside a facet, with the map of its plane.
    pub(super) fn of(facet: &Facet, map: &'m ConsistencyMap) -> Self {
        let windows = windows_inside(facet, &map.grid);
        Self { map, windows }
    }

    /// Some of the windows' middles, in plan, spread over the facet.
    pub(super) fn places(&self) -> impl Iterator<Item = Point2<f64>> {
        // Assumption: the mean over some hundreds is known to a few percent.
        const MOST_PLACES: usize = 500;
        let grid = &self.map.grid;
        let every = self.windows.len().div_ceil(MOST_PLACES).max(1);
        let windows = self.windows.iter().step_by(every);
        windows.map(|k| grid.center(k % grid.width, k / grid.width))
    }

    /// Counts the windows on a plane.
    pub(super) fn count(&self, on: &ConsistencyMap, counts: &mut WindowHistogram) {
        for (_, j) in self.shared_with(&on.grid) {
            counts.add(on.weight(j), on.correlation(j));
        }
    }

    /// The windows whose middles are cells of another grid, too: the cell of either.
    fn shared_with(&self, grid: &PlanGrid) -> impl Iterator<Item = (usize, usize)> {
        let own = &self.map.grid;
        let (dc, dr) = own.offset_in(grid);
        let at =
            |k: usize, d: isize, size: usize| k.checked_add_signed(d).filter(|moved| *moved < size);
        self.windows.iter().filter_map(move |&k| {
            let column = at(k % own.width, dc, grid.width)?;
            let row = at(k / own.width, dr, grid.height)?;
            Some((k, row * grid.width + column))
        })
    }

    /// How much better the views agree on another plane in the same windows: the mean difference of
    /// the correlations, in standard deviations of that mean. As many windows count as fit in side
    /// by side, since others share cells. Zero where no window sees both planes.
    pub(super) fn advantage_of(&self, other: &ConsistencyMap) -> f64 {
        let own = self.map;
        let (mut weights, mut squares, mut sum, mut sum_squares) = (0.0, 0.0, 0.0, 0.0);
        for (k, j) in self.shared_with(&other.grid) {
            let weight = f64::from(own.weight(k).min(other.weight(j)));
            let difference = f64::from(other.correlation(j) - own.correlation(k));
            weights += weight;
            squares += weight * weight;
            sum += weight * difference;
            sum_squares += weight * difference * difference;
        }
        if weights <= 0.0 {
            return 0.0;
        }
        let mean = sum / weights;
        let variance = (sum_squares / weights - mean * mean).max(LEAST_VARIANCE);
        let independent = weights * weights / (squares * (WINDOW * WINDOW) as f64);
        mean / (variance / independent).sqrt()
    }
}

/// The middles of the windows that lie wholly inside a facet, as cells of a grid, row by row.
pub(crate) fn windows_inside(facet: &Facet, grid: &PlanGrid) -> Vec<usize> {
    windows_in(&cells_inside(&facet.plan(), grid), grid.width)
}

/// Least variance of a difference of correlations: that of their rounding.
const LEAST_VARIANCE: f64 = 1e-5;
/// Which cells of a grid, row by row, lie inside a polygon.
fn cells_inside(polygon: &Polygon, grid: &PlanGrid) -> Vec<bool> {
    let pixels = polygon.mapped(|p| Point2::from((p - grid.origin) / grid.step));
    let mut mask = vec![false; grid.width * grid.height];
    mark_inside(&pixels, grid.width, grid.height, &mut mask);
    mask
}

/// The middles of the windows all of whose cells are marked.
fn windows_in(mask: &[bool], width: usize) -> Vec<usize> {
    let mut windows = Vec::new();
    // How many rows up to this one hold a whole side of a window that ends in the column.
    let mut rows = vec![0; width];
    for (y, row) in mask.chunks_exact(width.max(1)).enumerate() {
        let mut run = 0;
        for (x, (inside, rows)) in row.iter().zip(&mut rows).enumerate() {
            run = if *inside { run + 1 } else { 0 };
            *rows = if run >= WINDOW { *rows + 1 } else { 0 };
            if *rows >= WINDOW {
                windows.push((y - HALF_WINDOW) * width + x - HALF_WINDOW);
            }
        }
    }
    windows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of windows on a grid of 0.2 m.
    fn windows(rings: &[Vec<Point2<f64>>]) -> usize {
        let rings = rings.to_vec();
        let polygon = Polygon { rings };
        let grid = PlanGrid {
            origin: Point2::new(2.0, -6.0),
            step: 0.2,
            width: 55,
            height: 20,
        };
        let mask = cells_inside(&polygon, &grid);
        windows_in(&mask, grid.width).len()
    }

    fn strip(width: f64) -> Vec<Point2<f64>> {
        let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, width), (0.0, width)];
        corners.map(|(x, y)| Point2::new(x + 3.0, y - 5.0)).to_vec()
    }

    /// How a plane agrees at the places of a grid of 35 by 25 cells, 0.2 m, moved by whole cells.
    fn map(moved: [f64; 2], correlation: impl Fn(Point2<f64>) -> f32) -> ConsistencyMap {
        let grid = PlanGrid {
            origin: Point2::new(-1.0 + 0.2 * moved[0], -1.0 + 0.2 * moved[1]),
            step: 0.2,
            width: 35,
            height: 25,
        };
        let cells = grid.width * grid.height;
        let at = |k: usize| correlation(grid.center(k % grid.width, k / grid.width));
        ConsistencyMap {
            grid,
            correlation: (0..cells).map(|k| (at(k) * 127.0) as i8).collect(),
            weight: vec![200; cells],
            common_weight: vec![200; cells],
        }
    }

    /// A facet of 5 m by 3 m.
    fn facet() -> Facet {
        let corners = [(0.0, 0.0), (5.0, 0.0), (5.0, 3.0), (0.0, 3.0)];
        crate::roofs::testing::facet(&corners.map(|(x, y)| Point3::new(x, y, 0.0)))
    }

    /// Mean correlation inside if the facet's edges correlate, and its inside does by `inside`.
    fn with_edges(inside: f32) -> f64 {
        let map = map([0.0; 2], |p| {
            let from_edge = p.x.min(5.0 - p.x).min(p.y.min(3.0 - p.y));
            if from_edge > 0.45 { inside } else { 0.9 }
        });
        let inside = InteriorWindows::of(&facet(), &map).windows;
        let sum: f64 = inside.iter().map(|&k| f64::from(map.correlation(k))).sum();
        sum / inside.len() as f64
    }

    /// Values between -1 and 1 that change from cell to cell.
    fn scatter(p: Point2<f64>) -> f32 {
        (37.0 * p.x + 91.0 * p.y).rem_euclid(2.0) as f32 - 1.0
    }

    #[test]
    fn a_plane_that_the_views_agree_better_on_has_the_advantage() {
        let own = map([0.0; 2], |p| 0.5 + 0.1 * scatter(p));
        let inside = InteriorWindows::of(&facet(), &own);
        // 231 windows of 5 by 5 cells are 9.2 side by side; the mean is 0.1, the standard
        // deviation 0.14.
        let better = map([3.0, -2.0], |p| 0.6 - 0.1 * scatter(p));
        let sigmas = inside.advantage_of(&better);
        assert!((1.5..3.5).contains(&sigmas), "{sigmas}");
        let worse = map([3.0, -2.0], |p| 0.4 - 0.1 * scatter(p));
        assert!(inside.advantage_of(&worse) < -1.5);
        assert!(inside.advantage_of(&own).abs() < 1e-9);
    }

    #[test]
    fn windows_are_counted_on_the_plane_that_is_asked_for() {
        let own = map([0.0; 2], |_| 0.75);
        let inside = InteriorWindows::of(&facet(), &own);
        let counted = |map: &ConsistencyMap| {
            let mut counts = WindowHistogram::default();
            inside.count(map, &mut counts);
            // Weights of 200 of 255 are of the fourth class.
            let row = counts.rows().nth(3).expect("nine classes").to_vec();
            [15, 17].map(|class| row[class] as usize)
        };
        let all = inside.windows.len();
        assert_eq!(counted(&own), [0, all]);
        assert_eq!(counted(&map([3.0, -2.0], |_| 0.55)), [all, 0]);
        assert_eq!(counted(&map([90.0, 0.0], |_| 0.55)), [0, 0], "elsewhere");
    }

    #[test]
    fn scatter_that_both_planes_share_does_not_count() {
        let common = |p: Point2<f64>| 0.3 * scatter(p);
        let own = map([0.0; 2], |p| 0.4 + common(p));
        let inside = InteriorWindows::of(&facet(), &own);
        assert!(inside.advantage_of(&map([0.0; 2], |p| 0.5 + common(p))) > 10.0);
    }

    #[test]
    fn planes_without_a_window_in_common_cannot_be_compared() {
        let own = map([0.0; 2], |_| 0.2);
        let inside = InteriorWindows::of(&facet(), &own);
        assert_eq!(inside.advantage_of(&map([90.0, 0.0], |_| 0.9)), 0.0);
        assert_eq!(inside.advantage_of(&map([-90.0, -60.0], |_| 0.9)), 0.0);
    }

    #[test]
    fn edges_do_not_speak_for_the_inside() {
        // Over the whole facet both would correlate by more than 0.5.
        assert!((with_edges(0.2) - 0.2).abs() < 0.01);
        assert!((with_edges(0.6) - 0.6).abs() < 0.01);
    }

    #[test]
    fn a_strip_holds_a_window_when_it_is_as_wide() {
        assert!(windows(&[strip(0.95)]) > 0);
        assert!(windows(&[strip(0.85)]) == 0);
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
