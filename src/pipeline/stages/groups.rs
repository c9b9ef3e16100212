//! Groups of coplanar lines and half-planes (B99 4.2), whose planes compete for the plan, with the
//! planes of all other sources.

use std::sync::Arc;

use super::{Findings, Outcome, Results, Stage, StageDefinition, required};
use crate::base::execution::Sharded;
use crate::base::params::{Params, Source};
use crate::orienting::scene::Scene;
use crate::planes::grouping::GroupedPlanes;
use crate::roofs::facets::{
    CompetingPlanes, FacetInput, GroupingTrace, PlacedCloud, competing_planes,
};

/// The planes that compete, where there are any.
pub(super) type Found = Outcome<Option<Arc<CompetingPlanes>>, GroupingTrace>;

pub(super) struct Groups;

impl StageDefinition for Groups {
    type Found = Found;

    const NAME: &'static str = "groups";
    const TITLE: &'static str = "Groups";
    const SECTION: &'static str = "B99 4.2";
    const READS: &'static [&'static str] = &[
        "roof.coplanar_angle_deg",
        "roof.coplanar_distance_m",
        "roof.min_facet_depth_m",
        "roof.max_facet_depth_m",
        "roof.extension_m",
        "roof.min_height_m",
        "roof.refine.loss_sigmas",
        "point_cloud",
    ];
    const NEEDS: &'static [Stage] = &[
        Stage::Segments,
        Stage::Lines,
        Stage::Ground,
        Stage::HalfPlanes,
    ];
    const TAKES_PROPOSALS: bool = true;
    const SHARD_MAPS: &'static [&'static str] = &["planes"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let cloud = (before.dense.as_ref()).and_then(|found| found.trace.counted_cloud());
        let cloud = cloud.and_then(|cloud| PlacedCloud::new(scene, cloud, &params.point_cloud));
        let cloud = cloud.map(Arc::new);
        let proposals = before.proposals();
        let half_planes = before.half_planes.as_ref();
        let ground = required(&before.ground);
        let grouped = GroupedPlanes::new(
            &required(&before.lines).value,
            half_planes.map_or(&[], |found| &found.value),
            params.sources().contains(&Source::LinePairs),
            &proposals,
            ground,
            &params.roof,
        );
        let evidence = FacetInput {
            segments: &required(&before.segments).value,
            grouped: &grouped,
            ground,
            cloud: cloud.as_ref(),
        };
        let (competing, trace) = competing_planes(scene, &evidence, &params.roof)?;
        Ok((competing.map(Arc::new), trace).into())
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        let GroupingTrace {
            groups,
            borders,
            cells,
            ..
        } = &found.trace;
        Findings {
            counts: vec![
                ("groups", groups.len()),
                ("border lines", borders.len()),
                ("cells", *cells),
            ],
            warnings: Vec::new(),
        }
    }
}
