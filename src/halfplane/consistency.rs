//! Intensity similarity of a plane over the complete image set (B99 4.3, verification).
//!
//! B99 verifies a delineated face "by assessing intensity similarity over the complete image set, at
//! corresponding points within the projected delineation". Here every view is warped to the plan by
//! the plane under test, once; centred normalised cross-correlations of small windows over all pairs
//! of views follow from running sums. Two deviations, both against failure on real roofs:
//!
//! * Occlusion: at each plan position only the better half of the pairs counts, so one or two views in which
//!   something stands in front do not condemn a plane.
//! * Weak texture: where the grey values vary no more than the noise, correlation says nothing for or
//!   against; each position carries the weight `s^2 / (s^2 + n^2)` with s the standard deviation
//!   within the window and n that of the noise. It is also about what the views of a true plane correlate
//!   by more than chance, so that as little is asked of them ([`least_correlation`]).

use nalgebra::Point3;
use serde::{Deserialize, Serialize};
use wide::f32x8;

use super::plan::{PlanGrid, orthophoto};
use crate::camera::Camera;
use crate::geometry::Plane;
use crate::ids::ViewId;
use crate::scene::Scene;

/// How well the views agree on a plane, at every cell of a plan grid.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ConsistencyMap {
    /// The window of the plan.
    pub grid: PlanGrid,
    /// Correlation in steps of 1 / 127. A scene has hundreds of maps: a byte a value keeps them small.
    correlation: Vec<i8>,
    /// Weight in steps of 1 / 255.
    weight: Vec<u8>,
    /// The same from the median of the views instead of their mean.
    common_weight: Vec<u8>,
}

impl ConsistencyMap {
    /// Mean of the better half of the pairwise correlations at cell `k` (row by row), -1 to 1; 0 where
    /// the weight is 0.
    pub fn correlation(&self, k: usize) -> f32 {
        f32::from(self.correlation[k]) / 127.0
    }

    /// How much the texture at cell `k` can tell, 0 to 1; 0 where fewer than two views see the window.
    pub fn weight(&self, k: usize) -> f32 {
        f32::from(self.weight[k]) / 255.0
    }

    /// The same for the texture that most views show: what hides the cell in some of them has no say.
    pub fn common_weight(&self, k: usize) -> f32 {
        f32::from(self.common_weight[k]) / 255.0
    }
}

/// What windows that hardly have anything in common correlate by, in the better half of the pairs. Measured: 0.2 to 0.4 on
/// planes a metre beside the true ones.
const CHANCE: f64 = 0.3;

/// Correlation at which a plane is as good as no plane, for a texture `weight`: `textured` where the texture
/// is strong, chance where there is none.
pub fn least_correlation(weight: f64, textured: f64) -> f64 {
    CHANCE + (textured - CHANCE) * weight
}

/// What keeps two views of one surface from being alike, against the noise of a pixel: besides the noise, the sampling and
/// the shading. Measured on true planes.
const UNLIKE: f64 = 1.25;
/// Half the window side in cells: 11 x 11, a little smaller than the paper's 15 x 15, since its
/// windows lie along lines and these must not reach far over the borders of small facets.
const HALF_WINDOW: usize = 5;
/// Most views compared: pairs grow with the square and six views saturate the measure.
const MAX_VIEWS: usize = 6;

/// Compares all views on `plane` over `grid`.
pub fn consistency_map(scene: &Scene, plane: &Plane, grid: &PlanGrid) -> ConsistencyMap {
    let views = views_of_plane(scene, plane, grid);
    let photo = |&v: &ViewId| orthophoto(&scene.view(v).gray, scene.camera(v), plane, grid);
    let windows = views.iter().map(|v| ViewWindows::new(photo(v), grid));
    combine(&windows.collect::<Vec<_>>(), unlike(scene, &views), grid)
}

/// The same where something known stands in front of the plane: `hidden` says whether a view sees a point of it.
pub fn consistency_map_behind(
    scene: &Scene,
    plane: &Plane,
    grid: &PlanGrid,
    hidden: impl Fn(ViewId, &Point3<f64>) -> bool,
) -> ConsistencyMap {
    let views = views_of_plane(scene, plane, grid);
    let photo = |&v: &ViewId| {
        let mut photo = orthophoto(&scene.view(v).gray, scene.camera(v), plane, grid);
        for (k, gray) in photo.iter_mut().enumerate() {
            let at = grid.center(k % grid.width, k / grid.width);
            if hidden(v, &plane.lift(at.x, at.y)) {
                *gray = f32::NAN;
            }
        }
        photo
    };
    let windows = views.iter().map(|v| ViewWindows::new(photo(v), grid));
    combine(&windows.collect::<Vec<_>>(), unlike(scene, &views), grid)
}

/// Positions along each side of the window at which views are asked whether they see it.
const SAMPLES: usize = 6;

/// The views to compare: at most [`MAX_VIEWS`], such that every part of the window is seen by as many as
/// possible, frontal ones first. Crops of large photographs often show a part only.
fn views_of_plane(scene: &Scene, plane: &Plane, grid: &PlanGrid) -> Vec<ViewId> {
    let candidates: Vec<Candidate> = (scene.view_ids())
        .filter_map(|v| Candidate::new(v, scene.camera(v), plane, grid))
        .collect();
    let mut seen_by = [0u32; SAMPLES * SAMPLES];
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < MAX_VIEWS {
        let best = (0..candidates.len())
            .filter(|i| !chosen.contains(i))
            .map(|i| (candidates[i].gain(&seen_by), i))
            .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let Some((_, best)) = best else { break };
        let sees = candidates[best].sees.iter();
        (seen_by.iter_mut().zip(sees)).for_each(|(n, sees)| *n += u32::from(*sees));
        chosen.push(best);
    }
    chosen.into_iter().map(|i| candidates[i].view).collect()
}

/// A view that sees some of the window.
struct Candidate {
    view: ViewId,
    /// Cosine of the angle between the plane's normal and the direction to the camera.
    toward: f64,
    sees: [bool; SAMPLES * SAMPLES],
}

impl Candidate {
    fn new(view: ViewId, camera: &Camera, plane: &Plane, grid: &PlanGrid) -> Option<Self> {
        let at = |fx: f64, fy: f64| {
            let (x, y) = (fx * grid.width as f64, fy * grid.height as f64);
            plane.lift(grid.origin.x + x * grid.step, grid.origin.y + y * grid.step)
        };
        let middle = at(0.5, 0.5);
        let toward = (camera.center - middle).normalize().dot(&plane.normal);
        let sees = std::array::from_fn(|k| {
            let part = |i: usize| (i as f64 + 0.5) / SAMPLES as f64;
            let p = at(part(k % SAMPLES), part(k / SAMPLES));
            (camera.project(&p)).is_some_and(|x| camera.contains(&x, 1.0))
        });
        // A plane seen at a grazing angle (below 15 degrees) has no usable pixels.
        (toward > 0.26 && sees.contains(&true)).then_some(Self { view, toward, sees })
    }

    /// What the view adds: less where others see the position already.
    fn gain(&self, seen_by: &[u32]) -> f64 {
        let seen = seen_by.iter().zip(&self.sees).filter(|(_, sees)| **sees);
        self.toward * seen.map(|(n, _)| 1.0 / f64::from(1 + n * n)).sum::<f64>()
    }
}

/// One view on the grid with the mean and the variance of the window around every cell.
struct ViewWindows {
    gray: Vec<f32>,
    mean: Vec<f32>,
    variance: Vec<f32>,
    valid: Vec<bool>,
}

impl ViewWindows {
    fn new(mut gray: Vec<f32>, grid: &PlanGrid) -> Self {
        let inside: Vec<f32> = gray
            .iter()
            .map(|g| if g.is_nan() { 0.0 } else { 1.0 })
            .collect();
        let count = box_sum(&inside, grid);
        let full = ((2 * HALF_WINDOW + 1) * (2 * HALF_WINDOW + 1)) as f32;
        let valid: Vec<bool> = count.iter().map(|&c| c > full - 0.5).collect();
        // Centring keeps the running sums of squares small.
        let (sum, n) = gray
            .iter()
            .filter(|g| !g.is_nan())
            .fold((0.0f64, 0u32), |(s, n), &g| (s + f64::from(g), n + 1));
        let center = if n > 0 {
            (sum / f64::from(n)) as f32
        } else {
            0.0
        };
        gray.iter_mut()
            .for_each(|g| *g = if g.is_nan() { 0.0 } else { *g - center });
        let mean: Vec<f32> = box_sum(&gray, grid).iter().map(|s| s / full).collect();
        let squares: Vec<f32> = gray.iter().map(|g| g * g).collect();
        let variance = box_sum(&squares, grid)
            .iter()
            .zip(&mean)
            .map(|(s, m)| (s / full - m * m).max(0.0))
            .collect();
        Self {
            gray,
            mean,
            variance,
            valid,
        }
    }
}

/// Variance by which the grey values of the views differ at random.
fn unlike(scene: &Scene, views: &[ViewId]) -> f32 {
    let sum: f64 = views.iter().map(|v| scene.view(*v).noise).sum();
    let noise = UNLIKE * sum / views.len().max(1) as f64;
    (noise * noise) as f32
}

fn combine(windows: &[ViewWindows], unlike: f32, grid: &PlanGrid) -> ConsistencyMap {
    let cells = grid.width * grid.height;
    let full = ((2 * HALF_WINDOW + 1) * (2 * HALF_WINDOW + 1)) as f32;
    let mut pairs: Vec<Vec<f32>> = Vec::new();
    for (i, a) in windows.iter().enumerate() {
        for b in &windows[i + 1..] {
            let product: Vec<f32> = a.gray.iter().zip(&b.gray).map(|(x, y)| x * y).collect();
            let mut correlation = box_sum(&product, grid);
            for (k, c) in correlation.iter_mut().enumerate() {
                *c = if a.valid[k] && b.valid[k] {
                    let covariance = *c / full - a.mean[k] * b.mean[k];
                    (covariance / (a.variance[k] * b.variance[k]).sqrt().max(1e-7)).clamp(-1.0, 1.0)
                } else {
                    UNSEEN
                };
            }
            pairs.push(correlation);
        }
    }
    let mut map = ConsistencyMap {
        grid: *grid,
        correlation: vec![0; cells],
        weight: vec![0; cells],
        common_weight: vec![0; cells],
    };
    for start in (0..cells).step_by(LANES) {
        let means = better_half_means(&pairs, start, cells);
        for k in start..cells.min(start + LANES) {
            let Some(mean) = means[k - start] else {
                continue;
            };
            let (sum, seen) = (windows.iter().filter(|w| w.valid[k]))
                .fold((0.0f32, 0.0f32), |(s, n), w| (s + w.variance[k], n + 1.0));
            map.correlation[k] = (mean * 127.0).round().clamp(-127.0, 127.0) as i8;
            map.weight[k] = weight_of(sum / seen, unlike);
            map.common_weight[k] = weight_of(median_variance(windows, k), unlike);
        }
    }
    map
}

/// Weight of a window with this variance, in steps; 0 is kept for what is not seen at all.
fn weight_of(variance: f32, unlike: f32) -> u8 {
    let weight = variance / (variance + unlike);
    (weight * 255.0).round().max(1.0) as u8
}

/// The lower median of the variances of the windows that see a cell.
fn median_variance(windows: &[ViewWindows], k: usize) -> f32 {
    let mut seen = [0.0f32; MAX_VIEWS];
    let mut count = 0;
    for w in windows.iter().filter(|w| w.valid[k]) {
        // Kept in order: six at most.
        let mut at = count;
        while at > 0 && seen[at - 1] > w.variance[k] {
            seen[at] = seen[at - 1];
            at -= 1;
        }
        seen[at] = w.variance[k];
        count += 1;
    }
    seen[count.saturating_sub(1) / 2]
}

/// Cells that are sorted at once.
const LANES: usize = 8;
/// Pairs of [`MAX_VIEWS`] views.
const MAX_PAIRS: usize = MAX_VIEWS * (MAX_VIEWS - 1) / 2;
/// Below any correlation: the pair does not see the cell.
const UNSEEN: f32 = -4.0;

/// Mean of the better half of the pairs' correlations at the cells from `start`; `None` where no pair sees
/// the cell.
fn better_half_means(pairs: &[Vec<f32>], start: usize, cells: usize) -> [Option<f32>; LANES] {
    let end = cells.min(start + LANES);
    let mut columns = [f32x8::splat(UNSEEN); MAX_PAIRS];
    for (column, pair) in columns.iter_mut().zip(pairs) {
        let mut lanes = [UNSEEN; LANES];
        lanes[..end - start].copy_from_slice(&pair[start..end]);
        *column = f32x8::from(lanes);
    }
    let columns = &mut columns[..pairs.len()];
    sort_descending(columns);
    let sorted: Vec<[f32; LANES]> = columns.iter().map(|c| c.to_array()).collect();
    std::array::from_fn(|lane| {
        let seen = sorted.iter().filter(|c| c[lane] > UNSEEN).count();
        let better = seen.div_ceil(2);
        let sum: f32 = sorted[..better].iter().map(|c| c[lane]).sum();
        (seen > 0).then(|| sum / better as f32)
    })
}

/// Sorts every lane by comparisons of neighbours (a network of odd and even transpositions): no branches.
fn sort_descending(columns: &mut [f32x8]) {
    for round in 0..columns.len() {
        for pair in columns[round % 2..].chunks_exact_mut(2) {
            let (a, b) = (pair[0], pair[1]);
            (pair[0], pair[1]) = (a.fast_max(b), a.fast_min(b));
        }
    }
}

/// Sum over the window around every cell, along rows and then along columns; windows that stick out of the
/// grid are cut off.
fn box_sum(values: &[f32], grid: &PlanGrid) -> Vec<f32> {
    let (w, h, r) = (grid.width, grid.height, HALF_WINDOW);
    let mut rows = vec![0.0f32; w * h];
    let mut line = RowSum::new(w);
    for y in 0..h {
        line.sum(&values[y * w..(y + 1) * w], &mut rows[y * w..(y + 1) * w]);
    }
    let mut out = vec![0.0f32; w * h];
    let mut sums = vec![0.0f32; w];
    for y in 0..r.min(h) {
        for (s, v) in sums.iter_mut().zip(&rows[y * w..(y + 1) * w]) {
            *s += v;
        }
    }
    for y in 0..h {
        if y + r < h {
            for (s, v) in sums.iter_mut().zip(&rows[(y + r) * w..(y + r + 1) * w]) {
                *s += v;
            }
        }
        if y > r {
            for (s, v) in sums.iter_mut().zip(&rows[(y - r - 1) * w..(y - r) * w]) {
                *s -= v;
            }
        }
        out[y * w..(y + 1) * w].copy_from_slice(&sums);
    }
    out
}

/// Sums of 11 neighbours in a row, by doubling: 2, 4, 8, 8 + 2 + 1. No sum waits for the one before it,
/// so the compiler adds many at once.
struct RowSum {
    padded: Vec<f32>,
    two: Vec<f32>,
    four: Vec<f32>,
}

impl RowSum {
    fn new(width: usize) -> Self {
        let n = width + 2 * HALF_WINDOW;
        Self {
            padded: vec![0.0; n],
            two: vec![0.0; n],
            four: vec![0.0; n],
        }
    }

    fn sum(&mut self, row: &[f32], out: &mut [f32]) {
        const { assert!(2 * HALF_WINDOW + 1 == 8 + 2 + 1) };
        let (w, n) = (row.len(), self.padded.len());
        self.padded[HALF_WINDOW..HALF_WINDOW + w].copy_from_slice(row);
        let p = &self.padded[..n];
        for ((t, a), b) in self.two[..n - 1].iter_mut().zip(p).zip(&p[1..]) {
            *t = a + b;
        }
        for ((f, a), b) in self.four[..n - 3]
            .iter_mut()
            .zip(&self.two)
            .zip(&self.two[2..])
        {
            *f = a + b;
        }
        let (four, two) = (&self.four, &self.two);
        for (x, o) in out.iter_mut().enumerate() {
            *o = (four[x] + four[x + 4]) + (two[x + 8] + p[x + 10]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn less_is_asked_of_weak_texture() {
        assert_eq!(least_correlation(1.0, 0.45), 0.45);
        assert_eq!(least_correlation(0.0, 0.45), CHANCE);
        assert!(least_correlation(0.3, 0.45) < least_correlation(0.6, 0.45));
    }

    #[test]
    fn box_sum_agrees_with_direct_sums() {
        let grid = PlanGrid {
            origin: Point2::origin(),
            step: 1.0,
            width: 17,
            height: 14,
        };
        let values: Vec<f32> = (0..17 * 14).map(|i| ((i * 37) % 11) as f32).collect();
        let sums = box_sum(&values, &grid);
        for (x, y) in [(0, 0), (5, 5), (8, 7), (16, 13), (3, 12)] {
            let mut direct = 0.0;
            for v in y.max(HALF_WINDOW) - HALF_WINDOW..=(y + HALF_WINDOW).min(13) {
                for u in x.max(HALF_WINDOW) - HALF_WINDOW..=(x + HALF_WINDOW).min(16) {
                    direct += values[v * 17 + u];
                }
            }
            assert!((sums[y * 17 + x] - direct).abs() < 1e-3, "at {x}, {y}");
        }
    }
}
