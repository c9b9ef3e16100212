//! Gradients of one image of a scale space around a keypoint, in plain arithmetic: the same bits on
//! every target, and fast.

use crate::photographs::raster::Gray;

/// Length and direction (radians, -pi to pi) of the gradient at a pixel that is not at the border.
#[inline]
pub(super) fn gradient(image: &Gray, x: usize, y: usize) -> (f32, f32) {
    let i = y * image.width + x;
    let dx = image.data[i + 1] - image.data[i - 1];
    let dy = image.data[i + image.width] - image.data[i - image.width];
    ((dx * dx + dy * dy).sqrt(), angle_of(dy, dx))
}

/// atan2 by a polynomial, to 1e-4 radians (Abramowitz, Stegun 4.4.49, shortened).
#[inline]
pub(super) fn angle_of(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    let (low, high) = if ax > ay { (ay, ax) } else { (ax, ay) };
    let t = low / (high + f32::MIN_POSITIVE);
    let t2 = t * t;
    let a = t
        * (0.999_866
            + t2 * (-0.330_299_5 + t2 * (0.180_141 + t2 * (-0.085_133 + t2 * 0.020_835_1))));
    let a = if ay > ax {
        std::f32::consts::FRAC_PI_2 - a
    } else {
        a
    };
    let a = if x < 0.0 { std::f32::consts::PI - a } else { a };
    if y < 0.0 { -a } else { a }
}

/// exp(-x) for x >= 0, to 1e-4: from a table, as weights need no more.
pub(super) struct Decay {
    table: Vec<f32>,
}

impl Decay {
    // Entries of the table for each unit: between two a straight line is off by at most 1 / (8 *
    // 64^2), 3e-5.
    const ENTRIES_PER_UNIT: f32 = 64.0;
    // Where the table ends: exp(-12) is 6e-6.
    const LARGEST_ARGUMENT: usize = 12;

    pub(super) fn new() -> Self {
        let entries = 0..=Self::LARGEST_ARGUMENT * Self::ENTRIES_PER_UNIT as usize + 1;
        let value = |i: usize| {
            crate::base::math::exp(-(i as f64) / f64::from(Self::ENTRIES_PER_UNIT)) as f32
        };
        Self {
            table: entries.map(value).collect(),
        }
    }

    #[inline]
    pub(super) fn at(&self, x: f32) -> f32 {
        let x = x * Self::ENTRIES_PER_UNIT;
        let i = x as usize;
        match self.table.get(i..i + 2) {
            Some(pair) => pair[0] + (pair[1] - pair[0]) * (x - i as f32),
            None => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_and_weights_are_close_to_those_of_the_library() {
        for i in 0..360 {
            let (sin, cos) = crate::base::math::sin_cos(f64::from(i).to_radians());
            let expected = crate::base::math::atan2(sin, cos) as f32;
            let off = (angle_of(sin as f32, cos as f32) - expected).abs();
            assert!(
                off < 1e-4 || (off - std::f32::consts::TAU).abs() < 1e-4,
                "{i}: {off}"
            );
        }
        assert_eq!(angle_of(0.0, 0.0), 0.0);
        let decay = Decay::new();
        for i in 0..130 {
            let x = 0.1 * f64::from(i);
            let off = f64::from(decay.at(x as f32)) - crate::base::math::exp(-x);
            assert!(off.abs() < 1e-4, "{x}: {off}");
        }
    }
}
