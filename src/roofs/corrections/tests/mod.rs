//! Mistakes planted in models, and corrected.

mod adjusted;
mod drawn;
mod facets;
mod lists;

use nalgebra::{Point3, Vector3};

use super::*;
use crate::base::geometry::{mean_point, sides};
use crate::base::params::Params;
use crate::orienting::synthetic::gable_scene;
use crate::roofs::buildings::gable;
use crate::roofs::model::{Facet, check_invariants};
use crate::roofs::solids::close_buildings;
use crate::roofs::testing::facet;

/// The world's origin of the scene.
const ORIGIN: [f64; 3] = [500_000.0, 5_400_000.0, 250.0];
const GROUND_Z: f64 = 1.0;

fn closed(facets: &[Facet]) -> RoofModel {
    let (model, trace) = close_buildings(facets, |_| GROUND_Z);
    assert_eq!(trace.rejected, []);
    model
}

fn roof(rings: &[&[[f64; 3]]]) -> RoofModel {
    let ring = |ring: &&[[f64; 3]]| ring.iter().map(|&p| Point3::from(p)).collect::<Vec<_>>();
    closed(&rings.iter().map(|r| facet(&ring(r))).collect::<Vec<_>>())
}

/// A point or an edge in the world.
fn world(p: [f64; 3]) -> Point3<f64> {
    Point3::from(p) + Vector3::from(ORIGIN)
}

fn edge(ends: [[f64; 3]; 2]) -> [Point3<f64>; 2] {
    ends.map(world)
}

/// The place of a facet that covers a plan position.
fn place(model: &RoofModel, x: f64, y: f64) -> FacetPlace {
    let draft = Draft::new(model);
    let at = draft
        .facet_below(&nalgebra::Point2::new(x, y))
        .expect("a facet");
    let plane = draft.get(at).facet.plane;
    FacetPlace {
        at: plane.lift(x, y) + Vector3::from(ORIGIN),
        normal: plane.normal,
    }
}

fn corrected(model: &RoofModel, corrections: &[Correction]) -> (RoofModel, CorrectionTrace) {
    let mut scene = gable_scene(16).0;
    scene.origin = Vector3::from(ORIGIN);
    let (found, trace) = correct(&scene, model, corrections, &Params::default());
    assert_eq!(check_invariants(&found), []);
    assert_eq!(trace.outcomes.len(), corrections.len());
    assert_eq!(trace.sources.len(), found.facets.len());
    (found, trace)
}

/// The corrected model, all corrections being applied.
fn mended(model: &RoofModel, corrections: &[Correction]) -> RoofModel {
    let (found, trace) = corrected(model, corrections);
    assert_eq!(trace.outcomes, vec![None; corrections.len()]);
    found
}

fn why_not(model: &RoofModel, correction: Correction) -> NotApplied {
    let (found, trace) = corrected(model, &[correction]);
    assert_eq!(&found, model, "a refused correction changes nothing");
    trace.outcomes[0].expect("a refusal")
}

/// Every facet of the truth is found with its corners, and nothing else.
fn assert_is(found: &RoofModel, truth: &RoofModel, within_m: f64) {
    assert_eq!(found.facets.len(), truth.facets.len());
    assert_eq!(found.buildings.len(), truth.buildings.len());
    for facet in &truth.facets {
        let middle = mean_point(&facet.outer).xy();
        let own = (found.facets.iter())
            .find(|f| f.covers(&middle))
            .expect("a facet at the place");
        for (from, to) in [(facet, own), (own, facet)] {
            for p in &from.outer {
                let height = (to.plane.z_at(p.x, p.y) - p.z).abs();
                assert!(height < within_m, "{p}: {height} m too high");
                let distance = distance_m(p, &to.outer);
                assert!(distance < within_m, "{p}: {distance} m from the outline");
            }
        }
    }
}

/// Distance of a point from a ring.
fn distance_m(p: &Point3<f64>, ring: &[Point3<f64>]) -> f64 {
    let of_side = |[a, b]: [Point3<f64>; 2]| {
        let t = (p - a).dot(&(b - a)) / (b - a).norm_squared();
        (a + (b - a) * t.clamp(0.0, 1.0) - p).norm()
    };
    sides(ring).map(of_side).fold(f64::MAX, f64::min)
}

fn truth() -> RoofModel {
    closed(&gable())
}
