//! Heights on a grid, interpolated between the centres of its cells.

use super::holes;
use super::system::Way;

/// A raster of heights.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightGrid {
    place: Placement,
    /// Row by row from the north, metres; not a number where there is no height.
    heights: Vec<f32>,
    /// From its coordinates to the world frame.
    way: Way,
    /// Placement whose heights are none of the ground, though the file does not say so.
    holes: usize,
}

/// Where the cells of a raster lie, in the coordinates of its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    /// Easting and northing of the centre of the first cell, which is the north-western one.
    pub first: [f64; 2],
    /// Size of a cell east and south.
    pub cell: [f64; 2],
    pub columns: usize,
    pub rows: usize,
}

/// The heights of a raster as its file has them, row by row from the north.
pub(super) struct StoredHeights {
    pub values: Vec<f32>,
    /// The value that stands for none.
    pub no_data: Option<f32>,
    /// Factor and summand that make heights of the values, in the unit of the way.
    pub scale: [f64; 2],
}

impl StoredHeights {
    /// Heights that are stored as they are.
    pub(super) fn as_they_are(values: Vec<f32>, no_data: Option<f32>) -> Self {
        Self {
            values,
            no_data,
            scale: [1.0, 0.0],
        }
    }
}

/// Heights of the Earth's surface lie between these, metres: the shore of the Dead Sea at some
/// -430, Mount Everest at 8849.
const LOWEST_HEIGHT_M: f32 = -500.0;
const HIGHEST_HEIGHT_M: f32 = 9000.0;

/// Metres in a degree of latitude.
const DEGREE_M: f64 = 111_320.0;

impl HeightGrid {
    /// A grid of these cells and heights; otherwise why it is none.
    pub(super) fn new(place: Placement, stored: StoredHeights, way: Way) -> Result<Self, String> {
        let Placement {
            first,
            cell,
            columns,
            rows,
        } = place;
        if !first.iter().chain(&cell).all(|v| v.is_finite()) || cell.iter().any(|c| *c <= 0.0) {
            return Err("its place or the size of its cells is no number".to_owned());
        }
        let mut heights = stored.values;
        if columns < 2 || rows < 2 || heights.len() != columns * rows {
            return Err(format!("it has {columns} x {rows} cells"));
        }
        let [factor, summand] = stored.scale.map(|v| v * way.height_unit_m);
        let (mut holes, mut odd) = (0, None);
        for z in &mut heights {
            if stored.no_data == Some(*z) || !z.is_finite() {
                *z = f32::NAN;
                continue;
            }
            if [factor, summand] != [1.0, 0.0] {
                *z = (f64::from(*z) * factor + summand) as f32;
            }
            if !(LOWEST_HEIGHT_M..=HIGHEST_HEIGHT_M).contains(z) {
                odd.get_or_insert(*z);
                *z = f32::NAN;
                holes += 1;
            }
        }
        let known = heights.iter().filter(|z| !z.is_nan()).count();
        match odd {
            Some(z) if known == 0 => {
                return Err(format!(
                    "it holds a height of {z}, which is none of the ground in metres, and no other"
                ));
            }
            None if known == 0 => return Err("it holds no height at all".to_owned()),
            _ => {}
        }
        holes += holes::take_out(&mut heights, columns, cell_m(place, &way));
        Ok(Self {
            place,
            heights,
            way,
            holes,
        })
    }

    /// How many cells hold heights that are none of the ground, though the file does not say so,
    /// and how many hold others.
    pub(super) fn holes(&self) -> [usize; 2] {
        let known = self.heights.iter().filter(|z| !z.is_nan()).count();
        [self.holes, known]
    }

    /// Height at a position of the world frame, metres; `None` outside and beside cells without a
    /// height.
    pub fn z_at(&self, x: f64, y: f64) -> Option<f64> {
        let Placement {
            first,
            cell,
            columns,
            rows,
        } = self.place;
        let at = self.way.back([x, y]);
        let c = (at[0] - first[0]) / cell[0];
        let r = (first[1] - at[1]) / cell[1];
        // Half a cell around the outermost centres belongs to the grid.
        let inside = |v: f64, n: usize| v >= -0.5 && v <= n as f64 - 0.5;
        if !inside(c, columns) || !inside(r, rows) {
            return None;
        }
        let split = |v: f64, n: usize| {
            let v = v.clamp(0.0, (n - 1) as f64);
            let before = (v as usize).min(n - 2);
            (before, v - before as f64)
        };
        let ((c, s), (r, t)) = (split(c, columns), split(r, rows));
        let at = |c: usize, r: usize| f64::from(self.heights[r * columns + c]);
        let z = (1.0 - t) * ((1.0 - s) * at(c, r) + s * at(c + 1, r))
            + t * ((1.0 - s) * at(c, r + 1) + s * at(c + 1, r + 1));
        (!z.is_nan()).then(|| self.way.height([x, y], z))
    }
}

/// Size of a cell in metres, of the longer side, which allows the higher steps.
fn cell_m(place: Placement, way: &Way) -> f64 {
    let longer = crate::base::math::larger(place.cell[0], place.cell[1]);
    longer * way.plan_unit_m().unwrap_or(DEGREE_M)
}
