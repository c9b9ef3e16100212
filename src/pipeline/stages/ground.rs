//! The height of the ground.

use super::{Findings, Packing, Results, Stage, StageDefinition};
use super::{from_bytes, required, to_bytes};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::known::KnownThing;
use crate::orienting::scene::Scene;
use crate::planes::objectspace::ground_of_clusters;
use crate::planes::terrain::Ground as Surface;

/// The ground, which has a height everywhere.
pub(super) type Found = Surface;

pub(super) struct Ground;

impl StageDefinition for Ground {
    type Found = Found;

    const NAME: &'static str = "ground";
    const TITLE: &'static str = "Ground";
    const SECTION: &'static str = "height of the ground";
    const READS: &'static [&'static str] = &[];
    const NEEDS: &'static [Stage] = &[Stage::Directions, Stage::Clusters, Stage::Lines];
    const PACKING: Option<Packing<Found>> = Some(Packing {
        pack: to_bytes,
        unpack: from_bytes,
    });
    const SHARD_MAPS: &'static [&'static str] = &["ground"];

    fn run(scene: &Scene, _: &Params, before: &Results) -> Sharded<Found> {
        match &before.lines {
            Some(lines) => Surface::estimate(scene, &lines.value),
            None => {
                let windows = &required(&before.directions).value;
                ground_of_clusters(scene, windows, &required(&before.clusters).value)
            }
        }
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        let terrain = (found.terrain()).and_then(|terrain| terrain.warning(KnownThing::Terrain));
        Findings {
            counts: Vec::new(),
            warnings: terrain.into_iter().collect(),
        }
    }
}
