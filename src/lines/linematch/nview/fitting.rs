//! Lines fitted to segments or measured edges, the worst of which is dropped until the rest agree.

use super::context::{MIN_MEASURED, MatchContext, MatchRejection};
use crate::base::geometry::Segment3;
use crate::base::least_squares::Loss;
use crate::lines::linematch::segment_geometry::SegmentRef;
use crate::lines::lines2d::GuidedEdge;
use crate::lines::lines3d::{LineFit, Observation, fit_line};

impl MatchContext<'_> {
    /// [`Self::fit_consistent`] for measured edges.
    pub(super) fn fit_edges(
        &self,
        start: &Segment3,
        edges: &[GuidedEdge],
    ) -> Result<(LineFit, Vec<GuidedEdge>), MatchRejection> {
        let mut kept = edges.to_vec();
        loop {
            if kept.len() < MIN_MEASURED {
                return Err(MatchRejection::TooFewEdges);
            }
            let fit = fit_line(&self.observed(kept.iter()), start, self.fitting)
                .ok_or(MatchRejection::NoFit)?;
            match worst_residual(&fit.residuals) {
                Some(worst) if fit.residuals[worst] > self.fitting.max_residual => {
                    kept.remove(worst);
                }
                _ => return Ok((fit, kept)),
            }
        }
    }

    /// Fits the line to those segments that agree with each other: the worst is dropped and the
    /// line fitted again until none is farther than `max_residual`. The robust loss alone leaves a
    /// line between two parallel edges a pixel apart.
    pub(super) fn fit_consistent(
        &self,
        start: &Segment3,
        segments: &[SegmentRef],
    ) -> Result<(LineFit, Vec<SegmentRef>), MatchRejection> {
        let mut kept = segments.to_vec();
        loop {
            let fit = self.fit(start, &kept)?;
            let worst = worst_residual(&fit.residuals).ok_or(MatchRejection::NoFit)?;
            if fit.residuals[worst] <= self.fitting.max_residual {
                return Ok((fit, kept));
            }
            kept.remove(worst);
        }
    }

    /// How far each segment agrees with the line that fits those that agree best, 0 to 1: 1/2 at a
    /// standard deviation. `None` where nothing fits.
    pub(crate) fn agreement(&self, start: &Segment3, segments: &[SegmentRef]) -> Option<Vec<f64>> {
        let (fit, kept) = self.fit_consistent(start, segments).ok()?;
        let agrees = |s: &SegmentRef| {
            let i = kept.iter().position(|k| k == s)?;
            Some(Loss::Cauchy(1.0).weight(fit.residuals[i] * fit.residuals[i]))
        };
        Some(segments.iter().map(|s| agrees(s).unwrap_or(0.0)).collect())
    }

    fn fit(&self, start: &Segment3, segments: &[SegmentRef]) -> Result<LineFit, MatchRejection> {
        fit_line(&self.observations(segments), start, self.fitting).ok_or(MatchRejection::NoFit)
    }

    pub(super) fn observed<'e>(
        &self,
        edges: impl Iterator<Item = &'e GuidedEdge>,
    ) -> Vec<Observation<'_>> {
        edges
            .map(|e| Observation::of(e, self.scene.camera(e.view)))
            .collect()
    }

    fn observations(&self, segments: &[SegmentRef]) -> Vec<Observation<'_>> {
        segments
            .iter()
            .map(|s| {
                let detected = &self.segments[s.view.index()][s.segment.index()];
                Observation {
                    camera: self.scene.camera(s.view),
                    segment: detected.segment,
                    covariance: detected.covariance,
                }
            })
            .collect()
    }
}

/// The first of the largest residuals.
fn worst_residual(residuals: &[f64]) -> Option<usize> {
    (0..residuals.len()).max_by(|&i, &j| residuals[i].total_cmp(&residuals[j]).then(j.cmp(&i)))
}
