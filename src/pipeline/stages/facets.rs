//! Roof facets and the closed buildings below them (B99 4.3).

use super::{Findings, Outcome, Results, Stage, StageDefinition};
use super::{is_any, required, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::roofs::facets::{RegisterTrace, RoofTrace, reconstruct_roofs};
use crate::roofs::model::RoofModel;

/// Facets and buildings.
pub(super) type Found = Outcome<RoofModel, RoofTrace>;

pub(super) struct Facets;

impl StageDefinition for Facets {
    type Found = Found;

    const NAME: &'static str = "facets";
    const TITLE: &'static str = "Facets";
    const SECTION: &'static str = "B99 4.3";
    const READS: &'static [&'static str] = &[
        "roof.border_nats_per_m",
        "roof.least_nats",
        "roof.min_area_m2",
        "roof.min_height_m",
        "roof.register",
    ];
    const NEEDS: &'static [Stage] = &[Stage::Ground, Stage::Groups];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let ground = required(&before.ground);
        let competing = required(&before.groups).value.as_deref();
        Ok(reconstruct_roofs(scene, competing, ground, &params.roof).into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let facets = &found.value.facets;
        let none = "no roof was found: the model is empty; check that three or more photographs show one \
                    whole, and the height of the ground where it was stated";
        Findings {
            counts: vec![
                ("facets", facets.len()),
                ("buildings", found.value.buildings.len()),
            ],
            warnings: [
                warn_if(facets.is_empty() && is_any(&before.lines), none),
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
