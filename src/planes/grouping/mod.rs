//! Grouping half-planes and lines into planes (B99 4.2, figures 16 to 18).
//!
//! A group grows from its strongest half-plane over the topological neighbourhood: a neighbouring line
//! that lies in the plane joins it; when it carries a half-plane of nearly the same angle, that half-plane
//! joins too (collinear and coplanar half-planes alike). The plane is then computed again by
//! orthogonal regression to regular samples of all its lines (figure 17). A group with a single line has
//! no extent across it, so each half-plane also enters the regression as two points away from its line,
//! weighted by the uncertainty of theta; with a second line across the plane their weight is small
//! against the lines'.

mod line_pairs;
mod neighbourhood;
pub(crate) mod propagated;
mod proposed;
mod region;

pub(crate) use neighbourhood::line_neighbours;
pub(crate) use propagated::{group_repeated, with_repeated};
pub use proposed::ProposedPlane;
pub(crate) use proposed::add_rectangles;
pub(crate) use region::{MARGIN, Region};

use nalgebra::Point3;
use serde::Serialize;

use self::line_pairs::{add_line_pairs, with_lines_around};
use self::neighbourhood::Neighbours;
use super::half_plane::HalfPlane;
use crate::geometry::Plane;
use crate::ids::HalfPlaneId;
use crate::ids::LineId;
use crate::lines3d::Line3d;
use crate::lines3d::{Side, ThetaFrame};
use crate::math::smaller;
use crate::params::RoofParams;
use crate::sorting::sort_by;

/// A line that belongs to a plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
pub struct PlaneGroup {
    /// The plane, by regression to all members.
    pub plane: Plane,
    /// Members, the seed first.
    pub members: Vec<Member>,
    /// Planes of the other method in this plane ([`proposed::ProposedPlane::index`]).
    pub rectangles: Vec<u32>,
}

impl PlaneGroup {
    /// Is the line a member?
    pub fn contains(&self, line: LineId) -> bool {
        self.members.iter().any(|m| m.line == line)
    }

    /// The distinct lines, ascending.
    pub fn lines(&self) -> Vec<LineId> {
        let mut lines: Vec<LineId> = self.members.iter().map(|m| m.line).collect();
        sort_by(&mut lines, Ord::cmp);
        lines.dedup();
        lines
    }

    /// A point in or near the plane.
    pub fn place(&self, input: &GroupingInput) -> Option<Point3<f64>> {
        let first = self.members.first();
        let on_line = first.map(|m| input.lines[m.line.index()].at(0.5));
        on_line.or_else(|| self.rectangles(input).next()?.ring.first().copied())
    }

    /// The rectangles of the other method.
    pub fn rectangles<'a>(
        &self,
        input: &GroupingInput<'a>,
    ) -> impl Iterator<Item = &'a ProposedPlane> {
        let proposed = input.rectangles;
        proposed
            .iter()
            .filter(|r| self.rectangles.contains(&r.index))
    }

    /// Does it consist of half-planes that only repeat another plane?
    pub fn is_repeated(&self, input: &GroupingInput) -> bool {
        let half_planes = self.half_planes();
        let swept = |h: &HalfPlaneId| input.half_planes[h.index()].is_swept();
        !half_planes.is_empty() && !half_planes.iter().any(swept)
    }

    /// The same without the half-planes that no view has shown.
    pub fn as_swept(&self, input: &GroupingInput) -> Self {
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
        sort_by(&mut ids, Ord::cmp);
        ids
    }
}

/// Everything that grouping reads.
#[derive(Clone, Copy)]
pub struct GroupingInput<'a> {
    /// 3D lines.
    pub lines: &'a [Line3d],
    /// Accepted half-planes, and behind them those that repeat another plane ([`HalfPlane::is_swept`]).
    pub half_planes: &'a [HalfPlane],
    /// Neighbours of each line.
    pub neighbours: &'a Neighbours,
    /// Planes that the other method proposes.
    pub rectangles: &'a [ProposedPlane],
}

/// Groups all half-planes; every half-plane ends in exactly one group.
pub fn group_planes(input: &GroupingInput, params: &RoofParams) -> Vec<PlaneGroup> {
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
    crate::execution::map(&groups, |_, g| match g.half_planes().is_empty() {
        true => with_lines_around(input, g, params),
        false => g.clone(),
    })
}

/// A line that lies in the plane without a half-plane has the plane on the side of the other members.
pub fn infer_sides(input: &GroupingInput, group: &mut PlaneGroup) {
    /// Nearer than this to the line the others do not tell, metres.
    const UNDECIDED: f64 = 0.5;
    let middle = |m: &Member| input.lines[m.line.index()].at(0.5);
    let middles: Vec<_> = group.members.iter().map(middle).collect();
    for (i, m) in group
        .members
        .iter_mut()
        .enumerate()
        .filter(|(_, m)| m.side.is_none())
    {
        let line = &input.lines[m.line.index()].segment;
        let (d, p) = (line.direction().xy(), line.p0.xy());
        let offset: f64 = middles
            .iter()
            .enumerate()
            .filter(|(j, _)| *j != i)
            .map(|(_, q)| d.perp(&(q.xy() - p)))
            .sum();
        if offset.abs() > UNDECIDED {
            m.side = Some(if offset > 0.0 {
                Side::Left
            } else {
                Side::Right
            });
        }
    }
}

fn half_planes_by_line(input: &GroupingInput) -> Vec<Vec<HalfPlaneId>> {
    let mut by_line = vec![Vec::new(); input.lines.len()];
    for (i, h) in input.half_planes.iter().enumerate() {
        by_line[h.line.index()].push(HalfPlaneId::from_index(i));
    }
    by_line
}

/// Half-planes, the most reliable first: similarity times the length of the line.
pub fn by_strength(input: &GroupingInput) -> Vec<HalfPlaneId> {
    let strength = |id: &HalfPlaneId| {
        let h = &input.half_planes[id.index()];
        h.similarity * input.lines[h.line.index()].segment.length()
    };
    let mut ids: Vec<HalfPlaneId> = (0..input.half_planes.len())
        .map(HalfPlaneId::from_index)
        .collect();
    sort_by(&mut ids, |a, b| {
        strength(b).total_cmp(&strength(a)).then(a.cmp(b))
    });
    ids
}

pub fn grow(
    input: &GroupingInput,
    by_line: &[Vec<HalfPlaneId>],
    seed: HalfPlaneId,
    free: &mut [bool],
    params: &RoofParams,
) -> PlaneGroup {
    let half_plane = &input.half_planes[seed.index()];
    free[seed.index()] = false;
    let mut group = PlaneGroup {
        plane: half_plane.plane,
        members: vec![member(input, half_plane.line, Some(seed))],
        rectangles: Vec::new(),
    };
    extend(input, by_line, &mut group, free, params);
    group
}

pub fn member(input: &GroupingInput, line: LineId, half_plane: Option<HalfPlaneId>) -> Member {
    Member {
        line,
        side: half_plane.map(|h| input.half_planes[h.index()].side),
        half_plane,
    }
}

/// Adds neighbouring lines and half-planes that lie in the group's plane until there are no more.
pub fn extend(
    input: &GroupingInput,
    by_line: &[Vec<HalfPlaneId>],
    group: &mut PlaneGroup,
    free: &mut [bool],
    params: &RoofParams,
) {
    let mut queue: std::collections::VecDeque<LineId> =
        group.members.iter().map(|m| m.line).collect();
    while let Some(line) = queue.pop_front() {
        for &next in &input.neighbours.direct[line.index()] {
            if group.contains(next) || !lies_in_plane(input, group, next, params) {
                continue;
            }
            let matching = by_line[next.index()].iter().copied().find(|h| {
                free[h.index()]
                    && input.half_planes[h.index()].plane.angle_to(&group.plane)
                        < params.coplanar_angle_deg.to_radians()
            });
            // A line whose half-planes all rise elsewhere is still a border of this plane when it
            // bounds it on the right side, which delineation decides: it lies in the plane (figure 21 a).
            let before = group.clone();
            group.members.push(member(input, next, matching));
            match fit_plane(input, &group.members) {
                Some(plane) if all_lie_in(input, &plane, &group.members, params) => {
                    group.plane = plane;
                    if let Some(h) = matching {
                        free[h.index()] = false;
                    }
                    queue.push_back(next);
                }
                _ => *group = before,
            }
        }
    }
}

/// Does the line lie in the group's plane as far as the group's plane is known there?
pub fn lies_in_plane(
    input: &GroupingInput,
    group: &PlaneGroup,
    line: LineId,
    params: &RoofParams,
) -> bool {
    let candidate = &input.lines[line.index()];
    let over: Vec<&ProposedPlane> = group.rectangles(input).collect();
    [candidate.segment.p0, candidate.segment.p1]
        .iter()
        .all(|p| {
            // The nearest member tells how far the plane has to be extrapolated.
            let reach = group
                .members
                .iter()
                .map(|m| distance_to_segment(p, &input.lines[m.line.index()]))
                .chain(over.iter().map(|r| r.distance(&p.xy())))
                .fold(f64::INFINITY, smaller);
            let sigma_angle = if group.members.len() == 1 {
                group.members[0]
                    .half_plane
                    .map_or(0.0, |h| input.half_planes[h.index()].sigma_theta)
                    .max(MIN_SIGMA_THETA)
            } else {
                MIN_SIGMA_THETA
            };
            let sigma = (candidate.sigma_m * candidate.sigma_m
                + reach * sigma_angle * reach * sigma_angle)
                .sqrt();
            let tolerance =
                (3.0 * sigma).clamp(params.coplanar_distance_m, 3.0 * params.coplanar_distance_m);
            reach <= params.max_facet_depth_m && group.plane.signed_distance(p).abs() <= tolerance
        })
}

/// After the regression every member must still lie in the plane.
pub fn all_lie_in(
    input: &GroupingInput,
    plane: &Plane,
    members: &[Member],
    params: &RoofParams,
) -> bool {
    members.iter().all(|m| {
        let line = &input.lines[m.line.index()];
        let tolerance = (3.0 * line.sigma_m)
            .clamp(params.coplanar_distance_m, 2.0 * params.coplanar_distance_m);
        plane.signed_distance(&line.segment.p0).abs() <= tolerance
            && plane.signed_distance(&line.segment.p1).abs() <= tolerance
            && m.half_plane.is_none_or(|h| {
                input.half_planes[h.index()].plane.angle_to(plane)
                    < 1.5 * params.coplanar_angle_deg.to_radians()
            })
    })
}

/// Least standard deviation of theta that is believed, radians: B99 4.4 reports 2 degrees on textured roofs.
const MIN_SIGMA_THETA: f64 = 1.5 * std::f64::consts::PI / 180.0;
/// Least standard deviation of a line that is believed, metres: edges are blurred, gutters have a width.
const MIN_SIGMA_LINE: f64 = 0.03;
/// Distance from the line at which a half-plane's angle enters the regression, metres.
const ANGLE_ARM: f64 = 2.0;

/// Orthogonal regression to samples of all lines and to the half-planes' angles (figure 17).
pub fn fit_plane(input: &GroupingInput, members: &[Member]) -> Option<Plane> {
    let mut points = Vec::new();
    for member in members {
        let line = &input.lines[member.line.index()];
        let sigma = line.sigma_m.max(MIN_SIGMA_LINE);
        let samples = (line.segment.length() as usize).clamp(2, 50);
        for i in 0..=samples {
            points.push((line.at(i as f64 / samples as f64), 1.0 / (sigma * sigma)));
        }
        if let Some(h) = member.half_plane {
            let half_plane = &input.half_planes[h.index()];
            if let Some(frame) = ThetaFrame::new(&line.segment, half_plane.side) {
                let sigma = ANGLE_ARM * half_plane.sigma_theta.max(MIN_SIGMA_THETA);
                let away = frame.away(half_plane.theta) * ANGLE_ARM;
                points.push((line.at(0.25) + away, 1.0 / (sigma * sigma)));
                points.push((line.at(0.75) + away, 1.0 / (sigma * sigma)));
            }
        }
    }
    Plane::fit(&points).filter(|p| p.normal.z > 0.1)
}

/// Neighbouring groups of one plane become one.
pub fn merge_groups(
    input: &GroupingInput,
    groups: Vec<PlaneGroup>,
    params: &RoofParams,
) -> Vec<PlaneGroup> {
    let mut merged: Vec<PlaneGroup> = Vec::new();
    for group in groups {
        let target = merged.iter().position(|m| {
            m.plane.angle_to(&group.plane) < params.coplanar_angle_deg.to_radians()
                && are_neighbours(input, m, &group)
                && {
                    let mut union = m.members.clone();
                    union.extend(
                        group
                            .members
                            .iter()
                            .filter(|x| !union.contains(x))
                            .copied()
                            .collect::<Vec<_>>(),
                    );
                    fit_plane(input, &union)
                        .is_some_and(|plane| all_lie_in(input, &plane, &union, params))
                }
        });
        match target {
            Some(t) => {
                let extra: Vec<Member> = group
                    .members
                    .into_iter()
                    .filter(|x| !merged[t].members.contains(x))
                    .collect();
                merged[t].members.extend(extra);
                if let Some(plane) = fit_plane(input, &merged[t].members) {
                    merged[t].plane = plane;
                }
            }
            None => merged.push(group),
        }
    }
    merged
}

fn are_neighbours(input: &GroupingInput, a: &PlaneGroup, b: &PlaneGroup) -> bool {
    let lines = b.lines();
    a.members.iter().any(|m| {
        lines.contains(&m.line)
            || input.neighbours.direct[m.line.index()]
                .iter()
                .any(|n| lines.binary_search(n).is_ok())
    })
}

fn distance_to_segment(p: &Point3<f64>, line: &Line3d) -> f64 {
    let (a, b) = (line.segment.p0, line.segment.p1);
    let d = b - a;
    let t = ((p - a).dot(&d) / d.norm_squared().max(1e-12)).clamp(0.0, 1.0);
    (p - (a + d * t)).norm()
}
