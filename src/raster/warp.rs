//! Rasters filled from an image by a homography, four bilinear samples at a time: more would not fit the registers
//! of either target.

use nalgebra::{Matrix3, Point2, Vector3};
use wide::bytemuck::cast;
use wide::{f32x4, i32x4};

use super::Gray;

/// A homography in f32, relative to a whole pixel near the raster so that no digits are lost.
pub struct Warp<'a> {
    image: &'a Gray,
    m: [[f32; 3]; 3],
    /// Index of the pixel that the f32 coordinates start from.
    first: usize,
    /// Largest f32 coordinates with a right and a lower neighbour.
    limit: [f32; 2],
}

/// Where four raster positions fall in the image.
pub struct Four {
    x: f32x4,
    y: f32x4,
}

impl<'a> Warp<'a> {
    /// For a raster of `columns` by `rows`; `image_from_raster` maps its cells, whose centres are at + 0.5, to pixels. `None`
    /// when some of it is behind the camera, or the image has less than two rows or columns.
    pub fn new(
        image: &'a Gray,
        image_from_raster: &Matrix3<f64>,
        [columns, rows]: [usize; 2],
    ) -> Option<Self> {
        let (w, h) = (columns as f64, rows as f64);
        let (min, _) = bounds(&corners(image_from_raster, [0.0, 0.0], [w, h])?);
        if image.width < 2 || image.height < 2 {
            return None;
        }
        let start = |value: f64, size: usize| value.floor().clamp(0.0, (size - 2) as f64);
        let (x, y) = (start(min.x, image.width), start(min.y, image.height));
        // Pixel centres are at + 0.5 on both sides.
        let to_index = Matrix3::new(1.0, 0.0, -0.5 - x, 0.0, 1.0, -0.5 - y, 0.0, 0.0, 1.0);
        let to_centre = Matrix3::new(1.0, 0.0, 0.5, 0.0, 1.0, 0.5, 0.0, 0.0, 1.0);
        let m = to_index * image_from_raster * to_centre;
        let scale = m[(2, 0)] * w * 0.5 + m[(2, 1)] * h * 0.5 + m[(2, 2)];
        let m = m / scale;
        Some(Self {
            image,
            m: std::array::from_fn(|r| std::array::from_fn(|c| m[(r, c)] as f32)),
            first: y as usize * image.width + x as usize,
            limit: [
                ((image.width - 1) as f32 - x as f32).next_down(),
                ((image.height - 1) as f32 - y as f32).next_down(),
            ],
        })
    }

    /// Fills a row of the raster by what `value` makes of each four positions.
    #[inline]
    pub fn fill(&self, row: usize, out: &mut [f32], value: impl Fn(Four) -> f32x4) {
        let v = row as f32;
        let at = |r: usize| f32x4::splat(self.m[r][1] * v + self.m[r][2]);
        let slope = |r: usize| f32x4::splat(self.m[r][0]);
        let (x0, y0, w0) = (at(0), at(1), at(2));
        let (dx, dy, dw) = (slope(0), slope(1), slope(2));
        let mut u = f32x4::from([0.0, 1.0, 2.0, 3.0]);
        for out in out.chunks_mut(4) {
            let inverse = f32x4::ONE / (w0 + dw * u);
            let at = Four {
                x: (x0 + dx * u) * inverse,
                y: (y0 + dy * u) * inverse,
            };
            let values = value(at).to_array();
            match <&mut [f32; 4]>::try_from(&mut *out) {
                Ok(out) => *out = values,
                Err(_) => out.copy_from_slice(&values[..out.len()]),
            }
            u += f32x4::splat(4.0);
        }
    }

    /// Bilinear values; NaN outside the image.
    #[inline]
    pub fn or_nan(&self, at: Four) -> f32x4 {
        let zero = f32x4::ZERO;
        let [limit_x, limit_y] = self.limit.map(f32x4::splat);
        let inside =
            at.x.simd_ge(zero) & at.x.simd_le(limit_x) & at.y.simd_ge(zero) & at.y.simd_le(limit_y);
        // Where the horizon lies behind the raster, positions are no numbers.
        let [x, y] = [at.x, at.y].map(|x| inside.select(x, zero));
        inside.select(
            bilinear(self.image, self.first, x, y),
            f32x4::splat(f32::NAN),
        )
    }

    /// Bilinear values; outside the image those of its border.
    #[inline]
    pub fn bordered(&self, at: Four) -> f32x4 {
        let clamp = |x: f32x4, limit: f32| x.fast_max(f32x4::ZERO).fast_min(f32x4::splat(limit));
        let (x, y) = (clamp(at.x, self.limit[0]), clamp(at.y, self.limit[1]));
        bilinear(self.image, self.first, x, y)
    }
}

/// Bilinear values at columns and rows counted from pixel `first`, which must have a right and a lower neighbour.
// Everything below is inlined by force: called for every four samples, the calls took longer than the samples.
#[inline(always)]
pub(super) fn bilinear(image: &Gray, first: usize, x: f32x4, y: f32x4) -> f32x4 {
    let (column, row) = (x.fast_trunc_int(), y.fast_trunc_int());
    let (fx, fy) = (x - column.round_float(), y - row.round_float());
    let (column, row) = (
        (column + i32x4::splat(first as i32)).to_array(),
        row.to_array(),
    );
    let [i, j, k, l] = [
        block_at(image, column[0], row[0]),
        block_at(image, column[1], row[1]),
        block_at(image, column[2], row[2]),
        block_at(image, column[3], row[3]),
    ];
    let [a, b] = columns([i[0], j[0], k[0], l[0]]);
    let [c, d] = columns([i[1], j[1], k[1], l[1]]);
    let top = a + (b - a) * fx;
    let bottom = c + (d - c) * fx;
    top + (bottom - top) * fy
}

/// A pixel and its right neighbour, and the two below.
#[inline(always)]
fn block_at(image: &Gray, column: i32, row: i32) -> [[f32; 2]; 2] {
    let width = image.width as u32;
    // One by one: without SSE 4.1 there is no product of four integers.
    let start = (row as u32).wrapping_mul(width);
    let i = start.wrapping_add(column as u32) as usize;
    // In 64 bits a width of 32 cannot overflow, so that one comparison does for all four.
    let w = width as usize;
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

/// Where the corners of a rectangle go under a homography; `None` when one is beyond the horizon.
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

/// Least and largest coordinates.
pub fn bounds(points: &[Point2<f64>; 4]) -> (Point2<f64>, Point2<f64>) {
    let mut b = (points[0], points[0]);
    for p in points {
        b.0 = b.0.inf(p);
        b.1 = b.1.sup(p);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_those_of_the_image_and_nan_outside() {
        let image = Gray::from_fn(40, 30, |x, y| ((x * 7 + y * 13) % 31) as f32 / 31.0);
        let m = Matrix3::new(0.9, 0.1, -6.0, -0.05, 1.1, -4.0, 1e-3, -2e-3, 1.2);
        let warp = Warp::new(&image, &m, [56, 36]).unwrap();
        let mut out = [0.0f32; 56];
        let (mut seen, mut outside) = (0, 0);
        for row in 0..36 {
            warp.fill(row, &mut out, |at| warp.or_nan(at));
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
    fn what_reaches_behind_the_camera_is_not_warped() {
        let image = Gray::from_fn(40, 30, |_, _| 1.0);
        // The third coordinate is 0 in the middle of column 8.
        let m = Matrix3::new(20.0, 0.0, 0.0, 0.0, 15.0, 0.0, -1.0, 0.0, 8.5);
        assert!(Warp::new(&image, &m, [16, 4]).is_none());
        assert!(Warp::new(&image, &m, [8, 4]).is_some());
    }
}
