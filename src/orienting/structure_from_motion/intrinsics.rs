//! The camera that is calibrated: one focal length, principal point, two radial terms.
//!
//! ```text
//! u = f g x + cx,  v = f g y + cy,  g = 1 + k1 r^2 + k2 r^4,  r^2 = x^2 + y^2
//! ```
//!
//! (COLMAP's RADIAL; Brown 1966.)

use nalgebra::{Matrix2, Matrix2x5, Point2, Vector2};

use crate::base::math;

/// Interior orientation of the photographs of one camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Intrinsics {
    /// f, pixels.
    pub focal: f64,
    /// k1 and k2.
    pub radial: [f64; 2],
    /// cx and cy, pixels.
    pub center: [f64; 2],
    /// Width and height of the photographs, pixels.
    pub size: [u32; 2],
}

/// Parameters of [`Intrinsics`], in the order of the adjustment: f, k1, k2, cx, cy.
pub(super) const PARAMETERS: usize = 5;

/// Prior standard deviation of a stated focal length, a share of it.
pub(super) const STATED_FOCAL_PRIOR: f64 = 0.05;

/// Focal lengths that are tried where none is stated, as shares of the longer side.
pub(super) const FOCAL_GUESSES: [f64; 8] = [0.6, 0.72, 0.86, 1.0, 1.2, 1.5, 2.0, 2.8];

/// That a header belongs to its photograph, nats. Assumption: of a hundred one does not, because
/// the photograph was cut or the header is that of another one.
pub(super) const STATED_FOCAL_ODDS: f64 = 4.6;

/// How much likelier a focal length is where the stated one belongs to the photographs than where
/// it does not, nats: the density of its logarithm under the spread of what is stated (and of
/// itself, a share), over that of any lens between the shortest and the longest that are tried.
pub(super) fn stated_focal_nats(focal: f64, stated: f64, spread: f64) -> f64 {
    let sigma = math::hypot(STATED_FOCAL_PRIOR, spread);
    let z = math::ln(focal / stated) / sigma;
    let [shortest, .., longest] = FOCAL_GUESSES;
    let any = math::ln(longest / shortest);
    let density = math::ln(any / (sigma * (2.0 * std::f64::consts::PI).sqrt())) - 0.5 * z * z;
    STATED_FOCAL_ODDS + density
}

impl Intrinsics {
    /// A camera without distortion, its principal point in the middle.
    pub fn new(focal: f64, size: [u32; 2]) -> Self {
        Self {
            focal,
            radial: [0.0; 2],
            center: size.map(|side| f64::from(side) / 2.0),
            size,
        }
    }

    /// The image of a ray (x, y, 1), pixels.
    pub fn project(&self, ray: &Vector2<f64>) -> Point2<f64> {
        let r2 = ray.norm_squared();
        let g = 1.0 + r2 * (self.radial[0] + r2 * self.radial[1]);
        let [cx, cy] = self.center;
        Point2::new(self.focal * g * ray.x + cx, self.focal * g * ray.y + cy)
    }

    /// The ray (x, y, 1) of an image point; where the lens shows nothing, the nearest that Newton's
    /// method finds.
    pub fn ray(&self, pixel: &Point2<f64>) -> Vector2<f64> {
        let seen = Vector2::new(pixel.x - self.center[0], pixel.y - self.center[1]) / self.focal;
        let measured = seen.norm();
        if measured == 0.0 {
            return seen;
        }
        let [k1, k2] = self.radial;
        let mut r = measured;
        for _ in 0..20 {
            let r2 = r * r;
            let value = r * (1.0 + r2 * (k1 + r2 * k2)) - measured;
            let slope = 1.0 + r2 * (3.0 * k1 + 5.0 * r2 * k2);
            let step = value / slope.max(0.1);
            r -= step;
            if step.abs() < 1e-14 {
                break;
            }
        }
        seen * (r / measured)
    }

    /// Derivatives of the image point by x and y, and by f, k1, k2, cx, cy.
    pub(super) fn derivatives(&self, ray: &Vector2<f64>) -> (Matrix2<f64>, Matrix2x5<f64>) {
        let (x, y, f) = (ray.x, ray.y, self.focal);
        let r2 = ray.norm_squared();
        let [k1, k2] = self.radial;
        let g = 1.0 + r2 * (k1 + r2 * k2);
        // dg / d(r^2)
        let slope = k1 + 2.0 * r2 * k2;
        let by_ray = Matrix2::new(
            f * (g + 2.0 * slope * x * x),
            f * 2.0 * slope * x * y,
            f * 2.0 * slope * x * y,
            f * (g + 2.0 * slope * y * y),
        );
        let r4 = r2 * r2;
        #[rustfmt::skip]
        let by_parameters = Matrix2x5::new(
            g * x, f * r2 * x, f * r4 * x, 1.0, 0.0,
            g * y, f * r2 * y, f * r4 * y, 0.0, 1.0,
        );
        (by_ray, by_parameters)
    }

    pub(super) fn parameters(&self) -> [f64; PARAMETERS] {
        let ([k1, k2], [cx, cy]) = (self.radial, self.center);
        [self.focal, k1, k2, cx, cy]
    }

    pub(super) fn with_parameters(&self, [focal, k1, k2, cx, cy]: [f64; PARAMETERS]) -> Self {
        Self {
            focal,
            radial: [k1, k2],
            center: [cx, cy],
            size: self.size,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::least_squares::worst_derivative;

    fn camera() -> Intrinsics {
        Intrinsics {
            radial: [-0.12, 0.04],
            center: [403.0, 296.0],
            ..Intrinsics::new(610.0, [800, 600])
        }
    }

    #[test]
    fn a_ray_returns_to_its_pixel() {
        for (x, y) in [(403.0, 296.0), (10.0, 20.0), (790.0, 500.0)] {
            let pixel = Point2::new(x, y);
            let back = camera().project(&camera().ray(&pixel));
            assert!((back - pixel).norm() < 1e-9, "{back}");
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let ray = Vector2::new(0.4, -0.3);
        let (by_ray, by_parameters) = camera().derivatives(&ray);
        let off = worst_derivative(&by_ray, |step| camera().project(&(ray + step)).coords);
        assert!(off < 1e-6, "{off}");
        let off = worst_derivative(&by_parameters, |step| {
            let parameters = std::array::from_fn(|i| camera().parameters()[i] + step[i]);
            camera().with_parameters(parameters).project(&ray).coords
        });
        assert!(off < 1e-6, "{off}");
    }
}
