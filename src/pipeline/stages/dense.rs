//! Planes from dense matching (B99 2).

use super::{Findings, Outcome, Results, Stage, StageDefinition};
use super::{required, to_bytes};
use crate::dense::{DensePlane, DenseTrace, dense_planes};
use crate::execution::Sharded;
use crate::params::Params;
use crate::scene::Scene;

/// Planes of the surfaces that the views agree on.
pub(super) type Found = Outcome<Vec<DensePlane>, DenseTrace>;

pub(super) struct Dense;

impl StageDefinition for Dense {
    type Found = Found;

    const NAME: &'static str = "dense";
    const TITLE: &'static str = "Dense planes";
    const SECTION: &'static str = "B99 2";
    const READS: &'static [&'static str] = &["dense"];
    const NEEDS: &'static [Stage] = &[Stage::Lines, Stage::HalfPlanes];
    const SHARD_MAPS: &'static [&'static str] = &["levels", "patches"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        if !params.dense.enabled {
            return Ok((Vec::new(), DenseTrace::default()).into());
        }
        let lines = &required(&before.lines).value;
        Ok(dense_planes(scene, lines, &required(&before.half_planes).ground)?.into())
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        Findings {
            counts: vec![
                ("planes", found.value.len()),
                ("patches", found.trace.patches.len()),
            ],
            warnings: Vec::new(),
        }
    }

    fn pack(found: &Found) -> Vec<u8> {
        to_bytes(&found.value)
    }

    fn unpack(bytes: &[u8]) -> Option<Found> {
        super::untraced(bytes)
    }
}
