//! Correlations of several views of a plane over the window around every cell (B99 4.3,
//! verification).
//!
//! All running sums advance together, row by row: what a row needs of six views and their fifteen
//! pairs stays near the processor, whatever the size of the grid.

use wide::f32x8;

use super::box_sum::{BoxSum, HALF_WINDOW, RowSum, WINDOW_CELLS};
use super::consistency_map::{ConsistencyMap, MAX_VIEWS};
use super::plan_grid::{CELL_SAMPLES, PlanGrid, SampledCells};
use crate::base::math::larger;

/// Compares orthophotos on `grid`, at most [`MAX_VIEWS`]; `residual_variance` is the variance by
/// which the grey values of the views differ at random.
pub(super) fn correlate_views(
    photos: impl Iterator<Item = SampledCells>,
    residual_variance: f32,
    grid: &PlanGrid,
) -> ConsistencyMap {
    let mut map = ConsistencyMap::unseen(grid);
    let mut views: Vec<ViewWindows> = photos.map(|p| ViewWindows::new(p, grid)).collect();
    let pairs = (0..views.len()).flat_map(|a| (a + 1..views.len()).map(move |b| [a, b]));
    let mut pairs: Vec<PairWindows> = pairs.map(|of| PairWindows::new(of, grid)).collect();
    let best = Ranking::new(pairs.len());
    let middle = Ranking::new(views.len());
    let mut line = RowSum::new(grid.width);
    for y in 0..grid.height {
        for view in &mut views {
            view.next_row(y, &mut line, grid);
        }
        for pair in &mut pairs {
            pair.next_row(&views, &mut line);
        }
        let correlations: Vec<&[f32]> = pairs.iter().map(|p| p.row.as_slice()).collect();
        let variances: Vec<&[f32]> = views.iter().map(|v| v.variance.as_slice()).collect();
        for start in (0..grid.width).step_by(LANES) {
            let [better, seen] = best.agreement(&correlations, start);
            let (variance, median) = middle.texture(&variances, start);
            let [better, seen, variance, median] = [
                (better * f32x8::splat(127.0)).round(),
                seen,
                weight_of(variance, residual_variance),
                weight_of(median, residual_variance),
            ]
            .map(|x| x.to_array());
            for (lane, x) in (start..grid.width.min(start + LANES)).enumerate() {
                if seen[lane] > 0.0 {
                    let k = y * grid.width + x;
                    map.correlation[k] = better[lane] as i8;
                    map.weight[k] = variance[lane] as u8;
                    map.common_weight[k] = median[lane] as u8;
                }
            }
        }
    }
    map
}

/// Least variance that is not the rounding of a constant.
pub(crate) const LEAST_VARIANCE: f32 = 1e-7;
/// Samples of a window.
const WINDOW_SAMPLES: f32 = WINDOW_CELLS * SAMPLES as f32;
/// Samples of a cell.
const SAMPLES: usize = CELL_SAMPLES * CELL_SAMPLES;
/// Cells per SIMD register.
const LANES: usize = 8;
/// Pairs of [`MAX_VIEWS`] views.
const MAX_PAIRS: usize = MAX_VIEWS * (MAX_VIEWS - 1) / 2;
/// Marks a correlation or variance as not seen; below every real value.
const UNSEEN: f32 = -4.0;

/// A row of unseen values, padded to whole registers.
fn unseen_row(grid: &PlanGrid) -> Vec<f32> {
    vec![UNSEEN; grid.width.next_multiple_of(LANES)]
}

/// One view on the grid, with the mean and the variance of the windows around the cells of a row.
struct ViewWindows {
    width: usize,
    /// Centred; 0 where the view does not reach.
    gray: SampledCells,
    /// Where the view reaches, when that is not everywhere.
    reach: Option<Reach>,
    sum: BoxSum,
    squares: BoxSum,
    mean: Vec<f32>,
    /// [`UNSEEN`] where the view does not reach all of the window.
    variance: Vec<f32>,
    /// 1 / standard deviation; NaN where the view does not reach all of the window.
    inverse_deviation: Vec<f32>,
}

/// Which cells a view reaches, and how many in the windows of a row.
struct Reach {
    /// 1 where it reaches all samples of the cell, 0 elsewhere.
    inside: Vec<f32>,
    count: BoxSum,
}

impl ViewWindows {
    fn new(mut gray: SampledCells, grid: &PlanGrid) -> Self {
        let cells = grid.width * grid.height;
        let is_cut = |samples: &Vec<f32>| samples.iter().fold(false, |cut, g| cut | g.is_nan());
        // Centring keeps the running sums of squares small.
        let center = mean_of_seen(&gray[0]);
        let reach = gray.iter().any(is_cut).then(|| Reach {
            inside: (0..cells)
                .map(|k| f32::from(u8::from(gray.iter().all(|g| !g[k].is_nan()))))
                .collect(),
            count: BoxSum::new(grid),
        });
        (gray.iter_mut().flatten()).for_each(|g| *g = if g.is_nan() { 0.0 } else { *g - center });
        Self {
            width: grid.width,
            gray,
            reach,
            sum: BoxSum::new(grid),
            squares: BoxSum::new(grid),
            mean: vec![0.0; grid.width],
            variance: unseen_row(grid),
            inverse_deviation: vec![f32::NAN; grid.width],
        }
    }

    /// The samples of a row of cells.
    fn row(&self, y: usize) -> [&[f32]; SAMPLES] {
        row_of(&self.gray, y, self.width)
    }

    /// Goes on to row `y`, the next one.
    fn next_row(&mut self, y: usize, line: &mut RowSum, grid: &PlanGrid) {
        let (w, gray) = (self.width, &self.gray);
        let sums = (self.sum).next_row(line, |y, out| {
            let [a, b, c, d] = row_of(gray, y, w);
            for ((((o, a), b), c), d) in out.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                *o = (a + b) + (c + d);
            }
        });
        for (mean, sum) in self.mean.iter_mut().zip(sums) {
            *mean = sum / WINDOW_SAMPLES;
        }
        let squares = self.squares.next_row(line, |y, out| {
            let row = row_of(gray, y, w);
            products(row, row, out);
        });
        for ((v, sum), m) in self.variance.iter_mut().zip(squares).zip(&self.mean) {
            *v = larger(sum / WINDOW_SAMPLES - m * m, 0.0);
        }
        if let Some(reach) = &mut self.reach {
            let inside = &reach.inside;
            let count = (reach.count).next_row(line, |y, out| {
                out.copy_from_slice(&inside[y * w..(y + 1) * w]);
            });
            for (v, count) in self.variance.iter_mut().zip(count) {
                *v = if *count > WINDOW_CELLS - 0.5 {
                    *v
                } else {
                    UNSEEN
                };
            }
        } else if y < HALF_WINDOW || y + HALF_WINDOW >= grid.height || w <= 2 * HALF_WINDOW {
            self.variance.fill(UNSEEN);
        } else {
            self.variance[..HALF_WINDOW].fill(UNSEEN);
            self.variance[w - HALF_WINDOW..w].fill(UNSEEN);
        }
        for (inverse, v) in self.inverse_deviation.iter_mut().zip(&self.variance) {
            let known = 1.0 / larger(*v, LEAST_VARIANCE).sqrt();
            *inverse = if *v > UNSEEN { known } else { f32::NAN };
        }
    }
}

/// Mean of the values that are numbers; 0 without any.
fn mean_of_seen(values: &[f32]) -> f32 {
    let (mut sums, mut seen) = ([0.0f64; LANES], [0u32; LANES]);
    for values in values.chunks(LANES) {
        for ((sum, seen), v) in sums.iter_mut().zip(&mut seen).zip(values) {
            let number = !v.is_nan();
            *sum += if number { f64::from(*v) } else { 0.0 };
            *seen += u32::from(number);
        }
    }
    let seen = seen.iter().sum::<u32>().max(1);
    (sums.iter().sum::<f64>() / f64::from(seen)) as f32
}

/// The samples of a row of cells, each `width` wide.
fn row_of(gray: &SampledCells, y: usize, width: usize) -> [&[f32]; SAMPLES] {
    gray.each_ref().map(|g| &g[y * width..(y + 1) * width])
}

/// For every cell of a row the sum of the products of two views' samples.
// One copy of the code for views and pairs.
#[inline(never)]
fn products(a: [&[f32]; SAMPLES], b: [&[f32]; SAMPLES], out: &mut [f32]) {
    let n = out.len();
    let ([a0, a1, a2, a3], [b0, b1, b2, b3]) = (a.map(|a| &a[..n]), b.map(|b| &b[..n]));
    for (k, o) in out.iter_mut().enumerate() {
        *o = (a0[k] * b0[k] + a1[k] * b1[k]) + (a2[k] * b2[k] + a3[k] * b3[k]);
    }
}

/// Two views, with their correlation over the windows around the cells of a row.
struct PairWindows {
    of: [usize; 2],
    products: BoxSum,
    /// [`UNSEEN`] where one of them does not see all of the window.
    row: Vec<f32>,
}

impl PairWindows {
    fn new(of: [usize; 2], grid: &PlanGrid) -> Self {
        Self {
            of,
            products: BoxSum::new(grid),
            row: unseen_row(grid),
        }
    }

    /// Goes on to the row of the views.
    fn next_row(&mut self, views: &[ViewWindows], line: &mut RowSum) {
        let [a, b] = self.of.map(|v| &views[v]);
        let sums = (self.products).next_row(line, |y, out| products(a.row(y), b.row(y), out));
        let means = a.mean.iter().zip(&b.mean);
        let inverses = a.inverse_deviation.iter().zip(&b.inverse_deviation);
        let row = self.row.iter_mut().zip(sums);
        for (((c, sum), (mean_a, mean_b)), (by_a, by_b)) in row.zip(means).zip(inverses) {
            let r = (sum / WINDOW_SAMPLES - mean_a * mean_b) * (by_a * by_b);
            *c = if r.is_nan() {
                UNSEEN
            } else {
                r.clamp(-1.0, 1.0)
            };
        }
    }
}

/// Weights of windows with these variances, in steps; 0 is kept for what is not seen at all.
fn weight_of(variance: f32x8, residual_variance: f32) -> f32x8 {
    let weight = variance / (variance + f32x8::splat(residual_variance));
    (weight * f32x8::splat(255.0)).round().fast_max(f32x8::ONE)
}

/// Values of eight cells, one column a row; as many as pairs, and one more to make a power of two.
type Columns = [f32x8; MAX_PAIRS + 1];

/// The values of each row at the cells from `start`, a multiple of eight.
fn columns(rows: &[&[f32]], start: usize) -> Columns {
    let mut columns = [f32x8::splat(UNSEEN); MAX_PAIRS + 1];
    for (column, row) in columns.iter_mut().zip(rows) {
        let lanes: [f32; LANES] = (row[start..start + LANES].try_into()).expect("eight lanes");
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

/// Half of a whole number of zero or more, rounded down.
fn half(count: f32x8) -> f32x8 {
    (count * f32x8::splat(0.5)).fast_trunc_int().round_float()
}

/// Puts the larger half of some columns in order, lane by lane without branches.
struct Ranking {
    columns: usize,
    /// How many of the largest are put in order: half of them, and the middle.
    ranked: usize,
    /// The places that are compared and exchanged, one after the other.
    exchanges: Vec<[usize; 2]>,
}

impl Ranking {
    /// Merge exchange (Batcher; Knuth 5.2.2 M), without what only orders the smaller half.
    fn new(columns: usize) -> Self {
        let mut exchanges = Vec::new();
        let largest = columns.next_power_of_two() / 2;
        let mut p = largest;
        while p > 0 {
            let (mut q, mut r, mut d) = (largest, 0, p);
            loop {
                let first = (0..columns.saturating_sub(d)).filter(|i| i & p == r);
                exchanges.extend(first.map(|i| [i, i + d]));
                if q == p {
                    break;
                }
                (d, q, r) = (q - p, q / 2, p);
            }
            p /= 2;
        }
        let ranked = columns.min(columns / 2 + 1);
        let mut matters: Vec<bool> = (0..columns).map(|place| place < ranked).collect();
        let mut kept: Vec<[usize; 2]> = (exchanges.into_iter().rev())
            .filter(|&[i, j]| {
                let either = matters[i] || matters[j];
                (matters[i], matters[j]) = (either, either);
                either
            })
            .collect();
        kept.reverse();
        Self {
            columns,
            ranked,
            exchanges: kept,
        }
    }

    /// The largest values of every lane, in descending order; behind [`Self::ranked`] the others,
    /// in none.
    fn rank(&self, columns: &mut Columns) {
        for [i, j] in &self.exchanges {
            // The remainder changes nothing; the compiler sees that both are inside.
            let (i, j) = (i % (MAX_PAIRS + 1), j % (MAX_PAIRS + 1));
            let (a, b) = (columns[i], columns[j]);
            (columns[i], columns[j]) = (a.fast_max(b), a.fast_min(b));
        }
    }

    /// Mean of the better half of the pairs' correlations, and the number of pairs that see the
    /// cell.
    fn agreement(&self, pairs: &[&[f32]], start: usize) -> [f32x8; 2] {
        let mut columns = columns(pairs, start);
        let (_, seen) = sum_of_seen(&columns[..self.columns]);
        self.rank(&mut columns);
        let better = half(seen + f32x8::ONE);
        let ranked = columns[..self.ranked].iter().enumerate();
        let sum = ranked.fold(f32x8::ZERO, |sum, (place, c)| {
            let counts = f32x8::splat(place as f32).simd_lt(better);
            sum + counts.select(*c, f32x8::ZERO)
        });
        [sum / better.fast_max(f32x8::ONE), seen]
    }

    /// Mean and lower median of the variances of the windows that see a cell.
    fn texture(&self, variances: &[&[f32]], start: usize) -> (f32x8, f32x8) {
        let mut columns = columns(variances, start);
        let (sum, seen) = sum_of_seen(&columns[..self.columns]);
        self.rank(&mut columns);
        let place = half(seen);
        let ranked = columns[..self.ranked].iter().enumerate();
        let median = ranked.fold(f32x8::ZERO, |found, (i, c)| {
            f32x8::splat(i as f32).simd_eq(place).select(*c, found)
        });
        (sum / seen.fast_max(f32x8::ONE), median)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn the_larger_half_of_every_number_of_columns_is_sorted() {
        for n in 0..=MAX_PAIRS {
            // All lanes differ; multiples of a prime give every order of the residues.
            let value = |i: usize, lane: usize| ((i * (lane + 2)) % 17) as f32;
            let mut columns = [f32x8::splat(UNSEEN); MAX_PAIRS + 1];
            for (i, column) in columns[..n].iter_mut().enumerate() {
                *column = f32x8::from(std::array::from_fn(|lane| value(i, lane)));
            }
            let ranking = Ranking::new(n);
            ranking.rank(&mut columns);
            for lane in 0..8 {
                let mut sorted: Vec<f32> = (0..n).map(|i| value(i, lane)).collect();
                sorted.sort_by(|a, b| b.total_cmp(a));
                for (place, value) in sorted[..ranking.ranked].iter().enumerate() {
                    assert_eq!(columns[place].to_array()[lane], *value, "{n} columns");
                }
            }
        }
    }

    #[test]
    fn the_better_half_and_the_median_are_of_what_is_seen() {
        let row = |value: f32| {
            let mut row = [UNSEEN; LANES];
            row[0] = value;
            row
        };
        let rows = [0.5, 0.9, UNSEEN, 0.1].map(row);
        let rows = rows.each_ref().map(|r| r.as_slice());
        let [better, seen] = Ranking::new(4).agreement(&rows, 0);
        assert_eq!(
            [better, seen].map(|x| x.to_array()[0]),
            [(0.9 + 0.5) / 2.0, 3.0]
        );
        assert_eq!(seen.to_array()[1..], [0.0; 7]);
        let (mean, median) = Ranking::new(4).texture(&rows, 0);
        assert_eq!(
            (mean.to_array()[0], median.to_array()[0]),
            ((0.5 + 0.9 + 0.1) / 3.0, 0.5)
        );
        let (_, median) = Ranking::new(2).texture(&rows[..2], 0);
        assert_eq!(median.to_array()[0], 0.5, "the lower one of two");
    }

    /// A reproducible grey value at a cell.
    fn noise(k: usize, seed: usize) -> f32 {
        ((k * 7919 + seed * 104_729).wrapping_mul(2_654_435_761) >> 9 & 255) as f32 / 255.0
    }

    #[test]
    fn alike_views_agree_where_both_reach_the_whole_window() {
        let grid = PlanGrid {
            origin: Point2::origin(),
            step: 0.1,
            width: 37,
            height: 30,
        };
        let samples = |seed: usize| -> SampledCells {
            std::array::from_fn(|at| (0..37 * 30).map(|k| noise(k, seed + at)).collect())
        };
        let (whole, other) = (samples(0), samples(5));
        // Of half the contrast, and only from column 12 on.
        let part = whole.each_ref().map(|samples| -> Vec<f32> {
            let of_column = |(k, v): (usize, &f32)| {
                if k % 37 >= 12 {
                    0.2 + 0.5 * v
                } else {
                    f32::NAN
                }
            };
            samples.iter().enumerate().map(of_column).collect()
        });
        let map = correlate_views([whole.clone(), part].into_iter(), 1e-4, &grid);
        for k in 0..37 * 30 {
            let (x, y) = (k % 37, k / 37);
            let seen = (14..35).contains(&x) && (2..28).contains(&y);
            assert_eq!(map.weight(k) > 0.0, seen, "at {x}, {y}");
            assert_eq!(map.correlation(k), if seen { 1.0 } else { 0.0 });
        }
        let map = correlate_views([whole, other].into_iter(), 1e-4, &grid);
        for k in 0..37 * 30 {
            let whole_window = (2..35).contains(&(k % 37)) && (2..28).contains(&(k / 37));
            assert_eq!(map.weight(k) > 0.9, whole_window, "cell {k}");
            assert!(map.correlation(k) < 0.5);
        }
    }
}
