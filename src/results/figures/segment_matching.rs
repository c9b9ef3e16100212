//! One segment in matching (B99 3.1 and 3.2, figures 1, 2 and 4): where its line can
//! lie in the other views, which segments lie there, how they scored, and where third views should
//! show the line.

use nalgebra::{Point2, Point3};
use serde::Serialize;

use crate::base::geometry::Segment2;
use crate::base::ids::{SegmentId, ViewId};
use crate::lines::linematch::{MatchTrace, PairTrace, SegmentOutcome, SegmentRef, epipolar_beam};
use crate::lines::lines2d::ImageSegment;
use crate::orienting::scene::Scene;
use crate::photographs::camera::{Camera, plane_of_image_line};

/// The pair candidates of a segment and their outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SegmentMatching {
    /// Its outcome; `None` before matching.
    pub outcome: Option<SegmentOutcome>,
    /// Its beams in the other views.
    pub beams: Vec<Beam>,
    /// Segments of other views that it was paired with, the best score first.
    pub candidates: Vec<PairCandidate>,
}

/// The epipolar beam of a segment in another view.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Beam {
    /// The other view.
    pub view: ViewId,
    /// Corners, pixels: start at the lowest and highest height, end at the highest and lowest.
    pub corners: [Point2<f64>; 4],
}

/// A pair hypothesis as its first segment sees it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PairCandidate {
    /// The other view.
    pub view: ViewId,
    /// The segment in it.
    pub segment: SegmentId,
    /// Photometric score, 0 to 1.
    pub score: f32,
    /// The match that the pair became.
    pub line: Option<u32>,
    /// Where the line of the pair lies in third views, and which segments verify it there.
    pub predictions: Vec<ReprojectedLine>,
}

/// The line of a pair in a third view.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ReprojectedLine {
    /// The third view.
    pub view: ViewId,
    /// The reprojected line, as long as the first segment, pixels.
    pub segment: Segment2,
    /// The nearest verifying segment; `None` where the view has none.
    pub verified: Option<SegmentId>,
    /// Largest distance of that segment's ends from the reprojected line, pixels.
    pub distance_px: Option<f64>,
}

/// The matching of segment `of`. Without a height range in the trace there are no beams.
pub fn segment_matching(
    scene: &Scene,
    segments: &[Vec<ImageSegment>],
    trace: &MatchTrace,
    of: SegmentRef,
) -> Option<SegmentMatching> {
    let segment = &segment_of(segments, of)?.segment;
    let outcome = trace.outcomes.get(of.view.index());
    let candidates = trace
        .pairs
        .iter()
        .filter_map(|pair| candidate(scene, segments, pair, of));
    Some(SegmentMatching {
        outcome: outcome.and_then(|o| o.get(of.segment.index()).copied()),
        beams: trace.z_range_m.map_or(Vec::new(), |z_range| {
            beams(scene, segment, of.view, z_range)
        }),
        candidates: candidates.collect(),
    })
}

/// The segment of this name; `None` where there is no such view or segment.
pub(crate) fn segment_of(segments: &[Vec<ImageSegment>], of: SegmentRef) -> Option<&ImageSegment> {
    segments.get(of.view.index())?.get(of.segment.index())
}

fn beams(scene: &Scene, segment: &Segment2, view: ViewId, z_range: [f64; 2]) -> Vec<Beam> {
    let first = scene.camera(view);
    let others = scene.view_ids().filter(|&other| other != view);
    others
        .filter_map(|other| {
            let corners = epipolar_beam(first, segment, scene.camera(other), z_range)?;
            Some(Beam {
                view: other,
                corners,
            })
        })
        .collect()
}

fn candidate(
    scene: &Scene,
    segments: &[Vec<ImageSegment>],
    pair: &PairTrace,
    of: SegmentRef,
) -> Option<PairCandidate> {
    let other = match of {
        _ if pair.a == of => pair.b,
        _ if pair.b == of => pair.a,
        _ => return None,
    };
    let [first, second] = [of, other].map(|name| segment_of(segments, name).map(|s| &s.segment));
    let (first, second) = (first?, second?);
    let ends = ends_in_space(scene, of.view, first, other.view, second)?;
    let third = |&view: &ViewId| view != of.view && view != other.view;
    let predictions = scene
        .view_ids()
        .filter(third)
        .filter_map(|view| prediction(scene.camera(view), segments, pair, view, &ends));
    Some(PairCandidate {
        view: other.view,
        segment: other.segment,
        score: pair.score,
        line: pair.line,
        predictions: predictions.collect(),
    })
}

/// Where the rays of the first segment's ends meet the interpretation plane of the second.
fn ends_in_space(
    scene: &Scene,
    view: ViewId,
    segment: &Segment2,
    other: ViewId,
    candidate: &Segment2,
) -> Option<[Point3<f64>; 2]> {
    let plane = plane_of_image_line(scene.camera(other), &candidate.line())?;
    let camera = scene.camera(view);
    let meet = |x: &Point2<f64>| {
        let ray = camera.ray(x);
        let depth = -plane.signed_distance(&camera.center) / plane.normal.dot(&ray);
        (depth.is_finite() && depth > 0.0).then(|| camera.center + ray * depth)
    };
    Some([meet(&segment.p0)?, meet(&segment.p1)?])
}

fn prediction(
    camera: &Camera,
    segments: &[Vec<ImageSegment>],
    pair: &PairTrace,
    view: ViewId,
    ends: &[Point3<f64>; 2],
) -> Option<ReprojectedLine> {
    let segment = Segment2::new(camera.project(&ends[0])?, camera.project(&ends[1])?);
    let line = segment.line();
    let distance = |of: SegmentRef| {
        let s = &segment_of(segments, of)?.segment;
        let off = |p: &Point2<f64>| (line.x * p.x + line.y * p.y + line.z).abs();
        Some(off(&s.p0).max(off(&s.p1)))
    };
    let own = pair.verified.iter().filter(|v| v.segment.view == view);
    let nearest = own
        .filter_map(|v| Some((v.segment.segment, distance(v.segment)?)))
        .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    let shows = camera.contains(&segment.p0, 0.0) || camera.contains(&segment.p1, 0.0);
    (shows || nearest.is_some()).then_some(ReprojectedLine {
        view,
        segment,
        verified: nearest.map(|n| n.0),
        distance_px: nearest.map(|n| n.1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::params::{Lines3dParams, MatchParams, SegmentParams};
    use crate::lines::lines2d::detect_segments;
    use crate::orienting::synthetic::gable_scene;

    fn inputs() -> (Scene, Vec<Vec<ImageSegment>>, MatchTrace) {
        let (scene, _) = gable_scene(320);
        let params = SegmentParams::default();
        let segments: Vec<_> = scene
            .views
            .iter()
            .map(|v| detect_segments(&v.gray, None, &params).0)
            .collect();
        let (fitting, matching) = (Lines3dParams::default(), MatchParams::default());
        let (_, trace) =
            crate::lines::linematch::match_lines(&scene, &segments, &matching, &fitting).unwrap();
        (scene, segments, trace)
    }

    #[test]
    fn verified_segments_lie_on_the_reprojected_line() {
        let (scene, segments, trace) = inputs();
        let pair = trace
            .pairs
            .iter()
            .find(|p| p.line.is_some() && p.verified.len() >= 2)
            .expect("a gable has lines");
        for of in [pair.a, pair.b] {
            let matching = segment_matching(&scene, &segments, &trace, of).unwrap();
            assert!(matches!(
                matching.outcome,
                Some(SegmentOutcome::Matched { .. })
            ));
            assert_eq!(matching.beams.len(), scene.views.len() - 1);
            let candidate = matching.candidates.iter().find(|c| c.line == pair.line);
            let verified = || {
                candidate
                    .unwrap()
                    .predictions
                    .iter()
                    .flat_map(|p| p.distance_px)
            };
            assert!(verified().count() >= 1);
            assert!(
                verified().all(|d| d < 3.0),
                "{:?}",
                verified().collect::<Vec<_>>()
            );
        }
    }

    #[test]
    fn an_unknown_segment_has_no_matching() {
        let (scene, _) = gable_scene(64);
        let of = SegmentRef {
            view: ViewId(9),
            segment: SegmentId(0),
        };
        assert!(segment_matching(&scene, &[], &MatchTrace::default(), of).is_none());
    }
}
