//! Rings and polygons in plan: sides, areas, what lies inside, hulls, booleans.
//!
//! A ring is its corners in order; the last one is not the first one again. Every area is the z of
//! one sum of triangles on the first corner, so that coordinates far from the origin lose nothing.
//! Every answer to "is it inside" is that of one crossing test (even-odd rule): a side has its
//! lower end and not its upper one, so that a place on a side that two polygons share lies in one
//! of them.
//!
//! Booleans are i_overlay's, of one type in the whole crate, and the hull is spade's: every further
//! type would be compiled anew (docs/decisions/0003-one-instance-of-generic-code.md).

use i_overlay::core::fill_rule::FillRule;
pub(crate) use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use nalgebra::{Point2, Point3, Vector2, Vector3};
use spade::{ConstrainedDelaunayTriangulation, Triangulation};

use super::bounds;
use crate::base::math::{larger, smaller};

/// The sides of a ring: from each corner to the next one, and from the last to the first.
pub fn sides<T: Copy>(ring: &[T]) -> impl Iterator<Item = [T; 2]> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(&from, &to)| [from, to])
}

/// The sides of a ring in space as they are seen from above.
pub fn plan_sides(ring: &[Point3<f64>]) -> impl Iterator<Item = [Point2<f64>; 2]> {
    sides(ring).map(|ends| ends.map(|p| p.xy()))
}

/// Vector area of a ring (Newell): its length is the area, and seen against its direction the ring
/// runs counter-clockwise. Zero without corners.
pub fn vector_area(ring: impl IntoIterator<Item = Point3<f64>>) -> Vector3<f64> {
    let mut corners = ring.into_iter();
    let Some(first) = corners.next() else {
        return Vector3::zeros();
    };
    let mut from = Vector3::zeros();
    corners.fold(Vector3::zeros(), |sum, corner| {
        let (before, to) = (from, corner - first);
        from = to;
        sum + before.cross(&to) / 2.0
    })
}

/// Area of a ring, positive where it runs counter-clockwise.
pub fn signed_area(ring: impl IntoIterator<Item = Point2<f64>>) -> f64 {
    vector_area(ring.into_iter().map(|p| Point3::new(p.x, p.y, 0.0))).z
}

/// The x at which a side crosses a row of the plan.
#[inline]
pub fn crossing([from, to]: [Point2<f64>; 2], y: f64) -> Option<f64> {
    ((from.y > y) != (to.y > y)).then(|| from.x + (to.x - from.x) * (y - from.y) / (to.y - from.y))
}

/// What a convex ring holds of a row of the plan, from its sides.
pub fn span(sides: impl IntoIterator<Item = [Point2<f64>; 2]>, y: f64) -> Option<[f64; 2]> {
    let crossings = sides.into_iter().filter_map(|side| crossing(side, y));
    (crossings.map(|x| [x, x])).reduce(|[first, last], [x, _]| [smaller(first, x), larger(last, x)])
}

/// Does a place lie inside these sides (even-odd rule)?
pub fn contains(sides: impl IntoIterator<Item = [Point2<f64>; 2]>, p: &Point2<f64>) -> bool {
    let crossings = sides.into_iter().filter_map(|side| crossing(side, p.y));
    crossings.filter(|x| p.x < *x).count() % 2 == 1
}

/// Distance of a place inside these sides from the nearest of them; negative outside.
pub fn depth(sides: impl IntoIterator<Item = [Point2<f64>; 2]>, p: &Point2<f64>) -> f64 {
    let (mut squared, mut is_inside) = (f64::INFINITY, false);
    for side in sides {
        let [from, to] = side;
        let along = to - from;
        // A side without length is its corner.
        let t = (p - from).dot(&along) / larger(along.norm_squared(), 1e-12);
        let foot = from + along * t.clamp(0.0, 1.0);
        squared = smaller(squared, (p - foot).norm_squared());
        is_inside ^= crossing(side, p.y).is_some_and(|x| p.x < x);
    }
    squared.sqrt() * if is_inside { 1.0 } else { -1.0 }
}

/// The part of a ring on the positive side of a linear function (Sutherland and Hodgman). Added
/// edges lie on the border and cancel under the even-odd rule.
pub fn clip(ring: &[Point3<f64>], side: &dyn Fn(&Point3<f64>) -> f64) -> Vec<Point3<f64>> {
    let mut out = Vec::with_capacity(ring.len() + 2);
    for [p, q] in sides(ring) {
        let (sp, sq) = (side(&p), side(&q));
        if sp >= 0.0 {
            out.push(p);
        }
        if (sp >= 0.0) != (sq >= 0.0) {
            out.push(p + (q - p) * (sp / (sp - sq)));
        }
    }
    out
}

/// The corners of the convex hull, counter-clockwise; none of points that cannot be triangulated.
pub fn convex_hull(points: &[Point2<f64>]) -> Vec<Point2<f64>> {
    let mut triangles = ConstrainedDelaunayTriangulation::<spade::Point2<f64>>::new();
    let inserted = (points.iter()).map(|p| triangles.insert(spade::Point2::new(p.x, p.y)));
    if inserted.filter(Result::is_err).count() > 0 {
        return Vec::new();
    }
    let corners = triangles.convex_hull().map(|edge| edge.from().position());
    let mut ring: Vec<Point2<f64>> = corners.map(|p| Point2::new(p.x, p.y)).collect();
    if signed_area(ring.iter().copied()) < 0.0 {
        ring.reverse();
    }
    ring
}

/// What some rings in plan hold by the even-odd rule: an outer ring less its holes, or several such
/// parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// The rings, metres. What booleans give and what facets have runs counter-clockwise around a
    /// part, followed by its holes, clockwise.
    pub rings: Vec<Vec<Point2<f64>>>,
}

impl From<Vec<Point2<f64>>> for Polygon {
    fn from(ring: Vec<Point2<f64>>) -> Self {
        Self { rings: vec![ring] }
    }
}

impl FromIterator<Polygon> for Polygon {
    /// Parts that do not overlap, as one polygon.
    fn from_iter<I: IntoIterator<Item = Polygon>>(parts: I) -> Self {
        let rings = parts.into_iter().flat_map(|part| part.rings);
        Self {
            rings: rings.collect(),
        }
    }
}

impl Polygon {
    /// The sides of all rings.
    pub fn sides(&self) -> impl Iterator<Item = [Point2<f64>; 2]> {
        self.rings.iter().flat_map(|ring| sides(ring))
    }

    /// Least and largest coordinates.
    pub fn bounds(&self) -> [Point2<f64>; 2] {
        bounds(self.rings.iter().flatten().copied())
    }

    /// Area, where holes run the other way round: positive for outer rings that run
    /// counter-clockwise.
    pub fn signed_area(&self) -> f64 {
        (self.rings.iter())
            .map(|ring| signed_area(ring.iter().copied()))
            .sum()
    }

    /// Area of what it holds, whichever way its rings run.
    pub fn area(&self) -> f64 {
        self.parts().iter().map(Self::signed_area).sum()
    }

    /// Length of all sides.
    pub fn perimeter(&self) -> f64 {
        let around =
            |ring: &Vec<Point2<f64>>| -> f64 { sides(ring).map(|[p, q]| (q - p).norm()).sum() };
        self.rings.iter().map(around).sum()
    }

    /// Centre of gravity, of rings as [`Self::signed_area`] takes them; `None` without area.
    pub fn centroid(&self) -> Option<Point2<f64>> {
        let origin = *self.rings.first()?.first()?;
        let moment = self.sides().fold(Vector2::zeros(), |sum, side| {
            let [p, q] = side.map(|p| p - origin);
            sum + (p + q) * p.perp(&q) / 6.0
        });
        let area = self.signed_area();
        (area != 0.0).then(|| origin + moment / area)
    }

    /// Does it hold a place?
    pub fn contains(&self, p: &Point2<f64>) -> bool {
        contains(self.sides(), p)
    }

    /// Distance of a place inside from the border; negative outside.
    pub fn depth(&self, p: &Point2<f64>) -> f64 {
        depth(self.sides(), p)
    }

    /// The same rings in another frame.
    pub fn mapped(&self, place: impl Fn(&Point2<f64>) -> Point2<f64>) -> Self {
        let rings = self.rings.iter();
        Self {
            rings: rings
                .map(|ring| ring.iter().map(&place).collect())
                .collect(),
        }
    }

    /// The first ring turned to run counter-clockwise, and the others, its holes, clockwise.
    pub fn oriented(mut self) -> Self {
        for (i, ring) in self.rings.iter_mut().enumerate() {
            if (signed_area(ring.iter().copied()) > 0.0) != (i == 0) {
                ring.reverse();
            }
        }
        self
    }

    /// What both hold.
    pub fn and(&self, other: &Self) -> Self {
        self.overlay(other, OverlayRule::Intersect)
            .into_iter()
            .collect()
    }

    /// What either holds.
    pub fn or(&self, other: &Self) -> Self {
        self.overlay(other, OverlayRule::Union)
            .into_iter()
            .collect()
    }

    /// What this one holds and the other does not.
    pub fn without(&self, other: &Self) -> Self {
        self.overlay(other, OverlayRule::Difference)
            .into_iter()
            .collect()
    }

    /// Its connected parts.
    pub fn parts(&self) -> Vec<Self> {
        self.overlay(&Self::default(), OverlayRule::Subject)
    }

    /// The parts of a boolean.
    pub(crate) fn overlay(&self, other: &Self, rule: OverlayRule) -> Vec<Self> {
        self.filled(other, rule, FillRule::EvenOdd)
    }

    /// The same without folds: rings that neither cross themselves nor each other, around what is
    /// run around counter-clockwise.
    pub fn unfolded(&self) -> Self {
        self.filled(&Self::default(), OverlayRule::Subject, FillRule::Positive)
            .into_iter()
            .collect()
    }

    fn filled(&self, other: &Self, rule: OverlayRule, fill: FillRule) -> Vec<Self> {
        let plain = |polygon: &Self| -> Vec<Vec<[f64; 2]>> {
            let ring = |ring: &Vec<Point2<f64>>| ring.iter().map(|p| [p.x, p.y]).collect();
            polygon.rings.iter().map(ring).collect()
        };
        let ring = |ring: Vec<[f64; 2]>| ring.into_iter().map(Point2::from).collect();
        let shapes = plain(self).overlay_as::<i64>(&plain(other), rule, fill);
        (shapes.into_iter())
            .map(|shape| Self {
                rings: shape.into_iter().map(ring).collect(),
            })
            .collect()
    }

    /// The part to the left of a line through a place; nothing of a line without direction.
    pub fn left_of(&self, at: &Point2<f64>, direction: &Vector2<f64>) -> Self {
        let [low, high] = bounds(self.rings.iter().flatten().copied().chain([*at]));
        let Some(along) = direction.try_normalize(1e-9) else {
            return Self::default();
        };
        let reach = along * (2.0 * (high - low).norm() + 1.0);
        let left = Vector2::new(-reach.y, reach.x);
        let half = [at - reach, at + reach, at + reach + left, at - reach + left];
        self.and(&half.to_vec().into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::{atan2, sin_cos};
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    /// A ring that does not cross itself, counter-clockwise, mostly concave.
    fn star() -> impl Strategy<Value = Vec<Point2<f64>>> {
        let radii = prop::collection::vec(1.0..9.0f64, 3..16);
        (radii, -5.0..5.0f64, -5.0..5.0f64).prop_map(|(radii, x, y)| {
            let corner = |(k, r): (usize, &f64)| {
                let (sin, cos) = sin_cos(TAU * k as f64 / radii.len() as f64);
                Point2::new(x + r * cos, y + r * sin)
            };
            radii.iter().enumerate().map(corner).collect()
        })
    }

    fn place() -> impl Strategy<Value = Point2<f64>> {
        (-12.0..12.0f64, -12.0..12.0f64).prop_map(|(x, y)| Point2::new(x, y))
    }

    fn area(ring: &[Point2<f64>]) -> f64 {
        signed_area(ring.iter().copied())
    }

    /// So many times a ring runs around a place.
    fn winding(ring: &[Point2<f64>], p: &Point2<f64>) -> f64 {
        let turn = |[a, b]: [Point2<f64>; 2]| atan2((a - p).perp(&(b - p)), (a - p).dot(&(b - p)));
        (sides(ring).map(turn).sum::<f64>() / TAU).round()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn area_depends_on_the_way_that_a_ring_runs_alone(
            ring in star(), by in 1..9usize, angle in 0.0..TAU,
        ) {
            let expected = area(&ring);
            prop_assert!(expected > 0.0);
            let mut other = ring.clone();
            other.rotate_left(by % ring.len());
            prop_assert!((area(&other) - expected).abs() < 1e-9);
            other.reverse();
            prop_assert!((area(&other) + expected).abs() < 1e-9);
            let (sin, cos) = sin_cos(angle);
            let far = |p: &Point2<f64>| {
                Point2::new(5e5 + cos * p.x - sin * p.y, 5.4e6 + sin * p.x + cos * p.y)
            };
            prop_assert!((area(&ring.iter().map(far).collect::<Vec<_>>()) - expected).abs() < 1e-5);
            let steep = |p: &Point2<f64>| Point3::new(p.x, cos * p.y, 7.0 + sin * p.y);
            let in_space = vector_area(ring.iter().map(steep));
            prop_assert!((in_space.norm() - expected).abs() < 1e-9);
            prop_assert!((in_space - Vector3::new(0.0, -sin, cos) * expected).norm() < 1e-9);
        }

        #[test]
        fn a_ring_holds_what_it_runs_around(ring in star(), p in place()) {
            let depth = depth(sides(&ring), &p);
            prop_assume!(depth.abs() > 1e-9);
            prop_assert_eq!(contains(sides(&ring), &p), winding(&ring, &p) == 1.0);
            prop_assert_eq!(contains(sides(&ring), &p), depth > 0.0);
        }

        #[test]
        fn a_hull_holds_all_points(points in prop::collection::vec(place(), 3..30)) {
            let hull = convex_hull(&points);
            prop_assert!(points.iter().all(|p| depth(sides(&hull), p) > -1e-9));
            prop_assert!(hull.iter().all(|p| points.contains(p)));
            let turns_left = |i: usize| {
                let corner = |k: usize| hull[(i + k) % hull.len()];
                (corner(1) - corner(0)).perp(&(corner(2) - corner(1))) > 0.0
            };
            prop_assert!((0..hull.len()).all(turns_left));
        }

        #[test]
        fn what_two_polygons_have_in_common_and_the_rest_add_up(
            a in star(), b in star(), at in place(), angle in 0.0..TAU, p in place(),
        ) {
            let [a, b] = [a, b].map(Polygon::from);
            let (both, rest) = (a.and(&b), a.without(&b));
            let near = |x: f64, y: f64| (x - y).abs() < 1e-6;
            prop_assert!(near(both.signed_area() + rest.signed_area(), a.signed_area()));
            let either = a.signed_area() + b.signed_area() - both.signed_area();
            prop_assert!(near(a.or(&b).signed_area(), either));
            prop_assert!(near(both.area(), both.signed_area()));
            if [&a, &b].iter().all(|polygon| polygon.depth(&p).abs() > 1e-6) {
                prop_assert_eq!(both.contains(&p), a.contains(&p) && b.contains(&p));
            }
            // Halves, of their own centres.
            let (sin, cos) = sin_cos(angle);
            let halves = [1.0, -1.0].map(|sign| a.left_of(&at, &(Vector2::new(cos, sin) * sign)));
            let areas = halves.each_ref().map(Polygon::signed_area);
            prop_assert!(near(areas[0] + areas[1], a.signed_area()));
            let moment = |polygon: &Polygon| {
                let from_at = polygon.centroid().map_or(Vector2::zeros(), |c| c - at);
                from_at * polygon.signed_area()
            };
            prop_assert!((moment(&halves[0]) + moment(&halves[1]) - moment(&a)).norm() < 1e-5);
            let left = |q: &Point3<f64>| Vector2::new(cos, sin).perp(&(q.xy() - at));
            let ring: Vec<_> = a.rings[0].iter().map(|q| Point3::new(q.x, q.y, 0.0)).collect();
            prop_assert!(near(vector_area(clip(&ring, &left)).z, areas[0]));
        }
    }

    #[test]
    fn a_place_on_common_sides_lies_in_one_square() {
        let corner = |x: i32, y: i32| Point2::new(f64::from(x), f64::from(y));
        let square = |x: i32, y: i32| {
            [
                corner(x, y),
                corner(x + 2, y),
                corner(x + 2, y + 2),
                corner(x, y + 2),
            ]
        };
        let squares = || (0..9).map(|i| square(2 * (i % 3), 2 * (i / 3)));
        for (x, y) in (1..6).flat_map(|x| (1..6).map(move |y| (x, y))) {
            let holding = squares().filter(|s| contains(sides(s), &corner(x, y)));
            assert_eq!(holding.count(), 1, "{x}, {y}");
        }
    }

    #[test]
    fn holes_count_by_the_way_they_run_and_folds_vanish() {
        let ring = |corners: &[[f64; 2]]| corners.iter().map(|&p| Point2::from(p)).collect();
        let outer: Vec<_> = ring(&[[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]]);
        let hole: Vec<_> = ring(&[[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]]);
        let rings = vec![outer, hole];
        let drawn = Polygon { rings };
        assert_eq!((drawn.signed_area(), drawn.area()), (28.0, 20.0));
        let oriented = drawn.oriented();
        assert_eq!((oriented.signed_area(), oriented.perimeter()), (20.0, 28.0));
        assert!(!oriented.contains(&Point2::new(2.0, 2.0)));
        assert_eq!(oriented.depth(&Point2::new(4.0, 2.0)), 1.0);
        assert_eq!(
            oriented.bounds(),
            [[0.0, 0.0], [6.0, 4.0]].map(Point2::from)
        );
        // The last corner folds over the first side: a triangle runs clockwise.
        let corners = [[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [2.0, 4.0], [2.0, -1.0]];
        let folded = Polygon::from(ring(&corners));
        let fold = Point2::new(1.5, -0.3);
        assert!(folded.signed_area() == 15.0 && folded.contains(&fold));
        let unfolded = folded.unfolded();
        assert!((unfolded.signed_area() - 16.0).abs() < 1e-6 && !unfolded.contains(&fold));
    }
}
