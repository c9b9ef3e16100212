//! Roof facets and the closed buildings below them (B99 4.2, 4.3), and which lines these
//! contradict.

use super::{Findings, Outcome, Results, Stage, StageDefinition};
use super::{is_any, required, warn_if};
use crate::buildings::{RoofTrace, reconstruct_roofs, verify_lines};
use crate::dense::CloudComparison;
use crate::execution::Sharded;
use crate::facets::{FacetInput, PlacedCloud, RegisterTrace};
use crate::model::RoofModel;
use crate::objectspace::proposed_planes;
use crate::params::Params;
use crate::planes::ProposedPlane;
use crate::scene::Scene;

/// Facets and buildings.
pub(super) type Found = Outcome<RoofModel, RoofTrace>;

pub(super) struct Facets;

impl StageDefinition for Facets {
    type Found = Found;

    const NAME: &'static str = "facets";
    const TITLE: &'static str = "Facets";
    const SECTION: &'static str = "B99 4.2, 4.3";
    const READS: &'static [&'static str] = &["roof", "point_cloud"];
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
        let placed = |compared: &CloudComparison| {
            // Only the instance that weighs the planes has the points.
            let known = scene.known.point_cloud.as_ref()?;
            Some(PlacedCloud {
                points: compared.placed(known),
                accuracy_m: compared.accuracy_m,
                belongs: compared.belongs,
                params: params.point_cloud.clone(),
            })
        };
        let cloud: Option<PlacedCloud> = cloud.filter_map(placed).next();
        let evidence = FacetInput {
            segments: &required(&before.segments).value,
            lines: &required(&before.lines).value,
            half_planes: &half_planes.value,
            ground: &half_planes.ground,
            proposals: &proposals,
            cloud: cloud.as_ref(),
            line_pairs: params.method.pairs_lines(),
        };
        let (model, mut trace) = reconstruct_roofs(scene, &evidence, &params.roof)?;
        trace.lines = verify_lines(scene, evidence.lines, &model, evidence.ground, params);
        Ok((model, trace).into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let facets = &found.value.facets;
        let none = "no roof facet was found: the model is empty";
        let half_planes = before.half_planes.as_ref();
        let has_planes = half_planes.is_some_and(|found| !found.value.is_empty())
            || is_any(&before.coplanar)
            || is_any(&before.adjacency);
        Findings {
            counts: vec![
                ("facets", facets.len()),
                ("buildings", found.value.buildings.len()),
                ("below parapets", found.trace.parapets.len()),
                ("contradicted lines", found.trace.lines.contradicted.len()),
            ],
            warnings: [
                warn_if(facets.is_empty() && has_planes, none),
                found
                    .trace
                    .facets
                    .register
                    .iter()
                    .flat_map(RegisterTrace::warnings)
                    .collect(),
            ]
            .concat(),
        }
    }
}
