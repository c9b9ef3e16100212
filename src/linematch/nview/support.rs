//! Which views support a line, and which show another edge (B99 3.2).

use super::context::{MIN_MEASURED, MatchContext};
use super::profile::{LineProfile, ViewProfile};
use crate::geometry::Segment2;
use crate::ids::ViewId;
use crate::linematch::line_strip::EdgelScore;
use crate::lines3d::{LineSupport, SupportKind};
use crate::params::MatchParams;

/// Length beyond the detected segments from which on a stretch counts as grown, px: more than a
/// piece of a measured edge.
const GROWN_PX: f64 = 6.0;

/// Views with segments on the line that show another edge nearby: those without photometric
/// support and, where the mean score of the views is too low, the one least like the others.
///
/// A wrong view displaces the line and with it the windows of the right ones, so one is left out
/// at a time. Three edges may meet in a line by chance: they must correlate like a pair, or two of
/// them so well that they need no third ([`pair_suffices`]). From the fourth on half of that
/// suffices, as for any segment at a predicted position (B99 3.2).
pub(super) fn disagreeing_views(
    profile: &LineProfile,
    supports: &[LineSupport],
    params: &MatchParams,
) -> Vec<ViewId> {
    let measured = profile.views.iter().filter(|v| v.measured());
    let mean = supports.iter().map(|s| s.score).sum::<f64>() / supports.len().max(1) as f64;
    if mean < least_mean(profile.measured(), params) && !pair_suffices(profile, supports, params) {
        let worst = measured.min_by(|a, b| a.agreement.total_cmp(&b.agreement));
        return worst.map(|v| v.view).into_iter().collect();
    }
    let supported = |v: &&ViewProfile| supports.iter().any(|s| s.view == v.view);
    measured.filter(|v| !supported(v)).map(|v| v.view).collect()
}

/// Do two of three edges correlate as well as two without a verifying segment must (B99 3.2)? Then
/// the position of the segment in the third view suffices: the other strip may see an eave before
/// another ground and its roof in another light.
fn pair_suffices(profile: &LineProfile, supports: &[LineSupport], params: &MatchParams) -> bool {
    let reference = profile.views[profile.reference].view;
    let mut others = supports
        .iter()
        .filter(|s| s.edge.is_some() && s.view != reference);
    let least = params.pair_score * params.without_segment;
    profile.measured() == MIN_MEASURED && others.any(|s| s.score >= least)
}

/// Least mean score of the supports of a line, given the number of views with an edge.
fn least_mean(measured: usize, params: &MatchParams) -> f64 {
    let factor = match measured > MIN_MEASURED {
        true => params.with_segment,
        false => 1.0,
    };
    params.pair_score * factor
}

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

    /// The support of one view, with a segment at half the threshold, without at one and a half
    /// (B99 3.2). A view with a segment among three edges has no threshold here:
    /// [`disagreeing_views`] tests the three together.
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
        let one_of_three = profile.measured() == MIN_MEASURED && view.measured();
        let factor = match (measured, one_of_three && !segments.is_empty()) {
            (_, true) => 0.0,
            (true, false) => self.params.with_segment,
            (false, false) => self.params.without_segment,
        };
        let enough = measured || seen.included >= self.params.min_edgels;
        (enough && score >= self.params.pair_score * factor).then_some(())?;

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
    use crate::ids::SegmentId;
    use crate::linematch::segment_geometry::PreparedSegments;
    use crate::lines2d::{GuidedEdge, SegmentKind};
    use crate::lines3d::{ProjectedLine, planted};
    use crate::params::Lines3dParams;

    /// The views that support the line and those that are left out, of three views with edges: two
    /// that correlate by `pair`, and one without correlation, with or without a segment of its
    /// own.
    fn beside_a_pair(own_segment: bool, pair: f32) -> (Vec<u32>, Vec<ViewId>) {
        const EDGELS: usize = 100;
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let segments = planted::segments(&scene);
        let prepared = PreparedSegments::new(&scene, &segments);
        let context = MatchContext::of_planted(&scene, &segments, &prepared, (&params, &fitting));
        let view = |(index, correlation): (usize, f32)| ViewProfile {
            view: ViewId(index as u32),
            image: ProjectedLine::new(&scene.views[index].camera, &line).unwrap(),
            segments: match own_segment || correlation > 0.0 {
                true => vec![(SegmentId(0), [0.0, line.length()])],
                false => Vec::new(),
            },
            edge: Some(GuidedEdge {
                view: ViewId(index as u32),
                kind: SegmentKind::Edge,
                segment: planted::part_of(&scene, index, 0, 0.0, 1.0),
                covariance: nalgebra::Matrix2::identity(),
                pieces: Vec::new(),
            }),
            detected: vec![true; EDGELS],
            inside: vec![true; EDGELS],
            correlation: vec![correlation; EDGELS],
            agreement: f64::from(correlation),
        };
        let step = line.length() / EDGELS as f64;
        let profile = LineProfile {
            t: (0..EDGELS).map(|e| e as f64 * step).collect(),
            reference: 0,
            views: [(0, 1.0), (1, pair), (3, 0.0)].map(view).into(),
        };
        let supports = context.supports(&profile, (0, EDGELS - 1));
        let left_out = disagreeing_views(&profile, &supports, &params);
        (supports.iter().map(|s| s.view.0).collect(), left_out)
    }

    #[test]
    fn a_segment_in_its_place_verifies_two_views_that_are_very_alike() {
        assert_eq!(beside_a_pair(true, 0.8), (vec![0, 1, 3], vec![]));
        let third = vec![ViewId(3)];
        assert_eq!(beside_a_pair(true, 0.7).1, third, "not alike enough");
        assert_eq!(beside_a_pair(false, 0.8).1, third, "no segment");
    }

    /// The views left out of a line whose first `count` views have edges and score `score`.
    fn left_out(count: usize, score: f64) -> Vec<ViewId> {
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let edge = |view: usize| GuidedEdge {
            view: ViewId(view as u32),
            kind: SegmentKind::Edge,
            segment: planted::part_of(&scene, view, 0, 0.1, 0.9),
            covariance: nalgebra::Matrix2::identity(),
            pieces: Vec::new(),
        };
        let views = (0..count).map(|view| ViewProfile {
            view: ViewId(view as u32),
            image: ProjectedLine::new(&scene.views[view].camera, &line).unwrap(),
            segments: Vec::new(),
            edge: Some(edge(view)),
            detected: Vec::new(),
            inside: Vec::new(),
            correlation: Vec::new(),
            agreement: [0.4, 0.2, 0.3, 0.5, 0.6][view],
        });
        let profile = LineProfile {
            t: Vec::new(),
            reference: 0,
            views: views.collect(),
        };
        let supports = (0..count).map(|view| LineSupport {
            view: ViewId(view as u32),
            segments: Vec::new(),
            stretch: planted::part_of(&scene, view, 0, 0.1, 0.9),
            score,
            kind: SupportKind::Matched,
            edge: Some(edge(view)),
        });
        disagreeing_views(
            &profile,
            &supports.collect::<Vec<_>>(),
            &MatchParams::default(),
        )
    }

    #[test]
    fn three_edges_have_to_be_as_alike_as_a_pair_and_more_half_as_much() {
        let least_alike = vec![ViewId(1)];
        assert_eq!(left_out(3, 0.55), []);
        assert_eq!(left_out(3, 0.45), least_alike);
        assert_eq!(left_out(4, 0.45), []);
        assert_eq!(left_out(5, 0.3), []);
        assert_eq!(left_out(5, 0.2), least_alike);
    }
}
