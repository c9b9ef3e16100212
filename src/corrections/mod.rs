//! Corrections by hand: a model, as somebody says it should be.
//!
//! ```text
//! outcome    what became of a correction
//! draft      the model building by building, closed again after each correction
//! place      facets, buildings, corners and edges by their place in the world
//! plan       regions of the plan: intersection, difference, union
//! closing    the place of a deleted facet, divided between its neighbours
//! shape      facets deleted, merged, split, added
//! adjusting  corners, edges and slopes stated; the building is adjusted to them
//! ```
//!
//! Invariant: what is corrected fulfils the invariants of every model; a correction that would
//! break one is not applied, and says so. Invariant: one that finds no longer what it is about is
//! not applied either. Invariant: buildings that no correction is about keep their bits.

mod adjusting;
mod closing;
mod draft;
mod outcome;
mod place;
mod plan;
mod shape;
#[cfg(test)]
mod tests;

pub use outcome::{CorrectionTrace, NotApplied};

use nalgebra::{Point3, Vector3};

use self::adjusting::{Held, adjust, hold};
use self::draft::Draft;
use crate::model::RoofModel;
use crate::params::{Correction, FacetPlace, RefineParams};
use crate::scene::Scene;

/// Corrects a model, in the order of the corrections.
pub fn correct(
    scene: &Scene,
    model: &RoofModel,
    corrections: &[Correction],
    params: &RefineParams,
) -> (RoofModel, CorrectionTrace) {
    let mut draft = Draft::new(model);
    let mut held: Vec<Held> = Vec::new();
    let mut outcomes = Vec::new();
    for correction in corrections {
        let local = in_local_frame(correction, &scene.origin);
        let outcome = apply(scene, &mut draft, &local, &held, params);
        if outcome.is_ok() {
            hold(&local, &mut held);
        }
        outcomes.push(outcome.err());
    }
    let (model, sources) = draft.into_model();
    (model, CorrectionTrace { outcomes, sources })
}

fn apply(
    scene: &Scene,
    draft: &mut Draft,
    correction: &Correction,
    held: &[Held],
    params: &RefineParams,
) -> Result<(), NotApplied> {
    match correction {
        Correction::DeleteFacet { facet, filled } => shape::delete_facet(draft, facet, *filled),
        Correction::DeleteBuilding { building } => shape::delete_building(draft, building),
        Correction::Confirm { facet } => {
            let at = draft.facet(facet)?;
            draft.facet_mut(at).probability = 1.0;
            Ok(())
        }
        Correction::SetGround { building, height } => shape::set_ground(draft, building, *height),
        Correction::SetEave { building, height } => shape::set_eave(draft, building, *height),
        Correction::Merge { facet, with } => shape::merge(draft, facet, with),
        Correction::Split { facet, along } => shape::split(draft, facet, along),
        Correction::AddFacet { outline } => shape::add_facet(draft, outline, scene.ground_z),
        Correction::Mirror { facet, over } => shape::mirror(draft, facet, over),
        Correction::MoveCorner { .. }
        | Correction::MoveEdge { .. }
        | Correction::SetParallel { .. }
        | Correction::SetLevel { .. }
        | Correction::SetSlope { .. }
        | Correction::SetSymmetric { .. } => adjust(scene, draft, correction, held, params),
    }
}

/// The same correction with its places in the frame of the scene.
fn in_local_frame(correction: &Correction, origin: &Vector3<f64>) -> Correction {
    let mut local = correction.clone();
    let point = |p: &mut Point3<f64>| *p -= origin;
    let place = |f: &mut FacetPlace| f.at -= origin;
    match &mut local {
        Correction::DeleteFacet { facet, .. }
        | Correction::Confirm { facet }
        | Correction::SetLevel { facet }
        | Correction::SetSlope { facet, .. } => place(facet),
        Correction::DeleteBuilding { building } => point(building),
        Correction::SetGround { building, height } | Correction::SetEave { building, height } => {
            point(building);
            *height -= origin.z;
        }
        Correction::MoveCorner { from, to, .. } => [from, to].into_iter().for_each(point),
        Correction::MoveEdge { from, to, .. } | Correction::SetParallel { edge: from, to } => {
            from.iter_mut().chain(to).for_each(point);
        }
        Correction::SetSymmetric { facets } => facets.iter_mut().for_each(place),
        Correction::Merge { facet, with } => [facet, with].into_iter().for_each(place),
        Correction::Split { facet, along } | Correction::Mirror { facet, over: along } => {
            place(facet);
            along.iter_mut().for_each(point);
        }
        Correction::AddFacet { outline } => outline.iter_mut().for_each(point),
    }
    local
}
