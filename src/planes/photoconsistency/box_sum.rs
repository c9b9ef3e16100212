//! Sums over the window around every cell of a plan grid, by running sums, one row after the other.
//!
//! Only the rows of one window are kept: a plane is compared in many views, and rasters of all
//! their sums would not stay near the processor.

use super::plan_grid::PlanGrid;

/// Half the window side in cells: 5 x 5 cells of 2 x 2 samples, a little smaller than the paper's
/// 15 x 15 pixels, since its windows lie along lines and these must not reach far over the borders
/// of small facets.
pub(crate) const HALF_WINDOW: usize = 2;
/// Side of a window, cells.
pub(crate) const WINDOW: usize = 2 * HALF_WINDOW + 1;
/// Cells of a window.
pub(crate) const WINDOW_CELLS: f32 = (WINDOW * WINDOW) as f32;

/// Rows of a window, and the one that leaves it.
const KEPT_ROWS: usize = 2 * HALF_WINDOW + 2;

/// Sum over the window around every cell, along rows and then along columns; windows that stick out
/// of the grid are cut off.
pub(crate) struct BoxSum {
    width: usize,
    height: usize,
    /// Sums along the last rows that entered, row y at y modulo [`KEPT_ROWS`].
    rows: Vec<f32>,
    /// Sums over the window.
    sums: Vec<f32>,
    /// Rows that have entered.
    entered: usize,
    /// The next row to be returned.
    next: usize,
}

impl BoxSum {
    /// Above the first row.
    pub(crate) fn new(grid: &PlanGrid) -> Self {
        Self {
            width: grid.width,
            height: grid.height,
            rows: vec![0.0; KEPT_ROWS * grid.width],
            sums: vec![0.0; grid.width],
            entered: 0,
            next: 0,
        }
    }

    /// The sums around the cells of the next row; `fill` writes the values of a row of the grid.
    pub(crate) fn next_row(
        &mut self,
        line: &mut RowSum,
        mut fill: impl FnMut(usize, &mut [f32]),
    ) -> &[f32] {
        let (w, r) = (self.width, HALF_WINDOW);
        while self.entered < self.height.min(self.next + r + 1) {
            let row = &mut self.rows[self.entered % KEPT_ROWS * w..][..w];
            fill(self.entered, line.values());
            line.sum(row);
            for (sum, value) in self.sums.iter_mut().zip(row) {
                *sum += *value;
            }
            self.entered += 1;
        }
        if self.next > r {
            let row = &self.rows[(self.next - r - 1) % KEPT_ROWS * w..][..w];
            for (sum, value) in self.sums.iter_mut().zip(row) {
                *sum -= value;
            }
        }
        self.next += 1;
        &self.sums
    }
}

/// Sums of five neighbours in a row, as 2 + 2 + 1. No sum waits for the one before it, so the
/// compiler adds many at once.
pub(crate) struct RowSum {
    padded: Vec<f32>,
    two: Vec<f32>,
}

impl RowSum {
    /// For rows of `width` cells.
    pub(crate) fn new(width: usize) -> Self {
        let n = width + 2 * HALF_WINDOW;
        Self {
            padded: vec![0.0; n],
            two: vec![0.0; n],
        }
    }

    /// The values that are summed.
    fn values(&mut self) -> &mut [f32] {
        let end = self.padded.len() - HALF_WINDOW;
        &mut self.padded[HALF_WINDOW..end]
    }

    fn sum(&mut self, out: &mut [f32]) {
        const { assert!(WINDOW == 2 + 2 + 1) };
        let n = self.padded.len();
        let p = &self.padded[..n];
        for ((t, a), b) in self.two[..n - 1].iter_mut().zip(p).zip(&p[1..]) {
            *t = a + b;
        }
        let twos = self.two.iter().zip(&self.two[2..]);
        for ((o, (a, b)), c) in out.iter_mut().zip(twos).zip(&p[4..]) {
            *o = (a + b) + c;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn box_sum_agrees_with_direct_sums() {
        for (width, height) in [(17, 14), (3, 40), (30, 4), (1, 1)] {
            let grid = PlanGrid {
                origin: Point2::origin(),
                step: 1.0,
                width,
                height,
            };
            let values: Vec<f32> = (0..width * height)
                .map(|i| ((i * 37) % 11) as f32)
                .collect();
            let (mut sums, mut line) = (BoxSum::new(&grid), RowSum::new(width));
            for y in 0..height {
                let row = sums.next_row(&mut line, |y, out| {
                    out.copy_from_slice(&values[y * width..(y + 1) * width]);
                });
                for (x, sum) in row.iter().enumerate() {
                    let mut direct = 0.0;
                    for v in y.max(HALF_WINDOW) - HALF_WINDOW..=(y + HALF_WINDOW).min(height - 1) {
                        for u in x.max(HALF_WINDOW) - HALF_WINDOW..=(x + HALF_WINDOW).min(width - 1)
                        {
                            direct += values[v * width + u];
                        }
                    }
                    assert_eq!(*sum, direct, "at {x}, {y} of {width} x {height}");
                }
            }
        }
    }
}
