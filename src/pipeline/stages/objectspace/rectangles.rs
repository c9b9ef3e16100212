//! Planes between parallel lines and the closed buildings below them (W96 3.6).

use super::super::{Findings, Outcome, Packing, Proposals, Results, Stage, StageDefinition};
use super::super::{from_bytes, is_any, required, to_bytes, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::planes::objectspace::{RectangleTrace, find_rectangles, proposed_planes};
use crate::roofs::buildings::roofs_of_rectangles;
use crate::roofs::model::RoofModel;

/// Planes and buildings.
pub(in super::super) type Found = Outcome<RoofModel, RectangleTrace>;

pub(in super::super) struct Rectangles;

impl StageDefinition for Rectangles {
    type Found = Found;

    const NAME: &'static str = "rectangles";
    const TITLE: &'static str = "Rectangles";
    const SECTION: &'static str = "W96 3.6";
    const READS: &'static [&'static str] = &["objectspace.planes", "roof.border_nats_per_m"];
    const NEEDS: &'static [Stage] = &[
        Stage::Regions,
        Stage::Directions,
        Stage::Clusters,
        Stage::Ground,
    ];
    /// What facets are made of: the planes, not the buildings.
    const PACKING: Option<Packing<Found>> = Some(Packing {
        pack: |found| to_bytes(&(&found.trace.candidates, &found.trace.chosen)),
        unpack: |bytes| {
            let (candidates, chosen) = from_bytes(bytes)?;
            let trace = RectangleTrace {
                candidates,
                chosen,
                ..RectangleTrace::default()
            };
            Some((RoofModel::default(), trace).into())
        },
    });
    const PROPOSALS: Proposals<Found> = Some(|found| proposed_planes(&found.trace));
    const SHARD_MAPS: &'static [&'static str] = &["planes", "behind"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let lines = &required(&before.regions).value;
        let windows = &required(&before.directions).value;
        let clusters = &required(&before.clusters).value;
        let ground = required(&before.ground);
        let trace = find_rectangles(scene, lines, windows, clusters, ground, params)?;
        Ok((roofs_of_rectangles(&trace, ground), trace).into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let none = "no plane between parallel lines was accepted: the model is empty; try method \
                    lines";
        let is_empty = found.value.facets.is_empty();
        Findings {
            counts: vec![
                ("facets", found.value.facets.len()),
                ("buildings", found.value.buildings.len()),
                ("candidates", found.trace.candidates.len()),
                ("pairs of lines", found.trace.pairs.len()),
            ],
            warnings: warn_if(is_empty && is_any(&before.clusters), none),
        }
    }
}
