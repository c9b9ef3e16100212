//! What each view shows of a line: the segments that lie on its image, and the edge measured again along it (B99 3.2,
//! 3.4).
//!
//! The hypothesis comes from segments of one kind that are bright on the same side. A further view may show the line
//! in another way, and is asked for that where it does not show it in the same: two strips may see an eave bright on
//! different sides, and before the shadow of the house in colour alone.

use nalgebra::Point2;

use super::nviews::{Context, Taken};
use crate::geometry::{Segment2, Segment3};
use crate::ids::SegmentId;
use crate::ids::ViewId;
use crate::linematch::sight::{SegmentRef, Sight};
use crate::lines2d::SegmentKind;
use crate::lines2d::{GuidedEdge, measure_edge};
use crate::lines3d::{ProjectedLine, doubly_covered};

/// How near the segment of another line an edge measured again is that same edge, px. Assumption: three times what edges of
/// one line are off (`position_floor_px`).
const SAME_EDGE_PX: f64 = 0.3;

impl Context<'_> {
    /// The edge that a view shows along the line: of the kind of the line's segments or, where there is none,
    /// of the other one, if a segment of that lies there.
    pub fn measure(
        &self,
        line: &Segment3,
        segments: &[SegmentRef],
        view: ViewId,
        taken: Taken,
    ) -> Option<GuidedEdge> {
        let kind = self.sights.kind(segments)?;
        let edge = self.measure_in(kind, line, segments, view).or_else(|| {
            let other = self.adopt_in(view, kind.other(), line, segments, 1.0, taken);
            (!other.is_empty()).then_some(())?;
            let elsewhere = segments.iter().copied().filter(|s| s.view != view);
            let known: Vec<SegmentRef> = elsewhere.chain(other).collect();
            self.measure_in(kind.other(), line, &known, view)
        });
        let own_segment = segments.iter().any(|s| s.view == view);
        edge.filter(|edge| own_segment || !self.is_of_another(edge, taken))
    }

    /// Does most of an edge lie on segments that belong to other lines? Winner takes all (B99 3.2): an eave in front of a line on
    /// the ground is not seen twice.
    fn is_of_another(&self, edge: &GuidedEdge, taken: Taken) -> bool {
        let view = edge.view;
        let near =
            (self.sights.views[view.index()].index).near_segment(&edge.segment, SAME_EDGE_PX);
        let others: Vec<&Sight> = (near.into_iter())
            .map(|id| SegmentRef {
                view,
                segment: SegmentId(id),
            })
            .filter(|name| taken(*name))
            .filter_map(|name| self.sights.get(name))
            .filter(|sight| sight.kind == edge.kind)
            .collect();
        let on_another = |piece: &&Segment2| {
            let middle = piece.at(0.5);
            others.iter().any(|s| passes(&s.segment, &middle))
        };
        2 * edge.pieces.iter().filter(on_another).count() > edge.pieces.len()
    }

    fn measure_in(
        &self,
        kind: SegmentKind,
        line: &Segment3,
        segments: &[SegmentRef],
        view: ViewId,
    ) -> Option<GuidedEdge> {
        let (image, whole) = self.extent(line, segments, view)?;
        let margin = self.params.max_gap_px;
        let expected = Segment2::new(
            whole.p0 - image.direction * margin,
            whole.p1 + image.direction * margin,
        );
        let core = self.core(line, segments, view)?;
        let along = |t: f64| Some((image.at(t)? - expected.p0).dot(&expected.direction()));
        let core = [along(core.0)?, along(core.1)?];
        let seen = self.scene.view(view).channel(kind.channel());
        let against = self.against_contrast(&image, segments, view);
        measure_edge(view, seen, kind, &expected, core, against)
    }

    /// Is the bright side of this view's own segments the other one than the line's?
    fn against_contrast(
        &self,
        image: &ProjectedLine,
        segments: &[SegmentRef],
        view: ViewId,
    ) -> bool {
        let along = |s: &SegmentRef| {
            let sight = self.sights.get(*s)?;
            Some(sight.length_px * sight.segment.direction().dot(&image.direction))
        };
        let own = segments.iter().filter(|s| s.view == view);
        own.filter_map(along).sum::<f64>() < 0.0
    }

    /// The stretch of a line, metres, along which a view must show an edge: that of its own segments, or what
    /// two other views detected.
    fn core(&self, line: &Segment3, segments: &[SegmentRef], view: ViewId) -> Option<(f64, f64)> {
        let place = |s: &SegmentRef| {
            let image = ProjectedLine::new(self.scene.camera(s.view), line)?;
            let sight = self.sights.get(*s)?;
            let [t0, t1] = [&sight.segment.p0, &sight.segment.p1].map(|p| image.t_of(p));
            Some((t0.min(t1), t0.max(t1)))
        };
        let own = segments.iter().filter(|s| s.view == view).filter_map(place);
        let hull = own.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let all = segments.iter().filter_map(place);
        hull.or_else(|| doubly_covered(all.flat_map(|(s, e)| [(s, 1), (e, -1)]).collect()))
    }

    /// The segments of all views that lie on the projection of the line, or not farther beyond its
    /// ends than a gap may be; `reach` times the gate is near enough. Those of a view are of the kind that
    /// its measured edge is of, or else of the line's.
    pub fn adopt(
        &self,
        line: &Segment3,
        known: &[SegmentRef],
        edges: &[GuidedEdge],
        reach: f64,
        taken: Taken,
    ) -> Vec<SegmentRef> {
        let Some(kind) = self.sights.kind(known) else {
            return Vec::new();
        };
        let shown = |view| {
            let own: Vec<SegmentRef> = known.iter().copied().filter(|s| s.view == view).collect();
            let edge = edges.iter().find(|e| e.view == view).map(|e| e.kind);
            edge.or_else(|| self.sights.kind(&own)).unwrap_or(kind)
        };
        (self.scene.view_ids())
            .flat_map(|view| self.adopt_in(view, shown(view), line, known, reach, taken))
            .collect()
    }

    /// Those of one view and kind. Two strips may see an eave bright on different sides: where none is directed
    /// like the line, those against it are taken.
    fn adopt_in(
        &self,
        view: ViewId,
        kind: SegmentKind,
        line: &Segment3,
        known: &[SegmentRef],
        reach: f64,
        taken: Taken,
    ) -> Vec<SegmentRef> {
        let Some((image, extent)) = self.extent(line, known, view) else {
            return Vec::new();
        };
        let (from, to) = (
            extent.p0 - image.direction * self.params.max_gap_px,
            extent.p1 + image.direction * self.params.max_gap_px,
        );
        let stretch = Segment2::new(from, to);
        let index = &self.sights.views[view.index()].index;
        let ahead = |p: Point2<f64>| (p - from).dot(&image.direction);
        let near = index.near_segment(&stretch, reach * self.params.gate_px);
        let on_line = near.into_iter().filter_map(|id| {
            let name = SegmentRef {
                view,
                segment: SegmentId(id),
            };
            let sight = self.sights.get(name)?;
            let (s0, s1) = (ahead(sight.segment.p0), ahead(sight.segment.p1));
            (self.alike.holds(sight.kind, kind)
                && s0.max(s1) >= 0.0
                && s0.min(s1) <= stretch.length()
                && self.lies_on(&image, sight, reach)
                && !taken(name))
            .then_some((name, sight.segment.direction().dot(&image.direction) > 0.0))
        });
        let (along, against): (Vec<_>, Vec<_>) =
            on_line.partition(|(_, along)| *along || !self.alike.directs(kind));
        let own = if along.is_empty() { against } else { along };
        own.into_iter().map(|(name, _)| name).collect()
    }

    /// The image of the line in a view, and the stretch of it that the known segments cover.
    fn extent(
        &self,
        line: &Segment3,
        known: &[SegmentRef],
        view: ViewId,
    ) -> Option<(ProjectedLine, Segment2)> {
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for s in known {
            let image = ProjectedLine::new(self.scene.camera(s.view), line)?;
            let sight = self.sights.get(*s)?;
            for p in [sight.segment.p0, sight.segment.p1] {
                let t = image.t_of(&p);
                (from, to) = (from.min(t), to.max(t));
            }
        }
        let image = ProjectedLine::new(self.scene.camera(view), line)?;
        Some((image, Segment2::new(image.at(from)?, image.at(to)?)))
    }

    fn lies_on(&self, image: &ProjectedLine, sight: &Sight, reach: f64) -> bool {
        let along = sight.segment.direction().dot(&image.direction);
        let near = |p| image.distance(p).abs() <= reach * self.params.gate_px;
        along.abs() > 0.9 && near(&sight.segment.p0) && near(&sight.segment.p1)
    }
}

/// Does a segment pass a point within [`SAME_EDGE_PX`], between its ends?
fn passes(segment: &Segment2, point: &Point2<f64>) -> bool {
    let to_point = point - segment.p0;
    let along = to_point.dot(&segment.direction());
    (0.0..=segment.length()).contains(&along)
        && to_point.dot(&segment.normal()).abs() <= SAME_EDGE_PX
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linematch::planted;
    use crate::linematch::sight::Sights;
    use crate::params::Lines3dParams;
    use crate::params::MatchParams;

    #[test]
    fn an_edge_of_another_line_is_not_measured_again() {
        let scene = planted::scene();
        let own = |view| SegmentRef {
            view,
            segment: SegmentId(0),
        };
        let [first, last] = [ViewId(0), ViewId(3)];
        let mut segments = planted::segments(&scene);
        let again = SegmentRef {
            view: last,
            segment: SegmentId::from_index(segments[last.index()].len()),
        };
        let whole = segments[last.index()][0].clone();
        segments[last.index()].push(whole);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let sights = Sights::new(&scene, &segments);
        let context = Context::of_planted(&scene, &segments, &sights, (&params, &fitting));
        let shows = |known: &[SegmentRef], taken: &[SegmentRef]| {
            let line = planted::edges()[0];
            let taken = |s| taken.contains(&s);
            context.measure(&line, known, last, &taken).is_some()
        };
        let seen_by_two = [own(first), own(ViewId(1))];
        assert!(shows(&seen_by_two, &[]));
        assert!(!shows(&seen_by_two, &[again]));
        let beside = [own(first), own(last)];
        assert!(shows(&beside, &[again]), "a segment of its own");
    }

    #[test]
    fn a_view_that_shows_no_segment_like_the_others_gives_one_against_them() {
        let scene = planted::scene();
        let own = |view| SegmentRef {
            view,
            segment: SegmentId(0),
        };
        let [first, last] = [ViewId(0), ViewId(3)];
        let adopted = |change: &dyn Fn(&mut Vec<crate::lines2d::ImageSegment>)| {
            let mut segments = planted::segments(&scene);
            change(&mut segments[last.index()]);
            let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
            let sights = Sights::new(&scene, &segments);
            let context = Context::of_planted(&scene, &segments, &sights, (&params, &fitting));
            let line = planted::edges()[0];
            let mut found = context.adopt(&line, &[own(first)], &[], 1.0, &|_| false);
            found.retain(|s| s.view == last);
            found
        };
        let reversed = |s: &crate::lines2d::ImageSegment| {
            let mut s = s.clone();
            s.segment = Segment2::new(s.segment.p1, s.segment.p0);
            s
        };
        assert_eq!(adopted(&|_| ()), [own(last)]);
        assert_eq!(adopted(&|s| s[0] = reversed(&s[0])), [own(last)]);
        assert_eq!(
            adopted(&|s| s.push(reversed(&s[0]))),
            [own(last)],
            "not both"
        );
        assert_eq!(adopted(&|s| s[0].kind = SegmentKind::Color), []);
    }
}
