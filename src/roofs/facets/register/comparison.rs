//! Each footprint compared with the roofs of the model.

use nalgebra::Vector3;
use serde::Serialize;

use super::{MOST_SHIFT_M, RegisterEvidence};
use crate::base::error::listed;
use crate::base::math::larger;
use crate::orienting::known::{Footprint, KnownComparison, KnownShift, KnownThing, KnownVerdict};
use crate::roofs::model::Facet;

/// What became of a register.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct RegisterTrace {
    /// As a whole.
    pub compared: KnownComparison,
    /// Its footprints in the window, in the order of the file.
    pub footprints: Vec<FootprintFinding>,
}

/// A footprint compared with the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FootprintFinding {
    /// Its name in the register.
    pub name: String,
    /// What the images say of it.
    pub verdict: FootprintVerdict,
    /// South-western and north-eastern corner of its bounding box as it is in the file, metres,
    /// local frame.
    pub bounds_m: [[f64; 2]; 2],
    /// Share of its area under the roofs of the model, 0 to 1.
    pub roofed: f64,
    /// From the footprint as it is in the file to the model, east and north, metres; absent where
    /// too little of it is roofed to tell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shift_m: Option<[f64; 2]>,
}

/// What the images say of a footprint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
pub enum FootprintVerdict {
    /// A roof stands there.
    Agrees,
    /// A roof stands beside it.
    Shifted,
    /// The images show the ground there.
    Contradicted,
    /// Neither a roof nor the ground is shown.
    NothingFound,
}

impl RegisterTrace {
    /// What the user should know: what the images contradict.
    pub fn warnings(&self) -> Vec<String> {
        let file = &self.compared.file;
        let named = |verdict: FootprintVerdict| -> Vec<&str> {
            let of_it = self.footprints.iter().filter(|f| f.verdict == verdict);
            of_it.map(|f| &*f.name).collect()
        };
        let as_a_whole = self.compared.warning(KnownThing::Footprints);
        let mut warnings: Vec<String> = as_a_whole.into_iter().collect();
        if self.compared.verdict == KnownVerdict::Contradicted {
            return warnings;
        }
        for (verdict, what) in [
            (
                FootprintVerdict::Contradicted,
                "the images show ground on the footprint",
            ),
            (
                FootprintVerdict::NothingFound,
                "no roof was found on the footprint",
            ),
        ] {
            let names = named(verdict);
            if !names.is_empty() {
                let plural = if names.len() > 1 { "s" } else { "" };
                warnings.push(format!("{what}{plural} {} of {file}", listed(&names)));
            }
        }
        warnings
    }
}

/// Least share of a footprint under roofs that is one building with it.
const ROOFED: f64 = 0.5;
/// Least share of a footprint within the window to say anything of it.
const SHOWN: f64 = 0.8;
/// A shift of so many standard deviations of a border is named.
const SIGMAS: f64 = 1.5;
/// Nats for the ground, for each independent part, from which on the images contradict a roof:
/// odds of twenty to one.
const CLEAR: f64 = 3.0;

impl RegisterEvidence<'_> {
    /// Compares every footprint with the facets; `ground` is what the images say of the ground in
    /// each cell, nats.
    pub(in crate::roofs::facets) fn findings(
        &self,
        facets: &[Facet],
        ground: &[f64],
        areas: &[f64],
    ) -> RegisterTrace {
        let roofs = self.roofs(facets);
        let found = |footprint: &Footprint| self.finding(footprint, &roofs, ground, areas);
        let footprints: Vec<_> = (self.register.footprints.iter())
            .filter_map(found)
            .collect();
        let unused = KnownComparison::new(&self.register.file, self.register.accuracy_m);
        let [x, y] = self.moved.map(|n| n as f64 * self.grid.step);
        let shift = KnownShift {
            by: Vector3::new(x, y, 0.0),
            // It is the likeliest one against the accuracy already.
            explained_m: [0.0; 2],
        };
        let compared = match footprints.is_empty() {
            true => unused,
            false => unused.judged(Some(shift), self.belongs),
        };
        RegisterTrace {
            compared,
            footprints,
        }
    }

    fn finding(
        &self,
        footprint: &Footprint,
        roofs: &[bool],
        ground: &[f64],
        areas: &[f64],
    ) -> Option<FootprintFinding> {
        let around = self.around(footprint);
        let inside = self.shown_inside(footprint)?;
        let sample_m2 = self.grid.step * self.grid.step;
        let count = |of: &dyn Fn(usize) -> bool| inside.iter().filter(|k| of(**k)).count() as f64;
        let roofed = count(&|k| roofs[k]) / larger(inside.len() as f64, 1.0);
        let for_ground: f64 = (inside.iter())
            .filter_map(|&k| {
                let cell = self.cells[k] as usize;
                Some(ground.get(cell)? / larger(*areas.get(cell)?, sample_m2))
            })
            .sum();
        let per_part = for_ground / larger(inside.len() as f64, 1.0) * self.params.part_m2;
        let (verdict, shift_m) = if roofed >= ROOFED {
            let own = self.best_shift(roofs, || around.iter().copied(), self.register.accuracy_m);
            let shift = [0, 1].map(|i| (own[i] + self.moved[i]) as f64 * self.grid.step);
            let length = crate::base::math::hypot(shift[0], shift[1]);
            match length > SIGMAS * self.register.accuracy_m {
                true => (FootprintVerdict::Shifted, Some(shift)),
                false => (FootprintVerdict::Agrees, Some(shift)),
            }
        } else if per_part > CLEAR {
            (FootprintVerdict::Contradicted, None)
        } else {
            (FootprintVerdict::NothingFound, None)
        };
        Some(FootprintFinding {
            name: footprint.name.clone(),
            bounds_m: footprint.bounds().map(Into::into),
            verdict,
            roofed,
            shift_m,
        })
    }

    /// The samples inside a footprint as it is moved; `None` where the window shows too little of
    /// it to say anything.
    pub(super) fn shown_inside(&self, footprint: &Footprint) -> Option<Vec<usize>> {
        let moved = nalgebra::Vector2::from(self.moved.map(|n| n as f64 * self.grid.step));
        let place = |k: usize| self.grid.center(k % self.grid.width, k / self.grid.width);
        let inside: Vec<usize> = (self.around(footprint).into_iter())
            .filter(|&k| footprint.outline.contains(&(place(k) - moved)))
            .collect();
        let shown_m2 = inside.len() as f64 * self.grid.step * self.grid.step;
        (shown_m2 >= SHOWN * footprint.outline.signed_area()).then_some(inside)
    }

    /// The samples of a footprint as it is moved and around it.
    fn around(&self, footprint: &Footprint) -> Vec<usize> {
        let [low, high] = footprint.bounds();
        let [dx, dy] = self.moved.map(|n| n as f64 * self.grid.step);
        let range = |low: f64, high: f64, origin: f64, count: usize| {
            super::samples(
                low - MOST_SHIFT_M,
                high + MOST_SHIFT_M,
                origin,
                self.grid.step,
                count,
            )
        };
        let columns = range(low.x + dx, high.x + dx, self.grid.origin.x, self.grid.width);
        let rows = range(
            low.y + dy,
            high.y + dy,
            self.grid.origin.y,
            self.grid.height,
        );
        rows.flat_map(|r| columns.clone().map(move |c| r * self.grid.width + c))
            .collect()
    }
}
