//! The plan of a scene: one orientation chosen, images and orientations assigned by name, all
//! refusals collected.

use nalgebra::Vector3;

use super::candidate::OrientationCandidate;
use super::checks::camera_checks;
use super::input::LoadOptions;
use super::memory;
use super::names::{best_match, listed, match_rank};
use super::notices;
use super::planned_view::{PlannedImage, PlannedView};
use super::region::RegionOfInterest;
use super::turned::{shown_size, turn_of};
use crate::camera::Camera;
use crate::error::{Error, Result};
use crate::orientation::{
    FileKind, InputFile, Orientation, OrientationSet, detect, epsg_of, orientation_sets, stem,
    to_metric_frame,
};
use crate::raster::{ImageHeader, image_header};
use crate::scene::Survey;
use crate::sorting::{sort_by, sort_by_key};

/// Everything about a scene but its pixels.
pub(crate) struct Plan {
    /// What each file is.
    pub kinds: Vec<FileKind>,
    /// The images in use, sorted by name.
    pub images: Vec<PlannedImage>,
    /// The orientation that was taken.
    pub orientation: Option<String>,
    /// All of them, the preferred one first.
    pub candidates: Vec<OrientationCandidate>,
    /// The views: images with an orientation, in the order of `images`.
    pub views: Vec<PlannedView>,
    /// Added to local coordinates it gives the world of the input.
    pub origin: Vector3<f64>,
    /// Reference system and geodetic anchor.
    pub survey: Survey,
    /// Bytes that loading takes at its peak, the files included.
    pub peak_bytes: u64,
    pub warnings: Vec<String>,
    /// Refusals, the one to report first in front.
    pub errors: Vec<Error>,
    /// Do only the positions of the cameras give reason to refuse the scene? Then the images may
    /// show why.
    pub is_implausible: bool,
}

impl Plan {
    /// Plans a scene; reasons to refuse it are collected in `errors`.
    pub(crate) fn new(files: &[InputFile], options: &LoadOptions) -> Self {
        let mut plan = Self {
            kinds: files.iter().map(detect).collect(),
            images: Vec::new(),
            orientation: None,
            candidates: Vec::new(),
            views: Vec::new(),
            origin: Vector3::zeros(),
            survey: Survey::default(),
            peak_bytes: 0,
            warnings: Vec::new(),
            errors: Vec::new(),
            is_implausible: false,
        };
        plan.find_images(files, options);
        if let Some(orientations) = plan.choose_orientation(files, options) {
            plan.match_orientations(files, orientations, options.views.is_some());
            plan.form_views(files, options);
        }
        notices::add_to(&mut plan, files);
        plan
    }

    /// The images that are wanted, with their headers.
    fn find_images(&mut self, files: &[InputFile], options: &LoadOptions) {
        let mut images: Vec<usize> = (0..files.len())
            .filter(|&i| self.kinds[i] == FileKind::Image)
            .collect();
        sort_by_key(&mut images, |&i| (files[i].name(), &files[i].path));
        if let Some(wanted) = &options.views {
            images = self.select(files, &images, wanted);
        }
        self.refuse_duplicates(files, &images);
        if images.is_empty() && self.errors.is_empty() {
            self.errors.push(Error::Scene {
                problem: format!("there is no image among the {} files", files.len()),
                advice: "add three or more JPEG, PNG or TIFF images".to_owned(),
            });
        }
        let headers = crate::execution::map(&images, |_, &i| {
            image_header(&files[i].path, &files[i].bytes)
        });
        for (file, header) in images.into_iter().zip(headers) {
            let header = header.map_err(|e| self.errors.push(e)).ok();
            self.images.push(PlannedImage {
                file,
                header,
                orientation: None,
            });
        }
    }

    fn select(&mut self, files: &[InputFile], images: &[usize], wanted: &[String]) -> Vec<usize> {
        for name in wanted {
            if !images
                .iter()
                .any(|&i| match_rank(name, files[i].name()).is_some())
            {
                self.errors.push(Error::Scene {
                    problem: format!("there is no image called {name}"),
                    advice: format!(
                        "choose among {}",
                        listed(images.iter().map(|&i| files[i].name()))
                    ),
                });
            }
        }
        let is_wanted = |i: usize| {
            wanted
                .iter()
                .any(|name| match_rank(name, files[i].name()).is_some())
        };
        images.iter().copied().filter(|&i| is_wanted(i)).collect()
    }

    fn refuse_duplicates(&mut self, files: &[InputFile], images: &[usize]) {
        let mut keys: Vec<(String, usize)> = images
            .iter()
            .map(|&i| (stem(&files[i].path).to_lowercase(), i))
            .collect();
        sort_by(&mut keys, Ord::cmp);
        for pair in keys.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            self.errors.push(Error::Scene {
                problem: format!(
                    "{} and {} have the same name",
                    files[pair[0].1].path, files[pair[1].1].path
                ),
                advice: "rename or remove one: images and orientations are matched by name"
                    .to_owned(),
            });
        }
    }

    /// Reads the preferred candidate, or the one that the options choose.
    fn choose_orientation(
        &mut self,
        files: &[InputFile],
        options: &LoadOptions,
    ) -> Option<Vec<Orientation>> {
        let (sets, incomplete) = orientation_sets(files, &self.kinds);
        self.warn_of_json(files);
        self.candidates = sets
            .iter()
            .map(|set| OrientationCandidate {
                label: format!("{}: {}", set.format.name(), set.label(files)),
                path: files[set.files[0]].path.clone(),
            })
            .collect();
        let named = |wanted: &str, fits: &dyn Fn(&str, &str) -> bool| {
            let wanted = wanted.trim_end_matches('/');
            sets.iter()
                .find(|set| set.files.iter().any(|&i| fits(&files[i].path, wanted)))
        };
        let chosen = match &options.orientation {
            None => sets.first(),
            // A whole path names one set, even where it is a part of another's.
            Some(wanted) => named(wanted, &|path, wanted| path == wanted)
                .or_else(|| named(wanted, &|path, wanted| path.contains(wanted))),
        };
        let Some(set) = chosen else {
            self.errors
                .push(no_orientation(files, options, &sets, &incomplete));
            return None;
        };
        self.warnings.extend(incomplete);
        if options.orientation.is_none() && sets.len() > 1 {
            let others = sets[1..].iter().map(|s| s.label(files));
            self.warnings.push(format!(
                "the orientation stands in the files {} times: {} was taken, not {}",
                sets.len(),
                set.label(files),
                listed(others)
            ));
        }
        self.orientation = Some(format!("{}: {}", set.format.name(), set.label(files)));
        self.survey = Survey {
            epsg: options
                .epsg
                .or_else(|| set.reference(files))
                .or_else(|| self.stated_reference(files)),
            anchor: set.anchor(files),
            ..Survey::default()
        };
        let read = set.read(files, &mut self.warnings);
        let mut orientations = read.map_err(|e| self.errors.push(e)).ok()?;
        if let Some(anchor) = to_metric_frame(&mut orientations) {
            self.warnings.push(format!(
                "the positions are places on the Earth; the model stands in metres east and north of {:.3} degrees of longitude, {:.3} \
                 of latitude, heights above the ellipsoid",
                anchor.lon_deg, anchor.lat_deg
            ));
            self.survey = Survey {
                anchor: Some(anchor),
                ..Survey::default()
            };
        }
        Some(orientations)
    }

    /// The reference system that a file of its own names.
    fn stated_reference(&self, files: &[InputFile]) -> Option<u32> {
        // Photographs are not searched as text.
        (self.kinds.iter().zip(files))
            .filter(|(kind, _)| **kind == FileKind::ReferenceSystem)
            .find_map(|(_, file)| epsg_of(&file.text()))
    }

    fn warn_of_json(&mut self, files: &[InputFile]) {
        let of_json = (0..files.len()).filter(|&i| self.kinds[i] == FileKind::Json);
        let names: Vec<&str> = of_json.map(|i| &*files[i].path).collect();
        if !names.is_empty() {
            self.warnings.push(format!(
                "JSON that is no orientation known here, ignored: {}",
                listed(names.into_iter())
            ));
        }
    }

    /// Gives each image its orientation.
    fn match_orientations(
        &mut self,
        files: &[InputFile],
        orientations: Vec<Orientation>,
        selected: bool,
    ) {
        let mut used = vec![false; orientations.len()];
        for image in &mut self.images {
            let name = files[image.file].name();
            match best_match(&orientations, name)[..] {
                [] => self.errors.push(Error::File {
                    file: files[image.file].path.clone(),
                    problem: format!(
                        "the image has no orientation in {}",
                        self.orientation.as_deref().unwrap_or("any file")
                    ),
                    advice: "add its orientation, remove the image, or choose the views to use"
                        .to_owned(),
                }),
                [one] => {
                    used[one] = true;
                    image.orientation = Some(orientations[one].clone());
                }
                [first, second, ..] => self.errors.push(Error::File {
                    file: files[image.file].path.clone(),
                    problem: format!(
                        "two orientations are called like the image ({} and {})",
                        orientations[first].source, orientations[second].source
                    ),
                    advice: "remove one of them".to_owned(),
                }),
            }
        }
        let without: Vec<&str> = (orientations.iter().zip(&used))
            .filter(|(_, used)| !**used)
            .map(|(o, _)| &*o.image)
            .collect();
        if !without.is_empty() && !selected {
            self.warnings.push(format!(
                "orientations without an image, ignored: {}",
                listed(without.into_iter())
            ));
        }
    }

    /// Forms views in the local frame and checks them together.
    fn form_views(&mut self, files: &[InputFile], options: &LoadOptions) {
        let mut views = Vec::new();
        for image in &self.images {
            let (Some(header), Some(orientation)) = (&image.header, &image.orientation) else {
                continue;
            };
            match planned_view(&files[image.file].path, image.file, header, orientation) {
                Ok(view) => views.push(view),
                Err(error) => self.errors.push(error),
            }
        }
        if views.len() < 3 && self.errors.is_empty() {
            self.errors.push(too_few(files, &views));
        }
        if views.len() < 3 {
            self.views = views;
            return;
        }
        self.origin = camera_checks::scene_origin(views.iter().map(|v| &v.whole));
        for view in &mut views {
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
        self.warnings.extend(found.warnings);
        // A wrong orientation projects the region elsewhere: then it is cut after the correction.
        let cut_now = !options.apply_fix;
        if let (Some(roi), Some(heights), true) = (options.roi, found.heights, cut_now) {
            let roi = RegionOfInterest::new(roi, &self.origin, heights);
            match roi.and_then(|roi| roi.cut(files, &mut views)) {
                Ok(warnings) => self.warnings.extend(warnings),
                Err(error) => self.errors.push(error),
            }
        }
        self.peak_bytes = memory::peak_bytes(files, &views);
        let too_large = memory::check_memory(self.peak_bytes, &views, options.memory_mb);
        self.is_implausible &= too_large.is_none();
        self.errors.extend(too_large);
        self.views = views;
    }
}

/// The camera of a whole image in the world of its orientation file, after the checks that need no
/// other view.
fn planned_view(
    path: &str,
    file: usize,
    header: &ImageHeader,
    orientation: &Orientation,
) -> Result<PlannedView> {
    let refuse = |problem: String, advice: &str| Error::File {
        file: path.to_owned(),
        problem,
        advice: advice.to_owned(),
    };
    let turn = turn_of(header, orientation);
    let (width, height) = shown_size(header, turn);
    if let Some((w, h)) = orientation.size.filter(|&size| size != (width, height)) {
        return Err(refuse(
            format!(
                "the image has {width} x {height} pixels, but its orientation ({}) is for {w} x {h}",
                orientation.source
            ),
            "use the image that was oriented, or export the orientation for this size",
        ));
    }
    let mut k = orientation.k;
    if orientation.from_middle {
        k[(0, 2)] += f64::from(width) / 2.0;
        k[(1, 2)] += f64::from(height) / 2.0;
    }
    let camera = Camera {
        k,
        r: orientation.r,
        center: orientation.center,
        width,
        height,
    };
    if let Some(problem) = camera_checks::numeric_problem(&camera) {
        return Err(refuse(
            format!(
                "its orientation ({}) is impossible: {problem}",
                orientation.source
            ),
            "export the orientation again",
        ));
    }
    if let Some(lens) = &orientation.distortion
        && !lens.is_plausible(&camera.k, width, height)
    {
        return Err(refuse(
            format!(
                "the lens distortion in {} folds the image over",
                orientation.source
            ),
            "check the order and the signs of the coefficients, or undistort the images",
        ));
    }
    Ok(PlannedView {
        file,
        whole: camera,
        distortion: orientation.distortion,
        angles: orientation.angles,
        crop: orientation.crop,
        part: None,
        turn,
    })
}

fn no_orientation(
    files: &[InputFile],
    options: &LoadOptions,
    sets: &[OrientationSet],
    incomplete: &[String],
) -> Error {
    if let (Some(wanted), false) = (&options.orientation, sets.is_empty()) {
        return Error::Scene {
            problem: format!("no orientation file has {wanted} in its path"),
            advice: format!(
                "choose among {}",
                listed(sets.iter().map(|s| s.label(files)))
            ),
        };
    }
    let mut problem = "no orientation was found".to_owned();
    if !incomplete.is_empty() {
        problem = format!("{problem}: {}", incomplete.join("; "));
    }
    Error::Scene {
        problem,
        advice: "add the orientation as COLMAP, Metashape, BlocksExchange, Pix4D, OpenSfM or Bundler write it, a camera \
                 file with a list `image X0 Y0 Z0 omega phi kappa`, or one 3 x 4 matrix NAME.P an image"
            .to_owned(),
    }
}

fn too_few(files: &[InputFile], views: &[PlannedView]) -> Error {
    Error::Scene {
        problem: format!(
            "{} oriented {} ({}), but three are needed",
            views.len(),
            if views.len() == 1 { "view" } else { "views" },
            listed(views.iter().map(|v| files[v.file].name()))
        ),
        advice: "add images: a line match in two views cannot be verified without a third"
            .to_owned(),
    }
}
