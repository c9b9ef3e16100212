//! The epipolar beam of a drawn edge: both ends swept by their heights, and what the other views
//! show along the line between.

use nalgebra::{Point2, Point3};

use super::steps::shown_along;
use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::ViewId;
use crate::base::math::sin_cos;
use crate::orienting::scene::Scene;

/// Step of a height, as the parallax of the view that shows most of it, px. Assumption: measuring
/// along a candidate reaches as far (`lines2d::guided`).
const HEIGHT_STEP_PX: f64 = 1.25;
/// Most heights of an end: the square of them is looked at.
const MOST_HEIGHTS: usize = 160;
/// Candidates that are fitted. Assumption: so many edges run side by side on a roof and about it.
const CANDIDATES_FITTED: usize = 16;
/// Candidates this many heights from a better one are the same. Assumption: a peak of the score is
/// as wide as the places from which one edge is found.
const NEIGHBOUR_HEIGHTS: usize = 2;

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
    let lines: Vec<Option<Segment3>> = (0..pairs).map(line).collect();
    let total = shown_along(scene, &others, &lines);
    let mut order: Vec<usize> = (0..pairs).filter(|&k| total[k] > 0.0).collect();
    order.sort_by(|&i, &j| total[j].total_cmp(&total[i]).then(i.cmp(&j)));
    let mut chosen: Vec<usize> = Vec::new();
    for k in order {
        let is_same = |&c: &usize| {
            (c / count).abs_diff(k / count) <= NEIGHBOUR_HEIGHTS
                && (c % count).abs_diff(k % count) <= NEIGHBOUR_HEIGHTS
        };
        if !chosen.iter().any(is_same) {
            chosen.push(k);
        }
        if chosen.len() == CANDIDATES_FITTED {
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
    ((most / HEIGHT_STEP_PX).ceil() as usize + 1).clamp(2, MOST_HEIGHTS)
}
