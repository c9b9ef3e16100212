//! Straight image segments in every view (B99 3.2).

use super::{Findings, Outcome, Packing, Results, Stage, StageDefinition};
use crate::base::execution::{Sharded, sharded_map};
use crate::base::params::Params;
use crate::lines::lines2d::{ImageSegment, SegmentTrace, detect_segments};
use crate::orienting::scene::Scene;

/// Segments of each view, in the order of the views.
pub(super) type Found = Outcome<Vec<Vec<ImageSegment>>, Vec<SegmentTrace>>;

pub(super) struct Segments;

impl StageDefinition for Segments {
    type Found = Found;

    const NAME: &'static str = "segments";
    const TITLE: &'static str = "Segments";
    const SECTION: &'static str = "B99 3.2";
    const READS: &'static [&'static str] = &["segments"];
    const NEEDS: &'static [Stage] = &[];
    const PACKING: Option<Packing<Found>> = Some(Found::VALUE);
    const SHARD_MAPS: &'static [&'static str] = &["views"];
    const SHARDS_READ_COLOURS: bool = true;

    fn run(scene: &Scene, params: &Params, _: &Results) -> Sharded<Found> {
        let per_view = sharded_map("views", &scene.views, 0.0..1.0, |_, view| {
            detect_segments(&view.gray, view.red_blue.as_ref(), &params.segments)
        })?;
        let (value, trace) = per_view.into_iter().unzip();
        Ok(Outcome { value, trace })
    }

    fn summary(scene: &Scene, found: &Found, _: &Results) -> Findings {
        let views = scene.views.iter().zip(&found.value);
        let empty = views.filter(|(_, segments)| segments.is_empty());
        let warnings = empty.map(|(view, _)| {
            format!(
                "{}: no straight edge found; leave this view out, or lower segments.edgels.high",
                view.name
            )
        });
        Findings {
            counts: vec![
                ("views", scene.views.len()),
                ("segments", found.value.iter().map(Vec::len).sum()),
            ],
            warnings: warnings.collect(),
        }
    }
}
