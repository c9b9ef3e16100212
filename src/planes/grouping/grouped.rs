//! The order of grouping: half-planes and lines, propagated half-planes, planes of other sources.

use super::growth::{grow_all, infer_sides};
use super::line_pairs::{add_line_pairs, with_lines_around};
use super::neighbourhood::{LineNeighbours, line_neighbours};
use super::plane_group::{GroupingInput, Member, PlaneGroup};
use super::propagated::{group_propagated, with_propagated};
use super::proposals::add_proposals;
use super::proposed_plane::ProposedPlane;
use crate::base::execution::map;
use crate::base::ids::HalfPlaneId;
use crate::base::params::RoofParams;
use crate::lines::lines3d::Line3d;
use crate::planes::half_planes::{HalfPlane, is_wall};
use crate::planes::terrain::Ground;

/// Groups with the lines, half-planes and proposed planes that they refer to.
#[derive(Clone, Debug)]
pub struct GroupedPlanes<'a> {
    /// Of roofs: neither walls nor what lies on the ground.
    pub groups: Vec<PlaneGroup>,
    lines: &'a [Line3d],
    /// Those of the sweep, and behind them the propagated ones.
    half_planes: Vec<HalfPlane>,
    neighbours: LineNeighbours,
    proposals: &'a [ProposedPlane],
}

impl<'a> GroupedPlanes<'a> {
    /// Groups half-planes, pairs of lines where these are a source, and proposed planes.
    pub fn new(
        lines: &'a [Line3d],
        half_planes: &[HalfPlane],
        line_pairs: bool,
        proposals: &'a [ProposedPlane],
        ground: &Ground,
        params: &RoofParams,
    ) -> Self {
        let neighbours = line_neighbours(lines);
        let input = GroupingInput {
            lines,
            half_planes,
            neighbours: &neighbours,
            proposals,
        };
        let mut groups = group_planes(&input, line_pairs, params);
        groups.retain(|g| !is_wall(&g.plane) && !lies_on_ground(&input, g, ground, params));
        let half_planes = with_propagated(&input, &groups, ground, params);
        let input = GroupingInput {
            half_planes: &half_planes,
            ..input
        };
        groups.extend(group_propagated(&input, params));
        add_proposals(&input, &mut groups, params);
        Self {
            groups,
            lines,
            half_planes,
            neighbours,
            proposals,
        }
    }

    /// What the groups refer to.
    pub(crate) fn input(&self) -> GroupingInput<'_> {
        GroupingInput {
            lines: self.lines,
            half_planes: &self.half_planes,
            neighbours: &self.neighbours,
            proposals: self.proposals,
        }
    }
}

/// Groups all half-planes, and pairs of lines that none explains where these are a source; every
/// half-plane ends in exactly one group.
pub(super) fn group_planes(
    input: &GroupingInput,
    line_pairs: bool,
    params: &RoofParams,
) -> Vec<PlaneGroup> {
    let by_line = half_planes_by_line(input);
    let free = vec![true; input.half_planes.len()];
    let mut groups = grow_all(input, &by_line, free, params);
    if line_pairs {
        add_line_pairs(input, &by_line, &mut groups, params);
    }
    groups.iter_mut().for_each(|g| infer_sides(input, g));
    map(&groups, |_, g| match g.half_planes().is_empty() {
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

/// Are all lines of the group lower than any eave?
fn lies_on_ground(
    input: &GroupingInput,
    group: &PlaneGroup,
    ground: &Ground,
    params: &RoofParams,
) -> bool {
    let mut members = group.members.iter();
    let line = |m: &Member| &input.lines[m.line.index()].segment;
    members.all(|m| ground.is_near(line(m), params.min_height_m))
}
