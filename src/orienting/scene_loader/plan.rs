//! The plan of a scene: one orientation chosen, images and orientations assigned by name, all
//! refusals collected.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Vector3;

use super::assignment::{
    Ambiguity, ImageCandidate, LeftOut, PathName, assign, assign_in_order, factor_in_words,
    resized, scale,
};
use super::candidate::{Choice, OrientationCandidate, choose, take_group};
use super::checks::camera_checks;
use super::input::LoadOptions;
use super::known_files::kinds_of;
use super::memory;
use super::names::{images_called, view_names};
use super::notices;
use super::planned_view::{PlannedImage, PlannedView, planned_view};
use super::region::RegionOfInterest;
use crate::base::error::{Error, listed};
use crate::orienting::orientation::{
    Anchor, FileKind, InputFile, Orientation, OrientationSet, StatedReference, UnreadFormat,
    epsg_of, orientation_sets, to_metric_frame, unread_format,
};
use crate::orienting::scene::Survey;
use crate::photographs::camera::Camera;
use crate::photographs::raster::image_header;

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
    /// What the places of the cameras give reason to warn of.
    pub placement_warnings: Vec<String>,
    /// Is the region of interest cut from the loaded scene, since the cameras may change before?
    pub is_cut_later: bool,
    /// Do more views show the region of interest than are used?
    pub is_chosen: bool,
    /// Refusals, the one to report first in front.
    pub errors: Vec<Error>,
    /// Do only the positions of the cameras give reason to refuse the scene? Then the images may
    /// show why.
    pub is_implausible: bool,
    /// The refusal of images that were taken in the order of their names, unless they agree.
    pub unless_agreed: Option<Error>,
}

impl Plan {
    /// Plans a scene whose ground lies between these heights, metres, local frame, or as far as the
    /// cameras tell; reasons to refuse it are collected in `errors`.
    pub(crate) fn new(
        files: &[InputFile],
        options: &LoadOptions,
        ground: Option<[f64; 2]>,
    ) -> Self {
        let mut plan = Self {
            kinds: kinds_of(files, options),
            images: Vec::new(),
            orientation: None,
            candidates: Vec::new(),
            views: Vec::new(),
            origin: Vector3::zeros(),
            survey: Survey::default(),
            peak_bytes: 0,
            warnings: Vec::new(),
            placement_warnings: Vec::new(),
            is_cut_later: false,
            is_chosen: false,
            errors: Vec::new(),
            is_implausible: false,
            unless_agreed: None,
        };
        plan.find_images(files, options);
        if let Some(orientations) = plan.choose_orientation(files, options) {
            plan.match_orientations(files, orientations, options.views.is_some());
            plan.form_views(files, options, ground);
        } else {
            let unreadable = plan.images.iter().filter_map(|i| i.unreadable.clone());
            plan.errors.splice(0..0, unreadable.collect::<Vec<_>>());
        }
        let notices = notices::of_images(files, &plan.kinds, &plan.images, &plan.views);
        plan.warnings.extend(notices.warnings);
        plan.errors.splice(0..0, notices.errors);
        plan
    }

    /// The images that are wanted, with their headers.
    fn find_images(&mut self, files: &[InputFile], options: &LoadOptions) {
        let mut images: Vec<usize> = (0..files.len())
            .filter(|&i| self.kinds[i] == FileKind::Image)
            .collect();
        images.sort_by_key(|&i| (files[i].name(), &files[i].path));
        if let Some(wanted) = &options.views {
            images = self.select(files, &images, wanted);
        }
        if images.is_empty() && self.errors.is_empty() {
            self.errors.push(Error::Scene {
                problem: match files.len() {
                    1 => "the one file that was given is no image".to_owned(),
                    count => format!("there is no image among the {count} files"),
                },
                advice: "add three or more JPEG, PNG or TIFF images".to_owned(),
            });
        }
        let headers = crate::base::execution::map(&images, |_, &i| {
            image_header(&files[i].path, files[i].content())
        });
        for (file, header) in images.into_iter().zip(headers) {
            let (header, unreadable) = match header {
                Ok(header) => (Some(header), None),
                Err(error) => (None, Some(error)),
            };
            self.images.push(PlannedImage {
                file,
                header,
                unreadable,
                orientation: None,
            });
        }
    }

    fn select(&mut self, files: &[InputFile], images: &[usize], wanted: &[String]) -> Vec<usize> {
        let paths: Vec<PathName> = (images.iter())
            .map(|&i| PathName::new(&files[i].path))
            .collect();
        let mut chosen = BTreeSet::new();
        for name in wanted {
            let called = images_called(name, &paths);
            if called.is_empty() {
                self.errors.push(Error::Scene {
                    problem: format!("there is no image called {name}"),
                    advice: format!(
                        "choose among {}",
                        listed(images.iter().map(|&i| files[i].name()))
                    ),
                });
            }
            chosen.extend(called);
        }
        chosen.into_iter().map(|i| images[i]).collect()
    }

    /// Reads the preferred candidate, or the one that the options choose.
    fn choose_orientation(
        &mut self,
        files: &[InputFile],
        options: &LoadOptions,
    ) -> Option<Vec<Orientation>> {
        let (sets, incomplete) = orientation_sets(files, &self.kinds);
        self.warn_of_json(files);
        self.candidates = OrientationCandidate::of(&sets, files);
        let Some(Choice { set: index, group }) =
            choose(&sets, files, options.orientation.as_deref())
        else {
            self.errors.push(no_orientation(
                files,
                &self.kinds,
                options,
                &sets,
                &incomplete,
            ));
            return None;
        };
        let set = &sets[index];
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
        let read = set.read(files, &mut self.warnings);
        let orientations = read.map_err(|e| self.errors.push(e)).ok()?;
        let images = self.image_candidates(files);
        let taken = take_group(orientations, group.as_deref(), &images);
        self.warnings.extend(taken.warning(&set.label(files)));
        if let Some(taken) = &taken.group {
            self.orientation = self
                .orientation
                .take()
                .map(|label| format!("{label}: {taken}"));
        }
        let (epsg, anchor) = self.reference_of(set, files, taken.group.as_deref());
        self.survey = Survey {
            epsg: options.epsg.or(epsg),
            anchor,
            ..Survey::default()
        };
        OrientationCandidate::split(&mut self.candidates, index, &taken.groups);
        let mut orientations = taken.orientations;
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

    /// EPSG code of the coordinates' system, or the place that they count from.
    fn reference_of(
        &mut self,
        set: &OrientationSet,
        files: &[InputFile],
        group: Option<&str>,
    ) -> (Option<u32>, Option<Anchor>) {
        let beside = self.stated_reference(files);
        let (reason, anchor) = match set.reference(files, group) {
            StatedReference::None => return (beside.map(|(_, code)| code), None),
            StatedReference::System(code) => return (Some(code), None),
            StatedReference::Place(anchor) => (
                "the orientation counts east, north and up from a place".to_owned(),
                Some(anchor),
            ),
            StatedReference::Local(reason) => (reason, None),
        };
        if let Some((path, code)) = beside {
            self.warnings.push(format!(
                "{path} names EPSG:{code}, but the coordinates of {} are not in it: {reason}",
                set.label(files)
            ));
        }
        (None, anchor)
    }

    /// The reference system that a file of its own names, and that file.
    fn stated_reference<'a>(&self, files: &'a [InputFile]) -> Option<(&'a str, u32)> {
        // Photographs are not searched as text.
        (self.kinds.iter().zip(files))
            .filter(|(kind, _)| **kind == FileKind::ReferenceSystem)
            .find_map(|(_, file)| Some((&*file.path, epsg_of(&file.text())?)))
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

    fn image_candidates<'a>(&self, files: &'a [InputFile]) -> Vec<ImageCandidate<'a>> {
        let candidate = |image: &PlannedImage| {
            let InputFile { path, bytes, .. } = &files[image.file];
            ImageCandidate {
                path,
                size: image.header.map(|h| [h.width, h.height]),
                is_gray_png: is_gray_png(bytes),
            }
        };
        self.images.iter().map(candidate).collect()
    }

    /// Gives each image its orientation; what is left over is named.
    fn match_orientations(
        &mut self,
        files: &[InputFile],
        orientations: Vec<Orientation>,
        selected: bool,
    ) {
        let candidates = self.image_candidates(files);
        let mut found = assign(&orientations, &candidates);
        let path = |i: usize| &*files[self.images[i].file].path;
        let label = self.orientation.clone().unwrap_or("any file".to_owned());
        let mut warnings = Vec::new();
        let fits = !found.ambiguous.is_empty() || found.of_image.iter().any(Option::is_some);
        if let (false, Some(order)) = (fits, assign_in_order(&orientations, &candidates)) {
            let paths: Vec<&str> = (0..order.len()).map(path).collect();
            let stated: Vec<&str> = order.iter().map(|&one| &*orientations[one].image).collect();
            let pairs =
                (paths.iter().zip(&stated)).map(|(path, name)| format!("{path} for {name}"));
            warnings.push(format!(
                "no image is called as {label} says; they were taken in the order of their names: {}",
                listed(pairs)
            ));
            self.unless_agreed = Some(too_few_oriented(0, &paths, &stated, &label));
            found.of_image = order.into_iter().map(Some).collect();
        }
        let unreadable =
            (found.of_image.iter().zip(&self.images)).filter_map(|(of_image, image)| {
                image.unreadable.clone().filter(|_| of_image.is_some())
            });
        let mut errors: Vec<Error> = unreadable.collect();
        let unclear = found.ambiguous.iter();
        errors.extend(unclear.map(|same| ambiguous(same, &orientations, &path)));
        let without: Vec<&str> = (0..self.images.len())
            .filter(|&i| found.of_image[i].is_none() && found.left_out[i].is_none())
            .filter(|i| found.ambiguous.iter().all(|same| !same.images.contains(i)))
            .map(path)
            .collect();
        let copies = found
            .left_out
            .iter()
            .enumerate()
            .filter_map(|(i, why)| match (*why)? {
                LeftOut::For(taken) => Some(format!("{} ({} was taken)", path(i), path(taken))),
                LeftOut::WithCopies => Some(path(i).to_owned()),
            });
        let copies: Vec<String> = copies.collect();
        let mut used = vec![false; orientations.len()];
        for one in found.of_image.iter().flatten() {
            used[*one] = true;
        }
        let unused: Vec<&str> = (orientations.iter().zip(&used))
            .filter(|(_, used)| !**used)
            .map(|(o, _)| &*o.image)
            .collect();
        let oriented = used.iter().filter(|used| **used).count();
        if oriented < 3 && errors.is_empty() && !without.is_empty() {
            errors.push(too_few_oriented(oriented, &without, &unused, &label));
        }
        if !without.is_empty() {
            warnings.push(format!(
                "images without an orientation in {label}, left out: {}",
                listed(without.iter())
            ));
        }
        if !copies.is_empty() {
            warnings.push(format!(
                "masks or copies of images, left out because an orientation belongs to one image: {}",
                listed(copies.iter())
            ));
        }
        if !unused.is_empty() && !selected {
            warnings.push(format!(
                "orientations without an image, ignored: {}",
                listed(unused.iter())
            ));
        }
        self.warnings.extend(warnings);
        self.errors.extend(errors);
        for (image, one) in self.images.iter_mut().zip(found.of_image) {
            image.orientation = one.map(|one| orientations[one].clone());
        }
    }

    /// Forms views in the local frame and checks them together.
    fn form_views(&mut self, files: &[InputFile], options: &LoadOptions, ground: Option<[f64; 2]>) {
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
                    view.reduce(options.reduction.unwrap_or(1));
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
                listed(paths.into_iter())
            ));
        }
        if views.len() < 3 && self.errors.is_empty() {
            self.errors.push(too_few(files, &views));
        }
        if views.len() < 3 {
            self.views = views;
            return;
        }
        self.warnings.extend(notice_of_fisheyes(&views));
        self.warnings.extend(notice_of_reduction(options));
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
        self.placement_warnings = found.warnings;
        // A wrong orientation projects the region elsewhere: then it is cut after the correction,
        // and after the images have decided about the angles, where there is memory for that.
        let is_undecided = views.iter().all(|v| !v.readings.is_empty());
        let whole_fits = || {
            let bytes = memory::peak_bytes(files, &views);
            memory::check_memory(bytes, &views, options.memory_mb).is_none()
        };
        self.is_cut_later = options.apply_fix || is_undecided && whole_fits();
        let cut_now = !self.is_cut_later;
        if let (Some(roi), Some(heights), true) = (options.roi, ground.or(found.heights), cut_now) {
            let roi = RegionOfInterest::new(roi, &self.origin, heights);
            match roi.and_then(|roi| roi.cut(files, &mut views, options.max_views)) {
                Ok(cut) => {
                    self.warnings.extend(cut.warnings);
                    self.is_chosen = cut.is_chosen;
                }
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

/// By how much photographs are reduced.
fn notice_of_reduction(options: &LoadOptions) -> Option<String> {
    let factor = options.reduction.filter(|&factor| factor > 1)?;
    Some(format!(
        "photographs are used at {} of their width and height, as fine as roofs need (--reduce 1 \
         uses them in full)",
        match factor {
            2 => "half".to_owned(),
            3 => "a third".to_owned(),
            4 => "a quarter".to_owned(),
            more => format!("1/{more}"),
        }
    ))
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

fn no_orientation(
    files: &[InputFile],
    kinds: &[FileKind],
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
    let unread: Vec<(&InputFile, &UnreadFormat)> = (files.iter().zip(kinds))
        .filter(|(_, kind)| **kind == FileKind::Unread)
        .filter_map(|(file, _)| Some((file, unread_format(file)?)))
        .collect();
    let known = |(file, format): &(&InputFile, &UnreadFormat)| {
        format!("{} is {}, which is not read", file.path, format.name)
    };
    let mut reasons = incomplete.to_vec();
    // Their advice differs: of many files of one format one is named.
    let mut formats: Vec<&str> = Vec::new();
    for found in &unread {
        if !formats.contains(&found.1.name) {
            formats.push(found.1.name);
            reasons.push(known(found));
        }
    }
    if !reasons.is_empty() {
        problem = format!("{problem}: {}", reasons.join("; "));
    }
    if let (Some((_, format)), true) = (unread.first(), incomplete.is_empty()) {
        return Error::Scene {
            problem,
            advice: format.advice.to_owned(),
        };
    }
    if reasons.is_empty() {
        problem.push_str(" (a position in the header of a photograph does not orient it)");
    }
    Error::Scene {
        problem,
        advice: "add the orientation as COLMAP, Metashape, BlocksExchange, Pix4D, OpenSfM or Bundler write it, a camera \
                 file with a list `image X0 Y0 Z0 omega phi kappa`, or one 3 x 4 matrix NAME.P an image"
            .to_owned(),
    }
}

/// A mask, perhaps: a photograph in grey values alone is rarely a PNG.
fn is_gray_png(bytes: &[u8]) -> bool {
    // The byte that states it, behind signature, length, name, width, height and depth.
    const COLOUR_TYPE: usize = 25;
    bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.get(COLOUR_TYPE) == Some(&0)
}

fn ambiguous<'a>(
    same: &Ambiguity,
    orientations: &[Orientation],
    path: &impl Fn(usize) -> &'a str,
) -> Error {
    let images: Vec<&str> = same.images.iter().map(|&i| path(i)).collect();
    let sources = listed((same.orientations.iter()).map(|&i| &*orientations[i].source));
    match images[..] {
        [one] => Error::File {
            file: one.to_owned(),
            problem: format!("two orientations are called like the image ({sources})"),
            advice: "remove one of them".to_owned(),
        },
        _ => Error::Scene {
            problem: format!(
                "{} have the same name, and nothing tells which of them belongs to {sources}",
                images.join(" and ")
            ),
            advice: "rename or remove one, or give them the folders that the orientation states"
                .to_owned(),
        },
    }
}

/// The refusal of images of which too few have an orientation.
fn too_few_oriented(oriented: usize, without: &[&str], unused: &[&str], label: &str) -> Error {
    let named = match unused.is_empty() {
        true => String::new(),
        false => format!(" (it names {})", listed(unused.iter())),
    };
    Error::Scene {
        problem: format!(
            "{oriented} {} an orientation in {label}, but three are needed: none for {}{named}",
            if oriented == 1 {
                "image has"
            } else {
                "images have"
            },
            listed(without.iter())
        ),
        advice: "add the orientation of the others, or give the images the names that it states"
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
