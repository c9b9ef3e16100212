//! Edgels: a local Canny detector with sub-pixel positions (B99 3.2).
//!
//! The image is smoothed by a Gaussian and differentiated centrally. An edgel is a pixel whose gradient
//! is stronger than both neighbours along the gradient; its position is the top of the parabola through
//! the three. The threshold is a multiple of the local gradient noise ([`super::noise`]), because the paper
//! gives none and one number cannot suit both a plain roof and a tree. Canny's hysteresis acts on
//! whole chains, see [`super::chain`].

use nalgebra::{Point2, Vector2};
use serde::Serialize;

use super::noise::LocalStrengths;
use crate::params::EdgelParams;
use crate::raster::{Gray, gaussian_blur};

/// A point of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Edgel {
    /// Position, px (centre of the top-left pixel at (0.5, 0.5)); inside the pixel that found it.
    pub position: Point2<f64>,
    /// Gradient of the smoothed image, grey values per px: points to the brighter side.
    pub gradient: Vector2<f32>,
    /// Length of the gradient.
    pub strength: f32,
    /// Standard deviation of a gradient component around here, grey values per px.
    pub noise: f32,
}

impl Edgel {
    /// Unit direction along the edge, with the brighter side to the right as seen on the screen: then
    /// [`crate::geometry::Segment2::normal`] of a segment that runs this way points to the brighter side.
    pub fn tangent(&self) -> Vector2<f64> {
        let length = f64::from(self.strength);
        Vector2::new(
            f64::from(self.gradient.y) / length,
            -f64::from(self.gradient.x) / length,
        )
    }

    /// Column and row of the pixel that found it.
    pub fn pixel(&self) -> (usize, usize) {
        (self.position.x as usize, self.position.y as usize)
    }
}

/// The edgels of an image, row by row. Nothing closer than two pixels to the border is found.
pub fn detect_edgels(gray: &Gray, params: &EdgelParams) -> Vec<Edgel> {
    let gradient = Gradient::new(&gaussian_blur(gray, params.smoothing_px));
    suppress(&gradient, &gradient.statistics(), params.low)
}

/// Gradient of a smoothed image, row by row; zero on the border pixels.
pub struct Gradient {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Derivative to the right, grey values per px.
    pub x: Vec<f32>,
    /// Derivative downwards, grey values per px.
    pub y: Vec<f32>,
    /// Length of the gradient.
    pub strength: Vec<f32>,
}

impl Gradient {
    /// Differentiates a smoothed image.
    pub fn new(smooth: &Gray) -> Self {
        let (width, height) = (smooth.width, smooth.height);
        let mut gradient = Self {
            width,
            height,
            x: vec![0.0; width * height],
            y: vec![0.0; width * height],
            strength: vec![0.0; width * height],
        };
        if width >= 3 {
            for y in 1..height.saturating_sub(1) {
                gradient.differentiate_row(&smooth.data, y);
            }
        }
        gradient
    }

    /// Statistics of the strength.
    pub fn statistics(&self) -> LocalStrengths {
        LocalStrengths::new(&self.strength, self.width, self.height)
    }

    fn differentiate_row(&mut self, smooth: &[f32], y: usize) {
        let w = self.width;
        let row = |y: usize| &smooth[y * w..(y + 1) * w];
        let (above, here, below) = (row(y - 1), row(y), row(y + 1));
        let inner = y * w + 1..(y + 1) * w - 1;
        let (gx, gy) = (&mut self.x[inner.clone()], &mut self.y[inner.clone()]);
        let strength = &mut self.strength[inner];
        for ((g, left), right) in gx.iter_mut().zip(here).zip(&here[2..]) {
            *g = 0.5 * (right - left);
        }
        for ((g, a), b) in gy.iter_mut().zip(&above[1..]).zip(&below[1..]) {
            *g = 0.5 * (b - a);
        }
        for ((s, x), y) in strength.iter_mut().zip(gx.iter()).zip(gy.iter()) {
            *s = (x * x + y * y).sqrt();
        }
    }
}

/// Non-maximum suppression: the edgels stronger than `low` times the local noise.
pub fn suppress(gradient: &Gradient, local: &LocalStrengths, low: f64) -> Vec<Edgel> {
    let (w, h) = (gradient.width, gradient.height);
    let low = low as f32;
    let mut edgels = Vec::new();
    let mut noise = vec![0.0; w];
    for y in 2..h.saturating_sub(2) {
        local.noise_row(y, &mut noise);
        let strength = &gradient.strength[y * w..(y + 1) * w];
        for x in 2..w.saturating_sub(2) {
            if strength[x] < low * noise[x] {
                continue;
            }
            let i = y * w + x;
            if let Some(offset) = crest(gradient, i) {
                edgels.push(Edgel {
                    position: Point2::new(x as f64 + 0.5, y as f64 + 0.5) + offset,
                    gradient: Vector2::new(gradient.x[i], gradient.y[i]),
                    strength: gradient.strength[i],
                    noise: noise[x],
                });
            }
        }
    }
    edgels
}

/// Offset in px from the centre of pixel `i` to the crest of the gradient strength, across the edge; `None`
/// where a neighbour across the edge is stronger. Both components stay within half a pixel.
fn crest(gradient: &Gradient, i: usize) -> Option<Vector2<f64>> {
    let s = &gradient.strength;
    let m = s[i];
    let (gx, gy) = (gradient.x[i], gradient.y[i]);
    let along_x = gx.abs() >= gy.abs();
    let (major, minor) = if along_x {
        (1, gradient.width)
    } else {
        (gradient.width, 1)
    };
    if m <= 0.0 {
        return None;
    }
    let slope = if along_x { gy / gx } else { gx / gy };
    let f = slope.abs();
    let (ahead, behind) = if slope >= 0.0 {
        (s[i + major + minor], s[i - major - minor])
    } else {
        (s[i + major - minor], s[i - major + minor])
    };
    let ahead = s[i + major] + (ahead - s[i + major]) * f;
    let behind = s[i - major] + (behind - s[i - major]) * f;
    if ahead >= m || behind > m {
        return None;
    }
    let t = 0.5 * (ahead - behind) / (2.0 * m - ahead - behind);
    // Just inside the pixel, so that its index can be had back from the position.
    let t = f64::from(t).clamp(-0.499, 0.499);
    let slope = f64::from(slope);
    Some(if along_x {
        Vector2::new(t, t * slope)
    } else {
        Vector2::new(t * slope, t)
    })
}

#[cfg(test)]
mod tests {
    use super::super::testing::{add_noise, distance_to_edge, step_edge};
    use super::*;

    /// Edgels near the planted edge, away from the border.
    fn near_edge(gray: &Gray, angle: f64) -> Vec<(Edgel, f64)> {
        let inside = |e: &Edgel| {
            let (x, y) = e.pixel();
            (6..gray.width - 6).contains(&x) && (6..gray.height - 6).contains(&y)
        };
        detect_edgels(gray, &EdgelParams::default())
            .into_iter()
            .filter(inside)
            .map(|e| (e, distance_to_edge(gray, angle, &e.position)))
            .filter(|(_, d)| d.abs() < 1.5)
            .collect()
    }

    #[test]
    fn edgels_lie_on_a_planted_edge_without_bias() {
        for step in 0..24 {
            let angle = f64::from(step) * 15f64.to_radians() + 0.03;
            let mut gray = step_edge(80, 80, angle, 0.3);
            add_noise(&mut gray, 2.0 / 255.0, step as u64);
            let found = near_edge(&gray, angle);
            assert!(found.len() >= 60, "{} at {angle}", found.len());
            let n = found.len() as f64;
            let mean = found.iter().map(|(_, d)| d).sum::<f64>() / n;
            let rms = (found.iter().map(|(_, d)| d * d).sum::<f64>() / n).sqrt();
            assert!(rms <= 0.1, "rms {rms} at {angle}");
            assert!(mean.abs() <= 0.03, "mean {mean} at {angle}");
        }
    }

    #[test]
    fn the_gradient_points_to_the_brighter_side() {
        for angle in [0.2, 1.7, 3.0, 5.1] {
            let gray = step_edge(80, 80, angle, 0.3);
            for (e, _) in near_edge(&gray, angle) {
                let brighter = e.position + e.gradient.cast::<f64>().normalize() * 3.0;
                assert!(distance_to_edge(&gray, angle, &brighter) > 2.0);
                let t = e.tangent();
                assert!(Vector2::new(-t.y, t.x).dot(&e.gradient.cast::<f64>()) > 0.0);
            }
        }
    }

    #[test]
    fn tiny_and_flat_images_have_no_edgels() {
        for (w, h) in [(0, 0), (1, 1), (2, 9), (9, 2), (5, 5), (40, 3)] {
            let gray = Gray::from_fn(w, h, |_, _| 0.5);
            assert!(detect_edgels(&gray, &EdgelParams::default()).is_empty());
        }
    }
}
