//! The plan cut into cells by all border lines.
//!
//! Facets of one roof must share exact edges and vertices, may be concave, and must not overlap.
//! All three follow when every facet is a union of cells of one common subdivision of the plan: the
//! border lines cut each other, nearly coinciding crossings become one vertex (so that ridge, hips
//! and valleys meet in a point), a constrained Delaunay triangulation fills the gaps, and triangles
//! that no border separates make a cell.

use nalgebra::{Point2, Vector2};
use spade::{ConstrainedDelaunayTriangulation, Triangulation};

use super::border::Border;
use crate::base::geometry::{sides, span};
use crate::base::plan_index::PlanIndex;
use crate::planes::photoconsistency::PlanGrid;

/// A border between two cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CellEdge {
    /// The cell to the left of `a` -> `b`.
    pub left: usize,
    /// The cell to the right.
    pub right: usize,
    /// Index of the start vertex.
    pub a: usize,
    /// Index of the end vertex.
    pub b: usize,
}

/// Cells, vertices and edges of the subdivision.
#[derive(Clone, Debug, Default)]
pub(crate) struct Arrangement {
    /// Plan positions, metres.
    pub vertices: Vec<Point2<f64>>,
    /// Triangles as counter-clockwise vertex indices, with the cell that each belongs to.
    pub triangles: Vec<([usize; 3], usize)>,
    /// Number of cells.
    pub cells: usize,
    /// Plan area of each cell, square metres.
    pub areas: Vec<f64>,
    /// Borders between different cells.
    pub edges: Vec<CellEdge>,
    /// Does the cell touch the outside?
    pub open: Vec<bool>,
}

/// Of the same vertices as everywhere in this crate, so that it is compiled once.
type PlanTriangulation = ConstrainedDelaunayTriangulation<spade::Point2<f64>>;

/// Crossings nearer than this become one vertex, metres.
const SNAP_DISTANCE_M: f64 = 0.06;

impl Arrangement {
    /// Cuts the plan by the borders.
    pub(crate) fn new(borders: &[Border]) -> Self {
        let (points, edges) = split_at_crossings(borders);
        let mut cdt = PlanTriangulation::new();
        let handles: Vec<_> = (points.iter())
            .map(|p| cdt.insert(spade::Point2::new(p.x, p.y)))
            .collect();
        for (a, b) in edges {
            if let (Ok(a), Ok(b)) = (handles[a], handles[b])
                && a != b
            {
                cdt.add_constraint_and_split(a, b, |p| p);
            }
        }
        Self::from_triangulation(&cdt)
    }

    fn from_triangulation(cdt: &PlanTriangulation) -> Self {
        let vertices: Vec<Point2<f64>> = (cdt.vertices().map(|v| v.position()))
            .map(|p| Point2::new(p.x, p.y))
            .collect();
        let faces: Vec<[usize; 3]> = cdt
            .inner_faces()
            .map(|f| f.vertices().map(|v| v.fix().index()))
            .collect();
        // Inner faces are numbered from 1; 0 is the outside.
        let number =
            |f: spade::handles::FaceHandle<'_, spade::handles::PossiblyOuterTag, _, _, _, _>| {
                f.as_inner().map(|f| f.fix().index() - 1)
            };
        let mut sets = DisjointSets::new(faces.len());
        for edge in cdt.undirected_edges().filter(|e| !e.is_constraint_edge()) {
            let e = edge.as_directed();
            if let (Some(f), Some(g)) = (number(e.face()), number(e.rev().face())) {
                sets.join(f, g);
            }
        }
        let mut cell_of_root = vec![usize::MAX; faces.len()];
        let mut triangles = Vec::with_capacity(faces.len());
        let mut areas = Vec::new();
        for (i, &corners) in faces.iter().enumerate() {
            let root = sets.find(i);
            if cell_of_root[root] == usize::MAX {
                cell_of_root[root] = areas.len();
                areas.push(0.0);
            }
            let cell = cell_of_root[root];
            let [a, b, c] = corners.map(|v| vertices[v]);
            areas[cell] += 0.5 * (b - a).perp(&(c - a)).abs();
            triangles.push((corners, cell));
        }
        let mut open = vec![false; areas.len()];
        for edge in cdt.undirected_edges() {
            let e = edge.as_directed();
            match (number(e.face()), number(e.rev().face())) {
                (Some(f), None) | (None, Some(f)) => open[triangles[f].1] = true,
                _ => {}
            }
        }
        let edges = cdt
            .undirected_edges()
            .filter_map(|edge| {
                let e = edge.as_directed();
                let (f, g) = (number(e.face())?, number(e.rev().face())?);
                let (left, right) = (triangles[f].1, triangles[g].1);
                (left != right).then(|| CellEdge {
                    left,
                    right,
                    a: e.from().fix().index(),
                    b: e.to().fix().index(),
                })
            })
            .collect();
        Self {
            vertices,
            triangles,
            cells: areas.len(),
            areas,
            edges,
            open,
        }
    }

    /// For each cell the lowest of the connected cells that have its label.
    pub(crate) fn components(&self, labels: &[u32]) -> Vec<usize> {
        let mut sets = DisjointSets::new(self.cells);
        for e in &self.edges {
            if labels[e.left] == labels[e.right] {
                sets.join(e.left, e.right);
            }
        }
        (0..self.cells).map(|c| sets.find(c)).collect()
    }

    /// The cell under the centre of each grid cell; `u32::MAX` outside all triangles.
    pub(crate) fn raster(&self, grid: &PlanGrid) -> Vec<u32> {
        let mut out = vec![u32::MAX; grid.width * grid.height];
        for &(corners, cell) in &self.triangles {
            let t = corners.map(|v| self.vertices[v]);
            let min_y = t.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
            let max_y = t.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
            let row = |y: f64| (y - grid.origin.y) / grid.step - 0.5;
            let (r0, r1) = (row(min_y).ceil().max(0.0) as usize, row(max_y).floor());
            if r1 < 0.0 {
                continue;
            }
            for r in r0..=(r1 as usize).min(grid.height - 1) {
                let y = grid.center(0, r).y;
                let Some([x0, x1]) = span(sides(&t), y) else {
                    continue;
                };
                let column = |x: f64| (x - grid.origin.x) / grid.step - 0.5;
                // A centre on the common side of two triangles must not fall between them by
                // rounding.
                const SLACK: f64 = 1e-6;
                let c0 = (column(x0) - SLACK).ceil().max(0.0);
                let c1 = (column(x1) + SLACK).floor().min(grid.width as f64 - 1.0);
                if c1 >= c0 {
                    out[r * grid.width + c0 as usize..=r * grid.width + c1 as usize]
                        .fill(cell as u32);
                }
            }
        }
        out
    }
}

/// Vertices of the arrangement, snapped, and the pieces between them.
fn split_at_crossings(borders: &[Border]) -> (Vec<Point2<f64>>, Vec<(usize, usize)>) {
    let mut places: Vec<Point2<f64>> = borders.iter().flat_map(|b| [b.a, b.b]).collect();
    let index = PlanIndex::new(borders.iter().map(|b| [b.a, b.b]));
    let crossings = crate::base::execution::map(borders, |i, p| -> Vec<Point2<f64>> {
        let near = index
            .touching([p.a, p.b], SNAP_DISTANCE_M)
            .map(|j| j as usize);
        let mut later: Vec<usize> = near.filter(|j| *j > i).collect();
        later.sort();
        let crossings = later.into_iter().filter_map(|j| crossing(p, &borders[j]));
        crossings.collect()
    });
    places.extend(crossings.into_iter().flatten());
    let vertices = SnappedVertices::new(&places);
    let on_borders = crate::base::execution::map(borders, |_, border| vertices.along(border));
    let pieces = on_borders.iter().flat_map(|on| on.windows(2));
    let mut pieces: Vec<(usize, usize)> = pieces
        .map(|piece| (piece[0].min(piece[1]), piece[0].max(piece[1])))
        .collect();
    pieces.sort();
    pieces.dedup();
    (vertices.points, pieces)
}

/// Where two borders cross (ends included, with the snapping distance as slack).
fn crossing(p: &Border, q: &Border) -> Option<Point2<f64>> {
    let (d, e) = (p.b - p.a, q.b - q.a);
    let cross = d.perp(&e);
    // Lines at less than about 3 degrees have no useful crossing; the end points do.
    if cross.abs() < 0.05 * d.norm() * e.norm() {
        return None;
    }
    let r: Vector2<f64> = q.a - p.a;
    let (s, t) = (r.perp(&e) / cross, r.perp(&d) / cross);
    let (es, et) = (SNAP_DISTANCE_M / d.norm(), SNAP_DISTANCE_M / e.norm());
    ((-es..=1.0 + es).contains(&s) && (-et..=1.0 + et).contains(&t)).then(|| p.a + d * s)
}

/// Vertices, none of them near another one.
struct SnappedVertices {
    points: Vec<Point2<f64>>,
    index: PlanIndex,
}

impl SnappedVertices {
    /// The vertices at some places: one that is near an earlier vertex is that vertex.
    fn new(places: &[Point2<f64>]) -> Self {
        let of_places = PlanIndex::new(places.iter().map(|p| [*p; 2]));
        let mut is_vertex = vec![false; places.len()];
        for (i, p) in places.iter().enumerate() {
            is_vertex[i] = !of_places.touching([*p; 2], SNAP_DISTANCE_M).any(|j| {
                let j = j as usize;
                j < i
                    && is_vertex[j]
                    && (places[j] - p).norm_squared() <= SNAP_DISTANCE_M * SNAP_DISTANCE_M
            });
        }
        let vertices = places.iter().zip(is_vertex);
        let points: Vec<Point2<f64>> = vertices.filter(|(_, is)| *is).map(|(p, _)| *p).collect();
        let index = PlanIndex::new(points.iter().map(|p| [*p; 2]));
        Self { points, index }
    }

    /// The vertices on a border, in order from a to b.
    fn along(&self, border: &Border) -> Vec<usize> {
        let d = border.b - border.a;
        let length = d.norm().max(1e-12);
        let d = d / length;
        let mut on: Vec<(f64, usize)> = self
            .index
            .touching([border.a, border.b], SNAP_DISTANCE_M)
            .filter_map(|v| {
                let v = v as usize;
                let r = self.points[v] - border.a;
                let t = r.dot(&d);
                (d.perp(&r).abs() <= SNAP_DISTANCE_M
                    && t >= -SNAP_DISTANCE_M
                    && t <= length + SNAP_DISTANCE_M)
                    .then_some((t, v))
            })
            .collect();
        on.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        on.into_iter().map(|(_, v)| v).collect()
    }
}

/// Union-find with path halving; the smaller index is the root.
struct DisjointSets {
    parent: Vec<usize>,
}

impl DisjointSets {
    /// `n` sets of one element.
    fn new(n: usize) -> Self {
        Self {
            parent: (0..n).collect(),
        }
    }

    /// The representative of the set of `i`.
    fn find(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// Makes the sets of `i` and `j` one.
    fn join(&mut self, i: usize, j: usize) {
        let (a, b) = (self.find(i), self.find(j));
        self.parent[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::super::border::BorderKind;
    use super::*;

    fn border(a: [f64; 2], b: [f64; 2]) -> Border {
        Border {
            kind: BorderKind::Real,
            a: a.into(),
            b: b.into(),
        }
    }

    #[test]
    fn a_cross_in_a_square_makes_four_cells() {
        let a = Arrangement::new(&[
            border([0.0, 0.0], [4.0, 0.0]),
            border([4.0, 0.0], [4.0, 4.0]),
            border([4.0, 4.0], [0.0, 4.0]),
            border([0.0, 4.0], [0.0, 0.0]),
            border([-1.0, 1.0], [5.0, 1.0]),
            // Three lines nearly through one point: one vertex.
            border([1.0, -1.0], [1.0, 5.0]),
            border([0.02, 0.0], [4.0, 3.98]),
        ]);
        let crossings = a
            .vertices
            .iter()
            .filter(|v| (*v - Point2::new(1.0, 1.0)).norm() < 0.1)
            .count();
        assert_eq!(crossings, 1);
        let inside: Vec<f64> = {
            let grid = PlanGrid {
                origin: Point2::origin(),
                step: 0.05,
                width: 80,
                height: 80,
            };
            let mut seen: Vec<u32> = a.raster(&grid);
            seen.sort();
            seen.dedup();
            seen.iter().map(|&c| a.areas[c as usize]).collect()
        };
        assert_eq!(inside.len(), 6);
        assert!((inside.iter().sum::<f64>() - 16.0).abs() < 0.2);
    }

    #[test]
    fn raster_agrees_with_areas() {
        let a = Arrangement::new(&[
            border([0.0, 0.0], [4.0, 0.5]),
            border([4.0, 0.5], [3.0, 4.0]),
            border([3.0, 4.0], [0.0, 0.0]),
            border([-3.0, 1.0], [5.0, 2.0]),
        ]);
        let grid = PlanGrid {
            origin: Point2::new(-4.0, -1.0),
            step: 0.02,
            width: 500,
            height: 300,
        };
        let mut counted = vec![0usize; a.cells];
        for c in a.raster(&grid) {
            if c != u32::MAX {
                counted[c as usize] += 1;
            }
        }
        for (cell, &n) in counted.iter().enumerate() {
            assert!(
                (n as f64 * 0.0004 - a.areas[cell]).abs() < 0.05,
                "cell {cell}"
            );
        }
    }
}
