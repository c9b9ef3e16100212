//! Planes from dense matching (B99 2).

use super::{Findings, Outcome, Results, Stage, StageDefinition};
use super::{from_bytes, required, to_bytes};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::known::KnownThing;
use crate::orienting::scene::Scene;
use crate::planes::dense::{CloudComparison, DensePlane, DenseTrace, dense_planes};

/// Planes of the surfaces that the views agree on.
pub(super) type Found = Outcome<Vec<DensePlane>, DenseTrace>;

pub(super) struct Dense;

impl StageDefinition for Dense {
    type Found = Found;

    const NAME: &'static str = "dense";
    const TITLE: &'static str = "Dense planes";
    const SECTION: &'static str = "B99 2";
    const READS: &'static [&'static str] = &["dense", "point_cloud"];
    const NEEDS: &'static [Stage] = &[Stage::Lines, Stage::HalfPlanes];
    const SHARD_MAPS: &'static [&'static str] = &["levels", "patches"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        if !params.dense.enabled {
            return Ok((Vec::new(), DenseTrace::default()).into());
        }
        let lines = &required(&before.lines).value;
        let ground = &required(&before.half_planes).ground;
        Ok(dense_planes(scene, lines, ground, &params.point_cloud)?.into())
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        let mut counts = vec![
            ("planes", found.value.len()),
            ("patches", found.trace.patches.len()),
        ];
        let cloud = found.trace.point_cloud.as_ref();
        counts.extend(cloud.map(|cloud| ("planes of the point cloud", cloud.planes.len())));
        Findings {
            counts,
            warnings: cloud
                .and_then(|cloud| cloud.compared.warning(KnownThing::PointCloud))
                .into_iter()
                .collect(),
        }
    }

    fn pack(found: &Found) -> Vec<u8> {
        to_bytes(&(&found.value, &found.trace.point_cloud))
    }

    fn unpack(bytes: &[u8]) -> Option<Found> {
        let (planes, point_cloud): (_, Option<CloudComparison>) = from_bytes(bytes)?;
        let trace = DenseTrace {
            point_cloud,
            ..DenseTrace::default()
        };
        Some((planes, trace).into())
    }
}
