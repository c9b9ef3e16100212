//! Planted edges for the tests.

use nalgebra::{Point2, Vector2};

use super::edgels::Edgel;
use crate::base::math;
use crate::photographs::raster::Gray;

/// Blur of the planted edges, px: that of a good lens.
const BLUR_PX: f64 = 0.7;
/// Grey value of the dark side.
const DARK: f64 = 0.35;

/// An edge of the given contrast through the centre of an image, blurred as grey values. `angle`
/// is that of its normal, to the brighter side (0: right, pi/2: down).
pub(super) fn step_edge(width: usize, height: usize, angle: f64, contrast: f64) -> Gray {
    blurred_edge(width, height, angle, |share| DARK + contrast * share)
}

/// The same edge as a camera takes it: its light is blurred, and stored as sRGB.
pub(super) fn lit_edge(width: usize, height: usize, angle: f64, contrast: f64) -> Gray {
    // All values lie above the linear part of the coding.
    let light = |v: f64| math::exp(2.4 * math::ln((v + 0.055) / 1.055));
    let stored = |l: f64| 1.055 * math::exp(math::ln(l) / 2.4) - 0.055;
    let [dark, bright] = [DARK, DARK + contrast].map(light);
    blurred_edge(width, height, angle, |share| {
        stored(dark + (bright - dark) * share)
    })
}

/// Grey values by the share of the brighter side in the blurred edge.
fn blurred_edge(width: usize, height: usize, angle: f64, value: impl Fn(f64) -> f64) -> Gray {
    let empty = Gray::new(width, height);
    Gray::from_fn(width, height, |x, y| {
        let p = Point2::new(x as f64 + 0.5, y as f64 + 0.5);
        let d = distance_to_edge(&empty, angle, &p);
        let share = 0.5 * (1.0 + libm::erf(d / (BLUR_PX * std::f64::consts::SQRT_2)));
        value(share) as f32
    })
}

/// Signed distance of a point from the edge of [`step_edge`], px, positive on the brighter side.
pub(super) fn distance_to_edge(gray: &Gray, angle: f64, point: &Point2<f64>) -> f64 {
    let (s, c) = crate::base::math::sin_cos(angle);
    // A little off the middle of the image: no symmetry that hides a shift.
    let centre = Point2::new(
        gray.width as f64 / 2.0 + 0.2,
        gray.height as f64 / 2.0 - 0.3,
    );
    Vector2::new(c, s).dot(&(point - centre))
}

/// Adds white noise of standard deviation `sigma` (nearly normal: the sum of twelve uniform
/// numbers).
pub(super) fn add_noise(gray: &mut Gray, sigma: f64, seed: u64) {
    let mut random = Xorshift(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1);
    for value in &mut gray.data {
        let sum: f64 = (0..12).map(|_| random.uniform()).sum();
        *value += (sigma * (sum - 6.0)) as f32;
    }
}

/// An edgel with a gradient of length one in noise of one half.
pub(super) fn edgel(x: f64, y: f64, gradient: (f32, f32)) -> Edgel {
    Edgel {
        position: Point2::new(x, y),
        gradient: Vector2::new(gradient.0, gradient.1),
        strength: 1.0,
        noise: 0.5,
    }
}

/// Marsaglia's generator of uniform numbers.
struct Xorshift(u64);

impl Xorshift {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
