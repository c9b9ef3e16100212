//! 3D lines (B99 3.2), and with both methods those of the other one.

use super::{Findings, Outcome, Packing, Results, Stage, StageDefinition};
use super::{is_any, required, warn_if};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::lines::lines3d::{Line3d, LineTrace, reconstruct_lines};
use crate::orienting::scene::Scene;
use crate::planes::objectspace::adopted_lines;

/// 3D lines: those of matches, then those adopted from clusters.
pub(super) type Found = Outcome<Vec<Line3d>, LineTrace>;

pub(super) struct Lines;

impl StageDefinition for Lines {
    type Found = Found;

    const NAME: &'static str = "lines";
    const TITLE: &'static str = "3D lines";
    const SECTION: &'static str = "B99 3.2, fig. 4";
    const READS: &'static [&'static str] = &["lines3d"];
    const NEEDS: &'static [Stage] = &[Stage::Matches, Stage::Regions, Stage::Clusters];
    const PACKING: Option<Packing<Found>> = Some(Found::VALUE);

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let matches = &required(&before.matches).value;
        let (mut lines, trace) = reconstruct_lines(scene, matches, &params.lines3d);
        if let (Some(regions), Some(clusters)) = (&before.regions, &before.clusters) {
            let (regions, found) = (&regions.value, &clusters.value);
            let params = &params.objectspace.clusters;
            lines.extend(adopted_lines(scene, regions, found, &lines, params));
        }
        Ok((lines, trace).into())
    }

    fn summary(_: &Scene, found: &Found, before: &Results) -> Findings {
        let none = "none of the matched edges is long enough, and seen from places far enough \
                    apart, to give a line in space; use more photographs, or larger ones";
        let is_empty = found.value.is_empty();
        Findings {
            counts: vec![("lines", found.value.len())],
            warnings: warn_if(is_empty && is_any(&before.matches), none),
        }
    }
}
