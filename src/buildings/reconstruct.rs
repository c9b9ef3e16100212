//! Method "lines": from 3D lines and half-planes to a roof model (B99 4.2, 4.3, figure 24).

use serde::Serialize;

use super::model_lines::VerifiedLines;
use super::parapets::{Parapet, below_parapets};
use super::refine::{RefineTrace, RoofGap, cut_back_at_gaps, refine_roofs};
use crate::execution::Sharded;
use crate::facets::{FacetInput, FacetTrace, reconstruct_facets};
use crate::model::{Facet, RoofModel};
use crate::params::RoofParams;
use crate::scene::Scene;
use crate::solids::{SolidTrace, close_buildings};

/// The steps from half-planes to buildings.
#[derive(Clone, Debug, Default, Serialize)]
pub struct RoofTrace {
    /// Grouping, delineation and verification.
    pub facets: FacetTrace,
    /// Gaps between facets that delineation had closed.
    pub gaps: Vec<RoofGap>,
    /// The facets before refinement.
    pub unrefined: UnrefinedFacets,
    /// What was regularised and refined in each building.
    pub refinement: RefineTrace,
    /// Roofs that lie below the edges that bound them.
    pub parapets: Vec<Parapet>,
    /// Walls and ground.
    pub solids: SolidTrace,
    /// What the model says of the lines.
    pub lines: VerifiedLines,
}

/// The facets before refinement, whose buildings are those of [`RefineTrace`].
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct UnrefinedFacets {
    /// Closed, cut back at gaps, and not refined.
    pub facets: Vec<Facet>,
    /// For every facet of the model its index among these.
    pub sources: Vec<usize>,
}

/// Groups, delineates and verifies facets, refines the buildings and closes the solids.
pub fn reconstruct_roofs(
    scene: &Scene,
    evidence: &FacetInput,
    params: &RoofParams,
) -> Sharded<(RoofModel, RoofTrace)> {
    let FacetInput { lines, ground, .. } = *evidence;
    let (facets, facet_trace) = reconstruct_facets(scene, evidence, params)?;
    let below = |members: &[&Facet]| ground.below(members);
    // Refinement needs facets that share vertices, and moves them; so the solids are made again.
    let (delineated, solids) = close_buildings(&facets, below);
    let (separated, gaps) = cut_back_at_gaps(scene, &delineated, params);
    let (delineated, again) = close_buildings(&separated, below);
    let (refined, refinement) = refine_roofs(scene, lines, &delineated, params);
    let (lowered, parapets) = below_parapets(scene, &refined);
    let (model, closed) = close_buildings(&lowered, below);
    let unrefined = UnrefinedFacets {
        facets: delineated.facets,
        sources: closed.sources.clone(),
    };
    let solids = solids.then(again).then(closed);
    let trace = RoofTrace {
        facets: facet_trace,
        gaps,
        unrefined,
        refinement,
        parapets,
        solids,
        lines: VerifiedLines::default(),
    };
    Ok((model, trace))
}
