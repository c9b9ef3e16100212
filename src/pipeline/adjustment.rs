//! The orientation of a scene adjusted to the lines that its own images show: the stages up to the
//! lines, then [`crate::adjustment`], and all of it once more, because better cameras find more
//! lines.

use super::{Run, Stage};
use crate::adjustment::adjust_views;
use crate::error::Result;
use crate::execution::silent;
use crate::orientation::InputFile;
use crate::params::{Method, Params};
use crate::scene::{Scene, ViewAdjustment};
use crate::scene_loader::{LoadOptions, load_scene};

/// Rounds of matching and adjusting.
const ROUNDS: usize = 3;

/// [`load_scene`], and the adjustment where the options ask for it.
pub fn load_adjusted(files: &[InputFile], options: &LoadOptions, params: &Params) -> Result<Scene> {
    let scene = load_scene(files, options)?;
    Ok(match options.adjust {
        true => adjust_orientation(scene, params),
        false => scene,
    })
}

/// The scene with its cameras adjusted; a warning names the views that were. Sound orientations
/// stay as they are.
pub fn adjust_orientation(scene: Scene, params: &Params) -> Scene {
    // Whatever finds the roofs: it is lines that tell how the views lie.
    let params = Params {
        method: Method::Lines,
        ..params.clone()
    };
    let mut run = Run::new(scene, params);
    let mut total: Vec<ViewAdjustment> = Vec::new();
    for _ in 0..ROUNDS {
        run.step(Stage::Lines, &silent());
        let lines = run.results.lines.as_ref().expect("the stage has run");
        let (cameras, found) = adjust_views(&run.scene, &lines.value, &run.params.lines3d);
        let ends = found.iter().all(|view| view.rms_motion_px == 0.0);
        total = match total.is_empty() {
            true => found,
            false => total.into_iter().zip(found).map(together).collect(),
        };
        if ends {
            break;
        }
        for (view, camera) in run.scene.views.iter_mut().zip(cameras) {
            view.camera = camera;
        }
        run.drop_from(Stage::Matches);
    }
    let mut scene = run.scene;
    let named: Vec<String> = (scene.views.iter().zip(&total))
        .filter(|(_, t)| t.rms_motion_px > 0.0)
        .map(|(view, t)| {
            format!(
                "{} by {:.2} px ({:.4} degrees, {:.3} m; its edges were {:.2} px from their lines, now {:.2} px)",
                view.name, t.rms_motion_px, t.turn_deg, t.move_m, t.before_px, t.after_px
            )
        })
        .collect();
    if !named.is_empty() {
        let words = format!(
            "views that were adjusted to their lines: {}",
            named.join(", ")
        );
        scene.warnings.push(words);
    }
    scene.survey.adjustments = total;
    scene
}

/// Two rounds as one; motions that follow each other add up, at most.
fn together((first, second): (ViewAdjustment, ViewAdjustment)) -> ViewAdjustment {
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
