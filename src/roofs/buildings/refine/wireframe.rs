//! The wireframe of one building: vertices in plan, facets as planes over them, and the sides to
//! measure.
//!
//! A facet is `z = a (x - ox) + b (y - oy) + c`, a vertex a position in plan. Heights follow from
//! the planes, so facets are planar whatever the numbers are, and a vertex that facets share stays
//! shared. What must hold besides is written down as [`Meet`] (facets of one height at a vertex:
//! ridge, hip and valley end there) and [`Straight`] (a vertex of one facet that lies inside a side
//! of another).

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DVector, Point2, Point3, Vector2};

use crate::base::geometry::{Plane, Segment3, sides};
use crate::roofs::model::Facet;

/// Heights that differ by less are one, metres: what welding leaves.
const SAME_HEIGHT_M: f64 = 0.02;
/// A vertex nearer to the line between its neighbours lies in a straight side, metres.
const STRAIGHT_M: f64 = 0.02;

/// What lies on the other side of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SideKind {
    /// Nothing: an eave, a gable, the outline of a flat roof.
    Free,
    /// A lower facet of the same building.
    Step,
    /// A higher facet of the same building: its side is what shows.
    Foot,
    /// A facet of the same height: ridge, hip, valley.
    Crease,
}

/// A straight side of a facet.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WireframeSide {
    /// What lies beyond.
    pub kind: SideKind,
    /// The facet on its left.
    pub face: usize,
    /// The facet on its right, for a crease.
    pub beyond: Option<usize>,
    /// First and last vertex.
    pub ends: [usize; 2],
}

/// Two facets that have one height at a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meet {
    /// The vertex.
    pub vertex: usize,
    /// The facets.
    pub faces: [usize; 2],
}

/// A vertex on the straight line between two others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Straight {
    /// The vertex.
    pub vertex: usize,
    /// Its neighbours in the ring.
    pub between: [usize; 2],
}

/// The wireframe of one building. Positions and planes are in a [`WireframeState`] of its own.
#[derive(Clone, Debug)]
pub(super) struct Wireframe {
    /// Where plane coefficients count from, plan, metres.
    pub origin: Point2<f64>,
    /// Number of vertices.
    pub vertices: usize,
    /// Per facet its rings, the outer one first, as vertices.
    pub faces: Vec<Vec<Vec<usize>>>,
    /// What to measure.
    pub sides: Vec<WireframeSide>,
    /// What must stay joined.
    pub meets: Vec<Meet>,
    /// What must stay straight.
    pub straights: Vec<Straight>,
}

/// Numbers of a wireframe: x, y of every vertex, then a, b, c of every facet.
pub(super) type WireframeState = DVector<f64>;

impl Wireframe {
    /// The wireframe of facets whose outlines share vertices, and its present state.
    pub(super) fn new(facets: &[&Facet]) -> (Self, WireframeState) {
        let mut index: BTreeMap<[u64; 2], usize> = BTreeMap::new();
        let mut positions: Vec<Point2<f64>> = Vec::new();
        let mut vertex = |p: &Point3<f64>| {
            *index
                .entry([p.x.to_bits(), p.y.to_bits()])
                .or_insert_with(|| {
                    positions.push(p.xy());
                    positions.len() - 1
                })
        };
        let faces: Vec<Vec<Vec<usize>>> = facets
            .iter()
            .map(|f| {
                (f.rings())
                    .map(|ring| ring.iter().map(&mut vertex).collect())
                    .collect()
            })
            .collect();
        let sum = positions.iter().fold(Vector2::zeros(), |s, p| s + p.coords);
        let mut wireframe = Self {
            origin: Point2::from(sum / positions.len().max(1) as f64),
            vertices: positions.len(),
            faces,
            sides: Vec::new(),
            meets: Vec::new(),
            straights: Vec::new(),
        };
        let mut state = WireframeState::zeros(wireframe.size());
        for (v, p) in positions.iter().enumerate() {
            (state[2 * v], state[2 * v + 1]) = (p.x, p.y);
        }
        for (f, facet) in facets.iter().enumerate() {
            let (n, at) = (&facet.plane.normal, wireframe.plane_at(f));
            (state[at], state[at + 1]) = (-n.x / n.z, -n.y / n.z);
            state[at + 2] = facet.plane.z_at(wireframe.origin.x, wireframe.origin.y);
        }
        wireframe.connect(&state);
        (wireframe, state)
    }

    /// The vertex at a corner of a facet, counted through its rings.
    pub(super) fn vertex(&self, face: usize, corner: usize) -> usize {
        let mut vertices = self.faces[face].iter().flatten();
        *vertices.nth(corner).expect("a corner of the facet")
    }

    /// Number of unknowns.
    pub(super) fn size(&self) -> usize {
        2 * self.vertices + 3 * self.faces.len()
    }

    /// Place of the first coefficient of a facet.
    pub(super) fn plane_at(&self, face: usize) -> usize {
        2 * self.vertices + 3 * face
    }

    /// Plan position of a vertex.
    pub(super) fn position(&self, state: &WireframeState, vertex: usize) -> Point2<f64> {
        Point2::new(state[2 * vertex], state[2 * vertex + 1])
    }

    /// Height of a facet at a plan position.
    pub(super) fn height(&self, state: &WireframeState, face: usize, p: &Point2<f64>) -> f64 {
        let (at, d) = (self.plane_at(face), p - self.origin);
        state[at] * d.x + state[at + 1] * d.y + state[at + 2]
    }

    /// A vertex on a facet.
    pub(super) fn corner(&self, state: &WireframeState, face: usize, vertex: usize) -> Point3<f64> {
        let p = self.position(state, vertex);
        Point3::new(p.x, p.y, self.height(state, face, &p))
    }

    /// A side in space.
    pub(super) fn segment(&self, state: &WireframeState, side: &WireframeSide) -> Segment3 {
        let [p0, p1] = side.ends.map(|v| self.corner(state, side.face, v));
        Segment3::new(p0, p1)
    }

    /// The ends of all sides of a facet, ring by ring, from corner to corner.
    pub(super) fn ring_sides(&self, face: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.faces[face].iter().flat_map(|ring| sides(ring))
    }

    /// Does a piece of an outline lie on a side?
    pub(super) fn covers(
        &self,
        state: &WireframeState,
        side: &WireframeSide,
        piece: [usize; 2],
    ) -> bool {
        let [from, to] = side.ends.map(|v| self.position(state, v));
        let Some(along) = (to - from).try_normalize(0.0) else {
            return false;
        };
        piece.into_iter().all(|v| {
            let d = self.position(state, v) - from;
            let at = d.dot(&along);
            let is_between = at >= -STRAIGHT_M && at <= (to - from).norm() + STRAIGHT_M;
            is_between && d.perp(&along).abs() <= STRAIGHT_M
        })
    }

    /// Is a piece of a facet's outline a ridge, hip or valley?
    pub(super) fn is_crease(&self, face: usize, piece: [usize; 2]) -> bool {
        let meets = |v: usize, of: usize| {
            let faces = [face.min(of), face.max(of)];
            (self.meets.iter()).any(|m| m.vertex == v && m.faces == faces)
        };
        let others = (0..self.faces.len()).filter(|&other| other != face);
        let mut others =
            others.filter(|&other| self.ring_sides(other).any(|[u, v]| [v, u] == piece));
        others.any(|other| piece.into_iter().all(|v| meets(v, other)))
    }

    /// The unknowns that a side depends on.
    pub(super) fn unknowns(&self, side: &WireframeSide) -> Vec<usize> {
        let [u, v] = side.ends;
        let plane = self.plane_at(side.face);
        vec![
            2 * u,
            2 * u + 1,
            2 * v,
            2 * v + 1,
            plane,
            plane + 1,
            plane + 2,
        ]
    }

    /// The plane of a facet.
    pub(super) fn plane(&self, state: &WireframeState, face: usize) -> Plane {
        let at = self.plane_at(face);
        let normal = nalgebra::Vector3::new(-state[at], -state[at + 1], 1.0);
        let through = Point3::new(self.origin.x, self.origin.y, state[at + 2]);
        Plane::from_point_normal(&through, &normal).expect("z of the normal is 1")
    }

    /// The facets in another state.
    pub(super) fn facets(&self, state: &WireframeState, facets: &[&Facet]) -> Vec<Facet> {
        let changed = |(face, facet): (usize, &&Facet)| {
            let plane = self.plane(state, face);
            let lift = |ring: &Vec<usize>| -> Vec<Point3<f64>> {
                let corner = |&v: &usize| self.position(state, v);
                ring.iter()
                    .map(corner)
                    .map(|p| plane.lift(p.x, p.y))
                    .collect()
            };
            Facet {
                plane,
                outer: lift(&self.faces[face][0]),
                holes: self.faces[face][1..].iter().map(lift).collect(),
                ..(*facet).clone()
            }
        };
        facets.iter().enumerate().map(changed).collect()
    }

    /// Finds sides, meets and straights.
    fn connect(&mut self, state: &WireframeState) {
        let left_of = self.left_of();
        let mut straights = BTreeSet::new();
        let mut meets = BTreeSet::new();
        let mut sides = Vec::new();
        for (face, rings) in self.faces.iter().enumerate() {
            for ring in rings {
                let n = ring.len();
                let kind = |i: usize| self.kind(state, &left_of, face, ring[i], ring[(i + 1) % n]);
                let kinds: Vec<Option<(SideKind, Option<usize>)>> = (0..n).map(kind).collect();
                let straight = |i: usize| {
                    let (before, after) = (ring[(i + n - 1) % n], ring[(i + 1) % n]);
                    self.is_straight(state, before, ring[i], after)
                        .then_some(Straight {
                            vertex: ring[i],
                            between: [before.min(after), before.max(after)],
                        })
                };
                let bends: Vec<bool> = (0..n).map(|i| straight(i).is_none()).collect();
                straights.extend((0..n).filter_map(straight));
                let starts: Vec<usize> = (0..n)
                    .filter(|&i| bends[i] || kinds[(i + n - 1) % n] != kinds[i])
                    .collect();
                for (k, &start) in starts.iter().enumerate() {
                    let Some((kind, beyond)) = kinds[start] else {
                        continue;
                    };
                    let ends = [ring[start], ring[starts[(k + 1) % starts.len()]]];
                    if ends[0] != ends[1] {
                        sides.push(WireframeSide {
                            kind,
                            face,
                            beyond,
                            ends,
                        });
                    }
                }
            }
        }
        for (v, faces) in self.faces_at() {
            let p = self.position(state, v);
            let mut heights: Vec<(f64, usize)> = faces
                .iter()
                .map(|&f| (self.height(state, f, &p), f))
                .collect();
            heights.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let joined = heights
                .windows(2)
                .filter(|w| w[1].0 - w[0].0 < SAME_HEIGHT_M);
            meets.extend(joined.map(|w| (v, w[0].1.min(w[1].1), w[0].1.max(w[1].1))));
        }
        self.sides = sides;
        self.straights = straights.into_iter().collect();
        self.meets = meets
            .into_iter()
            .map(|(vertex, f, g)| Meet {
                vertex,
                faces: [f, g],
            })
            .collect();
    }

    /// For every directed edge the facet on its left.
    fn left_of(&self) -> BTreeMap<(usize, usize), usize> {
        let mut left_of = BTreeMap::new();
        for face in 0..self.faces.len() {
            left_of.extend(self.ring_sides(face).map(|[u, v]| ((u, v), face)));
        }
        left_of
    }

    /// The facets around every vertex.
    fn faces_at(&self) -> BTreeMap<usize, BTreeSet<usize>> {
        let mut at: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for (face, rings) in self.faces.iter().enumerate() {
            for &v in rings.iter().flatten() {
                at.entry(v).or_default().insert(face);
            }
        }
        at
    }

    /// What the edge from `u` to `v` of a facet is; `None` for a crease that is a side of the facet
    /// beyond.
    fn kind(
        &self,
        state: &WireframeState,
        left_of: &BTreeMap<(usize, usize), usize>,
        face: usize,
        u: usize,
        v: usize,
    ) -> Option<(SideKind, Option<usize>)> {
        let Some(&beyond) = left_of.get(&(v, u)) else {
            return Some((SideKind::Free, None));
        };
        let above = [u, v].map(|w| {
            let p = self.position(state, w);
            self.height(state, face, &p) - self.height(state, beyond, &p)
        });
        if above.iter().all(|d| d.abs() < SAME_HEIGHT_M) {
            return (face < beyond).then_some((SideKind::Crease, Some(beyond)));
        }
        let kind = if above[0] + above[1] > 0.0 {
            SideKind::Step
        } else {
            SideKind::Foot
        };
        Some((kind, None))
    }

    fn is_straight(&self, state: &WireframeState, before: usize, at: usize, after: usize) -> bool {
        let [p, q, r] = [before, at, after].map(|v| self.position(state, v));
        let along = r - p;
        let length = along.norm();
        let forward = (q - p).dot(&along) > 0.0 && (r - q).dot(&along) > 0.0;
        length > 0.0 && forward && (along.perp(&(q - p)) / length).abs() < STRAIGHT_M
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{facets_of, gable};
    use super::*;

    #[test]
    fn a_gable_has_six_free_sides_and_a_ridge() {
        let facets = gable();
        let (wireframe, state) = Wireframe::new(&facets_of(&facets));
        assert_eq!((wireframe.vertices, wireframe.faces.len()), (6, 2));
        let count = |kind| wireframe.sides.iter().filter(|s| s.kind == kind).count();
        assert_eq!((count(SideKind::Free), count(SideKind::Crease)), (6, 1));
        // Both ends of the ridge hold two facets together; seen from above the gable's ends are
        // straight.
        assert_eq!(wireframe.meets.len(), 2);
        assert_eq!(wireframe.straights, []);
        let back = wireframe.facets(&state, &facets_of(&facets));
        for (f, g) in facets.iter().zip(&back) {
            assert!(f.plane.angle_to(&g.plane) < 1e-12);
            for (p, q) in f.outer.iter().zip(&g.outer) {
                assert!((p - q).norm() < 1e-9);
            }
        }
    }
}
