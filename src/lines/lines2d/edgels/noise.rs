//! Local statistics of the gradient strength, block by block.
//!
//! B99 3.2 names the Canny detector and no thresholds. One threshold for a whole photograph either
//! loses the weak ridge between two roof planes of similar shade or drowns in the crowns of trees,
//! so everything here is relative to the surroundings: [`LocalStrengths::noise`] is the scale of
//! the gradients nearby, and [`LocalStrengths::surprisal`] is `-ln H(g)`, where `H(g)` is the
//! share of the pixels nearby whose gradient is stronger than `g` (Desolneux, Moisan, Morel 2001,
//! "Edge detection by Helmholtz principle", with the distribution taken locally instead of
//! globally).

use crate::base::math::RAYLEIGH_MEDIAN;

/// Side of a block, px. Statistics are pooled over 3 x 3 blocks: a roof plane's size.
const BLOCK_PX: usize = 32;
/// Bins of the gradient strength; the last one is open.
const BINS: usize = 256;
/// Width of a bin, grey values (0 to 1) per px: the last bin begins at 0.125 per px, a third of
/// full contrast in one pixel, where nothing is ordinary any more.
const BIN_WIDTH: f32 = 1.0 / 2048.0;
/// Gradient noise never counts as less than this, grey values per px: rounding to 8 bits alone has
/// a standard deviation of 1/255/sqrt(12), and a quarter of it is left after smoothing.
const MIN_NOISE: f32 = 0.25 / 255.0 / 3.464_101_6;
/// Statistics of a strength (of the gradient, of the second derivative) on a grid of blocks.
pub(crate) struct LocalStrengths {
    columns: usize,
    rows: usize,
    noise: Vec<f32>,
    surprisal: Vec<[f32; BINS]>,
}

impl LocalStrengths {
    /// The statistics of a raster of strengths, row by row.
    pub(crate) fn new(strength: &[f32], width: usize, height: usize) -> Self {
        let columns = width.div_ceil(BLOCK_PX).max(1);
        let rows = height.div_ceil(BLOCK_PX).max(1);
        let counts = pool(&histograms(strength, width, columns, rows), columns, rows);
        Self {
            columns,
            rows,
            noise: counts.iter().map(noise_of).collect(),
            surprisal: counts.iter().map(surprisal_of).collect(),
        }
    }

    /// Scale of the gradients around each pixel of row `y`: the standard deviation of a component,
    /// grey values per px, were they all noise. Bilinear between block centres, so that thresholds
    /// have no steps at block borders.
    pub(crate) fn noise_row(&self, y: usize, row: &mut [f32]) {
        let (above, f) = interval(y, self.rows);
        let below = (above + 1).min(self.rows - 1);
        let line = |row: usize| &self.noise[row * self.columns..(row + 1) * self.columns];
        let (above, below) = (line(above), line(below));
        let blocks = above.iter().zip(below).map(|(a, b)| a + (b - a) * f);
        let blocks: Vec<f32> = blocks.collect();
        // Before the first centre and after the last one the value is constant.
        let half = BLOCK_PX / 2;
        let (first, rest) = row.split_at_mut(half.min(row.len()));
        first.fill(blocks[0]);
        for (pixels, column) in rest.chunks_mut(BLOCK_PX).zip(0..) {
            let left = blocks[column];
            let slope = (blocks[(column + 1).min(self.columns - 1)] - left) / BLOCK_PX as f32;
            for (pixel, i) in pixels.iter_mut().zip(0u16..) {
                *pixel = left + slope * (f32::from(i) + 0.5);
            }
        }
    }

    /// `-ln H(strength)` around a pixel: 0 for a common strength, large for a rare one.
    pub(crate) fn surprisal(&self, x: usize, y: usize, strength: f32) -> f32 {
        let column = (x / BLOCK_PX).min(self.columns - 1);
        let row = (y / BLOCK_PX).min(self.rows - 1);
        self.surprisal[row * self.columns + column][bin(strength)]
    }
}

fn bin(strength: f32) -> usize {
    ((strength / BIN_WIDTH) as usize).min(BINS - 1)
}

/// Block whose centre lies at or before the pixel, and the fraction of the way to the next centre.
fn interval(x: usize, blocks: usize) -> (usize, f32) {
    let t = ((x as f32 + 0.5) / BLOCK_PX as f32 - 0.5).clamp(0.0, (blocks - 1) as f32);
    (t as usize, t - t.floor())
}

/// Strengths of every other pixel of every other row, counted per block.
fn histograms(strength: &[f32], width: usize, columns: usize, rows: usize) -> Vec<[u32; BINS]> {
    let mut counts = vec![[0u32; BINS]; columns * rows];
    for (y, line) in strength.chunks_exact(width.max(1)).enumerate().step_by(2) {
        let blocks = &mut counts[y / BLOCK_PX * columns..][..columns];
        for (block, pixels) in blocks.iter_mut().zip(line.chunks(BLOCK_PX)) {
            for &strength in pixels.iter().step_by(2) {
                block[bin(strength)] += 1;
            }
        }
    }
    counts
}

/// Sum of the 3 x 3 blocks around each.
fn pool(counts: &[[u32; BINS]], columns: usize, rows: usize) -> Vec<[u32; BINS]> {
    let mut pooled = vec![[0u32; BINS]; counts.len()];
    for row in 0..rows {
        for column in 0..columns {
            let sum = &mut pooled[row * columns + column];
            for r in row.saturating_sub(1)..(row + 2).min(rows) {
                for c in column.saturating_sub(1)..(column + 2).min(columns) {
                    for (s, n) in sum.iter_mut().zip(&counts[r * columns + c]) {
                        *s += n;
                    }
                }
            }
        }
    }
    pooled
}

fn noise_of(counts: &[u32; BINS]) -> f32 {
    let half = counts.iter().sum::<u32>() / 2;
    let mut below = 0;
    let mut median = 0.0;
    for (i, &n) in counts.iter().enumerate() {
        if below + n > half {
            let inside = (half - below) as f32 / n as f32;
            median = (i as f32 + inside) * BIN_WIDTH;
            break;
        }
        below += n;
    }
    (median / RAYLEIGH_MEDIAN as f32).max(MIN_NOISE)
}

fn surprisal_of(counts: &[u32; BINS]) -> [f32; BINS] {
    let total = counts.iter().sum::<u32>().max(1);
    let mut surprisal = [0.0; BINS];
    // A strength that no pixel reaches is taken as rare as one pixel of the sample.
    let mut value = crate::base::math::ln(f64::from(total)) as f32;
    let mut stronger = 0;
    for (s, &n) in surprisal.iter_mut().zip(counts).rev() {
        if n > 0 {
            stronger += n;
            value = -crate::base::math::ln(f64::from(stronger) / f64::from(total)) as f32;
        }
        *s = value;
    }
    surprisal
}

#[cfg(test)]
mod tests {
    use super::super::canny::Gradient;
    use super::*;
    use crate::lines::lines2d::testing::{add_noise, step_edge};
    use crate::photographs::raster::{Gray, gaussian_blur};

    /// What smoothing by 1 px and a central difference leave of white noise of 1: smoothed noise
    /// is correlated as R(d) = exp(-d^2 / 4) / 4 pi, and the variance of a difference over 2 px,
    /// halved, is (R(0) - R(2)) / 2.
    const GAIN: f32 = 0.1586;

    fn noisy(sigma: f64) -> LocalStrengths {
        let mut gray = Gray::from_fn(160, 160, |_, _| 0.5);
        add_noise(&mut gray, sigma, 7);
        Gradient::new(&gaussian_blur(&gray, 1.0)).statistics()
    }

    #[test]
    fn the_noise_is_that_of_the_image() {
        let local = noisy(0.02);
        let mut row = vec![0.0; 160];
        for y in [3, 80, 150] {
            local.noise_row(y, &mut row);
            for n in &row {
                assert!((n / (0.02 * GAIN) - 1.0).abs() < 0.15, "{n}");
            }
        }
    }

    #[test]
    fn a_clean_image_has_the_noise_of_rounding() {
        let local = noisy(0.0);
        let mut row = vec![0.0; 160];
        local.noise_row(9, &mut row);
        assert_eq!(row, vec![MIN_NOISE; 160]);
    }

    #[test]
    fn an_edge_is_rare_and_noise_is_not() {
        let mut gray = step_edge(160, 160, 0.3, 0.2);
        add_noise(&mut gray, 0.02, 7);
        let local = Gradient::new(&gaussian_blur(&gray, 1.0)).statistics();
        assert!(local.surprisal(80, 80, 0.02 * GAIN) < 1.0);
        assert!(local.surprisal(80, 80, 0.06) > 3.0);
    }
}
