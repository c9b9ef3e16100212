//! Elementary functions that give the same bits on every target.
//!
//! The standard library calls the platform's own `sin`, `exp`, ... which differ in the last bit
//! between native and wasm. Everything here is crate `libm`, compiled from the same source
//! everywhere. (`sqrt`, `abs`, `floor`, `round` are exact by IEEE 754 and may be used directly.)

pub(crate) use libm::{
    acos, asin, asinh, atan, atan2, cos, cosh, erfc, exp, hypot, log as ln, log2, sin, sinh,
};

/// The larger of two numbers, neither NaN: `f64::max`, which treats NaN, is a call in wasm.
#[inline]
pub(crate) fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The smaller of two numbers, neither NaN.
#[inline]
pub(crate) fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// Sine and cosine of an angle in radians.
pub(crate) fn sin_cos(angle: f64) -> (f64, f64) {
    (sin(angle), cos(angle))
}

/// Deviations of so many standard deviations are none of chance, of how many quantities ever they
/// are the largest. Assumption.
pub(crate) const SURE_RESIDUAL_SIGMAS: f64 = 4.0;

/// Median length of a vector of two normal components, in their standard deviation (Rayleigh).
pub(crate) const RAYLEIGH_MEDIAN: f64 = 1.177_41;

/// Standard deviation of a normal distribution over the median of its absolute deviations.
pub(crate) const SIGMA_OVER_MEDIAN: f64 = 1.4826;

/// Density of the normal distribution about 0; as good as nothing beyond thirty standard
/// deviations.
pub(crate) fn normal_density(x: f64, sigma: f64) -> f64 {
    /// Its integral over t.
    const SQRT_TWO_PI: f64 = 2.506_628_274_631_000_2;
    let t = smaller((x / sigma).abs(), 30.0);
    exp(-0.5 * t * t) / (sigma * SQRT_TWO_PI)
}

/// Median of the values (the lower of the two middle ones for an even count); `None` when empty.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = (values.len() - 1) / 2;
    let (_, m, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*m)
}
