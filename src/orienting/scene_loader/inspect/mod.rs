//! What was recognised among the files, as a table for the user before anything is computed.
//! `windows` has what is read of each view, and the area that views show; `flight` both for many
//! regions, and how the photographs overlap.

mod flight;
mod windows;

pub use flight::{Flight, FlightOverview, Footprint, GroundSource, Overlap};
pub use windows::{ShownArea, ViewWindow};
pub(crate) use windows::{box_of_views, shown_places};

use serde::Serialize;

use super::candidate::OrientationCandidate;
use super::ground::plan_scene;
use super::input::LoadOptions;
use super::known_files::opened_model;
use crate::orienting::orientation::{FileKind, InputFile};
use crate::orienting::structure_from_motion::PhotoMetadata;

/// Everything that is known about a set of files without decoding an image.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Inspection {
    /// One entry a file, in the order given.
    pub files: Vec<FileReport>,
    /// The images in use, sorted by name.
    pub images: Vec<ImageReport>,
    /// The orientation that a run would take: format and files.
    pub orientation: Option<String>,
    /// All orientations among the files, the preferred one first.
    pub orientations: Vec<OrientationCandidate>,
    /// Number of views that a run would use.
    pub views: usize,
    /// Memory that a run takes at its peak, about, megabytes; 0 where there are no views.
    pub peak_mb: u64,
    /// What a run would warn of.
    pub warnings: Vec<String>,
    /// Why a run would refuse these files; empty when it would not.
    pub errors: Vec<String>,
    /// Path of the CityJSON file whose model is opened instead, where there is no photograph.
    pub model: Option<String>,
    /// Do only the positions of the cameras give reason to refuse them? Then loading checks the
    /// images, and reports more.
    pub is_implausible: bool,
}

/// What a file is.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FileReport {
    /// Its path.
    pub path: String,
    /// Its kind.
    pub kind: FileKind,
    /// The kind in words.
    pub description: &'static str,
}

/// An image and its orientation.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ImageReport {
    /// Path of the file.
    pub path: String,
    /// The name that views go by.
    pub name: String,
    /// Width and height in pixels; `None` when the header cannot be read.
    pub size: Option<(u32, u32)>,
    /// File and line of its orientation; `None` when it has none.
    pub orientation: Option<String>,
    /// What the file says of where, when and with what it was taken.
    pub stated: PhotoMetadata,
}

/// Recognises files and plans a scene.
pub fn inspect_files(files: &[InputFile], options: &LoadOptions) -> Inspection {
    let plan = plan_scene(files, options);
    let described = files
        .iter()
        .zip(&plan.kinds)
        .map(|(file, &kind)| FileReport {
            path: file.path.clone(),
            kind,
            description: kind.describe(),
        });
    let name = |file: usize| {
        let own = files[file].name();
        let others = plan.images.iter().filter(|other| other.file != file);
        match plan.views.iter().find(|view| view.file == file) {
            Some(view) => view.name.clone(),
            None if others.clone().all(|other| files[other.file].name() != own) => own.to_owned(),
            // An image that is left out is told from a view of its name.
            None => files[file].path.clone(),
        }
    };
    let images = plan.images.iter().map(|image| {
        let size = image.header.map(|h| (h.width, h.height));
        ImageReport {
            path: files[image.file].path.clone(),
            name: name(image.file),
            size,
            orientation: image.orientation.as_ref().map(|o| o.source.clone()),
            stated: PhotoMetadata::read(
                files[image.file].content().start(),
                size.unwrap_or_default().into(),
            ),
        }
    });
    let model = opened_model(files).map(|file| file.path.clone());
    let errors = plan.errors.iter().map(ToString::to_string);
    Inspection {
        files: described.collect(),
        images: images.collect(),
        orientation: plan.orientation,
        orientations: plan.candidates,
        views: plan.views.len(),
        peak_mb: plan.peak_bytes >> 20,
        warnings: [plan.warnings, plan.placement_warnings].concat(),
        errors: errors.filter(|_| model.is_none()).collect(),
        model,
        is_implausible: plan.is_implausible,
    }
}
