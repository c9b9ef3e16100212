//! Kinds of roof edges: they follow from the planes and outlines of the facets alone.
//!
//! ```text
//! two facets meet     level, both fall away: ridge      inclined, convex:  hip
//!                     level, both rise:      valley     inclined, concave: valley
//!                     level, one of each:    transition (a mansard's break, a flat roof's end)
//! a facet ends        level, below it: eave      level, above it: top edge      inclined: rake
//! a facet ends below  a higher one: abutment; the higher one ends there as above
//! ```
//!
//! Level means: nearly along the contour lines of the steeper facet. So the rakes of a roof of
//! three degrees are none of its eaves, though they hardly rise.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector2};
use serde::Deserialize;

use crate::base::geometry::{Segment3, sides};
use crate::base::ids::FacetId;
use crate::roofs::model::Facet;
use crate::roofs::solids::{STEP_HEIGHT_M, WRITTEN_STEP_M};

/// An edge is level up to this sine of its angle to the contour lines: 10 degrees. Assumption: the
/// least angle of a hip to them is some 30.
const CONTOUR_SINE: f64 = 0.1736;

/// Rises below this are none, metres per metre: 1 degree.
const FLAT_SLOPE: f64 = 0.0175;

/// Pieces of an edge turn by less than this sine (1 degree).
pub(super) const TURN_SINE: f64 = 0.0175;

/// Shorter pieces between longer ones have no direction of their own, metres: what is left where
/// outlines were welded.
pub(super) const SHORT_PIECE_M: f64 = 0.01;

/// What an edge of a roof is.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "snake_case")]
pub enum RoofEdgeKind {
    /// The level top of two facets that fall away from it.
    Ridge,
    /// An inclined convex edge of two facets.
    Hip,
    /// A concave edge of two facets.
    Valley,
    /// A level edge that one facet rises to and the other goes on from: the slope changes.
    Transition,
    /// The level lower end of a facet.
    Eave,
    /// An inclined end of a facet.
    Rake,
    /// The level upper end of a facet that meets no other: the top of a lean-to.
    TopEdge,
    /// Where a facet ends at the wall below a higher one.
    Abutment,
}

impl RoofEdgeKind {
    /// All kinds, in the order in which they are listed.
    pub const ALL: [Self; 8] = [
        Self::Ridge,
        Self::Hip,
        Self::Valley,
        Self::Transition,
        Self::Eave,
        Self::Rake,
        Self::TopEdge,
        Self::Abutment,
    ];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ridge => "ridge",
            Self::Hip => "hip",
            Self::Valley => "valley",
            Self::Transition => "transition",
            Self::Eave => "eave",
            Self::Rake => "rake",
            Self::TopEdge => "top_edge",
            Self::Abutment => "abutment",
        }
    }
}

/// A straight edge of a roof.
#[derive(Clone, Debug, PartialEq)]
pub struct RoofEdge {
    /// What it is.
    pub kind: RoofEdgeKind,
    /// The facet that it belongs to, which lies to its left seen from above.
    pub facet: FacetId,
    /// The facet beyond: the other one of a common edge, the higher one of an abutment.
    pub other: Option<FacetId>,
    /// Its ends on `facet`, metres.
    pub segment: Segment3,
}

impl RoofEdge {
    /// Is it the edge of this other facet too?
    pub fn borders_on(&self, facet: FacetId) -> bool {
        self.kind != RoofEdgeKind::Abutment && self.other == Some(facet)
    }
}

/// A position in plan that can be compared.
pub(super) fn key(p: &Point3<f64>) -> [i64; 2] {
    [p.x, p.y].map(|c| (c / WRITTEN_STEP_M).round() as i64)
}

/// A piece of a ring between two of its corners: kind, facet beyond, ends.
type Piece = (RoofEdgeKind, Option<FacetId>, Segment3);

/// The edges of a building, each once, pieces of a straight one joined. Facets meet where they have
/// common corners, as those of a closed building do.
pub fn roof_edges(facets: &[(FacetId, &Facet)]) -> Vec<RoofEdge> {
    let mut left_of = BTreeMap::new();
    for (i, (_, facet)) in facets.iter().enumerate() {
        for [a, b] in facet.rings().flat_map(|ring| sides(ring)) {
            left_of.insert((key(&a), key(&b)), (i, a.z, b.z));
        }
    }
    let mut edges = Vec::new();
    for (i, &(id, facet)) in facets.iter().enumerate() {
        for ring in facet.rings() {
            let pieces = sides(ring).map(|[a, b]| {
                let twin = left_of.get(&(key(&b), key(&a))).filter(|twin| twin.0 != i);
                let beyond = twin.map(|&(j, z_b, z_a)| (j, z_a - a.z, z_b - b.z));
                let (kind, other) = match beyond {
                    Some((j, at_a, at_b))
                        if at_a.abs() < STEP_HEIGHT_M && at_b.abs() < STEP_HEIGHT_M =>
                    {
                        // The first of both facets has it.
                        if j < i {
                            return None;
                        }
                        (common_kind(facet, facets[j].1, &a, &b), Some(j))
                    }
                    Some((j, at_a, at_b)) if at_a + at_b > 0.0 => (RoofEdgeKind::Abutment, Some(j)),
                    _ => (end_kind(facet, &a, &b), None),
                };
                Some((kind, other.map(|j| facets[j].0), Segment3::new(a, b)))
            });
            let joined = join_pieces(&pieces.collect::<Vec<Option<Piece>>>());
            edges.extend(joined.into_iter().map(|(kind, other, segment)| RoofEdge {
                kind,
                facet: id,
                other,
                segment,
            }));
        }
    }
    edges
}

/// Joins neighbouring pieces of a ring that are one straight edge.
fn join_pieces(pieces: &[Option<Piece>]) -> Vec<Piece> {
    let goes_on = |run: &Piece, next: &Piece| {
        let (d, e) = (run.2.direction(), next.2.direction());
        let is_straight = d.dot(&e) > 0.0 && d.cross(&e).norm() < TURN_SINE;
        let is_same = (run.0, run.1) == (next.0, next.1) && is_straight;
        let is_rest = run.1.is_none() && next.1.is_none() && next.2.length() < SHORT_PIECE_M;
        is_same || (is_rest && run.2.length() >= SHORT_PIECE_M)
    };
    let starts_new = |i: usize| {
        let before = &pieces[(i + pieces.len() - 1) % pieces.len()];
        !matches!((before, &pieces[i]), (Some(a), Some(b)) if goes_on(a, b))
    };
    // A ring turns somewhere.
    let first = (0..pieces.len()).find(|&i| starts_new(i)).unwrap_or(0);
    let mut joined: Vec<Piece> = Vec::new();
    let mut is_open = false;
    for i in first..first + pieces.len() {
        let Some(piece) = &pieces[i % pieces.len()] else {
            is_open = false;
            continue;
        };
        match joined.last_mut() {
            Some(run) if is_open && goes_on(run, piece) => run.2.p1 = piece.2.p1,
            _ => joined.push(*piece),
        }
        is_open = true;
    }
    joined
}

/// Rise of a facet per metre to the east and to the north.
pub(super) fn gradient(facet: &Facet) -> Vector2<f64> {
    -facet.plane.normal.xy() / facet.plane.normal.z
}

/// The direction from one corner to the next, and that to the right of it, in plan.
fn along_and_out(a: &Point3<f64>, b: &Point3<f64>) -> (Vector2<f64>, Vector2<f64>) {
    let along = (b - a).xy().try_normalize(0.0).unwrap_or_else(Vector2::x);
    (along, Vector2::new(along.y, -along.x))
}

/// The kind of an edge with `facet` to its left and `other` to its right.
fn common_kind(facet: &Facet, other: &Facet, a: &Point3<f64>, b: &Point3<f64>) -> RoofEdgeKind {
    let (along, out) = along_and_out(a, b);
    let (own, beyond) = (gradient(facet), gradient(other));
    // What one climbs on going away from the edge.
    let (rise_own, rise_beyond) = (-own.dot(&out), beyond.dot(&out));
    let steeper = if own.norm() < beyond.norm() {
        beyond
    } else {
        own
    };
    let is_level = is_level(&along, &steeper);
    let bend = rise_own + rise_beyond;
    if is_level && rise_own < -FLAT_SLOPE && rise_beyond < -FLAT_SLOPE {
        RoofEdgeKind::Ridge
    } else if is_level && rise_own > FLAT_SLOPE && rise_beyond > FLAT_SLOPE {
        RoofEdgeKind::Valley
    } else if is_level || bend.abs() < FLAT_SLOPE {
        RoofEdgeKind::Transition
    } else if bend < 0.0 {
        RoofEdgeKind::Hip
    } else {
        RoofEdgeKind::Valley
    }
}

/// The kind of an edge where a facet ends.
fn end_kind(facet: &Facet, a: &Point3<f64>, b: &Point3<f64>) -> RoofEdgeKind {
    let (along, out) = along_and_out(a, b);
    let own = gradient(facet);
    if !is_level(&along, &own) {
        RoofEdgeKind::Rake
    } else if own.norm() < FLAT_SLOPE || own.dot(&out) < 0.0 {
        RoofEdgeKind::Eave
    } else {
        RoofEdgeKind::TopEdge
    }
}

fn is_level(along: &Vector2<f64>, gradient: &Vector2<f64>) -> bool {
    let slope = gradient.norm();
    slope < FLAT_SLOPE || along.dot(gradient).abs() < CONTOUR_SINE * slope
}
