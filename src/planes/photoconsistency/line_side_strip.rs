//! The neighbourhood of one side of a line, as a raster that every view is warped into.
//!
//! B99 4.1 correlates windows of the first view with their images under `H(theta)` in view i. Doing
//! that window by window samples every pixel 225 times, so the whole neighbourhood is warped once a
//! theta and view instead, into a raster whose columns run along the projected line and whose rows
//! run away from it, at the scale of the first view. Windows are therefore aligned with the line,
//! which the paper leaves open.

use nalgebra::{Matrix3, Point2, Vector2};
use wide::f32x4;

use crate::base::geometry::{Segment2, Segment3, bounds};
use crate::base::params::SweepParams;
use crate::lines::lines3d::ThetaFrame;
use crate::photographs::camera::Camera;
use crate::photographs::raster::{Gray, Outside, Warp, corners};

/// Grey values are held in units of 1/510, centred and rounded: whole numbers from -255 to 255. A
/// sum of 225 products of two is then a whole number below 2^24, which f32 holds exactly: running
/// sums do not drift, and no order of summation changes a bit. The rounding adds a variance of
/// (1/1767)^2 of the grey range, a hundredth of the noise of an 8-bit photograph.
const LEVELS: f32 = 510.0;

/// Rows and columns of a strip in the first view.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LineSideStrip {
    /// Start of the projected line, pixels.
    origin: Point2<f64>,
    /// Unit direction of the projected line.
    along: Vector2<f64>,
    /// Unit normal of the projected line, to the chosen side.
    across: Vector2<f64>,
    /// Rows begin this far from the line, pixels.
    margin_px: f64,
    /// Pixels along the line.
    pub columns: usize,
    /// Pixels away from the line.
    pub rows: usize,
}

impl LineSideStrip {
    /// The strip of a line side in a view: as long as the projected line, as deep as `params` say.
    /// `None` when the line is not wholly in the view or too short there.
    pub(crate) fn new(
        camera: &Camera,
        line: &Segment3,
        frame: &ThetaFrame,
        params: &SweepParams,
    ) -> Option<Self> {
        let image = Segment2::new(camera.project(&line.p0)?, camera.project(&line.p1)?);
        if image.length() < params.min_length_px
            || !camera.contains(&image.p0, 0.0)
            || !camera.contains(&image.p1, 0.0)
        {
            return None;
        }
        let middle = line.at(0.5);
        let pixel_m = camera.ground_pixel(&middle);
        let beyond = camera.project(&(middle + frame.outward * pixel_m))?;
        let normal = image.normal();
        let across = if normal.dot(&(beyond - image.midpoint())) >= 0.0 {
            normal
        } else {
            -normal
        };
        let depth_px = params.depth_px.min(params.depth_m / pixel_m);
        let margin_px = params.margin_px;
        let rows = (depth_px - margin_px).floor().max(0.0) as usize;
        let columns = image.length().floor() as usize;
        (rows > params.window_px / 2).then_some(Self {
            origin: image.p0,
            along: image.direction(),
            across,
            margin_px,
            columns,
            rows,
        })
    }

    /// `image_from_strip`: pixel (column, row) has its centre at (column + 0.5, row + 0.5).
    pub(crate) fn image_from_strip(&self) -> Matrix3<f64> {
        let start = self.origin + self.across * self.margin_px;
        Matrix3::new(
            self.along.x,
            self.across.x,
            start.x,
            self.along.y,
            self.across.y,
            start.y,
            0.0,
            0.0,
            1.0,
        )
    }

    /// Column and row of the pixel that holds an image point; `None` outside the strip.
    pub(crate) fn pixel_of(&self, image: &Point2<f64>) -> Option<(usize, usize)> {
        let offset = image - self.origin;
        let (u, v) = (
            offset.dot(&self.along),
            offset.dot(&self.across) - self.margin_px,
        );
        let inside = u >= 0.0 && v >= 0.0 && u < self.columns as f64 && v < self.rows as f64;
        inside.then_some((u as usize, v as usize))
    }

    /// Distance in pixels of a row's centre from the line.
    pub(crate) fn distance_px(&self, row: usize) -> f64 {
        self.margin_px + row as f64 + 0.5
    }

    /// Bounding box in the image: least and greatest coordinates.
    pub(crate) fn bounds(&self) -> [Point2<f64>; 2] {
        let corners = corners(
            &self.image_from_strip(),
            [0.0, 0.0],
            [self.columns as f64, self.rows as f64],
        )
        .expect("an affine map has no horizon");
        bounds(corners)
    }

    /// The same strip without the rows from `rows` on.
    pub(crate) fn truncated(mut self, rows: usize) -> Self {
        self.rows = self.rows.min(rows);
        self
    }
}

/// Grey values of a strip in whole units of 1/510, row by row; rows are padded with zeros to a
/// multiple of eight.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct StripPatch {
    /// Pixels along the line.
    pub columns: usize,
    /// Pixels away from the line.
    pub rows: usize,
    /// Length of a row with its padding.
    pub stride: usize,
    /// `rows * stride` whole numbers from -255 to 255.
    pub data: Vec<f32>,
}

impl StripPatch {
    /// Fills the patch with the bilinear values of `image` under `image_from_strip`, which must
    /// keep the whole strip in front of the camera. Positions outside the image take its border.
    pub(crate) fn warp(
        &mut self,
        image: &Gray,
        strip: &LineSideStrip,
        image_from_strip: &Matrix3<f64>,
    ) {
        self.columns = strip.columns;
        self.rows = strip.rows;
        self.stride = strip.columns.next_multiple_of(8);
        self.data.resize(self.rows * self.stride, 0.0);
        let Some(warp) = Warp::new(image, image_from_strip, [strip.columns, strip.rows]) else {
            self.data.fill(0.0);
            return;
        };
        for (row, out) in self.data.chunks_exact_mut(self.stride).enumerate() {
            let (values, padding) = out.split_at_mut(strip.columns);
            warp.fill(row, values, Outside::Border, in_levels);
            padding.fill(0.0);
        }
    }

    /// One row with its padding.
    pub(crate) fn row(&self, row: usize) -> &[f32] {
        &self.data[row * self.stride..(row + 1) * self.stride]
    }
}

/// Grey values in whole units of 1/510.
#[inline]
fn in_levels(gray: f32x4) -> f32x4 {
    let value = gray * f32x4::splat(LEVELS) - f32x4::splat(LEVELS / 2.0);
    // Adding 1.5 x 2^23 leaves no fractional bits: rounds to the nearest whole number.
    let shift = f32x4::splat(12_582_912.0);
    (value + shift) - shift
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    fn strip(columns: usize, rows: usize) -> LineSideStrip {
        LineSideStrip {
            origin: Point2::new(20.0, 30.0),
            along: Vector2::new(0.8, 0.6),
            across: Vector2::new(-0.6, 0.8),
            margin_px: 1.5,
            columns,
            rows,
        }
    }

    #[test]
    fn pixel_of_inverts_image_from_strip() {
        let strip = strip(21, 13);
        let m = strip.image_from_strip();
        for (column, row) in [(0, 0), (20, 12), (7, 3)] {
            let p = m * Vector3::new(column as f64 + 0.5, row as f64 + 0.5, 1.0);
            let p = Point2::new(p.x, p.y);
            assert_eq!(strip.pixel_of(&p), Some((column, row)));
            let distance = (p - strip.origin).dot(&strip.across);
            assert!((distance - strip.distance_px(row)).abs() < 1e-9);
        }
        assert_eq!(strip.pixel_of(&strip.origin), None, "the line itself");
    }

    #[test]
    fn warp_agrees_with_sampling_one_by_one() {
        let image = Gray::from_fn(90, 80, |x, y| ((x * 7 + y * 13) % 31) as f32 / 31.0);
        let strip = strip(29, 17);
        let h = Matrix3::new(0.9, 0.1, 3.0, -0.05, 1.1, -2.0, 1e-3, -2e-3, 1.2);
        let m = h * strip.image_from_strip();
        let mut patch = StripPatch::default();
        patch.warp(&image, &strip, &m);
        for row in 0..17 {
            for column in 0..29 {
                let p = m * Vector3::new(column as f64 + 0.5, row as f64 + 0.5, 1.0);
                let direct = image
                    .sample((p.x / p.z) as f32, (p.y / p.z) as f32)
                    .unwrap();
                let warped = patch.row(row)[column] / LEVELS + 0.5;
                assert!((warped - direct).abs() < 1.1e-3, "{warped} {direct}");
            }
            assert!(patch.row(row)[29..].iter().all(|&v| v == 0.0));
        }
    }

    #[test]
    fn outside_the_image_the_border_is_repeated() {
        let image = Gray::from_fn(30, 30, |_, _| 1.0);
        let mut patch = StripPatch::default();
        let far = Matrix3::new(1.0, 0.0, -400.0, 0.0, 1.0, 900.0, 0.0, 0.0, 1.0);
        patch.warp(&image, &strip(12, 9), &far);
        assert!((0..9).all(|r| patch.row(r)[..12].iter().all(|&v| v == 255.0)));
    }

    #[test]
    fn the_strip_lies_on_the_side_of_the_frame() {
        use crate::lines::lines3d::Side;
        let camera = crate::photographs::camera::testing::crop_camera(0.0, 0.0, 2.0);
        let line = Segment3::new(Point3::new(-4.0, 1.0, 8.0), Point3::new(5.0, 3.0, 8.0));
        for side in [Side::Left, Side::Right] {
            let frame = ThetaFrame::new(&line, side).unwrap();
            let strip =
                LineSideStrip::new(&camera, &line, &frame, &SweepParams::default()).unwrap();
            let on_side = camera.project(&(line.at(0.5) + frame.outward)).unwrap();
            let other = camera.project(&(line.at(0.5) - frame.outward)).unwrap();
            assert!(strip.pixel_of(&on_side).is_some());
            assert!(strip.pixel_of(&other).is_none());
        }
    }
}
