//! Edgels: a local Canny detector with sub-pixel positions (B99 3.2).
//!
//! The image is smoothed by a Gaussian and differentiated centrally. An edgel is a pixel whose
//! gradient is stronger than both neighbours along the gradient; its position is the top of the
//! parabola through the three. The threshold is a multiple of the local gradient noise
//! ([`super::noise`]), because the paper gives none and one number cannot suit both a plain roof
//! and a tree. Canny's hysteresis acts on whole chains, see [`super::chain`].

use nalgebra::{Point2, Vector2};
use serde::Serialize;

use super::noise::LocalStrengths;
use crate::photographs::raster::{Gray, gaussian_blur};

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
    /// Unit direction along the edge, with the brighter side to the right as seen on the screen:
    /// then [`crate::base::geometry::Segment2::normal`] of a segment that runs this way points to
    /// the brighter side.
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

/// The edgels of an image smoothed by `smoothing_px` with a gradient of at least `least`, row by
/// row. None lies closer than two pixels to the border. Their `noise` is `least`.
pub fn detect_edgels(gray: &Gray, smoothing_px: f64, least: f32) -> Vec<Edgel> {
    let smooth = gaussian_blur(gray, smoothing_px);
    suppress(&Gradient::new(&smooth), &|_, row| row.fill(least), 1.0)
}

/// Gradient of a smoothed image; zero on the border pixels. Only its length is stored, because the
/// components are needed at few pixels.
pub(crate) struct Gradient<'a> {
    smooth: &'a Gray,
    /// Length of the gradient, grey values per px, row by row.
    pub strength: Vec<f32>,
}

impl<'a> Gradient<'a> {
    /// Differentiates a smoothed image.
    pub(crate) fn new(smooth: &'a Gray) -> Self {
        let (w, h) = (smooth.width, smooth.height);
        let mut strength = vec![0.0; w * h];
        if w >= 3 {
            for y in 1..h.saturating_sub(1) {
                strength_row(
                    &smooth.data,
                    w,
                    y,
                    &mut strength[y * w + 1..(y + 1) * w - 1],
                );
            }
        }
        Self { smooth, strength }
    }

    /// Statistics of the strength.
    pub(crate) fn statistics(&self) -> LocalStrengths {
        LocalStrengths::new(&self.strength, self.smooth.width, self.smooth.height)
    }

    /// Derivatives to the right and downwards at an inner pixel, grey values per px.
    fn at(&self, i: usize) -> Vector2<f32> {
        let (s, w) = (&self.smooth.data, self.smooth.width);
        Vector2::new(0.5 * (s[i + 1] - s[i - 1]), 0.5 * (s[i + w] - s[i - w]))
    }
}

fn strength_row(smooth: &[f32], w: usize, y: usize, out: &mut [f32]) {
    let n = out.len();
    let row = |y: usize, x: usize| &smooth[y * w + x..][..n];
    let (left, right) = (row(y, 0), row(y, 2));
    let (above, below) = (row(y - 1, 1), row(y + 1, 1));
    for (i, out) in out.iter_mut().enumerate() {
        let (gx, gy) = (0.5 * (right[i] - left[i]), 0.5 * (below[i] - above[i]));
        *out = (gx * gx + gy * gy).sqrt();
    }
}

/// Non-maximum suppression: the edgels stronger than `low` times the local noise, which
/// `noise_row` writes for a row.
pub(crate) fn suppress(
    gradient: &Gradient,
    noise_row: &dyn Fn(usize, &mut [f32]),
    low: f64,
) -> Vec<Edgel> {
    let (w, h) = (gradient.smooth.width, gradient.smooth.height);
    let low = low as f32;
    let mut edgels = Vec::new();
    let mut noise = vec![0.0; w];
    for y in 2..h.saturating_sub(2) {
        noise_row(y, &mut noise);
        let strength = &gradient.strength[y * w..(y + 1) * w];
        for x in 2..w.saturating_sub(2) {
            if strength[x] < low * noise[x] {
                continue;
            }
            let i = y * w + x;
            let g = gradient.at(i);
            if let Some(offset) = crest(&gradient.strength, w, i, &g) {
                edgels.push(Edgel {
                    position: Point2::new(x as f64 + 0.5, y as f64 + 0.5) + offset,
                    gradient: g,
                    strength: gradient.strength[i],
                    noise: noise[x],
                });
            }
        }
    }
    edgels
}

/// Offset in px from the centre of pixel `i` to the crest of the gradient strength, across the
/// edge; `None` where a neighbour across the edge is stronger. Both components stay within half a
/// pixel.
fn crest(s: &[f32], width: usize, i: usize, gradient: &Vector2<f32>) -> Option<Vector2<f64>> {
    let (gx, gy) = (gradient.x, gradient.y);
    let along_x = gx.abs() >= gy.abs();
    let (major, minor) = if along_x { (1, width) } else { (width, 1) };
    let (large, small) = if along_x { (gx, gy) } else { (gy, gx) };
    let diagonal = if (gx >= 0.0) == (gy >= 0.0) {
        major + minor
    } else {
        // Wraps below zero and back where it is added.
        major.wrapping_sub(minor)
    };
    if large == 0.0 {
        return None;
    }
    // Interpolated strengths one step along the larger component, all times its size, which saves
    // the division.
    let (large_size, small_size) = (large.abs(), small.abs());
    let mix = |near: usize, far: usize| s[near] * (large_size - small_size) + s[far] * small_size;
    let m = s[i] * large_size;
    let ahead = mix(i + major, i.wrapping_add(diagonal));
    let behind = mix(i - major, i.wrapping_sub(diagonal));
    if ahead >= m || behind > m {
        return None;
    }
    let t = 0.5 * (ahead - behind) / (2.0 * m - ahead - behind);
    // Just inside the pixel, so that its index follows from the position.
    let t = f64::from(t).clamp(-0.499, 0.499);
    let slope = f64::from(small / large);
    Some(if along_x {
        Vector2::new(t, t * slope)
    } else {
        Vector2::new(t * slope, t)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::params::EdgelParams;
    use crate::lines::lines2d::testing::{add_noise, distance_to_edge, step_edge};

    fn local_edgels(gray: &Gray) -> Vec<Edgel> {
        let params = EdgelParams::default();
        let smooth = gaussian_blur(gray, params.smoothing_px);
        let gradient = Gradient::new(&smooth);
        let local = gradient.statistics();
        suppress(&gradient, &|y, row| local.noise_row(y, row), params.low)
    }

    /// Edgels near the planted edge, away from the border.
    fn near_edge(gray: &Gray, angle: f64) -> Vec<(Edgel, f64)> {
        let inside = |e: &Edgel| {
            let (x, y) = e.pixel();
            (6..gray.width - 6).contains(&x) && (6..gray.height - 6).contains(&y)
        };
        local_edgels(gray)
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
    fn tiny_and_flat_images_have_no_edgels() {
        for (w, h) in [(0, 0), (1, 1), (2, 9), (9, 2), (5, 5), (40, 3)] {
            let gray = Gray::from_fn(w, h, |_, _| 0.5);
            assert!(local_edgels(&gray).is_empty());
            assert!(detect_edgels(&gray, 1.0, 0.004).is_empty());
        }
    }
}
