//! The partition of a label image: boundaries along the cracks between pixels of different labels.

use super::integrals::{Lattice, RowSums};
use super::occupied::Occupied;
use super::partition::{Edge, ImagePartition, Node, OUTSIDE_REGION, PartitionRegion};

impl ImagePartition {
    /// The partition of a label image: vectors along the cracks between pixels of different labels.
    pub(super) fn from_labels(
        labels: &[u32],
        count: usize,
        width: usize,
        height: usize,
        sums: RowSums,
    ) -> Self {
        let mut p = Self {
            nodes: Vec::new(),
            edges: Vec::new(),
            regions: vec![PartitionRegion::default(); count + 1],
            sums,
            occupied: Occupied::new(width + 1, height + 1),
        };
        p.trace_cracks(&Cracks {
            labels,
            width,
            height,
        });
        for e in 0..p.edges.len() {
            let Edge { nodes, sides, .. } = p.edges[e];
            let term = p
                .sums
                .side(p.nodes[nodes[0] as usize].at, p.nodes[nodes[1] as usize].at);
            for (k, own) in sides.into_iter().enumerate() {
                let region = &mut p.regions[own as usize];
                region.moments = if k == 1 {
                    region.moments + term
                } else {
                    region.moments - term
                };
                region.edges.push(e as u32);
                *region.shared.entry(sides[1 - k]).or_default() += 1;
            }
        }
        p.regions.iter_mut().skip(1).for_each(|r| r.alive = true);
        p
    }

    /// Adds nodes and vectors along all cracks.
    fn trace_cracks(&mut self, cracks: &Cracks) {
        let (w, h) = (cracks.width, cracks.height);
        let mut ids = vec![u32::MAX; (w + 1) * (h + 1)];
        for y in 0..=h {
            for x in 0..=w {
                if cracks.is_node(x, y) {
                    ids[y * (w + 1) + x] = self.nodes.len() as u32;
                    let at = Lattice {
                        x: x as i32,
                        y: y as i32,
                    };
                    self.occupied.set(at, true);
                    self.nodes.push(Node::new(at));
                }
            }
        }
        for y in 0..=h {
            let mut start = ids[y * (w + 1)];
            for x in 1..=w {
                let end = ids[y * (w + 1) + x];
                if end != u32::MAX {
                    let (above, below) = (cracks.label(x, y), cracks.label(x, y + 1));
                    self.add_edge([start, end], [above, below]);
                    start = end;
                }
            }
        }
        for x in 0..=w {
            let mut start = ids[x];
            for y in 1..=h {
                let end = ids[y * (w + 1) + x];
                if end != u32::MAX {
                    let (left, right) = (cracks.label(x, y), cracks.label(x + 1, y));
                    // A vector that runs down has the pixels of larger x to its left.
                    self.add_edge([start, end], [right, left]);
                    start = end;
                }
            }
        }
    }

    /// Adds a vector unless there is no crack.
    fn add_edge(&mut self, nodes: [u32; 2], sides: [u32; 2]) {
        if sides[0] == sides[1] {
            return;
        }
        let id = self.edges.len() as u32;
        self.edges.push(Edge {
            nodes,
            sides,
            alive: true,
        });
        nodes
            .into_iter()
            .for_each(|n| self.nodes[n as usize].add(id));
    }
}

/// The cracks between the pixels of a label image.
struct Cracks<'a> {
    labels: &'a [u32],
    width: usize,
    height: usize,
}

impl Cracks<'_> {
    /// The region of a pixel, counted from 1, with columns and rows counted from 1;
    /// [`OUTSIDE_REGION`] beyond the border.
    fn label(&self, column: usize, row: usize) -> u32 {
        let inside = (1..=self.width).contains(&column) && (1..=self.height).contains(&row);
        if inside {
            self.labels[(row - 1) * self.width + column - 1] + 1
        } else {
            OUTSIDE_REGION
        }
    }

    /// Do the cracks at this lattice point do anything but run straight on?
    fn is_node(&self, x: usize, y: usize) -> bool {
        let a = [self.label(x, y), self.label(x + 1, y)];
        let b = [self.label(x, y + 1), self.label(x + 1, y + 1)];
        let straight = (a == b) || (a[0] == a[1] && b[0] == b[1]);
        !straight
    }
}
