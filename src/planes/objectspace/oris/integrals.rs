//! Sums of grey values over polygons, from running sums along the rows.
//!
//! A polygon on the pixel lattice holds the pixels whose centres lie inside. By Green's theorem its
//! count, sum and sum of squares are sums of one term per side, each a walk over the rows that the
//! side crosses; the terms are integers, so that a partition conserves every pixel exactly whatever
//! its sides do.

use std::ops::{Add, Neg, Sub};

use crate::base::math::larger;
use crate::photographs::raster::Gray;

/// A lattice point: a corner of pixels, (0, 0) at the outer corner of the top-left pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Lattice {
    /// Column, pixels.
    pub x: i32,
    /// Row, pixels.
    pub y: i32,
}

/// Number of channels: grey, and two colour differences.
pub(super) const CHANNELS: usize = 3;

/// Count, sums and sums of squares of the channels; the difference of two sets of pixels may be
/// negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct RegionMoments {
    /// Number of pixels.
    pub count: i64,
    sum: [i64; CHANNELS],
    squares: [i64; CHANNELS],
}

impl RegionMoments {
    /// Mean of a channel, 0 to 255.
    pub(super) fn mean(&self, channel: usize) -> f64 {
        self.sum[channel] as f64 / self.count.max(1) as f64
    }

    /// Variance of a channel, levels of 255 squared.
    pub(super) fn variance(&self, channel: usize) -> f64 {
        let mean = self.mean(channel);
        larger(
            self.squares[channel] as f64 / self.count.max(1) as f64 - mean * mean,
            0.0,
        )
    }
}

impl Add for RegionMoments {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self.count += other.count;
        for c in 0..CHANNELS {
            self.sum[c] += other.sum[c];
            self.squares[c] += other.squares[c];
        }
        self
    }
}

impl Neg for RegionMoments {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            count: -self.count,
            sum: self.sum.map(|v| -v),
            squares: self.squares.map(|v| -v),
        }
    }
}

impl Sub for RegionMoments {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

/// Running sums along every row of an image: sum and sum of squares of each channel. A row of 66
/// 000 pixels still fits into 32 bits.
pub(super) struct RowSums {
    stride: usize,
    before: Vec<[[u32; 2]; CHANNELS]>,
}

impl RowSums {
    /// The sums of an image in three channels of the same size, values 0 to 1.
    pub(super) fn new(channels: &[Gray; CHANNELS]) -> Self {
        let (width, height) = (channels[0].width, channels[0].height);
        let stride = width + 1;
        let mut before = Vec::with_capacity(stride * height);
        for y in 0..height {
            let mut sums = [[0u32; 2]; CHANNELS];
            before.push(sums);
            for x in 0..width {
                for (sum, channel) in sums.iter_mut().zip(channels) {
                    let level = (channel.get(x, y).clamp(0.0, 1.0) * 255.0).round() as u32;
                    sum[0] += level;
                    sum[1] += level * level;
                }
                before.push(sums);
            }
        }
        Self { stride, before }
    }

    /// The term of the side from `a` to `b`: the pixels to the left of it (smaller x) in every row
    /// that it crosses, positive for a side that runs down. A closed polygon that runs clockwise on
    /// the screen sums up to its inside.
    pub(super) fn side(&self, a: Lattice, b: Lattice) -> RegionMoments {
        let (top, bottom, down) = if a.y <= b.y {
            (a, b, true)
        } else {
            (b, a, false)
        };
        let (dx, dy) = (i64::from(bottom.x - top.x), i64::from(bottom.y - top.y));
        let mut m = RegionMoments::default();
        if dy == 0 {
            return m;
        }
        // The first pixel centre (k + 1/2) not left of the side at the centre of a row, and by how
        // many parts of 2 dy it lies to the right: one division for all rows (Bresenham).
        let mut k = i64::from(top.x) - (dy - dx).div_euclid(2 * dy);
        let mut right = (dy - dx).rem_euclid(2 * dy);
        let (step, rest) = (dx.div_euclid(dy), 2 * dx.rem_euclid(dy));
        for row in i64::from(top.y)..i64::from(bottom.y) {
            let at = row as usize * self.stride + k.max(0) as usize;
            m.count += k;
            for (c, [sum, squares]) in self.before[at].into_iter().enumerate() {
                m.sum[c] += i64::from(sum);
                m.squares[c] += i64::from(squares);
            }
            k += step;
            right -= rest;
            if right < 0 {
                k += 1;
                right += 2 * dy;
            }
        }
        if down { m } else { -m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image() -> Gray {
        Gray::from_fn(20, 16, |x, y| ((x * 7 + y * 13) % 50) as f32 / 50.0)
    }

    #[test]
    fn a_polygon_holds_the_pixels_whose_centres_lie_inside() {
        let gray = image();
        let sums = RowSums::new(&[gray.clone(), image(), image()]);
        let p = |x, y| Lattice { x, y };
        let (a, b, c) = (p(2, 1), p(17, 6), p(5, 15));
        let m = sums.side(a, b) + sums.side(b, c) + sums.side(c, a);
        let side = |u: Lattice, v: Lattice, x: f64, y: f64| {
            f64::from(v.x - u.x) * (y - f64::from(u.y))
                - f64::from(v.y - u.y) * (x - f64::from(u.x))
        };
        let (mut count, mut sum) = (0, 0.0);
        for row in 0..16 {
            for column in 0..20 {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                if side(a, b, x, y) > 0.0 && side(b, c, x, y) > 0.0 && side(c, a, x, y) > 0.0 {
                    count += 1;
                    sum += f64::from(gray.get(column, row)) * 255.0;
                }
            }
        }
        assert_eq!(m.count, count);
        assert!((m.mean(0) - sum / f64::from(count as i32)).abs() < 0.5);
    }

    #[test]
    fn a_side_counts_the_centres_to_its_left_in_every_row() {
        let sums = RowSums::new(&[image(), image(), image()]);
        for (x, to_x, y, to_y) in
            (0..4 * 20 * 20).map(|i| (i % 20, i / 20 % 20, 1, 2 + i / 400 * 4))
        {
            let side = sums.side(Lattice { x, y }, Lattice { x: to_x, y: to_y });
            let centres = (y..to_y).map(|row| {
                let t = (f64::from(row - y) + 0.5) / f64::from(to_y - y);
                let crossing = f64::from(x) + t * f64::from(to_x - x);
                (0..20)
                    .filter(|&k| f64::from(k) + 0.5 < crossing - 1e-9)
                    .count() as i64
            });
            assert_eq!(
                side.count,
                centres.sum::<i64>(),
                "{x} to {to_x}, {y} to {to_y}"
            );
        }
    }

    #[test]
    fn a_side_back_takes_away_what_it_brought() {
        let sums = RowSums::new(&[image(), image(), image()]);
        let (a, b) = (Lattice { x: 3, y: 14 }, Lattice { x: 11, y: 2 });
        assert_eq!(sums.side(a, b), -sums.side(b, a));
    }
}
