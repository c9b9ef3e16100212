//! How groups grow over the topological neighbourhood and merge (B99 4.2, figures 16 to 18).

use super::coplanarity::{all_lie_in, fit_plane, lies_in_plane};
use super::plane_group::{GroupingInput, Member, PlaneGroup, member};
use crate::base::ids::{HalfPlaneId, LineId};
use crate::base::params::RoofParams;
use crate::lines::lines3d::Side;

/// Half-planes, the most reliable first: similarity times the length of the line.
pub(super) fn by_strength(input: &GroupingInput) -> Vec<HalfPlaneId> {
    let strength = |id: &HalfPlaneId| {
        let h = &input.half_planes[id.index()];
        h.similarity * input.lines[h.line.index()].segment.length()
    };
    let mut ids: Vec<HalfPlaneId> = (0..input.half_planes.len())
        .map(HalfPlaneId::from_index)
        .collect();
    ids.sort_by(|a, b| strength(b).total_cmp(&strength(a)).then(a.cmp(b)));
    ids
}

/// Groups that grow from the strongest half-planes that are free, those of one plane merged.
pub(super) fn grow_all(
    input: &GroupingInput,
    by_line: &[Vec<HalfPlaneId>],
    mut free: Vec<bool>,
    params: &RoofParams,
) -> Vec<PlaneGroup> {
    let mut groups = Vec::new();
    for seed in by_strength(input) {
        if free[seed.index()] {
            groups.push(grow(input, by_line, seed, &mut free, params));
        }
    }
    merge_groups(input, groups, params)
}

/// The group that grows from a half-plane over those that are still free.
pub(super) fn grow(
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
        proposals: Vec::new(),
    };
    extend(input, by_line, &mut group, free, params);
    group
}

/// Adds neighbouring lines and half-planes that lie in the group's plane until there are no more.
pub(super) fn extend(
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
            // bounds it on the right side, which delineation decides: it lies in the plane (figure
            // 21 a).
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

/// Neighbouring groups of one plane become one.
pub(super) fn merge_groups(
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

/// A line that lies in the plane without a half-plane has the plane on the side of the other
/// members.
pub(super) fn infer_sides(input: &GroupingInput, group: &mut PlaneGroup) {
    /// Below this summed offset the side is left open, metres.
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
