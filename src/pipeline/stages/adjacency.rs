//! Corners matched over the views, and the planes that they propose (B99 2: Bonn).

use super::{Findings, Outcome, Packing, Proposals, Results, Stage, StageDefinition};
use super::{is_any, required, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::planes::adjacency::{AdjacencyTrace, CornerPlane, corner_planes};

/// Planes of corners, verified or not; the graphs and the corners are in the trace.
pub(super) type Found = Outcome<Vec<CornerPlane>, AdjacencyTrace>;

pub(super) struct Adjacency;

impl StageDefinition for Adjacency {
    type Found = Found;

    const NAME: &'static str = "adjacency";
    const TITLE: &'static str = "Adjacency graphs";
    const SECTION: &'static str = "B99 2";
    const READS: &'static [&'static str] = &["roof.border_nats_per_m"];
    const NEEDS: &'static [Stage] = &[Stage::Segments, Stage::Lines];
    const PACKING: Option<Packing<Found>> = Some(Found::VALUE);

    const PROPOSALS: Proposals<Found> = Some(|found| {
        let verified = (found.value.iter().enumerate()).filter(|(_, plane)| plane.is_verified());
        verified.map(|(i, plane)| plane.proposed(i)).collect()
    });

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let segments = &required(&before.segments).value;
        let lines = &required(&before.lines).value;
        Ok(corner_planes(scene, lines, segments, &params.roof).into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let verified = found.value.iter().filter(|p| p.is_verified()).count();
        let in_images = found.trace.graphs.iter().map(|g| g.corners.len()).sum();
        let none = "no corner of the images was found again in two other views; try method lines";
        let is_empty = in_images > 0 && found.trace.corners.is_empty();
        Findings {
            counts: vec![
                ("planes of corners", found.value.len()),
                ("verified planes", verified),
                ("corners in space", found.trace.corners.len()),
                ("corners in images", in_images),
            ],
            warnings: warn_if(is_empty && is_any(&before.lines), none),
        }
    }
}
