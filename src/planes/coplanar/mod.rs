//! Coplanar grouping of 3D lines (B99 2: the approach of Leuven; 5: "grouping and removing from
//! consideration coplanar lines").
//!
//! ```text
//! hypothesis       relations weighed by likelihoods
//! uncertain_plane  a plane with its covariance, fitted to lines
//! sets             sets of coplanar lines
//! outline          convex hull of their ends -> polygon with closed corners and sides
//! wireframe        the polygon adjusted to the image edges; square corners, level sides, symmetry
//! image_evidence   back-projection: what the photographs say of a polygon
//! ```
//!
//! "The emphasis during this modeling stage is on extracting the correct topology of the roof
//! structure rather than on the metric accuracy": outline. "Metric accuracy is obtained in an
//! additional step": wireframe.
//!
//! Invariant: no distance and no angle decides here; likelihoods do, in nats.

mod hypothesis;
mod image_evidence;
mod outline;
mod sets;
#[cfg(test)]
mod tests;
mod uncertain_plane;
mod wireframe;

pub(crate) use hypothesis::{END_M, log_normal, log_odds};
pub(crate) use image_evidence::ImageEvidence;
pub use outline::{ClosingKind, ClosingSide};
pub(crate) use uncertain_plane::{LineEnd, UncertainPlane};
pub use wireframe::{CoplanarRelationKind, WeighedRelation};

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use self::hypothesis::{LEVEL, SYMMETRIC, relation_nats};
use self::outline::Outline;
use self::sets::{LineSet, LineSpace, coplanar_line_sets};
use self::uncertain_plane::ends_of;
use self::wireframe::{Adjusted, Wireframe};
use crate::base::geometry::{Plane, mean_point};
use crate::base::ids::{LineId, ProposalOrigin};
use crate::base::params::{Lines3dParams, RoofParams};
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::{Line3d, Observation, Side};
use crate::orienting::scene::Scene;
use crate::planes::grouping::ProposedPlane;
use crate::planes::photoconsistency::PlanGrid;

/// Finest distance of the positions of a window, metres, as in the labelling of facets.
pub(crate) const FINEST_STEP: f64 = 0.06;
/// Sides shorter than this are none, metres.
const LEAST_SIDE: f64 = 0.05;

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
        }
    }

    /// Does it explain what lies on one side of a line, so that no half-plane needs to be sought
    /// there (B99 5)?
    pub fn explains(&self, id: LineId, line: &Line3d, side: Side) -> bool {
        let start = line.segment.p0.xy();
        let to = mean_point(&self.polygon).xy() - start;
        let left = line.segment.direction().xy().perp(&to) > 0.0;
        self.is_verified() && self.lines.contains(&id) && (side == Side::Left) == left
    }
}

/// How the polygon of a set came about.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CoplanarSetTrace {
    /// Sides without a line that were moved.
    pub closing: Vec<ClosingSide>,
    /// Relations, adopted and not.
    pub relations: Vec<WeighedRelation>,
    /// Root mean square reprojection error of the wireframe before and after its adjustment, px.
    pub reprojection_px: [f64; 2],
    /// Number of image edges that it was adjusted to.
    pub edges: usize,
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
    lines_params: &Lines3dParams,
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
    let slopes = slopes_across_ridges(&space, &sets);
    let polygons = crate::base::execution::map(&sets, |i, set| {
        polygon(scene, &space, &images, set, slopes[i], lines_params)
    });
    let (sets, traces) = polygons.into_iter().flatten().unzip();
    (sets, CoplanarTrace { sets: traces })
}

/// The polygon of a set; `None` where its hull has no area.
fn polygon(
    scene: &Scene,
    space: &LineSpace,
    images: &ImageEvidence,
    set: &LineSet,
    slope: Option<f64>,
    params: &Lines3dParams,
) -> Option<(CoplanarSet, CoplanarSetTrace)> {
    let plane = set.plane.plane();
    let hull = space.hull(&set.lines);
    let outline = Outline::of_hull(space, set)?.with_closed_corners();
    let (outline, closing) = outline.with_closing_sides(&plane, images);
    let (wireframe, start) = wireframe_of(scene, space, set, &outline, params);
    let (adjusted, relations, wireframe) = with_relations(wireframe, &start, slope);
    let (before, edges) = wireframe.reprojection(&start);
    let is_sound = |found: &Adjusted| {
        let corners = wireframe
            .ring(&found.state)
            .iter()
            .map(|p| p.xy())
            .collect();
        let moved = Outline {
            corners,
            sides: Vec::new(),
        };
        moved.is_convex(LEAST_SIDE)
    };
    let adjusted = adjusted.filter(is_sound);
    let state = adjusted.as_ref().map_or(&start, |found| &found.state);
    let (plane, polygon) = (wireframe.plane(state), wireframe.ring(state));
    let covariance = match &adjusted {
        Some(found) => found.covariance.fixed_view::<3, 3>(0, 0).into_owned(),
        None => set.plane.covariance,
    };
    let in_plan: Vec<_> = polygon.iter().map(|p| p.xy()).collect();
    let lines_plane = set.plane.plane();
    let found = CoplanarSet {
        lines: set.lines.clone(),
        plane,
        covariance: UncertainPlane {
            covariance,
            ..set.plane
        }
        .covariance_at(&mean_point(&polygon).xy()),
        hull: hull.iter().map(|p| lines_plane.lift(p.x, p.y)).collect(),
        coplanar_nats: set.nats,
        inside_nats: images.inside(&plane, &in_plan, &[]),
        outline_nats: images.outline(&polygon),
        polygon,
    };
    let trace = CoplanarSetTrace {
        closing,
        relations,
        reprojection_px: [before, wireframe.reprojection(state).0],
        edges,
    };
    Some((found, trace))
}

/// The wireframe of an outline with the measured edges of the lines on its sides, and the lines
/// inside it.
fn wireframe_of<'a>(
    scene: &'a Scene,
    space: &LineSpace<'a>,
    set: &LineSet,
    outline: &Outline,
    params: &Lines3dParams,
) -> (Wireframe<'a>, wireframe::WireframeState) {
    let on_sides: Vec<(usize, LineId)> = (outline.sides.iter().enumerate())
        .flat_map(|(k, lines)| lines.iter().map(move |l| (k, *l)))
        .collect();
    let edges = on_sides.iter().flat_map(|&(k, id)| {
        let edges = space
            .line(id)
            .supports
            .iter()
            .filter_map(|s| s.edge.as_ref());
        edges.map(move |edge| (k, Observation::of(edge, scene.camera(edge.view))))
    });
    let has_edges = |id: &LineId| {
        let mut supports = space.line(*id).supports.iter();
        on_sides.iter().any(|(_, l)| l == id) && supports.any(|s| s.edge.is_some())
    };
    let others = set.lines.iter().filter(|id| !has_edges(id));
    let inside = others.flat_map(|&id| {
        let sigma = |end| set.plane.sigma_of(&end, space.pixel_m);
        ends_of(space.line(id)).map(|end| (end.at, sigma(end)))
    });
    Wireframe::new(outline, &set.plane, edges, inside, params)
}

/// Adjusts a wireframe, weighs its relations by the covariance, and adjusts it again with those
/// that are likelier true than not.
fn with_relations<'a>(
    mut wireframe: Wireframe<'a>,
    start: &wireframe::WireframeState,
    slope: Option<f64>,
) -> (Option<Adjusted>, Vec<WeighedRelation>, Wireframe<'a>) {
    let Some(free) = wireframe.adjust(start) else {
        return (None, Vec::new(), wireframe);
    };
    let weighed = wireframe.weigh_relations(&free, slope);
    let likely = weighed.iter().filter(|(_, w)| w.nats > 0.0);
    wireframe.adopt(likely.map(|(relation, _)| *relation));
    let adjusted = wireframe.adjust(&free.state).or(Some(free));
    let relations = weighed.into_iter().map(|(_, w)| w).collect();
    (adjusted, relations, wireframe)
}

/// For each set the common slope of its plane and of that across a level ridge, if it is likelier
/// that they are equal than that they are not.
fn slopes_across_ridges(space: &LineSpace, sets: &[LineSet]) -> Vec<Option<f64>> {
    let of_set = |i: usize| {
        let own = sets[i].plane.slope();
        let others = sets.iter().enumerate().filter(|(j, _)| *j != i);
        let weighed = others.filter_map(|(_, other)| {
            let across = other.plane.slope();
            let mut shared = sets[i].lines.iter().filter(|l| other.lines.contains(l));
            let is_ridge = own.1.dot(&across.1) < 0.0 && shared.any(|&l| is_level(space, l));
            let variance = own.2 + across.2;
            let nats = relation_nats(own.0 - across.0, variance, 2.0, SYMMETRIC);
            let common = (own.0 * across.2 + across.0 * own.2) / variance;
            (is_ridge && nats > 0.0).then_some((nats, common))
        });
        let best = weighed.max_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, slope)| slope)
    };
    (0..sets.len()).map(of_set).collect()
}

/// Is a line likelier level than not?
fn is_level(space: &LineSpace, id: LineId) -> bool {
    let line = space.line(id);
    let [a, b] = line.covariance.map(|c| c[(2, 2)]);
    let rise = line.segment.p1.z - line.segment.p0.z;
    let variance = a + b + space.pixel_m * space.pixel_m;
    relation_nats(rise, variance, line.segment.length(), LEVEL) > 0.0
}
