//! The corners of a building in plan, and the straight sides between them: pieces of outlines that
//! go on into each other, of one facet or of several.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Point2, Point3, Vector2};

use super::edges::{TURN_SINE, key};
use crate::base::geometry::sides;
use crate::roofs::model::Facet;

/// Corners in plan, each once.
pub(super) struct Corners {
    positions: Vec<Point2<f64>>,
    index: BTreeMap<[i64; 2], usize>,
}

/// The rings of a facet as corners.
pub(super) type Rings = Vec<Vec<usize>>;

impl Corners {
    /// The corners of facets, and the rings of each.
    pub(super) fn of<'a>(facets: impl Iterator<Item = &'a Facet>) -> (Self, Vec<Rings>) {
        let mut corners = Self {
            positions: Vec::new(),
            index: BTreeMap::new(),
        };
        let rings_of = |facet: &'a Facet| {
            (facet.rings())
                .map(|ring| ring.iter().map(|p| corners.add(p)).collect())
                .collect()
        };
        let rings = facets.map(rings_of).collect();
        (corners, rings)
    }

    fn add(&mut self, p: &Point3<f64>) -> usize {
        let positions = &mut self.positions;
        *self.index.entry(key(p)).or_insert_with(|| {
            positions.push(p.xy());
            positions.len() - 1
        })
    }

    /// The corner at a place.
    pub(super) fn find(&self, p: &Point3<f64>) -> Option<usize> {
        self.index.get(&key(p)).copied()
    }

    pub(super) fn at(&self, corner: usize) -> Point2<f64> {
        self.positions[corner]
    }
}

/// From each corner of rings to the next.
pub(super) fn ring_pieces(rings: &Rings) -> impl Iterator<Item = [usize; 2]> + '_ {
    rings.iter().flat_map(|ring| sides(ring))
}

/// The straight sides of a building.
pub(super) struct StraightSides {
    /// Unit vectors.
    directions: Vec<Vector2<f64>>,
    /// For every piece, by its corners in order, its side.
    of_piece: BTreeMap<[usize; 2], usize>,
}

impl StraightSides {
    /// The sides of rings.
    pub(super) fn of<'a>(corners: &Corners, rings: impl Iterator<Item = &'a Vec<usize>>) -> Self {
        let pieces: BTreeSet<[usize; 2]> = rings.flat_map(|ring| sides(ring)).map(sorted).collect();
        let mut beside: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for &[p, q] in &pieces {
            beside.entry(p).or_default().insert(q);
            beside.entry(q).or_default().insert(p);
        }
        let direction = |[p, q]: [usize; 2]| {
            let along = corners.at(q) - corners.at(p);
            along.try_normalize(0.0).unwrap_or_else(Vector2::x)
        };
        let mut sides = Self {
            directions: Vec::new(),
            of_piece: BTreeMap::new(),
        };
        for &piece in &pieces {
            if sides.of_piece.contains_key(&piece) {
                continue;
            }
            let side = sides.len();
            sides.directions.push(direction(piece));
            sides.of_piece.insert(piece, side);
            let mut ahead = vec![piece, [piece[1], piece[0]]];
            while let Some([from, to]) = ahead.pop() {
                let along = direction([from, to]);
                for &next in &beside[&to] {
                    let on = direction([to, next]);
                    let is_straight = along.dot(&on) > 0.0 && along.perp(&on).abs() < TURN_SINE;
                    if is_straight && !sides.of_piece.contains_key(&sorted([to, next])) {
                        sides.of_piece.insert(sorted([to, next]), side);
                        ahead.push([to, next]);
                    }
                }
            }
        }
        sides
    }

    pub(super) fn len(&self) -> usize {
        self.directions.len()
    }

    /// The unit vector along a side.
    pub(super) fn direction(&self, side: usize) -> Vector2<f64> {
        self.directions[side]
    }

    /// The side of a piece of an outline.
    pub(super) fn of_piece(&self, ends: [usize; 2]) -> usize {
        self.of_piece[&sorted(ends)]
    }
}

fn sorted([p, q]: [usize; 2]) -> [usize; 2] {
    [p.min(q), p.max(q)]
}
