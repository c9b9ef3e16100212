//! Method "lines": from competing planes to closed buildings (B99 4.3, figure 24), which are then
//! refined (B99 2).

use serde::Serialize;

use super::model_lines::VerifiedLines;
use super::parapets::{Parapet, below_parapets};
use super::refine::{BuildingRefinement, RoofGap, cut_back_at_gaps, refine_roofs};
use crate::base::execution::reached;
use crate::base::params::RoofParams;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;
use crate::roofs::facets::{CompetingPlanes, FacetTrace, reconstruct_facets};
use crate::roofs::model::{Facet, RoofModel};
use crate::roofs::solids::{SolidTrace, close_buildings};

/// The steps from competing planes to closed buildings.
#[derive(Clone, Debug, Default, Serialize)]
pub struct RoofTrace {
    /// Delineation and verification.
    pub facets: FacetTrace,
    /// Walls and ground.
    pub solids: SolidTrace,
}

/// The steps from closed buildings to refined ones.
#[derive(Clone, Debug, Default, Serialize)]
pub struct RefinementTrace {
    /// Gaps between facets that delineation had closed.
    pub gaps: Vec<RoofGap>,
    /// The facets before refinement.
    pub unrefined: UnrefinedFacets,
    /// What was regularised and refined in each building.
    pub buildings: Vec<BuildingRefinement>,
    /// Roofs that lie below the edges that bound them.
    pub parapets: Vec<Parapet>,
    /// Walls and ground.
    pub solids: SolidTrace,
    /// What the model says of the lines.
    pub lines: VerifiedLines,
}

/// The facets before refinement, whose buildings are those of [`RefinementTrace`].
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct UnrefinedFacets {
    /// Closed, cut back at gaps, and not refined.
    pub facets: Vec<Facet>,
    /// For every facet of the model its index among these.
    pub sources: Vec<usize>,
}

/// Delineates and verifies facets, and closes the buildings below them.
pub fn reconstruct_roofs(
    scene: &Scene,
    competing: Option<&CompetingPlanes>,
    ground: &Ground,
    params: &RoofParams,
) -> (RoofModel, RoofTrace) {
    let (found, facets) = competing.map_or_else(Default::default, |competing| {
        reconstruct_facets(scene, competing, ground, params)
    });
    reached(0.9);
    let (model, solids) = close_above(&found, ground);
    (model, RoofTrace { facets, solids })
}

/// Closes the buildings below facets, down to the ground.
pub(super) fn close_above(facets: &[Facet], ground: &Ground) -> (RoofModel, SolidTrace) {
    close_buildings(facets, |members| {
        ground.below(members.iter().flat_map(|f| &f.outer))
    })
}

/// Cuts facets back at gaps, refines the buildings and closes them again.
pub fn refine_buildings(
    scene: &Scene,
    lines: &[Line3d],
    model: &RoofModel,
    ground: &Ground,
    params: &RoofParams,
) -> (RoofModel, RefinementTrace) {
    let (separated, gaps) = cut_back_at_gaps(scene, model, params);
    // Refinement needs facets that share vertices, and moves them; so the solids are made again.
    let (delineated, solids) = close_above(&separated, ground);
    reached(0.2);
    let (refined, buildings) = refine_roofs(scene, lines, &delineated, params);
    reached(0.7);
    let (lowered, parapets) = below_parapets(scene, &refined);
    let (model, closed) = close_above(&lowered, ground);
    let unrefined = UnrefinedFacets {
        facets: delineated.facets,
        sources: closed.sources.clone(),
    };
    let trace = RefinementTrace {
        gaps,
        unrefined,
        buildings,
        parapets,
        solids: solids.then(closed),
        lines: VerifiedLines::default(),
    };
    (model, trace)
}
