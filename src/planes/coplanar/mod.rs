//! Coplanar grouping of 3D lines (B99 2: the approach of Leuven; 5: "grouping and removing from
//! consideration coplanar lines").
//!
//! ```text
//! hypothesis       densities and odds
//! uncertain_plane  a plane with its covariance, fitted to lines
//! sets             sets of coplanar lines
//! outline          convex hull of their ends -> polygon with closed corners and sides
//! image_evidence   back-projection: what the photographs say of a polygon
//! ```
//!
//! "The emphasis during this modeling stage is on extracting the correct topology of the roof
//! structure rather than on the metric accuracy": outline. "Metric accuracy is obtained in an
//! additional step", with symmetries and the total reprojection error of the wireframe: that of
//! buildings, for the roofs of all methods.
//!
//! Invariant: no distance and no angle decides here; likelihoods do, in nats.

mod hypothesis;
mod image_evidence;
mod outline;
mod sets;
#[cfg(test)]
mod tests;
mod uncertain_plane;

pub(crate) use hypothesis::{END_M, log_normal, log_odds};
pub(crate) use image_evidence::ImageEvidence;
pub use outline::{ClosingKind, ClosingSide};
pub(crate) use uncertain_plane::{LineEnd, UncertainPlane};

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use self::outline::Outline;
use self::sets::{LineSet, LineSpace, coplanar_line_sets};
use crate::base::geometry::{Plane, mean_point};
use crate::base::ids::{LineId, ProposalOrigin};
use crate::base::params::RoofParams;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::planes::grouping::ProposedPlane;
use crate::planes::photoconsistency::PlanGrid;

/// Finest distance of the positions of a window, metres, as in the labelling of facets.
pub(crate) const FINEST_STEP: f64 = 0.06;

/// Coplanar lines and their polygon.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CoplanarSet {
    /// The lines.
    pub lines: Vec<LineId>,
    /// The plane of the polygon.
    pub plane: Plane,
    /// Covariance of the height in the middle of the polygon, metres, and of its gradient along x
    /// and y: 3 x 3.
    pub covariance: [[f64; 3]; 3],
    /// Convex hull of the ends of the lines, on the plane of the lines, counter-clockwise from
    /// above, metres, local frame.
    pub hull: Vec<Point3<f64>>,
    /// The polygon, on its plane, counter-clockwise from above.
    pub polygon: Vec<Point3<f64>>,
    /// Logarithm of the odds that the lines lie in one plane, by their ends (verification in 3D).
    pub coplanar_nats: f64,
    /// What the views say of the plane inside the polygon, nats (back-projection).
    pub inside_nats: f64,
    /// What its outline costs, nats: little where the views show an edge.
    pub outline_nats: f64,
}

impl CoplanarSet {
    /// What speaks for the polygon, and against it, nats.
    pub fn nats(&self) -> f64 {
        self.inside_nats + self.outline_nats
    }

    /// Is it likelier with the polygon than without it what the views show?
    pub fn is_verified(&self) -> bool {
        self.nats() > 0.0
    }

    /// As a plane that facets may have; `index` is its place in the list.
    pub fn proposed(&self, index: usize) -> ProposedPlane {
        ProposedPlane {
            origin: ProposalOrigin::CoplanarSet(index as u32),
            plane: self.plane,
            ring: self.polygon.clone(),
            sides_on_edges: true,
        }
    }
}

/// How the polygon of a set came about.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CoplanarSetTrace {
    /// Sides without a line that were moved.
    pub closing: Vec<ClosingSide>,
}

/// How the sets came about, in their order.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CoplanarTrace {
    /// One a set.
    pub sets: Vec<CoplanarSetTrace>,
}

/// Sets of coplanar lines with their polygons, verified or not.
pub fn coplanar_sets(
    scene: &Scene,
    lines: &[Line3d],
    segments: &[Vec<ImageSegment>],
    roof: &RoofParams,
) -> (Vec<CoplanarSet>, CoplanarTrace) {
    let Some(middle) = lines.get(lines.len() / 2).map(|l| l.at(0.5)) else {
        return Default::default();
    };
    let pixel = scene.median_ground_pixel(&middle).unwrap_or(FINEST_STEP);
    let sample = pixel.max(FINEST_STEP);
    let reduced = scene.reduced(((sample / pixel).round() as usize).max(1));
    let cell = PlanGrid::cell_of_pixels(sample);
    let images = ImageEvidence::new(scene, &reduced, cell, segments, roof);
    let space = LineSpace::new(lines, pixel);
    let sets = coplanar_line_sets(&space, &images);
    let polygons = crate::base::execution::map(&sets, |_, set| polygon(&space, &images, set));
    let (sets, traces) = polygons.into_iter().flatten().unzip();
    (sets, CoplanarTrace { sets: traces })
}

/// The polygon of a set; `None` where its hull has no area.
fn polygon(
    space: &LineSpace,
    images: &ImageEvidence,
    set: &LineSet,
) -> Option<(CoplanarSet, CoplanarSetTrace)> {
    let plane = set.plane.plane();
    let hull = space.hull(&set.lines);
    let outline = Outline::of_hull(space, set)?.with_closed_corners();
    let (outline, closing) = outline.with_closing_sides(&plane, images);
    let polygon = outline.lifted(&plane);
    let found = CoplanarSet {
        lines: set.lines.clone(),
        plane,
        covariance: set.plane.covariance_at(&mean_point(&polygon).xy()),
        hull: hull.iter().map(|p| plane.lift(p.x, p.y)).collect(),
        coplanar_nats: set.nats,
        inside_nats: images.inside(&plane, &outline.corners, &[]),
        outline_nats: images.outline(&polygon),
        polygon,
    };
    Some((found, CoplanarSetTrace { closing }))
}
