//! Whether a refined building may replace the old one: it has to close to a solid without a broken
//! invariant, and the views have to agree inside its facets as well as before.

use serde::Serialize;

use crate::base::ids::FacetId;
use crate::base::params::RefineParams;
use crate::orienting::scene::Scene;
use crate::planes::photoconsistency::{PlanGrid, consistency_map};
use crate::roofs::model::{Facet, Violation, check_invariants};
use crate::roofs::solids::close_buildings;

/// Why a building is not adjusted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case", tag = "reason")]
pub enum RefineRejection {
    /// More unknowns than are adjusted at once.
    TooLarge {
        /// Number of unknowns.
        unknowns: usize,
    },
    /// Too few of its sides show in the images.
    FewObservations {
        /// Measured edges.
        observations: usize,
    },
    /// The adjustment has no solution.
    Singular,
    /// The reprojection error does not fall.
    NoGain,
    /// The new outlines fold, cross, or do not close.
    Broken,
    /// The views agree less inside the new facets.
    Dissimilar {
        /// Mean correlation inside the facets before.
        before: f64,
        /// ... and after.
        after: f64,
    },
}

/// The facets that a refined building would replace, and what is needed to compare both.
pub(super) struct AcceptanceTest<'a> {
    /// The views.
    pub scene: &'a Scene,
    /// The facets before.
    pub old: &'a [&'a Facet],
    /// Height of the ground.
    pub ground_z: f64,
    /// Parameters.
    pub params: &'a RefineParams,
}

impl AcceptanceTest<'_> {
    /// The new facets if they are sound and the views agree on them as well as before; otherwise
    /// why not, and which of them are the cause.
    pub(super) fn accept(
        &self,
        new: Vec<Facet>,
    ) -> Result<Vec<Facet>, (RefineRejection, Vec<usize>)> {
        let broken = self.broken(&new);
        if !broken.is_empty() {
            return Err((RefineRejection::Broken, broken));
        }
        let [before, after, worse] = self.similarities(&new);
        let mean = |sums: &[[f64; 2]]| {
            let weight: f64 = sums.iter().map(|s| s[0]).sum();
            let sum: f64 = sums.iter().map(|s| s[1]).sum();
            if weight > 0.0 { sum / weight } else { 0.0 }
        };
        let (b, a) = (mean(&before), mean(&after));
        if a < b - self.params.similarity_loss {
            let lost = |i: &usize| worse[*i][0] > 0.0;
            let offending = (0..new.len()).filter(lost).collect();
            let (before, after) = (b, a);
            return Err((RefineRejection::Dissimilar { before, after }, offending));
        }
        Ok(new)
    }

    /// The facets that keep the new ones from closing to one solid with nothing cut, dropped or
    /// folded; none when they do.
    fn broken(&self, new: &[Facet]) -> Vec<usize> {
        let finite = |f: &Facet| {
            f.outer
                .iter()
                .all(|p| p.coords.iter().all(|c| c.is_finite()))
        };
        let all = || (0..new.len()).collect();
        if !new.iter().all(finite) {
            return all();
        }
        let (model, trace) = close_buildings(new, |_| self.ground_z);
        let mut closed = vec![0.0; new.len()];
        for (facet, &source) in model.facets.iter().zip(&trace.sources) {
            closed[source] += facet.plan().signed_area();
        }
        // A facet that overlaps its neighbour or itself is cut; one that doubles is another one.
        let is_cut = |&i: &usize| {
            let [area, old] = [&new[i], self.old[i]].map(|f| f.plan().signed_area());
            (closed[i] - area).abs() > 0.01 || area < 0.5 * old || area > 2.0 * old
        };
        let cut: Vec<usize> = (0..new.len()).filter(is_cut).collect();
        if !cut.is_empty() {
            return cut;
        }
        let violations = check_invariants(&model);
        if trace.rejected.is_empty() && violations.is_empty() {
            return cut;
        }
        // Some name facets; where none does, it may be any.
        let mut named: Vec<usize> = violations
            .iter()
            .flat_map(facets_of)
            .map(|f| trace.sources[f.index()])
            .chain(trace.rejected.iter().map(|r| r.0))
            .collect();
        named.sort_unstable();
        named.dedup();
        if named.is_empty() { all() } else { named }
    }

    /// Per facet (weight, weight x mean correlation) of the views inside, before and after, and
    /// whether that fell by more than its error. Facets that moved by less than a fraction of a
    /// pixel are not compared.
    fn similarities(&self, new: &[Facet]) -> [Vec<[f64; 2]>; 3] {
        let compared = crate::base::execution::map(new, |i, n| {
            let o = self.old[i];
            let pixel = self.pixel(o).filter(|pixel| moved(o, n, 0.25 * pixel))?;
            Some([self.agreement(o, pixel), self.agreement(n, pixel)])
        });
        let mut sums = [(); 3].map(|()| vec![[0.0; 2]; new.len()]);
        for (i, pair) in compared.into_iter().enumerate() {
            let Some([before, after]) = pair else {
                continue;
            };
            let [mean, new_mean] =
                [before, after].map(|[weight, sum]| sum / weight.max(f64::MIN_POSITIVE));
            let lost = mean - new_mean > self.params.similarity_loss;
            (sums[0][i], sums[1][i]) = (before, after);
            sums[2][i][0] = f64::from(u8::from(lost));
        }
        sums
    }

    /// Size of a pixel on the facet, metres.
    fn pixel(&self, facet: &Facet) -> Option<f64> {
        let at = facet.outer.first()?;
        let pixels = self.scene.views.iter().map(|v| v.camera.ground_pixel(at));
        Some(pixels.fold(f64::INFINITY, f64::min))
    }

    /// Sums of weight and of weight times correlation inside a facet.
    fn agreement(&self, facet: &Facet, pixel: f64) -> [f64; 2] {
        let [low, high] = facet.plan_bounds();
        let grid = PlanGrid::covering(low, high, PlanGrid::cell_of_pixels(pixel));
        let map = consistency_map(self.scene, &facet.plane, &grid);
        let mut sums = [0.0; 2];
        for k in 0..grid.width * grid.height {
            let weight = f64::from(map.weight(k));
            if weight == 0.0 {
                continue;
            }
            let p = grid.center(k % grid.width, k / grid.width);
            if facet.covers(&p) {
                sums[0] += weight;
                sums[1] += weight * f64::from(map.correlation(k));
            }
        }
        sums
    }
}

/// The facets that a violation is about.
fn facets_of(violation: &Violation) -> Vec<FacetId> {
    match violation {
        Violation::FacetPlane { facet }
        | Violation::FacetNotPlanar { facet, .. }
        | Violation::FacetRingNotSimple { facet, .. }
        | Violation::FacetRingOrientation { facet, .. } => vec![*facet],
        Violation::FacetsOverlap { first, second, .. } => vec![*first, *second],
        _ => Vec::new(),
    }
}

/// Did any corner move by more than this, metres?
fn moved(old: &Facet, new: &Facet, least_m: f64) -> bool {
    old.outer.len() != new.outer.len()
        || (old.outer.iter().zip(&new.outer)).any(|(p, q)| (p - q).norm() > least_m)
}
