//! Centred normalised cross-correlation `Cor` (B99 3.2, 4.1) of all windows of two patches by
//! running sums.
//!
//! Over the n pixels of a window, with a the reference and b the warped view, `Cor = (n Sab - Sa
//! Sb) / sqrt((n Saa - Sa^2) (n Sbb - Sb^2))`. Column sums over the height of the window slide down
//! the patch, one row in and one row out; a window is then the sum of 15 of them. The grey values
//! are whole numbers (see [`super::line_side_strip`]), so every sum is exact.
//!
//! Windows are cut at the border of the strip: B99 does not say what a window that crosses the line
//! does, but its pixels beyond the line belong to another surface and would pull the peak away.

use wide::bytemuck::cast;
use wide::{f32x4, f32x8};

use super::line_side_strip::StripPatch;

/// Least variance of a window, in units of (1/510)^2: half a unit of standard deviation. Below it
/// there is nothing but the rounding of the values.
const MIN_VARIANCE: f64 = 0.25;

/// Units of the patches in the range of grey values.
const UNITS: f64 = 510.0;

/// A window of the reference patch that is correlated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Site {
    /// Column of the centre.
    pub column: usize,
    /// Row of the centre.
    pub row: usize,
    /// Number of pixels.
    count: f64,
    /// `Sa`.
    sum: f64,
    /// `n Saa - Sa^2`.
    scatter: f64,
}

/// The reference patch with the windows that are correlated, and room for the running sums.
#[derive(Clone, Debug)]
pub(crate) struct CorrelationWindows {
    reference: StripPatch,
    half: usize,
    /// Ordered by row, then column.
    pub sites: Vec<Site>,
    columns: ColumnSums,
    /// Products of both scatters, whose roots divide the covariances of the sites.
    powers: Vec<f64>,
}

/// Sums over the rows of the window, one entry a column. `PADDING` zeros on either side stand for
/// the columns outside the strip.
#[derive(Clone, Debug, Default)]
struct ColumnSums {
    b: Vec<f32>,
    bb: Vec<f32>,
    ab: Vec<f32>,
}

/// Columns of zeros on either side: more than half a window.
const PADDING: usize = 8;

/// Half of the largest window, without its centre: sums of 15 x 15 products are still exact.
const MAX_HALF: usize = 7;

impl CorrelationWindows {
    /// Windows of `window_px` (odd, at most 15) around pixels (column, row), which must be ordered
    /// by row; those without texture are left out.
    pub(crate) fn new(reference: StripPatch, window_px: usize, pixels: &[(usize, usize)]) -> Self {
        let half = (window_px / 2).min(MAX_HALF);
        let mut windows = Self {
            columns: ColumnSums::new(reference.stride),
            half,
            sites: Vec::new(),
            powers: Vec::new(),
            reference,
        };
        windows.sites = pixels
            .iter()
            .filter_map(|&(column, row)| windows.site(column, row))
            .collect();
        windows
    }

    /// `Cor` of every site with the same window of `warped`, -1 to 1, in the order of the sites; 0
    /// where `warped` has no texture.
    pub(crate) fn correlate(&mut self, warped: &StripPatch, correlations: &mut Vec<f64>) {
        correlations.clear();
        self.powers.clear();
        self.columns.clear();
        let (rows, half) = (self.reference.rows, self.half);
        let mask = window_mask(half);
        let mut entered = 0;
        let mut left = 0;
        for site in &self.sites {
            while entered < rows.min(site.row + half + 1) {
                self.columns
                    .slide::<true>(self.reference.row(entered), warped.row(entered));
                entered += 1;
            }
            while left < site.row.saturating_sub(half) {
                self.columns
                    .slide::<false>(self.reference.row(left), warped.row(left));
                left += 1;
            }
            let [covariance, power] = site.moments(self.columns.window(site.column, &mask));
            correlations.push(covariance);
            self.powers.push(power);
        }
        // All roots and quotients together: several at once.
        for (correlation, power) in correlations.iter_mut().zip(&self.powers) {
            *correlation /= power.sqrt();
        }
    }

    fn site(&self, column: usize, row: usize) -> Option<Site> {
        let a = &self.reference;
        let (columns, rows) = (
            column.saturating_sub(self.half)..(column + self.half + 1).min(a.columns),
            row.saturating_sub(self.half)..(row + self.half + 1).min(a.rows),
        );
        let count = (columns.len() * rows.len()) as f64;
        let (mut sum, mut squares) = (0.0, 0.0);
        for row in rows {
            for &value in &a.row(row)[columns.clone()] {
                let value = f64::from(value);
                sum += value;
                squares += value * value;
            }
        }
        let scatter = count * squares - sum * sum;
        (scatter > MIN_VARIANCE * count * count).then_some(Site {
            column,
            row,
            count,
            sum,
            scatter,
        })
    }
}

impl Site {
    /// Standard deviation of the window in the reference, grey values 0 to 1.
    pub(crate) fn contrast(&self) -> f64 {
        self.scatter.sqrt() / self.count / UNITS
    }

    /// `n Sab - Sa Sb` and `(n Saa - Sa^2) (n Sbb - Sb^2)`; 0 and 1 where the warped view has no
    /// texture.
    fn moments(&self, [b, bb, ab]: [f64; 3]) -> [f64; 2] {
        let scatter = self.count * bb - b * b;
        if scatter <= MIN_VARIANCE * self.count * self.count {
            return [0.0, 1.0];
        }
        [self.count * ab - self.sum * b, self.scatter * scatter]
    }
}

impl ColumnSums {
    fn new(stride: usize) -> Self {
        let zeros = vec![0.0; stride + 2 * PADDING];
        Self {
            b: zeros.clone(),
            bb: zeros.clone(),
            ab: zeros,
        }
    }

    fn clear(&mut self) {
        for sums in [&mut self.b, &mut self.bb, &mut self.ab] {
            sums.fill(0.0);
        }
    }

    /// Takes a row in (`ENTER`) or out.
    fn slide<const ENTER: bool>(&mut self, a: &[f32], b: &[f32]) {
        let columns = PADDING..PADDING + a.len();
        let sums = self.b[columns.clone()]
            .chunks_exact_mut(8)
            .zip(self.bb[columns.clone()].chunks_exact_mut(8))
            .zip(self.ab[columns].chunks_exact_mut(8));
        let values = a.chunks_exact(8).zip(b.chunks_exact(8));
        for (((sum_b, sum_bb), sum_ab), (a, b)) in sums.zip(values) {
            let (a, b) = (load(a), load(b));
            for (sum, term) in [(sum_b, b), (sum_bb, b * b), (sum_ab, a * b)] {
                let old = load(sum);
                let new = if ENTER { old + term } else { old - term };
                sum.copy_from_slice(new.as_array());
            }
        }
    }

    /// `[Sb, Sbb, Sab]` over the columns that `mask` keeps of the sixteen from `column - 7` on. The
    /// sums are whole numbers, so the order in which the lanes are added does not matter.
    #[inline]
    fn window(&self, column: usize, mask: &[f32x8; 2]) -> [f64; 3] {
        let first = PADDING + column - MAX_HALF;
        let [b, bb, ab] = [
            quarters(&self.b[first..first + 16], mask),
            quarters(&self.bb[first..first + 16], mask),
            quarters(&self.ab[first..first + 16], mask),
        ];
        let [p, q, r, s] = f32x4::transpose([b, bb, ab, f32x4::ZERO]);
        let [b, bb, ab, _] = ((p + q) + (r + s)).to_array();
        [f64::from(b), f64::from(bb), f64::from(ab)]
    }
}

/// Four sums of four of the sixteen values each, of those that `mask` keeps.
#[inline(always)]
fn quarters(sums: &[f32], mask: &[f32x8; 2]) -> f32x4 {
    let (low, high) = sums.split_at(8);
    let [a, b]: [f32x4; 2] = cast(load(low) * mask[0] + load(high) * mask[1]);
    a + b
}

/// Ones at the columns of a window that starts `MAX_HALF - half` after the first of sixteen.
fn window_mask(half: usize) -> [f32x8; 2] {
    let lane = |i: usize| {
        if i.abs_diff(MAX_HALF) <= half {
            1.0
        } else {
            0.0
        }
    };
    [0, 8].map(|start| f32x8::from(std::array::from_fn::<f32, 8, _>(|i| lane(start + i))))
}

#[inline(always)]
fn load(values: &[f32]) -> f32x8 {
    let values: [f32; 8] = values.try_into().expect("chunks of eight");
    f32x8::from(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn patch(columns: usize, rows: usize, value: impl Fn(usize, usize) -> i32) -> StripPatch {
        let stride = columns.next_multiple_of(8);
        let mut data = vec![0.0; stride * rows];
        for row in 0..rows {
            for column in 0..columns {
                data[row * stride + column] = value(column, row).clamp(-255, 255) as f32;
            }
        }
        StripPatch {
            columns,
            rows,
            stride,
            data,
        }
    }

    /// The textbook formula: mean, deviation, product.
    fn direct(a: &StripPatch, b: &StripPatch, column: usize, row: usize, half: usize) -> f64 {
        let pixels: Vec<(f64, f64)> = (row.saturating_sub(half)..(row + half + 1).min(a.rows))
            .flat_map(|r| {
                (column.saturating_sub(half)..(column + half + 1).min(a.columns))
                    .map(move |c| (f64::from(a.row(r)[c]), f64::from(b.row(r)[c])))
            })
            .collect();
        let n = pixels.len() as f64;
        let mean_a = pixels.iter().map(|p| p.0).sum::<f64>() / n;
        let mean_b = pixels.iter().map(|p| p.1).sum::<f64>() / n;
        let sum = |f: &dyn Fn(f64, f64) -> f64| {
            pixels
                .iter()
                .map(|p| f(p.0 - mean_a, p.1 - mean_b))
                .sum::<f64>()
        };
        sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt()
    }

    fn all_pixels(columns: usize, rows: usize) -> Vec<(usize, usize)> {
        (0..rows)
            .flat_map(|r| (0..columns).map(move |c| (c, r)))
            .collect()
    }

    proptest! {
        #[test]
        fn running_sums_agree_with_direct_windows(
            columns in 1usize..40,
            rows in 1usize..40,
            seed in 0usize..1000,
            mean in -250i32..250,
            contrast in 2i32..260,
        ) {
            let noise = |c: usize, r: usize, k: usize| {
                let h = (c * 7919 + r * 104_729 + seed * 1301 + k).wrapping_mul(2_654_435_761);
                ((h >> 7) % 1000) as i32 * contrast / 1000 + mean
            };
            let a = patch(columns, rows, |c, r| noise(c, r, 0));
            let b = patch(columns, rows, |c, r| (noise(c, r, 0) + noise(c, r, 17)) / 2);
            let mut windows = CorrelationWindows::new(a.clone(), 15, &all_pixels(columns, rows));
            let mut correlations = Vec::new();
            windows.correlate(&b, &mut correlations);
            prop_assert_eq!(correlations.len(), windows.sites.len());
            for (site, cor) in windows.sites.iter().zip(&correlations) {
                if *cor != 0.0 {
                    let expected = direct(&a, &b, site.column, site.row, 7);
                    prop_assert!((cor - expected).abs() < 1e-4, "{} {}", cor, expected);
                }
            }
        }
    }

    #[test]
    fn contrast_and_brightness_do_not_matter_but_sign_does() {
        let a = patch(30, 20, |c, r| ((c * 5 + r * 11) % 23) as i32);
        let scaled = patch(30, 20, |c, r| ((c * 5 + r * 11) % 23) as i32 * 4 - 60);
        let inverted = patch(30, 20, |c, r| 50 - ((c * 5 + r * 11) % 23) as i32 * 2);
        let mut windows = CorrelationWindows::new(a, 15, &all_pixels(30, 20));
        let mut correlations = Vec::new();
        windows.correlate(&scaled, &mut correlations);
        assert_eq!(correlations.len(), 600);
        assert!(correlations.iter().all(|c| (c - 1.0).abs() < 1e-12));
        windows.correlate(&inverted, &mut correlations);
        assert!(correlations.iter().all(|c| (c + 1.0).abs() < 1e-12));
    }

    #[test]
    fn windows_without_texture_are_left_out() {
        let a = patch(40, 10, |c, _| if c < 10 { (c % 3) as i32 } else { 7 });
        let windows = CorrelationWindows::new(a, 15, &[(4, 4), (30, 4)]);
        assert_eq!(windows.sites.len(), 1);
        assert_eq!(windows.sites[0].column, 4);
    }
}
