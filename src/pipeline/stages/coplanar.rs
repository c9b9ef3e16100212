//! Coplanar lines and their polygons (B99 2: Leuven; 5).

use super::{Findings, Outcome, Packing, Proposals, Results, Stage, StageDefinition};
use super::{is_any, required, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::planes::coplanar::{CoplanarSet, CoplanarTrace, coplanar_sets};

/// Sets of coplanar lines with their polygons, verified or not.
pub(super) type Found = Outcome<Vec<CoplanarSet>, CoplanarTrace>;

pub(super) struct Coplanar;

impl StageDefinition for Coplanar {
    type Found = Found;

    const NAME: &'static str = "coplanar";
    const TITLE: &'static str = "Coplanar sets";
    const SECTION: &'static str = "B99 2, 5";
    const READS: &'static [&'static str] = &["roof.border_nats_per_m"];
    const NEEDS: &'static [Stage] = &[Stage::Segments, Stage::Lines];
    const PACKING: Option<Packing<Found>> = Some(Found::VALUE);

    const PROPOSALS: Proposals<Found> = Some(|found| {
        let verified = (found.value.iter().enumerate()).filter(|(_, set)| set.is_verified());
        verified.map(|(i, set)| set.proposed(i)).collect()
    });

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let segments = &required(&before.segments).value;
        let lines = &required(&before.lines).value;
        Ok(coplanar_sets(scene, lines, segments, &params.roof).into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let verified = found.value.iter().filter(|set| set.is_verified()).count();
        let none = "no two lines span a plane that the views agree on; try method lines";
        let is_empty = !found.trace.sets.is_empty() && verified == 0;
        Findings {
            counts: vec![("sets", found.value.len()), ("verified sets", verified)],
            warnings: warn_if(is_empty && is_any(&before.lines), none),
        }
    }
}
