//! Regions with straight boundaries in every view (W96 3.3).

use super::super::{Findings, Outcome, Packing, Results, Stage, StageDefinition};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::planes::objectspace::{RegionLine, Segmentation, find_regions};

/// Lines on the boundaries of the regions of each view, in the order of the views.
pub(in super::super) type Found = Outcome<Vec<Vec<RegionLine>>, Vec<Segmentation>>;

pub(in super::super) struct Regions;

impl StageDefinition for Regions {
    type Found = Found;

    const NAME: &'static str = "regions";
    const TITLE: &'static str = "Regions";
    const SECTION: &'static str = "W96 3.3";
    const READS: &'static [&'static str] = &["objectspace.oris"];
    const NEEDS: &'static [Stage] = &[];
    const PACKING: Option<Packing<Found>> = Some(Found::VALUE);
    const SHARD_MAPS: &'static [&'static str] = &["views"];
    const SHARDS_READ_COLOURS: bool = true;

    fn run(scene: &Scene, params: &Params, _: &Results) -> Sharded<Found> {
        Ok(find_regions(scene, &params.objectspace)?.into())
    }

    fn summary(scene: &Scene, found: &Found, _: &Results) -> Findings {
        let views = scene.views.iter().zip(&found.value);
        let empty = views.filter(|(_, lines)| lines.is_empty());
        let warnings = empty.map(|(view, _)| {
            format!(
                "{}: no straight region boundary found; leave this view out",
                view.name
            )
        });
        Findings {
            counts: vec![
                ("views", scene.views.len()),
                ("regions", found.trace.iter().map(|s| s.regions.len()).sum()),
                ("lines", found.value.iter().map(Vec::len).sum()),
            ],
            warnings: warnings.collect(),
        }
    }
}
