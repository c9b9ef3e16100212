//! The closed boundaries of the regions, from their vectors.

use std::collections::BTreeMap;

use super::segmentation::Vector;

/// The rings of every region: vectors chained head to tail with the region to their right.
pub(crate) fn rings(vectors: &[Vector], regions: usize) -> Vec<Vec<Vec<[i32; 2]>>> {
    let mut of_region: Vec<Vec<[[i32; 2]; 2]>> = vec![Vec::new(); regions];
    for v in vectors {
        let [a, b] = v.ends;
        if let Some(r) = v.sides[1] {
            of_region[r as usize].push([a, b]);
        }
        if let Some(l) = v.sides[0] {
            of_region[l as usize].push([b, a]);
        }
    }
    of_region.iter().map(|directed| chain(directed)).collect()
}

fn chain(directed: &[[[i32; 2]; 2]]) -> Vec<Vec<[i32; 2]>> {
    let mut starts: BTreeMap<[i32; 2], Vec<usize>> = BTreeMap::new();
    for (k, [a, _]) in directed.iter().enumerate() {
        starts.entry(*a).or_default().push(k);
    }
    let mut used = vec![false; directed.len()];
    let mut rings = Vec::new();
    for first in 0..directed.len() {
        let mut ring = Vec::new();
        let mut next = Some(first).filter(|&k| !used[k]);
        while let Some(k) = next {
            used[k] = true;
            let [a, b] = directed[k];
            ring.push(a);
            next = starts
                .get(&b)
                .into_iter()
                .flatten()
                .copied()
                .filter(|&n| !used[n])
                .max_by(|&m, &n| {
                    let (m, n) = (turn(a, b, directed[m][1]), turn(a, b, directed[n][1]));
                    m.total_cmp(&n)
                });
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    rings
}

/// How far the path a - b - c turns to the right, radians: at a node where a region meets itself,
/// the sharpest right turn keeps its parts apart.
fn turn(a: [i32; 2], b: [i32; 2], c: [i32; 2]) -> f64 {
    let d = |p: [i32; 2], q: [i32; 2]| (f64::from(q[0] - p[0]), f64::from(q[1] - p[1]));
    let (u, v) = (d(a, b), d(b, c));
    crate::base::math::atan2(u.0 * v.1 - u.1 * v.0, u.0 * v.0 + u.1 * v.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::signed_area;

    #[test]
    fn a_region_in_a_region_gives_a_hole() {
        let square = |low: i32, high: i32| {
            [
                [low, low],
                [high, low],
                [high, high],
                [low, high],
                [low, low],
            ]
        };
        let mut vectors = Vec::new();
        for (corners, sides) in [
            (square(0, 9), [None, Some(0)]),
            (square(3, 6), [Some(0), Some(1)]),
        ] {
            for w in corners.windows(2) {
                vectors.push(Vector {
                    ends: [w[0], w[1]],
                    sides,
                });
            }
        }
        let found = rings(&vectors, 2);
        assert_eq!((found[0].len(), found[1].len()), (2, 1));
        assert_eq!(found[1][0], [[3, 3], [6, 3], [6, 6], [3, 6]]);
        let area = |ring: &[[i32; 2]]| signed_area(ring.iter().map(|p| p.map(f64::from).into()));
        assert_eq!((area(&found[0][0]), area(&found[0][1])), (81.0, -9.0));
    }
}
