//! Simpler ways between two vertices of an outline, and whether one meets other sides.

use nalgebra::{Point2, Vector2};

use super::rings::{Chain, Links, Rings};
use crate::base::geometry::{bounds, sides};

/// Sides that meet at less than this sine (15 degrees) have no useful crossing.
const CROSSING_SINE: f64 = 0.25;
/// No side of a simpler way is shorter, metres: about the width of an edge in the images.
const SHORTEST_SIDE_M: f64 = 0.3;
/// Sides that have no vertex in common are farther apart, metres: nearer ones would be welded.
const SIDE_CLEARANCE_M: f64 = 0.05;
/// Sides at less than this sine, from one vertex to one side, lie on each other.
const FOLD_SINE: f64 = 0.02;

/// The vertices between the ends of simpler ways: none, or one where a side goes straight on from
/// one end and meets one that comes straight to the other, or the perpendicular through it.
pub(super) fn simpler(
    chain: &Chain,
    [from, to]: [usize; 2],
    rings: &Rings,
    links: &Links,
) -> Vec<Vec<Point2<f64>>> {
    let ends = [from, to].map(|i| rings.vertices[chain.vertices[i]]);
    let leaving = directions(chain, [from, from + 1], rings, links);
    let arriving = directions(chain, [to, to - 1], rings, links);
    let ahead = |x: &Point2<f64>, end: usize, direction: &Vector2<f64>| {
        (x - ends[end]).dot(direction) > SHORTEST_SIDE_M
    };
    let crossings = leaving.iter().flat_map(|d| {
        arriving.iter().filter_map(move |e| {
            let sine = d.perp(e);
            let x = ends[0] + d * ((ends[1] - ends[0]).perp(e) / sine);
            (sine.abs() > CROSSING_SINE && ahead(&x, 0, d) && ahead(&x, 1, e)).then_some(x)
        })
    });
    let foot = |end: usize, direction: &Vector2<f64>| {
        let x = ends[end] + direction * (ends[1 - end] - ends[end]).dot(direction);
        let is_apart = (x - ends[1 - end]).norm() > SHORTEST_SIDE_M;
        (is_apart && ahead(&x, end, direction)).then_some(x)
    };
    let feet = [(0, &leaving), (1, &arriving)];
    let feet = feet
        .into_iter()
        .flat_map(|(end, all)| all.iter().filter_map(move |d| foot(end, d)));
    let turning = crossings.chain(feet).map(|x| vec![x]);
    std::iter::once(Vec::new()).chain(turning).collect()
}

/// The directions in which a way may leave a vertex of a chain: that of the side that it has, and
/// those in which the other sides there go straight on.
fn directions(chain: &Chain, side: [usize; 2], rings: &Rings, links: &Links) -> Vec<Vector2<f64>> {
    let [vertex, next] = side.map(|i| chain.vertices[i]);
    let at = |v: usize| rings.vertices[v];
    let others = links[&vertex].iter().filter(|&&v| v != next);
    let straight_on = others.map(|&v| at(vertex) - at(v));
    let all = std::iter::once(at(next) - at(vertex)).chain(straight_on);
    all.filter_map(|d| d.try_normalize(1e-6)).collect()
}

/// Does a way meet a side that stays, or itself?
pub(super) fn meets_others(
    way: &[Point2<f64>],
    chain: &Chain,
    [from, to]: [usize; 2],
    rings: &Rings,
) -> bool {
    let [low, high] = bounds(way.iter().copied());
    let is_far = |p: &Point2<f64>, q: &Point2<f64>| {
        (0..2).any(|i| {
            p[i].max(q[i]) < low[i] - SIDE_CLEARANCE_M
                || p[i].min(q[i]) > high[i] + SIDE_CLEARANCE_M
        })
    };
    let gone = &chain.vertices[from..=to];
    let goes = |a: usize, b: usize| {
        gone.windows(2)
            .any(|w| [w[0], w[1]] == [a, b] || [w[1], w[0]] == [a, b])
    };
    let (first, last) = (gone[0], gone[gone.len() - 1]);
    rings.rings.iter().any(|ring| {
        sides(&ring.vertices).any(|[a, b]| {
            let side = [a, b].map(|v| rings.vertices[v]);
            if is_far(&side[0], &side[1]) || goes(a, b) {
                return false;
            }
            way.windows(2).enumerate().any(|(k, w)| {
                // Sides from one vertex meet there, and are apart elsewhere unless they fold.
                let is_shared =
                    |v: usize| (k == 0 && v == first) || (k + 2 == way.len() && v == last);
                match (is_shared(a), is_shared(b)) {
                    (false, false) => meet(&[w[0], w[1]], &side),
                    (true, true) => true,
                    (at_a, _) => {
                        let [vertex, far] = if at_a { side } else { [side[1], side[0]] };
                        let other = if w[0] == vertex { w[1] } else { w[0] };
                        let (u, v) = (far - vertex, other - vertex);
                        u.perp(&v).abs() < FOLD_SINE * u.norm() * v.norm() && u.dot(&v) > 0.0
                    }
                }
            })
        })
    })
}

/// Do two sides cross, or come too near to each other?
fn meet([a, b]: &[Point2<f64>; 2], [p, q]: &[Point2<f64>; 2]) -> bool {
    let is_left = |a: &Point2<f64>, b: &Point2<f64>, x: &Point2<f64>| (b - a).perp(&(x - a)) > 0.0;
    let crosses = is_left(a, b, p) != is_left(a, b, q) && is_left(p, q, a) != is_left(p, q, b);
    let is_near = |x: &Point2<f64>, a: &Point2<f64>, b: &Point2<f64>| {
        let along = b - a;
        let t = (x - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
        (x - (a + along * t.clamp(0.0, 1.0))).norm() < SIDE_CLEARANCE_M
    };
    crosses || is_near(a, p, q) || is_near(b, p, q) || is_near(p, a, b) || is_near(q, a, b)
}
