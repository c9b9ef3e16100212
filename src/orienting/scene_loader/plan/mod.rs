//! The plan of a scene: one orientation chosen, images and orientations assigned by name, all
//! refusals collected.

mod matching;
mod views;

use std::collections::BTreeSet;

use nalgebra::Vector3;

use super::assignment::ImageCandidate;
use super::candidate::{Choice, OrientationCandidate, choose, take_group};
use super::input::LoadOptions;
use super::known_files::kinds_of;
use super::names::belongs_to;
use super::notices;
use super::planned_view::{PlannedImage, PlannedView};
use crate::base::error::{Error, listed};
use crate::orienting::orientation::{
    Anchor, FileKind, InputFile, LinearUnit, Orientation, OrientationSet, PathName, PlanUnit,
    StatedReference, UnreadFormat, epsg_of, height_unit_of_code, images_called, is_geographic,
    linear_unit_of_code, orientation_sets, plane_of, to_metric_frame, units_of, unread_format,
};
use crate::orienting::scene::Survey;
use crate::photographs::raster::image_header;

/// Everything about a scene but its pixels.
#[derive(Default)]
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
    /// The unit of heights that a file beside the orientation states.
    height_unit: Option<LinearUnit>,
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
            ..Self::default()
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
            self.errors.push(Error::scene(
                match files.len() {
                    1 => "the one file that was given is no image".to_owned(),
                    count => format!("there is no image among the {count} files"),
                },
                "add three or more JPEG, PNG or TIFF images",
            ));
        }
        let headers = crate::base::execution::map(&images, |_, &i| {
            image_header(&files[i].path, files[i].content())
        });
        for (file, header) in images.into_iter().zip(headers) {
            self.images.push(PlannedImage {
                file,
                unreadable: header.as_ref().err().cloned(),
                header: header.ok(),
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
                let all = listed(images.iter().map(|&i| files[i].name()));
                self.errors.push(Error::scene(
                    format!("there is no image called {name}"),
                    format!("choose among {all}"),
                ));
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
        let wanted = options.orientation.as_deref();
        let Some(Choice { set: index, group }) = choose(&sets, files, wanted) else {
            let error = no_orientation(files, &self.kinds, options, &sets, &incomplete);
            self.errors.push(error);
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
        if let (Some(label), Some(taken)) = (&mut self.orientation, &taken.group) {
            *label = format!("{label}: {taken}");
        }
        let is_stated = options.epsg.is_some();
        let group = taken.group.as_deref();
        let (epsg, anchor) = self.reference_of(set, files, group, is_stated);
        self.survey = Survey {
            epsg: options.epsg.or(epsg),
            anchor,
            frame_sigma: set.frame_sigma(files),
            ..Survey::default()
        };
        OrientationCandidate::split(&mut self.candidates, index, &taken.groups);
        let mut orientations = taken.orientations;
        self.count_in_metres(&mut orientations);
        Some(orientations)
    }

    /// Where the positions are places on the Earth the scene counts metres from one of them, and
    /// where they are lengths in another unit, that of the same plane in metres.
    fn count_in_metres(&mut self, orientations: &mut [Orientation]) {
        let stated = self.survey.epsg;
        let is_degrees = stated.is_some_and(is_geographic);
        let Some(anchor) = to_metric_frame(orientations, is_degrees) else {
            match stated {
                Some(code) if is_degrees => self.errors.push(Error::scene(
                    format!(
                        "EPSG:{code} is longitude and latitude, and the positions of the cameras \
                         are none"
                    ),
                    "state the system that they are in (--crs EPSG:N)",
                )),
                Some(code) => self.count_feet_in_metres(code, orientations),
                None => {}
            }
            return;
        };
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

    /// Positions in the unit of a code become metres in the same plane.
    fn count_feet_in_metres(&mut self, code: u32, orientations: &mut [Orientation]) {
        let unit = linear_unit_of_code(code).unwrap_or_default();
        let heights = self.height_unit.or(height_unit_of_code(code));
        let heights = heights.unwrap_or(unit);
        if unit.is_metre() && heights.is_metre() {
            return;
        }
        let metric = if unit.is_metre() {
            code
        } else {
            plane_of(code)
        };
        if linear_unit_of_code(metric).is_none_or(|unit| !unit.is_metre()) {
            let unit = unit.words();
            self.errors.push(Error::scene(
                format!("EPSG:{code} is in {unit}, and no other code has the same plane in metres"),
                "convert the orientation to a system in metres, or multiply its positions \
                         by the metres of the unit and leave the system unstated",
            ));
            return;
        }
        for orientation in orientations.iter_mut() {
            let [x, y, z] = orientation.center.into();
            let (plan, height) = (unit.metres, heights.metres);
            orientation.center = [x * plan, y * plan, z * height].into();
        }
        self.warnings.push(format!(
            "the positions are in {}, heights in {} (EPSG:{code}); the model, its heights and areas \
             are in metres, in EPSG:{metric}, which is the same plane in metres (a region of interest \
             and a height of the ground count there)",
            unit.words(),
            heights.words()
        ));
        self.survey.epsg = Some(metric);
    }

    /// EPSG code of the coordinates' system, or the place that they count from.
    fn reference_of(
        &mut self,
        set: &OrientationSet,
        files: &[InputFile],
        group: Option<&str>,
        is_stated: bool,
    ) -> (Option<u32>, Option<Anchor>) {
        // What the user states makes what lies beside the orientation of no interest.
        let beside = match is_stated {
            true => None,
            false => self.stated_beside(set, files),
        };
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

    /// The reference system that a file of its own names, and that file: one that is called like a
    /// file of the orientation, else one that is called like no other file.
    fn stated_beside<'a>(
        &mut self,
        set: &OrientationSet,
        files: &'a [InputFile],
    ) -> Option<(&'a str, u32)> {
        let (mut own, mut free) = (Vec::new(), Vec::new());
        let mut of_others = Vec::new();
        // Photographs are not searched as text, and JSON names places.
        let stated = (self.kinds.iter().zip(files)).filter(|(kind, file)| {
            **kind == FileKind::ReferenceSystem && !file.name().to_lowercase().ends_with(".json")
        });
        let stated: Vec<&InputFile> = stated.map(|(_, file)| file).collect();
        for file in stated {
            let text = file.text();
            let Some(code) = epsg_of(&text) else {
                self.refuse_unknown_feet(file, &text);
                continue;
            };
            let heights = units_of(&text).and_then(|units| units.height);
            let found = (&*file.path, code, heights);
            let is_beside = |other: &&InputFile| belongs_to(file, other);
            match files.iter().find(is_beside) {
                _ if set.files.iter().any(|&i| belongs_to(file, &files[i])) => {
                    own.push(found);
                }
                Some(other) => of_others.push(format!("{} with {}", file.path, other.path)),
                None => free.push(found),
            }
        }
        if own.is_empty() && free.is_empty() && !of_others.is_empty() {
            self.warnings.push(format!(
                "no system is stated of the orientation (--crs EPSG:N states it); files of systems \
                 go by their names with others: {}",
                listed(of_others.iter())
            ));
        }
        let meant = if own.is_empty() { &free } else { &own };
        let [first, others @ ..] = &meant[..] else {
            return None;
        };
        if let Some(other) = others
            .iter()
            .find(|other| plane_of(other.1) != plane_of(first.1))
        {
            self.warnings.push(format!(
                "{} names EPSG:{} and {} EPSG:{}: none is taken for the orientation (--crs EPSG:N \
                 states its system)",
                first.0, first.1, other.0, other.1
            ));
            return None;
        }
        self.height_unit = first.2;
        Some((first.0, first.1))
    }

    /// A system without a code of which only the unit is known, and that is no metre.
    fn refuse_unknown_feet(&mut self, file: &InputFile, text: &str) {
        let Some(PlanUnit::Length(unit)) = units_of(text).map(|units| units.plan) else {
            return;
        };
        if !unit.is_metre() && self.errors.is_empty() {
            let unit = unit.words();
            self.errors.push(Error::file(
                &file.path,
                format!("it states coordinates in {unit}, of a system without a code"),
                "state the system of the orientation (--crs EPSG:N), or leave the file out \
                         (--without) if it is of something else",
            ));
        }
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
}

fn no_orientation(
    files: &[InputFile],
    kinds: &[FileKind],
    options: &LoadOptions,
    sets: &[OrientationSet],
    incomplete: &[String],
) -> Error {
    if let (Some(wanted), false) = (&options.orientation, sets.is_empty()) {
        let all = listed(sets.iter().map(|s| s.label(files)));
        return Error::scene(
            format!("no orientation file has {wanted} in its path"),
            format!("choose among {all}"),
        );
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
    let mut formats = BTreeSet::new();
    let first = unread
        .iter()
        .filter(|(_, format)| formats.insert(format.name));
    reasons.extend(first.map(known));
    if !reasons.is_empty() {
        problem = format!("{problem}: {}", reasons.join("; "));
    }
    if let (Some((_, format)), true) = (unread.first(), incomplete.is_empty()) {
        return Error::scene(problem, format.advice);
    }
    if reasons.is_empty() {
        problem.push_str(" (a position in the header of a photograph does not orient it)");
    }
    Error::scene(
        problem,
        "add the orientation as COLMAP, Metashape, BlocksExchange, Pix4D, OpenSfM or Bundler write it, a camera \
                 file with a list `image X0 Y0 Z0 omega phi kappa`, or one 3 x 4 matrix NAME.P an image",
    )
}

/// A mask, perhaps: a photograph in grey values alone is rarely a PNG.
fn is_gray_png(bytes: &[u8]) -> bool {
    // The byte that states it, behind signature, length, name, width, height and depth.
    const COLOUR_TYPE: usize = 25;
    bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.get(COLOUR_TYPE) == Some(&0)
}
