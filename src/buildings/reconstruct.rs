//! Method "lines": from 3D lines and half-planes to a roof model (B99 4.2, 4.3, figure 24).

use serde::Serialize;

use super::refine::{Parting, RefineTrace, part_roofs, refine_roofs};
use crate::facets::FacetInput;
use crate::facets::{FacetTrace, reconstruct_facets};
use crate::ids::LineId;
use crate::lines3d::{Line3d, Refutation};
use crate::model::{Facet, RoofModel};
use crate::params::RoofParams;
use crate::scene::Scene;
use crate::solids::{SolidTrace, close_buildings};

/// What happened on the way from half-planes to buildings.
#[derive(Clone, Debug, Default, Serialize)]
pub struct RoofTrace {
    /// Grouping, delineation and verification.
    pub facets: FacetTrace,
    /// Gaps between facets that delineation had closed.
    pub partings: Vec<Parting>,
    /// The facets that refinement was given.
    pub unrefined: Unrefined,
    /// What was regularised and refined in each building.
    pub refinement: RefineTrace,
    /// Walls and ground.
    pub solids: SolidTrace,
    /// Lines that the model adds to the matched ones (B99 4.2, 4.3).
    pub new_lines: Vec<Line3d>,
    /// Of the lines before and the new ones, counted on: those that the model refutes.
    pub refuted_lines: Vec<(LineId, Refutation)>,
}

/// The facets before refinement, whose buildings are those of [`RefineTrace`].
#[derive(Clone, Debug, Default, Serialize)]
pub struct Unrefined {
    /// Closed and parted, not refined.
    pub facets: Vec<Facet>,
    /// For every facet of the model which of these it was.
    pub sources: Vec<usize>,
}

/// Groups, delineates and verifies facets, refines the buildings and closes the solids.
pub fn reconstruct_roofs(
    scene: &Scene,
    evidence: &FacetInput,
    params: &RoofParams,
) -> (RoofModel, RoofTrace) {
    let FacetInput { lines, ground, .. } = *evidence;
    let (facets, facet_trace) = reconstruct_facets(scene, evidence, params);
    let below = |members: &[&Facet]| ground.below(members);
    // Refinement needs facets that share vertices, and moves them; so the solids are made again.
    let (delineated, solids) = close_buildings(&facets, below);
    let (parted, partings) = part_roofs(scene, &delineated, &params.refine);
    let (delineated, again) = close_buildings(&parted, below);
    let (refined, refinement) = refine_roofs(scene, lines, &delineated, &params.refine);
    let (model, closed) = close_buildings(&refined, below);
    let unrefined = Unrefined {
        facets: delineated.facets,
        sources: closed.sources.clone(),
    };
    let solids = solids.then(again).then(closed);
    (
        model,
        RoofTrace {
            facets: facet_trace,
            partings,
            unrefined,
            refinement,
            solids,
            new_lines: Vec::new(),
            refuted_lines: Vec::new(),
        },
    )
}
