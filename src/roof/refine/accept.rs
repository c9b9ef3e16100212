//! Whether a refined building may replace the old one.

use nalgebra::Point2;

use super::RefineRefusal;
use super::sight::inside;
use crate::halfplane::{PlanGrid, consistency_map};
use crate::params::RefineParams;
use crate::roof::{Facet, check_invariants, close_buildings};
use crate::scene::Scene;

/// What a refined building is measured against.
pub struct Judge<'a> {
    /// The views.
    pub scene: &'a Scene,
    /// The facets before.
    pub old: &'a [&'a Facet],
    /// Height of the ground.
    pub ground_z: f64,
    /// Parameters.
    pub params: &'a RefineParams,
}

impl Judge<'_> {
    /// The new facets if they are sound and the views agree on them as well as before.
    pub fn accept(&self, new: Vec<Facet>) -> Result<Vec<Facet>, RefineRefusal> {
        if !self.is_sound(&new) {
            return Err(RefineRefusal::Broken);
        }
        let (before, after) = self.similarities(&new);
        if after < before - self.params.similarity_loss {
            return Err(RefineRefusal::Dissimilar { before, after });
        }
        Ok(new)
    }

    /// Do the facets close to one solid without anything cut, dropped or folded?
    fn is_sound(&self, new: &[Facet]) -> bool {
        let finite = |f: &Facet| {
            f.outer
                .iter()
                .all(|p| p.coords.iter().all(|c| c.is_finite()))
        };
        if !new.iter().all(finite) {
            return false;
        }
        let (model, trace) = close_buildings(new, |_| self.ground_z);
        // Where the old outline had a facet in parts, the new one may; a facet that grows by half is another one.
        let area = |f: &Facet| plan_area(f).abs();
        trace.rejected.is_empty()
            && model.buildings.len() == 1
            && model.facets.len() == new.len()
            && (model.facets.iter().zip(new)).all(|(m, f)| (area(m) - area(f)).abs() < 0.01)
            && (new.iter().zip(self.old)).all(|(n, o)| {
                let ratio = plan_area(n) / plan_area(o);
                (0.5..=2.0).contains(&ratio)
            })
            && check_invariants(&model).is_empty()
    }

    /// Mean correlation of the views inside the old and inside the new facets, weighted by texture. Facets that moved by
    /// less than a fraction of a pixel are not compared.
    fn similarities(&self, new: &[Facet]) -> (f64, f64) {
        let (mut before, mut after) = ([0.0; 2], [0.0; 2]);
        for (o, n) in self.old.iter().zip(new) {
            let Some(step) = self.step(o) else { continue };
            if !moved(o, n, 0.25 * step) {
                continue;
            }
            for (sums, facet) in [(&mut before, *o), (&mut after, n)] {
                let [weight, correlation] = self.agreement(facet, step);
                sums[0] += weight;
                sums[1] += correlation;
            }
        }
        let mean = |[weight, sum]: [f64; 2]| if weight > 0.0 { sum / weight } else { 0.0 };
        (mean(before), mean(after))
    }

    /// Size of a pixel on the facet.
    fn step(&self, facet: &Facet) -> Option<f64> {
        let at = facet.outer.first()?;
        let pixels = self.scene.views.iter().map(|v| v.camera.ground_pixel(at));
        Some(pixels.fold(f64::INFINITY, f64::min))
    }

    /// Sums of weight and of weight times correlation inside a facet.
    fn agreement(&self, facet: &Facet, step: f64) -> [f64; 2] {
        let start = [
            Point2::new(f64::MAX, f64::MAX),
            Point2::new(f64::MIN, f64::MIN),
        ];
        let [low, high] = (facet.outer.iter()).fold(start, |[low, high], p| {
            [low.inf(&p.xy()), high.sup(&p.xy())]
        });
        let grid = PlanGrid::covering(low, high, step);
        let map = consistency_map(self.scene, &facet.plane, &grid);
        let mut sums = [0.0; 2];
        for k in 0..grid.width * grid.height {
            let weight = f64::from(map.weight(k));
            if weight == 0.0 {
                continue;
            }
            let p = grid.center(k % grid.width, k / grid.width);
            if inside(&facet.outer, &p) && !facet.holes.iter().any(|h| inside(h, &p)) {
                sums[0] += weight;
                sums[1] += weight * f64::from(map.correlation(k));
            }
        }
        sums
    }
}

/// Plan area of a facet, m^2.
fn plan_area(facet: &Facet) -> f64 {
    let doubled = |ring: &[nalgebra::Point3<f64>]| {
        let next = ring.iter().cycle().skip(1);
        let origin = ring.first().map_or(Point2::origin(), |p| p.xy());
        ring.iter()
            .zip(next)
            .map(|(a, b)| (a.xy() - origin).perp(&(b.xy() - origin)))
            .sum::<f64>()
    };
    0.5 * (doubled(&facet.outer) + facet.holes.iter().map(|h| doubled(h)).sum::<f64>())
}

/// Did any corner move by more than this, metres?
fn moved(old: &Facet, new: &Facet, least_m: f64) -> bool {
    old.outer.len() != new.outer.len()
        || (old.outer.iter().zip(&new.outer)).any(|(p, q)| (p - q).norm() > least_m)
}
