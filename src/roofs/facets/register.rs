//! Footprints of a register as evidence for roofs, in nats.
//!
//! A position at depth d inside a footprint (negative outside) is inside of the building with
//! probability q = Phi(d / sigma). A register that is right as often as its parameters say then
//! tells a roof from ground by
//!
//! ```text
//! L(d) = (q c + (1 - q) (1 - c)) / (q f + (1 - q) (1 - f))
//! ```
//!
//! c being its completeness and f the share of ground that it calls built on. Parts of a building
//! are drawn or left out as wholes, so L counts once for each of them, not for each square metre.
//!
//! Whether the register belongs to this place at all, and whether it is moved as a whole, is asked
//! of the roofs that the images show by themselves: w is the probability of the former, and every
//! ratio becomes w L + (1 - w). A register of another place is worth nothing then, and one with
//! another datum is moved before it is used. It decides nothing alone: clear images have thirty
//! times as many nats a square metre.

mod comparison;

pub use comparison::{FootprintFinding, FootprintVerdict, RegisterTrace};

use nalgebra::{Point2, Vector2};

use super::borders::Arrangement;
use crate::base::evidence::{EvidenceTerm, nats_where_it_belongs};
use crate::base::math::{erfc, larger, ln, normal_density, smaller};
use crate::base::params::RegisterParams;
use crate::orienting::known::{Footprint, Register, belongs_here, best_shift};
use crate::photographs::raster::mark_inside;
use crate::planes::photoconsistency::PlanGrid;
use crate::roofs::model::Facet;

/// Name of what a register says of a facet.
pub(crate) const FEATURE: &str = crate::base::evidence::INSIDE_FOOTPRINT;

/// Depths beyond this say what this one does, metres.
const REACH_M: f64 = 4.0;
/// A register is moved by at most this, metres. Assumption: more is another place.
const MOST_SHIFT_M: f64 = 3.0;

/// A register over the plan of a scene, and what it is worth there.
pub(super) struct RegisterEvidence<'a> {
    register: &'a Register,
    params: &'a RegisterParams,
    grid: PlanGrid,
    /// Cell of the arrangement of every sample; `u32::MAX` for none.
    cells: Vec<u32>,
    /// Depth of every sample in the roof over the nearest footprint, metres.
    depths: Vec<f32>,
    /// Standard deviation of a roof's border against that of the register, metres.
    sigma_m: f64,
    /// Is any footprint here?
    is_here: bool,
    /// By so much the register is moved, in whole samples and in metres.
    moved: [isize; 2],
    /// Probability that it belongs to this place.
    belongs: f64,
}

impl<'a> RegisterEvidence<'a> {
    /// Lays the register over the plan; it is worth nothing before it has been compared.
    pub(super) fn new(
        register: &'a Register,
        params: &'a RegisterParams,
        arrangement: &Arrangement,
        window: &PlanGrid,
    ) -> Self {
        let grid = window.in_samples();
        let step = grid.step;
        let mut depths = vec![-REACH_M as f32; grid.width * grid.height];
        let mut is_here = false;
        let reach = Vector2::repeat(REACH_M);
        for footprint in &register.footprints {
            let [low, high] = footprint.bounds();
            let columns = samples(
                low.x - reach.x,
                high.x + reach.x,
                grid.origin.x,
                step,
                grid.width,
            );
            let rows = samples(
                low.y - reach.y,
                high.y + reach.y,
                grid.origin.y,
                step,
                grid.height,
            );
            for row in rows {
                for column in columns.clone() {
                    let depth =
                        footprint.outline.depth(&grid.center(column, row)) + params.overhang_m;
                    let stored = &mut depths[row * grid.width + column];
                    *stored = larger(*stored, smaller(depth, REACH_M) as f32);
                    is_here |= depth > 0.0;
                }
            }
        }
        Self {
            sigma_m: crate::base::math::hypot(register.accuracy_m, params.overhang_sigma_m),
            cells: arrangement.raster(&grid),
            register,
            params,
            grid,
            depths,
            is_here,
            moved: [0, 0],
            belongs: 0.0,
        }
    }

    /// Is it worth anything here?
    pub(super) fn counts(&self) -> bool {
        self.belongs > 0.01
    }

    /// Compares the register with the roofs that the images show by themselves: by how much it is
    /// moved as a whole, and whether it belongs here.
    pub(super) fn compare(&mut self, facets: &[Facet]) {
        if !self.is_here {
            return;
        }
        let roofs = self.roofs(facets);
        let all = || 0..self.depths.len();
        self.moved = self.best_shift(&roofs, all, self.register.accuracy_m);
        let built = all().filter(|&k| self.depth(k) > 0.0).count() as f64;
        let chance = (built / all().len() as f64).clamp(0.02, 0.9);
        let (mut inside, mut outside) = (0.0, 0.0);
        for k in all().filter(|&k| roofs[k]) {
            match self.depth(k) > 0.0 {
                true => inside += self.parts(1.0),
                false => outside += self.parts(1.0),
            }
        }
        let RegisterParams {
            belongs,
            completeness,
            ..
        } = *self.params;
        self.belongs = belongs_here(belongs, [inside, outside], completeness, chance);
        // Of what lies elsewhere nothing counts: a verdict is what is done.
        let is_shown = |footprint: &Footprint| self.shown_inside(footprint).is_some();
        if !self.register.footprints.iter().any(is_shown) {
            self.belongs = 0.0;
        }
    }

    /// What it says for a roof in every cell, nats.
    pub(super) fn of_cells(&self, cells: usize) -> Vec<f64> {
        let mut nats = vec![0.0; cells];
        for (k, &cell) in self
            .cells
            .iter()
            .enumerate()
            .filter(|(_, c)| **c != u32::MAX)
        {
            nats[cell as usize] += self.parts(1.0) * self.nats(self.depth(k));
        }
        nats
    }

    /// What it says for an end of a roof along a border of the arrangement, nats: the outline of a
    /// roof is likelier where the register has one.
    pub(super) fn of_border(&self, a: &Point2<f64>, b: &Point2<f64>) -> f64 {
        let Some(k) = self.sample(&nalgebra::center(a, b)) else {
            return 0.0;
        };
        let along = (b - a).normalize();
        let across = Vector2::new(-along.y, along.x);
        // The depth changes by as much as one goes across, and not at all along it.
        let slope = |direction: Vector2<f64>| {
            let at = |by: f64| self.sample(&(nalgebra::center(a, b) + direction * by));
            let [from, to] = [at(-self.grid.step), at(self.grid.step)];
            let (Some(from), Some(to)) = (from, to) else {
                return 0.0;
            };
            (self.depth(to) - self.depth(from)) / (2.0 * self.grid.step)
        };
        if slope(across).abs() < PARALLEL {
            return 0.0;
        }
        let density = normal_density(self.depth(k), self.sigma_m);
        let ratio = larger(density * self.params.border_range_m, 1.0);
        (b - a).norm() / self.params.border_part_m * self.weighed(ratio)
    }

    /// What it says of a facet. Inside of a footprint it says that there is a roof, not which plane
    /// that has: nothing. Outside it doubts it.
    pub(super) fn of_facet(&self, facet: &Facet) -> EvidenceTerm {
        let roofs = self.roofs(std::slice::from_ref(facet));
        let covered = (0..roofs.len()).filter(|&k| roofs[k]);
        let (mut inside, mut count) = (0.0, 0.0);
        for k in covered {
            inside += self.inside(self.depth(k));
            count += 1.0;
        }
        let share = if count > 0.0 { inside / count } else { 0.5 };
        let outside = (1.0 - self.params.completeness) / self.params.outside_wrong;
        let ratio = share + (1.0 - share) * smaller(outside, 1.0);
        EvidenceTerm {
            feature: FEATURE,
            value: share,
            nats: self.weighed(ratio),
        }
    }

    /// The samples that facets cover.
    fn roofs(&self, facets: &[Facet]) -> Vec<bool> {
        let PlanGrid {
            origin,
            step,
            width,
            height,
        } = self.grid;
        let mut covered = vec![false; width * height];
        for facet in facets {
            let plan = (facet.plan()).mapped(|p| Point2::from((p - origin) / step));
            mark_inside(&plan, width, height, &mut covered);
        }
        covered
    }

    /// So many independent parts of buildings are in a number of samples.
    fn parts(&self, samples: f64) -> f64 {
        samples * self.grid.step * self.grid.step / self.params.part_m2
    }

    /// Depth of a sample in the register as it is moved, metres.
    fn depth(&self, k: usize) -> f64 {
        self.depth_moved(k, self.moved)
    }

    fn depth_moved(&self, k: usize, [dx, dy]: [isize; 2]) -> f64 {
        let column = (k % self.grid.width).checked_add_signed(-dx);
        let row = (k / self.grid.width).checked_add_signed(-dy);
        match (column, row) {
            (Some(c), Some(r)) if c < self.grid.width && r < self.grid.height => {
                f64::from(self.depths[r * self.grid.width + c])
            }
            _ => -REACH_M,
        }
    }

    /// Probability that a position at a depth is inside of the building.
    fn inside(&self, depth: f64) -> f64 {
        0.5 * erfc(-depth / (self.sigma_m * std::f64::consts::SQRT_2))
    }

    /// ln L(d) of a register that belongs here.
    fn certain_nats(&self, depth: f64) -> f64 {
        ln(self.ratio(depth))
    }

    fn nats(&self, depth: f64) -> f64 {
        self.weighed(self.ratio(depth))
    }

    fn ratio(&self, depth: f64) -> f64 {
        let q = self.inside(depth);
        let (c, f) = (self.params.completeness, self.params.built_in_error);
        (q * c + (1.0 - q) * (1.0 - c)) / (q * f + (1.0 - q) * (1.0 - f))
    }

    /// The logarithm of a ratio that holds where the register belongs here.
    fn weighed(&self, ratio: f64) -> f64 {
        nats_where_it_belongs(self.belongs, ratio)
    }

    fn sample(&self, p: &Point2<f64>) -> Option<usize> {
        let (column, row) = self.grid.cell(p)?;
        Some(row * self.grid.width + column)
    }

    /// The shift, in samples, at which the register explains best what is roof and what is not
    /// among some samples, less likely the larger it is.
    fn best_shift<I: Iterator<Item = usize>>(
        &self,
        roofs: &[bool],
        among: impl Fn() -> I,
        sigma_m: f64,
    ) -> [isize; 2] {
        let most = (MOST_SHIFT_M / self.grid.step) as isize;
        let mut shifts: Vec<[isize; 2]> = (-most..=most)
            .flat_map(|y| (-most..=most).map(move |x| [x, y]))
            .collect();
        // Of equally good ones the nearest counts.
        shifts.sort_by_key(|[x, y]| x * x + y * y);
        let table: Vec<f64> = (0..=TABLE)
            .map(|i| self.certain_nats((2.0 * i as f64 / TABLE as f64 - 1.0) * REACH_M))
            .collect();
        let nats =
            |depth: f64| table[((depth / REACH_M + 1.0) * 0.5 * TABLE as f64).round() as usize];
        let places: Vec<usize> = among().collect();
        let explained = |&[x, y]: &[isize; 2]| {
            let [of_roofs, of_all] = places.iter().fold([0.0, 0.0], |[roof, all], &k| {
                let nats = nats(self.depth_moved(k, [x + self.moved[0], y + self.moved[1]]));
                [roof + if roofs[k] { nats } else { 0.0 }, all + nats]
            });
            let away = ((x * x + y * y) as f64).sqrt() * self.grid.step / sigma_m;
            self.parts(2.0 * of_roofs - of_all) - 0.5 * away * away
        };
        best_shift(&shifts, explained).map_or([0, 0], |(shift, _)| shift)
    }
}

/// Entries of the table of nats by depth.
const TABLE: usize = 256;
/// Cosine of the angle between a border and the register's, at most: 25 degrees.
const PARALLEL: f64 = 0.9;

/// The samples of a grid between two coordinates along one axis.
fn samples(low: f64, high: f64, origin: f64, step: f64, count: usize) -> std::ops::Range<usize> {
    let at = |v: f64| ((v - origin) / step).clamp(0.0, count as f64) as usize;
    at(low)..smaller(at(high) + 1, count)
}
