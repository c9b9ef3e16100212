//! Where a plane may be: the part of the plan beside its lines, and between them (B99 4.3).

use nalgebra::{Point2, Vector2};
use serde::{Deserialize, Serialize};

use super::plane_group::{GroupingInput, PlaneGroup};
use super::proposed_plane::ProposedPlane;
use crate::base::geometry::{Plane, bounds, contains, convex_hull, sides, span};
use crate::base::math::{larger, smaller};
use crate::base::params::RoofParams;
use crate::lines::lines3d::Side;

/// How far a region reaches behind its line, metres: more than the line's own uncertainty.
pub(crate) const MARGIN: f64 = 0.5;
/// No coordinate in metres is rounded by more.
const ROUNDING: f64 = 1e-6;
/// Sine of the angle to the horizontal direction of a plane, in plan, below which a side is level
/// (5 degrees).
const LEVEL: f64 = 0.09;
/// Sine of the slope below which a plane has no such direction (5 degrees).
const NEARLY_LEVEL: f64 = 0.087;

/// The part of the plan that a group may cover: boxes beside its supporting lines, and their convex
/// hull, which is B99's delineation (4.3): two short rakes of a long roof have all of it between
/// them.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct PlanRegion {
    boxes: Vec<PlanBox>,
    hull: Vec<Point2<f64>>,
    /// Least and largest x and y of both, and a little more.
    around: [Point2<f64>; 2],
}

/// A rectangle beside a line: origin at the line's start, `along` its direction, `across` to the
/// left.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct PlanBox {
    start: Point2<f64>,
    along: Vector2<f64>,
    length: f64,
    left: f64,
    right: f64,
    ends: f64,
}

impl PlanBox {
    fn corners(&self) -> [Point2<f64>; 4] {
        let across = Vector2::new(-self.along.y, self.along.x);
        let far = self.length + self.ends;
        [
            (-self.ends, self.left),
            (-self.ends, -self.right),
            (far, self.left),
            (far, -self.right),
        ]
        .map(|(t, u)| self.start + self.along * t + across * u)
    }

    /// The part of a row of the plan in it.
    fn span_at(&self, y: f64) -> [f64; 2] {
        let (ax, ay) = (self.along.x, self.along.y);
        let (x0, dy) = (self.start.x, y - self.start.y);
        // t = ax (x - x0) + ay dy and u = ax dy - ay (x - x0), as linear functions of x.
        let (t, u) = (ay * dy - ax * x0, ax * dy + ay * x0);
        let sides = [
            (ax, t + self.ends),
            (-ax, self.length + self.ends - t),
            (ay, self.left - u),
            (-ay, u + self.right),
        ];
        (sides.iter()).fold(WHOLE_ROW, |span, (a, b)| clipped(span, *a, *b))
    }

    /// The box of a rectangle along its first side.
    fn around(rectangle: &ProposedPlane) -> Option<Self> {
        let [start, end] = rectangle.sides().next()?;
        let along = (end - start).try_normalize(1e-6)?;
        let across = Vector2::new(-along.y, along.x);
        let span = |axis: &Vector2<f64>| {
            let at = rectangle.ring.iter().map(|p| (p.xy() - start).dot(axis));
            at.fold((0.0f64, 0.0f64), |(low, high), t| (low.min(t), high.max(t)))
        };
        let ((t0, t1), (u0, u1)) = (span(&along), span(&across));
        Some(Self {
            start: start + along * t0,
            along,
            length: t1 - t0,
            left: u1 + MARGIN,
            right: MARGIN - u0,
            ends: MARGIN,
        })
    }
}

/// The parts of a row of the plan that a region holds.
pub(crate) struct RegionRow(Vec<[f64; 2]>);

impl RegionRow {
    /// Does it hold a position?
    pub(crate) fn contains(&self, x: f64) -> bool {
        self.0.iter().any(|[first, last]| *first <= x && x <= *last)
    }
}

/// All of a row.
const WHOLE_ROW: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// The part of `[first, last]` where `a x + b >= 0`; empty as `first > last`.
fn clipped([first, last]: [f64; 2], a: f64, b: f64) -> [f64; 2] {
    if a > 0.0 {
        [larger(first, -b / a), last]
    } else if a < 0.0 {
        [first, smaller(last, -b / a)]
    } else if b >= 0.0 {
        [first, last]
    } else {
        [f64::INFINITY, f64::NEG_INFINITY]
    }
}

impl PlanRegion {
    /// The region of a group: `depth` away from each supporting line on the side of its half-plane
    /// (both sides for a line without one), a little beyond on the other side and over the ends.
    pub(crate) fn new(input: &GroupingInput, group: &PlaneGroup, params: &RoofParams) -> Self {
        let boxes = group
            .members
            .iter()
            .filter_map(|m| {
                let line = &input.lines[m.line.index()].segment;
                let (a, b) = (line.p0.xy(), line.p1.xy());
                let length = (b - a).norm();
                if length < 1e-6 {
                    return None;
                }
                let depth = length.clamp(params.min_facet_depth_m, params.max_facet_depth_m);
                let (left, right) = match m.side {
                    Some(Side::Left) => (depth, MARGIN),
                    Some(Side::Right) => (MARGIN, depth),
                    // It lies in the plane, but which side of it the plane covers is unknown.
                    None => (MARGIN, MARGIN),
                };
                let ends = (0.5 * length).clamp(params.extension_m, params.min_facet_depth_m);
                Some(PlanBox {
                    start: a,
                    along: (b - a) / length,
                    length,
                    left,
                    right,
                    ends,
                })
            })
            .chain(group.proposed(input).filter_map(PlanBox::around))
            .collect();
        let lines = (group.members.iter()).map(|m| &input.lines[m.line.index()].segment);
        let ends = lines.flat_map(|l| [l.p0.xy(), l.p1.xy()]);
        Self::of(boxes, convex_hull(&ends.collect::<Vec<_>>()))
    }

    fn of(boxes: Vec<PlanBox>, hull: Vec<Point2<f64>>) -> Self {
        let corners = boxes.iter().flat_map(PlanBox::corners);
        let [low, high] = bounds(corners.chain(hull.iter().copied()));
        let rounding = Vector2::repeat(ROUNDING);
        Self {
            around: [low - rounding, high + rounding],
            boxes,
            hull,
        }
    }

    /// Does the region hold a plan position?
    pub(crate) fn contains(&self, p: &Point2<f64>) -> bool {
        let [low, high] = &self.around;
        if p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y {
            return false;
        }
        self.boxes.iter().any(|b| {
            let d = p - b.start;
            let (t, u) = (d.dot(&b.along), b.along.x * d.y - b.along.y * d.x);
            t >= -b.ends && t <= b.length + b.ends && u <= b.left && u >= -b.right
        }) || contains(sides(&self.hull), p)
    }

    /// What the region holds of the row of the plan at `y`, metres.
    pub(crate) fn row(&self, y: f64) -> RegionRow {
        let boxes = self.boxes.iter().map(|b| b.span_at(y));
        let spans = boxes.chain(span(sides(&self.hull), y));
        RegionRow(spans.filter(|[first, last]| first <= last).collect())
    }

    /// The sides of the convex hull of the group's lines that are level in its `plane`, as eaves
    /// and ridges are. A plane that is itself nearly level has none: there every side would be.
    pub(crate) fn level_sides(&self, plane: &Plane) -> Vec<[Point2<f64>; 2]> {
        let down = plane.normal.xy();
        if down.norm() < NEARLY_LEVEL {
            return Vec::new();
        }
        let is_level = |[a, b]: &[Point2<f64>; 2]| {
            (b - a).dot(&down).abs() < LEVEL * down.norm() * (b - a).norm()
        };
        sides(&self.hull).filter(is_level).collect()
    }

    /// Least and largest x and y, metres.
    pub(crate) fn bounds(&self) -> [Point2<f64>; 2] {
        bounds(self.boxes.iter().flat_map(PlanBox::corners))
    }
}

/// What a plane may cover to both sides of a line in it.
#[cfg(test)]
pub(crate) fn region_beside(line: crate::lines::lines3d::Line3d, plane: Plane) -> PlanRegion {
    let member = |side| super::plane_group::Member {
        line: crate::base::ids::LineId(0),
        side: Some(side),
        half_plane: None,
    };
    let group = PlaneGroup {
        plane,
        members: [Side::Left, Side::Right].map(member).to_vec(),
        proposals: Vec::new(),
    };
    let lines = [line];
    let input = GroupingInput {
        lines: &lines,
        half_planes: &[],
        neighbours: &super::neighbourhood::line_neighbours(&lines),
        proposals: &[],
    };
    PlanRegion::new(&input, &group, &RoofParams::default())
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::super::neighbourhood::line_neighbours;
    use super::super::plane_group::Member;
    use super::*;
    use crate::base::ids::LineId;
    use crate::roofs::testing::line;

    /// A shed roof that rises to the north.
    fn shed() -> Plane {
        let normal = nalgebra::Vector3::new(0.0, -0.25, 1.0);
        Plane::from_point_normal(&Point3::new(0.0, 0.0, 5.0), &normal).expect("a normal")
    }

    /// The region of its rakes, 4 m long and 20 m apart, each with the roof on its inner side.
    fn between_rakes() -> PlanRegion {
        let rake = |x: f64| line(Point3::new(x, 0.0, 5.0), Point3::new(x, 4.0, 6.0));
        let lines = [rake(0.0), rake(20.0)];
        let input = GroupingInput {
            lines: &lines,
            half_planes: &[],
            neighbours: &line_neighbours(&lines),
            proposals: &[],
        };
        let member = |index: u32, side| Member {
            line: LineId(index),
            half_plane: None,
            side: Some(side),
        };
        let group = PlaneGroup {
            plane: shed(),
            members: vec![member(0, Side::Right), member(1, Side::Left)],
            proposals: Vec::new(),
        };
        PlanRegion::new(&input, &group, &RoofParams::default())
    }

    #[test]
    fn a_plane_may_cover_all_that_lies_between_its_lines() {
        let region = between_rakes();
        for x in [0.5, 5.0, 10.0, 15.0, 19.5] {
            assert!(region.contains(&Point2::new(x, 2.0)), "at {x} m");
        }
    }

    #[test]
    fn the_hull_has_level_sides_between_the_rakes() {
        let region = between_rakes();
        let mut heights: Vec<[f64; 2]> = (region.level_sides(&shed()).iter())
            .map(|side| side.map(|p| p.y))
            .collect();
        heights.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(heights, [[0.0, 0.0], [4.0, 4.0]]);
        let flat = Plane {
            normal: nalgebra::Vector3::z(),
            d: -5.0,
        };
        assert!(region.level_sides(&flat).is_empty());
    }

    #[test]
    fn behind_its_lines_a_region_ends() {
        let region = between_rakes();
        for (x, y) in [(-1.0, 2.0), (21.0, 2.0), (10.0, -0.1), (10.0, 4.1)] {
            assert!(!region.contains(&Point2::new(x, y)), "at {x}, {y}");
        }
    }

    #[test]
    fn a_row_holds_what_the_region_holds() {
        let region = between_rakes();
        let boxes_alone = PlanRegion::of(region.boxes.clone(), Vec::new());
        for region in [region, boxes_alone] {
            let mut held = 0;
            for y in (-20..80).map(|i| 0.1 * f64::from(i) + 0.013) {
                let row = region.row(y);
                for x in (-30..250).map(|i| 0.1 * f64::from(i) + 0.017) {
                    let inside = region.contains(&Point2::new(x, y));
                    assert_eq!(row.contains(x), inside, "at {x}, {y}");
                    held += usize::from(inside);
                }
            }
            assert!(held > 500);
        }
    }

    #[test]
    fn lines_one_behind_the_other_have_nothing_between_them() {
        let on_a_line = [0.0, 1.0, 5.0, 9.0].map(|t| Point2::new(t, 2.0 * t));
        let hull = convex_hull(&on_a_line);
        for p in [
            Point2::new(3.0, 6.0),
            Point2::new(3.0, 6.5),
            Point2::new(3.0, 5.5),
        ] {
            assert!(!contains(sides(&hull), &p));
        }
    }
}
