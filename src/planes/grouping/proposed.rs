//! Planes that the other method proposes (W96 3.6), beside the groups of half-planes and lines.
//!
//! A rectangle in the plane of a group, over its place, joins it: the plane is then sought there too. Any other one is a group of
//! its own, with the lines that lie in it. Which plane covers what is settled by one labelling.
//!
//! Tried without gain: that the contrast at a rectangle's sides, which W96 counts in its measure, counts where there is no texture to
//! compare. Of a rendered suburb less of the roofs was then covered, not more: lawns and yards have sides with contrast, too.

use nalgebra::{Point2, Point3};
use serde::{Deserialize, Serialize};

use super::region::Region;
use super::{GroupingInput, Member, PlaneGroup, fit_plane, lies_in_plane, member};
use crate::geometry::{Plane, mean_point};
use crate::ids::LineId;
use crate::lines3d::Line3d;
use crate::lines3d::Side;
use crate::params::RoofParams;

/// A convex polygon in a plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProposedPlane {
    /// Its index where it comes from.
    pub index: u32,
    /// The plane.
    pub plane: Plane,
    /// Corners, metres, counter-clockwise seen from above.
    pub ring: Vec<Point3<f64>>,
}

impl ProposedPlane {
    /// The sides in plan, metres.
    pub fn sides(&self) -> impl Iterator<Item = [Point2<f64>; 2]> {
        let n = self.ring.len();
        (0..n).map(move |i| [self.ring[i].xy(), self.ring[(i + 1) % n].xy()])
    }

    /// Distance of a position from it in plan, metres; 0 inside.
    pub fn distance(&self, p: &Point2<f64>) -> f64 {
        let inside = |[a, b]: [Point2<f64>; 2]| (b - a).perp(&(p - a)) >= 0.0;
        if self.sides().all(inside) {
            return 0.0;
        }
        let from_side = |[a, b]: [Point2<f64>; 2]| {
            let d = b - a;
            let t = ((p - a).dot(&d) / d.norm_squared().max(1e-12)).clamp(0.0, 1.0);
            (p - (a + d * t)).norm()
        };
        self.sides().map(from_side).fold(f64::INFINITY, f64::min)
    }

    /// The middle of the corners.
    fn middle(&self) -> Point3<f64> {
        mean_point(&self.ring)
    }

    /// Do its corners lie in a plane, as well as the lines of one plane do?
    fn lies_in(&self, plane: &Plane, params: &RoofParams) -> bool {
        let far = 2.0 * params.coplanar_distance_m;
        plane.angle_to(&self.plane) < params.coplanar_angle_deg.to_radians()
            && self
                .ring
                .iter()
                .all(|p| plane.signed_distance(p).abs() <= far)
    }
}

/// Adds the rectangles to the groups, those in the plane of a group to it.
pub fn add_rectangles(input: &GroupingInput, groups: &mut Vec<PlaneGroup>, params: &RoofParams) {
    for rectangle in input.rectangles {
        let middle = rectangle.middle().xy();
        let same = groups.iter_mut().find(|g| {
            rectangle.lies_in(&g.plane, params) && Region::new(input, g, params).contains(&middle)
        });
        match same {
            Some(group) => group.rectangles.push(rectangle.index),
            None => groups.push(group_of(input, rectangle, params)),
        }
    }
}

/// A rectangle as a group, with the lines in its plane, to which the plane is fitted where they span one.
fn group_of(input: &GroupingInput, rectangle: &ProposedPlane, params: &RoofParams) -> PlaneGroup {
    let mut group = PlaneGroup {
        plane: rectangle.plane,
        members: Vec::new(),
        rectangles: vec![rectangle.index],
    };
    let region = Region::new(input, &group, params);
    let ids = (0..input.lines.len()).map(LineId::from_index);
    let members = ids.filter_map(|id| {
        let line = &input.lines[id.index()];
        let over = (0..5).filter(|i| region.contains(&line.at(f64::from(*i) / 4.0).xy()));
        let in_it = over.count() >= 3 && lies_in_plane(input, &group, id, params);
        in_it.then(|| Member {
            side: Some(side_of(line, &rectangle.middle().xy())),
            ..member(input, id, None)
        })
    });
    let members: Vec<Member> = members.collect();
    let fitted = fit_plane(input, &members).filter(|plane| rectangle.lies_in(plane, params));
    group.plane = fitted.unwrap_or(rectangle.plane);
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
    use crate::facets::RoofEvidence;
    use crate::facets::reconstruct_facets;
    use crate::model::Facet;
    use crate::planes::fixture::{Surface, scene};
    use crate::terrain::Ground;
    use crate::testing::line;
    use nalgebra::Vector3;

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
            index,
            plane: level(z),
            ring: corners.map(|(x, y)| Point3::new(x, y, z)).to_vec(),
        }
    }

    /// The facets of a flat roof of which one eave was matched, without a half-plane, with planes that are proposed for it.
    fn facets(rectangles: &[ProposedPlane]) -> Vec<Facet> {
        let on_roof = |x: f64, y: f64| x.abs() < 4.0 && y.abs() < 3.0;
        let textured = |plane, exists| Surface {
            plane,
            exists,
            texture: 0.3,
        };
        let scene = scene(&[
            textured(level(ROOF_Z), on_roof),
            textured(level(0.0), |_, _| true),
        ]);
        let eave = line(
            Point3::new(-4.0, -3.0, ROOF_Z),
            Point3::new(4.0, -3.0, ROOF_Z),
        );
        let evidence = RoofEvidence {
            segments: &[],
            lines: &[eave],
            half_planes: &[],
            ground: &Ground::level(0.0),
            rectangles,
        };
        reconstruct_facets(&scene, &evidence, &RoofParams::default()).0
    }

    #[test]
    fn a_rectangle_is_a_facet_where_half_planes_are_absent() {
        assert!(facets(&[]).is_empty());
        // The wrong ones come first, and lose.
        let proposed = [rectangle(7, 7.5), rectangle(8, 2.5), rectangle(9, ROOF_Z)];
        let found = facets(&proposed);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].rectangles, [9]);
        assert!((found[0].plane.z_at(0.0, 0.0) - ROOF_Z).abs() < 0.05);
        let covered = |p: &Point3<f64>| p.x.abs() < 4.5 && p.y.abs() < 3.5;
        assert!(found[0].outer.iter().all(covered), "{:?}", found[0].outer);
    }

    #[test]
    fn a_rectangle_in_the_plane_of_a_group_joins_it() {
        let lines =
            [-3.0, 3.0].map(|y| line(Point3::new(-4.0, y, ROOF_Z), Point3::new(4.0, y, ROOF_Z)));
        let rectangles = [rectangle(0, ROOF_Z + 0.1), rectangle(1, ROOF_Z + 1.0)];
        let neighbours = crate::planes::grouping::neighbourhood::line_neighbours(&lines);
        let input = GroupingInput {
            lines: &lines,
            half_planes: &[],
            neighbours: &neighbours,
            rectangles: &rectangles,
        };
        let params = RoofParams::default();
        let mut groups = crate::planes::grouping::group_planes(&input, &params);
        assert_eq!(groups.len(), 1, "the plane of both eaves");
        add_rectangles(&input, &mut groups, &params);
        let joined: Vec<&[u32]> = groups.iter().map(|g| &g.rectangles[..]).collect();
        assert_eq!(joined, [[0], [1]]);
        assert!((groups[0].plane.z_at(0.0, 0.0) - ROOF_Z).abs() < 1e-6);
        assert!(groups[1].members.is_empty(), "no line lies a metre higher");
    }
}
