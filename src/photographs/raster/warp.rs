//! Rasters filled from an image by a homography, four bilinear samples at a time: more would not
//! fit the registers of either target.

use nalgebra::{Matrix3, Point2, Vector3};
use wide::f32x4;

use super::bilinear::bilinear;
use super::gray::Gray;
use crate::base::geometry::bounds;

/// A homography in f32, relative to a whole pixel near the raster so that no digits are lost.
pub struct Warp<'a> {
    image: &'a Gray,
    m: [[f32; 3]; 3],
    /// Index of the pixel that the f32 coordinates start from.
    first: usize,
    /// Largest f32 coordinates with a right and a lower neighbour.
    limit: [f32; 2],
    /// Columns over which the positions of a row are a parabola, see [`span_of`].
    span: usize,
    /// All samples lie inside the image.
    inside: bool,
}

/// What takes the place of values outside the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// Those of the border.
    Border,
    /// NaN.
    Nan,
}

/// Largest distance of the parabola of a row from the true positions, pixels.
const TOLERANCE_PX: f64 = 1.0 / 256.0;

impl<'a> Warp<'a> {
    /// For a raster of `columns` by `rows`; `image_from_raster` maps its cells, whose centres are
    /// at + 0.5, to pixels. `None` when some of it is behind the camera, or the image has less
    /// than two rows or columns.
    pub fn new(
        image: &'a Gray,
        image_from_raster: &Matrix3<f64>,
        [columns, rows]: [usize; 2],
    ) -> Option<Self> {
        let (w, h) = (columns as f64, rows as f64);
        let [min, _] = bounds(corners(image_from_raster, [0.0, 0.0], [w, h])?);
        if image.width < 2 || image.height < 2 {
            return None;
        }
        // The pixel whose centre lies before the first position.
        let start = |x: f64, size: usize| (x - 0.5).floor().clamp(0.0, (size - 2) as f64);
        let (x, y) = (start(min.x, image.width), start(min.y, image.height));
        // Coordinates count from half a pixel beyond the first pixel's centre: rounded, they are
        // its column and row.
        let to_index = Matrix3::new(1.0, 0.0, -1.0 - x, 0.0, 1.0, -1.0 - y, 0.0, 0.0, 1.0);
        let to_centre = Matrix3::new(1.0, 0.0, 0.5, 0.0, 1.0, 0.5, 0.0, 0.0, 1.0);
        let m = to_index * image_from_raster * to_centre;
        let scale = m[(2, 0)] * w * 0.5 + m[(2, 1)] * h * 0.5 + m[(2, 2)];
        let m = m / scale;
        Some(Self {
            image,
            m: std::array::from_fn(|r| std::array::from_fn(|c| m[(r, c)] as f32)),
            first: y as usize * image.width + x as usize,
            limit: [
                last_before((image.width - 1) as f32 - x as f32),
                last_before((image.height - 1) as f32 - y as f32),
            ],
            span: span_of(&m, [w, h]),
            inside: falls_inside(image, image_from_raster, [columns, rows]),
        })
    }

    /// Fills a row of the raster by what `value` makes of each four grey values.
    #[inline]
    pub fn fill(
        &self,
        row: usize,
        out: &mut [f32],
        outside: Outside,
        value: impl Fn(f32x4) -> f32x4,
    ) {
        let (image, first) = (self.image, self.first);
        let (low, [right, lower]) = (f32x4::splat(-0.5), self.limit.map(f32x4::splat));
        // Written so that NaN becomes a border, too.
        let clamp = |x: f32x4, high: f32x4| {
            let x = x.simd_ge(low).select(x, low);
            x.simd_le(high).select(x, high)
        };
        if self.inside {
            self.positions(
                row,
                out,
                #[inline(always)]
                |x, y| value(bilinear(image, first, x, y)),
            );
            return;
        }
        self.positions(row, out, |x, y| {
            let values = value(bilinear(image, first, clamp(x, right), clamp(y, lower)));
            let inside = x.simd_ge(low) & x.simd_le(right) & y.simd_ge(low) & y.simd_le(lower);
            match outside {
                Outside::Border => values,
                Outside::Nan => inside.select(values, f32x4::splat(f32::NAN)),
            }
        });
    }

    /// Fills a row of the raster by what `value` makes of the coordinates of each four positions:
    /// true ones at both ends and in the middle of every span, a parabola by forward differences
    /// between.
    #[inline(always)]
    fn positions(&self, row: usize, out: &mut [f32], value: impl Fn(f32x4, f32x4) -> f32x4) {
        let v = row as f32;
        let [x0, y0, w0] = self.m.map(|m| m[1] * v + m[2]);
        let [dx, dy, dw] = self.m.map(|m| m[0]);
        let position = |u: f32| {
            let inverse = 1.0 / (w0 + dw * u);
            [(x0 + dx * u) * inverse, (y0 + dy * u) * inverse]
        };
        let mut column = 0.0;
        let mut start = position(column);
        for out in out.chunks_mut(self.span) {
            let length = out.len() as f32;
            let middle = position(column + 0.5 * length);
            column += length;
            let end = position(column);
            let [mut x, mut y] =
                [0, 1].map(|i| ForwardDifferences::new([start[i], middle[i], end[i]], length));
            start = end;
            let mut fours = out.chunks_exact_mut(4);
            for out in &mut fours {
                out.copy_from_slice(value(x.next(), y.next()).as_array());
            }
            let rest = fours.into_remainder();
            if !rest.is_empty() {
                let values = value(x.next(), y.next()).to_array();
                rest.copy_from_slice(&values[..rest.len()]);
            }
        }
    }
}

/// The largest coordinate before `end`, counted from half a pixel later.
fn last_before(end: f32) -> f32 {
    end.next_down() - 0.5
}

/// Do all samples have four pixels around them? Rows are filled in fours, a little beyond their
/// ends.
fn falls_inside(
    image: &Gray,
    image_from_raster: &Matrix3<f64>,
    [columns, rows]: [usize; 2],
) -> bool {
    // Far more than the errors of f32 and of the parabola, so that no sample need be checked.
    const MARGIN_PX: f64 = 0.5;
    let end = [columns.next_multiple_of(4) as f64, rows as f64];
    let Some(corners) = corners(image_from_raster, [0.0, 0.0], end) else {
        return false;
    };
    let [min, max] = bounds(corners);
    let within = |min: f64, max: f64, size: usize| {
        min >= 0.5 + MARGIN_PX && max <= size as f64 - 0.5 - MARGIN_PX
    };
    within(min.x, max.x, image.width) && within(min.y, max.y, image.height)
}

/// Number of columns, a power of two from 4 to 256, over which the positions `m` (u, v, 1) are a
/// parabola in u within [`TOLERANCE_PX`].
///
/// The error of the parabola through both ends and the middle of L columns is below `0.05 L^3 |f|
/// / 6`, with the third derivative `f = 6 x' (m20 / w)^2`, which is largest at a corner.
fn span_of(m: &Matrix3<f64>, [columns, rows]: [f64; 2]) -> usize {
    let mut off_by = 0.0_f64;
    for (u, v) in [(0.0, 0.0), (columns, 0.0), (0.0, rows), (columns, rows)] {
        let p = m * Vector3::new(u, v, 1.0);
        let slope = |r: usize| ((m[(r, 0)] - p[r] / p.z * m[(2, 0)]) / p.z).abs();
        let bend = m[(2, 0)] / p.z;
        off_by = off_by.max(0.05 * slope(0).max(slope(1)) * bend * bend);
    }
    let mut span = 256;
    while span > 4 && off_by * (span * span * span) as f64 > TOLERANCE_PX {
        span /= 2;
    }
    span
}

/// The values of a parabola at 0, 1, 2 and so on by forward differences, four at a time.
struct ForwardDifferences {
    /// The next four.
    values: f32x4,
    /// From these to the four after them.
    step: f32x4,
    /// From one step to the next.
    growth: f32x4,
}

impl ForwardDifferences {
    /// From the values at 0, n / 2 and n.
    #[inline(always)]
    fn new([start, middle, end]: [f32; 3], n: f32) -> Self {
        let square = 2.0 * ((start - middle) + (end - middle)) / (n * n);
        let slope = (end - start) / n - square * n;
        let u = f32x4::from([0.0, 1.0, 2.0, 3.0]);
        let four = f32x4::splat(4.0);
        let [start, slope, square] = [start, slope, square].map(f32x4::splat);
        Self {
            values: start + (slope + square * u) * u,
            step: (slope + square * (u + u + four)) * four,
            growth: square * f32x4::splat(32.0),
        }
    }

    #[inline(always)]
    fn next(&mut self) -> f32x4 {
        let values = self.values;
        self.values += self.step;
        self.step += self.growth;
        values
    }
}

/// The corners of a rectangle mapped by a homography; `None` when one is beyond the horizon.
pub fn corners(h: &Matrix3<f64>, min: [f64; 2], max: [f64; 2]) -> Option<[Point2<f64>; 4]> {
    let mut out = [Point2::origin(); 4];
    let rectangle = [
        [min[0], min[1]],
        [max[0], min[1]],
        [max[0], max[1]],
        [min[0], max[1]],
    ];
    for (o, [x, y]) in out.iter_mut().zip(rectangle) {
        let p = h * Vector3::new(x, y, 1.0);
        if p.z <= 1e-9 {
            return None;
        }
        *o = Point2::new(p.x / p.z, p.y / p.z);
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn samples_are_those_of_the_image_and_nan_outside() {
        let image = Gray::from_fn(40, 30, |x, y| ((x * 7 + y * 13) % 31) as f32 / 31.0);
        let m = Matrix3::new(0.9, 0.1, -6.0, -0.05, 1.1, -4.0, 1e-3, -2e-3, 1.2);
        let warp = Warp::new(&image, &m, [56, 36]).unwrap();
        let mut out = [0.0f32; 56];
        let (mut seen, mut outside) = (0, 0);
        for row in 0..36 {
            warp.fill(row, &mut out, Outside::Nan, |values| values);
            for (column, &value) in out.iter().enumerate() {
                let p = m * Vector3::new(column as f64 + 0.5, row as f64 + 0.5, 1.0);
                let p = [p.x / p.z, p.y / p.z];
                let from_border =
                    |axis: usize, size: f64| (p[axis] - 0.5).min(size - 0.5 - p[axis]);
                let inside = from_border(0, 40.0).min(from_border(1, 30.0));
                match image.sample(p[0] as f32, p[1] as f32) {
                    _ if inside.abs() < 1e-3 => {}
                    Some(direct) => {
                        assert!((value - direct).abs() < 1e-3, "{value} {direct}");
                        seen += 1;
                    }
                    None => {
                        assert!(value.is_nan(), "{p:?}");
                        outside += 1;
                    }
                }
            }
        }
        assert!(
            seen > 500 && outside > 200,
            "{seen} inside, {outside} outside"
        );
    }

    #[test]
    fn long_rows_keep_to_the_homography() {
        // Grey values that encode the position.
        let size = [700, 500];
        let column = Gray::from_fn(size[0], size[1], |x, _| x as f32 + 0.5);
        let row = Gray::from_fn(size[0], size[1], |_, y| y as f32 + 0.5);
        // The third coordinate falls to a third along a row, or not at all.
        for (bend, length) in [(-2.5e-3, 258), (0.0, 601), (4e-5, 399)] {
            let m = Matrix3::new(0.9, 0.1, 30.0, 0.02, 0.7, 40.0, bend, -1e-4, 1.0);
            let mut out = vec![0.0f32; length];
            for (axis, image) in [&column, &row].into_iter().enumerate() {
                let warp = Warp::new(image, &m, [length, 90]).unwrap();
                for v in [0, 89] {
                    warp.fill(v, &mut out, Outside::Nan, |values| values);
                    for (u, &value) in out.iter().enumerate() {
                        let p = m * Vector3::new(u as f64 + 0.5, v as f64 + 0.5, 1.0);
                        let p = [p.x / p.z, p.y / p.z];
                        let inside = (0..2).all(|a| p[a] > 0.51 && p[a] < size[a] as f64 - 0.51);
                        if inside {
                            let off = (f64::from(value) - p[axis]).abs();
                            assert!(off < 2.0 * TOLERANCE_PX, "{off} at {u} of {length}");
                        }
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn any_raster_is_sampled_or_nan_or_border(
            size in [2usize..40, 2usize..40],
            raster in [1usize..80, 1usize..20],
            turn in [-2.0..2.0f64, -2.0..2.0f64, -2.0..2.0f64, -2.0..2.0f64],
            start in [-30.0..50.0f64, -30.0..50.0f64],
            bend in [-0.02..0.02f64, -0.02..0.02f64],
        ) {
            let image = Gray::from_fn(size[0], size[1], |x, y| ((x * 7 + y * 13) % 31) as f32);
            let m = Matrix3::new(
                turn[0], turn[1], start[0], turn[2], turn[3], start[1], bend[0], bend[1], 1.0,
            );
            let Some(warp) = Warp::new(&image, &m, raster) else {
                return Ok(());
            };
            let [mut nan, mut border] = [0, 1].map(|_| vec![0.0f32; raster[0]]);
            for row in 0..raster[1] {
                warp.fill(row, &mut nan, Outside::Nan, |values| values);
                warp.fill(row, &mut border, Outside::Border, |values| values);
                for (&nan, &border) in nan.iter().zip(&border) {
                    prop_assert!((0.0..31.0).contains(&border));
                    prop_assert!(nan.is_nan() || nan == border);
                }
            }
        }
    }

    #[test]
    fn what_reaches_behind_the_camera_is_not_warped() {
        let image = Gray::from_fn(40, 30, |_, _| 1.0);
        // The third coordinate is 0 in the middle of column 8.
        let m = Matrix3::new(20.0, 0.0, 0.0, 0.0, 15.0, 0.0, -1.0, 0.0, 8.5);
        assert!(Warp::new(&image, &m, [16, 4]).is_none());
        assert!(Warp::new(&image, &m, [8, 4]).is_some());
    }
}
