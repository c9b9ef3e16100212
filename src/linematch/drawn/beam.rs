//! The epipolar beam of a drawn edge: both ends swept by their heights, and what the other views
//! show along the line between.
//!
//! A step is compared with the steps along all lines of the beam in the same view: the null is
//! measured at the place itself. With Cauchy's density about it, views in which some other edge is
//! crossed by chance decide nothing alone:
//!
//! ```text
//! score(i, j) = sum over views of ln(1 + (step(i, j) / median |step|)^2)
//! ```

use nalgebra::{Point2, Point3};

use crate::geometry::{Segment2, Segment3};
use crate::ids::ViewId;
use crate::linematch::nview::EDGE_MARGIN_PX;
use crate::math::{ln, median, sin_cos};
use crate::raster::{Channel, Gray};
use crate::scene::Scene;

/// Grey values, and red less blue.
pub(super) const CHANNELS: [Channel; 2] = [Channel::Grey, Channel::RedBlue];
/// Step of a height, as the parallax of the view that shows most of it, px. Assumption: measuring
/// along a candidate reaches as far (`lines2d::guided`).
const STEP_PX: f64 = 1.25;
/// Most heights of an end: the square of them is looked at.
const MOST_HEIGHTS: usize = 160;
/// Places along a line where the step is sampled.
const PLACES: usize = 24;
/// Candidates that are fitted. Assumption: so many edges run side by side on a roof and about it.
const MOST: usize = 16;
/// Candidates this many heights from a better one are the same.
const SAME: usize = 2;

/// The likeliest lines of the beam, the best one first.
pub(super) fn candidates(
    scene: &Scene,
    view: ViewId,
    drawn: &Segment2,
    z_range: [f64; 2],
    max_slope_deg: f64,
) -> Vec<Segment3> {
    let camera = scene.camera(view);
    let others: Vec<ViewId> = scene.view_ids().filter(|v| *v != view).collect();
    let count = heights(scene, view, &drawn.midpoint(), z_range);
    let height = |i: usize| z_range[0] + (z_range[1] - z_range[0]) * i as f64 / (count - 1) as f64;
    let ends = [drawn.p0, drawn.p1].map(|x| -> Vec<Option<Point3<f64>>> {
        (0..count)
            .map(|i| camera.at_height(&x, height(i)))
            .collect()
    });
    let steepest = sin_cos(max_slope_deg.to_radians()).0;
    let line = |k: usize| {
        let line = Segment3::new(ends[0][k / count]?, ends[1][k % count]?);
        (line.direction().z.abs() <= steepest).then_some(line)
    };
    let pairs = count * count;
    let shown = crate::execution::map(&others, |_, &other| {
        let seen = scene.view(other);
        let inside = |p: &Option<Point3<f64>>| {
            let x = seen.camera.project(p.as_ref()?)?;
            seen.camera.contains(&x, EDGE_MARGIN_PX).then_some(x)
        };
        let images = ends
            .each_ref()
            .map(|end| -> Vec<Option<Point2<f64>>> { end.iter().map(inside).collect() });
        let mut scores = vec![0.0f64; pairs];
        for channel in CHANNELS {
            if channel == Channel::RedBlue && seen.red_blue.is_none() {
                continue;
            }
            let (image, noise) = seen.channel(channel);
            // Where most of an image is even, any step would stand out.
            let chance = noise / (2.0 * PLACES as f64).sqrt();
            let steps: Vec<Option<f64>> = (0..pairs)
                .map(|k| {
                    line(k)?;
                    let step = step_across(image, &images[0][k / count]?, &images[1][k % count]?)?;
                    Some(f64::from(step.abs()))
                })
                .collect();
            let mut all: Vec<f64> = steps.iter().flatten().copied().collect();
            let typical = median(&mut all)
                .unwrap_or(0.0)
                .max(chance)
                .max(f64::MIN_POSITIVE);
            for (score, step) in scores.iter_mut().zip(steps) {
                let ratio = step.unwrap_or(0.0) / typical;
                *score = score.max(ln(1.0 + ratio * ratio));
            }
        }
        scores
    });
    let total: Vec<f64> = (0..pairs)
        .map(|k| shown.iter().map(|scores| scores[k]).sum())
        .collect();
    let mut order: Vec<usize> = (0..pairs).filter(|&k| total[k] > 0.0).collect();
    order.sort_by(|&i, &j| total[j].total_cmp(&total[i]).then(i.cmp(&j)));
    let mut chosen: Vec<usize> = Vec::new();
    for k in order {
        let is_same = |&c: &usize| {
            (c / count).abs_diff(k / count) <= SAME && (c % count).abs_diff(k % count) <= SAME
        };
        if !chosen.iter().any(is_same) {
            chosen.push(k);
        }
        if chosen.len() == MOST {
            break;
        }
    }
    chosen.into_iter().filter_map(line).collect()
}

/// How many heights an end is swept by.
fn heights(scene: &Scene, view: ViewId, place: &Point2<f64>, z_range: [f64; 2]) -> usize {
    let ends = z_range.map(|z| scene.camera(view).at_height(place, z));
    let parallax = |other: ViewId| {
        let images = ends.map(|p| scene.camera(other).project(&p?));
        Some((images[1]? - images[0]?).norm())
    };
    let most = (scene.view_ids()).filter_map(parallax).fold(0.0, f64::max);
    ((most / STEP_PX).ceil() as usize + 1).clamp(2, MOST_HEIGHTS)
}

/// Mean step of grey values across a line in an image, from its left to its right, over four
/// pixels; `None` where it leaves the image.
pub(super) fn step_across(image: &Gray, p: &Point2<f64>, q: &Point2<f64>) -> Option<f32> {
    let line = Segment2::new(*p, *q);
    let normal = line.normal();
    let mut sum = 0.0;
    for k in 0..PLACES {
        let at = line.at((k as f64 + 0.5) / PLACES as f64);
        for across in [1.0, 2.0] {
            let [right, left] = [across, -across].map(|by| at + normal * by);
            let value = |x: Point2<f64>| image.sample(x.x as f32, x.y as f32);
            sum += value(right)? - value(left)?;
        }
    }
    Some(sum / (2 * PLACES) as f32)
}
