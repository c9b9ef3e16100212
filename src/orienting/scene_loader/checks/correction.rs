//! The orientation check of a scene, and corrections of its cameras where the user asked for them.

use nalgebra::Vector3;

use super::camera_checks::{self, CameraChecks};
use super::consequence::warning_or_refusal;
use crate::base::agreement::{Agreement, AgreementReport};
use crate::base::error::{Error, Result, listed};
use crate::orienting::orientation::AngleUnit;
use crate::orienting::orientation_check::{
    AngleReadings, CheckFinding, CheckedView, OrientationCheck, cameras_in, check_orientation,
    try_angle_readings,
};
use crate::orienting::scene::ViewShift;
use crate::orienting::scene_loader::input::LoadOptions;
use crate::photographs::camera::Camera;

/// Cameras as they are to be used, what was found and what was corrected.
pub(crate) struct CheckedCameras {
    pub cameras: Vec<Camera>,
    /// To be added to the origin of the scene: corrected cameras may lie elsewhere.
    pub origin_change: Vector3<f64>,
    pub shifts: Vec<ViewShift>,
    pub report: AgreementReport,
    pub warnings: Vec<String>,
    /// The unit of the angles, where the images decided for another one than was guessed.
    pub reread: Option<AngleUnit>,
}

/// Checks the orientation of views and corrects it where the options ask for it. `refusal` is the
/// one that the positions of the cameras alone gave reason for.
pub(crate) fn check_and_correct(
    mut views: Vec<CheckedView>,
    mut refusal: Option<Error>,
    options: &LoadOptions,
) -> Result<CheckedCameras> {
    let mut warnings = Vec::new();
    let mut reread = None;
    if let Some(readings) = try_angle_readings(&views) {
        warnings.push(words_of_readings(&readings));
        reread = readings.decided.filter(|unit| *unit != readings.guess);
        if let Some(cameras) = reread.and_then(|unit| cameras_in(&views, unit)) {
            for (view, camera) in views.iter_mut().zip(cameras) {
                view.camera = camera;
            }
            let found = check_places(&views, options);
            refusal = found.errors.into_iter().next();
            warnings.extend(found.warnings);
        }
    } else if views.iter().all(|v| !v.readings.is_empty()) {
        warnings.extend(words_of_guess(&views));
    }
    let mut origin_change = Vector3::zeros();
    let mut check = check_orientation(&views);
    if options.apply_fix
        && let Some(correction) = correction(&check.finding, &views)
    {
        warnings.push(correction.words);
        origin_change = camera_checks::scene_origin(correction.cameras.iter());
        for (view, mut camera) in views.iter_mut().zip(correction.cameras) {
            camera.center -= origin_change;
            view.camera = camera;
            view.origin += origin_change;
        }
        let errors = check_places(&views, options).errors;
        errors.into_iter().next().map_or(Ok(()), Err)?;
        check = check_orientation(&views);
        refusal = None;
    }
    let warning = warning_or_refusal(&check, &views, refusal, options.ignore_check);
    warnings.extend(warning?);
    warnings.extend(words_of_shifts(&check, &views));
    Ok(CheckedCameras {
        cameras: views.iter().map(|v| v.camera.clone()).collect(),
        origin_change,
        report: check.report(),
        shifts: check.shifts,
        warnings,
        reread,
    })
}

/// Checks where the cameras of views stand.
fn check_places(views: &[CheckedView], options: &LoadOptions) -> CameraChecks {
    let ground_z = options.ground_z.map(|z| z - views[0].origin.z);
    let named: Vec<(&str, &Camera)> = views.iter().map(|v| (v.name, &v.camera)).collect();
    camera_checks::check_cameras(&named, ground_z)
}

/// Which unit was taken, and why.
fn words_of_readings(readings: &AngleReadings) -> String {
    let figure = |(unit, agreement): &(AngleUnit, Agreement)| {
        format!("{} {:.2}", unit.name(), agreement.score)
    };
    let figures = listed(readings.agreements.iter().map(figure));
    match readings.decided {
        Some(unit) => format!(
            "the angles were read in {}: so the images agree best ({figures}, where 0 is chance and 1 \
             perfect)",
            unit.name()
        ),
        None => format!(
            "the angles were read in {}, under which the views look at one place; the images do not \
             decide ({figures})",
            readings.guess.name()
        ),
    }
}

/// The unit that was guessed, where the images cannot be asked.
fn words_of_guess(views: &[CheckedView]) -> Option<String> {
    let first = views.first()?;
    let (unit, _) = (first.readings.iter()).find(|(_, r)| *r == first.camera.r)?;
    Some(format!(
        "the angles were read in {}, under which the views look at one place; the images do not decide",
        unit.name()
    ))
}

struct Correction {
    cameras: Vec<Camera>,
    words: String,
}

/// The cameras without the error that the check identified.
fn correction(finding: &CheckFinding, views: &[CheckedView]) -> Option<Correction> {
    let (hypothesis, words) = match finding {
        CheckFinding::Explained {
            before,
            after,
            hypothesis,
            words,
        } => (
            hypothesis,
            format!(
                "the orientation was corrected: {words} (agreement with the images {:.2}, before {:.2})",
                after.score, before.score
            ),
        ),
        CheckFinding::Offset {
            hypothesis,
            offsets_px: [before, after],
            words,
            ..
        } => (
            hypothesis,
            format!(
                "the orientation was corrected: {words} (mean offset {after:.2} px, before {before:.2} px)"
            ),
        ),
        _ => return None,
    };
    Some(Correction {
        cameras: hypothesis.corrected_cameras(views)?,
        words,
    })
}

/// The names of shifted views.
fn words_of_shifts(check: &OrientationCheck, views: &[CheckedView]) -> Option<String> {
    // Half a pixel in all views is an error of its own, which has been named.
    if matches!(check.finding, CheckFinding::Offset { .. }) {
        return None;
    }
    let shifted = check.shifts.iter().zip(views);
    let names: Vec<String> = (shifted.filter(|(shift, _)| shift.is_significant()))
        .map(|(shift, view)| {
            let [x, y] = shift.shift_px;
            format!("{} by ({x:+.2}, {y:+.2}) px", view.name)
        })
        .collect();
    let words = "views that are shifted against the others";
    (!names.is_empty()).then(|| format!("{words}: {}", listed(names.iter())))
}
