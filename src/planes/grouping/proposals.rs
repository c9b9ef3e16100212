//! Planes of other sources beside the groups of half-planes and lines: rectangles (W96 3.6) and
//! planes of dense matching (B99 2).
//!
//! One in the plane of a group, over its place, joins it: the plane is then sought there too. Any
//! other one is a group of its own, with the lines that lie in it. Which plane covers what is
//! settled by one labelling.

use nalgebra::{Point2, Point3};

use super::coplanarity::{fit_plane, lies_in_plane};
use super::plane_group::{GroupingInput, Member, PlaneGroup, member};
use super::proposed_plane::ProposedPlane;
use super::region::PlanRegion;
use crate::base::ids::LineId;
use crate::base::params::RoofParams;
use crate::lines::lines3d::{Line3d, Side};

/// Adds the proposed planes to the groups, those in the plane of a group to it.
pub(crate) fn add_proposals(
    input: &GroupingInput,
    groups: &mut Vec<PlaneGroup>,
    params: &RoofParams,
) {
    let region = |group: &PlaneGroup| PlanRegion::new(input, group, params);
    let mut regions: Vec<PlanRegion> = groups.iter().map(region).collect();
    for proposed in input.proposals {
        let same = (groups.iter().zip(&regions))
            .position(|(group, region)| explains(group, region, proposed, params));
        match same {
            Some(k) => {
                groups[k].proposals.push(proposed.origin);
                regions[k] = region(&groups[k]);
            }
            None => {
                let group = group_of(input, proposed, params);
                regions.push(region(&group));
                groups.push(group);
            }
        }
    }
}

/// Does a group say as much as a proposed plane, over most of it?
fn explains(
    group: &PlaneGroup,
    region: &PlanRegion,
    proposed: &ProposedPlane,
    params: &RoofParams,
) -> bool {
    let places: Vec<Point3<f64>> = proposed.places().collect();
    let inside = (places.iter())
        .filter(|p| region.contains(&p.xy()) && proposed.is_near(&group.plane, p, params));
    proposed.is_parallel(&group.plane, params)
        && inside.count() as f64 >= MOST * places.len() as f64
}

/// Share of a proposed plane that a group must explain. Assumption: half, and some more.
const MOST: f64 = 0.6;

/// A proposed plane as a group, with the lines in its plane, to which the plane is fitted where
/// they span one.
fn group_of(input: &GroupingInput, proposed: &ProposedPlane, params: &RoofParams) -> PlaneGroup {
    let mut group = PlaneGroup {
        plane: proposed.plane,
        members: Vec::new(),
        proposals: vec![proposed.origin],
    };
    let region = PlanRegion::new(input, &group, params);
    let ids = (0..input.lines.len()).map(LineId::from_index);
    let members = ids.filter_map(|id| {
        let line = &input.lines[id.index()];
        let over = (0..5).filter(|i| region.contains(&line.at(f64::from(*i) / 4.0).xy()));
        let in_it = over.count() >= 3 && lies_in_plane(input, &group, id, params);
        in_it.then(|| Member {
            side: Some(side_of(line, &proposed.middle().xy())),
            ..member(input, id, None)
        })
    });
    let members: Vec<Member> = members.collect();
    let fitted = fit_plane(input, &members).filter(|plane| proposed.lies_in(plane, params));
    group.plane = fitted.unwrap_or(proposed.plane);
    group.members = members;
    group
}

/// The side of a line on which a position lies in plan.
fn side_of(line: &Line3d, p: &Point2<f64>) -> Side {
    let segment = &line.segment;
    let left = segment.direction().xy().perp(&(p - segment.p0.xy())) > 0.0;
    if left { Side::Left } else { Side::Right }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::Plane;
    use crate::base::ids::ProposalOrigin;
    use crate::roofs::testing::line;
    use nalgebra::{Point3, Vector3};

    const ROOF_Z: f64 = 5.0;

    fn level(z: f64) -> Plane {
        Plane {
            normal: Vector3::z(),
            d: -z,
        }
    }

    /// A rectangle of 8 m by 6 m around the origin, at a height.
    fn rectangle(index: u32, z: f64) -> ProposedPlane {
        let corners = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)];
        ProposedPlane {
            origin: ProposalOrigin::Rectangle(index),
            plane: level(z),
            ring: corners.map(|(x, y)| Point3::new(x, y, z)).to_vec(),
        }
    }

    #[test]
    fn a_rectangle_in_the_plane_of_a_group_joins_it() {
        let lines =
            [-3.0, 3.0].map(|y| line(Point3::new(-4.0, y, ROOF_Z), Point3::new(4.0, y, ROOF_Z)));
        let rectangles = [rectangle(0, ROOF_Z + 0.1), rectangle(1, ROOF_Z + 1.0)];
        let neighbours = super::super::line_neighbours(&lines);
        let input = GroupingInput {
            lines: &lines,
            half_planes: &[],
            neighbours: &neighbours,
            proposals: &rectangles,
        };
        let params = RoofParams::default();
        let mut groups = super::super::group_planes(&input, &params);
        assert_eq!(groups.len(), 1, "the plane of both eaves");
        add_proposals(&input, &mut groups, &params);
        let joined: Vec<&[ProposalOrigin]> = groups.iter().map(|g| &g.proposals[..]).collect();
        assert_eq!(
            joined,
            [[0], [1]].map(|of| of.map(ProposalOrigin::Rectangle))
        );
        assert!((groups[0].plane.z_at(0.0, 0.0) - ROOF_Z).abs() < 1e-6);
        assert!(groups[1].members.is_empty(), "no line lies a metre higher");
    }
}
