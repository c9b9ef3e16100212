//! The object-space method: Wiman, Axelsson 1996, "Finding 3D-structures in multiple aerial images
//! using lines and regions" (W96).
//!
//! Nothing is matched from image to image. Image lines of all views are accumulated in object space
//! at once, three times: as azimuths, as places in a plane across a main direction, and as
//! positions along a pair of parallel lines. The work therefore grows linearly with the number of
//! images up to that point where pairs of image lines propose clusters.
//!
//! ```text
//! 3.3  oris        regions with straight shared boundaries, lines on them
//!      sight       image lines with rays and interpretation planes
//! 3.1  windows     a window for each building
//! 3.4  directions  main directions from a histogram of azimuths
//! 3.5  clusters    3D lines by clustering in the plane across a main direction (`cluster_plane`,
//!                  `cluster_proposals`, `cluster_select`)
//! 3.6  ends        where a plane between two parallel lines ends
//!      shapes      outlines between ends
//!      judge       what the images say about a plane
//!      solid       what hides a plane
//!      planes      plane candidates and their measure
//!      select      best non-overlapping set
//!      adopt       cluster lines for the other method
//!      stages      the stages that the pipeline runs
//! ```

mod adopt;
pub mod clusters;
pub mod directions;
#[cfg(test)]
mod fixture;
pub mod oris;
mod rectangles;
pub mod sight;
mod stages;
#[cfg(test)]
mod tests;
mod windows;

pub use adopt::adopted_lines;
pub(crate) use clusters::ClusterTrace;
pub(crate) use oris::Segmentation;
pub use oris::{ColorImage, Lattice, Moves, RegionLine, region_lines};
pub use rectangles::{Crossing, End, PlaneCandidate, PlaneRejection, PlaneTrace};
pub use stages::{
    FoundLine, RectangleTrace, find_clusters, find_directions, find_rectangles, find_regions,
    image_segments, proposed_planes, world_lines,
};
pub use windows::{Window, WindowTrace};
