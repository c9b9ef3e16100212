//! Windows and their main directions (W96 3.4).

use super::super::{Findings, Outcome, Packing, Results, Stage, StageDefinition};
use super::super::{required, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::planes::objectspace::{Window, WindowTrace, find_directions};

/// Windows with their main directions.
pub(in super::super) type Found = Outcome<Vec<Window>, WindowTrace>;

pub(in super::super) struct Directions;

impl StageDefinition for Directions {
    type Found = Found;

    const NAME: &'static str = "directions";
    const TITLE: &'static str = "Directions";
    const SECTION: &'static str = "W96 3.4";
    // Windows are found with clusters and the ground, too.
    const READS: &'static [&'static str] = &[
        "objectspace.windows",
        "objectspace.directions",
        "objectspace.clusters",
        "objectspace.planes.min_height_m",
    ];
    const NEEDS: &'static [Stage] = &[Stage::Regions];
    const PACKING: Option<Packing<Found>> = Some(Found::VALUE);
    const SHARD_MAPS: &'static [&'static str] = &["heights", "tiles", "ground"];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let lines = &required(&before.regions).value;
        Ok(find_directions(scene, lines, &params.objectspace)?.into())
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        let pairs = found.value.iter().map(|w| w.directions.len()).sum();
        let none = "no main direction was found: the lines run all ways; try method lines";
        Findings {
            counts: vec![
                ("windows", found.value.len()),
                ("pairs of directions", pairs),
            ],
            warnings: warn_if(pairs == 0, none),
        }
    }
}
