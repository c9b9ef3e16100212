//! Planes: half-planes beside 3D lines (B99 4.1), grouped into planes (4.2), with their evidence.
//!
//! ```text
//! half_plane   one side of a 3D line, and the plane there
//! sweep        half-planes by homography sweep over theta
//! grouping     half-planes and lines that share a plane, and the region that it may cover
//! line_sides   photo-consistency on both sides of a line
//! single_view  evidence where only one view sees a plane
//! plane_lines  new lines in a plane from segments of several views
//! hypothesis   planes with their regions, photo-consistency and lines, ready to compete
//! ```
//!
//! Invariant: which plane covers which part of the plan is not decided here, but in
//! [`crate::facets`].

mod grouping;
mod half_plane;
mod hypothesis;
mod line_sides;
pub(crate) mod plane_lines;
#[cfg(test)]
pub(crate) mod rendered_planes;
pub(crate) mod single_view;
mod sweep;

#[cfg(test)]
pub(crate) use grouping::region_beside;
pub(crate) use grouping::{
    GroupingInput, MARGIN, PlanRegion, add_proposals, convex_hull, group_planes, group_propagated,
    line_neighbours, with_propagated,
};
pub use grouping::{Member, PlaneGroup, ProposedPlane};
pub use half_plane::HalfPlane;
pub(crate) use half_plane::is_wall;
pub(crate) use hypothesis::{PlaneHypothesis, plane_hypotheses};
pub(crate) use line_sides::crosses_surface;
pub use plane_lines::PlaneLine;
pub use sweep::{
    PointsOfInterest, Posterior, SideTrace, SimilarityCurve, SweepRejection, SweepTrace, ViewCurve,
    similarity_curve, sweep_half_planes, sweep_side,
};
