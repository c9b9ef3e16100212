//! The straight sides of a building's outline, below each of which one wall stands.

use std::collections::BTreeSet;

use nalgebra::{Point2, Point3, Vector2};

use crate::base::geometry::sides;
use crate::base::math::hypot;
use crate::roofs::model::Facet;

/// Two edges are one side where the sine of their turn is less than this.
const TURN_SINE: f64 = 0.02;
/// Their heights differ by less than this where they meet, metres: a higher roof has eaves, and a
/// wall, of its own.
pub(crate) const STEP_HEIGHT_M: f64 = 0.1;

/// A straight stretch of a building's outline; the building is to its left.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// Corners along it, at the height of the roof's rim, metres: two at least.
    pub rim: Vec<Point3<f64>>,
}

impl Side {
    /// Its first corner.
    pub fn start(&self) -> Point3<f64> {
        self.rim[0]
    }

    /// Its last corner.
    pub fn end(&self) -> Point3<f64> {
        self.rim[self.rim.len() - 1]
    }

    /// Direction in plan, of length 1.
    pub fn along(&self) -> Vector2<f64> {
        (self.end() - self.start()).xy().normalize()
    }

    /// To the building in plan, of length 1.
    pub fn inward(&self) -> Vector2<f64> {
        left_of(&self.along())
    }

    /// Length in plan, metres.
    pub fn length(&self) -> f64 {
        (self.end() - self.start()).xy().norm()
    }

    /// Height of the rim so many metres along it; `None` beyond its ends.
    pub fn rim_at(&self, s: f64) -> Option<f64> {
        let (start, along) = (self.start().xy(), self.along());
        let place = |p: &Point3<f64>| (p.xy() - start).dot(&along);
        self.rim.windows(2).find_map(|ends| {
            let (a, b) = (place(&ends[0]), place(&ends[1]));
            let rise = (ends[1].z - ends[0].z) / (b - a);
            (a <= s && s <= b && a < b).then(|| ends[0].z + rise * (s - a))
        })
    }

    /// Is it an eave? Otherwise it is the rake of a gable.
    pub fn is_level(&self) -> bool {
        let z = |f: fn(f64, f64) -> f64, start| self.rim.iter().map(|p| p.z).fold(start, f);
        let rise = z(f64::max, f64::MIN) - z(f64::min, f64::MAX);
        rise < STEP_HEIGHT_M + TURN_SINE * self.length()
    }
}

/// A quarter turn to the left.
pub(super) fn left_of(v: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}

/// The sides of what some facets cover together: edges that no other of them has.
pub fn outline_sides(facets: &[&Facet]) -> Vec<Side> {
    let edges: Vec<[Point3<f64>; 2]> = (facets.iter())
        .flat_map(|f| f.rings())
        .flat_map(|ring| sides(ring))
        .collect();
    let taken: BTreeSet<_> = edges.iter().map(|[a, b]| [key(a), key(b)]).collect();
    let mut open: Vec<[Point3<f64>; 2]> = (edges.into_iter())
        .filter(|[a, b]| !taken.contains(&[key(b), key(a)]))
        .collect();
    let mut sides = Vec::new();
    while let Some([a, b]) = open.pop() {
        let mut rim = vec![a, b];
        while let Some(i) = open
            .iter()
            .position(|e| continues(&rim[rim.len() - 2..], e))
        {
            rim.push(open.remove(i)[1]);
        }
        while let Some(i) = open.iter().position(|e| continues(e, &rim[..2])) {
            rim.insert(0, open.remove(i)[0]);
        }
        sides.push(Side { rim });
    }
    sides
}

/// Corners of facets of one building have the same plan position or another.
pub(super) fn key(p: &Point3<f64>) -> [u64; 2] {
    [p.x.to_bits(), p.y.to_bits()]
}

/// Does an edge go on where another ends, straight and at its height?
fn continues(first: &[Point3<f64>], then: &[Point3<f64>]) -> bool {
    let (u, v) = ((first[1] - first[0]).xy(), (then[1] - then[0]).xy());
    let lengths = hypot(u.x, u.y) * hypot(v.x, v.y);
    key(&first[1]) == key(&then[0])
        && (first[1].z - then[0].z).abs() < STEP_HEIGHT_M
        && u.perp(&v).abs() < TURN_SINE * lengths
        && u.dot(&v) > 0.0
}

/// Where the lines at these depths inside two sides meet, if they turn.
pub(super) fn mitre(
    corner: &Point2<f64>,
    sides: [&Vector2<f64>; 2],
    depths: [f64; 2],
) -> Option<Point2<f64>> {
    let [u, v] = sides;
    let turn = u.perp(v);
    // n_u . x = d_u and n_v . x = d_v, with n a quarter turn to the left of the direction.
    let x = (v * depths[0] - u * depths[1]) / turn;
    let mitred = corner + x;
    (turn.abs() > TURN_SINE && mitred.coords.iter().all(|c| c.is_finite())).then_some(mitred)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::buildings::gable;

    #[test]
    fn a_gable_roof_has_two_eaves_and_two_rakes() {
        let facets = gable();
        let sides = outline_sides(&facets.iter().collect::<Vec<_>>());
        assert_eq!(sides.len(), 4);
        assert_eq!(sides.iter().filter(|s| s.is_level()).count(), 2);
        for side in &sides {
            let middle = side.start().xy() + side.along() * (0.5 * side.length());
            let inside = middle + side.inward() * 0.1;
            assert!(facets.iter().any(|f| f.covers(&inside)));
            assert_eq!(side.rim.len(), if side.is_level() { 2 } else { 3 });
            assert_eq!(side.rim_at(-0.1), None);
            let top = side.rim_at(0.5 * side.length()).unwrap();
            assert_eq!(top > side.start().z + 1.0, !side.is_level());
        }
    }

    #[test]
    fn a_mitre_is_at_both_depths() {
        let (u, v) = (Vector2::new(1.0, 0.0), Vector2::new(0.6, 0.8));
        let p = mitre(&Point2::new(2.0, 3.0), [&u, &v], [0.5, 0.2]).unwrap();
        let offset = p - Point2::new(2.0, 3.0);
        assert!((left_of(&u).dot(&offset) - 0.5).abs() < 1e-12);
        assert!((left_of(&v).dot(&offset) - 0.2).abs() < 1e-12);
        assert_eq!(mitre(&Point2::origin(), [&u, &u], [0.5, 0.2]), None);
    }
}
