//! The ground, and half-planes at the 3D lines (B99 4.1).

use super::{Findings, Results, Stage, StageDefinition};
use super::{from_bytes, is_any, required, to_bytes, warn_if};
use crate::base::execution::Sharded;
use crate::base::ids::LineId;
use crate::base::params::Params;
use crate::orienting::known::KnownThing;
use crate::orienting::scene::Scene;
use crate::planes::half_planes::{HalfPlane, SweepTrace, sweep_half_planes};
use crate::planes::terrain::Ground;

/// Half-planes, and the ground above which they were sought.
#[derive(Clone, Debug)]
pub struct Found {
    /// Half-planes.
    pub value: Vec<HalfPlane>,
    /// The ground.
    pub ground: Ground,
    /// What became of every side of every line.
    pub trace: SweepTrace,
}

pub(super) struct HalfPlanes;

impl StageDefinition for HalfPlanes {
    type Found = Found;

    const NAME: &'static str = "halfplanes";
    const TITLE: &'static str = "Half-planes";
    const SECTION: &'static str = "B99 4.1";
    const READS: &'static [&'static str] = &["sweep"];
    const NEEDS: &'static [Stage] = &[Stage::Lines, Stage::Coplanar];
    const SHARD_MAPS: &'static [&'static str] = &["ground", "sides"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let lines = &required(&before.lines).value;
        let ground = Ground::estimate(scene, lines)?;
        let swept = if params.method.pairs_lines() {
            &lines[..]
        } else {
            &[]
        };
        let sets = before.coplanar.as_ref().map_or(&[][..], |c| &c.value);
        let explained = |id: LineId, side| {
            let line = &lines[id.index()];
            sets.iter().any(|set| set.explains(id, line, side))
        };
        let (value, trace) = sweep_half_planes(scene, swept, &ground, &explained, &params.sweep)?;
        Ok(Found {
            value,
            ground,
            trace,
        })
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let was_swept = !found.trace.sides.is_empty();
        let correlations = usize::try_from(found.trace.correlations).unwrap_or(usize::MAX);
        let none = "no half-plane was accepted; the surfaces may have too little texture: try a \
                    lower sweep.min_similarity";
        let is_empty = found.value.is_empty();
        Findings {
            counts: vec![
                ("half-planes", found.value.len()),
                ("correlations", correlations),
            ],
            warnings: [
                warn_if(is_empty && was_swept && is_any(&before.lines), none),
                found
                    .ground
                    .terrain()
                    .and_then(|terrain| terrain.warning(KnownThing::Terrain))
                    .into_iter()
                    .collect(),
            ]
            .concat(),
        }
    }

    fn pack(found: &Found) -> Vec<u8> {
        to_bytes(&(&found.value, &found.ground))
    }

    fn unpack(bytes: &[u8]) -> Option<Found> {
        let (value, ground) = from_bytes(bytes)?;
        Some(Found {
            value,
            ground,
            trace: SweepTrace::default(),
        })
    }
}
