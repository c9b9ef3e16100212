//! An edge that somebody marks in one photograph, found in space along the beams of its ends.
//!
//! Every pair of heights of the two ends is a line in space. Of these the one is taken along which
//! the other views look most like the photograph: on the side that agrees better (what lies beyond
//! an eave is another thing in every view), and by the step across the edge (B99 3.1: correlation
//! along the line, on either side of it). All heights are tried, first coarsely, then around the
//! best.

use nalgebra::{Point2, Point3};

use crate::geometry::{Segment2, Segment3};
use crate::ids::ViewId;
use crate::model::RoofModel;
use crate::scene::{Scene, View};

/// Heights along each beam.
const STEPS: usize = 90;
/// An edge rises by no more than this, metres per metre of its length along the level: what two
/// heights make steeper is no edge of a roof.
const STEEPEST: f64 = 2.0;
/// Finer searches around the best heights, each by this factor.
const FINER: [f64; 3] = [0.4, 0.15, 0.05];
/// Samples along an image of the edge.
const SAMPLES: usize = 48;
/// Grey values are averaged over these distances from the edge, px.
const ACROSS_PX: [f64; 2] = [1.0, 2.5];
/// Other views that must look alike.
const LEAST_VIEWS: usize = 2;
/// Views look alike along an edge if they agree by so much, of 1.
const LEAST_AGREEMENT: f64 = 0.7;

/// Roofs are looked for up to this far above those of the model, metres.
const ABOVE_M: f64 = 5.0;

/// The edge in space whose ends a view shows where it shows these two points; `None` where too few
/// other views show one, or there is no model that says how high roofs are.
pub fn edge_in_space(
    scene: &Scene,
    model: &RoofModel,
    view: ViewId,
    points: [Point3<f64>; 2],
) -> Option<Segment3> {
    let camera = &scene.views.get(view.index())?.camera;
    let [p, q] = points.map(|p| camera.project(&p));
    let low = model
        .buildings
        .iter()
        .map(|b| b.ground_z)
        .reduce(f64::min)?;
    let corners = model.facets.iter().flat_map(|f| &f.outer);
    let high = corners.map(|p| p.z).reduce(f64::max)?;
    edge_between(scene, view, [p?, q?], [low, high + ABOVE_M])
}

/// The edge in space between two places of a view, pixels, within a range of heights, metres.
fn edge_between(
    scene: &Scene,
    view: ViewId,
    ends: [Point2<f64>; 2],
    heights_m: [f64; 2],
) -> Option<Segment3> {
    let marked = scene.view(view);
    let own = Strips::along(marked, &Segment2::new(ends[0], ends[1]))?;
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
        let is_edge = |e: &Segment3| {
            let by = e.p1 - e.p0;
            by.z.abs() <= STEEPEST * by.xy().norm()
        };
        let Some(edge) = line(z).filter(is_edge) else {
            return (0.0, 0);
        };
        let agreements = others.iter().filter_map(|v| {
            let strips = Strips::along(v, &image_of(v, &edge)?)?;
            Some(own.agreement(&strips))
        });
        agreements.fold((0.0, 0), |(sum, views), agreement| {
            (
                sum + agreement,
                views + usize::from(agreement >= LEAST_AGREEMENT),
            )
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
        let margin_px = 2.0 * ACROSS_PX[ACROSS_PX.len() - 1];
        view.camera.contains(&image, margin_px).then_some(image)
    };
    Some(Segment2::new(end(&edge.p0)?, end(&edge.p1)?))
}

/// Grey values beside a segment, to its left and to its right, each less their mean.
struct Strips {
    sides: [[f64; SAMPLES]; 2],
    /// By how much the right side is brighter than the left one.
    step: f64,
}

impl Strips {
    fn along(view: &View, segment: &Segment2) -> Option<Self> {
        let normal = segment.normal();
        let mut sides = [[0.0; SAMPLES]; 2];
        for k in 0..SAMPLES {
            let p = segment.at((k as f64 + 0.5) / SAMPLES as f64);
            for (side, sign) in sides.iter_mut().zip([-1.0, 1.0]) {
                for across in ACROSS_PX {
                    let q = p + normal * (sign * across);
                    side[k] += f64::from(view.gray.sample(q.x as f32, q.y as f32)?);
                }
            }
        }
        let means = sides.map(|side| side.iter().sum::<f64>() / SAMPLES as f64);
        for (side, mean) in sides.iter_mut().zip(means) {
            side.iter_mut().for_each(|grey| *grey -= mean);
        }
        let step = means[1] - means[0];
        Some(Self { sides, step })
    }

    /// How much two views look alike, up to 1: three quarters by the correlation on the better
    /// side, the rest by the step.
    fn agreement(&self, other: &Self) -> f64 {
        let correlation = |side: usize| {
            let (a, b) = (&self.sides[side], &other.sides[side]);
            let product = |a: &[f64; SAMPLES], b: &[f64; SAMPLES]| -> f64 {
                a.iter().zip(b).map(|(a, b)| a * b).sum()
            };
            let norm = (product(a, a) * product(b, b)).sqrt();
            product(a, b) / norm.max(f64::MIN_POSITIVE)
        };
        let step = (other.step * self.step.signum() / self.step.abs().max(1e-6)).clamp(-1.0, 1.0);
        0.75 * correlation(0).max(correlation(1)) + 0.25 * step
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::gable_scene;

    #[test]
    fn edges_marked_in_one_photograph_are_found_in_space() {
        let (scene, truth) = gable_scene(320);
        let mut found = 0;
        for edge in &truth.edges[..4] {
            let view = scene.view(ViewId(0));
            let Some(image) = image_of(view, edge) else {
                continue;
            };
            let heights = [truth.ground_z, truth.ground_z + 15.0];
            let marked = edge_between(&scene, ViewId(0), [image.p0, image.p1], heights);
            let off = marked.map(|m| (m.p0 - edge.p0).norm().max((m.p1 - edge.p1).norm()));
            found += usize::from(off.is_some_and(|off| off < 0.35));
        }
        // One along the flight line may be given up, or found elsewhere on its beam.
        assert!(
            found + 2 >= truth.edges.len(),
            "{found} of {}",
            truth.edges.len()
        );
    }

    #[test]
    fn where_no_view_shows_an_edge_none_is_found() {
        let (scene, truth) = gable_scene(160);
        let ends = [Point2::new(8.0, 8.0), Point2::new(8.0, 60.0)];
        let heights = [truth.ground_z + 200.0, truth.ground_z + 215.0];
        assert_eq!(edge_between(&scene, ViewId(0), ends, heights), None);
    }
}
