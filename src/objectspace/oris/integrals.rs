//! Sums of grey values over polygons, from running sums along the rows.
//!
//! A polygon on the pixel lattice holds the pixels whose centres lie inside. By Green's theorem its count,
//! sum and sum of squares are sums of one term per side, each a walk over the rows that the side crosses; the
//! terms are integers, so that a partition conserves every pixel exactly whatever its sides do.

use std::ops::{Add, Neg, Sub};

use crate::raster::Gray;

/// A lattice point: a corner of pixels, (0, 0) at the outer corner of the top-left pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Lattice {
    /// Column, pixels.
    pub x: i32,
    /// Row, pixels.
    pub y: i32,
}

/// Steps of the integer grey values in one grey level of 255.
const STEPS_PER_LEVEL: f64 = 4.0;

/// Count, sum and sum of squares of grey values; the difference of two sets of pixels may be negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moments {
    /// Number of pixels.
    pub count: i64,
    sum: i64,
    squares: i64,
}

impl Moments {
    /// Mean grey value, 0 to 255.
    pub fn mean(&self) -> f64 {
        self.sum as f64 / (self.count.max(1) as f64 * STEPS_PER_LEVEL)
    }

    /// Variance of the grey values, levels of 255 squared.
    pub fn variance(&self) -> f64 {
        let n = self.count.max(1) as f64;
        let mean = self.sum as f64 / n;
        let scale = STEPS_PER_LEVEL * STEPS_PER_LEVEL;
        (self.squares as f64 / n - mean * mean).max(0.0) / scale
    }
}

impl Add for Moments {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            sum: self.sum + other.sum,
            squares: self.squares + other.squares,
        }
    }
}

impl Neg for Moments {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            count: -self.count,
            sum: -self.sum,
            squares: -self.squares,
        }
    }
}

impl Sub for Moments {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

/// Running sums along every row of an image.
pub struct RowSums {
    stride: usize,
    before: Vec<(u32, u64)>,
}

impl RowSums {
    /// The sums of an image of grey values 0 to 1.
    pub fn new(gray: &Gray) -> Self {
        let stride = gray.width + 1;
        let mut before = Vec::with_capacity(stride * gray.height);
        for row in gray.data.chunks_exact(gray.width.max(1)) {
            let (mut sum, mut squares) = (0u32, 0u64);
            before.push((0, 0));
            for &g in row {
                let step = (f64::from(g).clamp(0.0, 1.0) * 255.0 * STEPS_PER_LEVEL).round() as u32;
                sum += step;
                squares += u64::from(step) * u64::from(step);
                before.push((sum, squares));
            }
        }
        Self { stride, before }
    }

    /// The term of the side from `a` to `b`: the pixels to the left of it (smaller x) in every row that it crosses,
    /// positive for a side that runs down. A closed polygon that runs clockwise on the screen sums up to its inside.
    pub fn side(&self, a: Lattice, b: Lattice) -> Moments {
        let (top, bottom, down) = if a.y <= b.y {
            (a, b, true)
        } else {
            (b, a, false)
        };
        let (dx, dy) = (i64::from(bottom.x - top.x), i64::from(bottom.y - top.y));
        let mut m = Moments::default();
        for row in 0..dy {
            // The first pixel centre (k + 1/2) not left of the side at the centre of the row.
            let k = i64::from(top.x) + ceil_div(dx * (2 * row + 1) - dy, 2 * dy);
            let (sum, squares) =
                self.before[(i64::from(top.y) + row) as usize * self.stride + k.max(0) as usize];
            m.count += k;
            m.sum += i64::from(sum);
            m.squares += squares as i64;
        }
        if down { m } else { -m }
    }
}

fn ceil_div(a: i64, b: i64) -> i64 {
    -(-a).div_euclid(b)
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
        let sums = RowSums::new(&gray);
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
        assert!((m.mean() - sum / f64::from(count as i32)).abs() < 0.13);
    }

    #[test]
    fn a_side_back_takes_away_what_it_brought() {
        let sums = RowSums::new(&image());
        let (a, b) = (Lattice { x: 3, y: 14 }, Lattice { x: 11, y: 2 });
        assert_eq!(sums.side(a, b), -sums.side(b, a));
    }
}
