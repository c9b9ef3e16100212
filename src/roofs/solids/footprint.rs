//! Where a building stands whose walls are inside its eaves: the plan of its roof, less a band
//! along each side.
//!
//! Bands of several sides can leave what no house stands on, and corners a hair beside a hip, whose
//! solid would have edges of a millimetre that bend its faces. So the footprint is tidied:
//!
//! 1. Where it touches itself in a point it is parted.
//! 2. Pieces narrower than a room are left out.
//! 3. Corners near an edge of a roof, or a roof's corner near its edge, lie on each other.

use std::collections::BTreeMap;

use nalgebra::{Point2, Point3, Vector2};

use super::sides::{Side, key, left_of, mitre};
use crate::base::geometry::{self, Polygon};

/// Least plan area of a footprint, as a share of the roof's: less is no house.
const LEAST_FOOTPRINT: f64 = 0.3;

/// Pieces of a footprint that are narrower carry no roof, metres. Assumption.
const LEAST_WIDTH_M: f64 = 0.5;

/// Corners and edges nearer than this lie on each other, metres: less than walls are known to, and
/// more than ten times what welding moves.
const TOUCHING_DISTANCE_M: f64 = 0.015;

/// Where two stretches of the outline come nearer than this it is parted, metres.
const PINCH_M: f64 = 4.0 * TOUCHING_DISTANCE_M;

/// The plan of the roof without the bands along its sides; `None` where too little is left.
pub(super) fn footprint(roofs: &[Polygon], sides: &[Side], depths: &[f64]) -> Option<Polygon> {
    let mut plan = roofs.first()?.clone();
    for roof in &roofs[1..] {
        plan = plan.or(roof);
    }
    let whole = plan.signed_area().abs();
    let starts: BTreeMap<_, usize> = (sides.iter().enumerate())
        .map(|(i, side)| (key(&side.start()), i))
        .collect();
    let ends: BTreeMap<_, usize> = (sides.iter().enumerate())
        .map(|(i, side)| (key(&side.end()), i))
        .collect();
    for (i, side) in sides.iter().enumerate().filter(|(i, _)| depths[*i] > 0.0) {
        let before = *ends.get(&key(&side.start()))?;
        let after = *starts.get(&key(&side.end()))?;
        let band = band(
            side,
            depths[i],
            [
                (&sides[before], depths[before]),
                (&sides[after], depths[after]),
            ],
        );
        plan = plan.without(&band.into());
    }
    if depths.iter().any(|depth| *depth > 0.0) {
        plan = aligned(&wide_pieces(&parted(plan)), roofs);
    }
    (plan.signed_area().abs() > LEAST_FOOTPRINT * whole).then_some(plan)
}

/// What lies between a side and its wall: a rectangle, or as far as the next wall where the outline
/// turns in.
fn band(side: &Side, depth: f64, [before, after]: [(&Side, f64); 2]) -> Vec<Point2<f64>> {
    let inner = left_of(&side.along()) * depth;
    let (start, end) = (side.start().xy(), side.end().xy());
    let turns_in = |first: &Side, then: &Side| first.along().perp(&then.along()) < 0.0;
    let at = |corner: Point2<f64>, [first, then]: [(&Side, f64); 2]| {
        let directions = [first.0.along(), then.0.along()];
        let mitred = mitre(&corner, [&directions[0], &directions[1]], [first.1, then.1]);
        let mitred = mitred.filter(|_| turns_in(first.0, then.0));
        mitred.unwrap_or(corner + inner)
    };
    let far = at(end, [(side, depth), after]);
    let near = at(start, [before, (side, depth)]);
    let rim = side.rim.iter().map(Point3::xy);
    rim.chain([far, near]).collect()
}

/// The footprint without small squares around the points where it touches itself.
fn parted(mut plan: Polygon) -> Polygon {
    // The sides of a square may touch again.
    const PARTING_ROUNDS: usize = 3;
    for _ in 0..PARTING_ROUNDS {
        let points = pinches(&plan);
        if points.is_empty() {
            break;
        }
        for p in points {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let square = corners.map(|[x, y]| p + Vector2::new(x, y) * 2.0 * PINCH_M);
            plan = plan.without(&square.to_vec().into());
        }
    }
    plan
}

/// Corners that lie on a stretch of outline which is not their own.
fn pinches(plan: &Polygon) -> Vec<Point2<f64>> {
    /// Stretches that follow each other within so many metres are one.
    const OWN_STRETCH_M: f64 = 10.0 * PINCH_M;
    let mut found: Vec<Point2<f64>> = Vec::new();
    for (r, ring) in plan.rings.iter().enumerate() {
        let n = ring.len();
        let next = |i: usize| ring[(i + 1) % n];
        let mut at = vec![0.0];
        for i in 0..n {
            at.push(at[i] + (next(i) - ring[i]).norm());
        }
        let along = |i: usize, j: usize| {
            let way = (at[i] - at[j]).abs();
            way.min(at[n] - way)
        };
        for (i, p) in ring.iter().enumerate() {
            let touches = plan.rings.iter().enumerate().any(|(s, other)| {
                (0..other.len()).any(|j| {
                    let end = (j + 1) % other.len();
                    let own = r == s && along(i, j).min(along(i, end)) < OWN_STRETCH_M;
                    !own && distance(p, [&other[j], &other[end]]) < PINCH_M
                })
            });
            if touches && found.iter().all(|q| (p - q).norm() > PINCH_M) {
                found.push(*p);
            }
        }
    }
    found
}

/// The pieces that a house can stand on.
fn wide_pieces(plan: &Polygon) -> Polygon {
    let is_wide = |piece: &Polygon| {
        // Of width w and length l the area is w l and the outline 2 l.
        2.0 * piece.signed_area().abs() > LEAST_WIDTH_M * piece.perimeter()
    };
    plan.parts().into_iter().filter(is_wide).collect()
}

/// The footprint with its corners on the corners and edges of roofs that are near, and its edges
/// through near corners of roofs.
fn aligned(plan: &Polygon, roofs: &[Polygon]) -> Polygon {
    let edges: Vec<[Point2<f64>; 2]> = roofs.iter().flat_map(Polygon::sides).collect();
    let corners: Vec<Point2<f64>> = edges.iter().map(|edge| edge[0]).collect();
    let nearest = |to: &Point2<f64>, among: &[Point2<f64>]| {
        let near = among.iter().map(|p| ((p - to).norm(), *p));
        let nearest = near.min_by(|p, q| p.0.total_cmp(&q.0));
        nearest
            .filter(|(d, _)| *d < TOUCHING_DISTANCE_M)
            .map(|(_, p)| p)
    };
    let mut placed = Vec::new();
    let mut place = |p: &Point2<f64>| {
        let on_edge = || {
            let feet: Vec<_> = edges.iter().map(|[a, b]| foot(p, [a, b])).collect();
            nearest(p, &feet)
        };
        let known = nearest(p, &corners).or_else(|| nearest(p, &placed));
        let at = known.or_else(on_edge).unwrap_or(*p);
        placed.push(at);
        at
    };
    let through = |a: Point2<f64>, b: Point2<f64>| {
        let along = b - a;
        let mut stops: Vec<(f64, Point2<f64>)> = (corners.iter())
            .filter(|c| distance(c, [&a, &b]) < TOUCHING_DISTANCE_M && **c != a && **c != b)
            .map(|c| (along.dot(&(c - a)), *c))
            .collect();
        stops.sort_by(|p, q| p.0.total_cmp(&q.0));
        std::iter::once(a).chain(stops.into_iter().map(|(_, c)| c))
    };
    let rings = plan.rings.iter().map(|ring| {
        let mut moved: Vec<_> = ring.iter().map(&mut place).collect();
        moved.dedup();
        let sides = geometry::sides(&moved);
        let mut whole: Vec<_> = sides.flat_map(|[a, b]| through(a, b)).collect();
        whole.dedup();
        whole
    });
    let aligned = Polygon {
        rings: rings.collect(),
    };
    aligned.parts().into_iter().collect()
}

/// The point of a segment that is nearest.
fn foot(p: &Point2<f64>, [a, b]: [&Point2<f64>; 2]) -> Point2<f64> {
    let along = b - a;
    let square = along.norm_squared();
    let s = if square > 0.0 {
        (along.dot(&(p - a)) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    a + along * s
}

fn distance(p: &Point2<f64>, segment: [&Point2<f64>; 2]) -> f64 {
    (foot(p, segment) - p).norm()
}
