//! What a hand draws, moved to the edge that the view shows there.

use nalgebra::{Matrix2, Point2};

use super::super::nview::most_of_edge;
use super::steps::{CHANNELS, step_across};
use crate::base::geometry::{Plane, Segment2, Segment3};
use crate::base::ids::ViewId;
use crate::base::math::exp;
use crate::lines::lines2d::{GuidedEdge, SegmentKind};
use crate::orienting::scene::{Scene, View};
use crate::photographs::camera::Camera;

/// An edge as a hand draws it in a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnEdge {
    /// The view.
    pub view: ViewId,
    /// Between its ends, pixels.
    pub segment: Segment2,
    /// Standard deviation of the ends across the edge, pixels.
    pub sigma_px: f64,
}

impl DrawnEdge {
    /// It on a plane, where the view shows it, or else where it is drawn; `None` where its rays do
    /// not meet the plane.
    pub fn on_plane(&self, scene: &Scene, plane: &Plane) -> Option<Segment3> {
        let own = own_edge(scene.view(self.view), self);
        let snapped = between(&own.segment, &self.segment);
        on_plane(scene.camera(self.view), &snapped, plane)
    }
}

/// An edge of an image on a plane.
pub(super) fn on_plane(camera: &Camera, edge: &Segment2, plane: &Plane) -> Option<Segment3> {
    let at = |x: &Point2<f64>| {
        let ray = camera.ray(x);
        let t = -plane.signed_distance(&camera.center) / plane.normal.dot(&ray);
        (t.is_finite() && t > 0.0).then(|| camera.center + ray * t)
    };
    Some(Segment3::new(at(&edge.p0)?, at(&edge.p1)?))
}

/// Either end is moved by up to so many standard deviations of the hand.
const REACH_SIGMAS: f64 = 2.0;
/// Step of a move, px: half of what the step across a line is measured over on either side.
const MOVE_STEP_PX: f64 = 1.0;
/// Most moves to either side: the square of all is tried.
const MOST_MOVES: f64 = 40.0;

/// The edge of a view that was meant by a drawn one; that itself, as well as a hand knows it,
/// where the view shows none.
pub(super) fn own_edge(seen: &View, drawn: &DrawnEdge) -> GuidedEdge {
    let DrawnEdge {
        view,
        segment,
        sigma_px,
    } = *drawn;
    let near = strongest_near(seen, drawn);
    most_of_edge(view, seen, &near).unwrap_or_else(|| {
        let (square, length) = (sigma_px * sigma_px, segment.length());
        GuidedEdge {
            view,
            kind: SegmentKind::Edge,
            segment,
            covariance: Matrix2::new(0.5 * square, 0.0, 0.0, 2.0 * square / (length * length)),
            pieces: vec![segment],
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
fn strongest_near(seen: &View, drawn: &DrawnEdge) -> Segment2 {
    let (segment, normal) = (drawn.segment, drawn.segment.normal());
    let moved =
        |from: f64, to: f64| Segment2::new(segment.p0 + normal * from, segment.p1 + normal * to);
    let mut best = (0.0, segment);
    for from in moves(drawn.sigma_px) {
        for to in moves(drawn.sigma_px) {
            let at = moved(from, to);
            let missed = (from * from + to * to) / (2.0 * drawn.sigma_px * drawn.sigma_px);
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

/// The moves of an end that are tried, px.
fn moves(sigma_px: f64) -> impl Iterator<Item = f64> {
    let reach = REACH_SIGMAS * sigma_px;
    let each_side = (reach / MOVE_STEP_PX).ceil().clamp(1.0, MOST_MOVES);
    let step = reach / each_side;
    (0..=2 * each_side as usize).map(move |i| (i as f64 - each_side) * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_moves_by_two_standard_deviations_to_either_side_in_steps_of_a_pixel() {
        let of = |sigma_px: f64| moves(sigma_px).collect::<Vec<_>>();
        assert_eq!(of(1.0), [-2.0, -1.0, 0.0, 1.0, 2.0]);
        assert_eq!(of(0.25), [-0.5, 0.0, 0.5]);
        // A hand that knows nothing keeps the work small.
        let far = of(1e4);
        assert_eq!((far.len(), far[0], far[40]), (81, -2e4, 0.0));
    }
}
