//! Roof facets and the closed buildings below them (B99 4.3), and which lines these
//! contradict.

use super::{Findings, Outcome, Results, Stage, StageDefinition};
use super::{is_any, required, warn_if};
use crate::buildings::{RoofTrace, reconstruct_roofs, verify_lines};
use crate::execution::Sharded;
use crate::facets::RegisterTrace;
use crate::model::RoofModel;
use crate::params::Params;
use crate::scene::Scene;

/// Facets and buildings.
pub(super) type Found = Outcome<RoofModel, RoofTrace>;

pub(super) struct Facets;

impl StageDefinition for Facets {
    type Found = Found;

    const NAME: &'static str = "facets";
    const TITLE: &'static str = "Facets";
    const SECTION: &'static str = "B99 4.3";
    const READS: &'static [&'static str] = &["roof"];
    const NEEDS: &'static [Stage] = &[Stage::Lines, Stage::HalfPlanes, Stage::Groups];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let lines = &required(&before.lines).value;
        let ground = &required(&before.half_planes).ground;
        let competing = required(&before.groups).value.as_deref();
        let (model, mut trace) = reconstruct_roofs(scene, competing, lines, ground, &params.roof);
        trace.lines = verify_lines(scene, lines, &model, ground, params);
        Ok((model, trace).into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let facets = &found.value.facets;
        let none = "no roof facet was found: the model is empty";
        let half_planes = before.half_planes.as_ref();
        let has_planes = half_planes.is_some_and(|found| !found.value.is_empty())
            || is_any(&before.coplanar)
            || is_any(&before.adjacency);
        Findings {
            counts: vec![
                ("facets", facets.len()),
                ("buildings", found.value.buildings.len()),
                ("below parapets", found.trace.parapets.len()),
                ("contradicted lines", found.trace.lines.contradicted.len()),
            ],
            warnings: [
                warn_if(facets.is_empty() && has_planes, none),
                found
                    .trace
                    .facets
                    .register
                    .iter()
                    .flat_map(RegisterTrace::warnings)
                    .collect(),
            ]
            .concat(),
        }
    }
}
