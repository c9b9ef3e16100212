//! Single views adjusted to the lines of all, in rounds: where views move, the run goes back to
//! the matches.

use super::{Findings, Results, Stage, StageDefinition, required};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::lines::adjustment::{AdjustmentRound, next_round, shifts_back};
use crate::lines::lines3d::reconstruct_lines;
use crate::orienting::scene::{Scene, ViewAdjustment};

/// What the last round found.
pub(super) type Found = AdjustmentRound;

pub(super) struct Adjustment;

impl StageDefinition for Adjustment {
    type Found = Found;

    const NAME: &'static str = "adjustment";
    const TITLE: &'static str = "Adjustment";
    const SECTION: &'static str = "views to their lines";
    const READS: &'static [&'static str] = &["adjustment", "lines3d"];
    const NEEDS: &'static [Stage] = &[Stage::Matches];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        if !params.adjustment.enabled {
            return Ok(Found::default());
        }
        let matches = &required(&before.matches).value;
        // Without the lines of regions, which are found with the adjusted cameras.
        let lines = || reconstruct_lines(scene, matches, &params.lines3d).0;
        Ok(next_round(scene, lines, &params.lines3d))
    }

    fn summary(scene: &Scene, found: &Found, _: &Results) -> Findings {
        // Without records of its views nothing was to be adjusted.
        let shifted = match found.views.is_empty() {
            true => Vec::new(),
            false => shifts_back(&scene.survey),
        };
        let moved = scene.views.iter().zip(&found.views).enumerate();
        let moved: Vec<_> = moved.filter(|(_, (_, of_view))| of_view.moves()).collect();
        let is_moved = |i: &usize| moved.iter().any(|(k, _)| k == i);
        let only_shifted = shifted.iter().filter(|(i, _)| !is_moved(i)).count();
        let shifted = shifted.iter().map(|&(i, _)| scene.views[i].name.clone());
        let adjusted = moved
            .iter()
            .map(|(_, (view, of_view))| words(&view.name, of_view));
        let warnings = [
            ("views that were shifted back", shifted.collect::<Vec<_>>()),
            (
                "views that were adjusted to their lines",
                adjusted.collect(),
            ),
        ];
        let warnings = warnings.into_iter().filter(|(_, views)| !views.is_empty());
        Findings {
            counts: vec![("adjusted views", only_shifted + moved.len())],
            warnings: warnings
                .map(|(what, views)| format!("{what}: {}", views.join(", ")))
                .collect(),
        }
    }
}

fn words(view: &str, found: &ViewAdjustment) -> String {
    let ViewAdjustment {
        rms_motion_px,
        turn_deg,
        move_m,
        before_px,
        after_px,
        ..
    } = found;
    format!(
        "{view} by {rms_motion_px:.2} px ({turn_deg:.4} degrees, {move_m:.3} m; its edges were \
         {before_px:.2} px from their lines, now {after_px:.2} px)"
    )
}
