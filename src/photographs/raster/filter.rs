//! Separable filters with clamped borders.

use super::gray::Gray;
use crate::base::math;

/// Gaussian blur with standard deviation `sigma_px`; borders are clamped. The kernel reaches 3
/// sigma.
pub fn gaussian_blur(input: &Gray, sigma_px: f64) -> Gray {
    let radius = (3.0 * sigma_px).ceil().max(1.0) as usize;
    let mut kernel: Vec<f64> = (0..=radius)
        .map(|i| math::exp(-0.5 * (i as f64 / sigma_px) * (i as f64 / sigma_px)))
        .collect();
    let sum = kernel[0] + 2.0 * kernel[1..].iter().sum::<f64>();
    kernel.iter_mut().for_each(|k| *k /= sum);
    let kernel: Vec<f32> = kernel.iter().map(|&k| k as f32).collect();
    let (w, h) = (input.width, input.height);

    if w == 0 || h == 0 {
        return Gray::new(w, h);
    }

    // Rows blurred along x are kept in a ring, as long as a row within the radius needs them.
    let slots = 2 * radius + 1;
    let mut rows = vec![0.0f32; slots * w];
    let mut padded = vec![0.0f32; w + 2 * radius];
    let mut ready = 0;
    let mut output = Gray::new(w, h);
    for (y, out) in output.data.chunks_exact_mut(w).enumerate() {
        while ready < h.min(y + radius + 1) {
            let slot = ready % slots;
            let row = &mut rows[slot * w..(slot + 1) * w];
            blur_row(
                &input.data[ready * w..(ready + 1) * w],
                &kernel,
                &mut padded,
                row,
            );
            ready += 1;
        }
        let row = |dy: isize| {
            let slot = (y as isize + dy).clamp(0, h as isize - 1) as usize % slots;
            &rows[slot * w..(slot + 1) * w]
        };
        for (o, v) in out.iter_mut().zip(row(0)) {
            *o = v * kernel[0];
        }
        for (i, &k) in kernel.iter().enumerate().skip(1) {
            let (above, below) = (row(-(i as isize)), row(i as isize));
            for ((o, a), b) in out.iter_mut().zip(above).zip(below) {
                *o += (a + b) * k;
            }
        }
    }
    output
}

/// Blurs one row; `padded` is a buffer for it and the kernel radius on either side.
fn blur_row(row: &[f32], kernel: &[f32], padded: &mut [f32], out: &mut [f32]) {
    let (w, radius) = (row.len(), kernel.len() - 1);
    padded[..radius].fill(row[0]);
    padded[radius..radius + w].copy_from_slice(row);
    padded[radius + w..].fill(row[w - 1]);
    for (o, v) in out.iter_mut().zip(row) {
        *o = v * kernel[0];
    }
    for (i, &k) in kernel.iter().enumerate().skip(1) {
        let (left, right) = (&padded[radius - i..][..w], &padded[radius + i..][..w]);
        for ((o, l), r) in out.iter_mut().zip(left).zip(right) {
            *o += (l + r) * k;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blur_keeps_the_mean_and_spreads_by_sigma() {
        let mut impulse = Gray::new(41, 41);
        impulse.data[20 * 41 + 20] = 1.0;
        let blurred = gaussian_blur(&impulse, 2.0);
        let sum: f32 = blurred.data.iter().sum();
        assert!((sum - 1.0).abs() < 1e-4);
        let variance: f32 = (0..41 * 41)
            .map(|i| blurred.data[i] * ((i % 41) as f32 - 20.0) * ((i % 41) as f32 - 20.0))
            .sum();
        assert!((variance - 4.0).abs() < 0.1, "variance {variance}");
    }
}
