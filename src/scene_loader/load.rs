//! Loading a scene: plan, decoding, orientation check, corrections.

use super::checks::check_and_correct;
use super::decode::decode_all;
use super::ground::{plan_scene, settled, whole_plan};
use super::input::LoadOptions;
use super::known_files::read_known;
use super::planned_view::PlannedView;
use super::region;
use crate::agreement::{AgreementReport, Finding};
use crate::error::{Error, Result};
use crate::known::{Known, WorldSystem};
use crate::orientation::InputFile;
use crate::orientation_check::CheckedView;
use crate::raster::Gray;
use crate::scene::{Scene, Survey, View};

/// Reads a scene. The first refusal is returned; [`inspect_files`](super::inspect_files) lists them
/// all.
pub fn load_scene(files: &[InputFile], options: &LoadOptions) -> Result<Scene> {
    let plan = plan_scene(files, options);
    let refusal = plan.errors.into_iter().next();
    if let Some(error) = refusal.clone().filter(|_| !plan.is_implausible) {
        return Err(error);
    }
    let mut views = decode_all(files, &plan.views)?;
    let checked: Vec<CheckedView> = (plan.views.iter().zip(&views))
        .map(|(planned, view)| planned.checked(view, plan.origin))
        .collect();
    let checked = check_and_correct(checked, refusal, options);
    if let (Some(error), false) = (plan.unless_agreed, options.ignore_check)
        && !checked.as_ref().is_ok_and(|c| agrees(&c.report))
    {
        return Err(error);
    }
    let checked = checked?;
    if let (Some(unit), Some(_), false) = (checked.reread, options.roi, plan.is_cut_later) {
        return Err(Error::Scene {
            problem: format!(
                "the images show that the angles are in {}, but the region of interest was cut \
                 before, for want of memory",
                unit.name()
            ),
            advice: format!(
                "state the unit in the list (\"# angles in {}\")",
                unit.name()
            ),
        });
    }
    // What was said of cameras with the angles read otherwise is out of date.
    let placement_warnings = match checked.reread {
        Some(_) => Vec::new(),
        None => plan.placement_warnings,
    };
    for (view, camera) in views.iter_mut().zip(checked.cameras) {
        view.camera = camera;
    }
    let mut scene = Scene {
        views,
        origin: plan.origin + checked.origin_change,
        ground_z: options
            .ground_z
            .map(|z| z - plan.origin.z - checked.origin_change.z),
        region: None,
        known: Known::default(),
        warnings: (plan.warnings.into_iter().chain(placement_warnings))
            .chain(checked.warnings)
            .collect(),
        survey: Survey {
            shifts: checked.shifts,
            agreement: Some(checked.report),
            ..plan.survey
        },
    };
    let system = WorldSystem {
        epsg: scene.survey.epsg,
        anchor: scene.survey.anchor,
    };
    let known = read_known(files, &plan.kinds, options, &system, scene.origin)?;
    scene.known = known.0;
    scene.warnings.extend(known.1);
    let local = |[x0, y0, x1, y1]: [f64; 4]| {
        let [x, y] = [scene.origin.x, scene.origin.y];
        [x0 - x, y0 - y, x1 - x, y1 - y]
    };
    scene.region = options.roi.map(local);
    if let (Some(roi), true) = (options.roi, plan.is_cut_later) {
        region::cut_scene(&mut scene, roi, options.max_views)?;
    }
    Ok(scene)
}

/// Do the images agree, each with some others?
fn agrees(report: &AgreementReport) -> bool {
    matches!(report.finding, Finding::Sound | Finding::Offset)
}

/// The views as whole images, without their pixels: names, cameras and reference system. Region of
/// interest and memory limit are ignored.
pub fn whole_views(files: &[InputFile], options: &LoadOptions) -> Result<Scene> {
    let plan = whole_plan(files, &settled(files, options));
    if let Some(error) = plan.errors.into_iter().next() {
        return Err(error);
    }
    let view = |planned: &PlannedView| {
        let none = (Gray::new(0, 0), image::RgbImage::new(0, 0));
        View::new(planned.name.clone(), planned.whole.clone(), none.0, none.1)
    };
    Ok(Scene {
        views: plan.views.iter().map(view).collect(),
        origin: plan.origin,
        ground_z: options.ground_z.map(|z| z - plan.origin.z),
        region: None,
        known: Known::default(),
        warnings: [plan.warnings, plan.placement_warnings].concat(),
        survey: plan.survey,
    })
}
