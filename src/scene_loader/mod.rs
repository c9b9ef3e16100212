//! From files in memory to a [`Scene`]: what the command line and the page hand over.
//!
//! ```text
//! files -> orientation::detect   what each file is
//!       -> plan                  one orientation chosen; image <-> orientation by name; all refusals
//!       -> checks                do the cameras look down, at the same place, from above the ground
//!       -> region                part of each image that shows the region of interest
//!       -> decode, undistort     views: of large frames the parts only
//!       -> doctor, verdict       do the images agree with their cameras
//!       -> treatment             corrections, where they are asked for
//! ```
//!
//! Architecture invariant: no file system here; paths are names. [`load_scene`] and [`inspect_files`] walk the
//! same plan, so that the page's table never disagrees with a run.

mod archive;
mod checks;
mod input;
mod inspect;
mod names;
mod plan;
mod project;
mod region;
#[cfg(test)]
mod tests;
mod treatment;
mod verdict;

pub use archive::unpack;
pub use input::LoadOptions;
pub use inspect::{FileReport, ImageReport, Inspection, OrientationReport, inspect_files};
pub use project::{Project, open_project};

use nalgebra::{Matrix3, Vector3};

use crate::camera::undistort;
use crate::error::{Error, Result};
use crate::orientation::InputFile;
use crate::orientation_check::Patient;
use crate::raster::{Gray, load_image, load_window};
use crate::scene::{Scene, Survey, View};

use self::plan::{Plan, PlannedView};
use self::treatment::treat;

/// Reads a scene. The first refusal is returned; [`inspect_files`] lists them all.
pub fn load_scene(files: &[InputFile], options: &LoadOptions) -> Result<Scene> {
    let plan = Plan::new(files, options);
    let refusal = plan.errors.into_iter().next();
    if let Some(error) = refusal.clone().filter(|_| !plan.is_implausible) {
        return Err(error);
    }
    let mut views = decode_all(files, &plan.views)?;
    let patients: Vec<Patient> = (plan.views.iter().zip(&views))
        .map(|(planned, view)| patient(planned, view, plan.origin))
        .collect();
    let treated = treat(patients, refusal, options)?;
    for (view, camera) in views.iter_mut().zip(treated.cameras) {
        view.camera = camera;
    }
    let mut scene = Scene {
        views,
        origin: plan.origin + treated.origin_change,
        ground_z: options
            .ground_z
            .map(|z| z - plan.origin.z - treated.origin_change.z),
        warnings: plan.warnings.into_iter().chain(treated.warnings).collect(),
        survey: Survey {
            shifts: treated.shifts,
            doctor: Some(treated.report),
            ..plan.survey
        },
    };
    if let (Some(roi), true) = (options.roi, options.apply_fix) {
        region::cut_scene(&mut scene, roi)?;
    }
    Ok(scene)
}

/// The views as whole images, without their pixels: names, cameras and what the files say. A region of interest and
/// memory do not matter.
pub fn whole_views(files: &[InputFile], options: &LoadOptions) -> Result<Scene> {
    let options = LoadOptions {
        roi: None,
        memory_mb: Some(u32::MAX),
        ..options.clone()
    };
    let plan = Plan::new(files, &options);
    if let Some(error) = plan.errors.into_iter().next() {
        return Err(error);
    }
    let view = |planned: &PlannedView| {
        let name = files[planned.file].name().to_owned();
        let none = (Gray::new(0, 0), image::RgbImage::new(0, 0));
        View::new(name, planned.whole.clone(), none.0, none.1)
    };
    Ok(Scene {
        views: plan.views.iter().map(view).collect(),
        origin: plan.origin,
        ground_z: options.ground_z.map(|z| z - plan.origin.z),
        warnings: plan.warnings,
        survey: plan.survey,
    })
}

/// Decodes all views, at the same time where that does not take much more memory.
fn decode_all(files: &[InputFile], planned: &[PlannedView]) -> Result<Vec<View>> {
    const MOST_PIXELS: u64 = 100_000_000;
    let whole = |v: &PlannedView| u64::from(v.whole.width) * u64::from(v.whole.height);
    if planned.iter().map(whole).sum::<u64>() <= MOST_PIXELS {
        let views = crate::execution::map(planned, |_, view| decode(&files[view.file], view));
        views.into_iter().collect()
    } else {
        planned
            .iter()
            .map(|view| decode(&files[view.file], view))
            .collect()
    }
}

fn patient<'a>(planned: &PlannedView, view: &'a View, origin: Vector3<f64>) -> Patient<'a> {
    Patient {
        name: &view.name,
        camera: view.camera.clone(),
        gray: &view.gray,
        origin,
        angles: planned.angles,
        // A part of the image has no place in the frame that the file speaks of.
        crop: planned.crop.filter(|_| planned.part.is_none()),
    }
}

/// Decodes the part of a view that is used, and removes its distortion.
fn decode(file: &InputFile, planned: &PlannedView) -> Result<View> {
    let whole = &planned.whole;
    let all = [0, 0, whole.width, whole.height];
    let part = planned.part.unwrap_or(all);
    let source = match &planned.distortion {
        Some(lens) => region::source_of(part, whole, lens),
        None => part,
    };
    let mut photograph = match source == all {
        true => load_image(&file.path, &file.bytes)?,
        false => load_window(&file.path, &file.bytes, source)?,
    };
    if photograph.rgb.dimensions() != (source[2], source[3]) {
        return Err(Error::File {
            file: file.path.clone(),
            problem: "its header and its content have different sizes".to_owned(),
            advice: "export it again".to_owned(),
        });
    }
    let [column, row, width, height] = part;
    if let Some(lens) = &planned.distortion {
        let k = moved(&whole.k, [source[0], source[1]]);
        photograph = undistort(&photograph, &k, lens);
    }
    if source != part {
        photograph = photograph.crop([column - source[0], row - source[1], width, height]);
    }
    let name = file.name().to_owned();
    Ok(View::new(
        name,
        planned.camera(),
        photograph.gray,
        photograph.rgb,
    ))
}

/// The calibration of a part that begins at this column and row.
fn moved(k: &Matrix3<f64>, [column, row]: [u32; 2]) -> Matrix3<f64> {
    let mut k = *k;
    k[(0, 2)] -= f64::from(column);
    k[(1, 2)] -= f64::from(row);
    k
}
