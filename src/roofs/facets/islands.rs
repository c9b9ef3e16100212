//! Islands of the labelling too small to be a facet or a hole (B99 4.3).
//!
//! Where texture is weak, a few cells take another plane than all around them, or none. Such an
//! island is smaller than the least facet and cannot be verified: it joins the neighbour with which
//! it shares most of its border.

use std::collections::BTreeMap;

use super::borders::Arrangement;

/// Labels in which no facet, and no hole within facets, has less than `min_area_m2` of plan area.
pub(super) fn without_islands(
    arrangement: &Arrangement,
    mut labels: Vec<u32>,
    min_area_m2: f64,
) -> Vec<u32> {
    // Islands that touch each other are joined one at a time; a few rounds settle all.
    const JOINING_ROUNDS: usize = 4;
    for _ in 0..JOINING_ROUNDS {
        let islands = Islands::new(arrangement, &labels);
        let mut changed = false;
        let small = islands
            .areas
            .iter()
            .filter(|(_, area)| **area < min_area_m2);
        for (&island, _) in small {
            let Some(label) = islands.label_around(island, &labels) else {
                continue;
            };
            changed = true;
            (labels.iter_mut().zip(&islands.of_cell))
                .filter(|(_, of)| **of == island)
                .for_each(|(l, _)| *l = label);
        }
        if !changed {
            break;
        }
    }
    labels
}

/// Connected cells of one label.
struct Islands {
    /// The lowest cell of each cell's island names the island.
    of_cell: Vec<usize>,
    /// Plan area, square metres.
    areas: BTreeMap<usize, f64>,
    /// Length of the common border with each neighbouring island, metres.
    borders: BTreeMap<usize, BTreeMap<usize, f64>>,
}

impl Islands {
    fn new(arrangement: &Arrangement, labels: &[u32]) -> Self {
        let of_cell = arrangement.components(labels);
        let mut areas = BTreeMap::<usize, f64>::new();
        for (&island, area) in of_cell.iter().zip(&arrangement.areas) {
            *areas.entry(island).or_default() += area;
        }
        let mut borders = BTreeMap::<usize, BTreeMap<usize, f64>>::new();
        for e in &arrangement.edges {
            let (left, right) = (of_cell[e.left], of_cell[e.right]);
            if left != right {
                let length = (arrangement.vertices[e.b] - arrangement.vertices[e.a]).norm();
                for (one, other) in [(left, right), (right, left)] {
                    *borders.entry(one).or_default().entry(other).or_default() += length;
                }
            }
        }
        Self {
            of_cell,
            areas,
            borders,
        }
    }

    /// The label with which an island shares most of its border.
    fn label_around(&self, island: usize, labels: &[u32]) -> Option<u32> {
        let mut around = BTreeMap::<u32, f64>::new();
        for (&other, &length) in self.borders.get(&island)? {
            *around.entry(labels[other]).or_default() += length;
        }
        around
            .into_iter()
            .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
            .map(|(label, _)| label)
            .filter(|&label| label != labels[island])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::labelling::NO_PLANE;
    use crate::roofs::facets::borders::{Border, BorderKind};
    use nalgebra::Point2;

    /// A square of 10 m within one of 30 m, with a square of `side` in its middle.
    fn nested(side: f64) -> (Arrangement, Vec<u32>) {
        let square = |low: f64, high: f64| {
            let corners = [(low, low), (high, low), (high, high), (low, high)];
            (0..4).map(move |i| {
                let (a, b) = (corners[i], corners[(i + 1) % 4]);
                Border {
                    kind: BorderKind::Real,
                    a: Point2::new(a.0, a.1),
                    b: Point2::new(b.0, b.1),
                }
            })
        };
        let half = 0.5 * side;
        let borders: Vec<Border> = square(0.0, 30.0)
            .chain(square(10.0, 20.0))
            .chain(square(15.0 - half, 15.0 + half))
            .collect();
        let arrangement = Arrangement::new(&borders);
        let labels = (arrangement.areas.iter())
            .map(|a| {
                if (*a - (100.0 - side * side)).abs() < 1e-6 {
                    7
                } else {
                    NO_PLANE
                }
            })
            .collect();
        (arrangement, labels)
    }

    fn covered(arrangement: &Arrangement, labels: &[u32]) -> f64 {
        (arrangement.areas.iter().zip(labels))
            .filter(|(_, l)| **l == 7)
            .map(|(a, _)| a)
            .sum()
    }

    #[test]
    fn a_small_hole_closes_and_a_courtyard_stays() {
        for (side, expected) in [(0.8, 100.0), (3.0, 91.0)] {
            let (arrangement, labels) = nested(side);
            let labels = without_islands(&arrangement, labels, 1.5);
            assert!((covered(&arrangement, &labels) - expected).abs() < 1e-6);
        }
    }

    #[test]
    fn a_facet_that_is_too_small_goes() {
        let (arrangement, labels) = nested(0.8);
        let swapped = labels.iter().map(|l| if *l == 7 { NO_PLANE } else { 7 });
        // Only the inner square keeps its plane, the frame outside has none.
        let labels: Vec<u32> = (swapped.zip(&arrangement.areas))
            .map(|(l, area)| if *area > 2.0 { NO_PLANE } else { l })
            .collect();
        assert!(covered(&arrangement, &labels) > 0.5);
        let labels = without_islands(&arrangement, labels, 1.5);
        assert_eq!(covered(&arrangement, &labels), 0.0);
    }
}
