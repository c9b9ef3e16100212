//! Closed outlines of facets from labelled cells (B99 4.3, figures 22 and 23).
//!
//! Cells of one plane that touch form a facet; its outline runs along the cells' borders and may be
//! concave or have holes. Where facets meet they share vertices. A vertex at which planes of about
//! the same height meet is moved to where these planes really intersect, the counterpart of figure
//! 22's "two close end points are replaced by the intersection of the two lines".

use std::collections::BTreeMap;

use nalgebra::{Matrix2, Point2, Vector2};

use super::borders::Arrangement;
use crate::base::geometry::{Plane, contains, sides, signed_area};
use crate::base::labelling::NO_PLANE;

/// A facet in plan, before it is lifted onto its plane.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outline {
    /// The plane's index.
    pub plane: u32,
    /// Outer ring, counter-clockwise vertex indices.
    pub outer: Vec<usize>,
    /// Holes, clockwise.
    pub holes: Vec<Vec<usize>>,
    /// The cells that it covers.
    pub cells: Vec<usize>,
}

/// Facets in plan and the plan positions that their vertex indices refer to.
#[derive(Clone, Debug, Default)]
pub(super) struct Delineation {
    /// Vertices, metres.
    pub vertices: Vec<Point2<f64>>,
    /// One outline a facet.
    pub outlines: Vec<Outline>,
}

/// Bends smaller than this are smoothed away, metres: about the width of an edge in the images.
const SMALLEST_BEND_M: f64 = 0.12;

/// The outlines of all facets of a labelling.
pub(super) fn delineate(
    arrangement: &Arrangement,
    labels: &[u32],
    planes: &[Plane],
) -> Delineation {
    let component = arrangement.components(labels);
    let borders = border_edges(arrangement, labels, &component);
    let keep = corner_vertices(arrangement, &borders);
    let mut outlines = Vec::new();
    for (root, edges) in group_by_component(&borders) {
        let cells: Vec<usize> = (0..arrangement.cells)
            .filter(|&c| component[c] == root)
            .collect();
        let rings = rings(&edges, &arrangement.vertices)
            .into_iter()
            .map(|ring| ring.into_iter().filter(|&v| keep[v]).collect::<Vec<_>>())
            .filter(|ring| ring.len() >= 3);
        outlines.extend(
            nest(rings, &arrangement.vertices)
                .into_iter()
                .map(|(outer, holes)| Outline {
                    plane: labels[root],
                    outer,
                    holes,
                    cells: cells.clone(),
                }),
        );
    }
    let vertices = move_to_intersections(&arrangement.vertices, &outlines, planes);
    join_coinciding(&vertices, &mut outlines);
    Delineation { vertices, outlines }
}

/// Vertices that were moved onto each other become one; rings lose what collapses with them.
fn join_coinciding(vertices: &[Point2<f64>], outlines: &mut Vec<Outline>) {
    /// Nearer than the arrangement tells crossings apart, metres.
    const SAME_VERTEX_M: f64 = 0.05;
    let mut used: Vec<usize> = outlines
        .iter()
        .flat_map(|o| o.outer.iter().chain(o.holes.iter().flatten()))
        .copied()
        .collect();
    used.sort_unstable();
    used.dedup();
    let mut first: BTreeMap<usize, usize> = BTreeMap::new();
    let mut kept: Vec<usize> = Vec::new();
    for v in used {
        let same = kept
            .iter()
            .copied()
            .find(|&k| (vertices[k] - vertices[v]).norm() < SAME_VERTEX_M);
        if same.is_none() {
            kept.push(v);
        }
        first.insert(v, same.unwrap_or(v));
    }
    for o in outlines.iter_mut() {
        for ring in std::iter::once(&mut o.outer).chain(&mut o.holes) {
            ring.iter_mut().for_each(|v| *v = first[v]);
            remove_spikes(ring);
        }
        o.holes.retain(|h| h.len() >= 3);
    }
    outlines.retain(|o| o.outer.len() >= 3 && is_counter_clockwise(&o.outer, vertices));
}

/// Takes out repeated vertices and runs to a vertex and straight back.
fn remove_spikes(ring: &mut Vec<usize>) {
    loop {
        let n = ring.len();
        if n < 3 {
            return;
        }
        let repeated = (0..n).find(|&i| ring[i] == ring[(i + 1) % n]);
        let spike = (0..n).find(|&i| ring[i] == ring[(i + 2) % n]);
        match (repeated, spike) {
            (Some(i), _) => drop(ring.remove(i)),
            (None, Some(i)) => drop(ring.remove((i + 1) % n)),
            (None, None) => return,
        }
    }
}

/// A piece of a facet's outline with the facet on its left, and what lies to its right.
#[derive(Clone, Copy)]
struct BorderEdge {
    component: usize,
    a: usize,
    b: usize,
}

fn border_edges(arrangement: &Arrangement, labels: &[u32], component: &[usize]) -> Vec<BorderEdge> {
    let mut borders = Vec::new();
    for e in arrangement
        .edges
        .iter()
        .filter(|e| component[e.left] != component[e.right])
    {
        if labels[e.left] != NO_PLANE {
            borders.push(BorderEdge {
                component: component[e.left],
                a: e.a,
                b: e.b,
            });
        }
        if labels[e.right] != NO_PLANE {
            borders.push(BorderEdge {
                component: component[e.right],
                a: e.b,
                b: e.a,
            });
        }
    }
    borders
}

fn group_by_component(borders: &[BorderEdge]) -> BTreeMap<usize, Vec<(usize, usize)>> {
    let mut groups: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
    for e in borders {
        groups.entry(e.component).or_default().push((e.a, e.b));
    }
    groups
}

/// Chains directed edges into rings; where a ring touches itself it is split.
fn rings(edges: &[(usize, usize)], vertices: &[Point2<f64>]) -> Vec<Vec<usize>> {
    let mut outgoing: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for &(a, b) in edges {
        outgoing.entry(a).or_default().push(b);
    }
    let mut rings = Vec::new();
    while let Some((&start, _)) = outgoing.iter().find(|(_, ends)| !ends.is_empty()) {
        let mut ring = vec![start];
        let mut previous: Option<usize> = None;
        let mut at = start;
        loop {
            let ends = outgoing.get_mut(&at).filter(|e| !e.is_empty());
            let Some(ends) = ends else { break };
            let next = sharpest_left(previous, at, ends, vertices);
            ends.retain(|&e| e != next);
            if next == start {
                break;
            }
            ring.push(next);
            previous = Some(at);
            at = next;
        }
        rings.push(ring);
    }
    rings
}

/// Of the edges that leave `at`, the one that turns most to the left: it bounds the same corner of
/// the facet.
fn sharpest_left(
    previous: Option<usize>,
    at: usize,
    ends: &[usize],
    vertices: &[Point2<f64>],
) -> usize {
    let Some(previous) = previous else {
        return ends[0];
    };
    let back = vertices[previous] - vertices[at];
    let clockwise_from_back = |end: usize| {
        let d = vertices[end] - vertices[at];
        let angle = crate::base::math::atan2(d.perp(&back), d.dot(&back));
        if angle <= 0.0 {
            angle + std::f64::consts::TAU
        } else {
            angle
        }
    };
    *ends
        .iter()
        .min_by(|a, b| {
            clockwise_from_back(**a)
                .total_cmp(&clockwise_from_back(**b))
                .then(a.cmp(b))
        })
        .expect("at least one edge leaves")
}

/// Outer rings with the holes inside them.
fn nest(
    rings: impl Iterator<Item = Vec<usize>>,
    vertices: &[Point2<f64>],
) -> Vec<(Vec<usize>, Vec<Vec<usize>>)> {
    let (outer, holes): (Vec<_>, Vec<_>) = rings.partition(|r| is_counter_clockwise(r, vertices));
    let mut nested: Vec<(Vec<usize>, Vec<Vec<usize>>)> =
        outer.into_iter().map(|o| (o, Vec::new())).collect();
    for hole in holes {
        let owner = nested.iter_mut().find(|(o, _)| {
            let around = || sides(o).map(|side| side.map(|v| vertices[v]));
            let mut others = hole.iter().filter(|v| !o.contains(v));
            others.any(|v| contains(around(), &vertices[*v]))
        });
        if let Some((_, holes)) = owner {
            holes.push(hole);
        }
    }
    nested
}

fn is_counter_clockwise(ring: &[usize], vertices: &[Point2<f64>]) -> bool {
    signed_area(ring.iter().map(|&v| vertices[v])) > 0.0
}

/// Which vertices stay: junctions of borders, and bends of the chains between them (Douglas and
/// Peucker 1973). Chains are shared by the facets on both sides, so both keep the same vertices.
fn corner_vertices(arrangement: &Arrangement, borders: &[BorderEdge]) -> Vec<bool> {
    let mut links: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for e in borders {
        links.entry(e.a).or_default().push(e.b);
        links.entry(e.b).or_default().push(e.a);
    }
    for ends in links.values_mut() {
        ends.sort();
        ends.dedup();
    }
    let mut keep = vec![false; arrangement.vertices.len()];
    let mut visited: std::collections::BTreeSet<(usize, usize)> = std::collections::BTreeSet::new();
    let junctions: Vec<usize> = links
        .iter()
        .filter(|(_, ends)| ends.len() != 2)
        .map(|(&v, _)| v)
        .collect();
    // Rings without a junction start anywhere, after all chains between junctions.
    let starts = junctions
        .iter()
        .chain(links.keys())
        .copied()
        .collect::<Vec<_>>();
    for start in starts {
        for &second in &links[&start] {
            if visited.contains(&(start, second)) {
                continue;
            }
            let mut chain = vec![start, second];
            visited.insert((start, second));
            visited.insert((second, start));
            while links[&chain[chain.len() - 1]].len() == 2 && chain[chain.len() - 1] != start {
                let (at, from) = (chain[chain.len() - 1], chain[chain.len() - 2]);
                let next = links[&at]
                    .iter()
                    .copied()
                    .find(|&v| v != from)
                    .expect("two links");
                visited.insert((at, next));
                visited.insert((next, at));
                chain.push(next);
            }
            mark_bends(&chain, &arrangement.vertices, &mut keep);
        }
    }
    keep
}

fn mark_bends(chain: &[usize], vertices: &[Point2<f64>], keep: &mut [bool]) {
    let (first, last) = (chain[0], chain[chain.len() - 1]);
    keep[first] = true;
    keep[last] = true;
    if chain.len() < 3 {
        return;
    }
    let (a, b) = (vertices[first], vertices[last]);
    let d: Vector2<f64> = b - a;
    let distance = |v: usize| {
        let r = vertices[v] - a;
        // A closed chain has no base line: the farthest vertex splits it.
        if d.norm() < 1e-9 {
            r.norm()
        } else {
            d.perp(&r).abs() / d.norm()
        }
    };
    let (split, far) = (1..chain.len() - 1)
        .map(|i| (i, distance(chain[i])))
        .max_by(|x, y| x.1.total_cmp(&y.1).then(y.0.cmp(&x.0)))
        .expect("at least one vertex in between");
    if far > SMALLEST_BEND_M {
        mark_bends(&chain[..=split], vertices, keep);
        mark_bends(&chain[split..], vertices, keep);
    }
}

/// Planes whose heights at a vertex differ by less than this meet there, metres.
const SAME_HEIGHT: f64 = 0.35;
/// A vertex moves at most this far, metres.
const MAX_MOVE: f64 = 0.4;

/// Moves every vertex at which planes of about the same height meet to their intersection.
fn move_to_intersections(
    vertices: &[Point2<f64>],
    outlines: &[Outline],
    planes: &[Plane],
) -> Vec<Point2<f64>> {
    let mut incident: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for o in outlines {
        for &v in o.outer.iter().chain(o.holes.iter().flatten()) {
            let list = incident.entry(v).or_default();
            if !list.contains(&o.plane) {
                list.push(o.plane);
            }
        }
    }
    let mut moved = vertices.to_vec();
    for (v, list) in incident {
        if let Some(p) = common_point(&vertices[v], &list, planes) {
            moved[v] = p;
        }
    }
    moved
}

/// The shortest solution of the normal equations `normal x = right` in the directions that they
/// determine: planes that are nearly parallel do not tell where they meet. `None` if they determine
/// none.
fn least_squares_step(normal: &Matrix2<f64>, right: &Vector2<f64>) -> Option<Vector2<f64>> {
    /// Square of the least difference in slope: 5 %.
    const LEAST_SLOPE_SQUARED: f64 = 0.05 * 0.05;
    let half = 0.5 * normal.trace();
    let apart = Vector2::new(0.5 * (normal.m11 - normal.m22), normal.m12).norm();
    let [low, high] = [half - apart, half + apart];
    if low > LEAST_SLOPE_SQUARED {
        return Some(normal.try_inverse()? * right);
    }
    // What is left without the weaker axis is a multiple of the projection onto the stronger one.
    let onto_stronger = (normal - Matrix2::identity() * low) / (high - low);
    (high > LEAST_SLOPE_SQUARED).then(|| onto_stronger * right / high)
}

/// The plan position nearest to `p` at which the planes that meet near it have one height.
fn common_point(p: &Point2<f64>, list: &[u32], planes: &[Plane]) -> Option<Point2<f64>> {
    let mut at: Vec<(f64, &Plane)> = list
        .iter()
        .map(|&i| &planes[i as usize])
        .map(|q| (q.z_at(p.x, p.y), q))
        .collect();
    at.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Differences of neighbouring heights within a cluster: slope difference . step = - height
    // difference.
    let rows: Vec<(Vector2<f64>, f64)> = at
        .windows(2)
        .filter(|w| w[1].0 - w[0].0 < SAME_HEIGHT)
        .map(|w| {
            let slope = |q: &Plane| -q.normal.xy() / q.normal.z;
            (slope(w[1].1) - slope(w[0].1), w[0].0 - w[1].0)
        })
        .collect();
    let normal = rows.iter().map(|(a, _)| a * a.transpose()).sum();
    let step = least_squares_step(&normal, &rows.iter().map(|(a, b)| a * *b).sum())?;
    (step.norm() <= MAX_MOVE).then(|| p + step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn a_step_is_taken_only_where_the_slopes_tell() {
        let step = |rows: &[([f64; 2], f64)]| {
            let rows: Vec<_> = rows.iter().map(|(a, b)| (Vector2::from(*a), *b)).collect();
            let normal = rows.iter().map(|(a, _)| a * a.transpose()).sum();
            least_squares_step(&normal, &rows.iter().map(|(a, b)| a * *b).sum())
        };
        let near = |step: Option<Vector2<f64>>, x: f64, y: f64| {
            (step.unwrap() - Vector2::new(x, y)).norm() < 1e-9
        };
        // 0.6 x + 0.8 y = 1 alone, then with x = 2.
        let one = ([0.6, 0.8], 1.0);
        assert!(near(step(&[one]), 0.6, 0.8));
        assert!(near(step(&[one, ([1.0, 0.0], 2.0)]), 2.0, -0.25));
        // A second pair of slopes that hardly differ determines nothing.
        assert!(near(
            step(&[([1.0, 0.0], 2.0), ([0.0, 0.04], 1.0)]),
            2.0,
            0.0
        ));
        assert!(step(&[([0.03, 0.03], 1.0)]).is_none());
        assert!(step(&[]).is_none());
    }

    #[test]
    fn a_touching_ring_is_split_into_simple_ones() {
        // Two triangles that share vertex 0, as one set of directed edges.
        let vertices: Vec<Point2<f64>> = [
            [0.0, 0.0],
            [2.0, -1.0],
            [2.0, 1.0],
            [-2.0, 1.0],
            [-2.0, -1.0],
        ]
        .map(Point2::from)
        .to_vec();
        let found = rings(&[(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)], &vertices);
        assert_eq!(found.len(), 2);
        assert!(
            found
                .iter()
                .all(|r| r.len() == 3 && is_counter_clockwise(r, &vertices))
        );
    }

    #[test]
    fn spikes_and_repetitions_leave_a_ring() {
        let mut ring = vec![1, 2, 2, 3, 7, 3, 4, 1];
        remove_spikes(&mut ring);
        assert_eq!(ring, [1, 2, 3, 4]);
    }

    #[test]
    fn three_planes_meet_in_one_point() {
        let apex = Point3::new(5.0, 6.0, 9.0);
        let planes: Vec<Plane> = [[1.0, 0.0, 1.5], [-1.0, 0.1, 1.5], [0.0, -1.0, 2.0]]
            .iter()
            .map(|n| Plane::from_point_normal(&apex, &Vector3::from(*n)).unwrap())
            .collect();
        let found = common_point(&Point2::new(5.1, 5.9), &[0, 1, 2], &planes).unwrap();
        assert!((found - apex.xy()).norm() < 1e-9);
        // Two planes: the nearest point of their line.
        let on_line = common_point(&Point2::new(5.1, 5.9), &[0, 1], &planes).unwrap();
        let (a, b) = (
            planes[0].z_at(on_line.x, on_line.y),
            planes[1].z_at(on_line.x, on_line.y),
        );
        assert!((a - b).abs() < 1e-9);
        // A step stays a step.
        let lower = Plane {
            d: planes[1].d + 2.0,
            ..planes[1]
        };
        assert!(common_point(&Point2::new(5.0, 6.0), &[0, 1], &[planes[0], lower]).is_none());
    }
}
