//! Half-planes at the 3D lines (B99 4.1).

use super::{Findings, Outcome, Packing, Results, Stage, StageDefinition};
use super::{is_any, required, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::planes::half_planes::{HalfPlane, SweepTrace, sweep_half_planes};

/// Half-planes, and what became of every side of every line.
pub(super) type Found = Outcome<Vec<HalfPlane>, SweepTrace>;

pub(super) struct HalfPlanes;

impl StageDefinition for HalfPlanes {
    type Found = Found;

    const NAME: &'static str = "halfplanes";
    const TITLE: &'static str = "Half-planes";
    const SECTION: &'static str = "B99 4.1";
    const READS: &'static [&'static str] = &["sweep"];
    const NEEDS: &'static [Stage] = &[Stage::Lines, Stage::Ground];
    const PACKING: Option<Packing<Found>> = Some(Found::VALUE);
    const SHARD_MAPS: &'static [&'static str] = &["sides"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let lines = &required(&before.lines).value;
        let ground = required(&before.ground);
        Ok(sweep_half_planes(scene, lines, ground, &params.sweep)?.into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let was_swept = !found.trace.sides.is_empty();
        let correlations = usize::try_from(found.trace.correlations).unwrap_or(usize::MAX);
        let none = "no line was found to be the edge of a roof face; the faces may show too \
                    little texture: try a lower sweep.min_similarity";
        let is_empty = found.value.is_empty();
        Findings {
            counts: vec![
                ("half-planes", found.value.len()),
                ("correlations", correlations),
            ],
            warnings: warn_if(is_empty && was_swept && is_any(&before.lines), none),
        }
    }
}
