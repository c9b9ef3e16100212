//! Corrections by hand: a model, as somebody says it should be.
//!
//! ```text
//! outcome    what became of a correction
//! draft      the model building by building, closed again after each correction
//! place      facets, buildings, corners and edges by their place in the world
//! closing    the place of a deleted facet, divided between its neighbours
//! shape      facets deleted, merged, split, added
//! drawn      the line of an edge drawn in one photograph
//! standing   what stands on facets, deleted and added
//! slope      how what lies beside it falls, by what the photographs show
//! dividing   facets divided along such a line
//! adjusting  corners, edges and slopes stated; the building is adjusted to them
//! ```
//!
//! Invariant: what is corrected fulfils the invariants of every model; a correction that would
//! break one is not applied, and says so. Invariant: one that finds no longer what it is about is
//! not applied either. Invariant: buildings that no correction is about keep their bits.

mod adjusting;
mod closing;
mod dividing;
mod draft;
mod drawn;
mod outcome;
mod place;
mod shape;
mod slope;
mod standing;
#[cfg(test)]
mod tests;

pub use outcome::{CorrectionTrace, NotApplied};

use nalgebra::{Point3, Vector3};

use self::adjusting::{Held, adjust, hold};
use self::dividing::divide;
use self::draft::Draft;
use self::drawn::Sought;
use self::slope::Beside;
use crate::base::geometry::Segment3;
use crate::base::params::{Correction, FacetPlace, Params, RefineParams};
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::roofs::model::RoofModel;

/// Corrects a model, in the order of the corrections.
pub fn correct(
    scene: &Scene,
    model: &RoofModel,
    corrections: &[Correction],
    params: &Params,
) -> (RoofModel, CorrectionTrace) {
    let mut draft = Draft::new(model);
    let mut held: Vec<Held> = Vec::new();
    let (mut outcomes, mut lines) = (Vec::new(), Vec::new());
    for correction in corrections {
        let local = in_local_frame(correction, &scene.origin);
        let mut line = None;
        let outcome = match &local {
            Correction::AddEdge {
                photograph,
                pixels,
                sigma_px,
            } => {
                let clicks = (pixels, *sigma_px);
                Sought::new(scene, &draft, photograph, clicks, params).and_then(|sought| {
                    add_edge(scene, &mut draft, &sought, &mut line, &mut held, params)
                })
            }
            _ => apply(scene, &mut draft, &local, &held, &params.roof.refine),
        };
        lines.push(line);
        if outcome.is_ok() {
            hold(&local, &mut held);
        }
        outcomes.push(outcome.err());
    }
    let (model, sources) = draft.into_model();
    let trace = CorrectionTrace {
        outcomes,
        lines,
        sources,
    };
    (model, trace)
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
        Correction::DeleteObstruction { at } => standing::delete_obstruction(draft, at),
        Correction::AddObstruction { outline, height_m } => {
            standing::add_obstruction(draft, outline, *height_m)
        }
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
        // Found in the photographs before.
        Correction::AddEdge { .. } => Err(NotApplied::NoLine),
    }
}

/// Divides what lies along the line of a drawn edge: that which other photographs show; where they
/// show none, that on the facet in which it is drawn, if beyond it one half turns to them.
fn add_edge(
    scene: &Scene,
    draft: &mut Draft,
    sought: &Sought,
    line: &mut Option<Segment3>,
    held: &mut Vec<Held>,
    params: &Params,
) -> Result<(), NotApplied> {
    let mut divided = |line: &Line3d| {
        let beside = Beside {
            scene,
            line,
            params,
        };
        let edges = divide(draft, &beside)?;
        held.extend(edges.iter().map(|ends| Held::edge(ends, line.sigma_m)));
        Ok(())
    };
    if let Some(found) = sought.matched(scene, params) {
        *line = Some(found.segment);
        return divided(&found);
    }
    let on_facet = sought.on_facet(scene).ok_or(NotApplied::NoLine)?;
    divided(&on_facet).map_err(|_: NotApplied| NotApplied::NoLine)?;
    *line = Some(on_facet.segment);
    Ok(())
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
        Correction::DeleteBuilding { building: at } | Correction::DeleteObstruction { at } => {
            point(at)
        }
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
        Correction::AddEdge { .. } => {}
        Correction::AddFacet { outline } | Correction::AddObstruction { outline, .. } => {
            outline.iter_mut().for_each(point);
        }
    }
    local
}
