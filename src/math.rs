//! Elementary functions that give the same bits on every target.
//!
//! The standard library calls the platform's own `sin`, `exp`, ... which differ in the last bit
//! between native and wasm. Everything here is crate `libm`, compiled from the same source
//! everywhere. (`sqrt`, `abs`, `floor`, `round` are exact by IEEE 754 and may be used directly.)

pub use libm::{acos, asin, atan, atan2, cos, exp, hypot, log as ln, log2, pow, sin, tan};
pub use libm::{cosf, expf, hypotf, sinf};

/// The larger of two numbers, neither NaN: `f64::max`, which treats NaN, is a call in wasm.
#[inline]
pub fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The smaller of two numbers, neither NaN.
#[inline]
pub fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// Sine and cosine of an angle in radians.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    (sin(angle), cos(angle))
}

/// Angle in radians between two directions, independent of their sign: 0 to pi/2.
pub fn angle_between_axes(a: &nalgebra::Vector3<f64>, b: &nalgebra::Vector3<f64>) -> f64 {
    // atan2 keeps full precision for nearly parallel axes, where acos loses half the digits.
    atan2(a.cross(b).norm(), a.dot(b).abs())
}

/// Median of the values (the lower of the two middle ones for an even count); `None` when empty.
pub fn median(values: &mut [f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = (values.len() - 1) / 2;
    let (_, m, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*m)
}
