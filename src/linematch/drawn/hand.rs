//! What a hand draws, moved to the edge that the view shows there.

use nalgebra::{Matrix2, Point2};

use super::super::nview::most_of_edge;
use super::beam::{CHANNELS, step_across};
use crate::geometry::Segment2;
use crate::ids::ViewId;
use crate::lines2d::{GuidedEdge, SegmentKind};
use crate::math::exp;
use crate::scene::View;

/// Standard deviation of a click across an edge, px. Assumption: a hand hits two pixels of a
/// photograph that is shown at about its own size.
pub(super) const HAND_PX: f64 = 2.0;
/// Moves that are tried at either end, px: two standard deviations.
const MOVES_PX: [f64; 9] = [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0];

/// The edge of a view that was meant by a drawn one; that itself, as well as a hand knows it,
/// where the view shows none.
pub(super) fn own_edge(view: ViewId, seen: &View, drawn: &Segment2) -> GuidedEdge {
    let near = strongest_near(seen, drawn);
    most_of_edge(view, seen, &near).unwrap_or_else(|| {
        let (square, length) = (HAND_PX * HAND_PX, drawn.length());
        GuidedEdge {
            view,
            kind: SegmentKind::Edge,
            segment: *drawn,
            covariance: Matrix2::new(0.5 * square, 0.0, 0.0, 2.0 * square / (length * length)),
            pieces: vec![*drawn],
        }
    })
}

/// The line through `edge`, between the places nearest to the ends of another segment.
pub(super) fn between(edge: &Segment2, ends: &Segment2) -> Segment2 {
    let along = edge.direction();
    let foot = |p: &Point2<f64>| edge.p0 + along * along.dot(&(p - edge.p0));
    Segment2::new(foot(&ends.p0), foot(&ends.p1))
}

/// The strongest step near a drawn edge, in standard deviations of the noise and less where it is
/// farther than a hand misses.
fn strongest_near(seen: &View, drawn: &Segment2) -> Segment2 {
    let normal = drawn.normal();
    let moved =
        |from: f64, to: f64| Segment2::new(drawn.p0 + normal * from, drawn.p1 + normal * to);
    let mut best = (0.0, *drawn);
    for from in MOVES_PX {
        for to in MOVES_PX {
            let at = moved(from, to);
            let missed = (from * from + to * to) / (2.0 * HAND_PX * HAND_PX);
            let steps = CHANNELS.map(|channel| {
                let (image, noise) = seen.channel(channel);
                step_across(image, &at.p0, &at.p1).map_or(0.0, |s| f64::from(s).abs() / noise)
            });
            let strength = steps[0].max(steps[1]) * exp(-missed);
            if strength > best.0 {
                best = (strength, at);
            }
        }
    }
    best.1
}
