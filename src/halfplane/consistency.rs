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

use super::box_sum::{HALF_WINDOW, box_sum};
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
    /// Centred; 0 where the view does not reach.
    gray: Vec<f32>,
    mean: Vec<f32>,
    /// [`UNSEEN`] where the view does not reach all of the window.
    variance: Vec<f32>,
    /// 1 / standard deviation; NaN where the view does not reach all of the window.
    inverse_deviation: Vec<f32>,
}

/// Cells of a window.
const FULL: f32 = ((2 * HALF_WINDOW + 1) * (2 * HALF_WINDOW + 1)) as f32;
/// Least variance that is not the rounding of a constant.
const LEAST_VARIANCE: f32 = 1e-7;

impl ViewWindows {
    fn new(mut gray: Vec<f32>, grid: &PlanGrid) -> Self {
        let inside: Vec<f32> = gray
            .iter()
            .map(|g| if g.is_nan() { 0.0 } else { 1.0 })
            .collect();
        let count = box_sum(&inside, grid);
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
        let mean: Vec<f32> = box_sum(&gray, grid).iter().map(|s| s / FULL).collect();
        let squares: Vec<f32> = gray.iter().map(|g| g * g).collect();
        let mut variance = box_sum(&squares, grid);
        for ((v, m), c) in variance.iter_mut().zip(&mean).zip(&count) {
            let is_whole = *c > FULL - 0.5;
            *v = if is_whole {
                (*v / FULL - m * m).max(0.0)
            } else {
                UNSEEN
            };
        }
        let inverse = |v: &f32| {
            if *v > UNSEEN {
                1.0 / v.max(LEAST_VARIANCE).sqrt()
            } else {
                f32::NAN
            }
        };
        Self {
            inverse_deviation: variance.iter().map(inverse).collect(),
            gray,
            mean,
            variance,
        }
    }
}

/// Variance by which the grey values of the views differ at random.
fn unlike(scene: &Scene, views: &[ViewId]) -> f32 {
    let sum: f64 = views.iter().map(|v| scene.view(*v).noise).sum();
    let noise = UNLIKE * sum / views.len().max(1) as f64;
    (noise * noise) as f32
}

/// Correlation of two views at every cell; [`UNSEEN`] where one of them does not see all of the window.
fn correlations(a: &ViewWindows, b: &ViewWindows, grid: &PlanGrid) -> Vec<f32> {
    let product: Vec<f32> = a.gray.iter().zip(&b.gray).map(|(x, y)| x * y).collect();
    let mut out = box_sum(&product, grid);
    let means = a.mean.iter().zip(&b.mean);
    let inverses = a.inverse_deviation.iter().zip(&b.inverse_deviation);
    for ((c, (mean_a, mean_b)), (by_a, by_b)) in out.iter_mut().zip(means).zip(inverses) {
        let r = (*c / FULL - mean_a * mean_b) * (by_a * by_b);
        *c = if r.is_nan() {
            UNSEEN
        } else {
            r.clamp(-1.0, 1.0)
        };
    }
    out
}

fn combine(windows: &[ViewWindows], unlike: f32, grid: &PlanGrid) -> ConsistencyMap {
    let cells = grid.width * grid.height;
    let pairs: Vec<Vec<f32>> = (windows.iter().enumerate())
        .flat_map(|(i, a)| windows[i + 1..].iter().map(move |b| (a, b)))
        .map(|(a, b)| correlations(a, b, grid))
        .collect();
    let pairs: Vec<&[f32]> = pairs.iter().map(Vec::as_slice).collect();
    let variances: Vec<&[f32]> = windows.iter().map(|w| w.variance.as_slice()).collect();
    let mut map = ConsistencyMap {
        grid: *grid,
        correlation: vec![0; cells],
        weight: vec![0; cells],
        common_weight: vec![0; cells],
    };
    for start in (0..cells).step_by(LANES) {
        let (mean, seen) = better_half(&pairs, start);
        let (variance, median) = texture(&variances, start);
        let [mean, seen, variance, median] = [
            mean,
            seen,
            weight_of(variance, unlike),
            weight_of(median, unlike),
        ]
        .map(|x| x.to_array());
        for (lane, k) in (start..cells.min(start + LANES)).enumerate() {
            if seen[lane] > 0.0 {
                map.correlation[k] = (mean[lane] * 127.0).round() as i8;
                map.weight[k] = variance[lane] as u8;
                map.common_weight[k] = median[lane] as u8;
            }
        }
    }
    map
}

/// Weights of windows with these variances, in steps; 0 is kept for what is not seen at all.
fn weight_of(variance: f32x8, unlike: f32) -> f32x8 {
    let weight = variance / (variance + f32x8::splat(unlike));
    (weight * f32x8::splat(255.0)).round().fast_max(f32x8::ONE)
}

/// Cells that are looked at at once.
const LANES: usize = 8;
/// Pairs of [`MAX_VIEWS`] views.
const MAX_PAIRS: usize = MAX_VIEWS * (MAX_VIEWS - 1) / 2;
/// In place of a correlation or a variance, and below all of them: not seen.
const UNSEEN: f32 = -4.0;

/// The values of each row at the cells from `start`; [`UNSEEN`] behind the last cell.
fn columns<const N: usize>(rows: &[&[f32]], start: usize) -> [f32x8; N] {
    let mut columns = [f32x8::splat(UNSEEN); N];
    for (column, row) in columns.iter_mut().zip(rows) {
        let mut lanes = [UNSEEN; LANES];
        let values = &row[start..row.len().min(start + LANES)];
        lanes[..values.len()].copy_from_slice(values);
        *column = f32x8::from(lanes);
    }
    columns
}

/// Sum of the values that are seen, and their number.
fn sum_of_seen(columns: &[f32x8]) -> (f32x8, f32x8) {
    let zero = f32x8::ZERO;
    columns.iter().fold((zero, zero), |(sum, count), c| {
        let seen = c.simd_gt(f32x8::splat(UNSEEN));
        (
            sum + seen.select(*c, zero),
            count + seen.select(f32x8::ONE, zero),
        )
    })
}

/// Mean of the better half of the pairs' correlations, and the number of pairs that see the cell.
fn better_half(pairs: &[&[f32]], start: usize) -> (f32x8, f32x8) {
    let mut columns = columns::<MAX_PAIRS>(pairs, start);
    let columns = &mut columns[..pairs.len()];
    sort_descending(columns);
    let (_, seen) = sum_of_seen(columns);
    let better = ((seen + f32x8::ONE) * f32x8::splat(0.5)).floor();
    let sum = columns
        .iter()
        .enumerate()
        .fold(f32x8::ZERO, |sum, (place, c)| {
            let counts = f32x8::splat(place as f32).simd_lt(better);
            sum + counts.select(*c, f32x8::ZERO)
        });
    (sum / better.fast_max(f32x8::ONE), seen)
}

/// Mean and lower median of the variances of the windows that see a cell.
fn texture(variances: &[&[f32]], start: usize) -> (f32x8, f32x8) {
    let mut columns = columns::<MAX_VIEWS>(variances, start);
    let columns = &mut columns[..variances.len()];
    let (sum, seen) = sum_of_seen(columns);
    sort_descending(columns);
    let place = (seen * f32x8::splat(0.5)).floor();
    let median = columns
        .iter()
        .enumerate()
        .fold(f32x8::ZERO, |found, (i, c)| {
            f32x8::splat(i as f32).simd_eq(place).select(*c, found)
        });
    (sum / seen.fast_max(f32x8::ONE), median)
}

/// Sorts every lane without branches: merge exchange (Batcher; Knuth 5.2.2 M).
fn sort_descending(columns: &mut [f32x8]) {
    let n = columns.len();
    let largest = n.next_power_of_two() / 2;
    let mut p = largest;
    while p > 0 {
        let (mut q, mut r, mut d) = (largest, 0, p);
        loop {
            for i in (0..n.saturating_sub(d)).filter(|i| i & p == r) {
                let (a, b) = (columns[i], columns[i + d]);
                (columns[i], columns[i + d]) = (a.fast_max(b), a.fast_min(b));
            }
            if q == p {
                break;
            }
            (d, q, r) = (q - p, q / 2, p);
        }
        p /= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn less_is_asked_of_weak_texture() {
        assert_eq!(least_correlation(1.0, 0.45), 0.45);
        assert_eq!(least_correlation(0.0, 0.45), CHANCE);
        assert!(least_correlation(0.3, 0.45) < least_correlation(0.6, 0.45));
    }

    #[test]
    fn every_number_of_columns_is_sorted() {
        for n in 0..=MAX_PAIRS {
            // All lanes differ; multiples of a prime give every order of the residues.
            let mut columns: Vec<f32x8> = (0..n)
                .map(|i| f32x8::from(std::array::from_fn(|lane| ((i * (lane + 2)) % 17) as f32)))
                .collect();
            sort_descending(&mut columns);
            for pair in columns.windows(2) {
                let (a, b) = (pair[0].to_array(), pair[1].to_array());
                assert!((0..8).all(|lane| a[lane] >= b[lane]), "{n} columns");
            }
        }
    }

    #[test]
    fn the_better_half_and_the_median_are_of_what_is_seen() {
        let rows = [
            [0.5, UNSEEN],
            [0.9, UNSEEN],
            [UNSEEN, UNSEEN],
            [0.1, UNSEEN],
        ];
        let rows = rows.each_ref().map(|r| r.as_slice());
        let (mean, seen) = better_half(&rows, 0);
        assert_eq!(
            (mean.to_array()[0], seen.to_array()[0]),
            ((0.9 + 0.5) / 2.0, 3.0)
        );
        assert_eq!(seen.to_array()[1..], [0.0; 7]);
        let (mean, median) = texture(&rows, 0);
        assert_eq!(
            (mean.to_array()[0], median.to_array()[0]),
            ((0.5 + 0.9 + 0.1) / 3.0, 0.5)
        );
        let (_, median) = texture(&rows[..2], 0);
        assert_eq!(median.to_array()[0], 0.5, "the lower one of two");
    }
}
