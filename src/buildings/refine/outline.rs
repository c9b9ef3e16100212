//! Simpler outlines: short sides between long ones go where they are below the resolution of the
//! images.
//!
//! Delineation follows cells, and cells follow every line that was found: a gutter here, the eave
//! there, a skylight or the shadow of a chimney at the border. Places nearer to each other than
//! half a correlation window cannot be separated by the agreement of the views, so a jog that
//! short is no evidence of a corner. The outline without it is tried as well, and the images decide
//! by the share of its sides that they show. Where corners lie to both sides of a straight way by
//! less than half of that, the way is taken: eaves are straight, and what was found of one is a
//! piece of gutter here and of fascia there.
//!
//! Only vertices of a single facet, with nothing beyond both of their sides, are touched.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Point2, Point3, Vector2};

use crate::model::Facet;

/// Sides at less than this angle run on into each other, sine (25 degrees).
const ALIGNED_SINE: f64 = 0.42;
/// A corner that replaces a short side lies at most so many lengths of the jog away.
const FARTHEST: f64 = 1.5;

/// The facets with simpler outlines, each on its own plane; a facet without a short free side is as
/// it was.
pub(super) fn simplified(facets: &[&Facet], jog_m: f64) -> Vec<Facet> {
    let free = free_vertices(facets);
    let changed = |facet: &&Facet| {
        let mut facet = (*facet).clone();
        let plane = facet.plane;
        let ring: Vec<Corner> = facet.outer.iter().map(|p| Corner::new(p, &free)).collect();
        let ring = without_jogs(ring, jog_m);
        if ring.len() >= 3 {
            let lift = |c: &Corner| {
                // Corners that stay keep their bits, so that neighbours go on sharing them.
                c.old.unwrap_or_else(|| plane.lift(c.at.x, c.at.y))
            };
            facet.outer = ring.iter().map(lift).collect();
        }
        facet
    };
    facets.iter().map(changed).collect()
}

/// A corner of an outline.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: Point2<f64>,
    /// May it move or go?
    free: bool,
    /// What it was, where it has not moved.
    old: Option<Point3<f64>>,
}

impl Corner {
    fn new(p: &Point3<f64>, free: &BTreeSet<[u64; 2]>) -> Self {
        Self {
            at: p.xy(),
            free: free.contains(&key(p)),
            old: Some(*p),
        }
    }

    fn at(at: Point2<f64>) -> Self {
        Self {
            at,
            free: true,
            old: None,
        }
    }
}

fn key(p: &Point3<f64>) -> [u64; 2] {
    [p.x.to_bits(), p.y.to_bits()]
}

/// Vertices that a single facet has, once.
fn free_vertices(facets: &[&Facet]) -> BTreeSet<[u64; 2]> {
    let mut uses: BTreeMap<[u64; 2], usize> = BTreeMap::new();
    let rings = |f: &&Facet| -> Vec<Point3<f64>> {
        let holes = f.holes.iter().flatten();
        f.outer.iter().chain(holes).copied().collect()
    };
    for p in facets.iter().flat_map(rings) {
        *uses.entry(key(&p)).or_default() += 1;
    }
    let single = uses.into_iter().filter(|(_, n)| *n == 1);
    // Not collected: that would sort the corners again, by one more sort.
    let mut free = BTreeSet::new();
    free.extend(single.map(|(k, _)| k));
    free
}

/// Takes out short sides, the shortest first, until none is left that can go.
fn without_jogs(mut ring: Vec<Corner>, jog_m: f64) -> Vec<Corner> {
    loop {
        let n = ring.len();
        if n < 5 {
            return ring;
        }
        let length = |i: usize| (ring[(i + 1) % n].at - ring[i].at).norm();
        let mut short: Vec<usize> = (0..n)
            .filter(|&i| length(i) < jog_m && ring[i].free && ring[(i + 1) % n].free)
            .collect();
        short.sort_by(|&i, &j| length(i).total_cmp(&length(j)).then(i.cmp(&j)));
        let shorter = (short.iter().find_map(|&i| without_side(&ring, i, jog_m)))
            .or_else(|| without_spike(&ring, jog_m));
        let Some(shorter) = shorter else {
            return ring;
        };
        ring = shorter;
    }
}

/// The facets without the free corners beside straight ways between two others, where they are no
/// farther from them than `tolerance_m`.
pub(super) fn straightened(facets: &[Facet], tolerance_m: f64) -> Vec<Facet> {
    let free = free_vertices(&facets.iter().collect::<Vec<_>>());
    let straight = |facet: &Facet| {
        let ring: Vec<Corner> = facet.outer.iter().map(|p| Corner::new(p, &free)).collect();
        let mut kept = vec![true; ring.len()];
        for (first, sides) in straight_ways(&ring, tolerance_m) {
            (1..sides).for_each(|k| kept[(first + k) % ring.len()] = false);
        }
        let mut facet = facet.clone();
        let mut kept = kept.into_iter();
        facet.outer.retain(|_| kept.next() == Some(true));
        facet
    };
    facets.iter().map(straight).collect()
}

/// First corner and number of sides of the straight ways of a ring, the longest first; none have a
/// side in common.
fn straight_ways(ring: &[Corner], tolerance_m: f64) -> Vec<(usize, usize)> {
    let n = ring.len();
    // Three corners stay.
    let ways = (0..n).flat_map(|i| (2..n.saturating_sub(1)).map(move |sides| (i, sides)));
    let mut ways: Vec<(usize, usize)> = ways
        .filter(|&(i, sides)| is_straight(ring, i, sides, tolerance_m))
        .collect();
    let length = |&(i, sides): &(usize, usize)| (ring[(i + sides) % n].at - ring[i].at).norm();
    ways.sort_by(|a, b| length(b).total_cmp(&length(a)).then(a.cmp(b)));
    let (mut taken, mut left) = (vec![false; n], n);
    ways.retain(|&(i, sides)| {
        let way = || (i..i + sides).map(|side| side % n);
        let may_go = way().all(|side| !taken[side]) && left >= 3 + sides - 1;
        if may_go {
            way().for_each(|side| taken[side] = true);
            left -= sides - 1;
        }
        may_go
    });
    ways
}

/// Do the corners between corner `i` and the one after some sides lie beside the way from one to
/// the other, in order, and free?
fn is_straight(ring: &[Corner], i: usize, sides: usize, tolerance_m: f64) -> bool {
    let at = |k: usize| &ring[(i + k) % ring.len()];
    let Some(along) = direction(at(0), at(sides)) else {
        return false;
    };
    let offset = |k: usize| at(k).at - at(0).at;
    (1..sides).all(|k| at(k).free && offset(k).perp(&along).abs() <= tolerance_m)
        && (0..sides).all(|k| offset(k).dot(&along) < offset(k + 1).dot(&along))
}

/// The ring without a corner between two neighbours that nearly touch: a wedge cut into the facet
/// or standing out.
fn without_spike(ring: &[Corner], jog_m: f64) -> Option<Vec<Corner>> {
    let n = ring.len();
    let is_spike = |&i: &usize| {
        let [p, q, r] = [i + n - 1, i, i + 1].map(|k| ring[k % n]);
        let sharp = (q.at - p.at).dot(&(r.at - q.at)) < 0.0;
        q.free && sharp && (r.at - p.at).norm() < FARTHEST * jog_m
    };
    let i = (0..n).find(is_spike)?;
    let mut shorter = ring.to_vec();
    shorter.remove(i);
    Some(shorter)
}

/// The ring without its side `i`; `None` where no simple change replaces it.
fn without_side(ring: &[Corner], i: usize, jog_m: f64) -> Option<Vec<Corner>> {
    let n = ring.len();
    // Rotated: before, [first, last] of the short side, after, and the corners around them.
    let at = |k: usize| ring[(i + n - 2 + k) % n];
    let (o, p, q, r, s, t) = (at(0), at(1), at(2), at(3), at(4), at(5));
    let rest: Vec<Corner> = (6..n).map(at).collect();
    let (into, out) = (direction(&p, &q)?, direction(&r, &s)?);
    let turn = into.perp(&out);
    let build = |middle: &[Corner]| {
        let mut ring = middle.to_vec();
        if n > 5 {
            ring.extend(&rest);
        }
        ring
    };
    let near = |x: &Point2<f64>, c: &Corner| (x - c.at).norm() <= FARTHEST * jog_m;
    if turn.abs() > ALIGNED_SINE {
        // A cut corner: its sides meet.
        let x = meeting(&p, &into, &r, &out)?;
        return (near(&x, &q) && near(&x, &r)).then(|| build(&six(n, [o, p, Corner::at(x), s, t])));
    }
    if into.dot(&out) < 0.0 {
        // There and back: a slot or a spike.
        return Some(build(&six(n, [o, p, s, t])));
    }
    // A jog: the longer side goes on.
    let (before, after) = ((q.at - p.at).norm(), (s.at - r.at).norm());
    let forward = || {
        let x = meeting(&p, &into, &s, &direction(&s, &t)?)?;
        (s.free && near(&x, &s)).then(|| build(&six(n, [o, p, Corner::at(x), t])))
    };
    let backward = || {
        let x = meeting(&s, &out, &p, &direction(&o, &p)?)?;
        (p.free && near(&x, &p)).then(|| build(&six(n, [o, Corner::at(x), s, t])))
    };
    if before >= after {
        forward().or_else(backward)
    } else {
        backward().or_else(forward)
    }
}

/// The corners around the change; in a ring of five the first and the last are one.
fn six<const K: usize>(n: usize, corners: [Corner; K]) -> Vec<Corner> {
    let keep = if n == 5 { K - 1 } else { K };
    corners[..keep].to_vec()
}

fn direction(a: &Corner, b: &Corner) -> Option<Vector2<f64>> {
    (b.at - a.at).try_normalize(1e-6)
}

/// Where the lines through two corners meet; `None` for lines at less than about 15 degrees.
fn meeting(
    a: &Corner,
    along: &Vector2<f64>,
    b: &Corner,
    across: &Vector2<f64>,
) -> Option<Point2<f64>> {
    let sine = along.perp(across);
    (sine.abs() > 0.25).then(|| a.at + along * ((b.at - a.at).perp(across) / sine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::facet;

    fn outline(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let ring: Vec<Point3<f64>> = corners
            .iter()
            .map(|&[x, y]| Point3::new(x, y, 5.0))
            .collect();
        let facet = facet(&ring);
        let found = simplified(&[&facet], 0.5);
        let mut ring: Vec<[f64; 2]> = (found[0].outer.iter())
            .map(|p| [p.x, p.y].map(|v| (v * 1e6).round() / 1e6))
            .collect();
        ring.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        ring
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [0.0, 6.0], [8.0, 0.0], [8.0, 6.0]];

    #[test]
    fn jogs_slots_and_cut_corners_go() {
        let jog = [
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, -0.4],
            [8.0, -0.4],
            [8.0, 6.0],
            [0.0, 6.0],
        ];
        assert_eq!(outline(&jog), SQUARE);
        let slot = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 1.0],
            [4.2, 1.0],
            [4.2, 0.0],
            [8.0, 0.0],
            [8.0, 6.0],
            [0.0, 6.0],
        ];
        let flat = outline(&slot);
        assert!(SQUARE.iter().all(|c| flat.contains(c)), "{flat:?}");
        assert!(!flat.contains(&[4.0, 1.0]) && !flat.contains(&[4.2, 1.0]));
        let wedge = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.2, 2.0],
            [4.5, 0.0],
            [8.0, 0.0],
            [8.0, 6.0],
            [0.0, 6.0],
        ];
        assert!(!outline(&wedge).contains(&[4.2, 2.0]));
        let cut = [[0.0, 0.0], [7.7, 0.0], [8.0, 0.3], [8.0, 6.0], [0.0, 6.0]];
        assert_eq!(outline(&cut), SQUARE);
    }

    #[test]
    fn a_zigzag_along_an_eave_is_straightened() {
        let straight = |offset: f64, neighbour: &[Facet]| {
            let eave = [[7.0, -0.3], [5.5, 0.6], [4.0, -0.6], [2.0, 0.8], [0.5, 0.0]];
            let mut ring = vec![[0.0, 0.0], [0.0, 6.0], [8.0, 6.0], [8.0, 0.0]];
            ring.extend(eave.map(|[x, y]| [x, y * offset]));
            let ring: Vec<Point3<f64>> = (ring.iter())
                .map(|&[x, y]| Point3::new(x, y, 5.0))
                .collect();
            let facets = [&[facet(&ring)], neighbour].concat();
            straightened(&facets, 0.25)[0].outer.len()
        };
        assert_eq!(straight(0.3, &[]), 4);
        // One corner is farther away than the tolerance.
        assert!(straight(0.4, &[]) > 4);
        // A neighbour has the corner.
        let beside = [[4.0, -0.6 * 0.2], [4.0, -3.0], [5.0, -3.0]];
        let beside = facet(&beside.map(|[x, y]| Point3::new(x, y, 5.0)));
        assert_eq!(straight(0.2, &[beside]), 5);
    }

    #[test]
    fn corners_beside_all_sides_leave_a_triangle() {
        for n in 3..9 {
            let ring: Vec<Point3<f64>> = (0..n)
                .map(|i| {
                    let (y, x) =
                        crate::math::sin_cos(std::f64::consts::TAU * f64::from(i) / f64::from(n));
                    Point3::new(0.1 * x, 0.1 * y, 5.0)
                })
                .collect();
            assert!(straightened(&[facet(&ring)], 0.25)[0].outer.len() >= 3);
        }
    }

    #[test]
    fn a_step_of_a_metre_stays() {
        let step = [
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, -1.0],
            [8.0, -1.0],
            [8.0, 6.0],
            [0.0, 6.0],
        ];
        assert_eq!(outline(&step).len(), 6);
    }

    #[test]
    fn corners_of_neighbours_stay() {
        let square = |x: f64| {
            let ring = [[x, 0.0], [x + 4.0, 0.0], [x + 4.0, 4.0], [x, 4.0]];
            ring.map(|[x, y]| Point3::new(x, y, 5.0)).to_vec()
        };
        // The neighbour shares the short side at (4, 0) - (4, 0.3).
        let mut left = square(0.0);
        left.insert(2, Point3::new(4.0, 0.3, 5.0));
        let right = [[4.0, 0.0], [7.0, 0.0], [7.0, 0.3], [4.0, 0.3]];
        let (left, right) = (
            facet(&left),
            facet(&right.map(|[x, y]| Point3::new(x, y, 5.0))),
        );
        let found = simplified(&[&left, &right], 0.5);
        assert_eq!(found[0].outer, left.outer);
    }
}
