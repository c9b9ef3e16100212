//! Colour edges are rejected where an edge in grey values runs along them.

use nalgebra::{Point2, Vector2};

use super::segment::ImageSegment;
use super::trace::{RejectedSegment, SegmentRejection, SegmentTrace};
use crate::base::geometry::Segment2;
use crate::base::line_linker::LineLinker;

/// Adds the candidates that no segment runs along; the others are recorded as rejected.
pub(super) fn add_without_overlap(
    segments: &mut Vec<ImageSegment>,
    candidates: Vec<ImageSegment>,
    clear_px: f64,
    trace: &mut SegmentTrace,
) {
    let boxes: Vec<Bounds> = segments.iter().map(|s| bounds(&s.segment)).collect();
    let (apart, beside): (Vec<_>, Vec<_>) =
        (candidates.into_iter()).partition(|c| is_apart(c, segments, &boxes, clear_px));
    segments.extend(apart);
    for candidate in beside {
        trace.reject(RejectedSegment {
            segment: candidate.segment,
            reason: SegmentRejection::BesideEdge,
        });
    }
}

/// Do the edges, which lie in these boxes, run along less than half of the candidate?
fn is_apart(
    candidate: &ImageSegment,
    edges: &[ImageSegment],
    boxes: &[Bounds],
    clear_px: f64,
) -> bool {
    let [low, high] = bounds(&candidate.segment);
    // A pixel more than the threshold against rounding; the boxes exclude most edges of the image.
    let reach = Vector2::repeat(clear_px + 1.0);
    let (low, high) = (low - reach, high + reach);
    let near =
        |b: &Bounds| b[1].x >= low.x && b[0].x <= high.x && b[1].y >= low.y && b[0].y <= high.y;
    let edges = edges.iter().zip(boxes).filter(|(_, b)| near(b));
    let (linker, own) = (LineLinker::blurred_edge(clear_px), candidate.segment.ends());
    let shared = edges.filter_map(|(edge, _)| linker.shared(&own, &edge.segment.ends()));
    shared.map(|[from, to]| to - from).sum::<f64>() <= 0.5 * candidate.segment.length()
}

/// Least and largest coordinates, px.
type Bounds = [Point2<f64>; 2];

fn bounds(segment: &Segment2) -> Bounds {
    [segment.p0.inf(&segment.p1), segment.p0.sup(&segment.p1)]
}
