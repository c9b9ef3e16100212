//! Photo-consistency inside a facet: the correlation windows that lie wholly in it (B99 4.3,
//! verification).
//!
//! Along an edge every plane through it is as good as the next within half a window. A plane that
//! bridges two roofs over shadow or a gap touches edges of both and is confirmed by them; only its
//! interior contradicts it.

use nalgebra::{Point2, Point3};

use crate::ids::ViewId;
use crate::model::Facet;
use crate::photoconsistency::PlanGrid;
use crate::photoconsistency::{
    ConsistencyMap, consistency_map_behind, least_correlation, least_overall,
};
use crate::photoconsistency::{HALF_WINDOW, WINDOW};
use crate::raster::mark_inside;
use crate::scene::Scene;

/// The windows that lie wholly inside a facet.
pub(super) struct InteriorWindows<'m> {
    /// How the views agree on its plane.
    map: &'m ConsistencyMap,
    /// The middles of the windows, as cells of the map's grid.
    windows: Vec<usize>,
    /// Share of the facet's cells that lie in one of them.
    share: f64,
}

/// Sums over the windows inside a facet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct InteriorSums {
    /// Number of windows.
    pub windows: usize,
    /// Sum of their texture weights.
    pub weight: f64,
    /// Sum of weight x correlation.
    pub correlation: f64,
    /// The same for the correlation at which the plane is as good as none.
    pub least: f64,
    /// Sum of weight x correlation of all pairs of views.
    pub overall: f64,
    /// The same for that at which the plane is as good as none.
    pub least_overall: f64,
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

/// Sums over the interior of a facet for the views that see it; `hidden` tells which do not see a
/// point, and `min_correlation` is what strong texture must reach.
pub(super) fn visible_interior(
    scene: &Scene,
    facet: &Facet,
    step: f64,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
    min_correlation: f64,
) -> InteriorSums {
    let map = interior_map(scene, facet, step, hidden);
    InteriorWindows::of(facet, &map).sums(min_correlation)
}

impl<'m> InteriorWindows<'m> {
    /// The windows inside a facet, with the map of its plane.
    pub(super) fn of(facet: &Facet, map: &'m ConsistencyMap) -> Self {
        let in_plan = |ring: &Vec<Point3<f64>>| ring.iter().map(Point3::xy).collect();
        let rings = std::iter::once(&facet.outer).chain(&facet.holes);
        let rings: Vec<Vec<Point2<f64>>> = rings.map(in_plan).collect();
        Self::new(&rings, map)
    }

    /// The windows inside `rings` (in plan, metres, holes too).
    fn new(rings: &[Vec<Point2<f64>>], map: &'m ConsistencyMap) -> Self {
        let mask = cells_inside(rings, &map.grid);
        let windows = windows_in(&mask, map.grid.width);
        let share = share_in_windows(&mask, map.grid.width, &windows);
        Self {
            map,
            windows,
            share,
        }
    }

    /// Is a facet so narrow that most of it is within half a window of its edges?
    pub(super) fn is_narrow(&self) -> bool {
        self.share < LEAST_SHARE
    }

    /// Their sums; `min_correlation` is what strong texture must reach.
    pub(super) fn sums(&self, min_correlation: f64) -> InteriorSums {
        let mut interior = InteriorSums {
            windows: self.windows.len(),
            ..InteriorSums::default()
        };
        for &k in &self.windows {
            let weight = f64::from(self.map.weight(k));
            interior.weight += weight;
            interior.correlation += weight * f64::from(self.map.correlation(k));
            interior.least += weight * least_correlation(weight, min_correlation);
            interior.overall += weight * f64::from(self.map.overall(k));
            interior.least_overall += weight * least_overall(weight, min_correlation);
        }
        interior
    }

    /// Some of the windows' middles, in plan, spread over the facet.
    pub(super) fn places(&self) -> impl Iterator<Item = Point2<f64>> {
        const MOST: usize = 500;
        let grid = &self.map.grid;
        let every = self.windows.len().div_ceil(MOST).max(1);
        let windows = self.windows.iter().step_by(every);
        windows.map(|k| grid.center(k % grid.width, k / grid.width))
    }

    /// How much better the views agree on another plane in the same windows: the mean difference of
    /// the correlations, in standard deviations of that mean. As many windows count as fit in side
    /// by side, since others share cells. Zero where no window sees both planes.
    pub(super) fn advantage_of(&self, other: &ConsistencyMap) -> f64 {
        let (own, grid) = (self.map, &other.grid);
        let (dc, dr) = own.grid.offset_in(grid);
        let (mut weights, mut squares, mut sum, mut sum_squares) = (0.0, 0.0, 0.0, 0.0);
        for &k in &self.windows {
            let column = (k % own.grid.width) as isize + dc;
            let row = (k / own.grid.width) as isize + dr;
            let (Ok(column), Ok(row)) = (usize::try_from(column), usize::try_from(row)) else {
                continue;
            };
            if column >= grid.width || row >= grid.height {
                continue;
            }
            let j = row * grid.width + column;
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

impl InteriorSums {
    /// Is there texture, and does it contradict the plane?
    pub(super) fn contradicts(&self) -> bool {
        self.falls_short(self.correlation, self.least, TOLERANCE)
    }

    /// The same for all pairs of views.
    pub(super) fn contradicts_overall(&self) -> bool {
        self.falls_short(self.overall, self.least_overall, TOLERANCE_OVERALL)
    }

    /// Do all pairs of views agree on the plane by little more than chance?
    pub(super) fn is_doubtful(&self) -> bool {
        self.falls_short(self.overall, self.least_overall, -DOUBT)
    }

    /// Do they by no more than chance?
    pub(super) fn is_by_chance(&self) -> bool {
        self.falls_short(self.overall, self.least_overall, 0.0)
    }

    /// Do the views agree on the plane as clearly as on most roofs?
    pub(super) fn is_clear(&self) -> bool {
        self.beyond_chance() >= CLEAR * self.weight
    }

    /// By how much the correlations, that of the better half of the pairs and that of all, exceed
    /// together what they must, summed over the windows.
    pub(super) fn beyond_chance(&self) -> f64 {
        self.correlation - self.least + self.overall - self.least_overall
    }

    fn falls_short(&self, correlation: f64, least: f64, tolerance: f64) -> bool {
        correlation < least - tolerance * self.weight
            && self.weight > TEXTURED * self.windows as f64
    }
}

/// Least variance of a difference of correlations: that of their rounding.
const LEAST_VARIANCE: f64 = 1e-5;
/// How exactly the least correlation is known. Assumption.
const TOLERANCE: f64 = 0.02;
/// By how much the mean of all pairs of views of a true roof may fall short: metal shines in some
/// of them and not in others. Measured: up to 0.11 on a roof of real-barns.
const TOLERANCE_OVERALL: f64 = 0.13;
/// Margin of the mean of all pairs below which the facet is tested again with the views that see
/// it. Assumption: occlusion in some views changes the mean of the pairs by less.
const DOUBT: f64 = 0.1;
/// By how much the correlations of a roof, that of the better half of the pairs and that of all,
/// exceed together what they must. Measured: by more on three quarters of the true facets of
/// rendered scenes, by less on hedges.
const CLEAR: f64 = 0.55;
/// Mean texture weight from which on the interior of a facet is evidence. Assumption: below it is
/// mostly noise.
const TEXTURED: f64 = 0.1;

/// Share of a facet that windows inside it must reach. Assumption: triangles and trapezes have half
/// or more.
const LEAST_SHARE: f64 = 0.25;

/// Which cells of a grid, row by row, lie inside the rings.
fn cells_inside(rings: &[Vec<Point2<f64>>], grid: &PlanGrid) -> Vec<bool> {
    let pixels = |ring: &Vec<Point2<f64>>| {
        let pixel = |p: &Point2<f64>| Point2::from((p - grid.origin) / grid.step);
        ring.iter().map(pixel).collect()
    };
    let rings: Vec<Vec<Point2<f64>>> = rings.iter().map(pixels).collect();
    let mut mask = vec![false; grid.width * grid.height];
    mark_inside(&rings, grid.width, grid.height, &mut mask);
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

/// Share of the marked cells that lie in one of the windows; 0 without any.
fn share_in_windows(mask: &[bool], width: usize, windows: &[usize]) -> f64 {
    let mut reached = vec![false; mask.len()];
    for &k in windows {
        for row in 0..WINDOW {
            let first = k + row * width - HALF_WINDOW * (width + 1);
            reached[first..first + WINDOW].fill(true);
        }
    }
    let count = |cells: &[bool]| cells.iter().filter(|c| **c).count();
    count(&reached) as f64 / count(mask).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of windows on a grid of 0.1 m, and the share of the cells in them.
    fn windows_and_share(rings: &[Vec<Point2<f64>>]) -> (usize, f64) {
        let grid = PlanGrid {
            origin: Point2::new(2.0, -6.0),
            step: 0.1,
            width: 110,
            height: 40,
        };
        let mask = cells_inside(rings, &grid);
        let windows = windows_in(&mask, grid.width);
        (windows.len(), share_in_windows(&mask, grid.width, &windows))
    }

    fn windows(rings: &[Vec<Point2<f64>>]) -> usize {
        windows_and_share(rings).0
    }

    fn strip(width: f64) -> Vec<Point2<f64>> {
        let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, width), (0.0, width)];
        corners.map(|(x, y)| Point2::new(x + 3.0, y - 5.0)).to_vec()
    }

    /// How a plane agrees at the places of a grid of 70 by 50 cells, 0.1 m, moved by whole cells.
    fn map(moved: [f64; 2], correlation: impl Fn(Point2<f64>) -> f32) -> ConsistencyMap {
        let grid = PlanGrid {
            origin: Point2::new(-1.0 + 0.1 * moved[0], -1.0 + 0.1 * moved[1]),
            step: 0.1,
            width: 70,
            height: 50,
        };
        let cells = grid.width * grid.height;
        let at = |k: usize| correlation(grid.center(k % grid.width, k / grid.width));
        ConsistencyMap {
            grid,
            correlation: (0..cells).map(|k| (at(k) * 127.0) as i8).collect(),
            overall: (0..cells).map(|k| (at(k) * 127.0) as i8).collect(),
            weight: vec![200; cells],
            common_weight: vec![200; cells],
        }
    }

    /// A facet of 5 m by 3 m.
    fn facet() -> Vec<Point2<f64>> {
        let corners = [(0.0, 0.0), (5.0, 0.0), (5.0, 3.0), (0.0, 3.0)];
        corners.map(|(x, y)| Point2::new(x, y)).to_vec()
    }

    /// What the facet shows if its edges correlate, and its inside correlates by `inside`.
    fn with_edges(inside: f32) -> InteriorSums {
        let map = map([0.0; 2], |p| {
            let from_edge = p.x.min(5.0 - p.x).min(p.y.min(3.0 - p.y));
            if from_edge > 0.5 { inside } else { 0.9 }
        });
        InteriorWindows::new(&[facet()], &map).sums(0.45)
    }

    /// Values between -1 and 1 that change from cell to cell.
    fn scatter(p: Point2<f64>) -> f32 {
        (37.0 * p.x + 91.0 * p.y).rem_euclid(2.0) as f32 - 1.0
    }

    #[test]
    fn a_plane_that_the_views_agree_better_on_has_the_advantage() {
        let own = map([0.0; 2], |p| 0.5 + 0.1 * scatter(p));
        let inside = InteriorWindows::new(&[facet()], &own);
        // 800 windows of 11 by 11 cells are 6.6 side by side; the mean is 0.1, the standard
        // deviation 0.14.
        let better = map([3.0, -2.0], |p| 0.6 - 0.1 * scatter(p));
        let sigmas = inside.advantage_of(&better);
        assert!((1.5..3.5).contains(&sigmas), "{sigmas}");
        let worse = map([3.0, -2.0], |p| 0.4 - 0.1 * scatter(p));
        assert!(inside.advantage_of(&worse) < -1.5);
        assert!(inside.advantage_of(&own).abs() < 1e-9);
    }

    #[test]
    fn scatter_that_both_planes_share_does_not_count() {
        let common = |p: Point2<f64>| 0.3 * scatter(p);
        let own = map([0.0; 2], |p| 0.4 + common(p));
        let inside = InteriorWindows::new(&[facet()], &own);
        assert!(inside.advantage_of(&map([0.0; 2], |p| 0.5 + common(p))) > 10.0);
    }

    #[test]
    fn planes_without_a_window_in_common_cannot_be_compared() {
        let own = map([0.0; 2], |_| 0.2);
        let inside = InteriorWindows::new(&[facet()], &own);
        assert_eq!(inside.advantage_of(&map([90.0, 0.0], |_| 0.9)), 0.0);
        assert_eq!(inside.advantage_of(&map([-90.0, -60.0], |_| 0.9)), 0.0);
    }

    #[test]
    fn edges_do_not_speak_for_the_inside() {
        // Over the whole facet both would correlate by more than 0.5.
        assert!(with_edges(0.2).contradicts());
        assert!(!with_edges(0.6).contradicts());
        assert_eq!(with_edges(0.6).windows, 40 * 20);
    }

    #[test]
    fn what_agrees_by_chance_is_doubtful_and_what_agrees_is_neither() {
        let says = |inside: f32| {
            let sums = with_edges(inside);
            [
                sums.is_doubtful(),
                sums.is_by_chance(),
                sums.contradicts_overall(),
            ]
        };
        // Strong texture must correlate by 0.40 in the mean of all pairs.
        assert_eq!(says(0.55), [false; 3]);
        assert_eq!(says(0.45), [true, false, false]);
        assert_eq!(says(0.35), [true, true, false]);
        assert_eq!(says(0.2), [true; 3]);
    }

    #[test]
    fn a_strip_holds_a_window_when_it_is_as_wide() {
        assert!(windows(&[strip(1.15)]) > 0);
        assert!(windows(&[strip(1.05)]) == 0);
        assert!(windows(&[]) == 0);
    }

    #[test]
    fn a_strip_with_a_wide_place_is_narrow_all_the_same() {
        let (_, share) = windows_and_share(&[strip(1.2)]);
        assert!(share > 0.9, "{share}");
        let mut widened = strip(1.0);
        let place = [(7.0, 1.0), (7.0, 1.3), (5.5, 1.3), (5.5, 1.0)];
        widened.splice(3..3, place.map(|(x, y)| Point2::new(x + 3.0, y - 5.0)));
        let (windows, share) = windows_and_share(&[widened]);
        assert!(windows > 0 && (0.1..0.25).contains(&share), "{share}");
        assert_eq!(windows_and_share(&[]), (0, 0.0));
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
