//! Correlation of the neighbourhoods of a line in two views (B99 3.1, 3.2; Schmid and Zisserman
//! 1997).
//!
//! The neighbourhood of a line is a strip: one row of samples across the line for each edgel, a
//! pixel apart in the reference view. In another view the same strip is sampled through the
//! homography of a plane through the line, so that strips flown in opposite directions need no
//! special case. A strip is sampled once and serves all windows along it: the centred normalised
//! cross-correlation of the 15 x 15 window at each edgel comes from running sums over the rows.
//!
//! Deviation from the paper: the two sides of the line are scored separately, each with its half of
//! the window (the line itself belongs to both), because beyond an eave or a rake the background
//! moves.

use std::ops::Range;

use nalgebra::{Point2, Vector2, Vector3};
use wide::f32x8;

use crate::base::geometry::Segment2;
use crate::photographs::camera::Homography;
use crate::photographs::raster::Gray;

/// Rows of sample positions along a line of the reference view.
#[derive(Clone, Copy, Debug)]
pub(super) struct StripFrame {
    /// The first edgel, pixels.
    origin: Point2<f64>,
    /// Unit direction along the line; edgels are one pixel apart.
    along: Vector2<f64>,
    /// Unit direction across the line, to its right as seen on the screen.
    across: Vector2<f64>,
    /// Number of edgels.
    pub edgels: usize,
    /// Half the window, pixels: 7 for a 15 x 15 window.
    half: usize,
}

impl StripFrame {
    /// The frame of a segment with windows of `window_px`.
    pub(super) fn new(segment: &Segment2, window_px: usize) -> Self {
        Self {
            origin: segment.p0,
            along: segment.direction(),
            across: segment.normal(),
            edgels: segment.length() as usize + 1,
            half: window_px / 2,
        }
    }

    /// The part of the frame from edgel `first` on, `edgels` long.
    pub(super) fn part(&self, first: usize, edgels: usize) -> Self {
        Self {
            origin: self.origin + self.along * first as f64,
            edgels,
            ..*self
        }
    }

    /// Image position of an edgel in the reference view.
    pub(super) fn edgel(&self, i: usize) -> Point2<f64> {
        self.origin + self.along * i as f64
    }

    fn width(&self) -> usize {
        2 * self.half + 1
    }

    fn rows(&self) -> usize {
        self.edgels + 2 * self.half
    }
}

/// Grey values of a strip, stored by column so that eight rows are processed at once. The rows
/// reach half a window past the first and last edgel.
pub(super) struct LineStrip {
    half: usize,
    /// Length of a column: the number of rows, made a multiple of eight.
    stride: usize,
    values: Vec<f32>,
    /// Which rows lie inside the image.
    valid: Vec<bool>,
}

/// Which side of the line, in the reference view's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StripSide {
    /// Against the across direction: left as seen on the screen.
    Left,
    /// Along the across direction: right as seen on the screen, bright for a segment directed by
    /// contrast.
    Right,
}

impl StripSide {
    /// Both sides, in the order of score pairs.
    pub(super) const BOTH: [StripSide; 2] = [StripSide::Left, StripSide::Right];

    /// The columns of a side: its half of the window and one pixel beyond the line, which makes the
    /// edge profile part of both.
    fn columns(self, half: usize) -> Range<usize> {
        match self {
            StripSide::Left => 0..half + 2,
            StripSide::Right => half - 1..2 * half + 1,
        }
    }
}

impl LineStrip {
    /// Samples the strip in the reference view itself.
    pub(super) fn reference(gray: &Gray, frame: &StripFrame) -> Self {
        let identity = Homography(nalgebra::Matrix3::identity());
        let all = 0..frame.width();
        Self::sample(gray, &identity, frame, all)
    }

    /// Samples one side of the strip in another view, warped by the homography of a plane from the
    /// reference view.
    pub(super) fn warped(gray: &Gray, h: &Homography, frame: &StripFrame, side: StripSide) -> Self {
        Self::sample(gray, h, frame, side.columns(frame.half))
    }

    fn sample(gray: &Gray, h: &Homography, frame: &StripFrame, columns: Range<usize>) -> Self {
        let rows = frame.rows();
        let stride = rows.next_multiple_of(8);
        let mut strip = Self {
            half: frame.half,
            stride,
            values: vec![0.0; frame.width() * stride],
            valid: vec![false; rows],
        };
        let start = frame.origin - frame.along * frame.half as f64;
        // Homogeneous coordinates are linear along the row of edgels and across it.
        let first = h.0 * Vector3::new(start.x, start.y, 1.0);
        let along = h.0 * Vector3::new(frame.along.x, frame.along.y, 0.0);
        let across = h.0 * Vector3::new(frame.across.x, frame.across.y, 0.0);
        let left = columns.start as f64 - frame.half as f64;
        for eight in (0..rows).step_by(8) {
            let mut places = [RowPlace::default(); 8];
            for (row, place) in (eight..rows).zip(&mut places) {
                let x = first + along * row as f64;
                if x.z <= 1e-12 {
                    continue;
                }
                // The second order across the line is below 0.01 px over seven pixels.
                let centre = x.xy() / x.z;
                let step = (across.xy() - centre * across.z) / x.z;
                let inside = RowPlace::new(gray, centre + step * left, step, columns.len());
                strip.valid[row] = inside.is_some();
                *place = inside.unwrap_or_default();
            }
            if strip.valid[eight..rows.min(eight + 8)].contains(&true) {
                strip.fill(gray, eight, &places, columns.clone());
            }
        }
        strip
    }

    /// Samples eight rows from `first` on.
    fn fill(&mut self, gray: &Gray, first: usize, places: &[RowPlace; 8], columns: Range<usize>) {
        let of = |value: fn(&RowPlace) -> f32| f32x8::from(places.each_ref().map(value));
        let (mut x, mut y) = (of(|p| p.x), of(|p| p.y));
        let (dx, dy) = (of(|p| p.dx), of(|p| p.dy));
        for column in columns {
            let out = &mut self.values[column * self.stride + first..][..8];
            out.copy_from_slice(gray.between(x, y).as_array());
            x += dx;
            y += dy;
        }
    }

    /// Rows of a column from `first` on.
    #[inline(always)]
    fn eight(&self, column: usize, first: usize) -> f32x8 {
        let values = &self.values[column * self.stride + first..][..8];
        f32x8::from(<[f32; 8]>::try_from(values).expect("eight rows"))
    }

    /// The part of the strip that belongs to [`StripFrame::part`].
    pub(super) fn part(&self, first: usize, edgels: usize) -> Self {
        let rows = first..first + edgels + 2 * self.half;
        let stride = rows.len().next_multiple_of(8);
        let mut values = Vec::with_capacity(self.values.len() / self.stride * stride);
        for column in self.values.chunks_exact(self.stride) {
            values.extend_from_slice(&column[rows.clone()]);
            values.resize(values.len() + stride - rows.len(), 0.0);
        }
        Self {
            half: self.half,
            stride,
            values,
            valid: self.valid[rows].to_vec(),
        }
    }
}

/// Sample positions of a row from the first one on, counted from the centre of the top-left pixel.
#[derive(Clone, Copy, Default)]
struct RowPlace {
    x: f32,
    y: f32,
    dx: f32,
    dy: f32,
}

impl RowPlace {
    /// `None` if any of the samples leaves the image.
    fn new(gray: &Gray, start: Vector2<f64>, step: Vector2<f64>, samples: usize) -> Option<Self> {
        let end = start + step * (samples - 1) as f64;
        let (right, bottom) = (gray.width as f64 - 0.5, gray.height as f64 - 0.5);
        let inside = |p: &Vector2<f64>| {
            p.x >= 0.5 && p.y >= 0.5 && p.x < right - 1e-3 && p.y < bottom - 1e-3
        };
        (inside(&start) && inside(&end)).then(|| Self {
            x: start.x as f32 - 0.5,
            y: start.y as f32 - 0.5,
            dx: step.x as f32,
            dy: step.y as f32,
        })
    }
}

/// Running sums of a window on one side of two strips.
#[derive(Clone, Copy, Default)]
struct Sums {
    rows: f64,
    a: f64,
    b: f64,
    aa: f64,
    bb: f64,
    ab: f64,
}

impl Sums {
    /// The sums of eight rows each, from `first` on, over some columns.
    fn of_rows(a: &LineStrip, b: &LineStrip, columns: Range<usize>, first: usize) -> [Self; 8] {
        let [mut sa, mut sb, mut saa, mut sbb, mut sab] = [f32x8::ZERO; 5];
        for column in columns {
            // Centred on mid grey, squares keep their digits in f32.
            let middle = f32x8::splat(0.5);
            let (x, y) = (
                a.eight(column, first) - middle,
                b.eight(column, first) - middle,
            );
            sa += x;
            sb += y;
            saa += x * x;
            sbb += y * y;
            sab += x * y;
        }
        let [sa, sb, saa, sbb, sab] = [sa, sb, saa, sbb, sab].map(|s| s.to_array());
        std::array::from_fn(|row| Self {
            rows: 1.0,
            a: f64::from(sa[row]),
            b: f64::from(sb[row]),
            aa: f64::from(saa[row]),
            bb: f64::from(sbb[row]),
            ab: f64::from(sab[row]),
        })
    }

    fn add(&mut self, o: &Self, sign: f64) {
        self.rows += sign * o.rows;
        self.a += sign * o.a;
        self.b += sign * o.b;
        self.aa += sign * o.aa;
        self.bb += sign * o.bb;
        self.ab += sign * o.ab;
    }

    /// Centred normalised cross-correlation; the noise variance added to both variances takes
    /// windows without texture to zero instead of to chance.
    fn correlation(&self, columns: usize, noise_variance: f64) -> f32 {
        let n = self.rows * columns as f64;
        let covariance = self.ab / n - self.a / n * (self.b / n);
        let va = self.aa / n - self.a / n * (self.a / n) + noise_variance;
        let vb = self.bb / n - self.b / n * (self.b / n) + noise_variance;
        (covariance / (va * vb).max(1e-18).sqrt()) as f32
    }
}

/// Correlation of one side of two strips of the same frame at each edgel; NaN where the window
/// lacks more than a quarter of its rows.
pub(super) fn correlate(a: &LineStrip, b: &LineStrip, side: StripSide, noise: f64) -> Vec<f32> {
    let columns = side.columns(a.half);
    let window = 2 * a.half + 1;
    let mut rows: Vec<Sums> = Vec::with_capacity(a.stride);
    for first in (0..a.valid.len()).step_by(8) {
        rows.extend(Sums::of_rows(a, b, columns.clone(), first));
    }
    rows.truncate(a.valid.len());
    for (row, (a, b)) in rows.iter_mut().zip(a.valid.iter().zip(&b.valid)) {
        if !(*a && *b) {
            *row = Sums::default();
        }
    }
    let mut sums = Sums::default();
    rows[..window - 1].iter().for_each(|r| sums.add(r, 1.0));
    let mut out = Vec::with_capacity(rows.len() + 1 - window);
    for last in window - 1..rows.len() {
        sums.add(&rows[last], 1.0);
        out.push(if sums.rows < 0.75 * window as f64 {
            f32::NAN
        } else {
            sums.correlation(columns.len(), noise * noise)
        });
        sums.add(&rows[last + 1 - window], -1.0);
    }
    out
}

/// The score of a stretch from the correlations at its edgels (B99 3.1 and "Implementation
/// details" of 3.2).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgelScore {
    /// Sum of the included correlations over the number of edgels seen in both views, 0 to 1.
    pub score: f64,
    /// Number of included edgels: those correlated above the edgel threshold.
    pub included: usize,
}

impl EdgelScore {
    /// Scores correlations; NaN edgels are not common to both views and count neither way.
    ///
    /// Assumption: an edgel below the threshold counts as zero. The paper's "average of the
    /// included ones" would lie above the edgel threshold always, and 150 % of a threshold for it
    /// above one.
    pub fn of(correlations: &[f32], edgel_threshold: f64) -> Self {
        let (mut sum, mut included, mut common) = (0.0, 0, 0);
        for c in correlations.iter().filter(|c| !c.is_nan()) {
            common += 1;
            if f64::from(*c) >= edgel_threshold {
                sum += f64::from(*c);
                included += 1;
            }
        }
        Self {
            score: if common > 0 {
                sum / f64::from(common)
            } else {
                0.0
            },
            included,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    /// A reproducible texture without structure.
    fn texture(x: f64, y: f64) -> f32 {
        let s = |v: f64| libm::sin(v);
        (0.5 + 0.12 * s(0.9 * x + 0.3 * y)
            + 0.12 * s(0.2 * x - 1.1 * y)
            + 0.1 * s(0.51 * x * y * 0.05)) as f32
    }

    fn image(h: &Matrix3<f64>) -> Gray {
        let inverse = h.try_inverse().unwrap();
        Gray::from_fn(160, 160, |c, r| {
            let p = inverse * Vector3::new(c as f64 + 0.5, r as f64 + 0.5, 1.0);
            texture(p.x / p.z, p.y / p.z)
        })
    }

    #[test]
    fn a_warped_strip_correlates_fully_and_a_shifted_one_does_not() {
        // Turned by 180 degrees and sheared, as between opposite strips.
        let h = Matrix3::new(-1.02, 0.05, 150.0, 0.02, -0.98, 148.0, 1e-5, -2e-5, 1.0);
        let (a, b) = (image(&Matrix3::identity()), image(&h));
        let line = Segment2::new(Point2::new(50.0, 60.0), Point2::new(90.0, 75.0));
        let frame = StripFrame::new(&line, 15);
        let reference = LineStrip::reference(&a, &frame);
        for side in StripSide::BOTH {
            let scores = |h: Matrix3<f64>| {
                let warped = LineStrip::warped(&b, &Homography(h), &frame, side);
                EdgelScore::of(&correlate(&reference, &warped, side, 0.005), 0.6)
            };
            let right = scores(h);
            assert!(right.score > 0.97, "{right:?}");
            assert_eq!(right.included, frame.edgels);
            let shift = Matrix3::new(1.0, 0.0, 3.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
            assert!(scores(shift * h).score < 0.3);
        }
    }

    #[test]
    fn sides_are_independent() {
        let a = image(&Matrix3::identity());
        // To the right of a line that runs down the screen, at smaller x, the background moved.
        let b = Gray::from_fn(160, 160, |c, r| {
            let moved = if c < 80 { 37.0 } else { 0.0 };
            texture(c as f64 + 0.5 + moved, r as f64 + 0.5 + moved)
        });
        let line = Segment2::new(Point2::new(81.0, 50.0), Point2::new(81.0, 100.0));
        let frame = StripFrame::new(&line, 15);
        let reference = LineStrip::reference(&a, &frame);
        let identity = Homography(Matrix3::identity());
        let [left, right] = StripSide::BOTH.map(|side| {
            let warped = LineStrip::warped(&b, &identity, &frame, side);
            EdgelScore::of(&correlate(&reference, &warped, side, 0.005), 0.6).score
        });
        assert!(left > 0.95 && right < 0.5, "left {left}, right {right}");
    }

    #[test]
    fn flat_windows_do_not_correlate() {
        let flat = Gray::from_fn(80, 80, |c, r| 0.5 + 0.0005 * ((c * 7 + r * 3) % 5) as f32);
        let line = Segment2::new(Point2::new(20.0, 40.0), Point2::new(60.0, 40.0));
        let frame = StripFrame::new(&line, 15);
        let strip = LineStrip::reference(&flat, &frame);
        let c = correlate(&strip, &strip, StripSide::Left, 0.006);
        assert!(c.iter().all(|c| *c < 0.1));
    }

    #[test]
    fn windows_outside_the_image_are_not_scored() {
        let a = image(&Matrix3::identity());
        let line = Segment2::new(Point2::new(20.0, 3.0), Point2::new(60.0, 3.0));
        let frame = StripFrame::new(&line, 15);
        let strip = LineStrip::reference(&a, &frame);
        assert!(
            correlate(&strip, &strip, StripSide::Left, 0.005)
                .iter()
                .all(|c| c.is_nan())
        );
    }
}
