//! The observations of a line in each view: the segments on its image, and the edge measured again
//! along it (B99 3.2, 3.4).
//!
//! The hypothesis comes from segments of one kind with the same bright side. Other kinds and
//! contrasts are accepted in a further view that shows none like it: in two strips an eave may be
//! bright on different sides, and before the shadow of the house visible in colour alone.

use super::context::{IsTaken, MatchContext};
use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::{SegmentId, ViewId};
use crate::base::line_linker::LineLinker;
use crate::lines::linematch::segment_geometry::{SegmentGeometry, SegmentRef};
use crate::lines::lines2d::{GuidedEdge, SegmentKind, measure_edge};
use crate::lines::lines3d::{ProjectedLine, doubly_covered};

impl MatchContext<'_> {
    /// The edge of a view along the line: of the kind of the line's segments or, without one, of
    /// the other kind, if a segment of that kind lies there.
    pub(crate) fn measure(
        &self,
        line: &Segment3,
        segments: &[SegmentRef],
        view: ViewId,
        taken: IsTaken,
    ) -> Option<GuidedEdge> {
        let kind = self.prepared.kind(segments)?;
        let edge = self.measure_in(kind, line, segments, view).or_else(|| {
            let other = self.adopt_in(view, kind.other(), line, segments, 1.0, taken);
            (!other.is_empty()).then_some(())?;
            let elsewhere = segments.iter().copied().filter(|s| s.view != view);
            let known: Vec<SegmentRef> = elsewhere.chain(other).collect();
            self.measure_in(kind.other(), line, &known, view)
        });
        let own_segment = segments.iter().any(|s| s.view == view);
        edge.filter(|edge| own_segment || !self.belongs_to_another(edge, taken))
    }

    /// Does most of an edge lie on segments of other lines? Winner takes all (B99 3.2): an eave in
    /// front of a line on the ground is one edge.
    fn belongs_to_another(&self, edge: &GuidedEdge, taken: IsTaken) -> bool {
        let view = edge.view;
        let linker = LineLinker::measured_edge();
        let near =
            (self.prepared.views[view.index()].index).near_segment(&edge.segment, linker.apart);
        let others: Vec<&SegmentGeometry> = (near.into_iter())
            .map(|id| SegmentRef {
                view,
                segment: SegmentId(id),
            })
            .filter(|name| taken(*name))
            .filter_map(|name| self.prepared.get(name))
            .filter(|geometry| geometry.kind == edge.kind)
            .collect();
        let on_another = |piece: &&Segment2| {
            let middle = piece.at(0.5);
            (others.iter()).any(|s| linker.passes(&s.segment.ends(), &middle))
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

    /// Are this view's own segments directed against the line, with the bright side on its left?
    fn against_contrast(
        &self,
        image: &ProjectedLine,
        segments: &[SegmentRef],
        view: ViewId,
    ) -> bool {
        let along = |s: &SegmentRef| {
            let geometry = self.prepared.get(*s)?;
            Some(geometry.length_px * geometry.segment.direction().dot(&image.direction))
        };
        let own = segments.iter().filter(|s| s.view == view);
        own.filter_map(along).sum::<f64>() < 0.0
    }

    /// The stretch of a line along which a view must show an edge, metres: that of its own
    /// segments, or the stretch detected in two other views.
    fn core(&self, line: &Segment3, segments: &[SegmentRef], view: ViewId) -> Option<(f64, f64)> {
        let place = |s: &SegmentRef| {
            let image = ProjectedLine::new(self.scene.camera(s.view), line)?;
            let geometry = self.prepared.get(*s)?;
            let [t0, t1] = [&geometry.segment.p0, &geometry.segment.p1].map(|p| image.t_of(p));
            Some((t0.min(t1), t0.max(t1)))
        };
        let own = segments.iter().filter(|s| s.view == view).filter_map(place);
        let hull = own.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let all = segments.iter().filter_map(place);
        hull.or_else(|| doubly_covered(all.flat_map(|(s, e)| [(s, 1), (e, -1)]).collect()))
    }

    /// The segments of all views on the projection of the line, or beyond its ends by no more than
    /// the largest gap, within `reach` times the gate. In each view they are of the kind of its
    /// measured edge, or else of the line.
    pub(crate) fn adopt(
        &self,
        line: &Segment3,
        known: &[SegmentRef],
        edges: &[GuidedEdge],
        reach: f64,
        taken: IsTaken,
    ) -> Vec<SegmentRef> {
        let Some(kind) = self.prepared.kind(known) else {
            return Vec::new();
        };
        let shown = |view| {
            let own: Vec<SegmentRef> = known.iter().copied().filter(|s| s.view == view).collect();
            let edge = edges.iter().find(|e| e.view == view).map(|e| e.kind);
            edge.or_else(|| self.prepared.kind(&own)).unwrap_or(kind)
        };
        (self.scene.view_ids())
            .flat_map(|view| self.adopt_in(view, shown(view), line, known, reach, taken))
            .collect()
    }

    /// The segments of one view and kind. Without one directed like the line, those against it are
    /// taken, because two strips may see an eave bright on different sides.
    fn adopt_in(
        &self,
        view: ViewId,
        kind: SegmentKind,
        line: &Segment3,
        known: &[SegmentRef],
        reach: f64,
        taken: IsTaken,
    ) -> Vec<SegmentRef> {
        let Some((image, extent)) = self.extent(line, known, view) else {
            return Vec::new();
        };
        let (from, to) = (
            extent.p0 - image.direction * self.params.max_gap_px,
            extent.p1 + image.direction * self.params.max_gap_px,
        );
        let stretch = Segment2::new(from, to);
        let index = &self.prepared.views[view.index()].index;
        let linker = LineLinker::predicted_image(reach * self.params.gate_px);
        let near = index.near_segment(&stretch, linker.apart);
        let on_line = near.into_iter().filter_map(|id| {
            let name = SegmentRef {
                view,
                segment: SegmentId(id),
            };
            let geometry = self.prepared.get(name)?;
            (self.compatibility.allows(geometry.kind, kind)
                && linker.connects(&stretch.ends(), &geometry.segment.ends())
                && !taken(name))
            .then_some((
                name,
                geometry.segment.direction().dot(&image.direction) > 0.0,
            ))
        });
        let (along, against): (Vec<_>, Vec<_>) =
            on_line.partition(|(_, along)| *along || !self.compatibility.contrast);
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
            let geometry = self.prepared.get(*s)?;
            for p in [geometry.segment.p0, geometry.segment.p1] {
                let t = image.t_of(&p);
                (from, to) = (from.min(t), to.max(t));
            }
        }
        let image = ProjectedLine::new(self.scene.camera(view), line)?;
        Some((image, Segment2::new(image.at(from)?, image.at(to)?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::params::{Lines3dParams, MatchParams};
    use crate::lines::linematch::segment_geometry::PreparedSegments;
    use crate::lines::lines3d::planted;

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
        let prepared = PreparedSegments::new(&scene, &segments);
        let context = MatchContext::of_planted(&scene, &segments, &prepared, (&params, &fitting));
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
        let adopted = |change: &dyn Fn(&mut Vec<crate::lines::lines2d::ImageSegment>)| {
            let mut segments = planted::segments(&scene);
            change(&mut segments[last.index()]);
            let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
            let prepared = PreparedSegments::new(&scene, &segments);
            let context =
                MatchContext::of_planted(&scene, &segments, &prepared, (&params, &fitting));
            let line = planted::edges()[0];
            let mut found = context.adopt(&line, &[own(first)], &[], 1.0, &|_| false);
            found.retain(|s| s.view == last);
            found
        };
        let reversed = |s: &crate::lines::lines2d::ImageSegment| {
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
