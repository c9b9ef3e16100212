//! Lines and half-planes that share a plane.

use nalgebra::Point3;
use serde::Serialize;

use super::neighbourhood::LineNeighbours;
use super::proposed_plane::ProposedPlane;
use crate::base::geometry::Plane;
use crate::base::ids::{HalfPlaneId, LineId, ProposalOrigin};
use crate::lines::lines3d::{Line3d, Side};
use crate::planes::half_planes::HalfPlane;

/// A line that belongs to a plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Member {
    /// The line.
    pub line: LineId,
    /// The side of the line that the plane covers, where that is known.
    pub side: Option<Side>,
    /// Its half-plane in this plane; `None` for a line that merely lies in it.
    pub half_plane: Option<HalfPlaneId>,
}

/// Lines and half-planes that share a plane.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneGroup {
    /// The plane, by regression to all members.
    pub plane: Plane,
    /// Members, the seed first.
    pub members: Vec<Member>,
    /// What other sources proposed in this plane.
    pub proposals: Vec<ProposalOrigin>,
}

impl PlaneGroup {
    /// Is the line a member?
    pub fn contains(&self, line: LineId) -> bool {
        self.members.iter().any(|m| m.line == line)
    }

    /// The distinct lines, ascending.
    pub fn lines(&self) -> Vec<LineId> {
        let mut lines: Vec<LineId> = self.members.iter().map(|m| m.line).collect();
        lines.sort();
        lines.dedup();
        lines
    }

    /// A point in or near the plane.
    pub fn place(&self, input: &GroupingInput) -> Option<Point3<f64>> {
        let first = self.members.first();
        let on_line = first.map(|m| input.lines[m.line.index()].at(0.5));
        on_line.or_else(|| self.proposed(input).next()?.ring.first().copied())
    }

    /// What other sources proposed in its plane.
    pub fn proposed<'a>(
        &self,
        input: &GroupingInput<'a>,
    ) -> impl Iterator<Item = &'a ProposedPlane> {
        let proposed = input.proposals;
        proposed
            .iter()
            .filter(|r| self.proposals.contains(&r.origin))
    }

    /// Are all its half-planes propagated from other planes?
    pub fn is_propagated(&self, input: &GroupingInput) -> bool {
        let half_planes = self.half_planes();
        let swept = |h: &HalfPlaneId| input.half_planes[h.index()].is_swept();
        !half_planes.is_empty() && !half_planes.iter().any(swept)
    }

    /// The same without the propagated half-planes.
    pub fn without_propagated(&self, input: &GroupingInput) -> Self {
        let mut group = self.clone();
        for member in &mut group.members {
            let swept = |h: &HalfPlaneId| input.half_planes[h.index()].is_swept();
            member.half_plane = member.half_plane.filter(swept);
        }
        group
    }

    /// The half-planes, ascending.
    pub fn half_planes(&self) -> Vec<HalfPlaneId> {
        let mut ids: Vec<HalfPlaneId> = self.members.iter().filter_map(|m| m.half_plane).collect();
        ids.sort();
        ids
    }
}

/// Everything that grouping reads.
#[derive(Clone, Copy)]
pub struct GroupingInput<'a> {
    /// 3D lines.
    pub lines: &'a [Line3d],
    /// Accepted half-planes, and behind them the propagated ones ([`HalfPlane::is_swept`]).
    pub half_planes: &'a [HalfPlane],
    /// Neighbours of each line.
    pub neighbours: &'a LineNeighbours,
    /// Planes that other sources propose.
    pub proposals: &'a [ProposedPlane],
}

/// A line as a member of a group, with its half-plane.
pub(super) fn member(
    input: &GroupingInput,
    line: LineId,
    half_plane: Option<HalfPlaneId>,
) -> Member {
    Member {
        line,
        side: half_plane.map(|h| input.half_planes[h.index()].side),
        half_plane,
    }
}
