//! What gradients are ordinary here: statistics of the gradient strength, block by block.
//!
//! B99 3.2 names the Canny detector and no thresholds. One threshold for a whole photograph either
//! loses the weak ridge between two roof planes of similar shade or drowns in the crowns of trees, so
//! everything here is relative to the surroundings: [`LocalGradients::noise`] is the scale of the
//! gradients nearby, and [`LocalGradients::surprise`] is `-ln H(g)`, where `H(g)` is the share of
//! the pixels nearby whose gradient is stronger than `g` (Desolneux, Moisan, Morel 2001, "Edge
//! detection by Helmholtz principle", with the distribution taken locally instead of globally).

use super::canny::Gradient;

/// Side of a block, px. Statistics are pooled over 3 x 3 blocks: a roof plane's size.
const BLOCK_PX: usize = 32;
/// Bins of the gradient strength; the last one is open.
const BINS: usize = 256;
/// Width of a bin, grey values (0 to 1) per px: the last bin begins at 0.125 per px, a third of
/// full contrast in one pixel, where nothing is ordinary any more.
const BIN_WIDTH: f32 = 1.0 / 2048.0;
/// Gradient noise never counts as less than this, grey values per px: rounding to 8 bits alone has a
/// standard deviation of 1/255/sqrt(12), and about a quarter of it is left after smoothing.
const MIN_NOISE: f32 = 0.25 / 255.0 / 3.464_101_6;
/// Median of a Rayleigh distribution, the strength of a gradient whose components are Gaussian with
/// standard deviation 1.
const RAYLEIGH_MEDIAN: f32 = 1.177_41;

/// Gradient statistics on a grid of blocks.
pub struct LocalGradients {
    columns: usize,
    rows: usize,
    noise: Vec<f32>,
    surprise: Vec<[f32; BINS]>,
}

impl LocalGradients {
    /// The statistics of a gradient raster.
    pub fn new(gradient: &Gradient) -> Self {
        let columns = gradient.width.div_ceil(BLOCK_PX).max(1);
        let rows = gradient.height.div_ceil(BLOCK_PX).max(1);
        let counts = pool(&histograms(gradient, columns, rows), columns, rows);
        Self {
            columns,
            rows,
            noise: counts.iter().map(noise_of).collect(),
            surprise: counts.iter().map(surprise_of).collect(),
        }
    }

    /// Scale of the gradients around a pixel: the standard deviation of a component, grey values
    /// per px, were they all noise.
    pub fn noise(&self, x: usize, y: usize) -> f32 {
        // Bilinear between block centres, so that thresholds have no steps at block borders.
        let (column, fx) = interval(x, self.columns);
        let (row, fy) = interval(y, self.rows);
        let right = (column + 1).min(self.columns - 1);
        let below = (row + 1).min(self.rows - 1);
        let at = |column: usize, row: usize| self.noise[row * self.columns + column];
        let top = at(column, row) + (at(right, row) - at(column, row)) * fx;
        let bottom = at(column, below) + (at(right, below) - at(column, below)) * fx;
        top + (bottom - top) * fy
    }

    /// `-ln H(strength)` around a pixel: 0 for what is ordinary there, large for what is rare.
    pub fn surprise(&self, x: usize, y: usize, strength: f32) -> f32 {
        let column = (x / BLOCK_PX).min(self.columns - 1);
        let row = (y / BLOCK_PX).min(self.rows - 1);
        self.surprise[row * self.columns + column][bin(strength)]
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
fn histograms(gradient: &Gradient, columns: usize, rows: usize) -> Vec<[u32; BINS]> {
    let mut counts = vec![[0u32; BINS]; columns * rows];
    for y in (0..gradient.height).step_by(2) {
        let line = &gradient.strength[y * gradient.width..(y + 1) * gradient.width];
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
    (median / RAYLEIGH_MEDIAN).max(MIN_NOISE)
}

fn surprise_of(counts: &[u32; BINS]) -> [f32; BINS] {
    let total = counts.iter().sum::<u32>().max(1);
    let mut surprise = [0.0; BINS];
    let mut stronger = 0;
    for (s, &n) in surprise.iter_mut().zip(counts).rev() {
        stronger += n;
        // Never zero: what no pixel reaches is at most as rare as one in the sample.
        let share = f64::from(stronger.max(1)) / f64::from(total);
        *s = -crate::math::ln(share) as f32;
    }
    surprise
}
