//! Points of the ground, on a grid.
//!
//! The height of a cell with points is that, in its middle, of the plane of least squares through
//! the points of this cell and of its neighbours: a slope is not moved by where its points happen
//! to lie. Gaps, as under buildings, are closed between their borders along rows and columns, by
//! straight lines, the shorter ones weighing more; beyond the points nothing is.

use crate::base::math::{hypot, larger};
use crate::orienting::known::height_grid::{HeightGrid, Placement, StoredHeights};
use crate::orienting::known::system::Way;

/// Points of the ground.
pub(super) struct GroundPoints {
    /// They are stored less this, metres.
    offset: [f64; 3],
    points: Vec<[f32; 3]>,
}

/// Points that a cell has on average.
const POINTS_A_CELL: f64 = 2.0;
/// Finest cell, metres: the ground is laid in blocks of a metre.
const FINEST_CELL_M: f64 = 0.5;
/// Most cells of a grid.
const MOST_CELLS: f64 = 4e6;
/// Widest gap that is closed, metres. Assumption: halls are as wide.
const WIDEST_GAP_M: f64 = 60.0;
/// Points lie along a line where the determinant of their scatter is a smaller share of its squared
/// trace: it is a quarter of that where they spread evenly. Assumption.
const COLLINEAR_SHARE: f64 = 0.02;

impl GroundPoints {
    pub(super) fn new() -> Self {
        Self {
            offset: [0.0; 3],
            points: Vec::new(),
        }
    }

    pub(super) fn push(&mut self, position: [f64; 3]) {
        if self.points.is_empty() {
            // Around the first point, whatever offset the file has: single precision suffices.
            self.offset = position;
        }
        let point = [0, 1, 2].map(|k| (position[k] - self.offset[k]) as f32);
        self.points.push(point);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Their heights on a grid; otherwise why they make none.
    pub(super) fn grid(self) -> Result<HeightGrid, String> {
        let Self { offset, points } = self;
        let range = |axis: usize| {
            let all = points.iter().map(|p| f64::from(p[axis]));
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
                [low.min(v), high.max(v)]
            })
        };
        let ([x0, x1], [y0, y1]) = (range(0), range(1));
        let area = (x1 - x0) * (y1 - y0);
        let of_density = (POINTS_A_CELL * area / points.len() as f64).sqrt();
        let cell = larger(
            larger(of_density, FINEST_CELL_M),
            (area / MOST_CELLS).sqrt(),
        );
        let [columns, rows] = [x1 - x0, y1 - y0].map(|size| (size / cell).floor() + 1.0);
        // Neither is true of what is no number.
        let is_grid = columns >= 2.0 && rows >= 2.0 && columns * rows <= 2.0 * MOST_CELLS;
        if !is_grid {
            return Err(format!(
                "its points of the ground lie within {:.1} m by {:.1} m",
                x1 - x0,
                y1 - y0
            ));
        }
        let (columns, rows) = (columns as usize, rows as usize);
        let cells = Cells::new(points, [x0, y1], cell, [columns, rows]);
        let heights: Vec<Option<f64>> = (0..columns * rows).map(|k| cells.height(k)).collect();
        let closed = closed(&heights, columns, (WIDEST_GAP_M / cell) as usize);
        let heights = (closed.into_iter())
            .map(|z| z.map_or(f32::NAN, |z| (z + offset[2]) as f32))
            .collect();
        let first = [x0 + offset[0] + 0.5 * cell, y1 + offset[1] - 0.5 * cell];
        let place = Placement {
            first,
            cell: [cell; 2],
            columns,
            rows,
        };
        HeightGrid::new(
            place,
            StoredHeights::as_they_are(heights, None),
            Way::same(),
        )
    }
}

/// Points by the cells that they lie in.
struct Cells {
    /// Western and northern border.
    corner: [f64; 2],
    cell: f64,
    columns: usize,
    rows: usize,
    points: Vec<[f32; 3]>,
    /// Where the points of each cell begin, and their number at the end.
    begins: Vec<u32>,
}

impl Cells {
    fn new(
        mut points: Vec<[f32; 3]>,
        corner: [f64; 2],
        cell: f64,
        [columns, rows]: [usize; 2],
    ) -> Self {
        let place = |p: &[f32; 3]| {
            let column = ((f64::from(p[0]) - corner[0]) / cell) as usize;
            let row = ((corner[1] - f64::from(p[1])) / cell) as usize;
            row.min(rows - 1) * columns + column.min(columns - 1)
        };
        points.sort_by_key(place);
        let mut begins = vec![0; columns * rows + 1];
        for p in &points {
            begins[place(p) + 1] += 1;
        }
        for k in 0..columns * rows {
            begins[k + 1] += begins[k];
        }
        Self {
            corner,
            cell,
            columns,
            rows,
            points,
            begins,
        }
    }

    /// Points of neighbouring cells of one row.
    fn between(&self, first: usize, last: usize) -> &[[f32; 3]] {
        &self.points[self.begins[first] as usize..self.begins[last + 1] as usize]
    }

    /// Height in the middle of a cell that has points.
    fn height(&self, k: usize) -> Option<f64> {
        if self.begins[k] == self.begins[k + 1] {
            return None;
        }
        let (column, row) = (k % self.columns, k / self.columns);
        let middle = [
            self.corner[0] + (column as f64 + 0.5) * self.cell,
            self.corner[1] - (row as f64 + 0.5) * self.cell,
        ];
        let [first, last] = [column.saturating_sub(1), (column + 1).min(self.columns - 1)];
        let rows = row.saturating_sub(1)..=(row + 1).min(self.rows - 1);
        let around =
            rows.flat_map(|r| self.between(r * self.columns + first, r * self.columns + last));
        let around = around.map(|p| {
            let [x, y, z] = p.map(f64::from);
            [x - middle[0], y - middle[1], z]
        });
        Some(height_at_origin(around))
    }
}

/// Height of the plane of least squares through points, at the origin of the plan; their mean
/// where they lie along a line or the plane would be laid far beyond them.
fn height_at_origin(points: impl Iterator<Item = [f64; 3]> + Clone) -> f64 {
    let (mut n, mut mean) = (0.0, [0.0; 3]);
    for p in points.clone() {
        n += 1.0;
        for (sum, v) in mean.iter_mut().zip(p) {
            *sum += v;
        }
    }
    let mean = mean.map(|sum| sum / n);
    let [mut xx, mut xy, mut yy, mut xz, mut yz] = [0.0; 5];
    for p in points {
        let [x, y, z] = [0, 1, 2].map(|k| p[k] - mean[k]);
        xx += x * x;
        xy += x * y;
        yy += y * y;
        xz += x * z;
        yz += y * z;
    }
    let determinant = xx * yy - xy * xy;
    let extent = xx + yy;
    let reaches = hypot(mean[0], mean[1]) <= (extent / n).sqrt();
    if determinant <= COLLINEAR_SHARE * extent * extent || !reaches {
        return mean[2];
    }
    let gradient = [
        (yy * xz - xy * yz) / determinant,
        (xx * yz - xy * xz) / determinant,
    ];
    mean[2] - gradient[0] * mean[0] - gradient[1] * mean[1]
}

/// Heights with their gaps of at most so many cells closed.
fn closed(heights: &[Option<f64>], columns: usize, widest: usize) -> Vec<Option<f64>> {
    let rows = heights.len() / columns;
    // Sum of weighted heights, and of weights.
    let mut filled = vec![[0.0; 2]; heights.len()];
    let mut along = |first: usize, step: usize, count: usize| {
        let mut last: Option<(usize, f64)> = None;
        for i in 0..count {
            let Some(z) = heights[first + i * step] else {
                continue;
            };
            if let Some((from, before)) = last {
                let gap = i - from;
                if gap > 1 && gap - 1 <= widest {
                    for j in from + 1..i {
                        let share = (j - from) as f64 / gap as f64;
                        let weight = 1.0 / gap as f64;
                        let cell = &mut filled[first + j * step];
                        cell[0] += weight * (before + share * (z - before));
                        cell[1] += weight;
                    }
                }
            }
            last = Some((i, z));
        }
    };
    (0..rows).for_each(|r| along(r * columns, 1, columns));
    (0..columns).for_each(|c| along(c, columns, rows));
    (heights.iter().zip(filled))
        .map(|(z, [sum, weight])| z.or_else(|| (weight > 0.0).then(|| sum / weight)))
        .collect()
}
