//! Sums over the window around every cell of a plan grid, by running sums.

use super::plan::PlanGrid;

/// Half the window side in cells: 11 x 11, a little smaller than the paper's 15 x 15, since its
/// windows lie along lines and these must not reach far over the borders of small facets.
pub const HALF_WINDOW: usize = 5;

/// Sum over the window around every cell, along rows and then along columns; windows that stick out of the
/// grid are cut off.
pub fn box_sum(values: &[f32], grid: &PlanGrid) -> Vec<f32> {
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
