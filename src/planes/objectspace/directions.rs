//! Main directions (W96 3.4, figures 4 and 5): two horizontal, perpendicular directions of a
//! building.
//!
//! The interpretation plane of every image line is cut with the XY plane. For a horizontal line the
//! cut is parallel to the line itself, from every view; for any other line it is some direction
//! that differs from view to view. The azimuths of all cuts of all views fill one histogram, each
//! weighted with the length and the contrast of its line, and two peaks that are perpendicular are
//! located together: the sum of the histogram at an azimuth and a right angle further is largest.
//!
//! W96 assumes one building. A window may hold several orientations: peaks are taken in turn while
//! they stand out.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::image_lines::ImageLine;
use crate::base::least_squares::Loss;
use crate::base::math::{atan2, exp, ln, sin_cos};
use crate::base::params::DirectionParams;

/// A line within this of a direction follows it, degrees. Assumption.
const TOLERANCE_DEG: f64 = 2.0;
/// Pairs are at least so far apart, degrees. Assumption.
const APART_DEG: f64 = 6.0;

/// A pair of perpendicular horizontal directions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct MainDirections {
    /// Azimuth of the first direction from the X axis towards Y, radians, 0 to pi/2; the other is a
    /// right angle further.
    pub azimuth: f64,
    /// Share of the weight of all lines that points either way.
    pub share: f64,
}

impl MainDirections {
    /// Both unit directions.
    pub fn axes(&self) -> [Vector3<f64>; 2] {
        let (s, c) = sin_cos(self.azimuth);
        [Vector3::new(c, s, 0.0), Vector3::new(-s, c, 0.0)]
    }
}

/// The histogram and what was read from it (figure 5).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct DirectionTrace {
    /// Weight of the azimuths 0 to 180 degrees, in bins of `bin_deg`, smoothed.
    pub histogram: Vec<f64>,
    /// Width of a bin, degrees.
    pub bin_deg: f64,
    /// The accepted pairs.
    pub found: Vec<MainDirections>,
}

/// Bins of half a degree: half of what an average line is accurate to.
const BINS: usize = 360;
/// Contrasts above this add no more weight: a white line on a road is no better edge than an eave.
const FULL_CONTRAST: f64 = 0.1;

/// The main directions of the lines, those of the largest weight first.
pub fn main_directions(
    image_lines: &[ImageLine],
    params: &DirectionParams,
) -> (Vec<MainDirections>, DirectionTrace) {
    let cuts: Vec<[f64; 2]> = image_lines.iter().filter_map(azimuth).collect();
    directions_of(&cuts, params)
}

/// The same from (azimuth in radians, weight).
fn directions_of(
    cuts: &[[f64; 2]],
    params: &DirectionParams,
) -> (Vec<MainDirections>, DirectionTrace) {
    let histogram = histogram(cuts);
    let total: f64 = cuts.iter().map(|c| c[1]).sum();
    let mut free: Vec<f64> = (0..BINS / 2)
        .map(|k| histogram[k] + histogram[k + BINS / 2])
        .collect();
    let mut found: Vec<MainDirections> = Vec::new();
    let bin = std::f64::consts::PI / BINS as f64;
    let apart = (APART_DEG.to_radians() / bin) as usize;
    while found.len() < params.max_pairs {
        let best = (0..free.len()).max_by(|&a, &b| free[a].total_cmp(&free[b]).then(b.cmp(&a)));
        let Some(best) = best.filter(|&b| free[b] > 0.0) else {
            break;
        };
        let azimuth = refined((best as f64 + 0.5) * bin, cuts);
        let share = share(azimuth, cuts, TOLERANCE_DEG.to_radians()) / total;
        if share < params.min_share {
            break;
        }
        found.push(MainDirections { azimuth, share });
        for k in 0..=2 * apart {
            let n = free.len();
            free[(best + n + k - apart) % n] = 0.0;
        }
    }
    let trace = DirectionTrace {
        histogram,
        bin_deg: 180.0 / BINS as f64,
        found: found.clone(),
    };
    (found, trace)
}

/// Share of the weight of the lines that points along an azimuth (radians) or at right angles to
/// it.
pub(super) fn share_of(lines: &[ImageLine], along: f64) -> f64 {
    let cuts: Vec<[f64; 2]> = lines.iter().filter_map(azimuth).collect();
    let total: f64 = cuts.iter().map(|c| c[1]).sum();
    match total > 0.0 {
        true => share(along, &cuts, TOLERANCE_DEG.to_radians()) / total,
        false => 0.0,
    }
}

/// Azimuth of a line from the X axis towards Y, up to right angles, with its standard deviation;
/// radians.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct MeasuredAzimuth {
    pub radians: f64,
    pub sigma: f64,
}

impl MeasuredAzimuth {
    /// The weighted mean of azimuths about `start`; `None` of nothing.
    pub(super) fn mean(start: f64, measured: impl Iterator<Item = Self>) -> Option<Self> {
        let (mut sum, mut weights) = (0.0, 0.0);
        for m in measured {
            let weight = 1.0 / (m.sigma * m.sigma);
            sum += weight * difference(m.radians, start);
            weights += weight;
        }
        (weights > 0.0).then(|| Self {
            radians: (start + sum / weights).rem_euclid(FRAC_PI_2),
            sigma: 1.0 / weights.sqrt(),
        })
    }

    /// The azimuth of a horizontal line from where the interpretation planes of its image lines cut
    /// the XY plane; `sigma_px` is the error of either end of an image line.
    pub(super) fn of_line(start: f64, image_lines: &[&ImageLine], sigma_px: f64) -> Option<Self> {
        let cuts = image_lines.iter().filter_map(|line| {
            let [radians, _] = azimuth(line)?;
            let sigma = std::f64::consts::SQRT_2 * sigma_px / line.length_px;
            Some(Self { radians, sigma })
        });
        Self::mean(start, cuts)
    }
}

/// The directions of lines, by their description length, nats, and which of them each line follows.
///
/// ```text
/// L = sum over lines       min(d^2 / (2 s^2) + ln(s sqrt(2 pi) K), ln(pi / 2))
///   + sum over directions  ln(pi / 2 / s)
/// ```
///
/// A line runs along one of K directions but for its standard deviation s, or anywhere; a direction
/// is stated as exactly as its lines know it. The one that saves most is added while any does.
pub(super) fn directions_by_length(
    lines: &[MeasuredAzimuth],
) -> (Vec<MeasuredAzimuth>, Vec<Option<usize>>) {
    let mut best = (Vec::new(), vec![None; lines.len()]);
    let mut least = described(&best.0, lines).0;
    loop {
        let mut next = None;
        for start in lines {
            let mut directions = best.0.clone();
            directions.push(*start);
            // Lines are divided among the directions and these averaged. Assumption: three times
            // settle it.
            const REASSIGNMENT_ROUNDS: usize = 3;
            for _ in 0..REASSIGNMENT_ROUNDS {
                let along = described(&directions, lines).1;
                for (k, direction) in directions.iter_mut().enumerate() {
                    let own = lines.iter().zip(&along).filter(|(_, d)| **d == Some(k));
                    let mean = MeasuredAzimuth::mean(direction.radians, own.map(|(l, _)| *l));
                    *direction = mean.unwrap_or(*direction);
                }
            }
            let (length, along) = described(&directions, lines);
            if length < least {
                least = length;
                next = Some((directions, along));
            }
        }
        match next {
            Some(better) => best = better,
            None => return best,
        }
    }
}

/// The description length of lines with these directions, and the direction of each line.
fn described(
    directions: &[MeasuredAzimuth],
    lines: &[MeasuredAzimuth],
) -> (f64, Vec<Option<usize>>) {
    let anywhere = ln(FRAC_PI_2);
    let mut length: f64 = directions.iter().map(|d| anywhere - ln(d.sigma)).sum();
    let choices = ln(directions.len().max(1) as f64);
    let along = lines.iter().map(|line| {
        let along = directions.iter().enumerate().map(|(k, d)| {
            let t = difference(line.radians, d.radians) / line.sigma;
            (0.5 * t * t + ln(line.sigma * TAU.sqrt()) + choices, k)
        });
        let nearest = along.min_by(|a, b| a.0.total_cmp(&b.0));
        let followed = nearest.filter(|(nats, _)| *nats < anywhere);
        length += followed.map_or(anywhere, |(nats, _)| nats);
        followed.map(|(_, k)| k)
    });
    let along = along.collect();
    (length, along)
}

/// Azimuth, 0 to pi, and weight of the cut of an interpretation plane with the XY plane; `None` for
/// a horizontal plane.
fn azimuth(image_line: &ImageLine) -> Option<[f64; 2]> {
    let n = image_line.normal;
    (n.x * n.x + n.y * n.y > 1e-12).then(|| {
        let a = atan2(n.x, -n.y).rem_euclid(std::f64::consts::PI);
        [
            a,
            image_line.length_px * image_line.contrast.min(FULL_CONTRAST),
        ]
    })
}

fn histogram(cuts: &[[f64; 2]]) -> Vec<f64> {
    let mut raw = vec![0.0; BINS];
    for [azimuth, weight] in cuts {
        let k = (azimuth / std::f64::consts::PI * BINS as f64) as usize % BINS;
        raw[k] += weight;
    }
    // Smoothed with the accuracy of an average line, 1 degree.
    const SIGMA_BINS: f64 = 2.0;
    const REACH: usize = 6;
    let kernel: Vec<f64> = (0..=REACH)
        .map(|k| exp(-0.5 * (k * k) as f64 / (SIGMA_BINS * SIGMA_BINS)))
        .collect();
    let at = |k: usize| {
        (1..=REACH).fold(kernel[0] * raw[k], |s, i| {
            s + kernel[i] * (raw[(k + i) % BINS] + raw[(k + BINS - i) % BINS])
        })
    };
    (0..BINS).map(at).collect()
}

/// Difference of two azimuths up to right angles, radians, -pi/4 to pi/4.
fn difference(a: f64, b: f64) -> f64 {
    let d = (a - b).rem_euclid(FRAC_PI_2);
    if d > 0.5 * FRAC_PI_2 {
        d - FRAC_PI_2
    } else {
        d
    }
}

/// The mean of the azimuths around a peak, far ones weighted down.
fn refined(start: f64, cuts: &[[f64; 2]]) -> f64 {
    // Radians. Assumption: half of an average line's degree, where weights begin to fall, and three
    // degrees, beyond which lines run along something else.
    const WEIGHT_SCALE_RADIANS: f64 = 0.01;
    const WINDOW_RADIANS: f64 = 0.05;
    const REWEIGHTING_ROUNDS: usize = 8;
    let mut azimuth = start;
    for _ in 0..REWEIGHTING_ROUNDS {
        let (mut sum, mut weights) = (0.0, 0.0);
        for [a, weight] in cuts {
            let d = difference(*a, azimuth);
            if d.abs() < WINDOW_RADIANS {
                let w = weight * Loss::Cauchy(WEIGHT_SCALE_RADIANS).weight(d * d);
                sum += w * d;
                weights += w;
            }
        }
        if weights > 0.0 {
            azimuth += sum / weights;
        }
    }
    azimuth.rem_euclid(FRAC_PI_2)
}

fn share(azimuth: f64, cuts: &[[f64; 2]], tolerance: f64) -> f64 {
    cuts.iter()
        .filter(|c| difference(c[0], azimuth).abs() < tolerance)
        .map(|c| c[1])
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn directions_are_found_among_unrelated_lines(
            azimuth in 0.0..90.0f64,
            noise in prop::collection::vec((0.0..180.0f64, 5.0..40.0f64), 36),
            errors in prop::collection::vec(-0.7..0.7f64, 84),
        ) {
            // 30 % of the lines run anywhere.
            let mut cuts: Vec<[f64; 2]> = errors
                .iter()
                .enumerate()
                .map(|(k, e)| {
                    let a = azimuth + 90.0 * f64::from(k as u32 % 2) + e;
                    [a.rem_euclid(180.0).to_radians(), 20.0]
                })
                .collect();
            cuts.extend(noise.iter().map(|(a, w)| [a.to_radians(), *w]));
            let (found, _) = directions_of(&cuts, &DirectionParams::default());
            let d = difference(found[0].azimuth, azimuth.to_radians()).to_degrees();
            prop_assert!(d.abs() < 0.3, "{d} degrees");
            // A start beside the peak leads to it.
            for wrong in [-1.5f64, 1.5] {
                let again = refined((azimuth + wrong).to_radians(), &cuts);
                let d = difference(again, azimuth.to_radians()).to_degrees();
                prop_assert!(d.abs() < 0.3, "{d} degrees after {wrong}");
            }
        }
    }

    #[test]
    fn houses_a_degree_apart_have_directions_of_their_own() {
        let measured = |degrees: f64| MeasuredAzimuth {
            radians: degrees.to_radians(),
            sigma: 0.2f64.to_radians(),
        };
        // Two houses, one of them across the end of the range, and a line of neither.
        let lines = [0.2, 89.9, 0.1, 1.5, 1.3, 1.4, 1.6, 40.0].map(measured);
        let (directions, along) = directions_by_length(&lines);
        assert_eq!(directions.len(), 2);
        let [a, b] = [along[0].expect("a house"), along[3].expect("a house")];
        let expected = [a, a, a, b, b, b, b].map(Some);
        assert_eq!(along[..7], expected);
        assert_eq!(along[7], None);
        assert!(difference(directions[a].radians, 0.0667f64.to_radians()).abs() < 1e-4);
        // What one direction explains is not parted.
        let one = [0.2, 89.9, 0.1, 0.3, 89.8].map(measured);
        assert_eq!(directions_by_length(&one).0.len(), 1);
    }

    #[test]
    fn two_orientations_give_two_pairs() {
        let cuts: Vec<[f64; 2]> = [10.0f64, 100.0, 10.2, 35.0, 125.0]
            .map(|a| [a.to_radians(), 20.0])
            .into();
        let (found, trace) = directions_of(&cuts, &DirectionParams::default());
        assert_eq!(found.len(), 2);
        assert!((found[0].azimuth.to_degrees() - 10.1).abs() < 0.2);
        assert!((found[1].azimuth.to_degrees() - 35.0).abs() < 0.1);
        assert_eq!(trace.histogram.len(), BINS);
    }
}
