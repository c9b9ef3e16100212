//! A plane with its covariance, fitted to the ends of lines that are uncertain themselves.
//!
//! `z = c + a (x - x0) + b (y - y0)`. The residual of an end is its height above the plane; its
//! variance is `m' S m` with m = (-a, -b, 1) and S the covariance of the end across its line, which
//! depends on the plane, so that the fit is repeated with the weights of the last one.

use nalgebra::{Matrix3, Point2, Point3, Vector3};

use super::hypothesis::log_normal;
use crate::base::evidence::UncertaintyTable;
use crate::base::geometry::Plane;
use crate::base::math::ln;
use crate::lines::lines3d::Line3d;

/// The end of a line: its place, metres, and the covariance of that across the line, m^2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineEnd {
    /// The place.
    pub at: Point3<f64>,
    /// 3 x 3, zero along the line.
    pub covariance: Matrix3<f64>,
}

/// Both ends of a line.
pub(crate) fn ends_of(line: &Line3d) -> [LineEnd; 2] {
    let [start, end] = line.covariance;
    [(line.segment.p0, start), (line.segment.p1, end)]
        .map(|(at, covariance)| LineEnd { at, covariance })
}

/// A plane over the plan with the covariance of its three numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UncertainPlane {
    /// Where its height and gradient are counted from, metres.
    pub origin: Point2<f64>,
    /// Height there, rise along x, rise along y.
    pub coefficients: Vector3<f64>,
    /// Their covariance, 3 x 3.
    pub covariance: Matrix3<f64>,
}

impl UncertainPlane {
    /// Weighted least squares to two ends or more that do not lie on a line in plan; `pixel_m` is
    /// the size of a ground pixel, of which a part is the least error that is credible.
    pub(crate) fn fit(ends: &[LineEnd], pixel_m: f64) -> Option<Self> {
        /// The weights change little after the second fit.
        const ROUNDS: usize = 3;
        let origin =
            crate::base::geometry::mean_point(&ends.iter().map(|e| e.at.xy()).collect::<Vec<_>>());
        let mut plane = Self {
            origin,
            coefficients: Vector3::zeros(),
            covariance: Matrix3::identity(),
        };
        for _ in 0..ROUNDS {
            let (mut information, mut sum) = (Matrix3::zeros(), Vector3::zeros());
            for end in ends {
                let (g, weight) = (
                    plane.gradient(&end.at.xy()),
                    1.0 / plane.variance_of(end, pixel_m),
                );
                information += g * g.transpose() * weight;
                sum += g * (end.at.z * weight);
            }
            let factor = information.cholesky()?;
            plane.coefficients = factor.solve(&sum);
            plane.covariance = factor.inverse();
        }
        Some(plane)
    }

    /// The plane.
    pub(crate) fn plane(&self) -> Plane {
        let normal = Vector3::new(-self.coefficients.y, -self.coefficients.z, 1.0);
        let through = Point3::new(self.origin.x, self.origin.y, self.coefficients.x);
        Plane::from_point_normal(&through, &normal).expect("z of the normal is 1")
    }

    /// Height at a plan position, metres.
    pub(crate) fn height(&self, p: &Point2<f64>) -> f64 {
        self.coefficients.dot(&self.gradient(p))
    }

    /// Variance of the height of a point of the plane, m^2.
    pub(crate) fn variance(&self, p: &Point2<f64>) -> f64 {
        let g = self.gradient(p);
        g.dot(&(self.covariance * g))
    }

    /// Covariance of the height at a plan position and of the gradient, 3 x 3.
    pub(crate) fn covariance_at(&self, p: &Point2<f64>) -> [[f64; 3]; 3] {
        let d = p - self.origin;
        let moved = Matrix3::new(1.0, d.x, d.y, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        (moved * self.covariance * moved.transpose())
            .transpose()
            .into()
    }

    /// Logarithm of the odds that both ends of a line lie in the plane rather than anywhere within
    /// `range_m` of height. A line that does not lie in it may still run along it: half of those
    /// do, so that the second end says little more than the first unless it contradicts.
    pub(crate) fn nats_of_line(&self, line: &Line3d, pixel_m: f64, range_m: f64) -> f64 {
        let ends = ends_of(line);
        let [g0, g1] = ends.map(|end| self.gradient(&end.at.xy()));
        let [v0, v1] = ends.map(|end| self.variance_of(&end, pixel_m));
        let above = ends.map(|end| end.at.z - self.height(&end.at.xy()));
        let (middle, apart) = (0.5 * (above[0] + above[1]), above[1] - above[0]);
        // Covariance of (middle, apart): that of the ends and that of the plane below them.
        let (g, d) = (0.5 * (g0 + g1), g1 - g0);
        let c = &self.covariance;
        let of_middle = 0.25 * (v0 + v1) + g.dot(&(c * g));
        let of_apart = v0 + v1 + d.dot(&(c * d));
        let of_both = 0.5 * (v1 - v0) + g.dot(&(c * d));
        let expected = of_both / of_middle * middle;
        let along = log_normal(apart - expected, of_apart - of_both * of_both / of_middle);
        let otherwise = ln(0.5 * crate::base::math::exp(along) + 0.5 / range_m);
        log_normal(middle, of_middle) + ln(range_m) + along - otherwise
    }

    /// Logarithm of the odds that a point lies in the plane rather than anywhere within `range_m`.
    pub(crate) fn nats_of_end(&self, end: &LineEnd, pixel_m: f64, range_m: f64) -> f64 {
        let p = end.at.xy();
        let variance = self.variance_of(end, pixel_m) + self.variance(&p);
        log_normal(end.at.z - self.height(&p), variance) + ln(range_m)
    }

    /// Derivatives of the height at a plan position by the coefficients.
    fn gradient(&self, p: &Point2<f64>) -> Vector3<f64> {
        Vector3::new(1.0, p.x - self.origin.x, p.y - self.origin.y)
    }

    /// Variance of the height of an end above the plane, m^2: its own, without that of the plane.
    fn variance_of(&self, end: &LineEnd, pixel_m: f64) -> f64 {
        let m = Vector3::new(-self.coefficients.y, -self.coefficients.z, 1.0);
        let sigma = m.dot(&(end.covariance * m)).max(0.0).sqrt();
        let stated = UncertaintyTable::fitted().height.of(sigma, pixel_m);
        stated * stated
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing::{line, uniform};

    fn end(x: f64, y: f64, z: f64, sigma: f64) -> LineEnd {
        LineEnd {
            at: Point3::new(x, y, z),
            covariance: Matrix3::from_diagonal_element(sigma * sigma),
        }
    }

    #[test]
    fn a_planted_plane_is_within_its_covariance() {
        let mut random = uniform(5);
        let mut squares = 0.0;
        const TRIALS: usize = 200;
        for _ in 0..TRIALS {
            // The sum of twelve is nearly normal, with variance 1.
            let mut noise = || (0..12).map(|_| random()).sum::<f64>() - 6.0;
            let places = [(0.0, 0.0), (8.0, 0.0), (8.0, 5.0), (0.0, 5.0)];
            let sigma = UncertaintyTable::fitted().height.of(0.0, 0.1);
            let ends = places.map(|(x, y)| end(x, y, 4.0 + 0.7 * y + sigma * noise(), 0.0));
            let found = UncertainPlane::fit(&ends, 0.1).unwrap();
            let off = found.coefficients - Vector3::new(4.0 + 0.7 * 2.5, 0.0, 0.7);
            squares += off.dot(&(found.covariance.cholesky().unwrap().solve(&off)));
        }
        let mean = squares / TRIALS as f64;
        assert!((mean - 3.0).abs() < 0.6, "chi-square of 3 numbers: {mean}");
    }

    #[test]
    fn lines_in_the_plane_are_told_from_others() {
        let ends = [(0.0, 0.0), (8.0, 0.0), (8.0, 5.0), (0.0, 5.0)];
        let ends = ends.map(|(x, y)| end(x, y, 4.0 + 0.7 * y, 0.02));
        let plane = UncertainPlane::fit(&ends, 0.1).unwrap();
        let nats = |z0: f64, z1: f64| {
            let rake = line(Point3::new(0.0, 0.0, z0), Point3::new(0.0, 5.0, z1));
            plane.nats_of_line(&rake, 0.1, 10.0)
        };
        assert!(nats(4.0, 7.5) > 3.0);
        assert!(nats(4.0, 8.5) < -5.0, "it rises out of it");
        assert!(nats(5.0, 8.5) < -5.0, "it runs above it");
    }

    #[test]
    fn the_ends_of_one_line_have_no_plane_that_says_anything() {
        let ends = [end(0.0, 0.0, 4.0, 0.02), end(8.0, 0.0, 4.0, 0.02)];
        assert!(UncertainPlane::fit(&ends, 0.1).is_none());
    }
}
