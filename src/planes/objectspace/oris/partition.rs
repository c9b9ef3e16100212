//! A partition of the image into regions with straight, shared boundaries, and its two changes.
//!
//! The boundaries are a planar graph: nodes on lattice points, vectors between them, each with the
//! region on either side. A node with two vectors is a break point, one with more a junction. Every
//! vector belongs to both of its regions, so that neighbours can neither overlap nor part.

use std::collections::BTreeMap;

use super::integrals::{Lattice, RegionMoments, RowSums};
use super::occupied::Occupied;

/// Beyond the border of the image.
pub(crate) const OUTSIDE_REGION: u32 = 0;

/// A vector of a boundary.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    /// Nodes at its start and end.
    pub nodes: [u32; 2],
    /// Regions to the left and to the right of its direction as seen on the screen.
    pub sides: [u32; 2],
    pub alive: bool,
}

/// A break point or junction with the vectors that end there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub at: Lattice,
    edges: [u32; 4],
    degree: u8,
}

impl Node {
    /// Without vectors.
    pub(super) fn new(at: Lattice) -> Self {
        Self {
            at,
            edges: [0; 4],
            degree: 0,
        }
    }

    /// The vectors that end here.
    pub(super) fn edges(&self) -> &[u32] {
        &self.edges[..usize::from(self.degree)]
    }

    pub(crate) fn add(&mut self, edge: u32) {
        self.edges[usize::from(self.degree)] = edge;
        self.degree += 1;
    }

    fn remove(&mut self, edge: u32) {
        let k = self.edges().iter().position(|&e| e == edge);
        let k = k.expect("a vector is listed at its nodes");
        self.degree -= 1;
        self.edges[k] = self.edges[usize::from(self.degree)];
    }

    fn replace(&mut self, old: u32, new: u32) {
        let k = self.edges().iter().position(|&e| e == old);
        self.edges[k.expect("a vector is listed at its nodes")] = new;
    }
}

/// A region while the partition changes.
#[derive(Clone, Debug, Default)]
pub(crate) struct PartitionRegion {
    pub moments: RegionMoments,
    pub alive: bool,
    /// Number of vectors shared with each neighbour.
    pub shared: BTreeMap<u32, u32>,
    /// Vectors that were beside this region at some time.
    pub(super) edges: Vec<u32>,
}

/// What dropping a break point would do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Straightening {
    /// The regions to the left and to the right of the path a - node - c.
    pub sides: [u32; 2],
    /// The pixels that would go from the right region to the left one.
    pub moved: RegionMoments,
    /// How far the boundary moves, pixels.
    pub height_px: f64,
    /// Is one of the two vectors as short as a pixel?
    pub step: bool,
}

/// The partition.
pub(crate) struct ImagePartition {
    pub nodes: Vec<Node>,
    pub edges: Vec<Edge>,
    pub regions: Vec<PartitionRegion>,
    pub(super) sums: RowSums,
    pub(crate) occupied: Occupied,
}

impl ImagePartition {
    /// The two vectors and the outer nodes at a break point; `None` for a junction or where nothing
    /// is left.
    fn ends(&self, node: u32) -> Option<([u32; 2], [u32; 2])> {
        let &[e, f] = self.nodes[node as usize].edges() else {
            return None;
        };
        let far = |e: u32| {
            let [a, b] = self.edges[e as usize].nodes;
            if a == node { b } else { a }
        };
        Some(([e, f], [far(e), far(f)]))
    }

    /// What dropping this break point would do; `None` where the boundary would then touch or cross
    /// another, or where the border of the image would move.
    pub(super) fn straightening(&self, node: u32) -> Option<Straightening> {
        let ([e, _], [a, c]) = self.ends(node)?;
        if a == c || self.joined(a, c) {
            return None;
        }
        let edge = &self.edges[e as usize];
        // The path runs a - node - c.
        let sides = if edge.nodes[1] == node {
            edge.sides
        } else {
            [edge.sides[1], edge.sides[0]]
        };
        let [pa, pb, pc] = [a, node, c].map(|n| self.nodes[n as usize].at);
        let cross = i64::from(pb.x - pa.x) * i64::from(pc.y - pa.y)
            - i64::from(pb.y - pa.y) * i64::from(pc.x - pa.x);
        if cross != 0 && (sides.contains(&OUTSIDE_REGION) || self.occupied.within([pa, pb, pc])) {
            return None;
        }
        let moved = self.sums.side(pa, pb) + self.sums.side(pb, pc) - self.sums.side(pa, pc);
        let (dx, dy) = (f64::from(pc.x - pa.x), f64::from(pc.y - pa.y));
        let height_px = cross.abs() as f64 / (dx * dx + dy * dy).sqrt();
        let short = |p: Lattice, q: Lattice| (p.x - q.x).abs() + (p.y - q.y).abs() <= 1;
        Some(Straightening {
            sides,
            moved,
            height_px,
            step: short(pa, pb) || short(pb, pc),
        })
    }

    fn joined(&self, a: u32, c: u32) -> bool {
        let ends = |e: &u32| self.edges[*e as usize].nodes;
        self.nodes[a as usize]
            .edges()
            .iter()
            .any(|e| ends(e).contains(&c))
    }

    /// Drops a break point; returns the two nodes that are joined now.
    pub(super) fn drop_node(&mut self, node: u32, what: &Straightening) -> [u32; 2] {
        let ([e, f], [a, c]) = self.ends(node).expect("only break points are dropped");
        let at = self.nodes[node as usize].at;
        self.occupied.set(at, false);
        self.nodes[node as usize].degree = 0;
        self.edges[e as usize].nodes = [a, c];
        self.edges[e as usize].sides = what.sides;
        self.edges[f as usize].alive = false;
        self.nodes[c as usize].replace(f, e);
        let [left, right] = what.sides;
        self.unshare(left, right);
        let l = &mut self.regions[left as usize];
        l.moments = l.moments + what.moved;
        let r = &mut self.regions[right as usize];
        r.moments = r.moments - what.moved;
        [a, c]
    }

    /// The nodes at the far ends of the vectors of a node.
    pub(super) fn around(&self, node: u32) -> impl Iterator<Item = u32> {
        self.nodes[node as usize].edges().iter().map(move |&e| {
            let [a, b] = self.edges[e as usize].nodes;
            if a == node { b } else { a }
        })
    }

    /// Is this a lattice point of the image?
    pub(super) fn covers(&self, at: Lattice) -> bool {
        self.occupied.covers(at)
    }

    /// May a node go to a place in the image without leaving the border of the image, and without
    /// its vectors passing over another node? (Whether it meets another vector on its way is for
    /// [`super::edge_grid`] to say.)
    pub(super) fn may_move(&self, node: u32, to: Lattice) -> bool {
        let at = self.nodes[node as usize].at;
        if self.occupied.get(to) {
            return false;
        }
        self.nodes[node as usize].edges().iter().all(|&e| {
            let edge = &self.edges[e as usize];
            let far = edge.nodes[usize::from(edge.nodes[0] == node)];
            let far = self.nodes[far as usize].at;
            let turn = i64::from(to.x - at.x) * i64::from(far.y - at.y)
                - i64::from(to.y - at.y) * i64::from(far.x - at.x);
            (turn == 0 || !edge.sides.contains(&OUTSIDE_REGION))
                && !self.occupied.within([at, to, far])
        })
    }

    /// The pixels that each region would win if a node went to a place.
    pub(super) fn shift(&self, node: u32, to: Lattice) -> Vec<(u32, RegionMoments)> {
        let at = self.nodes[node as usize].at;
        let mut won: Vec<(u32, RegionMoments)> = Vec::with_capacity(4);
        for &e in self.nodes[node as usize].edges() {
            let Edge { nodes, sides, .. } = self.edges[e as usize];
            let starts = nodes[0] == node;
            let far = self.nodes[nodes[usize::from(starts)] as usize].at;
            // What the right side wins; a vector towards the node counts the other way round.
            let term = self.sums.side(to, far) - self.sums.side(at, far);
            let term = if starts { term } else { -term };
            for (region, term) in [(sides[1], term), (sides[0], -term)] {
                match won.iter_mut().find(|w| w.0 == region) {
                    Some(w) => w.1 = w.1 + term,
                    None => won.push((region, term)),
                }
            }
        }
        won
    }

    /// Moves a node; `won` is its [`Self::shift`].
    pub(super) fn move_node(&mut self, node: u32, to: Lattice, won: &[(u32, RegionMoments)]) {
        let at = std::mem::replace(&mut self.nodes[node as usize].at, to);
        self.occupied.set(at, false);
        self.occupied.set(to, true);
        for (region, term) in won {
            let moments = &mut self.regions[*region as usize].moments;
            *moments = *moments + *term;
        }
    }

    fn unshare(&mut self, a: u32, b: u32) {
        for (own, other) in [(a, b), (b, a)] {
            let shared = &mut self.regions[own as usize].shared;
            if let Some(n) = shared.get_mut(&other) {
                *n -= 1;
                if *n == 0 {
                    shared.remove(&other);
                }
            }
        }
    }

    /// Merges two neighbours by taking away all vectors between them. Returns the region that
    /// stays, the neighbours whose boundary with it has grown, and the nodes that lost vectors.
    pub(super) fn merge(&mut self, i: u32, j: u32) -> (u32, Vec<u32>, Vec<u32>) {
        let len = |r: u32| (self.regions[r as usize].edges.len(), u32::MAX - r);
        let (keep, gone) = if len(i) >= len(j) { (i, j) } else { (j, i) };
        let old = std::mem::take(&mut self.regions[gone as usize]);
        let mut touched = Vec::new();
        for &e in &old.edges {
            let edge = &mut self.edges[e as usize];
            if !edge.alive || !edge.sides.contains(&gone) {
                continue;
            }
            if edge.sides.contains(&keep) {
                edge.alive = false;
                for n in edge.nodes {
                    self.nodes[n as usize].remove(e);
                    touched.push(n);
                }
            } else {
                let side = usize::from(edge.sides[1] == gone);
                edge.sides[side] = keep;
                self.regions[keep as usize].edges.push(e);
            }
        }
        let kept = &mut self.regions[keep as usize];
        kept.moments = kept.moments + old.moments;
        kept.shared.remove(&gone);
        let mut neighbours = Vec::new();
        for (&other, &n) in old.shared.iter().filter(|(o, _)| **o != keep) {
            *self.regions[keep as usize].shared.entry(other).or_default() += n;
            let back = &mut self.regions[other as usize].shared;
            back.remove(&gone);
            *back.entry(keep).or_default() += n;
            neighbours.push(other);
        }
        self.forget_free_nodes(&touched);
        (keep, neighbours, touched)
    }

    fn forget_free_nodes(&mut self, touched: &[u32]) {
        for &n in touched {
            if self.nodes[n as usize].edges().is_empty() {
                self.occupied.set(self.nodes[n as usize].at, false);
            }
        }
    }
}
