//! Lines joined by mutual reprojection (B99 3.4).
//!
//! "A correspondence is established between the two triples if the projection of L123 onto the images 4-6 matches at least two of the
//! lines I4, I5, I6, and reciprocally." Adopting the segments beside a line's projection joins most triples as they are found; what two
//! hypotheses still made two lines of is joined here: a step of grey values and one of colour along the same eave, and fragments whose
//! own ends do not reach each other. The image of either lies on the edges of the other, as near as a segment must and within three
//! standard deviations of the prediction, in two views of three; they overlap, or the gap between them is bridged (3.3).

use std::cmp::Ordering;

use super::guided::GuidedEdge;
use super::nviews::{Context, Line, Taken, complete_line};
use super::select::{Fate, Selection};
use super::sight::SegmentRef;
use super::triples::stretch_of;
use crate::geometry::Segment3;
use crate::lines3d::ProjectedLine;

/// A line less certain than this many pixels at another's edge (one standard deviation) tells nothing of it.
const MAX_SIGMA_PX: f64 = 2.0;
/// Cosine of the largest angle between two lines that are compared, 10 degrees.
const PARALLEL: f64 = 0.984_807_753_012_208;
/// Least share of either line's length that the joined one covers.
const COVERED: f64 = 0.9;

/// Joins the lines that are one.
pub fn join_lines(context: &Context, selection: &mut Selection) {
    let mut lines: Vec<Option<Line>> = selection.lines.drain(..).map(Some).collect();
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
                // It may reach others now.
                j = i;
            }
            j += 1;
        }
    }
    selection.renumber(lines, &joined);
}

/// The line that two are, if they are one: that of them which says all that the other does, or what the segments of both make.
fn join(context: &Context, a: &Line, b: &Line, taken: Taken) -> Option<Line> {
    (near(context, a, b) && reprojects(context, a, b) && reprojects(context, b, a)).then_some(())?;
    let absorbed = absorbing(a, b);
    let extended = || absorbed.map(|[line, other]| extended(context, line, other));
    if absorbed.is_some_and(|[line, other]| shows_in_all_views_of(line, other)) {
        return extended();
    }
    let mut seeds: Vec<SegmentRef> = segments(a).chain(segments(b)).collect();
    seeds.sort_unstable();
    seeds.dedup();
    seeds.retain(|s| !taken(*s));
    let joined = complete_line(context, &a.fit.line, &seeds, taken).ok();
    joined
        .filter(|line| is_both(context, line, [a, b]))
        .or_else(extended)
}

/// Do all views that support another line support this one?
fn shows_in_all_views_of(line: &Line, other: &Line) -> bool {
    let supports = |view| line.supports.iter().any(|s| s.view == view);
    other.supports.iter().all(|s| supports(s.view))
}

/// Is a line that was completed from the segments of two those two?
fn is_both(context: &Context, line: &Line, parts: [&Line; 2]) -> bool {
    parts.iter().all(|part| {
        line.supports.len() >= part.supports.len()
            && reprojects(context, line, part)
            && covers(&line.segment, &part.segment)
    })
}

/// The one of two lines that runs along the other, first, and the other; of two that do the one with more views, then the more
/// certain one.
fn absorbing<'a>(a: &'a Line, b: &'a Line) -> Option<[&'a Line; 2]> {
    let absorbs = |x: &Line, y: &Line| covers(&x.segment, &y.segment);
    let a_is_better = match a.supports.len().cmp(&b.supports.len()) {
        Ordering::Equal => a.fit.sigma_at(0.5) <= b.fit.sigma_at(0.5),
        views => views == Ordering::Greater,
    };
    match (absorbs(a, b), absorbs(b, a)) {
        (true, true) if a_is_better => Some([a, b]),
        (true, false) => Some([a, b]),
        (_, true) => Some([b, a]),
        (false, false) => None,
    }
}

/// A line that reaches as far as another one that lies on it, in the views that show both.
fn extended(context: &Context, line: &Line, other: &Line) -> Line {
    let mut line = line.clone();
    for support in &mut line.supports {
        let camera = context.scene.camera(support.view);
        let Some(image) = ProjectedLine::new(camera, &line.segment) else {
            continue;
        };
        let seen = other.supports.iter().filter(|s| s.view == support.view);
        for end in seen.flat_map(|s| [s.stretch.p0, s.stretch.p1]) {
            let t = image.t_of(&end);
            let on_line = image.at(t).unwrap_or(end);
            if t < image.t_of(&support.stretch.p0) {
                support.stretch.p0 = on_line;
            } else if t > image.t_of(&support.stretch.p1) {
                support.stretch.p1 = on_line;
            }
        }
    }
    let [t0, t1] = along(&line.segment, &other.segment);
    line.segment = stretch_of(&line.segment, t0.min(0.0), t1.max(line.segment.length()));
    line
}

/// First and last place of a part along a line, metres from its start.
fn along(line: &Segment3, part: &Segment3) -> [f64; 2] {
    let [t0, t1] = [part.p0, part.p1].map(|p| (p - line.p0).dot(&line.direction()));
    [t0.min(t1), t0.max(t1)]
}

fn segments(line: &Line) -> impl Iterator<Item = SegmentRef> + '_ {
    line.supports.iter().flat_map(|support| {
        let view = support.view;
        let segments = support.segments.iter();
        segments.map(move |&segment| SegmentRef { view, segment })
    })
}

/// Are two lines nearly parallel and no farther apart along them than a gap may be?
fn near(context: &Context, a: &Line, b: &Line) -> bool {
    let (a_line, b_line) = (&a.segment, &b.segment);
    let middle = a_line.at(0.5);
    let gap_m = (middle - b_line.at(0.5)).norm() - 0.5 * (a_line.length() + b_line.length());
    let pixel_m = context
        .scene
        .camera(a.supports[0].view)
        .ground_pixel(&middle);
    gap_m <= context.params.max_gap_px * pixel_m
        && a_line.direction().dot(&b_line.direction()).abs() >= PARALLEL
}

/// Does the image of a line lie on the edges of another, in two of three views that show one?
fn reprojects(context: &Context, line: &Line, onto: &Line) -> bool {
    let length = line.fit.line.length();
    let lies_on = |edge: &GuidedEdge| {
        let camera = context.scene.camera(edge.view);
        ProjectedLine::new(camera, &line.fit.line).is_some_and(|image| {
            [edge.segment.p0, edge.segment.p1].iter().all(|x| {
                let t = image.t_of(x);
                let sigma = image.sigma_px(t, &line.fit.covariance_at(t / length));
                let (gate, off) = (context.params.gate_px, image.distance(x));
                sigma <= MAX_SIGMA_PX && off * off <= gate * gate + 9.0 * sigma * sigma
            })
        })
    };
    let edges: Vec<bool> = (onto.supports.iter().filter_map(|s| s.edge.as_ref()))
        .map(lies_on)
        .collect();
    3 * edges.iter().filter(|on| **on).count() >= 2 * edges.len()
}

/// Does a line run along most of another?
fn covers(line: &Segment3, part: &Segment3) -> bool {
    let [from, to] = along(line, part);
    to.min(line.length()) - from.max(0.0) >= COVERED * part.length()
}

impl Selection {
    /// Takes these lines, without gaps between them, for what it had; `joined` names the one that each has become part of.
    fn renumber(&mut self, lines: Vec<Option<Line>>, joined: &[usize]) {
        let mut numbers = vec![0; lines.len()];
        for (old, line) in lines.into_iter().enumerate() {
            numbers[old] = self.lines.len();
            self.lines.extend(line);
        }
        let number = |old: &mut usize| *old = numbers[joined[*old]];
        for fate in &mut self.fates {
            match fate {
                Fate::Won(line) | Fate::Lost(line) => number(line),
                Fate::Rejected(_) => {}
            }
        }
        self.owners.iter_mut().flatten().flatten().for_each(number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Segment2;
    use crate::ids::{SegmentId, ViewId};
    use crate::linematch::sight::Sights;
    use crate::linematch::{LineSupport, SupportKind, planted};
    use crate::lines2d::{ImageSegment, SegmentKind};
    use crate::lines3d::{Observation, fit_line};
    use crate::params::{Lines3dParams, MatchParams};
    use crate::scene::Scene;
    use nalgebra::Matrix2;

    /// The flat roof, whose segments have the number of their edge.
    struct Roof {
        scene: Scene,
        segments: Vec<Vec<ImageSegment>>,
        sights: Sights,
        params: MatchParams,
        fitting: Lines3dParams,
    }

    impl Roof {
        fn new() -> Self {
            let scene = planted::scene();
            let segments = planted::segments(&scene);
            Self {
                sights: Sights::new(&scene, &segments),
                scene,
                segments,
                params: MatchParams::default(),
                fitting: Lines3dParams::default(),
            }
        }

        fn context(&self) -> Context<'_> {
            let params = (&self.params, &self.fitting);
            Context::of_planted(&self.scene, &self.segments, &self.sights, params)
        }

        /// The line through a part of an edge as some views show it, whose edges are `beside_px` off in the view that is named.
        fn line(
            &self,
            edge: usize,
            [from, to]: [f64; 2],
            views: &[u32],
            beside_px: (u32, f64),
        ) -> Line {
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
            Line {
                segment,
                fit,
                supports,
            }
        }

        fn joined(&self, a: &Line, b: &Line) -> Option<Line> {
            join(&self.context(), a, b, &|_| false)
        }
    }

    const ALL: [u32; 5] = [0, 1, 2, 3, 4];
    const NOWHERE: (u32, f64) = (9, 0.0);

    #[test]
    fn the_lines_of_two_strips_and_of_two_halves_are_one() {
        let roof = Roof::new();
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
        let roof = Roof::new();
        let line = roof.line(2, [0.0, 1.0], &ALL, NOWHERE);
        let short = roof.line(2, [0.48, 0.53], &[0, 1, 2], NOWHERE);
        let reprojects = |line: &Line, onto: &Line| super::reprojects(&roof.context(), line, onto);
        assert!(reprojects(&line, &short));
        // Five pixels do not tell where a hundred end.
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
    fn what_a_line_absorbs_lengthens_it() {
        let roof = Roof::new();
        let long = roof.line(2, [0.0, 0.95], &ALL, NOWHERE);
        let short = roof.line(2, [0.1, 1.0], &[0, 1, 2], NOWHERE);
        // Either runs along most of the other; more views show the first one.
        for [a, b] in [[&long, &short], [&short, &long]] {
            let [line, other] = absorbing(a, b).expect("one absorbs the other");
            assert_eq!([line.supports.len(), other.supports.len()], [5, 3]);
        }
        let line = extended(&roof.context(), &long, &short);
        let edge = planted::edges()[2];
        assert!((line.segment.p0 - edge.p0).norm() < 1e-6);
        assert!((line.segment.p1 - edge.p1).norm() < 1e-6);
        for support in &line.supports {
            let view = support.view.index();
            let end = if view < 3 { 1.0 } else { 0.95 };
            let expected = planted::part_of(&roof.scene, view, 2, 0.0, end);
            assert!((support.stretch.p0 - expected.p0).norm() < 0.05);
            assert!((support.stretch.p1 - expected.p1).norm() < 0.05);
        }
        // Of as many views the more certain one stays, and one that hardly overlaps is not absorbed.
        let vague = roof.line(2, [0.0, 0.95], &ALL, (0, 0.3));
        let [line, _] = absorbing(&vague, &long).expect("the same places");
        assert!(line.fit.sigma_at(0.5) < vague.fit.sigma_at(0.5));
        let half = roof.line(2, [0.5, 1.0], &ALL, NOWHERE);
        assert!(absorbing(&roof.line(2, [0.0, 0.6], &ALL, NOWHERE), &half).is_none());
    }

    #[test]
    fn joined_lines_leave_no_gap_in_the_numbers() {
        let roof = Roof::new();
        let mut selection = Selection::none(&roof.segments);
        selection.lines = vec![
            roof.line(2, [0.0, 0.45], &ALL, NOWHERE),
            roof.line(0, [0.0, 1.0], &ALL, NOWHERE),
            roof.line(2, [0.6, 1.0], &ALL, NOWHERE),
            roof.line(1, [0.0, 1.0], &ALL, NOWHERE),
        ];
        let owned = [(0, 2), (1, 0), (2, 4), (3, 1)];
        for (line, segment) in owned {
            selection.owners[0][segment] = Some(line);
            selection.fates.push(Fate::Won(line));
        }
        selection.fates.push(Fate::Lost(2));
        join_lines(&roof.context(), &mut selection);
        let numbers = owned.map(|(_, segment)| selection.owners[0][segment]);
        assert_eq!(numbers, [Some(0), Some(1), Some(0), Some(2)]);
        let fates = [0, 1, 0, 2].map(Fate::Won);
        assert_eq!(selection.fates[..4], fates);
        assert_eq!(selection.fates[4], Fate::Lost(0));
        let edges = planted::edges();
        for (line, edge) in selection.lines.iter().zip([2, 0, 1]) {
            assert!(covers(&line.segment, &edges[edge]), "edge {edge}");
        }
    }
}
