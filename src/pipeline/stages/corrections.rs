//! What somebody corrects of the model by hand.

use super::{Findings, Outcome, Results, Stage, StageDefinition};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::roofs::corrections::{CorrectionTrace, correct};
use crate::roofs::model::RoofModel;

/// The corrected model.
pub(super) type Found = Outcome<RoofModel, CorrectionTrace>;

pub(super) struct Corrections;

impl StageDefinition for Corrections {
    type Found = Found;

    const NAME: &'static str = "corrections";
    const TITLE: &'static str = "Corrections";
    const SECTION: &'static str = "by hand";
    const READS: &'static [&'static str] =
        &["corrections", "matching", "lines3d", "sweep", "roof.refine"];
    const NEEDS: &'static [Stage] = &[Stage::Rectangles, Stage::Refinement];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let model = before.found_model().expect("stages run in their order");
        Ok(correct(scene, model, &params.corrections, params).into())
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        let outcomes = &found.trace.outcomes;
        let refused = outcomes.iter().enumerate();
        let refused = refused.filter_map(|(i, why)| why.map(|why| (i + 1, why)));
        Findings {
            counts: vec![
                (
                    "corrections",
                    outcomes.iter().filter(|why| why.is_none()).count(),
                ),
                ("facets", found.value.facets.len()),
                ("buildings", found.value.buildings.len()),
            ],
            warnings: refused
                .map(|(number, why)| {
                    format!(
                        "correction {number} is not applied: {}; make it again, or remove it",
                        why.words()
                    )
                })
                .collect(),
        }
    }
}
