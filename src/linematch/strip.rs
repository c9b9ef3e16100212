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

use nalgebra::{Point2, Vector2, Vector3};

use crate::camera::Homography;
use crate::geometry::Segment2;
use crate::raster::Gray;

/// Rows of sample positions along a line of the reference view.
#[derive(Clone, Copy, Debug)]
pub struct StripFrame {
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
    pub fn new(segment: &Segment2, window_px: usize) -> Self {
        Self {
            origin: segment.p0,
            along: segment.direction(),
            across: segment.normal(),
            edgels: segment.length() as usize + 1,
            half: window_px / 2,
        }
    }

    /// The part of the frame from edgel `first` on, `edgels` long.
    pub fn part(&self, first: usize, edgels: usize) -> Self {
        Self {
            origin: self.origin + self.along * first as f64,
            edgels,
            ..*self
        }
    }

    /// Image position of an edgel in the reference view.
    pub fn edgel(&self, i: usize) -> Point2<f64> {
        self.origin + self.along * i as f64
    }

    fn width(&self) -> usize {
        2 * self.half + 1
    }

    fn rows(&self) -> usize {
        self.edgels + 2 * self.half
    }
}

/// Grey values of a strip, row by row; the rows reach half a window past the first and last edgel.
pub struct Strip {
    width: usize,
    half: usize,
    values: Vec<f32>,
    /// Which rows lie inside the image.
    valid: Vec<bool>,
}

/// Which side of the line, in the reference view's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StripSide {
    /// Against the across direction: left as seen on the screen.
    Left,
    /// Along the across direction: right as seen on the screen, bright for a segment directed by
    /// contrast.
    Right,
}

impl StripSide {
    /// Both sides, in the order of score pairs.
    pub const BOTH: [StripSide; 2] = [StripSide::Left, StripSide::Right];

    /// The columns of a side: its half of the window and one pixel beyond the line, which makes the
    /// edge profile part of both.
    fn columns(self, half: usize) -> std::ops::Range<usize> {
        match self {
            StripSide::Left => 0..half + 2,
            StripSide::Right => half - 1..2 * half + 1,
        }
    }
}

impl Strip {
    /// Samples the strip in the reference view itself.
    pub fn reference(gray: &Gray, frame: &StripFrame) -> Self {
        let identity = Homography(nalgebra::Matrix3::identity());
        let all = 0..frame.width();
        Self::sample(gray, &identity, frame, all)
    }

    /// Samples one side of the strip in another view, warped by the homography of a plane from the
    /// reference view.
    pub fn warped(gray: &Gray, h: &Homography, frame: &StripFrame, side: StripSide) -> Self {
        Self::sample(gray, h, frame, side.columns(frame.half))
    }

    fn sample(
        gray: &Gray,
        h: &Homography,
        frame: &StripFrame,
        columns: std::ops::Range<usize>,
    ) -> Self {
        let (width, rows) = (frame.width(), frame.rows());
        let mut values = vec![0.0; width * rows];
        let mut valid = vec![false; rows];
        let start = frame.origin - frame.along * frame.half as f64;
        // Homogeneous coordinates are linear along the row of edgels and across it.
        let first = h.0 * Vector3::new(start.x, start.y, 1.0);
        let along = h.0 * Vector3::new(frame.along.x, frame.along.y, 0.0);
        let across = h.0 * Vector3::new(frame.across.x, frame.across.y, 0.0);
        let left = columns.start as f64 - frame.half as f64;
        for row in 0..rows {
            let x = first + along * row as f64;
            if x.z <= 1e-12 {
                continue;
            }
            // To first order across the line: over seven pixels the second order is below 0.01 px.
            let centre = x.xy() / x.z;
            let step = (across.xy() - centre * across.z) / x.z;
            let out = &mut values[row * width + columns.start..row * width + columns.end];
            valid[row] = sample_row(gray, &(centre + step * left), &step, out);
        }
        Self {
            width,
            half: frame.half,
            values,
            valid,
        }
    }

    fn row(&self, row: usize) -> &[f32] {
        &self.values[row * self.width..(row + 1) * self.width]
    }

    /// The part of the strip that belongs to [`StripFrame::part`].
    pub fn part(&self, first: usize, edgels: usize) -> Self {
        let rows = first..first + edgels + 2 * self.half;
        Self {
            width: self.width,
            half: self.half,
            values: self.values[rows.start * self.width..rows.end * self.width].to_vec(),
            valid: self.valid[rows].to_vec(),
        }
    }
}

/// Bilinear samples at `start`, `start + step`, ...; false (and no samples) if any leaves the
/// image.
fn sample_row(gray: &Gray, start: &Vector2<f64>, step: &Vector2<f64>, out: &mut [f32]) -> bool {
    let end = start + step * (out.len() - 1) as f64;
    let (right, bottom) = (gray.width as f64 - 0.5, gray.height as f64 - 0.5);
    let inside =
        |p: &Vector2<f64>| p.x >= 0.5 && p.y >= 0.5 && p.x < right - 1e-3 && p.y < bottom - 1e-3;
    if !inside(start) || !inside(&end) {
        return false;
    }
    let (mut x, mut y) = (start.x as f32 - 0.5, start.y as f32 - 0.5);
    let (dx, dy) = (step.x as f32, step.y as f32);
    let (w, last) = (gray.width, gray.data.len() - 1);
    for o in out {
        let (column, row) = (x as usize, y as usize);
        let (fx, fy) = (x - column as f32, y - row as f32);
        let i = row * w + column;
        // The clamp is for rounding in the last row only; it never moves an interior sample.
        let (i, j) = (i.min(last - 1), (i + w).min(last - 1));
        let top = gray.data[i] + (gray.data[i + 1] - gray.data[i]) * fx;
        let low = gray.data[j] + (gray.data[j + 1] - gray.data[j]) * fx;
        *o = top + (low - top) * fy;
        x += dx;
        y += dy;
    }
    true
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
    fn of_row(a: &[f32], b: &[f32]) -> Self {
        let (mut sa, mut sb, mut saa, mut sbb, mut sab) = (0.0f32, 0.0f32, 0.0f32, 0.0f32, 0.0f32);
        for (x, y) in a.iter().zip(b) {
            // Centred on mid grey, squares keep their digits in f32.
            let (x, y) = (x - 0.5, y - 0.5);
            sa += x;
            sb += y;
            saa += x * x;
            sbb += y * y;
            sab += x * y;
        }
        Self {
            rows: 1.0,
            a: f64::from(sa),
            b: f64::from(sb),
            aa: f64::from(saa),
            bb: f64::from(sbb),
            ab: f64::from(sab),
        }
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
pub fn correlate(a: &Strip, b: &Strip, side: StripSide, noise: f64) -> Vec<f32> {
    let columns = side.columns(a.half);
    let window = 2 * a.half + 1;
    let rows: Vec<Sums> = (0..a.valid.len())
        .map(|r| {
            if a.valid[r] && b.valid[r] {
                Sums::of_row(&a.row(r)[columns.clone()], &b.row(r)[columns.clone()])
            } else {
                Sums::default()
            }
        })
        .collect();
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
        let reference = Strip::reference(&a, &frame);
        for side in StripSide::BOTH {
            let scores = |h: Matrix3<f64>| {
                let warped = Strip::warped(&b, &Homography(h), &frame, side);
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
        let reference = Strip::reference(&a, &frame);
        let identity = Homography(Matrix3::identity());
        let [left, right] = StripSide::BOTH.map(|side| {
            let warped = Strip::warped(&b, &identity, &frame, side);
            EdgelScore::of(&correlate(&reference, &warped, side, 0.005), 0.6).score
        });
        assert!(left > 0.95 && right < 0.5, "left {left}, right {right}");
    }

    #[test]
    fn flat_windows_do_not_correlate() {
        let flat = Gray::from_fn(80, 80, |c, r| 0.5 + 0.0005 * ((c * 7 + r * 3) % 5) as f32);
        let line = Segment2::new(Point2::new(20.0, 40.0), Point2::new(60.0, 40.0));
        let frame = StripFrame::new(&line, 15);
        let strip = Strip::reference(&flat, &frame);
        let c = correlate(&strip, &strip, StripSide::Left, 0.006);
        assert!(c.iter().all(|c| *c < 0.1));
    }

    #[test]
    fn windows_outside_the_image_are_not_scored() {
        let a = image(&Matrix3::identity());
        let line = Segment2::new(Point2::new(20.0, 3.0), Point2::new(60.0, 3.0));
        let frame = StripFrame::new(&line, 15);
        let strip = Strip::reference(&a, &frame);
        assert!(
            correlate(&strip, &strip, StripSide::Left, 0.005)
                .iter()
                .all(|c| c.is_nan())
        );
    }
}
