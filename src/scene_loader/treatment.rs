//! What becomes of a scene after the doctor: a refusal, a warning, or, where the user asked for it, a correction.

use nalgebra::Vector3;

use super::checks;
use super::input::LoadOptions;
use super::names::listed;
use super::verdict::verdict;
use crate::agreement::AgreementReport;
use crate::camera::Camera;
use crate::error::{Error, Result};
use crate::orientation_check::{Diagnosis, Examination, Patient, examine};
use crate::scene::ViewShift;

/// Cameras as they are to be used, and what was found and done.
pub(crate) struct Treated {
    pub cameras: Vec<Camera>,
    /// To be added to the origin of the scene: other cameras may stand elsewhere.
    pub origin_change: Vector3<f64>,
    pub shifts: Vec<ViewShift>,
    pub report: AgreementReport,
    pub warnings: Vec<String>,
}

/// Examines views and corrects what may be corrected. `refusal` is what the places of the cameras alone gave reason
/// to say.
pub(crate) fn treat(
    mut patients: Vec<Patient>,
    refusal: Option<Error>,
    options: &LoadOptions,
) -> Result<Treated> {
    let mut warnings = Vec::new();
    let mut origin_change = Vector3::zeros();
    let mut found = examine(&patients);
    if options.apply_fix
        && let Some(fixed) = fixed(&found.diagnosis, &patients)
    {
        warnings.push(fixed.words);
        origin_change = checks::scene_origin(fixed.cameras.iter());
        for (patient, mut camera) in patients.iter_mut().zip(fixed.cameras) {
            camera.center -= origin_change;
            patient.camera = camera;
            patient.origin += origin_change;
        }
        let ground_z = options.ground_z.map(|z| z - patients[0].origin.z);
        let named: Vec<(&str, &Camera)> = patients.iter().map(|p| (p.name, &p.camera)).collect();
        if let Some(error) = checks::check_cameras(&named, ground_z)
            .errors
            .into_iter()
            .next()
        {
            return Err(error);
        }
        found = examine(&patients);
        warnings.extend(verdict(&found, &patients, None)?);
    } else {
        warnings.extend(verdict(&found, &patients, refusal)?);
    }
    let mut cameras: Vec<Camera> = patients.iter().map(|p| p.camera.clone()).collect();
    warnings.extend(shift_views(&found, &patients, &mut cameras, options.adjust));
    Ok(Treated {
        cameras,
        origin_change,
        report: found.report(),
        shifts: found.shifts,
        warnings,
    })
}

struct Fixed {
    cameras: Vec<Camera>,
    words: String,
}

/// The cameras without the mistake that the doctor names.
fn fixed(diagnosis: &Diagnosis, patients: &[Patient]) -> Option<Fixed> {
    let (suspect, words) = match diagnosis {
        Diagnosis::Explained {
            before,
            after,
            suspect,
            words,
        } => (
            suspect,
            format!(
                "the orientation was corrected: {words} (agreement with the images {:.2}, before {:.2})",
                after.score, before.score
            ),
        ),
        Diagnosis::Offset {
            suspect,
            offsets_px: [before, after],
            words,
            ..
        } => (
            suspect,
            format!(
                "the orientation was corrected: {words} (mean offset {after:.2} px, before {before:.2} px)"
            ),
        ),
        _ => return None,
    };
    Some(Fixed {
        cameras: suspect.treated(patients)?,
        words,
    })
}

/// Names views that are shifted, or shifts them back.
fn shift_views(
    found: &Examination,
    patients: &[Patient],
    cameras: &mut [Camera],
    adjust: bool,
) -> Option<String> {
    // Half a pixel in all views is a mistake of its own, which has been named.
    if matches!(found.diagnosis, Diagnosis::Offset { .. }) {
        return None;
    }
    let mut names = Vec::new();
    for ((shift, patient), camera) in found.shifts.iter().zip(patients).zip(cameras) {
        let [x, y] = shift.shift_px;
        if shift.is_significant() {
            names.push(format!("{} by ({x:+.2}, {y:+.2}) px", patient.name));
            if adjust {
                camera.k[(0, 2)] += x;
                camera.k[(1, 2)] += y;
            }
        }
    }
    let done = if adjust {
        "were shifted back"
    } else {
        "are shifted against the others (--adjust shifts them back)"
    };
    (!names.is_empty()).then(|| format!("views that {done}: {}", listed(names.iter())))
}
