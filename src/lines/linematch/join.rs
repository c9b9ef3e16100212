//! Lines joined by mutual reprojection (B99 3.4).
//!
//! "A correspondence is established between the two triples if the projection of L123 onto the
//! images 4-6 matches at least two of the lines I4, I5, I6, and reciprocally." Adopting the
//! segments beside a line's projection joins most triples as they are found. Joined here are lines
//! that two hypotheses still have in common, such as those of the views of two strips, and
//! fragments that do not reach each other. The image of either lies on the edges of the other in
//! two views of three, within the gate of a segment and three standard deviations of the
//! prediction; the two overlap, or the views correlate in the gap between them (3.3).

use super::nview::{CompletedLine, IsTaken, MatchContext, complete_line};
use super::segment_geometry::SegmentRef;
use super::selection::{BundleOutcome, Selection};
use crate::base::line_linker::LineLinker;
use crate::lines::lines3d::reprojects_onto;

/// Joins the lines that are images of one edge.
pub(super) fn join_lines(context: &MatchContext, selection: &mut Selection) {
    let mut lines: Vec<Option<CompletedLine>> = selection.lines.drain(..).map(Some).collect();
    // The line that each one has become part of.
    let mut joined: Vec<usize> = (0..lines.len()).collect();
    for i in 0..lines.len() {
        let mut j = i + 1;
        while j < lines.len() {
            let others = |s| {
                let owner = selection.owner(s).map(|k| joined[k]);
                owner.is_some_and(|k| k != i && k != j)
            };
            let both = lines[i].as_ref().zip(lines[j].as_ref());
            if let Some(line) = both.and_then(|(a, b)| join(context, a, b, &others)) {
                selection.own(&line, i);
                lines[i] = Some(line);
                lines[j] = None;
                let part_of_j = joined.iter_mut().filter(|k| **k == j);
                part_of_j.for_each(|k| *k = i);
                // The longer line may reach others.
                j = i;
            }
            j += 1;
        }
    }
    selection.renumber(lines, &joined);
}

/// The line through the segments of two, if they are one. A mere duplicate stays, because grey
/// values and colour are independent evidence for an edge.
fn join(
    context: &MatchContext,
    a: &CompletedLine,
    b: &CompletedLine,
    taken: IsTaken,
) -> Option<CompletedLine> {
    (near(context, a, b) && reprojects(context, a, b) && reprojects(context, b, a)).then_some(())?;
    if is_duplicate_of(a, b) || is_duplicate_of(b, a) {
        return None;
    }
    let mut seeds: Vec<SegmentRef> = segments(a).chain(segments(b)).collect();
    seeds.sort_unstable();
    seeds.dedup();
    seeds.retain(|s| !taken(*s));
    let joined = complete_line(context, &a.fit.line, &seeds, taken).ok()?;
    is_both(context, &joined, [a, b]).then_some(joined)
}

/// Do the views and the stretch of another line include those of this one?
fn is_duplicate_of(line: &CompletedLine, other: &CompletedLine) -> bool {
    let supports = |view| other.supports.iter().any(|s| s.view == view);
    line.supports.iter().all(|s| supports(s.view)) && contains(other, line)
}

/// Does a line run along nearly all of another?
fn contains(line: &CompletedLine, part: &CompletedLine) -> bool {
    LineLinker::contained().connects(&line.segment.ends(), &part.segment.ends())
}

/// Does the line completed from the segments of two include both?
fn is_both(context: &MatchContext, line: &CompletedLine, parts: [&CompletedLine; 2]) -> bool {
    parts.iter().all(|part| {
        line.supports.len() >= part.supports.len()
            && reprojects(context, line, part)
            && contains(line, part)
    })
}

fn segments(line: &CompletedLine) -> impl Iterator<Item = SegmentRef> + '_ {
    line.supports.iter().flat_map(|support| {
        let view = support.view;
        let segments = support.segments.iter();
        segments.map(move |&segment| SegmentRef { view, segment })
    })
}

/// Are two lines nearly parallel and no farther apart along them than a gap may be?
fn near(context: &MatchContext, a: &CompletedLine, b: &CompletedLine) -> bool {
    let pixel_m = context
        .scene
        .camera(a.supports[0].view)
        .ground_pixel(&a.segment.p0);
    let linker = LineLinker::fragments(context.params.max_gap_px * pixel_m);
    linker.connects(&a.segment.ends(), &b.segment.ends())
}

/// Does the image of a line lie on the edges of another, in two of three views that show one?
fn reprojects(context: &MatchContext, line: &CompletedLine, onto: &CompletedLine) -> bool {
    let length = line.fit.line.length();
    let covariance_at = |t: f64| line.fit.covariance_at(t / length);
    let linker = LineLinker::reprojected_fragment(context.params.gate_px);
    let of_line = (&line.fit.line, covariance_at);
    reprojects_onto(context.scene, of_line, &onto.supports, &linker)
}

impl Selection {
    /// Replaces the lines by those that remain; `joined` is the line that each has become part of.
    fn renumber(&mut self, lines: Vec<Option<CompletedLine>>, joined: &[usize]) {
        let mut numbers = vec![0; lines.len()];
        for (old, line) in lines.into_iter().enumerate() {
            numbers[old] = self.lines.len();
            self.lines.extend(line);
        }
        let number = |old: &mut usize| *old = numbers[joined[*old]];
        for outcome in &mut self.outcomes {
            match outcome {
                BundleOutcome::Accepted(line) | BundleOutcome::Superseded(line) => number(line),
                BundleOutcome::Rejected(_) => {}
            }
        }
        self.owners.iter_mut().flatten().flatten().for_each(number);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::PlantedRoof;
    use super::*;
    use crate::base::evidence::Evidence;
    use crate::base::geometry::{Segment2, Segment3};
    use crate::base::ids::SegmentId;
    use crate::base::ids::ViewId;
    use crate::lines::lines2d::{GuidedEdge, SegmentKind};
    use crate::lines::lines3d::planted;
    use crate::lines::lines3d::{LineSupport, SupportKind};
    use crate::lines::lines3d::{Observation, fit_line};
    use nalgebra::Matrix2;

    fn covers(line: &Segment3, part: &Segment3) -> bool {
        LineLinker::contained().connects(&line.ends(), &part.ends())
    }

    impl PlantedRoof {
        /// The line through a part of an edge from some views, with the edge displaced in one of
        /// them: `beside_px` is that view and the distance.
        fn line(
            &self,
            edge: usize,
            [from, to]: [f64; 2],
            views: &[u32],
            beside_px: (u32, f64),
        ) -> CompletedLine {
            let support = |&view: &u32| {
                let exact = planted::part_of(&self.scene, view as usize, edge, from, to);
                let off = if view == beside_px.0 {
                    beside_px.1
                } else {
                    0.0
                };
                let across = exact.normal() * off;
                let stretch = Segment2::new(exact.p0 + across, exact.p1 + across);
                let length = stretch.length();
                LineSupport {
                    view: ViewId(view),
                    segments: vec![SegmentId(edge as u32)],
                    stretch,
                    score: 0.9,
                    kind: SupportKind::Matched,
                    edge: Some(GuidedEdge {
                        view: ViewId(view),
                        kind: SegmentKind::Edge,
                        segment: stretch,
                        covariance: Matrix2::new(0.0025, 0.0, 0.0, 0.01 / (length * length)),
                        pieces: vec![stretch],
                    }),
                }
            };
            let supports: Vec<LineSupport> = views.iter().map(support).collect();
            let whole = planted::edges()[edge];
            let segment = Segment3::new(whole.at(from), whole.at(to));
            let observed: Vec<Observation> = (supports.iter().filter_map(|s| s.edge.as_ref()))
                .map(|e| Observation::of(e, self.scene.camera(e.view)))
                .collect();
            let fit = fit_line(&observed, &segment, &self.fitting).expect("a line");
            CompletedLine {
                segment,
                fit,
                supports,
                evidence: Evidence {
                    prior: 3.0,
                    terms: Vec::new(),
                },
            }
        }

        fn joined(&self, a: &CompletedLine, b: &CompletedLine) -> Option<CompletedLine> {
            join(&self.context(), a, b, &|_| false)
        }
    }

    const ALL: [u32; 5] = [0, 1, 2, 3, 4];
    const NOWHERE: (u32, f64) = (9, 0.0);

    #[test]
    fn the_lines_of_two_strips_and_of_two_halves_are_one() {
        let roof = PlantedRoof::new();
        let whole = planted::edges()[2];
        let outward = roof.line(2, [0.0, 1.0], &[0, 1, 4], NOWHERE);
        let back = roof.line(2, [0.0, 1.0], &[2, 3, 4], NOWHERE);
        // 100 pixels, of which the images show the 15 between the halves.
        let first = roof.line(2, [0.0, 0.45], &ALL, NOWHERE);
        let second = roof.line(2, [0.6, 1.0], &ALL, NOWHERE);
        for (a, b) in [(&outward, &back), (&first, &second), (&second, &first)] {
            let line = roof.joined(a, b).expect("one line");
            assert_eq!(line.supports.len(), 5);
            assert!(covers(&line.segment, &whole), "{:?}", line.segment);
            assert!(whole.line_distance(&line.segment.at(0.5)) < 0.05);
        }
        let far = roof.line(2, [0.8, 1.0], &ALL, NOWHERE);
        assert!(roof.joined(&first, &far).is_none(), "35 pixels apart");
        // Edge 0 lies across from it, and edge 1 meets it in a corner.
        for edge in [0, 1] {
            let other = roof.line(edge, [0.0, 1.0], &ALL, NOWHERE);
            assert!(roof.joined(&outward, &other).is_none(), "edge {edge}");
        }
    }

    #[test]
    fn each_line_has_to_reproject_onto_two_of_three_edges_of_the_other() {
        let roof = PlantedRoof::new();
        let line = roof.line(2, [0.0, 1.0], &ALL, NOWHERE);
        let short = roof.line(2, [0.48, 0.53], &[0, 1, 2], NOWHERE);
        let reprojects = |line: &CompletedLine, onto: &CompletedLine| {
            super::reprojects(&roof.context(), line, onto)
        };
        assert!(reprojects(&line, &short));
        // A line of five pixels does not determine the ends of one of a hundred.
        assert!(!reprojects(&short, &line));
        // Three pixels off is another edge, in one view of three and in two.
        let mut beside = short.clone();
        let mut displace = |view: usize| {
            let edge = beside.supports[view].edge.as_mut().expect("measured");
            let across = edge.segment.normal() * 3.0;
            edge.segment = Segment2::new(edge.segment.p0 + across, edge.segment.p1 + across);
            reprojects(&line, &beside)
        };
        assert!(displace(0));
        assert!(!displace(1));
    }

    #[test]
    fn a_line_that_repeats_another_stays() {
        let roof = PlantedRoof::new();
        let line = roof.line(2, [0.0, 1.0], &ALL, NOWHERE);
        let part = roof.line(2, [0.1, 0.8], &[0, 1, 2], NOWHERE);
        assert!(is_duplicate_of(&part, &line) && !is_duplicate_of(&line, &part));
        assert!(roof.joined(&part, &line).is_none());
        // Not where it has a view or a stretch of its own.
        let fewer = roof.line(2, [0.0, 1.0], &[0, 1, 4], NOWHERE);
        let shorter = roof.line(2, [0.0, 0.6], &ALL, NOWHERE);
        for other in [fewer, shorter] {
            assert!(!is_duplicate_of(&part, &other));
            let joined = roof.joined(&part, &other).expect("one line");
            assert!(contains(&joined, &part));
        }
    }

    #[test]
    fn joined_lines_leave_no_gap_in_the_numbers() {
        let roof = PlantedRoof::new();
        let mut selection = Selection::empty(&roof.segments);
        selection.lines = vec![
            roof.line(2, [0.0, 0.45], &ALL, NOWHERE),
            roof.line(0, [0.0, 1.0], &ALL, NOWHERE),
            roof.line(2, [0.6, 1.0], &ALL, NOWHERE),
            roof.line(1, [0.0, 1.0], &ALL, NOWHERE),
        ];
        let owned = [(0, 2), (1, 0), (2, 4), (3, 1)];
        for (line, segment) in owned {
            selection.owners[0][segment] = Some(line);
            selection.outcomes.push(BundleOutcome::Accepted(line));
        }
        selection.outcomes.push(BundleOutcome::Superseded(2));
        join_lines(&roof.context(), &mut selection);
        let numbers = owned.map(|(_, segment)| selection.owners[0][segment]);
        assert_eq!(numbers, [Some(0), Some(1), Some(0), Some(2)]);
        let outcomes = [0, 1, 0, 2].map(BundleOutcome::Accepted);
        assert_eq!(selection.outcomes[..4], outcomes);
        assert_eq!(selection.outcomes[4], BundleOutcome::Superseded(0));
        let edges = planted::edges();
        for (line, edge) in selection.lines.iter().zip([2, 0, 1]) {
            assert!(covers(&line.segment, &edges[edge]), "edge {edge}");
        }
    }
}
