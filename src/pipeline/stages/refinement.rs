//! The buildings refined by the edges of all views (B99 2), and which lines they contradict.

use super::{Findings, Outcome, Results, Stage, StageDefinition, required};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::roofs::buildings::{RefinementTrace, refine_buildings};
use crate::roofs::facets::CompetingPlanes;
use crate::roofs::model::RoofModel;

/// The roof model.
pub(super) type Found = Outcome<RoofModel, RefinementTrace>;

pub(super) struct Refinement;

impl StageDefinition for Refinement {
    type Found = Found;

    const NAME: &'static str = "refinement";
    const TITLE: &'static str = "Refinement";
    const SECTION: &'static str = "B99 2";
    const READS: &'static [&'static str] = &["roof.refine", "roof.border_nats_per_m"];
    const NEEDS: &'static [Stage] = &[Stage::Lines, Stage::Ground, Stage::Groups, Stage::Facets];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let lines = &required(&before.lines).value;
        let ground = required(&before.ground);
        let competing = required(&before.groups).value.as_deref();
        let cloud = competing.and_then(CompetingPlanes::cloud);
        let facets = &required(&before.facets).value;
        Ok(refine_buildings(scene, lines, facets, (ground, cloud), params).into())
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        let (model, trace) = (&found.value, &found.trace);
        let obstructions = model.facets.iter().flat_map(|facet| &facet.obstructions);
        Findings {
            counts: vec![
                ("facets", model.facets.len()),
                ("buildings", model.buildings.len()),
                ("below parapets", trace.parapets.len()),
                ("obstructions", obstructions.count()),
                ("contradicted lines", trace.lines.contradicted.len()),
            ],
            warnings: Vec::new(),
        }
    }
}
