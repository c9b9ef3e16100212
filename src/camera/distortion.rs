//! Lens distortion (Brown 1966, with the rational form that OpenCV and COLMAP share) and its
//! removal.
//!
//! With x, y the ideal image coordinates (principal point subtracted, divided by the focal length),
//! `r^2 = x^2 + y^2`:
//!
//! ```text
//! g  = (1 + k1 r^2 + k2 r^4 + k3 r^6 + l4 r^8) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
//! x' = x g + 2 p1 x y + p2 (r^2 + 2 x^2)
//! y' = y g + 2 p2 x y + p1 (r^2 + 2 y^2)
//! ```
//!
//! x', y' are the distorted coordinates; l4 is what Metashape calls k4. Images are resampled once
//! on loading to a pinhole of the same size and calibration: each new pixel looks up one place of
//! the photograph, so no inverse is needed.

use nalgebra::{Matrix3, Point2, Vector2};

use crate::raster::{Gray, Photograph};

/// Coefficients of the formula above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distortion {
    /// k1, k2, k3, l4: above the fraction line.
    pub radial: [f64; 4],
    /// k4, k5, k6: below it.
    pub radial_below: [f64; 3],
    /// p1, p2.
    pub tangential: [f64; 2],
    /// Centre of distortion against the principal point, divided by the focal length: x and y above
    /// count from there.
    pub center: [f64; 2],
}

impl Distortion {
    /// Radial k1, k2, k3, l4, as many as there are, and tangential p1, p2; `None` where all are
    /// zero.
    pub fn brown<const N: usize>(radial: [f64; N], tangential: [f64; 2]) -> Option<Self> {
        const { assert!(N <= 4) };
        let any = radial.iter().chain(&tangential).any(|&v| v != 0.0);
        any.then(|| Self {
            radial: std::array::from_fn(|i| radial.get(i).copied().unwrap_or(0.0)),
            radial_below: [0.0; 3],
            tangential,
            center: [0.0; 2],
        })
    }

    /// The distorted position of an ideal normalised image point.
    pub fn distort(&self, ideal: &Point2<f64>) -> Point2<f64> {
        let center = Vector2::from(self.center);
        let (x, y) = (ideal.x - center.x, ideal.y - center.y);
        let r2 = x * x + y * y;
        let g = polynomial(&self.radial, r2) / polynomial(&self.radial_below, r2);
        let [p1, p2] = self.tangential;
        Point2::new(
            x * g + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * g + 2.0 * p2 * x * y + p1 * (r2 + 2.0 * y * y),
        ) + center
    }

    /// Does the lens keep the order of points over an image of this size? Beyond the turning point
    /// of its polynomial a distortion folds the image over, which no lens does.
    pub fn is_plausible(&self, k: &Matrix3<f64>, width: u32, height: u32) -> bool {
        const STEPS: u32 = 16;
        (0..=STEPS * STEPS).all(|i| {
            let p = Vector2::new(
                f64::from(width) * f64::from(i % STEPS) / f64::from(STEPS - 1),
                f64::from(height) * f64::from((i / STEPS).min(STEPS - 1)) / f64::from(STEPS - 1),
            );
            let ideal = Point2::new((p.x - k[(0, 2)]) / k[(0, 0)], (p.y - k[(1, 2)]) / k[(1, 1)]);
            // Central differences of the map: its Jacobian determinant must stay near 1.
            let h = 1e-4;
            let d = |dx: f64, dy: f64| {
                let step = Vector2::new(dx, dy) * h;
                (self.distort(&(ideal + step)) - self.distort(&(ideal - step))) / (2.0 * h)
            };
            let (dx, dy) = (d(1.0, 0.0), d(0.0, 1.0));
            let determinant = dx.x * dy.y - dx.y * dy.x;
            (0.1..10.0).contains(&determinant)
        })
    }
}

/// 1 + c1 t + c2 t^2 + c3 t^3 ...
fn polynomial(c: &[f64], t: f64) -> f64 {
    1.0 + t * c.iter().rev().fold(0.0, |sum, c| c + t * sum)
}

/// The photograph as a pinhole of calibration `k` would have taken it, of the same size. Where the
/// pinhole sees more than the photograph shows, its border is repeated.
pub fn undistort(photograph: &Photograph, k: &Matrix3<f64>, lens: &Distortion) -> Photograph {
    let (width, height) = photograph.rgb.dimensions();
    let rows: Vec<u32> = (0..height).collect();
    let lines = crate::execution::map(&rows, |_, &row| {
        let mut colours = Vec::with_capacity(width as usize * 3);
        let mut grays = Vec::with_capacity(width as usize);
        for column in 0..width {
            let ideal = Point2::new(
                (f64::from(column) + 0.5 - k[(0, 2)]) / k[(0, 0)],
                (f64::from(row) + 0.5 - k[(1, 2)]) / k[(1, 1)],
            );
            let d = lens.distort(&ideal);
            let at = Point2::new(d.x * k[(0, 0)] + k[(0, 2)], d.y * k[(1, 1)] + k[(1, 2)]);
            let (colour, gray) = bilinear(photograph, &at);
            colours.extend(colour);
            grays.push(gray);
        }
        (colours, grays)
    });
    let (colours, grays): (Vec<_>, Vec<_>) = lines.into_iter().unzip();
    Photograph {
        rgb: image::RgbImage::from_raw(width, height, colours.concat())
            .expect("three bytes for each pixel"),
        gray: Gray {
            width: width as usize,
            height: height as usize,
            data: grays.concat(),
        },
    }
}

/// Bilinear colour and grey value at an image point; outside the centres of the border pixels,
/// those of the border.
fn bilinear(photograph: &Photograph, at: &Point2<f64>) -> ([u8; 3], f32) {
    let (width, height) = photograph.rgb.dimensions();
    let inside = |v: f64, size: u32| (v - 0.5).max(0.0).min(f64::from(size - 1));
    let (x, y) = (inside(at.x, width), inside(at.y, height));
    let (column, row) = (x as u32, y as u32);
    let (right, below) = ((column + 1).min(width - 1), (row + 1).min(height - 1));
    let (fx, fy) = (x - f64::from(column), y - f64::from(row));
    let blend = |value: &dyn Fn(u32, u32) -> f64| {
        let top = value(column, row) * (1.0 - fx) + value(right, row) * fx;
        let bottom = value(column, below) * (1.0 - fx) + value(right, below) * fx;
        top * (1.0 - fy) + bottom * fy
    };
    let colour = [0, 1, 2]
        .map(|c| blend(&|x, y| f64::from(photograph.rgb.get_pixel(x, y)[c])).round() as u8);
    let gray = blend(&|x, y| f64::from(photograph.gray.get(x as usize, y as usize)));
    (colour, gray as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENS: Distortion = Distortion {
        radial: [-0.25, 0.03, 0.004, -0.05],
        radial_below: [0.01, 0.0, 0.0],
        tangential: [0.001, -0.002],
        center: [0.01, -0.02],
    };

    #[test]
    fn a_photograph_of_known_colours_is_straightened() {
        // Each colour is the ideal position of its pixel, found by iteration independent of the
        // look-up.
        let k = Matrix3::new(200.0, 0.0, 103.0, 0.0, 210.0, 74.0, 0.0, 0.0, 1.0);
        let photograph = image::RgbImage::from_fn(200, 150, |c, r| {
            let d = Point2::new(
                (f64::from(c) + 0.5 - 103.0) / 200.0,
                (f64::from(r) + 0.5 - 74.0) / 210.0,
            );
            let mut ideal = d;
            for _ in 0..50 {
                ideal += d - LENS.distort(&ideal);
            }
            let (x, y) = (ideal.x * 200.0 + 103.0, ideal.y * 210.0 + 74.0);
            image::Rgb([x.round() as u8, y.round() as u8, 0])
        });
        let gray = Gray::from_rgb(&photograph);
        let rgb = photograph.clone();
        let straight = undistort(&Photograph { rgb, gray }, &k, &LENS);
        let mean = |g: &Gray| g.data.iter().sum::<f32>() / g.data.len() as f32;
        assert!((mean(&straight.gray) - mean(&Gray::from_rgb(&straight.rgb))).abs() < 2e-3);
        for (c, r, p) in straight
            .rgb
            .enumerate_pixels()
            .filter(|(c, r, _)| (4..196).contains(c) && (4..146).contains(r))
        {
            assert!(
                (f64::from(c) + 0.5 - f64::from(p[0])).abs() <= 1.5,
                "{c} {r} {p:?}"
            );
            assert!(
                (f64::from(r) + 0.5 - f64::from(p[1])).abs() <= 1.5,
                "{c} {r} {p:?}"
            );
        }
        assert!(
            photograph.get_pixel(4, 75)[0].abs_diff(4) > 2,
            "the lens does distort"
        );
    }

    #[test]
    fn a_lens_that_folds_the_image_is_not_plausible() {
        let k = Matrix3::new(200.0, 0.0, 100.0, 0.0, 200.0, 75.0, 0.0, 0.0, 1.0);
        assert!(LENS.is_plausible(&k, 200, 150));
        let folded = Distortion {
            radial: [-3.0, 0.0, 0.0, 0.0],
            ..LENS
        };
        assert!(!folded.is_plausible(&k, 200, 150));
    }
}
