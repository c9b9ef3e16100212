//! The description length that segmentation minimises.

use super::integrals::{CHANNELS, RegionMoments};
use crate::base::math::{larger, log2};
use crate::base::params::OrisParams;

/// Pixels that make one independent grey value. Assumption: resampling and compression
/// correlate neighbours.
const PIXELS_PER_SAMPLE: f64 = 1.7;
/// Weight of each of the two colour differences beside grey. Assumption: they are smoother, and
/// JPEG stores them at half the resolution.
const COLOR_WEIGHT: f64 = 0.5;

/// Gains below this are rounding, bits.
pub(crate) const LEAST_GAIN: f64 = 1e-6;

/// The code length, bits; see [`super`].
#[derive(Clone, Copy)]
pub(crate) struct CodeLength {
    /// Bits of a vector.
    pub vector_bits: f64,
    least_variance: f64,
    weights: [f64; CHANNELS],
}

impl CodeLength {
    pub(super) fn new(params: &OrisParams) -> Self {
        Self {
            vector_bits: params.vector_bits,
            least_variance: params.least_sigma * params.least_sigma,
            weights: [1.0, COLOR_WEIGHT, COLOR_WEIGHT],
        }
    }

    /// Bits of a region: its grey values given mean and noise, and these two parameters.
    pub(super) fn region(&self, m: &RegionMoments) -> f64 {
        let samples = m.count as f64 / PIXELS_PER_SAMPLE;
        let spread: f64 = (0..CHANNELS)
            .map(|c| self.weights[c] * log2(larger(m.variance(c), self.least_variance)))
            .sum();
        0.5 * samples * spread + log2(larger(samples, 1.0))
    }
}
