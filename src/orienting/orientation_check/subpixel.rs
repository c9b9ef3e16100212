//! Offsets of a fraction of a pixel: correspondences are measured in the images at full resolution,
//! and their distances from the epipolar lines compared with and without half a pixel.
//!
//! Views of one strip shift together, which hides such an offset; strips flown in opposite
//! directions show it twice.

use nalgebra::{Point2, Vector3};

use super::epipolar::{ReducedView, best_match, refined_match};
use super::epipolar_check::{EpipolarCheck, mean_axis};
use super::error_hypothesis::ErrorHypothesis;
use super::view::CheckedView;
use crate::base::execution::parallel;
use crate::base::math;
use crate::photographs::camera::{Camera, fundamental};

/// Least mean offset that is reported, pixels. Orientations from structure from motion reach 0.2.
const MIN_OFFSET_PX: f64 = 0.25;

/// Largest share of the offset that may remain.
const MAX_REMAINING_SHARE: f64 = 0.5;

/// Fewest correspondences of a pair of views, or of one that is moved, for a median.
pub(super) const MIN_MATCHES: usize = 12;

/// A point that is matched in a pair of views, pixels.
pub(crate) struct PointMatch {
    /// Number of the interest point in the first view.
    pub point: usize,
    /// Its position in the first view: x.
    pub first: Point2<f64>,
    /// Its position in the second view: x'.
    pub second: Point2<f64>,
}

/// Half a pixel, if adding it to the principal points removes most of the offsets; mean offsets
/// before and after, pixels.
pub(crate) fn half_pixel_offset(
    check: &EpipolarCheck,
    views: &[CheckedView],
    stated: &[Camera],
    matches: &[Vec<PointMatch>],
) -> Option<(ErrorHypothesis, [f64; 2])> {
    let before = mean_offset_px(check, matches, stated)?;
    if before < MIN_OFFSET_PX {
        return None;
    }
    let tested = [0.5, -0.5]
        .map(ErrorHypothesis::HalfPixelOrigin)
        .into_iter();
    let after = tested.filter_map(|hypothesis| {
        let cameras = hypothesis.corrected_cameras(views)?;
        Some((hypothesis, mean_offset_px(check, matches, &cameras)?))
    });
    let (hypothesis, after) = after.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (after < MAX_REMAINING_SHARE * before).then_some((hypothesis, [before, after]))
}

/// Matches of each pair of views, measured in the images at full resolution.
pub(crate) fn matches(
    check: &EpipolarCheck,
    views: &[CheckedView],
    cameras: &[Camera],
) -> Vec<Vec<PointMatch>> {
    let reduced = check.reduced(cameras);
    let whole: Vec<ReducedView> = (cameras.iter().zip(views))
        .map(|(camera, view)| ReducedView {
            camera: camera.clone(),
            gray: view.gray,
        })
        .collect();
    let axis = mean_axis(cameras);
    parallel::map(&check.pairs, |_, &(i, j)| {
        let scale = [i, j].map(|v| check.factors[v] as f64);
        let measure = |(point, x): (usize, &Point2<f64>)| {
            let found = best_match(&reduced[i], &reduced[j], &axis, x)?;
            if found.shift.abs() > 1 {
                return None;
            }
            let (x, near) = (x * scale[0], found.at * scale[1]);
            let y = refined_match(&whole[i], &whole[j], &axis, &x, &near, scale[1] + 3.0)?;
            Some(PointMatch {
                point,
                first: x,
                second: y,
            })
        };
        check.points[i]
            .iter()
            .enumerate()
            .filter_map(measure)
            .collect()
    })
}

/// Mean over the pairs of views of the absolute median offset across the epipolar lines, pixels.
fn mean_offset_px(
    check: &EpipolarCheck,
    matches: &[Vec<PointMatch>],
    cameras: &[Camera],
) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for (&(i, j), matches) in check.pairs.iter().zip(matches) {
        if matches.len() < MIN_MATCHES {
            continue;
        }
        let f = fundamental(&cameras[i], &cameras[j]);
        let mut offsets: Vec<f64> = matches
            .iter()
            .map(
                |PointMatch {
                     first: x,
                     second: y,
                     ..
                 }| {
                    let l = f * Vector3::new(x.x, x.y, 1.0);
                    l.dot(&Vector3::new(y.x, y.y, 1.0)) / l.xy().norm()
                },
            )
            .collect();
        sum += math::median(&mut offsets)?.abs();
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}
