//! Planes from dense matching (B99 2).

use super::{Findings, Outcome, Packing, Proposals, Results, Stage, StageDefinition};
use super::{from_bytes, required, to_bytes};
use crate::base::execution::Sharded;
use crate::base::params::{Params, Source};
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
    const READS: &'static [&'static str] = &["point_cloud"];
    const NEEDS: &'static [Stage] = &[Stage::Lines, Stage::Ground];
    const PACKING: Option<Packing<Found>> = Some(Packing {
        pack: |found| to_bytes(&(&found.value, &found.trace.point_cloud)),
        unpack: |bytes| {
            let (planes, point_cloud): (_, Option<CloudComparison>) = from_bytes(bytes)?;
            let trace = DenseTrace {
                point_cloud,
                ..DenseTrace::default()
            };
            Some((planes, trace).into())
        },
    });
    const PROPOSALS: Proposals<Found> = Some(|found| {
        let planes = found.value.iter().enumerate();
        let of_cloud = found.trace.counted_cloud().into_iter();
        let of_cloud = of_cloud.flat_map(|cloud| &cloud.planes).enumerate();
        let planes = planes.map(|(i, plane)| plane.proposed(i));
        planes
            .chain(of_cloud.map(|(i, plane)| plane.proposed(i)))
            .collect()
    });
    const SHARD_MAPS: &'static [&'static str] = &["levels", "patches"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let lines = &required(&before.lines).value;
        let ground = required(&before.ground);
        let is_source = |source| params.sources().contains(&source);
        let cloud = is_source(Source::PointCloud).then_some(&params.point_cloud);
        let (mut planes, trace) = dense_planes(scene, lines, ground, cloud)?;
        if !is_source(Source::Dense) {
            planes.clear();
        }
        Ok((planes, trace).into())
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
}
