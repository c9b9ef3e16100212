//! Grouping half-planes and lines into planes (B99 4.2, figures 16 to 18).
//!
//! A group grows from its strongest half-plane over the topological neighbourhood: a neighbouring
//! line that lies in the plane joins it; when it carries a half-plane of nearly the same angle,
//! that half-plane joins too (collinear and coplanar half-planes alike). The plane is then computed
//! again by orthogonal regression to regular samples of all its lines (figure 17). A group with a
//! single line has no extent across it, so each half-plane also enters the regression as two points
//! away from its line, weighted by the uncertainty of theta; with a second line across the plane
//! their weight is small against the lines'.
//!
//! ```text
//! neighbourhood   Delaunay triangulation constrained to the projected lines
//! proposed_plane  a plane of another source (B99 2, W96 3.6)
//! plane_group     lines and half-planes that share a plane
//! region          the part of the plan that a group may cover
//! coplanarity     which lines lie in a plane, and the plane that fits them
//! growth          how groups grow and merge
//! line_pairs      planes of two lines without a half-plane (B99 5)
//! propagated      half-planes propagated from a plane next to them, where texture is weak
//! proposals       planes of other sources beside the groups
//! grouped         the order of these steps
//! ```
//!
//! Invariant: every half-plane of the sweep ends in exactly one group.

mod coplanarity;
mod grouped;
mod growth;
mod line_pairs;
mod neighbourhood;
mod plane_group;
pub(crate) mod propagated;
mod proposals;
mod proposed_plane;
mod region;

pub use grouped::GroupedPlanes;
pub(crate) use neighbourhood::line_neighbours;
pub(crate) use plane_group::GroupingInput;
pub use plane_group::{Member, PlaneGroup};
pub use proposed_plane::ProposedPlane;
pub(crate) use region::{MARGIN, PlanRegion};

#[cfg(test)]
pub(crate) use region::region_beside;
