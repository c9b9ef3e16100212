//! What a border between two cells costs, by the planes on its two sides.
//!
//! A border costs so many nats a metre where nothing supports it; reconstructed lines and
//! intersections of planes make it cheap, so that outlines follow them (tau_real of B99 4.3 and the
//! new lines of 4.2).
//! Costs are computed on demand, from the heights of both planes at the border: a
//! list of all pairs would grow with the square of the planes.

use nalgebra::{Point2, Vector2};

use super::arrangement::{Arrangement, CellEdge};
use super::line_index::LineIndex;
use crate::base::evidence::ON_LINE;
use crate::base::geometry::Plane;
use crate::base::labelling::{NO_PLANE, PairwiseCosts};
use crate::base::math::{larger, smaller};
use crate::base::params::RoofParams;
use crate::planes::grouping::propagated::LEAST_SLOPE_SINE;

/// The costs of all borders of an arrangement.
pub(crate) struct BorderCosts {
    /// In the order of [`Arrangement::edges`].
    borders: Vec<CellBorder>,
    /// By label.
    planes: Vec<Plane>,
}

impl BorderCosts {
    /// Prepares the borders; `index` holds the reconstructed lines, `ends_of_roofs` says what else
    /// speaks for the end of a roof between two positions, nats.
    pub(crate) fn new(
        arrangement: &Arrangement,
        planes: &[Plane],
        index: &LineIndex,
        ends_of_roofs: impl Fn(&Point2<f64>, &Point2<f64>) -> f64,
        params: &RoofParams,
    ) -> Self {
        let border = |e: &CellEdge| {
            let ends = [e.a, e.b].map(|v| arrangement.vertices[v]);
            CellBorder {
                full: (ends[1] - ends[0]).norm() * params.border_nats_per_m,
                registered: ends_of_roofs(&ends[0], &ends[1]),
                heights: index.heights_along(&ends[0], &ends[1]),
                ends,
            }
        };
        Self {
            borders: arrangement.edges.iter().map(border).collect(),
            planes: planes.to_vec(),
        }
    }

    /// Share of the full cost of a border between the labels to its left and right.
    fn share(&self, border: &CellBorder, left: u32, right: u32) -> f64 {
        let plane = |label: u32| self.planes.get(label as usize);
        border.share(plane(left), plane(right))
    }
}

impl PairwiseCosts for BorderCosts {
    fn cost(&self, edge: usize, left: u32, right: u32) -> f64 {
        let border = &self.borders[edge];
        let cost = self.share(border, left, right) * border.full;
        let ends = (left == NO_PLANE) != (right == NO_PLANE);
        match ends {
            true => larger(
                cost - border.registered,
                smaller(cost, ON_LINE * border.full),
            ),
            false => cost,
        }
    }

    fn reorder(&mut self, order: &[usize]) {
        let in_order = order.iter().map(|&edge| self.borders[edge].clone());
        self.borders = in_order.collect();
    }

    fn upper_bound(&self, edge: usize) -> f64 {
        self.borders[edge].full
    }
}

/// A border between two cells.
#[derive(Clone)]
struct CellBorder {
    /// Cost when nothing supports the border, nats.
    full: f64,
    /// What a register says for the end of a roof, nats.
    registered: f64,
    /// Plan positions, metres.
    ends: [Point2<f64>; 2],
    /// Heights of the reconstructed lines along it, metres.
    heights: Vec<f64>,
}

impl CellBorder {
    /// Share of its full cost between two planes.
    fn share(&self, left: Option<&Plane>, right: Option<&Plane>) -> f64 {
        let sides = [(left, right, -1.0), (right, left, 1.0)];
        let mut supports = [1.0; 2];
        for (support, (plane, beyond, side)) in supports.iter_mut().zip(sides) {
            if let Some(plane) = plane.filter(|p| self.bounds(p)) {
                let open_top = self.open_top(plane, beyond, &(self.to_left() * side));
                *support = ON_LINE + (1.0 - ON_LINE) * open_top;
            }
        }
        let crease = match (left, right) {
            (Some(a), Some(b)) if self.is_crease(a, b) => CREASE,
            _ => 1.0,
        };
        supports.into_iter().fold(crease, smaller)
    }

    /// Does a reconstructed line run along the border at a height?
    fn has_line_at(&self, z: f64) -> bool {
        self.heights.iter().any(|h| is_line_height(*h, z))
    }

    /// Does a reconstructed line in the plane run along the border?
    fn bounds(&self, plane: &Plane) -> bool {
        !self.heights.is_empty() && self.has_line_at(mean_height(plane, &self.ends))
    }
}

impl CellBorder {
    /// The unit vector across it, to its left.
    fn to_left(&self) -> Vector2<f64> {
        let along = (self.ends[1] - self.ends[0]).normalize();
        Vector2::new(-along.y, along.x)
    }

    /// Do two planes meet here at an angle?
    fn is_crease(&self, a: &Plane, b: &Plane) -> bool {
        let apart = (self.ends).map(|p| (a.z_at(p.x, p.y) - b.z_at(p.x, p.y)).abs());
        apart.iter().all(|apart| *apart < MEETING_HEIGHT_M) && !are_one_plane(a, b)
    }

    /// How much of the border is the top of a slope that ends in the air, 0 to 1.
    fn open_top(&self, plane: &Plane, beyond: Option<&Plane>, outwards: &Vector2<f64>) -> f64 {
        let height = |plane: &Plane| mean_height(plane, &self.ends);
        match beyond.is_some_and(|other| height(other) > height(plane) - MEETING_HEIGHT_M) {
            true => 0.0,
            false => open_top(plane, outwards),
        }
    }
}

/// How much of a border is the top of a slope, 0 to 1: a line there is a ridge, and a ridge has a
/// second slope (prior of roofs).
pub(super) fn open_top(plane: &Plane, outwards: &Vector2<f64>) -> f64 {
    let uphill = -plane.normal.xy();
    match uphill.norm() {
        slope if slope > LEAST_SLOPE_SINE => larger(outwards.dot(&uphill) / slope, 0.0),
        _ => 0.0,
    }
}

/// Are two planes that meet one plane that was found twice, and their border no crease?
pub(super) fn are_one_plane(a: &Plane, b: &Plane) -> bool {
    a.normal.dot(&b.normal) >= SAME_PLANE_COSINE
}

/// Of the two ends of a border.
fn mean_height(plane: &Plane, ends: &[Point2<f64>; 2]) -> f64 {
    let heights = ends.map(|p| plane.z_at(p.x, p.y));
    0.5 * (heights[0] + heights[1])
}

/// Does a line at a height lie in a plane that is at z there?
fn is_line_height(height: f64, z: f64) -> bool {
    (height - z).abs() < LINE_HEIGHT
}

/// Planes at less than 6 degrees that meet are one plane found twice: the cosine of that angle.
const SAME_PLANE_COSINE: f64 = 0.994_521_895_368_273_3;
/// Share of the cost of a border where two planes meet without a line. Measured: 0.1 breaks roofs
/// into more pieces.
pub(super) const CREASE: f64 = 0.3;
/// Planes meet when their heights differ by less, metres.
pub(super) const MEETING_HEIGHT_M: f64 = 0.25;
/// A line lies in a plane's border when their heights differ by less, metres.
pub(crate) const LINE_HEIGHT: f64 = 0.35;

/// Share of the full cost of a border between two positions.
#[cfg(test)]
pub(super) fn share(
    index: &LineIndex,
    ends: [Point2<f64>; 2],
    left: Option<&Plane>,
    right: Option<&Plane>,
) -> f64 {
    let border = CellBorder {
        full: 1.0,
        registered: 0.0,
        heights: index.heights_along(&ends[0], &ends[1]),
        ends,
    };
    border.share(left, right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    /// A border of 2 m along y at x = 0, the planes with the given normals through a point of it,
    /// and at `lift` above it.
    fn costs(normals: [[f64; 3]; 2], lift: f64, line: bool) -> BorderCosts {
        let ends = [Point2::new(0.0, 0.0), Point2::new(0.0, 2.0)];
        let planes = [0.0, lift].into_iter().zip(normals).map(|(z, n)| {
            Plane::from_point_normal(&Point3::new(0.0, 0.0, 5.0 + z), &Vector3::from(n)).unwrap()
        });
        let heights = if line { vec![5.0] } else { Vec::new() };
        let border = CellBorder {
            full: 2.0,
            registered: 0.0,
            ends,
            heights,
        };
        BorderCosts {
            borders: vec![border],
            planes: planes.collect(),
        }
    }

    #[test]
    fn borders_where_planes_meet_and_on_lines_are_cheap() {
        let gable = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
        let flat = [[0.0, 0.0, 1.0]; 2];
        let cost = |normals, lift, line| costs(normals, lift, line).cost(0, 0, 1);
        assert_eq!(cost(gable, 0.0, true), 2.0 * ON_LINE, "crease on a line");
        assert_eq!(cost(gable, 0.0, false), 2.0 * CREASE, "crease");
        assert_eq!(cost(flat, 3.0, true), 2.0 * ON_LINE, "eave");
        assert_eq!(cost(flat, 3.0, false), 2.0, "a step that no line shows");
        assert_eq!(cost(flat, 0.1, false), 2.0, "one plane found twice");
    }

    #[test]
    fn where_a_roof_ends_a_line_in_its_plane_makes_the_border_cheap() {
        let costs = costs([[0.0, 0.0, 1.0]; 2], 3.0, true);
        assert_eq!(costs.cost(0, 0, NO_PLANE), 2.0 * ON_LINE);
        assert_eq!(costs.cost(0, NO_PLANE, 0), 2.0 * ON_LINE);
        assert_eq!(costs.cost(0, 1, NO_PLANE), 2.0);
    }

    #[test]
    fn a_line_at_the_top_of_a_slope_is_no_end_of_the_roof() {
        // The first plane rises to the east, the second one to the west; to the left is west.
        let gable = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
        let ridge = costs(gable, 0.0, true);
        assert_eq!(
            ridge.cost(0, 0, 1),
            2.0 * ON_LINE,
            "it has its second slope"
        );
        assert_eq!(ridge.cost(0, 0, NO_PLANE), 2.0, "it ends in the air");
        assert_eq!(ridge.cost(0, NO_PLANE, 1), 2.0);
        assert_eq!(ridge.cost(0, NO_PLANE, 0), 2.0 * ON_LINE, "an eave");
        let below_a_wall = costs(gable, 3.0, true);
        assert_eq!(below_a_wall.cost(0, 0, 1), 2.0 * ON_LINE);
    }
}
