//! From files in memory to a [`Scene`]: what the command line and the page hand over.
//!
//! ```text
//! files -> orientation::detect   what each file is
//!       -> plan                  one orientation chosen; image <-> orientation by name; all refusals
//!       -> checks                do the cameras look down, at the same place, from above the ground
//!       -> region                part of each image that shows the region of interest
//!       -> decode, undistort     views
//!       -> doctor, verdict       do the images agree with their cameras
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
mod region;
mod verdict;

pub use archive::unpack;
pub use input::{InputFile, LoadOptions};
pub use inspect::{FileReport, ImageReport, Inspection, OrientationReport, inspect_files};

use nalgebra::Vector3;

use crate::camera::undistort;
use crate::doctor::{Patient, examine};
use crate::raster::load_image;
use crate::scene::{Scene, View};
use crate::{Error, Result};

use plan::{Plan, PlannedView};
use verdict::verdict;

/// Reads a scene. The first refusal is returned; [`inspect_files`] lists them all.
pub fn load_scene(files: &[InputFile], options: &LoadOptions) -> Result<Scene> {
    let plan = Plan::new(files, options);
    let refusal = plan.errors.into_iter().next();
    if let Some(error) = refusal.clone().filter(|_| !plan.is_implausible) {
        return Err(error);
    }
    let views = crate::parallel::map(&plan.views, |_, view| decode(&files[view.file], view));
    let views: Vec<View> = views.into_iter().collect::<Result<_>>()?;
    let patients: Vec<Patient> = (plan.views.iter().zip(&views))
        .map(|(planned, view)| patient(planned, view, plan.origin))
        .collect();
    let warning = verdict(examine(&patients), &patients, refusal)?;
    Ok(Scene {
        views,
        origin: plan.origin,
        ground_z: options.ground_z.map(|z| z - plan.origin.z),
        warnings: plan.warnings.into_iter().chain(warning).collect(),
    })
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

/// Decodes one view, removes its distortion and cuts out its part.
fn decode(file: &InputFile, planned: &PlannedView) -> Result<View> {
    let mut photograph = load_image(&file.path, &file.bytes)?;
    let whole = &planned.whole;
    if photograph.rgb.dimensions() != (whole.width, whole.height) {
        return Err(Error::File {
            file: file.path.clone(),
            problem: "its header and its content have different sizes".to_owned(),
            advice: "export it again".to_owned(),
        });
    }
    if let Some(lens) = &planned.distortion {
        photograph = undistort(&photograph, &whole.k, lens);
    }
    if let Some(part) = planned.part {
        photograph = photograph.crop(part);
    }
    Ok(View {
        name: file.name().to_owned(),
        camera: planned.camera(),
        gray: photograph.gray,
        rgb: photograph.rgb,
    })
}

#[cfg(test)]
mod tests;
