//! Loading a scene: plan, decoding, orientation check, corrections.

use super::checks::camera_checks::check_cameras;
use super::checks::check_and_correct;
use super::decode::{decode_all, needed};
use super::ground::{files_of_ground, files_of_settling, plan_scene, settled, whole_plan};
use super::input::LoadOptions;
use super::inspect::{box_of_views, shown_places};
use super::known_files::KnownOf;
use super::plan::Plan;
use super::planned_view::PlannedView;
use super::region;
use crate::base::agreement::{AgreementReport, Finding};
use crate::base::error::{Error, Result};
use crate::orienting::known::WorldSystem;
use crate::orienting::orientation::{FileKind, FileSource, InputFile};
use crate::orienting::orientation_check::CheckedView;
use crate::orienting::scene::{Scene, Survey, View};
use crate::photographs::camera::Camera;
use crate::photographs::raster::Gray;

/// Reads a scene. The first refusal is returned; [`inspect_files`](super::inspect_files) lists them
/// all.
pub fn load_scene(files: &[InputFile], options: &LoadOptions) -> Result<Scene> {
    load_planned(plan_scene(files, options), files, options)
}

/// A scene that is planned, the photographs of its views being whole.
pub struct PlannedScene {
    plan: Plan,
    options: LoadOptions,
}

impl PlannedScene {
    /// Plans a scene of files of which the photographs are made whole as their pixels are needed.
    /// An error says which of them cannot be had; a scene that is refused is so by `load`.
    pub fn new(source: &mut dyn FileSource, options: &LoadOptions) -> Result<Self> {
        source.hold(&|files| files_of_settling(files, options))?;
        let options = settled(source.files(), options);
        source.hold(&|files| files_of_ground(files, &options))?;
        let plan = plan_scene(source.files(), &options);
        let is_refused = !plan.errors.is_empty() && !plan.is_implausible;
        source.hold(&|files| match is_refused {
            true => Vec::new(),
            false => plan.views.iter().map(|view| needed(files, view)).collect(),
        })?;
        Ok(Self { plan, options })
    }

    /// Reads the scene, as [`load_scene`] does, of the files of the same source.
    pub fn load(self, files: &[InputFile]) -> Result<Scene> {
        load_planned(self.plan, files, &self.options)
    }
}

fn load_planned(plan: Plan, files: &[InputFile], options: &LoadOptions) -> Result<Scene> {
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
        return Err(cut_before(unit.name()));
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
        warnings: (plan.warnings.into_iter().chain(placement_warnings))
            .chain(checked.warnings)
            .collect(),
        survey: Survey {
            shifts: checked.shifts,
            agreement: Some(checked.report),
            ..plan.survey
        },
        ..Scene::default()
    };
    add_known(&mut scene, files, &plan.kinds, options)?;
    if let (Some(roi), true) = (options.roi, plan.is_cut_later) {
        region::cut_scene(&mut scene, roi, options.max_views)?;
    }
    Ok(scene)
}

fn cut_before(unit: &str) -> Error {
    Error::scene(
        format!(
            "the images show that the angles are in {unit}, but the region of interest was cut \
             before, for want of memory"
        ),
        format!("state the unit in the list (\"# angles in {unit}\")"),
    )
}

/// Adds the region of interest and what is known of it.
fn add_known(
    scene: &mut Scene,
    files: &[InputFile],
    kinds: &[FileKind],
    options: &LoadOptions,
) -> Result<()> {
    let local = |[x0, y0, x1, y1]: [f64; 4]| {
        let [x, y] = [scene.origin.x, scene.origin.y];
        [x0 - x, y0 - y, x1 - x, y1 - y]
    };
    scene.region = options.roi.map(local);
    let (known, warnings) = known_of(scene, options).read(files, kinds)?;
    scene.known = known;
    scene.warnings.extend(warnings);
    Ok(())
}

/// The scene as what is known of it is read, as far as the views tell how high the ground is.
fn known_of<'a>(scene: &Scene, options: &'a LoadOptions) -> KnownOf<'a> {
    let named: Vec<(&str, &Camera)> = (scene.views.iter())
        .map(|view| (&*view.name, &view.camera))
        .collect();
    let cameras: Vec<&Camera> = scene.views.iter().map(|view| &view.camera).collect();
    let heights = check_cameras(&named, scene.ground_z).heights;
    let shown = heights.map(|[low, high]| shown_places(&cameras, 0.5 * (low + high)));
    let (places, step) = shown.unwrap_or_default();
    let of_views = || box_of_views(&cameras, heights?);
    KnownOf {
        system: WorldSystem {
            epsg: scene.survey.epsg,
            anchor: scene.survey.anchor,
        },
        origin: scene.origin,
        area: scene.region.or_else(of_views),
        shown_m2: places.len() as f64 * step * step,
        places,
        options,
    }
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
        warnings: [plan.warnings, plan.placement_warnings].concat(),
        survey: plan.survey,
        ..Scene::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::orientation::Needed;
    use crate::orienting::synthetic::{gable_scene, to_files};

    /// Photographs by the first half of their bytes, and as a whole.
    struct Halves {
        whole: Vec<InputFile>,
        files: Vec<InputFile>,
        /// How many were filled at the same time.
        most: usize,
    }

    impl FileSource for Halves {
        fn files(&self) -> &[InputFile] {
            &self.files
        }

        fn hold(&mut self, needed: &dyn Fn(&[InputFile]) -> Vec<Needed>) -> Result<()> {
            let needed: Vec<usize> = needed(&self.files).iter().map(|one| one.file).collect();
            for (i, file) in self.files.iter_mut().enumerate() {
                match needed.contains(&i) {
                    true => file.fill(self.whole[i].bytes.clone()),
                    false => {
                        file.empty();
                        false
                    }
                };
            }
            let filled = self.files.iter().filter(|file| file.is_filled()).count();
            self.most = self.most.max(filled);
            Ok(())
        }
    }

    #[test]
    fn photographs_are_whole_only_as_their_pixels_are_needed() {
        let (scene, truth) = gable_scene(96);
        let whole: Vec<InputFile> = (to_files(&scene).iter())
            .map(|(path, bytes)| InputFile::new(path, bytes.clone()))
            .collect();
        let half = |file: &InputFile| file.half().unwrap_or(file.clone());
        let files: Vec<InputFile> = whole.iter().map(half).collect();
        let images = files.iter().filter(|file| file.lacking().is_some());
        assert_eq!(images.count(), 6);
        let [x, y, z] = scene.origin.into();
        // The ground is measured in four photographs, unless it is stated.
        for (ground_z, most) in [(None, 4), (Some(z + truth.ground_z), 3)] {
            let options = LoadOptions {
                orientation: Some("colmap".to_owned()),
                roi: Some([x - 12.0, y - 12.0, x + 12.0, y + 12.0]),
                max_views: Some(3),
                ground_z,
                ..LoadOptions::default()
            };
            let mut halves = Halves {
                whole: whole.clone(),
                files: files.clone(),
                most: 0,
            };
            let planned = PlannedScene::new(&mut halves, &options).unwrap();
            let loaded = planned.load(halves.files()).unwrap();
            let expected = load_scene(&whole, &options).unwrap();
            assert_eq!(loaded.warnings, expected.warnings);
            assert_eq!((loaded.views.len(), halves.most), (3, most));
            for (a, b) in loaded.views.iter().zip(&expected.views) {
                assert_eq!((&a.name, &a.camera, &a.rgb), (&b.name, &b.camera, &b.rgb));
            }
        }
    }
}
