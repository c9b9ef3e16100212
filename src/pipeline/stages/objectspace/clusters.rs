//! 3D lines by clustering (W96 3.5).

use super::super::{Findings, Outcome, Packing, Results, Stage, StageDefinition};
use super::super::{is_any, required, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::planes::objectspace::{ClusterTrace, FoundLine, find_clusters};

/// 3D lines; a trace for each window and direction.
pub(in super::super) type Found = Outcome<Vec<FoundLine>, Vec<ClusterTrace>>;

pub(in super::super) struct Clusters;

impl StageDefinition for Clusters {
    type Found = Found;

    const NAME: &'static str = "clusters";
    const TITLE: &'static str = "Clusters";
    const SECTION: &'static str = "W96 3.5";
    const READS: &'static [&'static str] = &["objectspace.clusters"];
    const NEEDS: &'static [Stage] = &[Stage::Regions, Stage::Directions];
    const PACKING: Option<Packing<Found>> = Some(Found::VALUE);
    const SHARD_MAPS: &'static [&'static str] = &["clusters"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let lines = &required(&before.regions).value;
        let windows = &required(&before.directions).value;
        Ok(find_clusters(scene, lines, windows, &params.objectspace)?.into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let none = "no 3D line was found; check that the orientation belongs to these images and \
                    that the views overlap";
        let is_empty = found.value.is_empty();
        Findings {
            counts: vec![("lines", found.value.len())],
            warnings: warn_if(is_empty && is_any(&before.directions), none),
        }
    }
}
