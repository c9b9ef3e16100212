//! What a border between two cells costs, by the planes on its two sides.
//!
//! The cost of an unsupported border is its length; reconstructed lines and intersections of planes make it
//! cheap, so that outlines follow them (tau_real of B99 4.3 and the new lines of 4.2). Costs are worked out
//! when they are asked for, from the heights of both planes at the border: a list of all pairs would grow with
//! the square of the planes.

use nalgebra::{Point2, Vector3};

use super::arrangement::{Arrangement, CellEdge};
use super::labelling::{Borders, NO_PLANE};
use super::line_index::LineIndex;
use crate::geometry::Plane;
use crate::params::RoofParams;

/// The costs of all borders of an arrangement.
pub struct BorderCosts {
    /// In the order of [`Arrangement::edges`].
    borders: Vec<Border>,
    /// Normals of the planes, by label.
    normals: Vec<Vector3<f64>>,
}

impl BorderCosts {
    /// Prepares the borders; `labels` are the planes that may cover a cell, ascending.
    pub fn new<L: Iterator<Item = u32>>(
        arrangement: &Arrangement,
        labels: impl Fn(usize) -> L,
        planes: &[Plane],
        index: &LineIndex,
        params: &RoofParams,
    ) -> Self {
        let border = |e: &CellEdge| {
            let ends = [e.a, e.b].map(|v| arrangement.vertices[v]);
            let heights = index.heights_along(&ends[0], &ends[1]);
            let beside = |cell| {
                labels(cell)
                    .map(|l| Beside::new(l, &planes[l as usize], &ends, &heights))
                    .collect()
            };
            Border {
                full: (ends[1] - ends[0]).norm() * params.border_cost_m,
                left: beside(e.left),
                right: beside(e.right),
            }
        };
        Self {
            borders: arrangement.edges.iter().map(border).collect(),
            normals: planes.iter().map(|p| p.normal).collect(),
        }
    }

    /// Share of the full cost between two planes.
    fn between(&self, a: &Beside, b: &Beside) -> f64 {
        let near = |a: f64, b: f64| (a - b).abs() < MEETING;
        let cosine = || self.normals[a.label as usize].dot(&self.normals[b.label as usize]);
        // Two hypotheses of one roof plane: a border between them says nothing.
        if near(a.middle(), b.middle()) && cosine() > SAME_PLANE_COSINE {
            return DUPLICATE;
        }
        let meets = near(a.ends[0], b.ends[0]) && near(a.ends[1], b.ends[1]);
        match (meets, a.on_line || b.on_line) {
            (true, true) => CREASE_ON_LINE,
            (true, false) => CREASE,
            (false, true) => ON_LINE,
            (false, false) => 1.0,
        }
    }
}

impl Borders for BorderCosts {
    fn cost(&self, edge: usize, left: u32, right: u32) -> f64 {
        let border = &self.borders[edge];
        let share = match (find(&border.left, left), find(&border.right, right)) {
            (Some(a), Some(b)) => self.between(a, b),
            (Some(one), None) if right == NO_PLANE && one.on_line => ON_LINE,
            (None, Some(one)) if left == NO_PLANE && one.on_line => ON_LINE,
            _ => 1.0,
        };
        share * border.full
    }

    fn most(&self, edge: usize) -> f64 {
        DUPLICATE * self.borders[edge].full
    }
}

/// The planes on both sides of a border between cells.
struct Border {
    /// Cost when nothing supports the border.
    full: f64,
    /// Ascending by label.
    left: Vec<Beside>,
    /// Ascending by label.
    right: Vec<Beside>,
}

fn find(side: &[Beside], label: u32) -> Option<&Beside> {
    let place = side.binary_search_by_key(&label, |b| b.label).ok()?;
    Some(&side[place])
}

/// A plane beside a border.
struct Beside {
    label: u32,
    /// Does a reconstructed line in the plane run along the border?
    on_line: bool,
    /// Heights at both ends of the border, metres.
    ends: [f64; 2],
}

impl Beside {
    /// `heights` are those of the real lines along the border.
    fn new(label: u32, plane: &Plane, ends: &[Point2<f64>; 2], heights: &[f64]) -> Self {
        let mut beside = Self {
            label,
            on_line: false,
            ends: ends.map(|p| plane.z_at(p.x, p.y)),
        };
        let middle = beside.middle();
        beside.on_line = heights.iter().any(|h| (h - middle).abs() < LINE_HEIGHT);
        beside
    }

    fn middle(&self) -> f64 {
        0.5 * (self.ends[0] + self.ends[1])
    }
}

/// Planes at less than 6 degrees that meet are one plane found twice: the cosine of that angle.
const SAME_PLANE_COSINE: f64 = 0.994_521_895_368_273_3;
/// Share of the full border cost between two hypotheses of one plane.
const DUPLICATE: f64 = 1.5;
/// Share of the full border cost where two planes meet along a reconstructed line, ...
const CREASE_ON_LINE: f64 = 0.1;
/// ... where two planes meet, ...
const CREASE: f64 = 0.3;
/// ... and where a reconstructed line of one of the planes bounds it.
const ON_LINE: f64 = 0.15;
/// Planes meet when their heights differ by less, metres.
const MEETING: f64 = 0.25;
/// A line lies in a plane's border when their heights differ by less, metres.
pub const LINE_HEIGHT: f64 = 0.35;

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    /// A border of 2 m along y at x = 0, the planes with the given normals through a point of it, and at `lift` above it.
    fn cost(normals: [[f64; 3]; 2], lift: f64, line: bool) -> f64 {
        let ends = [Point2::new(0.0, 0.0), Point2::new(0.0, 2.0)];
        let planes = [0.0, lift].into_iter().zip(normals).map(|(z, n)| {
            Plane::from_point_normal(&Point3::new(0.0, 0.0, 5.0 + z), &Vector3::from(n)).unwrap()
        });
        let planes: Vec<Plane> = planes.collect();
        let heights = if line { vec![5.0] } else { Vec::new() };
        let beside = |l: u32| vec![Beside::new(l, &planes[l as usize], &ends, &heights)];
        let costs = BorderCosts {
            borders: vec![Border {
                full: 2.0,
                left: beside(0),
                right: beside(1),
            }],
            normals: planes.iter().map(|p| p.normal).collect(),
        };
        costs.cost(0, 0, 1)
    }

    #[test]
    fn borders_where_planes_meet_and_on_lines_are_cheap() {
        let gable = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
        let flat = [[0.0, 0.0, 1.0]; 2];
        assert_eq!(cost(gable, 0.0, true), 2.0 * CREASE_ON_LINE);
        assert_eq!(cost(gable, 0.0, false), 2.0 * CREASE);
        assert_eq!(cost(flat, 3.0, true), 2.0 * ON_LINE);
        assert_eq!(cost(flat, 3.0, false), 2.0);
        // One plane found twice: dearer than no support at all.
        assert_eq!(cost(flat, 0.1, true), 2.0 * DUPLICATE);
    }
}
