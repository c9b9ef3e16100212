//! What the views say of the area between two ways.

use std::ops::Range;

use nalgebra::{Point2, Vector2};

use super::energy::OutlineEnergy;
use super::rings::{Chain, Rings};
use crate::base::geometry::{bounds, crossing, sides};
use crate::planes::photoconsistency::PlanGrid;

/// Samples are so far apart, metres.
const SAMPLE_SPACING_M: f64 = 0.2;
/// How far outlines may grow beyond all of them, metres: their sides are not longer, mostly.
const MARGIN_M: f64 = 5.0;
/// No facet covers a sample.
const NO_OWNER: u32 = u32::MAX;

/// Samples of the plan, with the facet that covers each.
pub(super) struct PlanArea<'a> {
    energy: &'a OutlineEnergy<'a>,
    /// The plane of each facet.
    labels: Vec<u32>,
    grid: PlanGrid,
    /// The cell at each sample.
    cells: Vec<u32>,
    /// The facet at each sample.
    owners: Vec<u32>,
}

impl<'a> PlanArea<'a> {
    /// `None` where there are no rings.
    pub(super) fn new(
        energy: &'a OutlineEnergy<'a>,
        labels: Vec<u32>,
        rings: &Rings,
    ) -> Option<Self> {
        let used = rings.rings.iter().flat_map(|r| &r.vertices);
        let [low, high] = bounds(used.map(|&v| rings.vertices[v]));
        (low.x < high.x).then_some(())?;
        let margin = Vector2::repeat(MARGIN_M);
        let grid = PlanGrid::covering(low - margin, high + margin, SAMPLE_SPACING_M);
        let facets = labels.len();
        let mut area = Self {
            energy,
            labels,
            cells: energy.arrangement.raster(&grid),
            owners: vec![NO_OWNER; grid.width * grid.height],
            grid,
        };
        for facet in 0..facets {
            let of_facet = rings.rings.iter().filter(|r| r.facet == facet);
            let outline: Vec<Vec<Point2<f64>>> = of_facet
                .map(|r| r.vertices.iter().map(|&v| rings.vertices[v]).collect())
                .collect();
            for samples in area.inside(&outline) {
                area.owners[samples].fill(facet as u32);
            }
        }
        Some(area)
    }

    /// The plane of a facet.
    pub(super) fn label(&self, facet: usize) -> u32 {
        self.labels[facet]
    }

    /// The samples inside an odd number of rings, as stretches of rows.
    pub(super) fn inside(&self, rings: &[Vec<Point2<f64>>]) -> Vec<Range<usize>> {
        let grid = &self.grid;
        let index = |x: f64, axis: usize| (x - grid.origin[axis]) / grid.step - 0.5;
        let [low, high] = bounds(rings.iter().flatten().copied());
        let rows = index(low.y, 1).ceil().max(0.0)..index(high.y, 1).min(grid.height as f64);
        let mut samples = Vec::new();
        for row in rows.start as usize..rows.end.ceil().max(0.0) as usize {
            let y = grid.center(0, row).y;
            let crossings =
                (rings.iter().flat_map(|ring| sides(ring))).filter_map(|side| crossing(side, y));
            let mut at: Vec<f64> = crossings.map(|x| index(x, 0)).collect();
            at.sort_by(f64::total_cmp);
            for pair in at.chunks_exact(2) {
                let first = pair[0].ceil().max(0.0) as usize;
                let end = (pair[1].floor() + 1.0).clamp(0.0, grid.width as f64) as usize;
                if first < end {
                    samples.push(row * grid.width + first..row * grid.width + end);
                }
            }
        }
        samples
    }

    /// May outlines within two boxes have samples in common?
    pub(super) fn have_samples_in_common(
        &self,
        [a, b]: &[Point2<f64>; 2],
        [c, d]: &[Point2<f64>; 2],
    ) -> bool {
        let step = self.grid.step;
        (0..2).all(|i| a[i] <= d[i] + step && c[i] <= b[i] + step)
    }

    /// By how much the evidence of the views grows, nats, where samples go to the other side of a
    /// chain; `None` where a third facet covers one, or its new facet's plane may not.
    pub(super) fn gain(&self, chain: &Chain, samples: &[Range<usize>]) -> Option<f64> {
        let (mut gain, mut of_one) = (0.0, 0.0);
        // Samples one after the other mostly lie in one cell and one facet.
        let mut at = None;
        for samples in samples {
            for (cell, owner) in
                (self.cells[samples.clone()].iter()).zip(&self.owners[samples.clone()])
            {
                if at != Some((*cell, *owner)) {
                    at = Some((*cell, *owner));
                    of_one = self.gain_of_one(chain, *cell, *owner)?;
                }
                gain += of_one;
            }
        }
        Some(gain * self.grid.step * self.grid.step)
    }

    /// The gain of one sample, nats a square metre.
    fn gain_of_one(&self, chain: &Chain, cell: u32, owner: u32) -> Option<f64> {
        let (from, to) = sides_of(chain, owner)?;
        // What a facet loses it may have covered for its neighbours' sake alone.
        let before = from.map_or(0.0, |f| self.cost(cell, f).unwrap_or(0.0));
        let after = match to {
            Some(facet) => self.cost(cell, facet)?,
            None => 0.0,
        };
        Some(before - after)
    }

    /// Gives samples to the other side of a chain.
    pub(super) fn change_hands(&mut self, chain: &Chain, samples: &[Range<usize>]) {
        for owner in samples.iter().flat_map(|s| s.clone()) {
            let owner = &mut self.owners[owner];
            if let Some((_, to)) = sides_of(chain, *owner) {
                *owner = to.map_or(NO_OWNER, |facet| facet as u32);
            }
        }
    }

    /// What a facet's plane costs in a cell, nats a square metre; `None` where it may not be.
    fn cost(&self, cell: u32, facet: usize) -> Option<f64> {
        (cell != u32::MAX).then_some(())?;
        let cost = (self.energy.cost)(cell as usize, self.labels[facet])?;
        Some(cost / self.energy.arrangement.areas[cell as usize])
    }
}

/// The facet, or none, that a sample beside a chain belongs to, and the one beyond the chain.
fn sides_of(chain: &Chain, owner: u32) -> Option<(Option<usize>, Option<usize>)> {
    let owner = (owner != NO_OWNER).then_some(owner as usize);
    let (left, right) = (Some(chain.left), chain.right);
    match owner {
        o if o == left => Some((left, right)),
        o if o == right => Some((right, left)),
        _ => None,
    }
}
