//! The cameras of a run: as its scene states them, and as the adjustment moves them.

use super::{Run, Stage};
use crate::lines::adjustment::shifts_back;
use crate::orienting::scene::ViewShift;

impl Run {
    /// Puts the cameras where the run begins: as stated, with the shifts of single views taken
    /// back where views are to be adjusted.
    pub(super) fn restore_cameras(&mut self) {
        let is_adjusted = self.params.adjustment.enabled
            && Stage::of(self.params.method).contains(&Stage::Adjustment);
        let survey = &mut self.scene.survey;
        survey.adjustments.clear();
        survey.adjustment_rounds = 0;
        let shifts = match is_adjusted {
            true => shifts_back(survey),
            false => Vec::new(),
        };
        for (view, stated) in self.scene.views.iter_mut().zip(&self.stated) {
            view.camera = stated.clone();
        }
        for (view, ViewShift { shift_px, .. }) in shifts {
            let k = &mut self.scene.views[view].camera.k;
            k[(0, 2)] += shift_px[0];
            k[(1, 2)] += shift_px[1];
        }
    }

    /// After a round of the adjustment: where views moved, the stages from the matches on are to
    /// run once more.
    pub(super) fn take_round(&mut self) {
        let Some(round) = &self.results.adjustment else {
            return;
        };
        let survey = &mut self.scene.survey;
        survey.adjustments.clone_from(&round.views);
        let Some(cameras) = &round.cameras else {
            return;
        };
        survey.adjustment_rounds += 1;
        for (view, camera) in self.scene.views.iter_mut().zip(cameras) {
            view.camera = camera.clone();
        }
        self.drop_from(Stage::Matches);
    }
}
