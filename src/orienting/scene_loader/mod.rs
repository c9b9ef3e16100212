//! From files in memory to a [`Scene`](crate::orienting::scene::Scene): what the command line and
//! the page hand over.
//!
//! ```text
//! archive, project   files of a .zip; a project's files and options
//! input              what the caller asks for beyond the files
//! plan               one orientation chosen, images assigned to it by name; all refusals
//! candidate          the orientations that the plan chooses from
//! assignment, names  which image an orientation belongs to; planned_view: the plan's views
//! checks             the cameras by themselves and against the images; corrections
//! notices            what is said of images: bands and turns, formats that are not read
//! region             part of each image that shows the region of interest
//! memory             memory that a run takes
//! inspect            the plan as a table; what is read of each view, the area that views show
//! decode             views: of large frames the parts only, distortion removed
//! ground             the heights of a region that more views show than are used; the plan by them
//! known_files        terrain and footprints among the files
//! load               all of it
//! ```
//!
//! Invariant: no file system here; paths are names.
//! Invariant: [`load_scene`] and [`inspect_files`] use the same plan, so that the page's table
//! never disagrees with a run.

mod archive;
mod assignment;
mod candidate;
mod checks;
mod decode;
mod ground;
mod input;
mod inspect;
mod known_files;
mod load;
mod memory;
mod names;
mod notices;
mod plan;
mod planned_view;
mod project;
mod region;
#[cfg(test)]
mod tests;

pub use archive::unpack;
pub use candidate::OrientationCandidate;
pub use ground::{
    files_of_ground, files_of_settling, files_of_views, finer_than, ground_files, ground_heights,
    settled, settled_on,
};
pub use input::LoadOptions;
pub use inspect::{
    FileReport, Flight, FlightOverview, Footprint, GroundSource, ImageReport, Inspection, Overlap,
    ShownArea, ViewWindow, inspect_files,
};
pub use known_files::opened_model;
pub use load::{PlannedScene, load_scene, whole_views};
#[cfg(target_arch = "wasm32")]
pub(crate) use project::SHOWN;
pub use project::{Project, open_project};
pub use region::MOST_VIEWS;
