//! Which lines are neighbours: a Delaunay triangulation constrained to the projected lines (B99 4.3).
//!
//! "In grouping operations, thresholds on distances are avoided by using a topological neighbourhood
//! between projected lines, defined by a Delaunay triangulation constrained to fit the line segments."
//! The lines are projected onto the XY plane, which every view shares.

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use crate::ids::LineId;
use crate::lines3d::Line3d;
use crate::sorting::sort_by;

/// For each line its neighbours in ascending order, itself left out.
pub fn line_neighbours(lines: &[Line3d]) -> Vec<Vec<LineId>> {
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    // Which lines run through each vertex of the triangulation.
    let mut owners: Vec<Vec<LineId>> = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let ends = [line.segment.p0, line.segment.p1].map(|p| cdt.insert(Point2::new(p.x, p.y)));
        let [Ok(from), Ok(to)] = ends else { continue };
        if from == to {
            continue;
        }
        let edges = cdt.add_constraint_and_split(from, to, |p| p);
        owners.resize(cdt.num_vertices(), Vec::new());
        for edge in edges {
            for vertex in cdt.directed_edge(edge).vertices() {
                owners[vertex.fix().index()].push(LineId::from_index(i));
            }
        }
    }
    owners.resize(cdt.num_vertices(), Vec::new());

    let mut neighbours = vec![Vec::new(); lines.len()];
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
    for shared in &owners {
        link(shared, shared);
    }
    for list in &mut neighbours {
        sort_by(list, Ord::cmp);
        list.dedup();
    }
    neighbours
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Segment3;
    use nalgebra::{Matrix3, Point3};

    fn line(a: [f64; 2], b: [f64; 2]) -> Line3d {
        Line3d {
            origin: Default::default(),
            segment: Segment3::new(Point3::new(a[0], a[1], 0.0), Point3::new(b[0], b[1], 0.0)),
            sigma_m: 0.05,
            covariance: [Matrix3::identity() * 0.0025; 2],
            supports: Vec::new(),
        }
    }

    #[test]
    fn a_line_in_between_separates() {
        let lines = [
            line([0.0, 0.0], [10.0, 0.0]),
            line([-20.0, 2.0], [30.0, 2.0]),
            line([0.0, 4.0], [10.0, 4.0]),
        ];
        let n = line_neighbours(&lines);
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
        let n = line_neighbours(&lines);
        assert!(n[0].contains(&LineId(1)) && n[1].contains(&LineId(0)));
        assert!(n[0].contains(&LineId(2)));
    }
}
