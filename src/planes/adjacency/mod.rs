//! Feature adjacency graphs, matched over the views and transferred into object space (B99 2: the
//! approach of Bonn).
//!
//! ```text
//! graph          the corners, edges and regions of an image
//! corners        corners where ends of segments meet
//! sectors        regions: what lies between two edges of a corner, and goes on along them
//! matching       corners matched over the views as wholes
//! space_corner   a corner in space with its edges, by least squares, in nats
//! transfer       the planes of the regions between its edges
//! ```
//!
//! "The 2D description consists of a Feature Adjacency Graph, for example a 2D corner and its
//! associated line segments and regions. The idea is to transfer the neighbourhood relations that
//! are available from the images into object space and to use them to produce consistent 3D object
//! descriptions. This involves matching the 2D descriptions over multiple images."
//!
//! Invariant: it proposes planes only, and no distance in pixels and no correlation decides: odds
//! do. No matched line is needed.

mod corners;
mod graph;
mod matching;
mod sectors;
mod space_corner;
#[cfg(test)]
mod tests;
mod transfer;

pub use graph::{CornerEdge, GraphRegion, ImageCorner, ImageGraph};
pub use space_corner::{SpaceCorner, SpaceEdge};
pub use transfer::CornerPlane;

use serde::Serialize;

use self::matching::GraphSpace;
use self::transfer::PlaneSpace;
use crate::base::params::RoofParams;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::planes::coplanar::{END_M, FINEST_STEP, ImageEvidence};

/// How the planes came about.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct AdjacencyTrace {
    /// The graph of each view.
    pub graphs: Vec<ImageGraph>,
    /// Corners in space, the likeliest first.
    pub corners: Vec<SpaceCorner>,
}

/// The planes that the corners of all views propose, verified or not. Of the matched lines only the
/// range of heights is used.
pub fn corner_planes(
    scene: &Scene,
    lines: &[Line3d],
    segments: &[Vec<ImageSegment>],
    roof: &RoofParams,
) -> (Vec<CornerPlane>, AdjacencyTrace) {
    let Some(middle) = lines.get(lines.len() / 2).map(|l| l.at(0.5)) else {
        return Default::default();
    };
    let pixel = scene.median_ground_pixel(&middle).unwrap_or(FINEST_STEP);
    let graphs = crate::base::execution::map(segments, |v, segments| {
        corners::image_graph(&scene.views[v], segments, END_M / pixel)
    });
    let ends = || lines.iter().flat_map(|l| [l.segment.p0.z, l.segment.p1.z]);
    let low = ends().fold(f64::INFINITY, f64::min);
    let high = ends().fold(f64::NEG_INFINITY, f64::max).max(low + pixel);
    let corners = GraphSpace::new(scene, &graphs, [low, high]).corners();
    let step = pixel.max(FINEST_STEP);
    let reduced = scene.reduced(((step / pixel).round() as usize).max(1));
    let images = ImageEvidence::new(scene, &reduced, step, segments, roof);
    let space = PlaneSpace {
        graphs: &graphs,
        images: &images,
        pixel_m: pixel,
        range_m: high - low,
    };
    let planes = space.planes(&corners);
    (planes, AdjacencyTrace { graphs, corners })
}
