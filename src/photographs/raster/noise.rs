//! Standard deviation of the noise of an image (Immerkaer 1996, "Fast noise variance estimation").
//!
//! The difference of two Laplacians is zero on planes and nearly so on edges: on a flat area it is
//! noise. The median instead of the published mean keeps textured areas out.

use super::gray::Gray;

/// Only every fourth row is used, because noise is everywhere.
const ROW_STEP: usize = 4;
/// Standard deviation of the response to white noise of standard deviation one.
const GAIN: f64 = 6.0;
/// Median of the absolute value of a standard normal variable.
const MEDIAN_OF_NORMAL: f64 = 0.6745;
/// Standard deviation of rounding to 256 grey values.
const QUANTISATION: f64 = 0.29 / 255.0;

/// Standard deviation of the noise of one pixel, grey values 0 to 1; never below that of rounding.
pub fn estimate_noise(gray: &Gray) -> f64 {
    let rows = (1..gray.height.saturating_sub(1)).step_by(ROW_STEP);
    let mut responses: Vec<f64> = rows
        .flat_map(|y| (1..gray.width.saturating_sub(1)).map(move |x| (x, y)))
        .map(|(x, y)| f64::from(response(gray, x, y).abs()))
        .collect();
    let median = crate::base::math::median(&mut responses).unwrap_or(0.0);
    (median / (MEDIAN_OF_NORMAL * GAIN)).max(QUANTISATION)
}

/// The mask (1 -2 1; -2 4 -2; 1 -2 1) around a pixel.
fn response(gray: &Gray, x: usize, y: usize) -> f32 {
    let row = |y: usize| gray.get(x - 1, y) - 2.0 * gray.get(x, y) + gray.get(x + 1, y);
    row(y - 1) - 2.0 * row(y) + row(y + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing::uniform;

    /// A slope, a step and white noise of known size.
    fn noisy(sigma: f32) -> Gray {
        let mut next = uniform(7);
        Gray::from_fn(200, 160, |x, y| {
            let white = (0..12).map(|_| next() as f32 - 0.5).sum::<f32>() * sigma;
            0.2 + 0.001 * x as f32 + if x + y > 170 { 0.3 } else { 0.0 } + white
        })
    }

    #[test]
    fn planted_noise_is_recovered_beside_slopes_and_edges() {
        for sigma in [0.004f32, 0.01, 0.03] {
            let found = estimate_noise(&noisy(sigma));
            assert!(
                (found / f64::from(sigma) - 1.0).abs() < 0.06,
                "{found} of {sigma}"
            );
        }
    }

    #[test]
    fn without_noise_or_pixels_rounding_remains() {
        for gray in [
            noisy(0.0),
            Gray::from_fn(2, 2, |_, _| 0.5),
            Gray::from_fn(0, 0, |_, _| 0.5),
        ] {
            assert_eq!(estimate_noise(&gray), QUANTISATION);
        }
    }
}
