//! The range of heights in which a scene's lines lie. The epipolar beam of B99 3.1 is endless along
//! the epipolar lines; the range cuts it to what the scene can contain.
//!
//! The paper does not say how. Here the ends of the longest segments are swept along their rays
//! through all depths at which another view can see them; an unambiguous maximum of correlation
//! that two more views confirm gives a height. The range spans the heights with enough neighbours,
//! so that a few wrong maxima do not widen it and a single tower does.

use nalgebra::{Matrix2, Matrix3, Point2, Point3, Vector2, Vector3};

use super::segment_geometry::PreparedSegments;
use crate::base::execution::parallel;
use crate::base::execution::{Sharded, sharded_map};
use crate::base::geometry::Plane;
use crate::base::ids::ViewId;
use crate::orienting::scene::Scene;
use crate::photographs::camera::{Camera, fundamental, homography_of_plane};
use crate::photographs::raster::{Gray, gaussian_blur};

/// Number of segments whose ends are swept, over all views.
const SEGMENTS: usize = 360;
/// Samples of a patch are this far apart, px, in a 7 x 7 grid.
const STRIDE_PX: f64 = 2.0;
/// Step along the epipolar line, px. Assumption: a window of correlation is as wide that a maximum
/// is not stepped over.
const EPIPOLAR_STEP_PX: f64 = 2.0;
/// Least correlation in the nearest view of a depth that the others test. Assumption: lower than
/// [`ACCEPTED_CORRELATION`], because one view may be the worst.
const CANDIDATE_CORRELATION: f64 = 0.6;
/// Least mean correlation over the other views. Assumption.
const ACCEPTED_CORRELATION: f64 = 0.75;
/// Least margin of the best depth over any other. Assumption: repeated texture correlates nearly as
/// well elsewhere.
const CORRELATION_MARGIN: f64 = 0.1;
/// A height counts when this many others lie within [`NEIGHBOUR_M`]...
const MIN_NEIGHBOURS: usize = 4;
/// ... metres of it.
const NEIGHBOUR_M: f64 = 2.0;
/// The range reaches past the lowest and highest such heights by this, metres: half a storey.
const MARGIN_M: f64 = 2.0;

/// The range of heights, and the heights that it is derived from.
pub(super) struct HeightRange {
    /// Lowest and highest, metres.
    pub z: [f64; 2],
    /// Heights found at the ends of segments, sorted, metres.
    pub heights: Vec<f64>,
}

/// Estimates the range; `None` when too few points agree.
pub(super) fn height_range(
    scene: &Scene,
    prepared: &PreparedSegments,
) -> Sharded<Option<HeightRange>> {
    let blurred: Vec<Gray> = parallel::map(&scene.views, |_, v| gaussian_blur(&v.gray, 1.0));
    let points = interest_points(scene, prepared);
    let found = sharded_map("heights", &points, 0.0..0.2, |_, (view, x)| {
        sweep(scene, &blurred, *view, x)
    })?;
    Ok(range_of(scene, found.into_iter().flatten().collect()))
}

/// The range in which heights lie that others confirm.
fn range_of(scene: &Scene, mut heights: Vec<f64>) -> Option<HeightRange> {
    heights.sort_by(f64::total_cmp);
    let neighbours = |z: f64| {
        let from = heights.partition_point(|h| *h < z - NEIGHBOUR_M);
        heights.partition_point(|h| *h <= z + NEIGHBOUR_M) - from - 1
    };
    let mut low = heights
        .iter()
        .copied()
        .find(|z| neighbours(*z) >= MIN_NEIGHBOURS)?;
    let high = heights
        .iter()
        .rev()
        .copied()
        .find(|z| neighbours(*z) >= MIN_NEIGHBOURS)?;
    if let Some(ground) = scene.ground_z {
        low = low.min(ground);
    }
    Some(HeightRange {
        z: [low - MARGIN_M, high + MARGIN_M],
        heights,
    })
}

/// A range without evidence: from well below the ground, or from where the lowest camera would see
/// it at one in ten thousand, to half way up to the lowest camera.
pub(super) fn any_height(scene: &Scene) -> [f64; 2] {
    let lowest = scene.views.iter().map(|v| v.camera.center.z);
    let camera = lowest.fold(f64::INFINITY, f64::min);
    let ground = scene.ground_z.unwrap_or_else(|| {
        let scale = |c: &Camera| c.center.z - 1000.0 * c.k[(0, 0)] / 10_000.0;
        scene
            .views
            .iter()
            .map(|v| scale(&v.camera))
            .fold(f64::INFINITY, f64::min)
    });
    [ground - MARGIN_M, ground + 0.5 * (camera - ground)]
}

/// Both ends of the longest segments of each view.
fn interest_points(scene: &Scene, prepared: &PreparedSegments) -> Vec<(ViewId, Point2<f64>)> {
    let each = SEGMENTS / scene.views.len().max(1) + 1;
    let mut points = Vec::new();
    for view in scene.view_ids() {
        let mut segments: Vec<_> = prepared.of_view(view).collect();
        segments.sort_by(|(a, s), (b, t)| t.length_px.total_cmp(&s.length_px).then(a.cmp(b)));
        for (_, s) in segments.iter().take(each) {
            points.push((view, s.segment.p0));
            points.push((view, s.segment.p1));
        }
    }
    points
}

/// Height of an image point from the depth at which its patch agrees with three other views.
fn sweep(scene: &Scene, images: &[Gray], view: ViewId, x: &Point2<f64>) -> Option<f64> {
    let camera = scene.camera(view);
    let nearest = nearest_views(scene, view);
    let (first, others) = nearest.split_first()?;
    let patch = CorrelationPatch::reference(&images[view.index()], x)?;
    let depths = epipolar_depths(camera, scene.camera(*first), x);
    let score = |j: ViewId, depth: f64| {
        let point = camera.center + camera.ray(x) * depth;
        patch.correlation(camera, scene.camera(j), &images[j.index()], &point)
    };
    let along: Vec<f64> = depths
        .iter()
        .map(|d| score(*first, *d).unwrap_or(-1.0))
        .collect();
    let mut maxima: Vec<usize> = (1..along.len().saturating_sub(1))
        .filter(|&i| {
            along[i] >= CANDIDATE_CORRELATION && along[i] >= along[i - 1] && along[i] > along[i + 1]
        })
        .collect();
    maxima.sort_by(|&a, &b| along[b].total_cmp(&along[a]).then(a.cmp(&b)));
    maxima.truncate(12);

    // A step in the nearest view may be several pixels in the others, so that depths around each
    // maximum are tested.
    let confirm = |i: usize| {
        let around = (-4..=4).map(|k| {
            let f = f64::from(k) / 4.0;
            let next = if k < 0 { depths[i - 1] } else { depths[i + 1] };
            depths[i] + (next - depths[i]) * f.abs()
        });
        around
            .filter_map(|depth| {
                let scores: Vec<f64> = others
                    .iter()
                    .take(2)
                    .map(|j| score(*j, depth))
                    .collect::<Option<_>>()?;
                let mean = scores.iter().sum::<f64>() / scores.len().max(1) as f64;
                (!scores.is_empty()).then_some((0.5 * (mean + along[i]), depth))
            })
            .max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let mut confirmed: Vec<(f64, f64)> = maxima.iter().filter_map(|&i| confirm(i)).collect();
    confirmed.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (best, depth) = *confirmed.first()?;
    let second = confirmed.get(1).map_or(0.0, |c| c.0);
    (best >= ACCEPTED_CORRELATION && best - second >= CORRELATION_MARGIN)
        .then(|| (camera.center + camera.ray(x) * depth).z)
}

/// The other views, nearest projection centre first.
pub(super) fn nearest_views(scene: &Scene, view: ViewId) -> Vec<ViewId> {
    let center = scene.camera(view).center;
    let distance = |v: &ViewId| (scene.camera(*v).center - center).norm();
    let mut others: Vec<ViewId> = scene.view_ids().filter(|v| *v != view).collect();
    others.sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
    others
}

/// Depths along the ray of `x` (metres) whose images in `second` are [`EPIPOLAR_STEP_PX`] apart,
/// from far to near or the reverse, as far as `second` sees the ray.
fn epipolar_depths(first: &Camera, second: &Camera, x: &Point2<f64>) -> Vec<f64> {
    let line = fundamental(first, second) * Vector3::new(x.x, x.y, 1.0);
    let normal = line.xy();
    if normal.norm() < 1e-12 {
        return Vec::new();
    }
    let (width, height) = (f64::from(second.width), f64::from(second.height));
    let along = Vector2::new(-normal.y, normal.x).normalize();
    let centre = Point2::new(0.5 * width, 0.5 * height);
    let offset = (normal.dot(&centre.coords) + line.z) / normal.norm();
    let foot = centre - normal.normalize() * offset;
    let half = (0.5 * (width + height) / EPIPOLAR_STEP_PX) as i32;
    let (center, ray) = (first.center, first.ray(x));
    (-half..=half)
        .map(|k| foot + along * (f64::from(k) * EPIPOLAR_STEP_PX))
        .filter(|p| second.contains(p, 8.0))
        .filter_map(|p| {
            // Nearest approach of the two rays.
            let other = second.ray(&p);
            let c = ray.dot(&other);
            let b = second.center - center;
            let (s, t) = (
                b.dot(&ray) - c * b.dot(&other),
                c * b.dot(&ray) - b.dot(&other),
            );
            let sine2 = 1.0 - c * c;
            (sine2 > 1e-10 && s > 0.0 && t > 0.0).then(|| s / sine2)
        })
        .collect()
}

/// A 7 x 7 patch about an image point.
struct CorrelationPatch {
    x: Point2<f64>,
    values: Vec<f64>,
}

impl CorrelationPatch {
    fn reference(image: &Gray, x: &Point2<f64>) -> Option<Self> {
        let values = sample(image, x, &Matrix2::identity())?;
        (variance(&values) > 1e-4).then_some(Self { x: *x, values })
    }

    /// Correlation with another view, warped by the horizontal plane through `point`.
    fn correlation(
        &self,
        first: &Camera,
        second: &Camera,
        image: &Gray,
        point: &Point3<f64>,
    ) -> Option<f64> {
        let plane = Plane {
            normal: Vector3::z(),
            d: -point.z,
        };
        let h = homography_of_plane(first, second, &plane)?;
        let x = h.apply(&self.x)?;
        let values = sample(image, &x, &jacobian(&h.0, &self.x, &x))?;
        let n = values.len() as f64;
        let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
        let (ma, mb) = (mean(&self.values), mean(&values));
        let covariance: f64 = self
            .values
            .iter()
            .zip(&values)
            .map(|(a, b)| (a - ma) * (b - mb))
            .sum::<f64>()
            / n;
        let scale = (variance(&self.values) * (variance(&values) + 1e-5)).sqrt();
        Some(covariance / scale)
    }
}

fn variance(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n
}

/// Derivative of x' = H x at x, 2 x 2.
fn jacobian(h: &Matrix3<f64>, x: &Point2<f64>, y: &Point2<f64>) -> Matrix2<f64> {
    let w = h[(2, 0)] * x.x + h[(2, 1)] * x.y + h[(2, 2)];
    Matrix2::from_fn(|r, c| (h[(r, c)] - y[r] * h[(2, c)]) / w)
}

/// A row of a patch at a time; the eighth lane repeats the seventh.
fn sample(image: &Gray, x: &Point2<f64>, j: &Matrix2<f64>) -> Option<Vec<f64>> {
    let mut values = Vec::with_capacity(49);
    for row in -3..=3 {
        let places: [Point2<f64>; 8] = std::array::from_fn(|lane| {
            let column = lane.min(6) as f64 - 3.0;
            x + j * Vector2::new(column, f64::from(row)) * STRIDE_PX
        });
        let samples = image.sample_eight(places.map(|p| p.x as f32), places.map(|p| p.y as f32));
        if samples.is_nan().any() {
            return None;
        }
        values.extend(samples.to_array()[..7].iter().map(|v| f64::from(*v)));
    }
    Some(values)
}
