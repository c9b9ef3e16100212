//! Do two images agree about a point: is what lies on its epipolar line in the other image more like it than what
//! lies beside the line?
//!
//! The neighbourhood of the point is compared (normalised correlation) with every place on the epipolar line
//! l' = F x and on lines shifted across it by up to [`SHIFTS`] pixels. With a right orientation the best place lies on
//! the line; with a wrong one it is as likely on any of the shifted lines. These calibrate the test
//! themselves: texture, season and noise lower the correlation on all lines alike.
//!
//! Windows are turned and scaled as a plane across the views' mean axis at the place asks for: strips flown in
//! opposite directions differ by half a turn.

use std::ops::Range;

use nalgebra::{Matrix2, Point2, Point3, Vector2, Vector3};
use wide::f32x8;

use crate::camera::{Camera, fundamental, homography_of_plane};
use crate::geometry::Plane;
use crate::raster::Gray;

/// Farthest shifted line, pixels of the reduced image.
pub(crate) const SHIFTS: usize = 6;

/// Half the window, pixels of the reduced image.
const HALF: usize = 4;

/// Side of the window.
const SIDE: usize = 2 * HALF + 1;

/// Pixels between a point and the border of its image.
pub(crate) const MARGIN: usize = SHIFTS + HALF + 2;

/// Least correlation of a place that counts. Assumption: what is less alike on every line is hidden, or changed.
const LEAST_CORRELATION: f32 = 0.7;

/// Least standard deviation of grey values in a window, 0 to 1: below it there is only noise.
const LEAST_CONTRAST: f32 = 0.01;

/// Depths at which a point may lie, in baselines. Assumption: aerial views meet at angles between two degrees and
/// a hundred. Without an upper end, crops centred on the same place agree under any short focal length.
const DEPTHS: [f64; 2] = [0.4, 30.0];

/// Shortest part of an epipolar line worth a search, pixels.
const SHORTEST: f64 = 4.0;

/// A view, reduced.
pub(crate) struct Reduced<'a> {
    pub camera: Camera,
    pub gray: &'a Gray,
}

/// The best place for a point in the other image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Where, pixels.
    pub at: Point2<f64>,
    /// Shift across the epipolar line, whole pixels.
    pub shift: i32,
}

/// Searches the other image along the epipolar lines of a point.
pub(crate) fn best_place(
    first: &Reduced,
    second: &Reduced,
    axis: &Vector3<f64>,
    x: &Point2<f64>,
) -> Option<Place> {
    let path = Path::new(&first.camera, &second.camera, x)?;
    let middle = path.start + path.along * (0.5 * path.length);
    let world = path.world(&first.camera, &second.camera, x, &middle)?;
    let first_from_path = path.map_to_first(&first.camera, &second.camera, &world, axis)?;
    let template = template(first.gray, x, &first_from_path)?;
    let strip = Strip::new(second.gray, &path);
    let best = strip.best(
        &template,
        0..strip.places(),
        0..2 * SHIFTS + 1,
        LEAST_CORRELATION,
    );
    best.map(|(u, v)| {
        let shift = v as i32 - SHIFTS as i32;
        Place {
            at: path.start + path.along * u as f64 + path.across * f64::from(shift),
            shift,
        }
    })
}

/// The same place to a fraction of a pixel in the images as they are: (x, x') in pixels. `near` is where it was
/// found, within `reach_px`.
pub(crate) fn fine_place(
    first: &Reduced,
    second: &Reduced,
    axis: &Vector3<f64>,
    x: &Point2<f64>,
    near: &Point2<f64>,
    reach_px: f64,
) -> Option<Point2<f64>> {
    let mut path = Path::line(&first.camera, &second.camera, x)?;
    let along = path.along * path.along.dot(&(near - path.start));
    let middle = path.start + along;
    path.start = middle - path.along * reach_px.ceil();
    path.length = 2.0 * reach_px.ceil();
    let inside = [path.start, path.end()].map(|p| second.camera.contains(&p, MARGIN as f64));
    if inside != [true, true] {
        return None;
    }
    let world = path.world(&first.camera, &second.camera, x, &middle)?;
    let first_from_path = path.map_to_first(&first.camera, &second.camera, &world, axis)?;
    let template = template(first.gray, x, &first_from_path)?;
    let strip = Strip::new(second.gray, &path);
    let (u, v) = strip.best(
        &template,
        1..strip.places() - 1,
        1..2 * SHIFTS,
        LEAST_FINE_CORRELATION,
    )?;
    let at = |u: usize, v: usize| f64::from(strip.correlations(&template, u, v)[0]);
    let top = at(u, v);
    let du = summit(at(u - 1, v), top, at(u + 1, v))?;
    let dv = summit(at(u, v - 1), top, at(u, v + 1))?;
    let shift = v as f64 + dv - SHIFTS as f64;
    Some(path.start + path.along * (u as f64 + du) + path.across * shift)
}

/// Least correlation of a place that is measured to a fraction of a pixel.
const LEAST_FINE_CORRELATION: f32 = 0.85;

/// Where the parabola through three values has its summit, if the middle one is the greatest.
fn summit(before: f64, top: f64, after: f64) -> Option<f64> {
    let curvature = before - 2.0 * top + after;
    (top > before && top > after).then(|| 0.5 * (before - after) / curvature)
}

/// The part of an epipolar line on which the point may lie.
struct Path {
    start: Point2<f64>,
    /// Unit vectors along the line and across it.
    along: Vector2<f64>,
    across: Vector2<f64>,
    length: f64,
}

impl Path {
    /// The whole line, from the point nearest to the zero of the image; without length.
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

    /// The part that lies inside the image and at possible depths.
    fn new(first: &Camera, second: &Camera, x: &Point2<f64>) -> Option<Self> {
        let line = Self::line(first, second, x)?;
        let (foot, along, across) = (line.start, line.along, line.across);
        let [low, high] = clip(second, &foot, &along)?;
        // Of the line within the image, the longest part whose depth is possible.
        let baseline = (first.center - second.center).norm();
        let is_possible = |t: f64| {
            depth(first, second, x, &(foot + along * t))
                .is_some_and(|d| d > DEPTHS[0] * baseline && d < DEPTHS[1] * baseline)
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
        (length >= SHORTEST).then(|| Self {
            start: foot + along * (low + 2.0 * best[0] as f64),
            along,
            across,
            length,
        })
    }

    /// The world point seen at `x` and nearest to the ray of `y`.
    fn world(
        &self,
        first: &Camera,
        second: &Camera,
        x: &Point2<f64>,
        y: &Point2<f64>,
    ) -> Option<Point3<f64>> {
        Some(first.center + first.ray(x) * depth(first, second, x, y)?)
    }

    /// Steps along and across the path, as steps in the first image: by a plane across `axis`.
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
        let reach = HALF as f64;
        let column = |d: &Vector2<f64>| {
            let (a, b) = (map.apply(&(y - d * reach))?, map.apply(&(y + d * reach))?);
            Some((b - a) / (2.0 * reach))
        };
        let m = Matrix2::from_columns(&[column(&self.along)?, column(&self.across)?]);
        let scale = m.determinant();
        // Mirrored, or seen from very different distances: nothing to compare.
        (0.2..5.0).contains(&scale).then_some(m)
    }
}

/// Distance along the ray of `x` at which the ray of `y` passes nearest; `None` behind either camera.
fn depth(first: &Camera, second: &Camera, x: &Point2<f64>, y: &Point2<f64>) -> Option<f64> {
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
fn clip(camera: &Camera, foot: &Point2<f64>, along: &Vector2<f64>) -> Option<[f64; 2]> {
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
    (high - low >= SHORTEST && high.is_finite() && low.is_finite()).then_some([low, high])
}

/// The window around a point in the frame of the path: mean zero, length one.
fn template(
    gray: &Gray,
    x: &Point2<f64>,
    first_from_path: &Matrix2<f64>,
) -> Option<[f32; SIDE * SIDE]> {
    let mut values = [0.0; SIDE * SIDE];
    for (i, value) in values.iter_mut().enumerate() {
        let step = Vector2::new(
            (i % SIDE) as f64 - HALF as f64,
            (i / SIDE) as f64 - HALF as f64,
        );
        let p = x + first_from_path * step;
        *value = gray.sample(p.x as f32, p.y as f32)?;
    }
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    values.iter_mut().for_each(|v| *v -= mean);
    let norm = values.iter().map(|v| v * v).sum::<f32>().sqrt();
    if norm < LEAST_CONTRAST * SIDE as f32 {
        return None;
    }
    values.iter_mut().for_each(|v| *v /= norm);
    Some(values)
}

/// Places that are compared at once.
const LANES: usize = 8;

/// The image around a path, resampled along it.
struct Strip {
    width: usize,
    /// Row by row, and [`LANES`] zeros.
    data: Vec<f32>,
}

impl Strip {
    fn new(gray: &Gray, path: &Path) -> Self {
        let width = path.length as usize + 1 + 2 * HALF;
        let height = 2 * SHIFTS + SIDE;
        let mut data = vec![0.0; width * height + LANES];
        for (v, out) in data.chunks_exact_mut(width).take(height).enumerate() {
            let row = path.start + path.across * (v as f64 - (SHIFTS + HALF) as f64);
            for (first, out) in out.chunks_mut(LANES).enumerate() {
                let places: [Point2<f64>; LANES] = std::array::from_fn(|lane| {
                    row + path.along * ((LANES * first + lane) as f64 - HALF as f64)
                });
                let [x, y] = [places.map(|p| p.x as f32), places.map(|p| p.y as f32)];
                let samples = gray.sample_eight(x, y);
                // The margin keeps all of it inside the image.
                let samples = samples.is_nan().select(f32x8::ZERO, samples).to_array();
                out.copy_from_slice(&samples[..out.len()]);
            }
        }
        Self { width, data }
    }

    /// Places along the path.
    fn places(&self) -> usize {
        self.width - 2 * HALF
    }

    /// The first of the places most like the template: (along, across), if they correlate by more than `least`.
    fn best(
        &self,
        template: &[f32; SIDE * SIDE],
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

    /// Normalised correlation of the template with the windows at eight places, from `u` on along the path; behind the last place
    /// any value.
    fn correlations(&self, template: &[f32; SIDE * SIDE], u: usize, v: usize) -> [f32; LANES] {
        let [mut product, mut sum, mut squares] = [f32x8::ZERO; 3];
        for row in 0..SIDE {
            let from = (v + row) * self.width + u;
            let windows = self.data[from..from + SIDE + LANES - 1].windows(LANES);
            for (values, t) in windows.zip(&template[row * SIDE..(row + 1) * SIDE]) {
                let values = f32x8::from(<[f32; LANES]>::try_from(values).expect("eight"));
                product += values * f32x8::splat(*t);
                sum += values;
                squares += values * values;
            }
        }
        let count = f32x8::splat((SIDE * SIDE) as f32);
        let variance = squares / count - sum * sum / (count * count);
        let flat = variance.simd_lt(f32x8::splat(LEAST_CONTRAST * LEAST_CONTRAST));
        let correlation = product / (variance * count).sqrt();
        flat.select(f32x8::ZERO, correlation).to_array()
    }
}
