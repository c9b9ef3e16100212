//! Rounds of the adjustment: better cameras find more lines, which tell more of the cameras.

use super::adjust_views;
use crate::base::agreement::Finding;
use crate::base::params::Lines3dParams;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::{Scene, Survey, ViewAdjustment, ViewShift};
use crate::photographs::camera::Camera;

/// Most rounds of matching and adjusting in which views move.
const MOST_ROUNDS: usize = 3;

/// What a round found.
#[derive(Clone, Debug, Default)]
pub struct AdjustmentRound {
    /// Cameras with which the lines are to be found again; `None` where all views stay.
    pub cameras: Option<Vec<Camera>>,
    /// How each view was adjusted, in all rounds.
    pub views: Vec<ViewAdjustment>,
}

/// Largest shift of a view, in distances of its matches from where the others put them. Measured:
/// true ones are 1 to 2.3 times as large, wrong ones 5 to 11 times.
const BORNE_OUT: f64 = 3.0;

/// The views that are shifted against the others, and by how much. None where one of the shifts is
/// not borne out by the distances that it should explain: it runs along the epipolar lines, where
/// other heights explain it as well, and few views tell the two apart.
pub(crate) fn shifts_back(survey: &Survey) -> Vec<(usize, ViewShift)> {
    // Half a pixel in all views is an error of its own, which has been named.
    let is_offset = (survey.agreement.as_ref()).is_some_and(|a| a.finding == Finding::Offset);
    let shifts = survey.shifts.iter().copied().enumerate();
    let shifted: Vec<_> = shifts
        .filter(|(_, shift)| shift.is_significant() && !is_offset)
        .collect();
    let is_borne_out = |(_, shift): &(usize, ViewShift)| {
        let [x, y] = shift.shift_px;
        crate::base::math::hypot(x, y) <= BORNE_OUT * shift.before_px
    };
    match shifted.iter().all(is_borne_out) {
        true => shifted,
        false => Vec::new(),
    }
}

/// The next round of a scene whose earlier ones stand in its survey. `lines` are not asked for
/// after the last one.
pub(crate) fn next_round(
    scene: &Scene,
    lines: impl FnOnce() -> Vec<Line3d>,
    params: &Lines3dParams,
) -> AdjustmentRound {
    let Survey {
        adjustments: before,
        adjustment_rounds: rounds,
        ..
    } = &scene.survey;
    if *rounds >= MOST_ROUNDS {
        return AdjustmentRound {
            cameras: None,
            views: before.clone(),
        };
    }
    let (cameras, found) = adjust_views(scene, &lines(), params);
    let moves = found.iter().any(ViewAdjustment::moves);
    AdjustmentRound {
        cameras: moves.then_some(cameras),
        views: match before.is_empty() {
            true => found,
            false => before.iter().zip(found).map(together).collect(),
        },
    }
}

/// Two rounds as one; motions that follow each other add up, at most.
fn together((first, second): (&ViewAdjustment, ViewAdjustment)) -> ViewAdjustment {
    let motion_px = [0, 1].map(|i| first.motion_px[i] + second.motion_px[i]);
    ViewAdjustment {
        motion_px,
        rms_motion_px: first.rms_motion_px + second.rms_motion_px,
        turn_deg: first.turn_deg + second.turn_deg,
        move_m: first.move_m + second.move_m,
        before_px: first.before_px,
        ..second
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shifts_that_nothing_bears_out_are_not_taken_back() {
        let shift = |x: f64, before_px: f64| ViewShift {
            shift_px: [x, 0.0],
            sigma_px: 0.02,
            before_px,
            after_px: 0.1,
            places: 200,
        };
        let taken_back = |shifts: &[ViewShift]| {
            let survey = Survey {
                shifts: shifts.to_vec(),
                ..Survey::default()
            };
            shifts_back(&survey).len()
        };
        assert_eq!(taken_back(&[shift(0.7, 0.4), ViewShift::default()]), 1);
        let along_the_rays = shift(2.0, 0.3);
        assert_eq!(taken_back(&[shift(0.7, 0.4), along_the_rays]), 0);
    }
}
