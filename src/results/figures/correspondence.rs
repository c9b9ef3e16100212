//! Pointwise correspondence (B99 3.1, figure 3): the point x of a segment corresponds to `x' = l' x
//! (F x)`, where the epipolar line of x meets the candidate line l'. What matching compares there
//! are the windows about x and x'.
//!
//! Deviation: matching warps each side of the line by the best half-plane; here both windows are
//! related by the horizontal plane through the point in space, which is enough to see whether they
//! show the same thing.

use nalgebra::{Matrix3, Point2, Vector3};
use serde::Serialize;

use super::segment_matching::segment_of;
use crate::base::geometry::{Plane, Segment2};
use crate::lines::linematch::SegmentRef;
use crate::lines::lines2d::ImageSegment;
use crate::orienting::scene::Scene;
use crate::photographs::camera::{
    Camera, Homography, fundamental, homography_of_plane, plane_of_image_line,
};
use crate::photographs::raster::{Channel, Gray};

/// Side of the windows, pixels (B99 3.1: 15 x 15).
const WINDOW_PX: usize = 15;

/// A point of a segment and the point of the candidate that corresponds to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Correspondence {
    /// The point of the segment, pixels.
    pub x: Point2<f64>,
    /// The epipolar line F x in the other view, scaled so that `l . (x, y, 1)` is a distance in
    /// pixels.
    pub epipolar: Vector3<f64>,
    /// `x' = l' x (F x)`, pixels.
    pub other: Point2<f64>,
    /// The channel that shows the segment: what is compared.
    pub channel: Channel,
    /// Its values, 0 to 1, in the window about x, row by row.
    pub window: Vec<f32>,
    /// The same places in the other view; empty where it does not show them all.
    pub other_window: Vec<f32>,
    /// Their correlation, -1 to 1; `None` without a window.
    pub correlation: Option<f64>,
}

/// The correspondence at fraction `t` (0 start, 1 end) of segment `of` with segment `candidate` of
/// another view. `None` where the two lines have no common point there.
pub fn correspondence(
    scene: &Scene,
    segments: &[Vec<ImageSegment>],
    of: SegmentRef,
    candidate: SegmentRef,
    t: f64,
) -> Option<Correspondence> {
    let (first, second) = (scene.view(of.view), scene.view(candidate.view));
    let segment = segment_of(segments, of)?;
    let x = segment.segment.at(t);
    let other_line = &segment_of(segments, candidate)?.segment;
    let epipolar = epipolar_line(&first.camera, &second.camera, &x)?;
    let other = meet(other_line, &epipolar)?;
    let channel = segment.kind.channel();
    let [shown, other_shown] = [first, second].map(|view| view.channel(channel).0);
    let window = window_at(shown, &Homography(Matrix3::identity()), &x)?;
    let plane = level_plane(&first.camera, &x, &second.camera, other_line)?;
    let other_window = homography_of_plane(&first.camera, &second.camera, &plane)
        .and_then(|h| window_at(other_shown, &h, &x))
        .unwrap_or_default();
    Some(Correspondence {
        x,
        epipolar,
        other,
        channel,
        correlation: correlation(&window, &other_window),
        window,
        other_window,
    })
}

fn epipolar_line(first: &Camera, second: &Camera, x: &Point2<f64>) -> Option<Vector3<f64>> {
    let l = fundamental(first, second) * Vector3::new(x.x, x.y, 1.0);
    let norm = l.xy().norm();
    (norm > 1e-12).then(|| l / norm)
}

/// `l' x (F x)`.
fn meet(line: &Segment2, epipolar: &Vector3<f64>) -> Option<Point2<f64>> {
    let p = line.line().cross(epipolar);
    (p.z.abs() > 1e-9).then(|| Point2::new(p.x / p.z, p.y / p.z))
}

/// The horizontal plane through the point in space that both views see.
fn level_plane(
    first: &Camera,
    x: &Point2<f64>,
    second: &Camera,
    other: &Segment2,
) -> Option<Plane> {
    let interpretation_plane = plane_of_image_line(second, &other.line())?;
    let ray = first.ray(x);
    let depth = -interpretation_plane.signed_distance(&first.center)
        / interpretation_plane.normal.dot(&ray);
    let point = (depth.is_finite() && depth > 0.0).then(|| first.center + ray * depth)?;
    Plane::from_point_normal(&point, &Vector3::z())
}

/// The window about `x` as another view shows it under a homography; `None` where it is not all in
/// the image.
fn window_at(gray: &Gray, h: &Homography, x: &Point2<f64>) -> Option<Vec<f32>> {
    let half = (WINDOW_PX / 2) as f64;
    (0..WINDOW_PX * WINDOW_PX)
        .map(|i| {
            let (column, row) = ((i % WINDOW_PX) as f64, (i / WINDOW_PX) as f64);
            let at = h.apply(&Point2::new(x.x + column - half, x.y + row - half))?;
            gray.sample(at.x as f32, at.y as f32)
        })
        .collect()
}

/// Centred normalised cross-correlation.
fn correlation(a: &[f32], b: &[f32]) -> Option<f64> {
    if a.len() != b.len() || a.is_empty() {
        return None;
    }
    let n = a.len() as f64;
    let mean = |w: &[f32]| w.iter().map(|&v| f64::from(v)).sum::<f64>() / n;
    let (ma, mb) = (mean(a), mean(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (&u, &v) in a.iter().zip(b) {
        let (u, v) = (f64::from(u) - ma, f64::from(v) - mb);
        ab += u * v;
        aa += u * u;
        bb += v * v;
    }
    Some(ab / (aa * bb).max(1e-18).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::ids::SegmentId;
    use crate::base::ids::ViewId;
    use crate::lines::lines2d::SegmentKind;
    use crate::orienting::synthetic::gable_scene;
    use nalgebra::Matrix2;

    #[test]
    fn points_of_a_planted_edge_correspond() {
        let (scene, truth) = gable_scene(320);
        // The flat ground through the edge is not the roof: the test only requires a correlation.
        for edge in &truth.edges {
            let segments: Vec<Vec<ImageSegment>> = scene
                .views
                .iter()
                .map(|v| {
                    let ends = [edge.p0, edge.p1].map(|p| v.camera.project(&p).unwrap());
                    vec![ImageSegment {
                        kind: SegmentKind::Edge,
                        segment: Segment2::new(ends[0], ends[1]),
                        covariance: Matrix2::identity(),
                        contrast: 0.2,
                        edgels: 20,
                    }]
                })
                .collect();
            let named = |view| SegmentRef {
                view: ViewId(view),
                segment: SegmentId(0),
            };
            for other in [1, 3, 5] {
                let found = correspondence(&scene, &segments, named(0), named(other), 0.4);
                let Some(found) = found else { continue };
                // The point of the edge that the first view sees at x is the one that the second
                // sees at x'.
                let x = Vector3::new(found.other.x, found.other.y, 1.0);
                assert!(found.epipolar.dot(&x).abs() < 1e-6);
                let line = segments[other as usize][0].segment.line();
                assert!(line.dot(&x).abs() < 1e-6);
                assert!(found.correlation.is_none_or(|c| c.abs() <= 1.0 + 1e-9));
            }
        }
    }

    #[test]
    fn a_segment_in_colour_is_compared_in_colour() {
        let (scene, truth) = gable_scene(320);
        let edge = truth.edges[0];
        let shown = |kind| -> Vec<Vec<ImageSegment>> {
            let in_view = |v: &crate::orienting::scene::View| {
                let ends = [edge.p0, edge.p1].map(|p| v.camera.project(&p).unwrap());
                vec![ImageSegment {
                    kind,
                    segment: Segment2::new(ends[0], ends[1]),
                    covariance: Matrix2::identity(),
                    contrast: 0.2,
                    edgels: 20,
                }]
            };
            scene.views.iter().map(in_view).collect()
        };
        let first = SegmentRef {
            view: ViewId(0),
            segment: SegmentId(0),
        };
        let second = SegmentRef {
            view: ViewId(1),
            ..first
        };
        let windows = [SegmentKind::Edge, SegmentKind::Color].map(|kind| {
            let found = correspondence(&scene, &shown(kind), first, second, 0.4).unwrap();
            assert_eq!(found.channel, kind.channel());
            found.window
        });
        assert_ne!(windows[0], windows[1]);
    }

    #[test]
    fn equal_windows_correlate_inverted_ones_contradict() {
        let a: Vec<f32> = (0..225).map(|i| ((i * 37) % 101) as f32 / 101.0).collect();
        let b: Vec<f32> = a.iter().map(|v| 1.0 - 0.5 * v).collect();
        assert!((correlation(&a, &a).unwrap() - 1.0).abs() < 1e-9);
        assert!((correlation(&a, &b).unwrap() + 1.0).abs() < 1e-6);
        assert_eq!(correlation(&a, &[]), None);
    }
}
