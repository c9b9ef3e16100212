//! The line of an edge that somebody draws in one view (B99 3.1, 3.4, from the second look on).
//!
//! ```text
//! hand    the drawn edge, moved to the edge that the view shows there
//! beam    its epipolar beam: the candidates for the line, by the steps that the other views show
//! steps   the steps along lines that may be edges
//!    -> complete_from_edges    measured in every view, fitted and weighed as every other line
//! ```
//!
//! The likeliest of the fitted candidates is the line. No view needs a detected segment: that the
//! detector missed the edge is why it is drawn.

mod beam;
mod hand;
mod steps;
#[cfg(test)]
mod tests;

pub use hand::DrawnEdge;
pub(crate) use steps::shown_along;

use super::nview::{CompletedLine, complete_from_edges};
use crate::base::geometry::{Plane, Segment2, Segment3};
use crate::base::ids::ViewId;
use crate::base::params::{Lines3dParams, MatchParams};
use crate::lines::lines3d::{Line3d, LineOrigin, ProjectedLine};
use crate::orienting::scene::Scene;

/// The line, between heights in metres, of an edge drawn in a view; its ends are those that were
/// drawn. Besides the lines that the other views make likely it is sought on the `planes` of roofs.
/// `None` where fewer than two other views show an edge along a line that the views together
/// determine.
pub fn line_of_drawn(
    scene: &Scene,
    drawn: &DrawnEdge,
    (z_range, planes): ([f64; 2], &[Plane]),
    (params, fitting): (&MatchParams, &Lines3dParams),
) -> Option<Line3d> {
    let view = drawn.view;
    let own = hand::own_edge(scene.view(view), drawn);
    let snapped = hand::between(&own.segment, &drawn.segment);
    let on_roof = (planes.iter()).filter_map(|p| hand::on_plane(scene.camera(view), &snapped, p));
    let beam = beam::candidates(scene, view, &snapped, z_range, params.max_slope_deg);
    let starts: Vec<Segment3> = on_roof.chain(beam).collect();
    let fitted = crate::base::execution::map(&starts, |_, start| {
        complete_from_edges(scene, start, &own, z_range, (params, fitting))
    });
    let nats = |line: &CompletedLine| line.evidence.nats();
    // The first of the best, which the steps made likelier.
    let best =
        fitted
            .into_iter()
            .flatten()
            .reduce(|best, other| match nats(&other) > nats(&best) {
                true => other,
                false => best,
            })?;
    line_between(scene, view, &snapped, best)
}

/// A drawn edge is at most so many times as long as what the other views measure of it. Assumption:
/// they see a tenth.
const MOST_LENGTHS: f64 = 10.0;

/// The line with the ends that were drawn.
fn line_between(
    scene: &Scene,
    view: ViewId,
    drawn: &Segment2,
    found: CompletedLine,
) -> Option<Line3d> {
    let fit = &found.fit;
    let image = ProjectedLine::new(scene.camera(view), &fit.line)?;
    let ends = [image.t_of(&drawn.p0), image.t_of(&drawn.p1)];
    let segment = fit.line.stretch(ends[0], ends[1]);
    // Nearly along a ray there is no end; what is no number is refused.
    let is_bounded = segment.length() <= MOST_LENGTHS * fit.line.length();
    if !is_bounded {
        return None;
    }
    let shares = ends.map(|t| t / fit.line.length());
    let [first, last] = shares.map(|share| fit.sigma_at(share));
    Some(Line3d {
        origin: LineOrigin::Matched,
        segment,
        sigma_m: first.max(last),
        covariance: shares.map(|share| fit.covariance_at(share)),
        probability: found.evidence.probability(),
        supports: found.supports,
        contradiction: None,
    })
}
