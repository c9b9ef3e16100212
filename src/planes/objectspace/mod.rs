//! The object-space method: Wiman, Axelsson 1996, "Finding 3D-structures in multiple aerial images
//! using lines and regions" (W96).
//!
//! Nothing is matched from image to image. The image lines of all views are accumulated in object
//! space at once, three times: as azimuths, as places in a plane across a main direction, and as
//! positions along a pair of parallel lines. The work therefore grows linearly with the number of
//! images, except where pairs of image lines propose clusters.
//!
//! ```text
//! oris         regions with straight shared boundaries, and lines on them     3.3
//! image_lines  image lines with rays and interpretation planes
//! directions   main directions from a histogram of azimuths                   3.4
//! clusters     3D lines by clustering in the plane across a main direction    3.5
//! windows      a window for each building                                     3.1
//! rectangles   planes between parallel lines, and the best set of them        3.6
//! adopt        cluster lines for the method of B99
//! stages       the stages that the pipeline runs
//! ```
//!
//! Invariant: an image line supports one 3D line at most, and chosen planes do not overlap in plan.

mod adopt;
pub mod clusters;
pub mod directions;
#[cfg(test)]
mod fixture;
mod image_lines;
pub mod oris;
mod rectangles;
mod stages;
#[cfg(test)]
mod tests;
mod windows;

pub use adopt::adopted_lines;
pub(crate) use clusters::ClusterTrace;
pub(crate) use oris::Segmentation;
pub use oris::{ColorImage, Lattice, Moves, RegionLine, region_lines};
pub use rectangles::{
    Crossing, PlaneCandidate, PlaneEnd, PlaneFeatures, PlaneRejection, PlaneTrace,
};
pub use stages::{
    FoundLine, RectangleTrace, find_clusters, find_directions, find_rectangles, find_regions,
    image_segments, proposed_planes, world_lines,
};
pub use windows::{Window, WindowTrace};
