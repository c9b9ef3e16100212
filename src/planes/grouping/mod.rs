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
//! ```
//!
//! Invariant: every half-plane of the sweep ends in exactly one group.

mod coplanarity;
mod growth;
mod line_pairs;
mod neighbourhood;
mod plane_group;
pub(crate) mod propagated;
mod proposals;
mod proposed_plane;
mod region;

pub(crate) use neighbourhood::line_neighbours;
pub(crate) use plane_group::GroupingInput;
pub use plane_group::{Member, PlaneGroup};
pub(crate) use propagated::{group_propagated, with_propagated};
pub(crate) use proposals::add_proposals;
pub use proposed_plane::ProposedPlane;
pub(crate) use region::{MARGIN, PlanRegion};

#[cfg(test)]
pub(crate) use region::region_beside;

use self::growth::{by_strength, grow, infer_sides, merge_groups};
use self::line_pairs::{add_line_pairs, with_lines_around};
use crate::base::ids::HalfPlaneId;
use crate::base::params::RoofParams;

/// Groups all half-planes; every half-plane ends in exactly one group.
pub(crate) fn group_planes(input: &GroupingInput, params: &RoofParams) -> Vec<PlaneGroup> {
    let by_line = half_planes_by_line(input);
    let mut free = vec![true; input.half_planes.len()];
    let mut groups = Vec::new();
    for seed in by_strength(input) {
        if free[seed.index()] {
            groups.push(grow(input, &by_line, seed, &mut free, params));
        }
    }
    let mut groups = merge_groups(input, groups, params);
    add_line_pairs(input, &by_line, &mut groups, params);
    groups.iter_mut().for_each(|g| infer_sides(input, g));
    crate::base::execution::map(&groups, |_, g| match g.half_planes().is_empty() {
        true => with_lines_around(input, g, params),
        false => g.clone(),
    })
}

fn half_planes_by_line(input: &GroupingInput) -> Vec<Vec<HalfPlaneId>> {
    let mut by_line = vec![Vec::new(); input.lines.len()];
    for (i, h) in input.half_planes.iter().enumerate() {
        by_line[h.line.index()].push(HalfPlaneId::from_index(i));
    }
    by_line
}
