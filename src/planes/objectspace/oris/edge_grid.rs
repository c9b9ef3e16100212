//! Which vectors pass near a lattice point.

use super::integrals::Lattice;
use super::partition::ImagePartition;

/// Side of a cell, pixels. Assumption: about the length of a vector.
const CELL_PX: i32 = 16;

/// The vectors of every cell that their bounding boxes touch. Vectors that moved on are listed
/// still: what counts is where they are now.
pub(crate) struct EdgeGrid {
    columns: i32,
    cells: Vec<Vec<u32>>,
}

impl EdgeGrid {
    /// All vectors of a partition.
    pub(super) fn new(p: &ImagePartition) -> Self {
        let far = |f: fn(&Lattice) -> i32| p.nodes.iter().map(|n| f(&n.at)).max().unwrap_or(0);
        let (columns, rows) = (far(|a| a.x) / CELL_PX + 1, far(|a| a.y) / CELL_PX + 1);
        let mut grid = Self {
            columns,
            cells: vec![Vec::new(); (columns * rows) as usize],
        };
        for e in 0..p.edges.len() as u32 {
            if p.edges[e as usize].alive {
                grid.add(p, e);
            }
        }
        grid
    }

    /// Lists the vectors at a node where they are now.
    pub(super) fn add_around(&mut self, p: &ImagePartition, node: u32) {
        for &e in p.nodes[node as usize].edges() {
            self.add(p, e);
        }
    }

    /// Would a node on its way meet a vector that does not end at it?
    pub(super) fn crossed(&self, p: &ImagePartition, node: u32, to: Lattice) -> bool {
        let from = p.nodes[node as usize].at;
        self.cells_of(from, to).any(|cell| {
            self.cells[cell].iter().any(|&e| {
                let edge = &p.edges[e as usize];
                let [a, b] = edge.nodes.map(|n| p.nodes[n as usize].at);
                edge.alive && !edge.nodes.contains(&node) && meet([from, to], [a, b])
            })
        })
    }

    fn add(&mut self, p: &ImagePartition, e: u32) {
        let [a, b] = p.edges[e as usize].nodes.map(|n| p.nodes[n as usize].at);
        for cell in self.cells_of(a, b) {
            if !self.cells[cell].contains(&e) {
                self.cells[cell].push(e);
            }
        }
    }

    fn cells_of(&self, a: Lattice, b: Lattice) -> impl Iterator<Item = usize> + use<> {
        let range = |p: i32, q: i32| (p.min(q) / CELL_PX)..=(p.max(q) / CELL_PX);
        let (columns, width) = (range(a.x, b.x), self.columns);
        range(a.y, b.y).flat_map(move |r| columns.clone().map(move |c| (r * width + c) as usize))
    }
}

/// Do two closed segments share a point?
fn meet(s: [Lattice; 2], t: [Lattice; 2]) -> bool {
    let boxes = |f: fn(&Lattice) -> i32| {
        let [a, b, c, d] = [f(&s[0]), f(&s[1]), f(&t[0]), f(&t[1])];
        a.min(b) <= c.max(d) && c.min(d) <= a.max(b)
    };
    let apart = |s: [Lattice; 2], t: [Lattice; 2]| {
        side(s[0], s[1], t[0]).signum() * side(s[0], s[1], t[1]).signum() > 0
    };
    boxes(|p| p.x) && boxes(|p| p.y) && !apart(s, t) && !apart(t, s)
}

/// On which side of a line through `a` and `b` a point lies, by sign; zero on it.
fn side(a: Lattice, b: Lattice, p: Lattice) -> i64 {
    i64::from(b.x - a.x) * i64::from(p.y - a.y) - i64::from(b.y - a.y) * i64::from(p.x - a.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_meet_where_they_cross_or_touch() {
        let p = |x, y| Lattice { x, y };
        let s = [p(0, 0), p(6, 3)];
        assert!(meet(s, [p(3, 0), p(3, 4)]));
        assert!(meet(s, [p(2, 1), p(9, 9)]));
        assert!(meet(s, [p(4, 2), p(8, 4)]));
        assert!(!meet(s, [p(3, 2), p(3, 9)]));
        assert!(!meet(s, [p(8, 4), p(10, 5)]));
    }
}
