//! From closed buildings to refined ones, and what these say of the lines: the stage of refinement
//! (B99 2).

use serde::Serialize;

use super::model_lines::{VerifiedLines, verify_lines};
use super::parapets::{Parapet, below_parapets};
use super::refine::{BuildingRefinement, RoofGap, cut_back_at_gaps, refine_roofs};
use crate::base::evidence::JudgedFacet;
use crate::base::execution::reached;
use crate::base::params::Params;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;
use crate::roofs::facets::CloudEvidence;
use crate::roofs::model::{Facet, RoofModel};
use crate::roofs::obstructions::{find_obstructions, take_out_islands};
use crate::roofs::solids::{SolidTrace, close_above};

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
    /// Blocks that may stand on the roofs.
    pub obstructions: Vec<JudgedFacet>,
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

/// Cuts facets back at gaps, refines the buildings, takes what is no roof out of them, closes them
/// again, finds what stands on them, and weighs the lines in them.
pub(crate) fn refine_buildings(
    scene: &Scene,
    lines: &[Line3d],
    model: &RoofModel,
    (ground, cloud): (&Ground, Option<&CloudEvidence>),
    params: &Params,
) -> (RoofModel, RefinementTrace) {
    let (separated, gaps) = cut_back_at_gaps(scene, model, &params.roof);
    // Refinement needs facets that share vertices, and moves them; so the solids are made again.
    let (delineated, solids) = close_above(&separated, ground);
    reached(0.2);
    let (refined, buildings) = refine_roofs(scene, lines, &delineated, &params.roof);
    reached(0.7);
    let (lowered, parapets) = below_parapets(scene, &refined, cloud);
    let (roofs, kept) = take_out_islands(&lowered);
    let (mut model, closed) = close_above(&roofs, ground);
    let obstructions = find_obstructions(scene, &mut model);
    let unrefined = UnrefinedFacets {
        facets: delineated.facets,
        sources: closed.sources.iter().map(|&i| kept[i]).collect(),
    };
    let trace = RefinementTrace {
        gaps,
        unrefined,
        buildings,
        parapets,
        obstructions,
        solids: solids.then(closed),
        lines: verify_lines(scene, lines, &model, ground, params),
    };
    (model, trace)
}
