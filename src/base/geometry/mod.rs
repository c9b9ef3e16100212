//! Finite segments, infinite lines, planes, rings and polygons. Points and vectors are nalgebra's.

mod polygon;

pub(crate) use polygon::OverlayRule;
pub use polygon::{
    Polygon, clip, contains, convex_hull, crossing, depth, plan_sides, sides, signed_area, span,
    vector_area,
};

use nalgebra::{Matrix3, Point, Point2, Point3, Rotation3, SVector, Unit, Vector2, Vector3};
use serde::{Deserialize, Serialize};

/// Least and largest coordinates of points. Without any, the least are larger than the largest.
pub fn bounds<const D: usize>(
    points: impl IntoIterator<Item = Point<f64, D>>,
) -> [Point<f64, D>; 2] {
    let none = [f64::MAX, f64::MIN].map(|bound| Point::from([bound; D]));
    let widen = |[low, high]: [Point<f64, D>; 2], p: Point<f64, D>| [low.inf(&p), high.sup(&p)];
    points.into_iter().fold(none, widen)
}

/// Mean of points, one at least.
pub fn mean_point<const D: usize>(points: &[Point<f64, D>]) -> Point<f64, D> {
    let sum = points.iter().fold(SVector::zeros(), |s, p| s + p.coords);
    Point::from(sum / points.len() as f64)
}

/// Eigenvalues of a symmetric matrix in rising order, and the eigenvectors.
pub(crate) fn principal_axes(matrix: Matrix3<f64>) -> ([f64; 3], [Vector3<f64>; 3]) {
    let eigen = matrix.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let axes = order.map(|i| eigen.eigenvectors.column(i).into_owned());
    (order.map(|i| eigen.eigenvalues[i]), axes)
}

/// A finite, directed segment in an image, in pixels (x right, y down, centre of the top-left
/// pixel at (0.5, 0.5)).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Segment2 {
    /// Start, pixels.
    pub p0: Point2<f64>,
    /// End, pixels.
    pub p1: Point2<f64>,
}

impl Segment2 {
    /// The segment from `p0` to `p1`.
    pub fn new(p0: Point2<f64>, p1: Point2<f64>) -> Self {
        Self { p0, p1 }
    }

    /// Both ends.
    pub fn ends(&self) -> [Point2<f64>; 2] {
        [self.p0, self.p1]
    }

    /// Length in pixels.
    pub fn length(&self) -> f64 {
        (self.p1 - self.p0).norm()
    }

    /// Unit direction from start to end; zero for a segment without length.
    pub fn direction(&self) -> Vector2<f64> {
        let d = self.p1 - self.p0;
        let n = d.norm();
        if n > 0.0 { d / n } else { Vector2::zeros() }
    }

    /// Unit normal (-dy, dx): to the right of the direction as seen on the screen (y down).
    pub fn normal(&self) -> Vector2<f64> {
        let d = self.direction();
        Vector2::new(-d.y, d.x)
    }

    /// The infinite line through the segment, scaled so that `l . (x, y, 1)` is the signed
    /// distance in pixels, positive on the side of [`Self::normal`].
    pub fn line(&self) -> Vector3<f64> {
        let n = self.normal();
        Vector3::new(n.x, n.y, -n.dot(&self.p0.coords))
    }

    /// The point at fraction `t` (0 at the start, 1 at the end).
    pub fn at(&self, t: f64) -> Point2<f64> {
        self.p0 + (self.p1 - self.p0) * t
    }

    /// The middle.
    pub fn midpoint(&self) -> Point2<f64> {
        self.at(0.5)
    }

    /// The same segment in an image `factor` times as large.
    pub fn enlarged(&self, factor: f64) -> Self {
        Self::new(self.p0 * factor, self.p1 * factor)
    }

    /// The same segment, the other way round.
    pub fn reversed(&self) -> Self {
        Self {
            p0: self.p1,
            p1: self.p0,
        }
    }
}

/// A finite, directed segment in the world, in metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Segment3 {
    /// Start, metres.
    pub p0: Point3<f64>,
    /// End, metres.
    pub p1: Point3<f64>,
}

impl Segment3 {
    /// The segment from `p0` to `p1`.
    pub fn new(p0: Point3<f64>, p1: Point3<f64>) -> Self {
        Self { p0, p1 }
    }

    /// Both ends.
    pub fn ends(&self) -> [Point3<f64>; 2] {
        [self.p0, self.p1]
    }

    /// Length in metres.
    pub fn length(&self) -> f64 {
        (self.p1 - self.p0).norm()
    }

    /// Unit direction from start to end; zero for a segment without length.
    pub fn direction(&self) -> Vector3<f64> {
        let d = self.p1 - self.p0;
        let n = d.norm();
        if n > 0.0 { d / n } else { Vector3::zeros() }
    }

    /// The point at fraction `t` (0 at the start, 1 at the end).
    pub fn at(&self, t: f64) -> Point3<f64> {
        self.p0 + (self.p1 - self.p0) * t
    }

    /// The stretch of the infinite line between two distances from the start, metres.
    pub fn stretch(&self, from_m: f64, to_m: f64) -> Self {
        let d = self.direction();
        Self::new(self.p0 + d * from_m, self.p0 + d * to_m)
    }

    /// Distance in metres from `point` to the infinite line through the segment.
    pub fn line_distance(&self, point: &Point3<f64>) -> f64 {
        (point - self.p0).cross(&self.direction()).norm()
    }

    /// The overlap of another segment with this one in plan; `None` without one, or where the sine
    /// of the angle between them is larger than `sine`.
    pub fn alongside(&self, other: &Self, sine: f64) -> Option<PlanOverlap> {
        let along = self.p1.xy() - self.p0.xy();
        let length = along.norm();
        let direction = along / length;
        let [a, b] = [other.p0, other.p1].map(|p| p.xy() - self.p0.xy());
        let (s, t) = (a.dot(&direction), b.dot(&direction));
        let stretch = [s.min(t).max(0.0), s.max(t).min(length)];
        // Written so that a segment without length has no overlap.
        let parallel = direction.perp(&(b - a)).abs() <= sine * (b - a).norm();
        (parallel && stretch[1] > stretch[0]).then_some(())?;
        let middle = 0.5 * (stretch[0] + stretch[1]);
        let (own, beside) = (self.at(middle / length), other.at((middle - s) / (t - s)));
        Some(PlanOverlap {
            stretch,
            apart: direction.perp(&(beside.xy() - own.xy())).abs(),
            rise: beside.z - own.z,
        })
    }
}

/// Overlap of two nearly parallel segments in plan, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanOverlap {
    /// Stretch of the first segment, from its start.
    pub stretch: [f64; 2],
    /// Distance in plan between the two, at the middle of the stretch.
    pub apart: f64,
    /// Height of the second segment above the first there.
    pub rise: f64,
}

/// An oriented plane `normal . X + d = 0`; roof planes have `normal.z > 0`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Plane {
    /// Unit normal.
    pub normal: Vector3<f64>,
    /// Minus the signed distance of the plane from the origin along the normal, metres.
    pub d: f64,
}

impl Plane {
    /// The level plane at a height, metres.
    pub fn level(z: f64) -> Self {
        Self {
            normal: Vector3::z(),
            d: -z,
        }
    }

    /// The same plane in a frame whose origin lies `by` further, metres.
    pub fn relative_to(&self, by: &Vector3<f64>) -> Self {
        Self {
            normal: self.normal,
            d: self.d + self.normal.dot(by),
        }
    }

    /// The plane through `point` with this normal (any length but zero); `None` for a zero normal.
    pub fn from_point_normal(point: &Point3<f64>, normal: &Vector3<f64>) -> Option<Self> {
        let normal = Unit::try_new(*normal, 1e-12)?.into_inner();
        Some(Self {
            normal,
            d: -normal.dot(&point.coords),
        })
    }

    /// Orthogonal regression of a plane to weighted points (B99 4.2, fig. 17), oriented upwards.
    /// `None` with fewer than three points or when they lie on a line.
    pub fn fit(points: &[(Point3<f64>, f64)]) -> Option<Self> {
        let weight: f64 = points.iter().map(|(_, w)| w).sum();
        if points.len() < 3 || weight <= 0.0 {
            return None;
        }
        let mean = points
            .iter()
            .fold(Vector3::zeros(), |s, (p, w)| s + p.coords * *w)
            / weight;
        let scatter = points.iter().fold(Matrix3::zeros(), |s, (p, w)| {
            let r = p.coords - mean;
            s + r * r.transpose() * *w
        });
        let ([_, second, largest], [normal, ..]) = principal_axes(scatter);
        // Collinear points leave the second axis without extent: no plane.
        if second <= 1e-9 * largest {
            return None;
        }
        let plane = Self::from_point_normal(&Point3::from(mean), &normal)?;
        Some(plane.upwards())
    }

    /// The same plane with its normal pointing up.
    pub fn upwards(self) -> Self {
        if self.normal.z < 0.0 {
            Self {
                normal: -self.normal,
                d: -self.d,
            }
        } else {
            self
        }
    }

    /// Signed distance in metres, positive on the side of the normal.
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&point.coords) + self.d
    }

    /// Height of the plane at a plan position; infinite or NaN for a vertical plane.
    pub fn z_at(&self, x: f64, y: f64) -> f64 {
        -(self.normal.x * x + self.normal.y * y + self.d) / self.normal.z
    }

    /// The point of the plane above or below a plan position.
    pub fn lift(&self, x: f64, y: f64) -> Point3<f64> {
        Point3::new(x, y, self.z_at(x, y))
    }

    /// Angle in radians between the normals of two planes, 0 to pi.
    pub fn angle_to(&self, other: &Plane) -> f64 {
        let (a, b) = (&self.normal, &other.normal);
        crate::base::math::atan2(a.cross(b).norm(), a.dot(b))
    }

    /// The line in which two planes meet: a point on it (nearest to `near`) and its unit direction.
    /// `None` for planes parallel within `sin(angle) < 1e-6`.
    pub fn intersection(
        &self,
        other: &Plane,
        near: &Point3<f64>,
    ) -> Option<(Point3<f64>, Vector3<f64>)> {
        let direction = self.normal.cross(&other.normal);
        let sine2 = direction.norm_squared();
        if sine2 < 1e-12 {
            return None;
        }
        let (e1, e2) = (self.signed_distance(near), other.signed_distance(near));
        let c = self.normal.dot(&other.normal);
        // Least-norm step from `near` onto both planes: a n1 + b n2 with
        // a + b c = -e1, a c + b = -e2.
        let (a, b) = ((-e1 + c * e2) / sine2, (-e2 + c * e1) / sine2);
        Some((
            near + self.normal * a + other.normal * b,
            direction / sine2.sqrt(),
        ))
    }
}

/// Length of the part of `within` that the union of the stretches covers.
pub fn covered(stretches: impl Iterator<Item = [f64; 2]>, within: [f64; 2]) -> f64 {
    let mut inside: Vec<[f64; 2]> = stretches
        .map(|s| [s[0].max(within[0]), s[1].min(within[1])])
        .filter(|s| s[1] > s[0])
        .collect();
    inside.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut sum, mut end) = (0.0, f64::NEG_INFINITY);
    for [a, b] in inside {
        sum += (b - a.max(end)).max(0.0);
        end = end.max(b);
    }
    sum
}

/// The rotation about this axis by its length, radians (Rodrigues).
pub fn rotation_from_axis_angle(turn: &Vector3<f64>) -> Rotation3<f64> {
    let angle = turn.norm();
    if angle < 1e-15 {
        return Rotation3::identity();
    }
    let (sin, cos) = crate::base::math::sin_cos(angle);
    let cross = (turn / angle).cross_matrix();
    let r = Matrix3::identity() + cross * sin + cross * cross * (1.0 - cos);
    Rotation3::from_matrix_unchecked(r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_around_their_mean_and_within_their_bounds() {
        let points = [[1.0, 5.0, -2.0], [4.0, -1.0, 0.0], [-2.0, 2.0, 5.0]].map(Point3::from);
        assert_eq!(mean_point(&points), Point3::new(1.0, 2.0, 1.0));
        let [low, high] = bounds(points);
        assert_eq!(low, Point3::new(-2.0, -1.0, -2.0));
        assert_eq!(high, Point3::new(4.0, 5.0, 5.0));
        let [low, high] = bounds::<2>([]);
        assert!(low.x > high.x && low.y > high.y);
    }

    #[test]
    fn plane_fit_recovers_a_planted_plane() {
        let planted =
            Plane::from_point_normal(&Point3::new(3.0, 4.0, 5.0), &Vector3::new(0.3, -0.2, 0.9))
                .unwrap();
        let points: Vec<_> = (0..20)
            .map(|i| {
                (
                    planted.lift(f64::from(i % 5), f64::from(i / 5) * 1.5),
                    1.0 + f64::from(i),
                )
            })
            .collect();
        let found = Plane::fit(&points).unwrap();
        assert!(found.angle_to(&planted) < 1e-9);
        assert!((found.d - planted.d).abs() < 1e-9);
    }

    #[test]
    fn collinear_points_have_no_plane() {
        let points: Vec<_> = (0..9)
            .map(|i| (Point3::new(f64::from(i), 2.0 * f64::from(i), 1.0), 1.0))
            .collect();
        assert!(Plane::fit(&points).is_none());
    }

    #[test]
    fn intersection_lies_on_both_planes() {
        let a =
            Plane::from_point_normal(&Point3::new(0.0, 0.0, 10.0), &Vector3::new(0.5, 0.0, 1.0))
                .unwrap();
        let b =
            Plane::from_point_normal(&Point3::new(0.0, 0.0, 10.0), &Vector3::new(-0.5, 0.1, 1.0))
                .unwrap();
        let (p, d) = a.intersection(&b, &Point3::new(7.0, 8.0, 9.0)).unwrap();
        for t in [-3.0, 0.0, 5.0] {
            assert!(a.signed_distance(&(p + d * t)).abs() < 1e-9);
            assert!(b.signed_distance(&(p + d * t)).abs() < 1e-9);
        }
        assert!(
            (p - Point3::new(7.0, 8.0, 9.0)).dot(&d).abs() < 1e-9,
            "nearest point of the line"
        );
    }

    #[test]
    fn line_gives_the_signed_distance() {
        let s = Segment2::new(Point2::new(1.0, 1.0), Point2::new(5.0, 1.0));
        // Travelling to the right, the normal points down the screen, where y grows.
        assert_eq!(s.line().dot(&Vector3::new(3.0, 4.0, 1.0)), 3.0);
    }

    #[test]
    fn covered_counts_overlaps_once() {
        let parts = [[0.0, 2.0], [1.0, 3.0], [5.0, 9.0], [-4.0, -1.0]];
        assert_eq!(covered(parts.into_iter(), [0.0, 6.0]), 4.0);
    }

    #[test]
    fn a_segment_runs_along_another_where_both_are() {
        let own = Segment3::new(Point3::new(1.0, 2.0, 5.0), Point3::new(11.0, 2.0, 5.0));
        let segment = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
            Segment3::new(Point3::new(x[0], y[0], z[0]), Point3::new(x[1], y[1], z[1]))
        };
        // It rises by 1 in 10 and converges by 1 in 20; the middle of the overlap is at x = 9.
        let other = segment([17.0, 7.0], [2.6, 2.1], [9.0, 8.0]);
        let found = own.alongside(&other, 0.1).expect("nearly parallel");
        assert!((found.stretch[0] - 6.0).abs() < 1e-12 && (found.stretch[1] - 10.0).abs() < 1e-12);
        assert!((found.apart - 0.2).abs() < 1e-12, "{found:?}");
        assert!((found.rise - 3.2).abs() < 1e-12, "{found:?}");
        assert_eq!(own.alongside(&other, 0.04), None, "askew");
        assert_eq!(
            own.alongside(&segment([12.0, 20.0], [2.0; 2], [5.0; 2]), 0.1),
            None,
            "beyond its end"
        );
        assert_eq!(
            segment([3.0; 2], [2.0; 2], [0.0, 4.0]).alongside(&own, 0.1),
            None,
            "upright"
        );
        assert_eq!(
            own.alongside(&segment([3.0; 2], [2.0; 2], [0.0, 4.0]), 0.1),
            None,
            "upright"
        );
    }
}
