//! Photographs resampled to a pinhole, once, on loading.
//!
//! The pinhole has the size of the photograph and its principal point. Behind a lens that is nearly
//! one it has its focal length, too; that of a fisheye follows from the field that is used. Each
//! new pixel looks up one place of the photograph, so no inverse is needed.

use nalgebra::{Matrix3, Point2};

use super::distortion::{Distortion, normalised};
use crate::base::math;
use crate::photographs::raster::{Gray, Photograph};

/// Largest angle from the axis of a fisheye that is used, degrees. Out there the pinhole draws a
/// pixel of an equidistant photograph out to four (1 / cos^2), and further out ever faster.
const WIDEST_ANGLE_DEG: f64 = 60.0;

impl Distortion {
    /// The pinhole of the photograph's size that takes in the widest field of a fisheye with
    /// calibration `k`: all of its pixels lie within the photograph, and within 60 degrees of the
    /// axis. Its calibration and the lens seen from it; or why there is none.
    pub fn rectified(
        &self,
        k: &Matrix3<f64>,
        width: u32,
        height: u32,
    ) -> Result<(Matrix3<f64>, Self), &'static str> {
        // Pinholes that are tried. Assumption: a tenth of a degree at its border is no loss.
        const STEPS_PER_DEGREE: u32 = 10;
        // Places along each side of the image. Assumption: its border is smooth.
        const BORDER_STEPS: u32 = 64;
        let (w, h) = (f64::from(width), f64::from(height));
        let border: Vec<Point2<f64>> = (0..=BORDER_STEPS)
            .flat_map(|i| {
                let t = f64::from(i) / f64::from(BORDER_STEPS);
                [[t * w, 0.0], [t * w, h], [0.0, t * h], [w, t * h]].map(Point2::from)
            })
            .map(|pixel| normalised(k, &pixel))
            .collect();
        let far = (border.iter().map(|p| p.coords.norm())).fold(0.0, f64::max);
        let inside = |p: Point2<f64>| {
            let slack = 0.5;
            (-slack..=w + slack).contains(&p.x) && (-slack..=h + slack).contains(&p.y)
        };
        let mut found = None;
        for step in 1..=WIDEST_ANGLE_DEG as u32 * STEPS_PER_DEGREE {
            let angle_deg = f64::from(step) / f64::from(STEPS_PER_DEGREE);
            let (s, c) = math::sin_cos(angle_deg.to_radians());
            // Border points of this pinhole lie at `wider` times the directions of `k`.
            let wider = s / c / far;
            if !border.iter().all(|p| self.keeps_order(&(p * wider))) {
                return Err("folds the image over");
            }
            if !border
                .iter()
                .all(|p| inside(self.measured(k, &to_pixel(k, &(p * wider)))))
            {
                break;
            }
            found = Some(wider);
        }
        let wider = found.ok_or("has its axis outside of the image")?;
        let mut pinhole = *k;
        for at in [(0, 0), (0, 1), (1, 1)] {
            pinhole[at] /= wider;
        }
        let lens = Self {
            focal_factor: self.focal_factor * wider,
            ..*self
        };
        Ok((pinhole, lens))
    }
}

fn to_pixel(k: &Matrix3<f64>, p: &Point2<f64>) -> Point2<f64> {
    Point2::new(
        p.x * k[(0, 0)] + p.y * k[(0, 1)] + k[(0, 2)],
        p.y * k[(1, 1)] + k[(1, 2)],
    )
}

/// The photograph as a pinhole of calibration `k` would have taken it, of the same size. Where the
/// pinhole sees more than the photograph shows, its border is repeated.
pub fn undistort(photograph: &Photograph, k: &Matrix3<f64>, lens: &Distortion) -> Photograph {
    let (width, height) = photograph.rgb.dimensions();
    let rows: Vec<u32> = (0..height).collect();
    let lines = crate::base::execution::map(&rows, |_, &row| {
        let mut colours = Vec::with_capacity(width as usize * 3);
        let mut grays = Vec::with_capacity(width as usize);
        for column in 0..width {
            let pixel = Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let at = lens.measured(k, &pixel);
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
    use crate::photographs::camera::Projection;

    fn planted() -> Distortion {
        Distortion {
            radial_below: [0.01, 0.0, 0.0],
            center: [0.01, -0.02],
            ..Distortion::brown([-0.25, 0.03, 0.004, -0.05], [0.001, -0.002]).unwrap()
        }
    }

    #[test]
    fn a_photograph_of_known_colours_is_straightened() {
        let lens = planted();
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
                ideal += d - lens.distort(&ideal);
            }
            let (x, y) = (ideal.x * 200.0 + 103.0, ideal.y * 210.0 + 74.0);
            image::Rgb([x.round() as u8, y.round() as u8, 0])
        });
        let gray = Gray::from_rgb(&photograph);
        let rgb = photograph.clone();
        let straight = undistort(&Photograph { rgb, gray }, &k, &lens);
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
    /// What a fisheye takes of a pattern of smooth waves over the directions.
    fn pattern([x, y]: [f64; 2]) -> f64 {
        0.5 + 0.2 * math::sin(9.0 * x) * math::cos(7.0 * y) + 0.2 * math::sin(5.0 * y + 3.0 * x)
    }

    #[test]
    fn a_fisheye_is_rectified_to_a_pinhole() {
        let k = Matrix3::new(300.0, 0.0, 318.0, 0.0, 302.0, 243.0, 0.0, 0.0, 1.0);
        let radial = [-0.02, 0.003, -0.001, 0.0002];
        for projection in [Projection::Equidistant, Projection::Equisolid] {
            let lens = Distortion::lens(projection, radial, [2e-4, -1e-4]).unwrap();
            // The direction of each pixel of the photograph, by Newton's method on the radius.
            let gray = Gray::from_fn(640, 480, |c, r| {
                let at = Point2::new(
                    (c as f64 + 0.5 - 318.0) / 300.0,
                    (r as f64 + 0.5 - 243.0) / 302.0,
                );
                pattern(direction(&lens, at).into()) as f32
            });
            let rgb = image::RgbImage::new(640, 480);
            let (pinhole, seen) = lens.rectified(&k, 640, 480).unwrap();
            let straight = undistort(&Photograph { rgb, gray }, &pinhole, &seen).gray;
            // The grey values are those of the pinhole's own directions: what is left, divided by
            // the slope, is a shift below a twentieth of a pixel.
            let (mut off, mut slope) = (0.0_f64, 0.0_f64);
            for (row, column) in (0..480).flat_map(|r| (0..640).map(move |c| (r, c))) {
                let of = |column: f64| {
                    pattern([
                        (column - pinhole[(0, 2)]) / pinhole[(0, 0)],
                        (row as f64 + 0.5 - pinhole[(1, 2)]) / pinhole[(1, 1)],
                    ])
                };
                let middle = column as f64 + 0.5;
                off = off.max((f64::from(straight.get(column, row)) - of(middle)).abs());
                slope = slope.max((of(middle + 0.5) - of(middle - 0.5)).abs());
            }
            assert!(off < 0.05 * slope, "{off} at a slope of {slope} a pixel");
            let camera = crate::photographs::camera::Camera::new(
                pinhole,
                nalgebra::Rotation3::identity(),
                Default::default(),
                640,
                480,
            );
            let widest = camera.half_field_deg();
            assert!((50.0..=60.1).contains(&widest), "{widest} degrees");
        }
    }

    /// The direction that a lens puts at a place, by steps back from where it puts it.
    fn direction(lens: &Distortion, at: Point2<f64>) -> Point2<f64> {
        // Angles for radii first, as if the lens were equidistant.
        let theta = at.coords.norm().min(1.5);
        let mut ideal = at * (math::sin(theta) / (math::cos(theta) * theta));
        for _ in 0..100 {
            let off = at - lens.distort(&ideal);
            let r2 = ideal.coords.norm_squared();
            ideal += off * (1.0 + 0.5 * r2);
            if off.amax() < 1e-13 {
                break;
            }
        }
        ideal
    }

    #[test]
    fn a_field_ends_where_the_photograph_or_the_lens_does() {
        let k = Matrix3::new(600.0, 0.0, 320.0, 0.0, 600.0, 240.0, 0.0, 0.0, 1.0);
        let lens = Distortion::lens(Projection::Equidistant, [0.0], [0.0; 2]).unwrap();
        let (pinhole, seen) = lens.rectified(&k, 640, 480).unwrap();
        // The photograph ends at 0.4 above its middle: no pixel looks beyond.
        let top = seen.measured(&pinhole, &Point2::new(320.0, 0.0));
        assert!((-0.5..3.0).contains(&top.y), "{top}");
        let folds = Distortion::lens(Projection::Equidistant, [-2.0], [0.0; 2]).unwrap();
        assert_eq!(folds.rectified(&k, 640, 480), Err("folds the image over"));
        let outside = Matrix3::new(600.0, 0.0, -20.0, 0.0, 600.0, 240.0, 0.0, 0.0, 1.0);
        assert!(lens.rectified(&outside, 640, 480).is_err());
    }
}
