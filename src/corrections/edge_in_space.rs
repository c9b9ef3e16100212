//! An edge that somebody marks in one photograph, found in space along the beams of its ends.
//!
//! Every pair of heights of the two ends is a line in space; of these the one is taken along whose
//! images the grey values step most in the other views, and as in the photograph (B99 3.2: a
//! hypothesis is judged by the views that did not make it). All heights are tried, first coarsely,
//! then around the best.

use nalgebra::{Point2, Point3};

use crate::geometry::{Segment2, Segment3};
use crate::ids::ViewId;
use crate::scene::{Scene, View};

/// Heights along each beam.
const STEPS: usize = 90;
/// Finer searches around the best heights, each by this factor.
const FINER: [f64; 3] = [0.4, 0.15, 0.05];
/// Samples along an image of the edge.
const SAMPLES: usize = 24;
/// Grey values are compared this far to both sides of the edge, px.
const ACROSS_PX: f64 = 1.5;
/// Other views that must show a step there.
const LEAST_VIEWS: usize = 2;
/// A view shows it if it has at least this share of the step in the photograph.
const LEAST_SHARE: f64 = 0.25;

/// The edge in space between two places of a view, pixels, within a range of heights, metres; `None`
/// where too few other views show one.
pub fn edge_in_space(
    scene: &Scene,
    view: ViewId,
    ends: [Point2<f64>; 2],
    heights_m: [f64; 2],
) -> Option<Segment3> {
    let marked = scene.view(view);
    let step = step_across(marked, &Segment2::new(ends[0], ends[1]))?;
    let others: Vec<&View> = scene
        .view_ids()
        .filter(|&v| v != view)
        .map(|v| scene.view(v))
        .collect();
    let line = |z: [f64; 2]| {
        let [p, q] = [0, 1].map(|i| marked.camera.at_height(&ends[i], z[i]));
        Some(Segment3::new(p?, q?))
    };
    let shown = |z: [f64; 2]| -> (f64, usize) {
        let Some(edge) = line(z) else {
            return (0.0, 0);
        };
        let shares = others.iter().filter_map(|v| {
            let image = image_of(v, &edge)?;
            // More of a step than in the photograph is another edge.
            Some((step_across(v, &image)? / step).clamp(-1.0, 1.0))
        });
        shares.fold((0.0, 0), |(sum, views), share| {
            (sum + share, views + usize::from(share >= LEAST_SHARE))
        })
    };
    let [low, high] = heights_m;
    let coarse = (high - low) / STEPS as f64;
    let mut best = (f64::NEG_INFINITY, [low; 2]);
    let mut attempt = |z: [f64; 2]| {
        let (sum, _) = shown(z);
        if sum > best.0 {
            best = (sum, z);
        }
        best.1
    };
    for i in 0..=STEPS {
        for j in 0..=STEPS {
            attempt([i, j].map(|k| low + coarse * k as f64));
        }
    }
    let mut middle = attempt([low; 2]);
    for finer in FINER {
        let around = middle;
        for i in -3i32..=3 {
            for j in -3i32..=3 {
                let by = [i, j].map(|k| f64::from(k) * coarse * finer);
                middle = attempt([around[0] + by[0], around[1] + by[1]]);
            }
        }
    }
    let (_, views) = shown(middle);
    (views >= LEAST_VIEWS).then(|| line(middle)).flatten()
}

/// The image of an edge, where all of it is in the view.
fn image_of(view: &View, edge: &Segment3) -> Option<Segment2> {
    let end = |p: &Point3<f64>| {
        let image = view.camera.project(p)?;
        view.camera.contains(&image, 2.0 * ACROSS_PX).then_some(image)
    };
    Some(Segment2::new(end(&edge.p0)?, end(&edge.p1)?))
}

/// By how much grey values to the right of a segment are larger than to the left, on average.
fn step_across(view: &View, segment: &Segment2) -> Option<f64> {
    let across = segment.normal() * ACROSS_PX;
    let grey = |p: Point2<f64>| view.gray.sample(p.x as f32, p.y as f32).map(f64::from);
    let mut sum = 0.0;
    for k in 0..SAMPLES {
        let p = segment.at((k as f64 + 0.5) / SAMPLES as f64);
        sum += grey(p + across)? - grey(p - across)?;
    }
    Some(sum / SAMPLES as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::gable_scene;

    #[test]
    fn edges_marked_in_one_photograph_are_found_in_space() {
        let (scene, truth) = gable_scene(320);
        let mut found = 0;
        for edge in &truth.edges {
            let view = scene.view(ViewId(0));
            let Some(image) = image_of(view, edge) else {
                continue;
            };
            let heights = [truth.ground_z, truth.ground_z + 15.0];
            let marked = edge_in_space(&scene, ViewId(0), [image.p0, image.p1], heights);
            let off = marked.map(|m| (m.p0 - edge.p0).norm().max((m.p1 - edge.p1).norm()));
            found += usize::from(off.is_some_and(|off| off < 0.35));
        }
        // One along the flight line may be given up, or found elsewhere on its beam.
        assert!(found + 2 >= truth.edges.len(), "{found} of {}", truth.edges.len());
    }

    #[test]
    fn where_no_view_shows_an_edge_none_is_found() {
        let (scene, truth) = gable_scene(320);
        let ends = [Point2::new(8.0, 8.0), Point2::new(8.0, 60.0)];
        let heights = [truth.ground_z + 200.0, truth.ground_z + 215.0];
        assert_eq!(edge_in_space(&scene, ViewId(0), ends, heights), None);
    }
}
