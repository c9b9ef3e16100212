//! Bilinear interpolation of four or eight positions at a time.

use wide::bytemuck::cast;
use wide::{f32x4, f32x8, i32x4};

use super::gray::Gray;

impl Gray {
    /// Bilinear values at eight positions, counted from the centre of the top-left pixel, which
    /// may lie outside the image by no more than rounding.
    pub fn between(&self, x: f32x8, y: f32x8) -> f32x8 {
        // Rounding may lead before the first pixel or to the last, which has no right neighbour;
        // `bilinear` counts from half a pixel later.
        let within = |x: f32x8, size: usize| -> [f32x4; 2] {
            let last = f32x8::splat(((size - 1) as f32).next_down());
            cast(x.fast_max(f32x8::ZERO).fast_min(last) - f32x8::splat(0.5))
        };
        let ([x0, x1], [y0, y1]) = (within(x, self.width), within(y, self.height));
        cast([bilinear(self, 0, x0, y0), bilinear(self, 0, x1, y1)])
    }

    /// [`Self::sample`] at eight positions at once; NaN in place of `None`.
    pub fn sample_eight(&self, x: [f32; 8], y: [f32; 8]) -> f32x8 {
        let zero = f32x8::ZERO;
        let [x, y] = [x, y].map(|x| f32x8::from(x) - f32x8::splat(0.5));
        let [last_x, last_y] =
            [self.width, self.height].map(|n| f32x8::splat(n.saturating_sub(1) as f32));
        let inside = x.simd_ge(zero) & y.simd_ge(zero) & x.simd_lt(last_x) & y.simd_lt(last_y);
        if !inside.any() {
            return f32x8::splat(f32::NAN);
        }
        let [x, y] = [x, y].map(|x| inside.select(x, zero));
        inside.select(self.between(x, y), f32x8::splat(f32::NAN))
    }
}

/// Bilinear values at coordinates counted from half a pixel right of and below the centre of pixel
/// `first`, which must have a right and a lower neighbour.
// Inlining is forced because the calls took longer than the four samples they were for.
#[inline(always)]
pub(crate) fn bilinear(image: &Gray, first: usize, x: f32x4, y: f32x4) -> f32x4 {
    // Adding 1.5 x 2^23 rounds to a whole number, which the last bits then hold: a conversion
    // would cost six instructions of wasm.
    const SHIFT: f32 = 12_582_912.0;
    const SHIFT_BITS: i32 = SHIFT.to_bits() as i32;
    // Masked to these bits, the sum of an index and a width cannot overflow and needs no check.
    const INDEX: i32 = i32::MAX;
    const WIDTH: i32 = i32::MAX / 2;
    let (shift, half) = (f32x4::splat(SHIFT), f32x4::splat(0.5));
    let (column, row) = (x + shift, y + shift);
    let (fx, fy) = (x - (column - shift) + half, y - (row - shift) + half);
    let width = image.width as i32 & WIDTH;
    let first = (first as i32)
        .wrapping_sub(SHIFT_BITS)
        .wrapping_sub(SHIFT_BITS.wrapping_mul(width));
    let (column, row): (i32x4, i32x4) = (cast(column), cast(row));
    let index = (row * i32x4::splat(width) + column + i32x4::splat(first)) & i32x4::splat(INDEX);
    let [i, j, k, l] = index.to_array();
    let [i, j, k, l] = [
        block_at(image, i, width),
        block_at(image, j, width),
        block_at(image, k, width),
        block_at(image, l, width),
    ];
    let [a, b] = columns([i[0], j[0], k[0], l[0]]);
    let [c, d] = columns([i[1], j[1], k[1], l[1]]);
    let top = a + (b - a) * fx;
    let bottom = c + (d - c) * fx;
    top + (bottom - top) * fy
}

/// A pixel and its right neighbour, and the two below.
#[inline(always)]
fn block_at(image: &Gray, index: i32, width: i32) -> [[f32; 2]; 2] {
    let (i, w) = (index as u32 as usize, width as u32 as usize);
    // One comparison for all four.
    let pixels = &image.data[i..i + (w + 2)];
    [[pixels[0], pixels[1]], [pixels[w], pixels[w + 1]]]
}

/// The left and the right of four pairs.
#[inline(always)]
fn columns([i, j, k, l]: [[f32; 2]; 4]) -> [f32x4; 2] {
    let first: f32x4 = cast([i, j]);
    let last: f32x4 = cast([k, l]);
    let (even, odd) = (first.unpack_lo(last), first.unpack_hi(last));
    [even.unpack_lo(odd), even.unpack_hi(odd)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_samples_are_those_one_by_one() {
        let g = Gray::from_fn(9, 7, |x, y| ((x * 7 + y * 13) % 31) as f32 / 31.0);
        let x = [0.4, 0.5, 3.3, 8.499, 8.5, 2.0, f32::NAN, 6.999];
        for y in [
            [1.0; 8],
            [0.5, 6.499, 4.7, 5.2, 3.0, 6.5, 3.0, 0.499],
            [-3.0; 8],
        ] {
            let eight = g.sample_eight(x, y).to_array();
            for lane in 0..8 {
                let one = g.sample(x[lane], y[lane]);
                assert_eq!(
                    one.is_none(),
                    eight[lane].is_nan(),
                    "{} {}",
                    x[lane],
                    y[lane]
                );
                assert!(one.is_none_or(|v| v == eight[lane]));
            }
        }
    }
}
