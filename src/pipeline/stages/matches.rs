//! Segments matched over the views (B99 3.1 - 3.4).

use super::{Findings, Outcome, Results, Stage, StageDefinition};
use super::{required, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::lines::linematch::{MatchTrace, match_lines};
use crate::lines::lines3d::{LineTrack, SupportKind};
use crate::orienting::scene::Scene;

/// Matches.
pub(super) type Found = Outcome<Vec<LineTrack>, MatchTrace>;

pub(super) struct Matches;

impl StageDefinition for Matches {
    type Found = Found;

    const NAME: &'static str = "matches";
    const TITLE: &'static str = "Matches";
    const SECTION: &'static str = "B99 3.1–3.4";
    // Matching fits 3D lines too, to tell which segments agree; the last matches are those of the
    // adjusted views.
    const READS: &'static [&'static str] = &["matching", "lines3d", "adjustment"];
    const NEEDS: &'static [Stage] = &[Stage::Segments];
    const SHARD_MAPS: &'static [&'static str] = &["heights", "pairs", "triples", "bundles"];
    const SHARDS_READ_COLOURS: bool = true;

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let segments = &required(&before.segments).value;
        Ok(match_lines(scene, segments, &params.matching, &params.lines3d)?.into())
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        let supports = || found.value.iter().flat_map(|m| &m.supports);
        let of_kind = |kind| supports().filter(|s| s.kind == kind).count();
        let none = "no line was matched over three views; check that the orientation belongs to \
                    these images (angle units, order of rotations, pixel size) and that the views \
                    overlap";
        Findings {
            counts: vec![
                ("matches", found.value.len()),
                ("supports", supports().count()),
                (
                    "matched segments",
                    supports().map(|s| s.segments.len()).sum(),
                ),
                ("merged supports", of_kind(SupportKind::Merged)),
                ("grown supports", of_kind(SupportKind::Grown)),
            ],
            warnings: warn_if(found.value.is_empty(), none),
        }
    }
}
