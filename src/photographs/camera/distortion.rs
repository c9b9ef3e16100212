//! Lens distortion: Brown (1966) with the rational form that OpenCV and COLMAP share, about any
//! projection.
//!
//! With x, y the image coordinates that the projection gives (for a pinhole: principal point
//! subtracted, divided by the focal length), `r^2 = x^2 + y^2`:
//!
//! ```text
//! g  = (1 + k1 r^2 + k2 r^4 + k3 r^6 + l4 r^8 + ...) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
//! x' = x g + 2 p1 x y + p2 (r^2 + 2 x^2) + b1 x + b2 y + s1 r^2
//! y' = y g + 2 p2 x y + p1 (r^2 + 2 y^2) + s2 r^2
//! ```
//!
//! x', y' are the distorted coordinates; l4 is what Metashape calls k4. For a fisheye r is the
//! angle from the axis (or what else its projection gives), so that OpenCV's four coefficients are
//! k1, k2, k3 and l4.

use nalgebra::{Matrix3, Point2, Vector2};

use super::projection::Projection;

/// Terms of the radial polynomial above the fraction line; MicMac has up to ten.
const RADIAL_TERMS: usize = 10;

/// Coefficients of the formula above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distortion {
    /// What the lens does with the angles of rays.
    pub projection: Projection,
    /// k1, k2, k3, l4 and further ones: above the fraction line.
    pub radial: [f64; RADIAL_TERMS],
    /// k4, k5, k6: below it.
    pub radial_below: [f64; 3],
    /// p1, p2.
    pub tangential: [f64; 2],
    /// b1, b2: affinity and shear of the ideal coordinates.
    pub affine: [f64; 2],
    /// s1, s2 of a thin prism.
    pub thin_prism: [f64; 2],
    /// Centre of distortion against the principal point, divided by the focal length: x and y above
    /// count from there.
    pub center: [f64; 2],
    /// Focal length of the lens in that of the pinhole which replaces it.
    pub focal_factor: f64,
}

impl Default for Distortion {
    /// No distortion.
    fn default() -> Self {
        Self {
            projection: Projection::Perspective,
            radial: [0.0; RADIAL_TERMS],
            radial_below: [0.0; 3],
            tangential: [0.0; 2],
            affine: [0.0; 2],
            thin_prism: [0.0; 2],
            center: [0.0; 2],
            focal_factor: 1.0,
        }
    }
}

impl Distortion {
    /// Radial k1, k2, k3, l4, ..., as many as there are, and tangential p1, p2; `None` where all
    /// are zero.
    pub fn brown<const N: usize>(radial: [f64; N], tangential: [f64; 2]) -> Option<Self> {
        Self::lens(Projection::Perspective, radial, tangential)
    }

    /// The same about any projection; `None` where it is a pinhole without distortion.
    pub fn lens<const N: usize>(
        projection: Projection,
        radial: [f64; N],
        tangential: [f64; 2],
    ) -> Option<Self> {
        const { assert!(N <= RADIAL_TERMS) };
        let lens = Self {
            projection,
            radial: std::array::from_fn(|i| radial.get(i).copied().unwrap_or(0.0)),
            tangential,
            ..Self::default()
        };
        (lens != Self::default()).then_some(lens)
    }

    /// Does the lens differ from a pinhole by its projection, not only by small terms?
    pub fn is_fisheye(&self) -> bool {
        self.projection != Projection::Perspective
    }

    /// The distorted position of an ideal normalised image point.
    pub fn distort(&self, ideal: &Point2<f64>) -> Point2<f64> {
        self.distort_projected(self.projection.project(*ideal)) * self.focal_factor
    }

    /// The formula above, of what the projection gives.
    pub(super) fn distort_projected(&self, projected: Point2<f64>) -> Point2<f64> {
        let center = Vector2::from(self.center);
        let (x, y) = (projected.x - center.x, projected.y - center.y);
        let r2 = x * x + y * y;
        let g = polynomial(&self.radial, r2) / polynomial(&self.radial_below, r2);
        let ([p1, p2], [b1, b2], [s1, s2]) = (self.tangential, self.affine, self.thin_prism);
        Point2::new(
            x * g + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x) + (b1 * x + b2 * y + s1 * r2),
            y * g + 2.0 * p2 * x * y + p1 * (r2 + 2.0 * y * y) + s2 * r2,
        ) + center
    }

    /// Where the lens shows what the pinhole of calibration `k` shows at an image point.
    pub(crate) fn measured(&self, k: &Matrix3<f64>, pixel: &Point2<f64>) -> Point2<f64> {
        let d = self.distort(&normalised(k, pixel));
        Point2::new(
            d.x * k[(0, 0)] + k[(0, 1)] * d.y + k[(0, 2)],
            d.y * k[(1, 1)] + k[(1, 2)],
        )
    }

    /// Does the lens keep the order of points over an image of this size? Beyond the turning point
    /// of its polynomial a distortion folds the image over, which no lens does.
    pub fn is_plausible(&self, k: &Matrix3<f64>, width: u32, height: u32) -> bool {
        // Places a side where the order is looked at. Assumption: a polynomial that folds anywhere
        // folds a corner.
        const GRID_POINTS: u32 = 16;
        (0..=GRID_POINTS * GRID_POINTS).all(|i| {
            let p = Point2::new(
                f64::from(width) * f64::from(i % GRID_POINTS) / f64::from(GRID_POINTS - 1),
                f64::from(height) * f64::from((i / GRID_POINTS).min(GRID_POINTS - 1))
                    / f64::from(GRID_POINTS - 1),
            );
            self.keeps_order(&normalised(k, &p))
        })
    }

    /// Are points around an ideal one still around it, and in the same sense?
    pub(super) fn keeps_order(&self, ideal: &Point2<f64>) -> bool {
        // The Jacobian determinant against that of the projection, which never folds.
        let own = determinant(ideal, |p| self.distort(&p) / self.focal_factor);
        let plain = match self.projection {
            Projection::Perspective => 1.0,
            Projection::OfAngle(_) => determinant(ideal, |p| Projection::Equidistant.project(p)),
            _ => determinant(ideal, |p| self.projection.project(p)),
        };
        (0.1..10.0).contains(&(own / plain))
    }
}

/// The Jacobian determinant of a map, by central differences.
fn determinant(at: &Point2<f64>, map: impl Fn(Point2<f64>) -> Point2<f64>) -> f64 {
    let h = 1e-4;
    let d = |dx: f64, dy: f64| {
        let step = Vector2::new(dx, dy) * h;
        (map(at + step) - map(at - step)) / (2.0 * h)
    };
    let (dx, dy) = (d(1.0, 0.0), d(0.0, 1.0));
    dx.x * dy.y - dx.y * dy.x
}

/// An image point without the calibration.
pub(super) fn normalised(k: &Matrix3<f64>, pixel: &Point2<f64>) -> Point2<f64> {
    let y = (pixel.y - k[(1, 2)]) / k[(1, 1)];
    Point2::new((pixel.x - k[(0, 2)] - k[(0, 1)] * y) / k[(0, 0)], y)
}

/// 1 + c1 t + c2 t^2 + c3 t^3 ...
fn polynomial(c: &[f64], t: f64) -> f64 {
    1.0 + t * c.iter().rev().fold(0.0, |sum, c| c + t * sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lens_that_folds_the_image_is_not_plausible() {
        let k = Matrix3::new(200.0, 0.0, 100.0, 0.0, 200.0, 75.0, 0.0, 0.0, 1.0);
        let lens = Distortion::brown([-0.25, 0.03, 0.004, -0.05], [0.001, -0.002]).unwrap();
        assert!(lens.is_plausible(&k, 200, 150));
        let folded = Distortion::brown([-3.0], [0.001, -0.002]).unwrap();
        assert!(!folded.is_plausible(&k, 200, 150));
    }

    #[test]
    fn a_skewed_calibration_leads_to_the_lens_and_back_to_pixels() {
        let k = Matrix3::new(200.0, 7.0, 100.0, 0.0, 230.0, 75.0, 0.0, 0.0, 1.0);
        let lens = Distortion::brown([-0.25, 0.03], [0.001, -0.002]).unwrap();
        let pixel = |p: Point2<f64>| Point2::from((k * p.to_homogeneous()).xy());
        for ideal in [[0.3, -0.2], [-0.4, 0.3], [0.1, 0.25]].map(Point2::from) {
            let seen = lens.measured(&k, &pixel(ideal));
            assert!((seen - pixel(lens.distort(&ideal))).norm() < 1e-9, "{seen}");
        }
    }
}
