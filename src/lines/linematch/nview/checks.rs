//! The last step of a completed line (B99 3.4): what speaks for it, weighed once.

use super::context::{CompletedLine, MatchContext, MatchRejection};
use super::profile::{LineProfile, ViewProfile};
use crate::base::evidence::EvidenceModel;
use crate::base::geometry::Segment3;
use crate::base::math::{asin, ln};
use crate::lines::lines3d::{LineFit, LineSupport, conditioning};

/// Largest standard deviation that the views leave without one of them, ground pixels: more is as
/// good as undetermined.
const UNDETERMINED_PX: f64 = 99.0;

impl MatchContext<'_> {
    /// Number of views that see the middle of a stretch of a profile.
    pub(super) fn seeing_views(
        &self,
        profile: &LineProfile,
        (start, end): (usize, usize),
    ) -> usize {
        let middle = 0.5 * (profile.t[start] + profile.t[end]);
        let sees = |v: &&ViewProfile| {
            let x = v.image.at(middle);
            x.is_some_and(|x| self.scene.camera(v.view).contains(&x, 1.0))
        };
        profile.views.iter().filter(sees).count()
    }

    /// The completed line between t0 and t1 (metres) of the fit, if it is likelier true than false.
    pub(super) fn judge_line(
        &self,
        fit: LineFit,
        [t0, t1]: [f64; 2],
        seeing: usize,
        supports: Vec<LineSupport>,
    ) -> Result<CompletedLine, MatchRejection> {
        let segment = fit.line.stretch(t0, t1);
        let pixel_m = self
            .scene
            .camera(supports[0].view)
            .ground_pixel(&segment.p0);
        let length_px = segment.length() / pixel_m;
        let length = fit.line.length();
        let sigma_px = fit.sigma_at(t0 / length).max(fit.sigma_at(t1 / length)) / pixel_m;
        if sigma_px > self.fitting.largest_sigma_px(length_px) {
            return Err(MatchRejection::IllConditioned);
        }
        let [low, high] = self.z_range;
        if [segment.p0.z, segment.p1.z]
            .iter()
            .any(|z| *z < low || *z > high)
        {
            return Err(MatchRejection::OutsideHeights);
        }
        let measured = supports.iter().filter(|s| s.edge.is_some()).count();
        let score = supports.iter().map(|s| s.score).sum::<f64>() / supports.len() as f64;
        let squares: f64 = fit.residuals.iter().map(|r| r * r).sum();
        let without_px = self.sigma_without_a_view(&segment, &supports) / pixel_m;
        let slope = asin(segment.direction().z.abs().min(1.0)).to_degrees();
        let evidence = EvidenceModel::of_lines().weigh(&[
            ("missing_views", seeing.saturating_sub(measured) as f64),
            ("correlation", score),
            (
                "ln_sigma_without_a_view_px",
                ln(without_px.clamp(1e-3, UNDETERMINED_PX)),
            ),
            (
                "residual_rms_sigmas",
                (squares / fit.residuals.len() as f64).sqrt(),
            ),
            ("slope_deg", slope),
        ]);
        match evidence.accepts(self.params.least_nats) {
            true => Ok(CompletedLine {
                segment,
                fit,
                supports,
                evidence,
            }),
            false => Err(MatchRejection::Improbable),
        }
    }

    /// Standard deviation of a line across itself, metres, if the view were missing without which
    /// it is determined worst: large where a single view determines it in some direction, in which
    /// any parallel edge would fit.
    fn sigma_without_a_view(&self, line: &Segment3, supports: &[LineSupport]) -> f64 {
        let sigma_without = |left_out: &LineSupport| {
            let others = supports.iter().filter(|s| s.view != left_out.view);
            let edges = others.filter_map(|s| s.edge.as_ref());
            conditioning(&self.observed(edges), line, self.fitting)
                .map_or(f64::INFINITY, |c| c.sigma_at(0.0).max(c.sigma_at(1.0)))
        };
        let measured = supports.iter().filter(|s| s.edge.is_some());
        measured
            .map(sigma_without)
            .fold(0.0, crate::base::math::larger)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::ids::ViewId;
    use crate::base::params::{Lines3dParams, MatchParams};
    use crate::lines::linematch::segment_geometry::PreparedSegments;
    use crate::lines::lines2d::{GuidedEdge, SegmentKind};
    use crate::lines::lines3d::{ProjectedLine, SupportKind, fit_line, planted};

    /// The probability of a line that `views` with edges support at this score where so many see
    /// it; `None` if it is rejected.
    fn judged(views: &[usize], seeing: usize, score: f64) -> Option<f64> {
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let segments = planted::segments(&scene);
        let prepared = PreparedSegments::new(&scene, &segments);
        let context = MatchContext::of_planted(&scene, &segments, &prepared, (&params, &fitting));
        let edges: Vec<GuidedEdge> = (views.iter())
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
        let completed = context.judge_line(fit, [0.0, line.length()], seeing, supports);
        completed.ok().map(|line| line.evidence.probability())
    }

    #[test]
    fn a_line_is_the_likelier_the_more_of_its_views_show_it_and_agree() {
        let views = [0, 1, 4, 2, 3];
        let sure = judged(&views, 5, 0.9).expect("five of five views");
        assert!(sure > 0.95, "{sure}");
        let missed = judged(&views, 9, 0.9).expect("four views do not show it");
        let unlike = judged(&views, 5, 0.5).expect("its sides differ");
        assert!(missed < sure && unlike < sure, "{missed} {unlike}");
    }

    #[test]
    fn a_line_that_one_view_alone_determines_is_less_likely() {
        // Any two of the first three determine it; of the others one view is needed for that.
        let verified = judged(&[0, 1, 4], 3, 0.8).expect("three views");
        let needed = judged(&[0, 1, 2], 3, 0.8).unwrap_or(0.0);
        assert!(needed < verified, "{needed} {verified}");
    }

    #[test]
    fn views_that_look_elsewhere_do_not_miss_a_line() {
        let places = [0.0, 8.0, 16.0, 24.0, 32.0, 40.0].map(|x| (x, 0.0, 0.0));
        let seeing = |looks_away: usize| {
            let mut scene = planted::views_from(&places);
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
                views: (0..places.len()).map(view).collect(),
            };
            context.seeing_views(&profile, (0, 1))
        };
        assert_eq!([seeing(0), seeing(1)], [6, 5]);
    }
}
