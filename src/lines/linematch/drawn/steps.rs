//! The steps of grey values or colours that views show along lines which may be edges.
//!
//! A step is compared with the steps along all candidates in the same view: the null is measured at
//! the place itself. With Cauchy's density about it, views in which some other edge is crossed by
//! chance decide nothing alone:
//!
//! ```text
//! score(line) = sum over views of ln(1 + (step(line) / median |step|)^2)
//! ```

use nalgebra::{Point2, Point3};

use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::ViewId;
use crate::base::least_squares::Loss;
use crate::base::math::median;
use crate::lines::linematch::nview::EDGE_MARGIN_PX;
use crate::orienting::scene::Scene;
use crate::photographs::raster::{Channel, Gray};

/// Grey values, and red less blue.
pub(super) const CHANNELS: [Channel; 2] = [Channel::Grey, Channel::RedBlue];
/// Places along a line where the step is sampled.
const PLACES: usize = 24;

/// How much likelier each of some lines is an edge than not by what these views show along it,
/// nats, but for what is common to all; 0 for what is no line. The lines are candidates for one
/// edge, most of them wrong.
pub(crate) fn shown_along(scene: &Scene, views: &[ViewId], lines: &[Option<Segment3>]) -> Vec<f64> {
    let shown = crate::base::execution::map(views, |_, &view| {
        let seen = scene.view(view);
        let inside = |p: &Point3<f64>| {
            let x = seen.camera.project(p)?;
            seen.camera.contains(&x, EDGE_MARGIN_PX).then_some(x)
        };
        let images: Vec<Option<[Point2<f64>; 2]>> = (lines.iter())
            .map(|line| line.and_then(|l| Some([inside(&l.p0)?, inside(&l.p1)?])))
            .collect();
        let mut scores = vec![0.0f64; lines.len()];
        for channel in CHANNELS {
            if channel == Channel::RedBlue && seen.red_blue.is_none() {
                continue;
            }
            let (image, noise) = seen.channel(channel);
            // Where most of an image is even, any step would stand out.
            let chance = noise / (2.0 * PLACES as f64).sqrt();
            let step = |[p, q]: &[Point2<f64>; 2]| step_across(image, p, q).map(f32::abs);
            let steps: Vec<Option<f64>> = (images.iter())
                .map(|ends| ends.as_ref().and_then(step).map(f64::from))
                .collect();
            let mut all: Vec<f64> = steps.iter().flatten().copied().collect();
            let typical = median(&mut all)
                .unwrap_or(0.0)
                .max(chance)
                .max(f64::MIN_POSITIVE);
            for (score, step) in scores.iter_mut().zip(steps) {
                let ratio = step.unwrap_or(0.0) / typical;
                *score = score.max(Loss::Cauchy(1.0).cost(ratio * ratio));
            }
        }
        scores
    });
    (0..lines.len())
        .map(|k| shown.iter().map(|scores| scores[k]).sum())
        .collect()
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
