//! The last tests of a completed line (B99 3.4).

use super::context::{CompletedLine, MIN_MEASURED, MatchContext, MatchRejection};
use super::profile::{LineProfile, ViewProfile};
use crate::lines3d::{LineFit, LineSupport, conditioning};
use crate::params::MatchParams;

/// Number of views of a line from which on [`MatchParams::min_views`] must support it (B99 3.4).
pub const MANY_VIEWS: usize = 6;

impl MatchContext<'_> {
    /// Number of views that must support the line: `min_views` where many see it.
    pub(super) fn expected_views(
        &self,
        profile: &LineProfile,
        (start, end): (usize, usize),
    ) -> usize {
        let middle = 0.5 * (profile.t[start] + profile.t[end]);
        let sees = |v: &&ViewProfile| {
            let x = v.image.at(middle);
            x.is_some_and(|x| self.scene.camera(v.view).contains(&x, 1.0))
        };
        let seeing = profile.views.iter().filter(sees).count();
        if seeing >= MANY_VIEWS {
            self.params.min_views
        } else {
            MIN_MEASURED
        }
    }

    /// The last tests of a completed line, with the stretch t0 to t1 (metres) of the fit.
    ///
    /// Where four of six views are required (B99 3.4), three pass if their mean score is that of a
    /// pair without a third view: the finished model knows how many views can see the line, and
    /// then requires the fourth ([`crate::buildings::verify_lines`]).
    pub(super) fn check_line(
        &self,
        fit: LineFit,
        [t0, t1]: [f64; 2],
        expected_views: usize,
        supports: Vec<LineSupport>,
    ) -> Result<CompletedLine, MatchRejection> {
        let length = fit.line.length();
        let segment = fit.line.stretch(t0, t1);
        let camera = self.scene.camera(supports[0].view);
        let pixel_m = camera.ground_pixel(&segment.p0);
        let length_px = segment.length() / pixel_m;
        let largest_m = self.fitting.largest_sigma_px(length_px) * pixel_m;
        if fit.sigma_at(t0 / length).max(fit.sigma_at(t1 / length)) > largest_m {
            return Err(MatchRejection::IllConditioned);
        }
        let score = supports.iter().map(|s| s.score).sum::<f64>() / supports.len() as f64;
        if !self.every_view_verified(&fit, [t0, t1], &supports, 2.0 * largest_m) {
            return Err(MatchRejection::Unverified);
        }
        let measured = supports.iter().filter(|s| s.edge.is_some()).count();
        let well_correlated = score >= self.params.pair_score;
        if measured < MIN_MEASURED || (supports.len() < expected_views && !well_correlated) {
            return Err(MatchRejection::TooFewViews);
        }
        // The shorter a line, the more easily the one view that verifies two others agrees by
        // chance.
        if measured == MIN_MEASURED && length_px < 2.0 * self.params.min_edgels as f64 {
            return Err(MatchRejection::TooShort);
        }
        let [low, high] = self.z_range;
        if [segment.p0.z, segment.p1.z]
            .iter()
            .any(|z| *z < low || *z > high)
        {
            return Err(MatchRejection::OutsideHeights);
        }
        Ok(CompletedLine {
            segment,
            fit,
            supports,
        })
    }

    /// Is every view verified by its score or by the others? Each is left out in turn; `limit_m`
    /// is the largest standard deviation that the others may leave.
    fn every_view_verified(
        &self,
        fit: &LineFit,
        [t0, t1]: [f64; 2],
        supports: &[LineSupport],
        limit_m: f64,
    ) -> bool {
        let line = fit.line.stretch(t0, t1);
        let sigma_without = |left_out: &LineSupport| {
            let others = supports.iter().filter(|s| s.view != left_out.view);
            let edges = others.filter_map(|s| s.edge.as_ref());
            conditioning(&self.observed(edges), &line, self.fitting)
                .map_or(f64::INFINITY, |c| c.sigma_at(0.0).max(c.sigma_at(1.0)))
        };
        let few = self.scene.views.len() <= self.params.min_views;
        let least = |uncertainty| least_score(uncertainty, few, self.params);
        let mut measured = supports.iter().filter(|s| s.edge.is_some());
        measured.all(|s| {
            s.score >= least(f64::INFINITY) || s.score >= least(sigma_without(s) / limit_m)
        })
    }
}

/// Least score of a view with an edge, given the uncertainty that the others leave, as a share of
/// the limit.
///
/// Where the others determine the line, the edge is a measurement at the predicted position. Where
/// they do not, any parallel edge would fit, and its grey values must agree as much as without an
/// edge. With `few` views the least score rises with the uncertainty in between; six views do not
/// need that.
fn least_score(uncertainty: f64, few: bool, params: &MatchParams) -> f64 {
    let without_edge = params.pair_score * params.without_segment;
    if uncertainty <= 1.0 {
        return f64::NEG_INFINITY;
    }
    if !few || uncertainty >= 2.0 {
        return without_edge;
    }
    params.pair_score + (without_edge - params.pair_score) * (uncertainty - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::ViewId;
    use crate::linematch::segment_geometry::PreparedSegments;
    use crate::lines2d::{GuidedEdge, SegmentKind};
    use crate::lines3d::{ProjectedLine, SupportKind, fit_line, planted};
    use crate::params::Lines3dParams;

    /// The rejection of a line that `count` views with edges support at this score where
    /// `expected` views should.
    fn checked(count: usize, expected: usize, score: f64) -> Option<MatchRejection> {
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let segments = planted::segments(&scene);
        let prepared = PreparedSegments::new(&scene, &segments);
        let context = MatchContext::of_planted(&scene, &segments, &prepared, (&params, &fitting));
        // Any two of the first three determine it.
        let edges: Vec<GuidedEdge> = [0, 1, 4, 2, 3][..count]
            .iter()
            .map(|&view| GuidedEdge {
                view: ViewId(view as u32),
                kind: SegmentKind::Edge,
                segment: planted::part_of(&scene, view, 0, 0.0, 1.0),
                covariance: nalgebra::Matrix2::new(1e-3, 0.0, 0.0, 1e-6),
                pieces: Vec::new(),
            })
            .collect();
        let fit = fit_line(&context.observed(edges.iter()), &line, &fitting).expect("a line");
        let support = |edge: &GuidedEdge| LineSupport {
            view: edge.view,
            segments: Vec::new(),
            stretch: edge.segment,
            score,
            kind: SupportKind::Matched,
            edge: Some(edge.clone()),
        };
        let supports = edges.iter().map(support).collect();
        let ends = [0.0, line.length()];
        context.check_line(fit, ends, expected, supports).err()
    }

    #[test]
    fn too_few_views_have_to_be_as_alike_as_a_pair() {
        let too_few = Some(MatchRejection::TooFewViews);
        assert_eq!(checked(4, 4, 0.4), None, "four of four");
        assert_eq!(checked(3, 4, 0.4), too_few, "three of four");
        assert_eq!(checked(3, 3, 0.4), None, "three of three");
        assert_eq!(checked(3, 4, 0.5), None, "three that a pair would do with");
    }

    #[test]
    fn four_views_are_expected_where_six_see_a_line() {
        let places = [0.0, 8.0, 16.0, 24.0, 32.0, 40.0].map(|x| (x, 0.0, 0.0));
        let expected = |count: usize, looks_away: usize| {
            let mut scene = planted::views_from(&places[..count]);
            for view in &mut scene.views[..looks_away] {
                view.camera.k[(0, 2)] += 1000.0;
            }
            let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
            let prepared = PreparedSegments { views: Vec::new() };
            let context = MatchContext::of_planted(&scene, &[], &prepared, (&params, &fitting));
            let line = planted::edges()[0];
            let view = |index: usize| ViewProfile {
                view: ViewId(index as u32),
                image: ProjectedLine::new(&scene.views[index].camera, &line).unwrap(),
                segments: Vec::new(),
                edge: None,
                detected: Vec::new(),
                inside: Vec::new(),
                correlation: Vec::new(),
                agreement: 0.0,
            };
            let profile = LineProfile {
                t: vec![0.0, line.length()],
                reference: 0,
                views: (0..count).map(view).collect(),
            };
            context.expected_views(&profile, (0, 1))
        };
        assert_eq!([expected(6, 0), expected(5, 0)], [4, 3]);
        assert_eq!(expected(6, 1), 3, "the sixth looks elsewhere");
    }

    #[test]
    fn the_less_certain_the_others_the_more_a_view_has_to_agree() {
        let params = MatchParams::default();
        let (pair, unverified) = (0.5, 0.75);
        for few in [false, true] {
            assert!(least_score(0.9, few, &params) < 0.0);
            assert_eq!(least_score(2.5, few, &params), unverified);
            assert_eq!(least_score(f64::INFINITY, few, &params), unverified);
        }
        assert_eq!(least_score(1.5, false, &params), unverified);
        assert!((least_score(1.0 + 1e-9, true, &params) - pair).abs() < 1e-6);
        assert!((least_score(1.4, true, &params) - 0.6).abs() < 1e-12);
    }
}
