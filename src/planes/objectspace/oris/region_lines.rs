//! Image lines from the vectors of a segmentation, to a fraction of a pixel.
//!
//! Each vector is moved to the crest of the gradient across it: the place of the steepest ascent on
//! profiles one pixel apart, and a line fitted to those places, far ones weighted down. W96
//! measures with the vectors themselves and finds their accuracy "rather poor".

use nalgebra::{Matrix2, Point2, Vector2};
use serde::{Deserialize, Serialize};

use super::color::ColorImage;
use super::segmentation::Segmentation;
use crate::base::geometry::Segment2;
use crate::base::least_squares::Loss;
use crate::base::math::{hypot, median};
use crate::base::params::OrisParams;
use crate::lines::lines2d::{ImageSegment, SegmentKind};
use crate::photographs::raster::Gray;

/// Least contrast of a line, grey range 1. Assumption: three grey levels of 255.
const LEAST_CONTRAST: f64 = 0.012;
/// Largest root mean square distance of the gradient's crest from the line, px; otherwise the
/// vector itself is taken. Assumption.
const LARGEST_RMS_PX: f64 = 0.8;

/// An image line on the boundary of two regions, directed by contrast: its right side is the
/// brighter one (or the one of more red or blue, where colour shows it better).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionLine {
    /// The line with its accuracy.
    pub line: ImageSegment,
    /// Mean grey value beside it, left and right, 0 to 1.
    pub sides: [f64; 2],
    /// The vector that it was measured on.
    pub vector: u32,
}

/// The lines of all vectors that are long and clear enough, longest first.
pub fn region_lines(
    image: &ColorImage,
    segmentation: &Segmentation,
    params: &OrisParams,
) -> Vec<RegionLine> {
    let mut lines: Vec<RegionLine> = (0..segmentation.vectors.len())
        .filter_map(|k| {
            let v = &segmentation.vectors[k];
            if v.length_px() < params.min_line_px || v.sides.contains(&None) {
                return None;
            }
            let point = |p: [i32; 2]| Point2::new(f64::from(p[0]), f64::from(p[1]));
            let vector = Segment2::new(point(v.ends[0]), point(v.ends[1]));
            let channel = clearest_channel(image, &vector)?;
            let (sharp, smooth) = (&image.sharp[channel], &image.smooth[channel]);
            let mut found = measure(sharp, smooth, &vector, k as u32)?;
            if channel != 0 {
                let beside = |side| grey_beside(&image.sharp[0], &found.line.segment, side);
                found.sides = [beside(-1.0)?, beside(1.0)?];
            }
            Some(found)
        })
        .collect();
    lines.sort_by(|a, b| {
        let length = |l: &RegionLine| l.line.segment.length();
        length(b)
            .total_cmp(&length(a))
            .then(a.vector.cmp(&b.vector))
    });
    lines
}

/// Half the length of a profile across a vector, pixels: what rounding to pixels and straightening
/// may displace.
const REACH_PX: f64 = 2.0;
/// Step along a profile, pixels: two samples a pixel.
const PROFILE_STEP_PX: f64 = 0.5;
/// Distances from the line at which the grey values beside it are taken, pixels: outside the blur
/// of the edge.
const BESIDE_PX: [f64; 3] = [1.8, 2.6, 3.4];

/// The channel with the largest contrast across a vector. Grey counts twice: compression leaves
/// colour at half the resolution.
fn clearest_channel(image: &ColorImage, vector: &Segment2) -> Option<usize> {
    let mut best = (0, 0.0);
    for (c, channel) in image.sharp.iter().enumerate() {
        let contrast =
            (grey_beside(channel, vector, 1.0)? - grey_beside(channel, vector, -1.0)?).abs();
        let weighted = if c == 0 { 2.0 * contrast } else { contrast };
        if weighted > best.1 {
            best = (c, weighted);
        }
    }
    Some(best.0)
}

fn measure(gray: &Gray, smooth: &Gray, vector: &Segment2, index: u32) -> Option<RegionLine> {
    let beside = |s: &Segment2, side: f64| grey_beside(gray, s, side);
    // The bright side to the right.
    let vector = if beside(vector, 1.0)? >= beside(vector, -1.0)? {
        *vector
    } else {
        vector.reversed()
    };
    let crest = crest(smooth, &vector);
    let (segment, rms) = fit(&vector, &crest)?;
    let segment = if rms <= LARGEST_RMS_PX {
        segment
    } else {
        vector
    };
    let sides = [beside(&segment, -1.0)?, beside(&segment, 1.0)?];
    let contrast = sides[1] - sides[0];
    if contrast < LEAST_CONTRAST {
        return None;
    }
    let n = crest.len().max(2) as f64;
    let variance = (rms * rms / n).max(0.01 * 0.01);
    let length = segment.length();
    Some(RegionLine {
        line: ImageSegment {
            segment,
            contrast: contrast as f32,
            edgels: crest.len() as u32,
            covariance: Matrix2::new(variance, 0.0, 0.0, 12.0 * variance / (length * length)),
            kind: SegmentKind::default(),
        },
        sides,
        vector: index,
    })
}

/// (position along, offset across) of the steepest ascent on each profile.
fn crest(smooth: &Gray, vector: &Segment2) -> Vec<[f64; 2]> {
    let (length, direction, normal) = (vector.length(), vector.direction(), vector.normal());
    let count = (length - 2.0).max(1.0) as usize;
    let steps = (REACH_PX / PROFILE_STEP_PX) as i32;
    (0..count)
        .filter_map(|i| {
            let t = (length - count as f64 + 1.0) / 2.0 + i as f64;
            let at = |offset: f64| {
                let p = vector.p0 + direction * t + normal * offset;
                smooth.sample(p.x as f32, p.y as f32).map(f64::from)
            };
            let slope = |k: i32| {
                let offset = f64::from(k) * PROFILE_STEP_PX;
                Some(at(offset + 0.5)? - at(offset - 0.5)?)
            };
            let slopes: Vec<f64> = (-steps..=steps).map(slope).collect::<Option<_>>()?;
            let best = (1..slopes.len() - 1)
                .max_by(|&a, &b| slopes[a].total_cmp(&slopes[b]).then(b.cmp(&a)))?;
            let (before, top, after) = (slopes[best - 1], slopes[best], slopes[best + 1]);
            let bend = before - 2.0 * top + after;
            if top <= 0.0 || bend >= 0.0 || top < before || top < after {
                return None;
            }
            let shift = (0.5 * (before - after) / bend).clamp(-0.5, 0.5);
            let offset = (f64::from(best as i32 - steps) + shift) * PROFILE_STEP_PX;
            Some([t, offset])
        })
        .collect()
}

/// A line through the crest, as long as the vector, and its root mean square residual; `None` with
/// too few places.
fn fit(vector: &Segment2, crest: &[[f64; 2]]) -> Option<(Segment2, f64)> {
    if crest.len() < 4 {
        return None;
    }
    let mut offsets: Vec<f64> = crest.iter().map(|p| p[1]).collect();
    let (mut base, mut slope) = (median(&mut offsets)?, 0.0);
    let mut rms = f64::INFINITY;
    const ROUNDS: usize = 5;
    // Scale of the weights, pixels: three times what a good edge scatters.
    const SCALE_PX: f64 = 0.5;
    for _ in 0..ROUNDS {
        let (mut w, mut wt, mut wo, mut wtt, mut wto, mut wrr) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for [t, o] in crest {
            let r = o - base - slope * t;
            let weight = Loss::Cauchy(SCALE_PX).weight(r * r);
            w += weight;
            wt += weight * t;
            wo += weight * o;
            wtt += weight * t * t;
            wto += weight * t * o;
            wrr += weight * r * r;
        }
        rms = (wrr / w).sqrt();
        let spread = wtt - wt * wt / w;
        slope = if spread > 1e-9 {
            (wto - wt * wo / w) / spread
        } else {
            0.0
        };
        base = (wo - slope * wt) / w;
    }
    let (d, n) = (vector.direction(), vector.normal());
    let end = |t: f64| vector.p0 + d * t + n * (base + slope * t);
    let tilt: Vector2<f64> = Vector2::new(1.0, slope);
    // A fit that leaves the profiles has followed something else.
    let length = vector.length();
    let worst = base.abs().max((base + slope * length).abs());
    (worst <= REACH_PX && hypot(tilt.x, tilt.y).is_finite())
        .then(|| (Segment2::new(end(0.0), end(length)), rms))
}

/// Mean grey value along a line at some distance to its right (`side` 1) or left (-1).
fn grey_beside(gray: &Gray, s: &Segment2, side: f64) -> Option<f64> {
    let count = (s.length() / 1.5).max(3.0) as usize;
    let (mut sum, mut n) = (0.0, 0u32);
    for i in 0..count {
        let p = s.at((i as f64 + 0.5) / count as f64);
        for distance in BESIDE_PX {
            let q = p + s.normal() * (side * distance);
            if let Some(g) = gray.sample(q.x as f32, q.y as f32) {
                sum += f64::from(g);
                n += 1;
            }
        }
    }
    (n > 0).then(|| sum / f64::from(n))
}

#[cfg(test)]
mod tests {
    use super::super::segment_regions;
    use super::*;

    #[test]
    fn a_line_is_found_to_a_tenth_of_a_pixel() {
        // A bright half-plane above a slanted line; pixels on it are mixed.
        let line = Vector2::new(0.2, 1.0).normalize();
        let offset = line.dot(&Vector2::new(32.0, 30.3));
        let gray = Gray::from_fn(64, 60, |x, y| {
            let d = offset - line.dot(&Vector2::new(x as f64 + 0.5, y as f64 + 0.5));
            (0.3 + 0.3 * (d + 0.5).clamp(0.0, 1.0)) as f32
        });
        let params = OrisParams::default();
        let image = ColorImage::from_gray(&gray);
        let lines = region_lines(&image, &segment_regions(&image, &params), &params);
        assert_eq!(lines.len(), 1);
        let found = &lines[0];
        for p in [found.line.segment.p0, found.line.segment.p1] {
            assert!((line.dot(&p.coords) - offset).abs() < 0.1, "{p}");
        }
        // Bright above: the right of a line that runs to the left of the screen.
        assert!(found.line.segment.direction().x < 0.0);
        assert!((found.sides[1] - 0.6).abs() < 0.02 && (found.sides[0] - 0.3).abs() < 0.02);
    }
}
