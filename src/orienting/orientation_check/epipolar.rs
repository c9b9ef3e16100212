//! Do two images agree about a point: does its best match in the other image lie on its epipolar
//! line?
//!
//! The window around the point is compared (normalised cross-correlation) with every position on
//! the epipolar line l' = F x and on lines shifted across it by up to [`MAX_SHIFT`] pixels. With a
//! correct orientation the best match lies on the line; with a wrong one it is as likely on any of
//! the shifted lines. The shifted lines calibrate the test: texture, season and noise lower the
//! correlation on all lines alike.
//!
//! Windows are rotated and scaled by the homography of a plane perpendicular to the mean viewing
//! direction: images of strips flown in opposite directions differ by half a turn.

use std::ops::Range;

use nalgebra::{Matrix2, Point2, Point3, Vector2, Vector3};
use wide::f32x8;

use crate::base::geometry::Plane;
use crate::photographs::camera::{Camera, fundamental, homography_of_plane};
use crate::photographs::raster::Gray;

/// Farthest shifted line, pixels of the reduced image.
pub(crate) const MAX_SHIFT: usize = 6;

/// Half the window, pixels of the reduced image.
const HALF_WINDOW: usize = 4;

/// Side of the window.
const WINDOW: usize = 2 * HALF_WINDOW + 1;

/// Pixels between a point and the border of its image.
pub(crate) const MARGIN: usize = MAX_SHIFT + HALF_WINDOW + 2;

/// Least correlation of a match. Assumption: a point that correlates less on every line is
/// occluded, or changed.
const MIN_CORRELATION: f32 = 0.7;

/// Least standard deviation of grey values in a window, grey range 1: below it there is only noise.
const MIN_CONTRAST: f32 = 0.01;

/// Range of the depth of a point, in baselines. Assumption: aerial rays intersect at angles between
/// 2 and 100 degrees. Without an upper limit, crops centred on one place agree under any short
/// focal length.
const DEPTH_RANGE: [f64; 2] = [0.4, 30.0];

/// Shortest part of an epipolar line that is searched, pixels.
const MIN_LENGTH_PX: f64 = 4.0;

/// A reduced image with its camera.
pub(crate) struct ReducedView<'a> {
    pub camera: Camera,
    pub gray: &'a Gray,
}

/// The best match of a point in the other image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EpipolarMatch {
    /// Its position, pixels.
    pub at: Point2<f64>,
    /// Shift across the epipolar line, whole pixels.
    pub shift: i32,
}

/// Searches the other image along the epipolar lines of a point.
pub(crate) fn best_match(
    first: &ReducedView,
    second: &ReducedView,
    axis: &Vector3<f64>,
    x: &Point2<f64>,
) -> Option<EpipolarMatch> {
    let line = EpipolarSegment::new(&first.camera, &second.camera, x)?;
    let middle = line.start + line.along * (0.5 * line.length);
    let world = line.triangulate(&first.camera, &second.camera, x, &middle)?;
    let first_from_line = line.map_to_first(&first.camera, &second.camera, &world, axis)?;
    let template = template(first.gray, x, &first_from_line)?;
    let strip = RectifiedStrip::new(second.gray, &line);
    let best = strip.best(
        &template,
        0..strip.positions(),
        0..2 * MAX_SHIFT + 1,
        MIN_CORRELATION,
    );
    best.map(|(u, v)| {
        let shift = v as i32 - MAX_SHIFT as i32;
        EpipolarMatch {
            at: line.start + line.along * u as f64 + line.across * f64::from(shift),
            shift,
        }
    })
}

/// The match x' of x to a fraction of a pixel in the images at full resolution. `near` is its
/// position to within `reach_px`.
pub(crate) fn refined_match(
    first: &ReducedView,
    second: &ReducedView,
    axis: &Vector3<f64>,
    x: &Point2<f64>,
    near: &Point2<f64>,
    reach_px: f64,
) -> Option<Point2<f64>> {
    let mut line = EpipolarSegment::line(&first.camera, &second.camera, x)?;
    let along = line.along * line.along.dot(&(near - line.start));
    let middle = line.start + along;
    line.start = middle - line.along * reach_px.ceil();
    line.length = 2.0 * reach_px.ceil();
    let inside = [line.start, line.end()].map(|p| second.camera.contains(&p, MARGIN as f64));
    if inside != [true, true] {
        return None;
    }
    let world = line.triangulate(&first.camera, &second.camera, x, &middle)?;
    let first_from_line = line.map_to_first(&first.camera, &second.camera, &world, axis)?;
    let template = template(first.gray, x, &first_from_line)?;
    let strip = RectifiedStrip::new(second.gray, &line);
    let (u, v) = strip.best(
        &template,
        1..strip.positions() - 1,
        1..2 * MAX_SHIFT,
        MIN_REFINED_CORRELATION,
    )?;
    let at = |u: usize, v: usize| f64::from(strip.correlations(&template, u, v)[0]);
    let peak = at(u, v);
    let du = parabola_peak(at(u - 1, v), peak, at(u + 1, v))?;
    let dv = parabola_peak(at(u, v - 1), peak, at(u, v + 1))?;
    let shift = v as f64 + dv - MAX_SHIFT as f64;
    Some(line.start + line.along * (u as f64 + du) + line.across * shift)
}

/// Least correlation of a match that is measured to a fraction of a pixel.
const MIN_REFINED_CORRELATION: f32 = 0.85;

/// The peak of the parabola through three values, if the middle one is the greatest.
fn parabola_peak(before: f64, peak: f64, after: f64) -> Option<f64> {
    let curvature = before - 2.0 * peak + after;
    (peak > before && peak > after).then(|| 0.5 * (before - after) / curvature)
}

/// The part of an epipolar line on which the point may lie.
struct EpipolarSegment {
    start: Point2<f64>,
    /// Unit vectors along the line and across it.
    along: Vector2<f64>,
    across: Vector2<f64>,
    length: f64,
}

impl EpipolarSegment {
    /// The whole line, from the point nearest to the origin of the image; without length.
    fn line(first: &Camera, second: &Camera, x: &Point2<f64>) -> Option<Self> {
        let l = fundamental(first, second) * Vector3::new(x.x, x.y, 1.0);
        let across = l.xy().try_normalize(0.0)?;
        Some(Self {
            start: Point2::from(-across * (l.z / l.xy().norm())),
            along: Vector2::new(across.y, -across.x),
            across,
            length: 0.0,
        })
    }

    fn end(&self) -> Point2<f64> {
        self.start + self.along * self.length
    }

    /// The longest part that lies inside the image and within [`DEPTH_RANGE`].
    fn new(first: &Camera, second: &Camera, x: &Point2<f64>) -> Option<Self> {
        let line = Self::line(first, second, x)?;
        let (foot, along, across) = (line.start, line.along, line.across);
        let [low, high] = clip_to_image(second, &foot, &along)?;
        let baseline = (first.center - second.center).norm();
        let is_possible = |t: f64| {
            ray_depth(first, second, x, &(foot + along * t))
                .is_some_and(|d| d > DEPTH_RANGE[0] * baseline && d < DEPTH_RANGE[1] * baseline)
        };
        let steps = ((high - low) / 2.0).floor() as usize;
        let (mut best, mut from) = ([0, 0], None);
        for i in 0..=steps {
            let possible = is_possible(low + 2.0 * i as f64);
            from = if possible { from.or(Some(i)) } else { None };
            if let Some(f) = from.filter(|f| i - f > best[1] - best[0]) {
                best = [f, i];
            }
        }
        let length = 2.0 * (best[1] - best[0]) as f64;
        (length >= MIN_LENGTH_PX).then(|| Self {
            start: foot + along * (low + 2.0 * best[0] as f64),
            along,
            across,
            length,
        })
    }

    /// The world point on the ray of `x` that is nearest to the ray of `y`.
    fn triangulate(
        &self,
        first: &Camera,
        second: &Camera,
        x: &Point2<f64>,
        y: &Point2<f64>,
    ) -> Option<Point3<f64>> {
        Some(first.center + first.ray(x) * ray_depth(first, second, x, y)?)
    }

    /// Steps along and across the line, as steps in the first image: by the homography of a plane
    /// perpendicular to `axis`.
    fn map_to_first(
        &self,
        first: &Camera,
        second: &Camera,
        world: &Point3<f64>,
        axis: &Vector3<f64>,
    ) -> Option<Matrix2<f64>> {
        let plane = Plane::from_point_normal(world, axis)?;
        let map = homography_of_plane(second, first, &plane)?;
        let y = second.project(world)?;
        let reach = HALF_WINDOW as f64;
        let column = |d: &Vector2<f64>| {
            let (a, b) = (map.apply(&(y - d * reach))?, map.apply(&(y + d * reach))?);
            Some((b - a) / (2.0 * reach))
        };
        let m = Matrix2::from_columns(&[column(&self.along)?, column(&self.across)?]);
        let scale = m.determinant();
        // Mirrored images, or images of very different scales, cannot be compared.
        (0.2..5.0).contains(&scale).then_some(m)
    }
}

/// Distance along the ray of `x` at which the ray of `y` passes nearest; `None` behind either
/// camera.
fn ray_depth(first: &Camera, second: &Camera, x: &Point2<f64>, y: &Point2<f64>) -> Option<f64> {
    let (r, q) = (first.ray(x), second.ray(y));
    let base = second.center - first.center;
    let cross = r.cross(&q);
    let sine2 = cross.norm_squared();
    if sine2 < 1e-12 {
        return None;
    }
    let s = base.cross(&q).dot(&cross) / sine2;
    let t = base.cross(&r).dot(&cross) / sine2;
    (s > 0.0 && t > 0.0).then_some(s)
}

/// The range of t for which foot + along t lies inside the image by the margin.
fn clip_to_image(camera: &Camera, foot: &Point2<f64>, along: &Vector2<f64>) -> Option<[f64; 2]> {
    let margin = MARGIN as f64;
    let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
    for (p, d, size) in [
        (foot.x, along.x, f64::from(camera.width)),
        (foot.y, along.y, f64::from(camera.height)),
    ] {
        let (a, b) = ((margin - p) / d, (size - margin - p) / d);
        if d.abs() > 1e-9 {
            (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
        } else if !(margin..size - margin).contains(&p) {
            return None;
        }
    }
    (high - low >= MIN_LENGTH_PX && high.is_finite() && low.is_finite()).then_some([low, high])
}

/// The window around a point, in directions along and across the line: mean zero, norm one.
fn template(
    gray: &Gray,
    x: &Point2<f64>,
    first_from_line: &Matrix2<f64>,
) -> Option<[f32; WINDOW * WINDOW]> {
    let mut values = [0.0; WINDOW * WINDOW];
    for (i, value) in values.iter_mut().enumerate() {
        let step = Vector2::new(
            (i % WINDOW) as f64 - HALF_WINDOW as f64,
            (i / WINDOW) as f64 - HALF_WINDOW as f64,
        );
        let p = x + first_from_line * step;
        *value = gray.sample(p.x as f32, p.y as f32)?;
    }
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    values.iter_mut().for_each(|v| *v -= mean);
    let norm = values.iter().map(|v| v * v).sum::<f32>().sqrt();
    if norm < MIN_CONTRAST * WINDOW as f32 {
        return None;
    }
    values.iter_mut().for_each(|v| *v /= norm);
    Some(values)
}

/// Positions that are compared at once (SIMD).
const LANES: usize = 8;

/// The image around an epipolar line, resampled so that the line is a row.
struct RectifiedStrip {
    width: usize,
    /// Row by row, and [`LANES`] zeros.
    data: Vec<f32>,
}

impl RectifiedStrip {
    fn new(gray: &Gray, line: &EpipolarSegment) -> Self {
        let width = line.length as usize + 1 + 2 * HALF_WINDOW;
        let height = 2 * MAX_SHIFT + WINDOW;
        let mut data = vec![0.0; width * height + LANES];
        for (v, out) in data.chunks_exact_mut(width).take(height).enumerate() {
            let row = line.start + line.across * (v as f64 - (MAX_SHIFT + HALF_WINDOW) as f64);
            for (first, out) in out.chunks_mut(LANES).enumerate() {
                let positions: [Point2<f64>; LANES] = std::array::from_fn(|lane| {
                    row + line.along * ((LANES * first + lane) as f64 - HALF_WINDOW as f64)
                });
                let [x, y] = [positions.map(|p| p.x as f32), positions.map(|p| p.y as f32)];
                let samples = gray.sample_eight(x, y);
                // The margin keeps all of it inside the image.
                let samples = samples.is_nan().select(f32x8::ZERO, samples).to_array();
                out.copy_from_slice(&samples[..out.len()]);
            }
        }
        Self { width, data }
    }

    /// Number of positions along the line.
    fn positions(&self) -> usize {
        self.width - 2 * HALF_WINDOW
    }

    /// The position (along, across) of the best correlation with the template above `least`; the
    /// first of equals.
    fn best(
        &self,
        template: &[f32; WINDOW * WINDOW],
        along: Range<usize>,
        across: Range<usize>,
        least: f32,
    ) -> Option<(usize, usize)> {
        let mut best = (least, None);
        for v in across {
            for first in along.clone().step_by(LANES) {
                let correlations = self.correlations(template, first, v);
                for (u, correlation) in (first..along.end).zip(correlations) {
                    if correlation > best.0 {
                        best = (correlation, Some((u, v)));
                    }
                }
            }
        }
        best.1
    }

    /// Normalised cross-correlation of the template with the windows at eight positions, from `u`
    /// on along the line; arbitrary beyond the last position.
    fn correlations(&self, template: &[f32; WINDOW * WINDOW], u: usize, v: usize) -> [f32; LANES] {
        let [mut product, mut sum, mut squares] = [f32x8::ZERO; 3];
        for row in 0..WINDOW {
            let from = (v + row) * self.width + u;
            let windows = self.data[from..from + WINDOW + LANES - 1].windows(LANES);
            for (values, t) in windows.zip(&template[row * WINDOW..(row + 1) * WINDOW]) {
                let values = f32x8::from(<[f32; LANES]>::try_from(values).expect("eight"));
                product += values * f32x8::splat(*t);
                sum += values;
                squares += values * values;
            }
        }
        let count = f32x8::splat((WINDOW * WINDOW) as f32);
        let variance = squares / count - sum * sum / (count * count);
        let flat = variance.simd_lt(f32x8::splat(MIN_CONTRAST * MIN_CONTRAST));
        let correlation = product / (variance * count).sqrt();
        flat.select(f32x8::ZERO, correlation).to_array()
    }
}
