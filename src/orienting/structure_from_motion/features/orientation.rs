//! Dominant directions of the gradient around a keypoint (Lowe 2004, section 5).

use super::extrema::Extremum;
use super::gradient::{Decay, gradient};
use super::scale_space::{Octave, SCALES, sigma_at};

/// Bins of the histogram of directions, of ten degrees (Lowe 2004, section 5).
const BINS: usize = 36;

/// Weights fall with this many times the blur of the keypoint.
const WINDOW: f64 = 1.5;

/// Peaks of at least this share of the highest one give a keypoint of their own.
const PEAK_SHARE: f32 = 0.8;

/// Most directions of one place. Assumption: a third one is rarely matched.
const MOST_DIRECTIONS: usize = 2;

thread_local! {
    static DECAY: Decay = Decay::new();
}

/// The image of the octave whose blur is nearest to a keypoint's.
pub(super) fn nearest_image(scale: f64) -> usize {
    (scale.round() as usize).clamp(1, SCALES)
}

/// At most two directions in radians, that of the highest peak first.
pub(super) fn dominant(octave: &Octave, extremum: &Extremum) -> Vec<f32> {
    let [x, y, scale] = extremum.in_octave;
    let image = &octave.images[nearest_image(scale)];
    let sigma = WINDOW * sigma_at(scale);
    let radius = (3.0 * sigma).round() as isize;
    let falloff = (0.5 / (sigma * sigma)) as f32;
    let (cx, cy) = (x.round() as isize, y.round() as isize);
    let (fx, fy) = ((x - cx as f64) as f32, (y - cy as f64) as f32);
    let mut histogram = [0.0f32; BINS];
    DECAY.with(|decay| {
        for dy in -radius..=radius {
            let row = cy + dy;
            if row < 1 || row + 1 >= image.height as isize {
                continue;
            }
            for dx in -radius..=radius {
                let column = cx + dx;
                if column < 1 || column + 1 >= image.width as isize {
                    continue;
                }
                let (ox, oy) = (dx as f32 - fx, dy as f32 - fy);
                let weight = decay.at((ox * ox + oy * oy) * falloff);
                let (length, angle) = gradient(image, column as usize, row as usize);
                let bin = (angle / std::f32::consts::TAU + 1.0) * BINS as f32 + 0.5;
                histogram[bin as usize % BINS] += weight * length;
            }
        }
    });
    peaks(&smoothed(&histogram))
}

/// Twice the binomial filter of five.
fn smoothed(histogram: &[f32; BINS]) -> [f32; BINS] {
    let once = |h: &[f32; BINS]| {
        let at = |i: usize| h[i % BINS];
        std::array::from_fn(|i| {
            let i = i + BINS;
            (at(i - 2) + at(i + 2)) / 16.0 + (at(i - 1) + at(i + 1)) / 4.0 + at(i) * 0.375
        })
    };
    once(&once(histogram))
}

fn peaks(histogram: &[f32; BINS]) -> Vec<f32> {
    let highest = histogram
        .iter()
        .fold(0.0f32, |a, &b| if b > a { b } else { a });
    if highest <= 0.0 {
        return Vec::new();
    }
    let mut peaks: Vec<(f32, f32)> = Vec::new();
    for i in 0..BINS {
        let (left, right) = (histogram[(i + BINS - 1) % BINS], histogram[(i + 1) % BINS]);
        let value = histogram[i];
        if value > left && value >= right && value >= PEAK_SHARE * highest {
            let offset = 0.5 * (left - right) / (left + right - 2.0 * value);
            let turn = (i as f32 + offset) / BINS as f32;
            peaks.push((value, turn * std::f32::consts::TAU));
        }
    }
    peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
    peaks.truncate(MOST_DIRECTIONS);
    peaks.into_iter().map(|(_, angle)| angle).collect()
}
