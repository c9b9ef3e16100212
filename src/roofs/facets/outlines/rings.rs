//! The outlines of all facets, and the chains of sides that two of them share.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Point2;

use crate::base::geometry;
use crate::roofs::facets::delineation::Delineation;

/// A ring of a facet, which lies to the left of it.
pub(super) struct Ring {
    pub facet: usize,
    /// Indices of vertices.
    pub vertices: Vec<usize>,
}

/// The rings of facets, each facet's outer one first, and their vertices.
pub(super) struct Rings {
    /// Plan positions, metres.
    pub vertices: Vec<Point2<f64>>,
    pub rings: Vec<Ring>,
}

/// For every vertex those that a side joins it with.
pub(super) type Links = BTreeMap<usize, BTreeSet<usize>>;

/// Where a chain begins in a ring.
#[derive(Clone, Copy)]
struct Place {
    ring: usize,
    index: usize,
}

/// A stretch of a ring with the same facet, or none, to the right of all of it. One that is the
/// whole ring goes around twice, so that stretches may cross its first vertex.
pub(super) struct Chain {
    pub vertices: Vec<usize>,
    pub left: usize,
    pub right: Option<usize>,
    in_left: Place,
    /// The facet to the right has the chain backwards.
    in_right: Option<Place>,
    is_closed: bool,
}

/// All that the simpler ways along a chain depend on, but for who covers the plan.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ChainPlace {
    vertices: Vec<usize>,
    facets: (usize, Option<usize>),
    is_closed: bool,
    /// The vertices before and after it, in the rings on both sides.
    around: Vec<[usize; 2]>,
    /// The vertices that sides join its ends with.
    joined: [BTreeSet<usize>; 2],
}

/// Most vertices that one move takes away.
const MOST_REMOVED: usize = 12;

impl Chain {
    /// The facets beside it.
    pub(super) fn facets(&self) -> impl Iterator<Item = usize> {
        std::iter::once(self.left).chain(self.right)
    }

    /// Where it lies.
    pub(super) fn place(&self, rings: &Rings, links: &Links) -> ChainPlace {
        let last = self.vertices.len() - 1;
        ChainPlace {
            vertices: self.vertices.clone(),
            facets: (self.left, self.right),
            is_closed: self.is_closed,
            around: rings.vertices_around(self, [0, last]),
            joined: [0, last].map(|i| links[&self.vertices[i]].clone()),
        }
    }

    /// The stretches of two sides and more, by their first and last vertex. Of a chain that is a
    /// whole ring three vertices stay.
    pub(super) fn stretches(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let n = self.vertices.len();
        // A ring that meets others in one vertex begins and ends there.
        let is_loop = self.vertices.first() == self.vertices.last();
        let (starts, most) = match (self.is_closed, is_loop) {
            (true, _) => (n / 2, MOST_REMOVED.min((n / 2).saturating_sub(3))),
            (false, true) => (n, MOST_REMOVED.min(n.saturating_sub(4))),
            (false, false) => (n, MOST_REMOVED),
        };
        (0..starts).flat_map(move |i| (i + 2..n.min(i + most + 2)).map(move |j| [i, j]))
    }

    /// The positions along a stretch.
    pub(super) fn way(&self, rings: &Rings, [from, to]: [usize; 2]) -> Vec<Point2<f64>> {
        let at = |&v: &usize| rings.vertices[v];
        self.vertices[from..=to].iter().map(at).collect()
    }
}

impl Rings {
    /// The rings of the outlines that are `accepted`.
    pub(super) fn new(delineation: &Delineation, accepted: &[bool]) -> Self {
        let outlines = delineation.outlines.iter().enumerate();
        let rings = outlines
            .filter(|(i, _)| accepted[*i])
            .flat_map(|(facet, o)| {
                let rings = std::iter::once(&o.outer).chain(&o.holes).cloned();
                rings.map(move |vertices| Ring { facet, vertices })
            });
        Self {
            rings: rings.collect(),
            vertices: delineation.vertices.clone(),
        }
    }

    /// The outer ring and the holes of a facet; `None` of one that has no rings here.
    pub(super) fn of(&self, facet: usize) -> Option<(Vec<usize>, Vec<Vec<usize>>)> {
        let of_facet = self.rings.iter().filter(|r| r.facet == facet);
        let mut rings = of_facet.map(|r| r.vertices.clone());
        Some((rings.next()?, rings.collect()))
    }

    /// For every vertex those that a side joins it with.
    pub(super) fn links(&self) -> Links {
        let mut links = Links::new();
        for (_, [a, b]) in self.sides() {
            links.entry(a).or_default().insert(b);
            links.entry(b).or_default().insert(a);
        }
        links
    }

    /// All sides, with their place.
    fn sides(&self) -> impl Iterator<Item = (Place, [usize; 2])> + '_ {
        self.rings.iter().enumerate().flat_map(|(ring, r)| {
            let sides = geometry::sides(&r.vertices).enumerate();
            sides.map(move |(index, side)| (Place { ring, index }, side))
        })
    }

    /// The chains that all rings are made of, each once, but for slits.
    pub(super) fn chains(&self) -> Vec<Chain> {
        let place: BTreeMap<[usize; 2], Place> = self.sides().map(|(p, side)| (side, p)).collect();
        let links = self.links();
        let mut chains = Vec::new();
        for (index, ring) in self.rings.iter().enumerate() {
            let n = ring.vertices.len();
            let vertex = |i: usize| ring.vertices[i % n];
            let beyond = |i: usize| place.get(&[vertex(i + 1), vertex(i)]).copied();
            let ring_beyond = |i: usize| beyond(i).map(|p| p.ring);
            let is_end = |i: &usize| {
                links[&vertex(*i)].len() != 2 || ring_beyond(*i) != ring_beyond(i + n - 1)
            };
            let ends: Vec<usize> = (0..n).filter(is_end).collect();
            let stretches: Vec<[usize; 2]> = match ends.first() {
                None => vec![[0, 2 * n - 1]],
                Some(first) => {
                    let next = ends.iter().skip(1).copied().chain([first + n]);
                    ends.iter().zip(next).map(|(&s, e)| [s, e]).collect()
                }
            };
            for [start, end] in stretches {
                // The first vertex is the end of its side in the ring beyond.
                let in_right = beyond(start).map(|p| Place {
                    index: p.index + 1,
                    ..p
                });
                // Each once; a slit, with one ring on both sides, stays as it is.
                if in_right.is_some_and(|p| p.ring <= index) {
                    continue;
                }
                chains.push(Chain {
                    vertices: (start..=end).map(vertex).collect(),
                    left: ring.facet,
                    right: in_right.map(|p| self.rings[p.ring].facet),
                    in_left: Place {
                        ring: index,
                        index: start,
                    },
                    in_right,
                    is_closed: ends.is_empty(),
                });
            }
        }
        chains
    }

    /// For the facet on either side the positions before and after a stretch, along the chain.
    pub(super) fn around(&self, chain: &Chain, stretch: [usize; 2]) -> Vec<[Point2<f64>; 2]> {
        let vertices = self.vertices_around(chain, stretch).into_iter();
        vertices
            .map(|pair| pair.map(|v| self.vertices[v]))
            .collect()
    }

    /// The vertices there.
    fn vertices_around(&self, chain: &Chain, [from, to]: [usize; 2]) -> Vec<[usize; 2]> {
        let at = |p: Place, forward: usize, backward: usize| {
            let ring = &self.rings[p.ring].vertices;
            // Rings are gone around at most twice.
            let index = p.index + forward + 3 * ring.len() - backward;
            ring[index % ring.len()]
        };
        let left = [at(chain.in_left, from, 1), at(chain.in_left, to + 1, 0)];
        let right = |p: Place| [at(p, 1, from), at(p, 0, to + 1)];
        std::iter::once(left)
            .chain(chain.in_right.map(right))
            .collect()
    }

    /// Puts other vertices between the ends of a stretch, in the rings on both sides.
    pub(super) fn replace(&mut self, chain: &Chain, stretch: [usize; 2], new: &[Point2<f64>]) {
        let [from, to] = stretch;
        let first = self.vertices.len();
        self.vertices.extend(new);
        let mut way = vec![chain.vertices[from]];
        way.extend(first..self.vertices.len());
        way.push(chain.vertices[to]);
        let removed = to - from + 1;
        let left = &mut self.rings[chain.in_left.ring].vertices;
        let n = left.len();
        left.rotate_left((chain.in_left.index + from) % n);
        left.splice(..removed, way.iter().copied());
        if let Some(p) = chain.in_right {
            let right = &mut self.rings[p.ring].vertices;
            let n = right.len();
            right.rotate_left((p.index + 3 * n - to) % n);
            right.splice(..removed, way.into_iter().rev());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::facets::delineation::Outline;

    #[test]
    fn of_a_ring_that_meets_another_in_one_vertex_three_vertices_stay() {
        let at = |[x, y]: [f64; 2]| Point2::new(x, y);
        let places = [[0.0, 0.0], [9.0, 0.0], [9.0, 6.0], [0.0, 6.0]];
        let beyond = [[12.0, 6.0], [14.0, 8.0], [12.0, 9.0], [9.0, 8.0]];
        let outline = |plane: u32, outer: Vec<usize>| Outline {
            plane,
            outer,
            holes: Vec::new(),
            cells: Vec::new(),
        };
        let found = Delineation {
            vertices: places.into_iter().chain(beyond).map(at).collect(),
            outlines: vec![
                outline(0, vec![0, 1, 2, 3]),
                outline(1, vec![2, 4, 5, 6, 7]),
            ],
        };
        let chains = Rings::new(&found, &[true, true]).chains();
        assert_eq!(chains.len(), 2);
        for chain in chains {
            let around = Rings::new(&found, &[true, true]);
            let ring = around.rings[chain.in_left.ring].vertices.len();
            assert_eq!(chain.vertices.len(), ring + 1);
            let left = |[from, to]: [usize; 2]| ring - (to - from - 1);
            assert_eq!(chain.stretches().map(left).min(), Some(3));
            let mut rings = around;
            let last = chain.stretches().last().expect("there is one");
            rings.replace(&chain, last, &[]);
        }
    }
}
