//! Closed rings from the directed edges that bound a region in plan.
//!
//! An edge runs with the region on its left, so outer rings come out counter-clockwise and holes
//! clockwise. Where a region touches itself at a point, rings turn there so as to keep to the same
//! stretch of outside: each hole and the outer ring then pass the point once and all rings stay
//! simple.

use std::collections::BTreeMap;

use nalgebra::Point2;

use crate::base::geometry::{contains, sides, signed_area};
use crate::base::math;

/// A connected region: the outer ring (counter-clockwise), then its holes (clockwise), as indices
/// of plan vertices.
pub(super) type PlanRegion = Vec<Vec<u32>>;

/// The regions to the left of `edges`. Edges that occur in both directions cancel; edges that
/// close no ring, and holes outside every region, are left out.
pub(super) fn regions_from_edges(
    edges: &[(u32, u32)],
    positions: &[Point2<f64>],
) -> Vec<PlanRegion> {
    let mut net: BTreeMap<(u32, u32), i32> = BTreeMap::new();
    for &(a, b) in edges {
        *net.entry((a, b)).or_default() += 1;
        *net.entry((b, a)).or_default() -= 1;
    }
    let mut open: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    // An edge that is run through twice closes two rings; as one it would leave both open.
    for ((a, b), times) in net {
        open.entry(a).or_default().extend((0..times).map(|_| b));
    }
    let mut rings = Vec::new();
    while let Some((&start, _)) = open.iter().find(|(_, ends)| !ends.is_empty()) {
        if let Some(ring) = trace_ring(start, &mut open, positions) {
            split_lobes(ring, &mut rings);
        }
    }
    nest(rings, positions)
}

/// Signed area of a ring, m^2: positive when it runs counter-clockwise.
pub(super) fn area(ring: &[u32], positions: &[Point2<f64>]) -> f64 {
    signed_area(ring.iter().map(|&v| positions[v as usize]))
}

/// The directed edges of a closed ring.
pub(super) fn ring_edges(ring: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    sides(ring).map(|[a, b]| (a, b))
}

/// Follows edges from `start`, taking them out of `open`, until the ring closes.
fn trace_ring(
    start: u32,
    open: &mut BTreeMap<u32, Vec<u32>>,
    positions: &[Point2<f64>],
) -> Option<Vec<u32>> {
    let mut ring = vec![start];
    let first = open.get_mut(&start)?.pop()?;
    let (mut from, mut at) = (start, first);
    // A ring ends on the edge that started it, not merely at its first vertex: the ring may pass
    // there.
    loop {
        let ends = open.get(&at).map_or(&[][..], Vec::as_slice);
        let back = angle(at, from, positions);
        let next = ends
            .iter()
            .copied()
            .chain((at == start).then_some(first))
            .min_by(|&p, &q| {
                turn(back, angle(at, p, positions)).total_cmp(&turn(back, angle(at, q, positions)))
            })?;
        if at == start && next == first {
            return Some(ring);
        }
        let ends = open.get_mut(&at)?;
        ends.remove(ends.iter().position(|&end| end == next)?);
        ring.push(at);
        (from, at) = (at, next);
    }
}

/// Cuts a ring where it passes a vertex again: it goes around parts that touch there only.
fn split_lobes(ring: Vec<u32>, rings: &mut Vec<Vec<u32>>) {
    let mut path: Vec<u32> = Vec::with_capacity(ring.len());
    for vertex in ring {
        if let Some(i) = path.iter().position(|&v| v == vertex) {
            rings.push(path.split_off(i));
        }
        path.push(vertex);
    }
    rings.push(path);
}

/// Azimuth of the edge from `a` to `b`, radians.
fn angle(a: u32, b: u32, positions: &[Point2<f64>]) -> f64 {
    let d = positions[b as usize] - positions[a as usize];
    math::atan2(d.y, d.x)
}

/// Counter-clockwise turn from one azimuth to another, in (0, 2 pi].
pub(super) fn turn(from: f64, to: f64) -> f64 {
    let t = to - from;
    if t > 0.0 {
        t
    } else {
        t + std::f64::consts::TAU
    }
}

/// Puts every clockwise ring into the smallest counter-clockwise one around it.
fn nest(rings: Vec<Vec<u32>>, positions: &[Point2<f64>]) -> Vec<PlanRegion> {
    let (outers, holes): (Vec<_>, Vec<_>) = rings
        .into_iter()
        .filter(|ring| ring.len() >= 3)
        .partition(|ring| area(ring, positions) > 0.0);
    let mut regions: Vec<PlanRegion> = outers.into_iter().map(|ring| vec![ring]).collect();
    for hole in holes {
        // A hole may share vertices with its outer ring but no edge, so an edge's middle is inside.
        let (a, b) = (positions[hole[0] as usize], positions[hole[1] as usize]);
        let inside = nalgebra::center(&a, &b);
        let around = |ring: &[u32]| {
            let sides = sides(ring).map(|side| side.map(|v| positions[v as usize]));
            contains(sides, &inside)
        };
        let home = regions
            .iter_mut()
            .filter(|region| around(&region[0]))
            .min_by(|p, q| area(&p[0], positions).total_cmp(&area(&q[0], positions)));
        if let Some(region) = home {
            region.push(hole);
        }
    }
    regions
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(rings: &[&[u32]]) -> Vec<(u32, u32)> {
        rings.iter().flat_map(|ring| ring_edges(ring)).collect()
    }

    #[test]
    fn a_hole_that_touches_the_outline_stays_a_hole() {
        // A square whose hole (a triangle) touches the corner 0.
        let positions = [
            Point2::new(0.0, 0.0),
            Point2::new(4.0, 0.0),
            Point2::new(4.0, 4.0),
            Point2::new(0.0, 4.0),
            Point2::new(1.0, 2.0),
            Point2::new(2.0, 1.0),
        ];
        // One ring that passes corner 0 twice, as an outline with a pinch comes in.
        let pinched: &[u32] = &[0, 1, 2, 3, 0, 4, 5];
        let regions = regions_from_edges(&edges(&[pinched]), &positions);
        assert_eq!(regions.len(), 1);
        assert_eq!(regions[0].len(), 2);
        assert_eq!(area(&regions[0][0], &positions), 16.0);
        assert_eq!(area(&regions[0][1], &positions), -1.5);
    }

    #[test]
    fn two_lobes_that_touch_are_two_regions_and_spikes_vanish() {
        let positions = [
            Point2::new(0.0, 0.0),
            Point2::new(1.0, 0.0),
            Point2::new(1.0, 1.0),
            Point2::new(2.0, 1.0),
            Point2::new(2.0, 2.0),
            Point2::new(5.0, 5.0),
        ];
        let regions = regions_from_edges(&edges(&[&[0, 1, 2], &[2, 3, 4, 5, 4]]), &positions);
        assert_eq!(regions, [[vec![2, 3, 4]], [vec![0, 1, 2]]]);
    }
}
