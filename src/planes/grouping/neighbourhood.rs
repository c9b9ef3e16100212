//! Which lines are neighbours: a Delaunay triangulation constrained to the projected lines (B99
//! 4.3).
//!
//! "In grouping operations, thresholds on distances are avoided by using a topological
//! neighbourhood between projected lines, defined by a Delaunay triangulation constrained to fit
//! the line segments." The lines are projected onto the XY plane, which every view shares.
//!
//! Where several lines end at one corner, their ends differ by their uncertainty, and it is chance
//! which of them the triangulation joins to the lines across. Such neighbours around a corner are
//! kept apart.

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use crate::base::ids::LineId;
use crate::lines::lines3d::Line3d;

/// For each line its neighbours in ascending order, itself left out.
#[derive(Clone, Debug, Default)]
pub struct LineNeighbours {
    /// Those that the triangulation joins.
    pub direct: Vec<Vec<LineId>>,
    /// Those that it would join if its vertex at a corner belonged to every line that ends there.
    pub around_corners: Vec<Vec<LineId>>,
}

/// The topological neighbourhood of lines in plan.
pub(crate) fn line_neighbours(lines: &[Line3d]) -> LineNeighbours {
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    // Which lines run through each vertex of the triangulation.
    let mut owners: Vec<Vec<LineId>> = Vec::new();
    let mut ends_at: Vec<LineEnd> = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let ends = [line.segment.p0, line.segment.p1].map(|p| cdt.insert(Point2::new(p.x, p.y)));
        let [Ok(from), Ok(to)] = ends else { continue };
        if from == to {
            continue;
        }
        let length = (line.segment.p1 - line.segment.p0).xy().norm();
        ends_at.extend([from, to].map(|vertex| LineEnd {
            line: LineId::from_index(i),
            vertex: vertex.index(),
            length,
        }));
        let edges = cdt.add_constraint_and_split(from, to, |p| p);
        owners.resize(cdt.num_vertices(), Vec::new());
        for edge in edges {
            for vertex in cdt.directed_edge(edge).vertices() {
                owners[vertex.fix().index()].push(LineId::from_index(i));
            }
        }
    }
    owners.resize(cdt.num_vertices(), Vec::new());
    let neighbours = joined(&cdt, &owners, lines.len());
    let positions: Vec<Point2<f64>> = cdt.vertices().map(|v| v.position()).collect();
    for (vertex, line) in lines_at_shared_corners(&ends_at, &positions) {
        owners[vertex].push(line);
    }
    let mut around_corners = joined(&cdt, &owners, lines.len());
    for (around, direct) in around_corners.iter_mut().zip(&neighbours) {
        around.retain(|l| direct.binary_search(l).is_err());
    }
    LineNeighbours {
        direct: neighbours,
        around_corners,
    }
}

/// Lines whose vertices an edge of the triangulation joins, or that share one: for each line,
/// ascending, itself left out.
fn joined(
    cdt: &ConstrainedDelaunayTriangulation<Point2<f64>>,
    owners: &[Vec<LineId>],
    lines: usize,
) -> Vec<Vec<LineId>> {
    let mut neighbours = vec![Vec::new(); lines];
    let mut link = |a: &[LineId], b: &[LineId]| {
        for &i in a {
            for &j in b {
                if i != j {
                    neighbours[i.index()].push(j);
                    neighbours[j.index()].push(i);
                }
            }
        }
    };
    for edge in cdt.undirected_edges() {
        let [a, b] = edge.vertices().map(|v| v.fix().index());
        link(&owners[a], &owners[b]);
    }
    for shared in owners {
        link(shared, shared);
    }
    for list in &mut neighbours {
        list.sort();
        list.dedup();
    }
    neighbours
}

/// Where a line ends.
struct LineEnd {
    line: LineId,
    vertex: usize,
    /// Of the line in plan, metres.
    length: f64,
}

/// Lines that end so near to a vertex at which another ends that the two are one corner. Which of
/// them the triangulation joins to what lies around the corner is left to chance by the uncertainty
/// of ends.
fn lines_at_shared_corners(ends: &[LineEnd], positions: &[Point2<f64>]) -> Vec<(usize, LineId)> {
    let mut order: Vec<usize> = (0..ends.len()).collect();
    let x = |i: usize| positions[ends[i].vertex].x;
    order.sort_by(|&a, &b| x(a).total_cmp(&x(b)).then(a.cmp(&b)));
    let longest = ends.iter().map(|e| e.length).fold(0.0, f64::max);
    let mut found = Vec::new();
    for (k, &i) in order.iter().enumerate() {
        let (a, p) = (&ends[i], positions[ends[i].vertex]);
        let following = order[k + 1..].iter();
        for &j in following.take_while(|&&j| x(j) - p.x <= CORNER_SHARE * longest) {
            let (b, q) = (&ends[j], positions[ends[j].vertex]);
            let reach = CORNER_SHARE * a.length.min(b.length);
            let apart2 = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
            if a.vertex != b.vertex && apart2 <= reach * reach {
                found.extend([(a.vertex, b.line), (b.vertex, a.line)]);
            }
        }
    }
    found
}

/// Ends within this share of the shorter line are one corner. Assumption: ends are known to a tenth
/// of the length.
const CORNER_SHARE: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::Segment3;
    use nalgebra::{Matrix3, Point3};

    fn line(a: [f64; 2], b: [f64; 2]) -> Line3d {
        Line3d {
            origin: Default::default(),
            segment: Segment3::new(Point3::new(a[0], a[1], 0.0), Point3::new(b[0], b[1], 0.0)),
            sigma_m: 0.05,
            covariance: [Matrix3::identity() * 0.0025; 2],
            probability: 1.0,
            supports: Vec::new(),
            contradiction: None,
        }
    }

    #[test]
    fn a_line_in_between_separates() {
        let lines = [
            line([0.0, 0.0], [10.0, 0.0]),
            line([-20.0, 2.0], [30.0, 2.0]),
            line([0.0, 4.0], [10.0, 4.0]),
        ];
        let n = line_neighbours(&lines).direct;
        assert_eq!(n[0], [LineId(1)]);
        assert_eq!(n[1], [LineId(0), LineId(2)]);
        assert_eq!(n[2], [LineId(1)]);
    }

    #[test]
    fn crossing_and_touching_lines_are_neighbours() {
        let lines = [
            line([0.0, 0.0], [10.0, 0.0]),
            line([5.0, -5.0], [5.0, 5.0]),
            line([10.0, 0.0], [10.0, 9.0]),
        ];
        let n = line_neighbours(&lines).direct;
        assert!(n[0].contains(&LineId(1)) && n[1].contains(&LineId(0)));
        assert!(n[0].contains(&LineId(2)));
    }

    #[test]
    fn two_hips_are_neighbours_though_others_end_at_their_corners() {
        // A hipped roof without its ridge. Hip 3 is a little too long and comes between the upper
        // ends of 0 and 2; a line on the ground comes between the lower ones.
        let lines = [
            line([0.0, 0.0], [4.0, 3.9]),
            line([0.0, 8.0], [4.0, 4.0]),
            line([14.0, 0.0], [10.1, 3.9]),
            line([14.0, 8.0], [9.8, 3.8]),
            line([7.0, -2.0], [7.0, 2.0]),
        ];
        let n = line_neighbours(&lines);
        assert!(!n.direct[0].contains(&LineId(2)));
        assert!(n.around_corners[0].contains(&LineId(2)));
        assert!(n.around_corners[2].contains(&LineId(0)));
        let both = |i: usize| n.direct[i].iter().any(|l| n.around_corners[i].contains(l));
        assert!(!(0..lines.len()).any(both));
    }
}
