//! Groups of coplanar lines and half-planes (B99 4.2), whose planes compete for the plan, with the
//! planes of all other sources.

use std::sync::Arc;

use super::{Findings, Outcome, Results, Stage, StageDefinition, required};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::planes::dense::CloudComparison;
use crate::planes::grouping::ProposedPlane;
use crate::planes::objectspace::proposed_planes;
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
        "point_cloud",
    ];
    const NEEDS: &'static [Stage] = &[
        Stage::Segments,
        Stage::Lines,
        Stage::Coplanar,
        Stage::Adjacency,
        Stage::HalfPlanes,
        Stage::Rectangles,
        Stage::Dense,
    ];
    const SHARD_MAPS: &'static [&'static str] = &["planes"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let half_planes = required(&before.half_planes);
        let rectangles = before.rectangles.as_ref();
        let rectangles = rectangles.map_or_else(Vec::new, |found| proposed_planes(&found.trace));
        let dense = before.dense.iter().flat_map(|found| &found.value);
        let dense = dense.enumerate().map(|(i, plane)| plane.proposed(i));
        let sets = before
            .coplanar
            .iter()
            .flat_map(|found| &found.value)
            .enumerate();
        let verified = sets.filter(|(_, set)| set.is_verified());
        let coplanar = verified.map(|(i, set)| set.proposed(i));
        let of_corners = before.adjacency.iter().flat_map(|found| &found.value);
        let verified = of_corners
            .enumerate()
            .filter(|(_, plane)| plane.is_verified());
        let corners = verified.map(|(i, plane)| plane.proposed(i));
        let cloud = before.dense.iter().filter_map(|found| {
            let compared = found.trace.point_cloud.as_ref();
            compared.filter(|compared| compared.counts())
        });
        let of_cloud = (cloud.clone()).flat_map(|c| &c.planes).enumerate();
        let of_cloud = of_cloud.map(|(i, plane)| plane.proposed(i));
        let others = rectangles.into_iter().chain(coplanar).chain(corners);
        let proposals: Vec<ProposedPlane> = others.chain(dense).chain(of_cloud).collect();
        let placed = |cloud: &CloudComparison| {
            // Only the instance that weighs the planes has the points.
            let known = scene.known.point_cloud.as_ref()?;
            Some(PlacedCloud {
                points: cloud.placed(known),
                accuracy_m: cloud.compared.accuracy_m,
                belongs: cloud.compared.belongs,
                params: params.point_cloud.clone(),
            })
        };
        let cloud: Option<Arc<PlacedCloud>> = cloud.filter_map(placed).map(Arc::new).next();
        let evidence = FacetInput {
            segments: &required(&before.segments).value,
            lines: &required(&before.lines).value,
            half_planes: &half_planes.value,
            ground: &half_planes.ground,
            proposals: &proposals,
            cloud: cloud.as_ref(),
            line_pairs: params.method.pairs_lines(),
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
