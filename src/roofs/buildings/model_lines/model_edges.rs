//! The straight edges of a model's facets, each once, with what lies beyond them.

use std::collections::BTreeMap;

use nalgebra::Point3;

use crate::base::geometry::{self, Segment3};
use crate::base::ids::FacetId;
use crate::lines::lines3d::LineOrigin;
use crate::roofs::model::Facet;

/// Facets whose heights differ by less at a common corner meet there, metres.
const MEET_M: f64 = 0.02;

/// A straight edge of the model.
pub(super) struct ModelEdge {
    /// The edge, with the facet on its left.
    pub segment: Segment3,
    /// The facet on its left, and the one that it meets on the right.
    pub facets: Vec<FacetId>,
}

impl ModelEdge {
    /// How a line on this edge came about.
    pub(super) fn origin(&self) -> LineOrigin {
        match self.facets.len() {
            2 => LineOrigin::Intersection,
            _ => LineOrigin::Border,
        }
    }
}

/// The edges of all facets: consecutive collinear sides are one edge, a side that two facets share
/// is listed once, and the feet of walls (a higher facet has the same side) are left out.
pub(super) fn model_edges(facets: &[Facet]) -> Vec<ModelEdge> {
    let at_edges = FacetsAtEdges::new(facets);
    let mut edges = Vec::new();
    for (f, facet) in facets.iter().enumerate() {
        let id = FacetId::from_index(f);
        for ring in facet.rings() {
            for (side, beyond) in straight_edges(ring, |a, b| at_edges.neighbour(id, a, b)) {
                let facets = match beyond {
                    Neighbour::None | Neighbour::Lower => vec![id],
                    Neighbour::Meets(other) if id < other => vec![id, other],
                    Neighbour::Meets(_) | Neighbour::Higher => continue,
                };
                edges.push(ModelEdge {
                    segment: side,
                    facets,
                });
            }
        }
    }
    edges
}

/// What lies on the right of a side.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Neighbour {
    None,
    Lower,
    Higher,
    Meets(FacetId),
}

/// The sides of a ring with what is beyond them, collinear ones with the same neighbour joined.
fn straight_edges(
    ring: &[Point3<f64>],
    beyond: impl Fn(&Point3<f64>, &Point3<f64>) -> Neighbour,
) -> Vec<(Segment3, Neighbour)> {
    let sides: Vec<(Segment3, Neighbour)> = geometry::sides(ring)
        .filter(|[a, b]| (b - a).norm() > 1e-6)
        .map(|[a, b]| (Segment3::new(a, b), beyond(&a, &b)))
        .collect();
    let goes_on = |a: &(Segment3, Neighbour), b: &(Segment3, Neighbour)| {
        a.1 == b.1 && a.0.direction().dot(&b.0.direction()) > 1.0 - 1e-6
    };
    // From a corner on, so that no side is cut where the ring happens to begin.
    let count = sides.len();
    let corner = (0..count).find(|&i| !goes_on(&sides[(i + count - 1) % count.max(1)], &sides[i]));
    let mut joined: Vec<(Segment3, Neighbour)> = Vec::new();
    for k in 0..count {
        let side = sides[(corner.unwrap_or(0) + k) % count];
        match joined.last_mut() {
            Some(last) if goes_on(last, &side) => last.0 = Segment3::new(last.0.p0, side.0.p1),
            _ => joined.push(side),
        }
    }
    joined
}

/// Bits of two plan positions: facets of one building share corners exactly.
type PlanEdgeKey = [u64; 4];

/// Which facets have a side, and at which heights.
struct FacetsAtEdges {
    sides: BTreeMap<PlanEdgeKey, Vec<(FacetId, [f64; 2])>>,
}

impl FacetsAtEdges {
    fn new(facets: &[Facet]) -> Self {
        let mut sides: BTreeMap<PlanEdgeKey, Vec<(FacetId, [f64; 2])>> = BTreeMap::new();
        for (f, facet) in facets.iter().enumerate() {
            for [a, b] in facet.rings().flat_map(|ring| geometry::sides(ring)) {
                let owner = (FacetId::from_index(f), [a.z, b.z]);
                sides.entry(key(&a, &b)).or_default().push(owner);
            }
        }
        Self { sides }
    }

    /// What is on the other side of a side of `facet`.
    fn neighbour(&self, facet: FacetId, a: &Point3<f64>, b: &Point3<f64>) -> Neighbour {
        let reversed = self.sides.get(&key(b, a)).into_iter().flatten();
        let Some((other, [zb, za])) = reversed.copied().find(|(f, _)| *f != facet) else {
            return Neighbour::None;
        };
        let (da, db) = (za - a.z, zb - b.z);
        if da.abs() < MEET_M && db.abs() < MEET_M {
            Neighbour::Meets(other)
        } else if da + db > 0.0 {
            Neighbour::Higher
        } else {
            Neighbour::Lower
        }
    }
}

fn key(a: &Point3<f64>, b: &Point3<f64>) -> PlanEdgeKey {
    [a.x, a.y, b.x, b.y].map(f64::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing;

    #[test]
    fn of_two_roofs_side_by_side_the_higher_one_has_the_edge() {
        let flat = |x0: f64, x1: f64, z: f64| {
            let corners = [(x0, 0.0), (x1, 0.0), (x1, 6.0), (x0, 6.0)];
            testing::facet(&corners.map(|(x, y)| Point3::new(x, y, z)))
        };
        let edges = model_edges(&[flat(0.0, 4.0, 5.0), flat(4.0, 9.0, 8.0)]);
        // Three sides of the lower roof, four of the higher one; where they touch, the higher one's
        // alone.
        assert_eq!(edges.len(), 7);
        let between = |e: &&ModelEdge| e.segment.p0.x == 4.0 && e.segment.p1.x == 4.0;
        let shared: Vec<&ModelEdge> = edges.iter().filter(between).collect();
        assert_eq!(shared.len(), 1);
        assert_eq!(shared[0].facets, [FacetId(1)]);
        // At one height they meet, and the edge is listed once with both.
        let edges = model_edges(&[flat(0.0, 4.0, 5.0), flat(4.0, 9.0, 5.0)]);
        let shared: Vec<&ModelEdge> = edges.iter().filter(between).collect();
        assert_eq!(shared.len(), 1);
        assert_eq!(shared[0].facets, [FacetId(0), FacetId(1)]);
    }
}
