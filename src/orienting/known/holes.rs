//! Cells of a raster of heights that hold no ground: fillers that no tag names.
//!
//! Programs write 0 (gdalwarp without a value for none), -1, 255 or the least number there is
//! where nothing is known. Ground does not stand on or below walls all around, so cells are parts
//! that hang together by steps that ground has. The largest part that is no filler is the ground.
//! Another one is a hole where it
//!
//! ```text
//! repeats one whole number, which ground with fractions does not, beside a step all around that
//!     no accuracy explains (the shore of water that was made level has none)
//! lies out of reach of the ground's heights, or in a pit of walls
//! rims another hole, as what was interpolated between filler and ground
//! ```

use std::collections::VecDeque;

/// Standard deviation of the heights of a terrain model where none is stated, metres. Assumption:
/// surveys promise 0.15 to 0.3 m for models from airborne laser scanning.
pub const TERRAIN_ACCURACY_M: f64 = 0.3;

/// Rise of ground over a cell, metres a metre (80 degrees). Assumption: steeper ground is rock,
/// which has a gentler side.
const STEEPEST_SLOPE: f32 = 5.7;
/// Nothing stands higher above the ground, metres: the tallest roof that is looked for.
const TALLEST_ROOF_HEIGHT_M: f32 = 60.0;
/// So many cells beside a hole an interpolation reaches: a cubic one takes two on each side.
const RIM: u8 = 2;

/// A part of a raster that hangs together.
#[derive(Clone)]
struct Part {
    cells: usize,
    low: f32,
    high: f32,
    /// The least step to other parts; whether all of them lead up.
    least_step: f32,
    is_below: bool,
    /// Cells within reach of an interpolation across a hole.
    rim: usize,
    is_hole: bool,
}

impl Part {
    const NONE: Self = Self {
        cells: 0,
        low: f32::INFINITY,
        high: f32::NEG_INFINITY,
        least_step: f32::INFINITY,
        is_below: true,
        rim: 0,
        is_hole: false,
    };

    fn add(&mut self, z: f32) {
        self.cells += 1;
        (self.low, self.high) = (self.low.min(z), self.high.max(z));
    }

    fn step(&mut self, rise: f32) {
        self.least_step = self.least_step.min(rise.abs());
        self.is_below &= rise > 0.0;
    }

    /// Is there another part beside it, and none without a step as high as this?
    fn is_beyond(&self, step: f32) -> bool {
        self.least_step > step && self.least_step < f32::INFINITY
    }
}

/// A raster whose cells hang together where they are alike.
struct Raster<'a> {
    heights: &'a [f32],
    columns: usize,
    /// The highest step of ground over a cell, metres.
    step: f32,
    has_fractions: bool,
}

/// Takes out what is no ground, rows of cells of this size in metres; returns the number of cells.
pub(super) fn take_out(heights: &mut [f32], columns: usize, cell_m: f64) -> usize {
    let step = STEEPEST_SLOPE * cell_m as f32;
    let raster = Raster {
        heights,
        columns,
        step,
        has_fractions: heights.iter().any(|z| !z.is_nan() && z.fract() != 0.0),
    };
    if raster.hangs_together() {
        return 0;
    }
    let (of_cell, mut parts) = raster.parts();
    let has_fractions = raster.has_fractions;
    let is_filler = |part: &Part| has_fractions && part.low == part.high && part.low.fract() == 0.0;
    let size = |i: &usize| {
        if is_filler(&parts[*i]) {
            0
        } else {
            parts[*i].cells
        }
    };
    // Of equal ones the first.
    let ground = (1..parts.len()).rev().max_by_key(size).unwrap_or(0);
    let (low, high) = (
        parts[ground].low - step,
        parts[ground].high + TALLEST_ROOF_HEIGHT_M,
    );
    // Smaller steps all around are the ground's own: three standard deviations of the heights.
    let explained = 3.0 * TERRAIN_ACCURACY_M as f32;
    for (i, part) in parts.iter_mut().enumerate().skip(1) {
        let is_off = part.high < low || part.low > high;
        let is_pit = part.is_below && part.is_beyond(step);
        let is_filled = is_filler(part) && part.least_step > explained;
        part.is_hole = i != ground && (is_off || is_pit || is_filled);
    }
    mark_rims(&of_cell, &mut parts, columns);
    for (i, part) in parts.iter_mut().enumerate().skip(1) {
        part.is_hole |= i != ground && part.rim == part.cells && part.is_beyond(step);
    }
    let mut holes = 0;
    for (z, part) in heights.iter_mut().zip(&of_cell) {
        if parts[*part as usize].is_hole {
            *z = f32::NAN;
            holes += 1;
        }
    }
    holes
}

impl Raster<'_> {
    fn beside(&self, k: usize) -> impl Iterator<Item = usize> {
        beside(k, self.columns, self.heights.len())
    }

    /// Is a cell's height a whole number that a neighbour repeats, in a model of fractions?
    fn is_repeated(&self, k: usize) -> bool {
        let z = self.heights[k];
        let is_whole = self.has_fractions && z.fract() == 0.0;
        is_whole && self.beside(k).any(|other| self.heights[other] == z)
    }

    /// Do neighbours with heights not hang together?
    fn is_step(&self, k: usize, other: usize) -> bool {
        let rise = (self.heights[other] - self.heights[k]).abs();
        rise > self.step || rise > 0.0 && self.is_repeated(k) != self.is_repeated(other)
    }

    fn hangs_together(&self) -> bool {
        let cells = 0..self.heights.len();
        !cells
            .into_iter()
            .any(|k| self.beside(k).any(|other| self.is_step(k, other)))
    }

    /// The part of every cell, and the parts; the first one is of cells without a height.
    fn parts(&self) -> (Vec<u32>, Vec<Part>) {
        let mut of_cell = vec![0; self.heights.len()];
        let mut parts = vec![Part::NONE];
        let mut open = VecDeque::new();
        for first in 0..self.heights.len() {
            if of_cell[first] != 0 || self.heights[first].is_nan() {
                continue;
            }
            let number = parts.len() as u32;
            let mut part = Part::NONE;
            of_cell[first] = number;
            open.push_back(first);
            while let Some(k) = open.pop_front() {
                let z = self.heights[k];
                part.add(z);
                for other in self
                    .beside(k)
                    .filter(|&other| !self.heights[other].is_nan())
                {
                    if self.is_step(k, other) {
                        part.step(self.heights[other] - z);
                    } else if of_cell[other] == 0 {
                        of_cell[other] = number;
                        open.push_back(other);
                    }
                }
            }
            parts.push(part);
        }
        (of_cell, parts)
    }
}

/// The cells beside one in its row and its column.
fn beside(k: usize, columns: usize, cells: usize) -> impl Iterator<Item = usize> {
    let column = k % columns;
    [
        (column > 0).then(|| k - 1),
        (column + 1 < columns).then_some(k + 1),
        k.checked_sub(columns),
        Some(k + columns).filter(|&below| below < cells),
    ]
    .into_iter()
    .flatten()
}

/// Counts the cells of every part that lie at the rim of a hole.
fn mark_rims(of_cell: &[u32], parts: &mut [Part], columns: usize) {
    let is_hole = |part: u32| parts[part as usize].is_hole;
    let mut away: Vec<u8> = (of_cell.iter())
        .map(|&part| if is_hole(part) { 0 } else { u8::MAX })
        .collect();
    for reach in 1..=RIM {
        let near: Vec<usize> = (0..away.len())
            .filter(|&k| away[k] == u8::MAX)
            .filter(|&k| beside(k, columns, away.len()).any(|other| away[other] == reach - 1))
            .collect();
        near.into_iter().for_each(|k| away[k] = reach);
    }
    for (part, away) in of_cell.iter().zip(&away) {
        if *away != u8::MAX {
            parts[*part as usize].rim += 1;
        }
    }
}
