//! Which views support a line (B99 3.2).

use super::context::MatchContext;
use super::profile::{LineProfile, ViewProfile};
use crate::base::geometry::Segment2;
use crate::lines::linematch::line_strip::EdgelScore;
use crate::lines::lines3d::{LineSupport, SupportKind};

/// Length beyond the detected segments from which on a stretch counts as grown, px: more than a
/// piece of a measured edge.
const GROWN_PX: f64 = 6.0;

impl MatchContext<'_> {
    /// The views that support the stretch.
    pub(super) fn supports(
        &self,
        profile: &LineProfile,
        stretch: (usize, usize),
    ) -> Vec<LineSupport> {
        let mut supports: Vec<LineSupport> = (0..profile.views.len())
            .filter(|i| *i != profile.reference)
            .filter_map(|i| self.support(profile, &profile.views[i], stretch, None))
            .collect();
        // The reference view correlates fully with itself, so that its score is the mean of the
        // others.
        let mean = supports.iter().map(|s| s.score).sum::<f64>() / supports.len().max(1) as f64;
        let reference = &profile.views[profile.reference];
        supports.extend(self.support(profile, reference, stretch, Some(mean)));
        supports.sort_by_key(|s| s.view);
        supports
    }

    /// The support of one view: with an edge at the predicted position whatever it correlates by,
    /// which the line's evidence weighs; without one at one and a half times the score of a pair
    /// (B99 3.2).
    fn support(
        &self,
        profile: &LineProfile,
        view: &ViewProfile,
        (start, end): (usize, usize),
        score: Option<f64>,
    ) -> Option<LineSupport> {
        let (t0, t1) = (profile.t[start], profile.t[end]);
        let segments: Vec<_> = view
            .segments
            .iter()
            .filter(|(_, [s, e])| e.min(t1) - s.max(t0) >= 0.5 * (e - s).min(t1 - t0))
            .collect();
        let correlation = &view.correlation[start..=end];
        let seen = EdgelScore::of(correlation, self.params.edgel_correlation);
        let score = score.unwrap_or(seen.score);
        let measured = view.edge.is_some() || !segments.is_empty();
        let alike = score >= self.params.pair_score * self.params.without_segment
            && seen.included >= self.params.min_edgels;
        (measured || alike).then_some(())?;

        let supported: Vec<usize> = (start..=end)
            .filter(|&e| {
                view.detected[e] || f64::from(view.correlation[e]) >= self.params.edgel_correlation
            })
            .collect();
        let (first, last) = (*supported.first()?, *supported.last()?);
        let stretch = Segment2::new(
            view.image.at(profile.t[first])?,
            view.image.at(profile.t[last])?,
        );
        let outermost = segments
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(f, t), (_, [s, e])| {
                (f.min(s.max(t0)), t.max(e.min(t1)))
            });
        let detected_px = (outermost.1 - outermost.0)
            * (stretch.length() / (profile.t[last] - profile.t[first]).max(1e-9));
        let kind = match segments.len() {
            2.. => SupportKind::Merged,
            1 if stretch.length() <= detected_px + GROWN_PX => SupportKind::Matched,
            _ => SupportKind::Grown,
        };
        Some(LineSupport {
            view: view.view,
            segments: segments.iter().map(|(id, _)| *id).collect(),
            stretch,
            score: score.min(1.0),
            kind,
            edge: view.edge.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::ids::{SegmentId, ViewId};
    use crate::base::params::{Lines3dParams, MatchParams};
    use crate::lines::linematch::segment_geometry::PreparedSegments;
    use crate::lines::lines2d::{GuidedEdge, SegmentKind};
    use crate::lines::lines3d::{ProjectedLine, planted};

    /// The views that support a line: two with segments that correlate fully, and one more that
    /// correlates by so much, with an edge or without.
    fn beside_a_pair(with_edge: bool, third: f32) -> Vec<u32> {
        const EDGELS: usize = 100;
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let segments = planted::segments(&scene);
        let prepared = PreparedSegments::new(&scene, &segments);
        let context = MatchContext::of_planted(&scene, &segments, &prepared, (&params, &fitting));
        let view = |(index, correlation, shows): (usize, f32, bool)| ViewProfile {
            view: ViewId(index as u32),
            image: ProjectedLine::new(&scene.views[index].camera, &line).unwrap(),
            segments: match shows {
                true => vec![(SegmentId(0), [0.0, line.length()])],
                false => Vec::new(),
            },
            edge: shows.then(|| GuidedEdge {
                view: ViewId(index as u32),
                kind: SegmentKind::Edge,
                segment: planted::part_of(&scene, index, 0, 0.0, 1.0),
                covariance: nalgebra::Matrix2::identity(),
                pieces: Vec::new(),
            }),
            detected: vec![shows; EDGELS],
            inside: vec![true; EDGELS],
            correlation: vec![correlation; EDGELS],
            agreement: f64::from(correlation),
        };
        let step = line.length() / EDGELS as f64;
        let profile = LineProfile {
            t: (0..EDGELS).map(|e| e as f64 * step).collect(),
            reference: 0,
            views: [(0, 1.0, true), (1, 1.0, true), (3, third, with_edge)]
                .map(view)
                .into(),
        };
        let supports = context.supports(&profile, (0, EDGELS - 1));
        supports.iter().map(|s| s.view.0).collect()
    }

    #[test]
    fn an_edge_in_its_place_supports_a_line_and_without_one_the_views_have_to_be_alike() {
        assert_eq!(beside_a_pair(true, 0.0), [0, 1, 3]);
        assert_eq!(beside_a_pair(false, 0.9), [0, 1, 3]);
        assert_eq!(beside_a_pair(false, 0.2), [0, 1]);
    }
}
