//! Extent of a plane by photo-consistency: closing lines where it seems to end (B99 4.3).
//!
//! B99 closes a facet by the convex hull of its lines when no line was found at one of its sides. A
//! side whose edge is in no image strongly enough still shows: the views agree on the plane up to
//! it and not beyond. Of all rectangles along the plane's longest line the one with the largest sum
//! of evidence is sought, each position with the evidence it has when planes compete
//! ([`crate::roofs::facets::evidence`]); where it ends, a line may bound the facet. The line has no
//! cost advantage, it only allows the facet to end there.

use nalgebra::{Point2, Vector2};

use super::border::{Border, BorderKind};
use crate::base::geometry::Segment3;
use crate::planes::grouping::{GroupingInput, ProposedPlane};
use crate::planes::hypotheses::PlaneHypothesis;
use crate::planes::photoconsistency::{ShiftableWindows, WINDOW};
use crate::roofs::facets::point_cloud::CloudEvidence;

/// Width of a strip, metres: about a pixel of aerial photographs.
const STRIP_M: f64 = 0.1;
/// How often the two spans of the rectangle are sought by turns. Assumption: a third time changes
/// few.
const SPAN_ROUNDS: usize = 2;
/// Planes with less evidence than this, nats, get no closing lines: that of about half a square
/// metre of agreement.
const LEAST_EVIDENCE_NATS: f64 = 2.5;
/// How far an end goes beyond the sides across it, metres, to meet their lines.
const OVERRUN_M: f64 = 0.5;

/// Lines where planes with a half-plane, or proposed ones, seem to end, up to four for each, unless
/// a real line shows that end.
pub(super) fn extent_lines(
    input: &GroupingInput,
    hypotheses: &[PlaneHypothesis],
    windows: &ShiftableWindows,
    cloud: Option<&CloudEvidence>,
) -> Vec<Border> {
    crate::base::execution::map(hypotheses, |_, h| {
        sides(input, h, windows, cloud).unwrap_or_default()
    })
    .into_iter()
    .flatten()
    .collect()
}

/// The sides, where no real line shows them, of the rectangle along the longest line, or side of a
/// proposed plane, in which the views agree on a plane.
fn sides(
    input: &GroupingInput,
    h: &PlaneHypothesis,
    windows: &ShiftableWindows,
    cloud: Option<&CloudEvidence>,
) -> Option<Vec<Border>> {
    if h.group.half_planes().is_empty() && h.group.proposals.is_empty() {
        return None;
    }
    let lines = (h.group.members.iter())
        .map(|m| &input.lines[m.line.index()].segment)
        .map(|line| [line.p0.xy(), line.p1.xy()]);
    let sides = h.group.proposed(input).flat_map(ProposedPlane::sides);
    let [start, end] =
        (lines.chain(sides)).max_by(|[a, b], [c, d]| (b - a).norm().total_cmp(&(d - c).norm()))?;
    let reach = end - start;
    let along = reach.try_normalize(1e-6)?;
    let across = Vector2::new(-along.y, along.x);
    let votes = votes(h, windows, cloud, &start, [&along, &across]);
    let sample_m = h.map.grid.of_samples().step;
    let least = LEAST_EVIDENCE_NATS / (sample_m * sample_m);
    let [(t0, t1), (u0, u1)] = best_rectangle(&votes, reach.norm(), least)?;
    let at = |t: f64, u: f64| start + along * t + across * u;
    let half_window = 0.5 * WINDOW as f64 * h.map.grid.step + STRIP_M;
    let members = (h.group.members.iter()).map(|m| input.lines[m.line.index()].segment);
    let lines: Vec<Segment3> = members.chain(h.lines.iter().map(|l| l.segment)).collect();
    let sides = [
        [at(t0, u0), at(t1, u0)],
        [at(t0, u1), at(t1, u1)],
        [at(t0, u0), at(t0, u1)],
        [at(t1, u0), at(t1, u1)],
    ];
    let open = sides
        .into_iter()
        .filter(|side| !(lines.iter()).any(|l| shows(l, side, half_window)));
    Some(
        open.map(|[a, b]| {
            let over = (b - a).try_normalize(1e-6).unwrap_or_default() * OVERRUN_M;
            Border {
                kind: BorderKind::Closing,
                a: a - over,
                b: b + over,
            }
        })
        .collect(),
    )
}

/// Is a real line the edge that a side was found by? It runs along most of the side, within half a
/// window: as far beyond an edge every plane through it is as good as the next.
fn shows(line: &Segment3, [a, b]: &[Point2<f64>; 2], half_window: f64) -> bool {
    let Some(along) = (b - a).try_normalize(1e-6) else {
        return false;
    };
    let [p, q] = [line.p0.xy() - a, line.p1.xy() - a];
    let beside = [p, q].iter().all(|r| along.perp(r).abs() <= half_window);
    let [s, t] = [p, q].map(|r| r.dot(&along));
    let length = (b - a).norm();
    let common = s.max(t).min(length) - s.min(t).max(0.0);
    beside && common >= 0.5 * length
}

/// The evidence of one sample.
struct Vote {
    /// Where, along two axes, metres.
    at: [f64; 2],
    /// What its window says, nats: positive for the plane.
    nats: f64,
}

/// The votes of all samples in a plane's region, along `axes` from `start`.
fn votes(
    h: &PlaneHypothesis,
    windows: &ShiftableWindows,
    cloud: Option<&CloudEvidence>,
    start: &Point2<f64>,
    axes: [&Vector2<f64>; 2],
) -> Vec<Vote> {
    let grid = &h.map.grid;
    let of_cloud = cloud.map(|cloud| cloud.of(&h.group.plane));
    let samples = grid.of_samples();
    let mut votes = Vec::new();
    for k in 0..grid.width * grid.height {
        if h.map.weight(k) == 0.0 && of_cloud.is_none() {
            continue;
        }
        let cell = [k % grid.width, k / grid.width];
        let observed = windows.evidence_at(&h.map, cell).nats_with_prior();
        let places = (grid.samples_of(cell)).map(|[column, row]| samples.center(column, row));
        let inside = places.into_iter().filter(|p| h.region.contains(p));
        votes.extend(inside.map(|p| Vote {
            at: axes.map(|axis| (p - start).dot(axis)),
            nats: observed + of_cloud.as_ref().map_or(0.0, |cloud| cloud.nats_at(&p)),
        }));
    }
    votes
}

/// The rectangle with the largest sum of votes, as its spans along both axes: across first, beside
/// a line from 0 to `length` along the other. `None` where the sum is below `least`.
fn best_rectangle(votes: &[Vote], length: f64, least: f64) -> Option<[(f64, f64); 2]> {
    let mut spans = [(0.0, length), (0.0, 0.0)];
    let mut sum = 0.0;
    for axis in [1, 0].repeat(SPAN_ROUNDS) {
        let (from, to) = spans[1 - axis];
        let beside = |v: &&Vote| v.at[1 - axis] >= from && v.at[1 - axis] <= to;
        let inside = votes.iter().filter(beside).map(|v| (v.at[axis], v.nats));
        (spans[axis], sum) = best_span(inside)?;
    }
    (sum >= least).then_some(spans)
}

/// The interval of strips with the largest sum of gains, and that sum.
fn best_span(gains: impl Iterator<Item = (f64, f64)> + Clone) -> Option<((f64, f64), f64)> {
    let ends = gains
        .clone()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), (x, _)| {
            (l.min(x), h.max(x))
        });
    let (low, high) = ends;
    (high >= low).then_some(())?;
    let mut strips = vec![0.0; ((high - low) / STRIP_M) as usize + 1];
    gains.for_each(|(x, gain)| strips[((x - low) / STRIP_M) as usize] += gain);
    let (mut best, mut span) = (0.0, None);
    let (mut sum, mut first) = (0.0, 0);
    for (i, gain) in strips.iter().enumerate() {
        if sum <= 0.0 {
            (sum, first) = (0.0, i);
        }
        sum += gain;
        if sum > best {
            (best, span) = (sum, Some((first, i + 1)));
        }
    }
    let place = |strip: usize| low + strip as f64 * STRIP_M;
    span.map(|(first, end)| ((place(first), place(end)), best))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Agreement over a rectangle, with a hole in it, among disagreement; a chance match far away.
    fn votes() -> Vec<Vote> {
        let nats = |t: f64, u: f64| {
            let inside = (2.0..9.0).contains(&t) && (-1.0..4.0).contains(&u);
            let hole = (5.0..5.5).contains(&t) && (1.0..2.0).contains(&u);
            let chance = (13.0..13.5).contains(&t) && (6.0..6.5).contains(&u);
            if (inside && !hole) || chance {
                0.3
            } else {
                -0.2
            }
        };
        let steps = |n: usize| (0..n).map(|i| 0.05 * i as f64 + 0.025);
        steps(320)
            .flat_map(|t| steps(240).map(move |u| [t, u - 4.0]))
            .map(|at| Vote {
                at,
                nats: nats(at[0], at[1]),
            })
            .collect()
    }

    #[test]
    fn a_surface_ends_where_agreement_does() {
        // The line is longer than the surface at one end and shorter at the other.
        let [(t0, t1), (u0, u1)] = best_rectangle(&votes(), 7.0, 1.0).unwrap();
        for (found, planted) in [(t0, 2.0), (t1, 9.0), (u0, -1.0), (u1, 4.0)] {
            assert!((found - planted).abs() <= STRIP_M, "{found} for {planted}");
        }
    }

    #[test]
    fn a_real_line_within_half_a_window_is_the_edge_that_a_side_was_found_by() {
        let side = [Point2::new(0.0, 0.0), Point2::new(8.0, 0.0)];
        let shows = |from: [f64; 2], to: [f64; 2]| {
            let [p0, p1] = [from, to].map(|[x, y]| nalgebra::Point3::new(x, y, 5.0));
            shows(&Segment3::new(p0, p1), &side, 0.5)
        };
        assert!(shows([-1.0, 0.4], [9.0, 0.4]));
        assert!(shows([6.0, -0.4], [1.0, -0.3]));
        assert!(!shows([-1.0, 0.6], [9.0, 0.6]), "too far beside it");
        assert!(
            !shows([-4.0, 0.4], [3.0, 0.4]),
            "along less than half of it"
        );
        assert!(!shows([2.0, -3.0], [2.0, 3.0]), "across it");
    }

    #[test]
    fn a_plane_without_agreement_has_no_end() {
        let mut against = votes();
        assert!(best_rectangle(&against, 7.0, 1e5).is_none(), "too little");
        against.iter_mut().for_each(|v| v.nats = -v.nats.abs());
        assert!(best_rectangle(&against, 7.0, 0.0).is_none());
    }
}
