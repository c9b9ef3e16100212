//! The views of images and their orientations, in the local frame and checked together.

use std::collections::BTreeMap;

use super::Plan;
use crate::base::error::{Error, listed};
use crate::orienting::orientation::{InputFile, Orientation};
use crate::orienting::scene_loader::assignment::{factor_in_words, resized, scale};
use crate::orienting::scene_loader::checks::camera_checks;
use crate::orienting::scene_loader::input::LoadOptions;
use crate::orienting::scene_loader::memory;
use crate::orienting::scene_loader::names::view_names;
use crate::orienting::scene_loader::planned_view::{PlannedView, planned_view};
use crate::orienting::scene_loader::region::RegionOfInterest;
use crate::photographs::camera::{Camera, FEWEST_VIEWS};

impl Plan {
    /// Forms views in the local frame and checks them together.
    pub(super) fn form_views(
        &mut self,
        files: &[InputFile],
        options: &LoadOptions,
        ground: Option<[f64; 2]>,
    ) {
        let mut views = self.views_of_images(files, options);
        if views.len() < FEWEST_VIEWS && self.errors.is_empty() {
            self.errors.push(too_few(files, &views));
        }
        if views.len() < FEWEST_VIEWS {
            self.views = views;
            return;
        }
        self.warnings.extend(notice_of_fisheyes(&views));
        self.warnings.extend(notice_of_reduction(options));
        let heights = self.place_views(files, options, &mut views);
        // A wrong orientation projects the region elsewhere: then it is cut after the correction,
        // and after the images have decided about the angles, where there is memory for that.
        let is_undecided = views.iter().all(|v| !v.readings.is_empty());
        let whole_fits = || {
            let bytes = memory::peak_bytes(files, &views, None);
            memory::check_memory(bytes, &views, options.memory_mb).is_none()
        };
        self.is_cut_later = options.apply_fix || is_undecided && whole_fits();
        let cut_now = !self.is_cut_later;
        let known = options.ground_range;
        let known = known.map(|range| range.map(|height| height - self.origin.z));
        let heights = known.or(ground).or(heights);
        if let (Some(roi), Some(heights), true) = (options.roi, heights, cut_now) {
            let roi = RegionOfInterest::new(roi, &self.origin, heights);
            match roi.and_then(|roi| roi.cut(files, &mut views, options.max_views)) {
                Ok(cut) => {
                    self.warnings.extend(cut.warnings);
                    self.is_chosen = cut.is_chosen;
                }
                Err(error) => self.errors.push(error),
            }
        }
        // On ground that is known there has been a first look, and a plan of what roofs take.
        let roofs_m2 = options.ground_range.map(|_| 0.0);
        self.peak_bytes = memory::peak_bytes(files, &views, roofs_m2);
        let too_large = memory::check_memory(self.peak_bytes, &views, options.memory_mb);
        self.is_implausible &= too_large.is_none();
        self.errors.extend(too_large);
        self.views = views;
    }

    /// The images that have an orientation as views, in the frame of the input.
    fn views_of_images(&mut self, files: &[InputFile], options: &LoadOptions) -> Vec<PlannedView> {
        let mut views = Vec::new();
        let mut scaled: BTreeMap<String, Vec<&str>> = BTreeMap::new();
        for image in &self.images {
            let (Some(header), Some(orientation)) = (&image.header, &image.orientation) else {
                continue;
            };
            let path = &*files[image.file].path;
            let size = [header.width, header.height];
            let stated = orientation.size.map(|(w, h)| [w, h]).filter(|&s| s != size);
            let view = match stated.and_then(|stated| scale(stated, size)) {
                Some(factors) => {
                    let words = factor_in_words(factors[0]);
                    scaled.entry(words).or_default().push(path);
                    let orientation = &Orientation {
                        size: None,
                        ..resized(orientation, factors)
                    };
                    planned_view(path, image.file, header, orientation)
                }
                None => planned_view(path, image.file, header, orientation),
            };
            match view {
                Ok(mut view) => {
                    view.reduce(options.reduction.unwrap_or(1.0));
                    views.push(view);
                }
                Err(error) => self.errors.push(error),
            }
        }
        let paths: Vec<&str> = views.iter().map(|v| &*files[v.file].path).collect();
        for (view, name) in views.iter_mut().zip(view_names(&paths)) {
            view.name = name;
        }
        for (factor, paths) in scaled {
            self.warnings.push(format!(
                "images of {factor} the size that their orientation states, whose cameras were scaled: {}",
                listed(paths)
            ));
        }
        views
    }

    /// Counts the places of the cameras from an origin of the scene and checks them; the heights
    /// between which the ground lies, where they tell it.
    fn place_views(
        &mut self,
        files: &[InputFile],
        options: &LoadOptions,
        views: &mut [PlannedView],
    ) -> Option<[f64; 2]> {
        self.origin = camera_checks::scene_origin(views.iter().map(|v| &v.whole));
        for view in views.iter_mut() {
            view.whole.center -= self.origin;
        }
        let ground_z = options.ground_z.map(|z| z - self.origin.z);
        let named: Vec<(&str, &Camera)> = views
            .iter()
            .map(|v| (&*files[v.file].path, &v.whole))
            .collect();
        let found = camera_checks::check_cameras(&named, ground_z);
        self.is_implausible = self.errors.is_empty() && !found.errors.is_empty();
        self.errors.extend(found.errors);
        self.placement_warnings = found.warnings;
        found.heights
    }
}

/// What part of fisheye photographs is used.
fn notice_of_fisheyes(views: &[PlannedView]) -> Option<String> {
    let of_fisheye = (views.iter())
        .filter(|v| v.distortion.is_some_and(|lens| lens.is_fisheye()))
        .map(|v| v.whole.half_field_deg());
    let widest = of_fisheye.reduce(f64::max)?;
    Some(format!(
        "fisheye photographs are rectified to pinholes: what lies more than {widest:.0} degrees from \
         their axis is not used"
    ))
}

/// By how much photographs are reduced.
fn notice_of_reduction(options: &LoadOptions) -> Option<String> {
    let factor = options.reduction.filter(|&factor| factor > 1.0)?;
    Some(format!(
        "photographs are used at {:.0} % of their width and height, as fine as roofs need \
         (--reduce 1 uses them in full)",
        100.0 / factor
    ))
}

fn too_few(files: &[InputFile], views: &[PlannedView]) -> Error {
    Error::scene(
        format!(
            "{} oriented {} ({}), but three are needed",
            views.len(),
            if views.len() == 1 { "view" } else { "views" },
            listed(views.iter().map(|v| files[v.file].name()))
        ),
        "add images with their orientation: what two show alike is true only if a third shows it too",
    )
}
