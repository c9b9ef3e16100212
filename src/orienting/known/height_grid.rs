//! Heights on a grid, interpolated between the centres of its cells.

/// A raster of heights, world frame of its file, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightGrid {
    /// Easting and northing of the centre of the first cell, which is the north-western one.
    first: [f64; 2],
    /// Size of a cell east and south, metres.
    cell: [f64; 2],
    columns: usize,
    rows: usize,
    /// Row by row from the north; not a number where there is no height.
    heights: Vec<f32>,
}

/// Heights of the Earth's surface lie between these, metres: the shore of the Dead Sea at some
/// -430, Mount Everest at 8849.
const LOWEST_HEIGHT_M: f32 = -500.0;
const HIGHEST_HEIGHT_M: f32 = 9000.0;

impl HeightGrid {
    /// A grid whose centre of the north-western cell, cells and heights these are; heights that are
    /// `no_data` are none. Otherwise why it is none.
    pub(super) fn new(
        first: [f64; 2],
        cell: [f64; 2],
        [columns, rows]: [usize; 2],
        mut heights: Vec<f32>,
        no_data: Option<f32>,
    ) -> Result<Self, String> {
        if !first.iter().chain(&cell).all(|v| v.is_finite()) || cell.iter().any(|c| *c <= 0.0) {
            return Err("its place or the size of its cells is no number".to_owned());
        }
        if columns < 2 || rows < 2 || heights.len() != columns * rows {
            return Err(format!("it has {columns} x {rows} cells"));
        }
        for z in &mut heights {
            if no_data == Some(*z) || !z.is_finite() {
                *z = f32::NAN;
            }
        }
        let known = || heights.iter().copied().filter(|z| !z.is_nan());
        if known().next().is_none() {
            return Err("it holds no height at all".to_owned());
        }
        if let Some(z) = known().find(|z| !(LOWEST_HEIGHT_M..=HIGHEST_HEIGHT_M).contains(z)) {
            return Err(format!(
                "it holds a height of {z}, which is none of the ground in metres"
            ));
        }
        Ok(Self {
            first,
            cell,
            columns,
            rows,
            heights,
        })
    }

    /// Height at a position; `None` outside and beside cells without a height.
    pub fn z_at(&self, x: f64, y: f64) -> Option<f64> {
        let c = (x - self.first[0]) / self.cell[0];
        let r = (self.first[1] - y) / self.cell[1];
        // Half a cell around the outermost centres belongs to the grid.
        let inside = |v: f64, n: usize| v >= -0.5 && v <= n as f64 - 0.5;
        if !inside(c, self.columns) || !inside(r, self.rows) {
            return None;
        }
        let split = |v: f64, n: usize| {
            let v = v.clamp(0.0, (n - 1) as f64);
            let before = (v as usize).min(n - 2);
            (before, v - before as f64)
        };
        let ((c, s), (r, t)) = (split(c, self.columns), split(r, self.rows));
        let at = |c: usize, r: usize| f64::from(self.heights[r * self.columns + c]);
        let z = (1.0 - t) * ((1.0 - s) * at(c, r) + s * at(c + 1, r))
            + t * ((1.0 - s) * at(c, r + 1) + s * at(c + 1, r + 1));
        (!z.is_nan()).then_some(z)
    }
}
