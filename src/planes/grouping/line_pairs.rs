//! Planes of two lines (B99 4.2, 5): hipped roofs without texture have ridges, hips and eaves, but
//! no half-plane.
//!
//! B99 5: "an efficient and robust approach would use both" half-planes and coplanar lines. Two
//! neighbouring lines that span a plane propose it; the photo-consistency beside them decides
//! ([`crate::planes::hypotheses::hypothesis`]). Lines that are neighbours around a corner only are
//! paired where the sweep found no half-plane between them.

use super::coplanarity::{all_lie_in, fit_plane, lies_in_plane};
use super::growth::{extend, infer_sides};
use super::plane_group::{GroupingInput, PlaneGroup, member};
use super::region::PlanRegion;
use crate::base::geometry::Plane;
use crate::base::ids::{HalfPlaneId, LineId};
use crate::base::params::RoofParams;
use crate::lines::lines3d::{Line3d, Side};
use crate::planes::half_planes::is_wall;

/// Planes of two neighbouring coplanar lines that no half-plane explains (B99 5: "an efficient and
/// robust approach would use both"): hipped roofs without texture have ridges and eaves, but no
/// half-plane.
pub(super) fn add_line_pairs(
    input: &GroupingInput,
    by_line: &[Vec<HalfPlaneId>],
    groups: &mut Vec<PlaneGroup>,
    params: &RoofParams,
) {
    let mut none_free = vec![false; input.half_planes.len()];
    for first in (0..input.lines.len()).map(LineId::from_index) {
        let around = (input.neighbours.around_corners[first.index()].iter())
            .filter(|&&second| unexplained(input, by_line, first, second));
        let neighbours = input.neighbours.direct[first.index()].iter();
        for &second in neighbours.chain(around).filter(|&&n| n > first) {
            if groups
                .iter()
                .any(|g| g.contains(first) && g.contains(second))
            {
                continue;
            }
            let members = vec![member(input, first, None), member(input, second, None)];
            let Some(plane) = plane_of_pair(input, first, second)
                .filter(|p| all_lie_in(input, p, &members, params))
            else {
                continue;
            };
            let mut group = PlaneGroup {
                plane,
                members,
                proposals: Vec::new(),
            };
            extend(input, by_line, &mut group, &mut none_free, params);
            groups.push(group);
        }
    }
}

/// Has neither of two lines a half-plane on the side of the other?
fn unexplained(
    input: &GroupingInput,
    by_line: &[Vec<HalfPlaneId>],
    first: LineId,
    second: LineId,
) -> bool {
    let explained = |line: LineId, other: LineId| {
        let segment = &input.lines[line.index()].segment;
        let to = input.lines[other.index()].at(0.5).xy() - segment.p0.xy();
        let left = segment.direction().xy().perp(&to) > 0.0;
        let side = if left { Side::Left } else { Side::Right };
        let half_planes = by_line[line.index()].iter();
        half_planes
            .map(|h| input.half_planes[h.index()].side)
            .any(|s| s == side)
    };
    !explained(first, second) && !explained(second, first)
}

/// A group without a half-plane with all lines in its plane that lie where it may reach: clutter on
/// a roof or below it, which the plan does not tell apart, comes between lines that are neighbours
/// on the roof.
pub(super) fn with_lines_around(
    input: &GroupingInput,
    group: &PlaneGroup,
    params: &RoofParams,
) -> PlaneGroup {
    let mut group = group.clone();
    loop {
        let region = PlanRegion::new(input, &group, params);
        let inside = |line: &Line3d| {
            let seen = (0..5).filter(|i| region.contains(&line.at(f64::from(*i) / 4.0).xy()));
            seen.count() >= 3
        };
        let around = (0..input.lines.len()).map(LineId::from_index).filter(|&l| {
            !group.contains(l)
                && inside(&input.lines[l.index()])
                && lies_in_plane(input, &group, l, params)
        });
        let mut larger = group.clone();
        for line in around {
            let mut members = larger.members.clone();
            members.push(member(input, line, None));
            let plane = fit_plane(input, &members);
            if let Some(plane) = plane.filter(|p| all_lie_in(input, p, &members, params)) {
                larger = PlaneGroup {
                    plane,
                    members,
                    ..larger
                };
            }
        }
        if larger.members.len() == group.members.len() {
            return group;
        }
        infer_sides(input, &mut larger);
        group = larger;
    }
}

/// The plane through two lines that span one: at an angle, or parallel and apart.
fn plane_of_pair(input: &GroupingInput, first: LineId, second: LineId) -> Option<Plane> {
    /// Lines at less than this sine (10 degrees) are parallel; ...
    const PARALLEL_SINE: f64 = 0.17;
    /// ... then they must be this far apart, metres.
    const APART: f64 = 1.0;
    let (a, b) = (
        &input.lines[first.index()].segment,
        &input.lines[second.index()].segment,
    );
    let sine = a.direction().cross(&b.direction()).norm();
    let apart = a.line_distance(&b.at(0.5)).max(b.line_distance(&a.at(0.5)));
    if sine < PARALLEL_SINE && apart < APART {
        return None;
    }
    fit_plane(
        input,
        &[member(input, first, None), member(input, second, None)],
    )
    .filter(|p| !is_wall(p))
}

#[cfg(test)]
mod tests {
    use super::super::grouped::group_planes;
    use super::super::neighbourhood::line_neighbours;
    use super::*;
    use crate::roofs::testing::line;
    use nalgebra::Point3;

    /// The four hips of a roof of 14 m by 8 m and 4 m height whose ridge was not found. Hip 3 is a
    /// little too long and a line on the ground lies below, so that the triangulation joins none of
    /// hip 2 to hip 0. The last is a batten in the plane of both.
    fn hipped() -> Vec<Line3d> {
        let p = Point3::new;
        vec![
            line(p(0.0, 0.0, 6.0), p(3.95, 3.95, 9.95)),
            line(p(0.0, 8.0, 6.0), p(4.0, 4.0, 10.0)),
            line(p(14.0, 0.0, 6.0), p(10.1, 3.9, 9.9)),
            line(p(14.0, 8.0, 6.0), p(9.8, 3.8, 10.2)),
            line(p(7.0, -2.0, 0.0), p(7.0, 2.0, 0.0)),
            line(p(6.0, 1.0, 7.0), p(8.0, 1.0, 7.0)),
        ]
    }

    fn groups(lines: &[Line3d]) -> Vec<PlaneGroup> {
        let neighbours = line_neighbours(lines);
        let input = GroupingInput {
            lines,
            half_planes: &[],
            neighbours: &neighbours,
            proposals: &[],
        };
        group_planes(&input, true, &RoofParams::default())
    }

    #[test]
    fn two_hips_span_the_plane_between_them() {
        let lines = hipped();
        let front = groups(&lines[..5]);
        let front = front
            .iter()
            .find(|g| g.contains(LineId(0)) && g.contains(LineId(2)));
        let plane = front.expect("the hips of the front").plane;
        assert!((plane.z_at(7.0, 2.0) - 8.0).abs() < 0.05);
        assert!((plane.z_at(7.0, 0.0) - 6.0).abs() < 0.05);
    }

    #[test]
    fn a_plane_takes_in_the_lines_that_lie_in_it() {
        let lines = hipped();
        let neighbours = line_neighbours(&lines);
        let input = GroupingInput {
            lines: &lines,
            half_planes: &[],
            neighbours: &neighbours,
            proposals: &[],
        };
        let params = RoofParams::default();
        let plane = plane_of_pair(&input, LineId(0), LineId(2)).expect("a plane");
        let members = vec![
            member(&input, LineId(0), None),
            member(&input, LineId(2), None),
        ];
        let mut group = PlaneGroup {
            plane,
            members,
            proposals: Vec::new(),
        };
        infer_sides(&input, &mut group);
        let larger = with_lines_around(&input, &group, &params);
        assert!(larger.contains(LineId(5)), "the batten");
        assert!(
            !larger.contains(LineId(1)) && !larger.contains(LineId(3)),
            "hips of the back"
        );
        assert!(larger.plane.angle_to(&plane) < 0.01);
    }
}
