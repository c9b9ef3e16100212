//! The search over theta (B99 4.1).
//!
//! "The algorithm used is recursive sub-division with a termination criterion of `Delta theta < 1`
//! degree." A first pass samples the whole interval; the highest maxima are then halved down to the
//! last step, and a parabola through the finest samples gives theta.
//!
//! Valid views: whether a view is valid depends on theta, since an occluded view agrees with no
//! plane or with a wrong one. The sum over the views valid at each theta selects the maximum; the
//! views valid there are then kept for the whole curve, so that Sim is continuous, and averaged.

use super::half_plane::HalfPlane;
use super::peak::{Peak, SimilarityParabola, sigma_of_maximum};
use super::posterior::Posterior;
use super::similarity::{LineSide, ViewScore};
use super::trace::{SimilarityCurve, SweepRejection, ViewCurve};
use crate::base::ids::LineId;
use crate::base::params::SweepParams;
use crate::lines::lines3d::{Line3d, Side};

/// All views at one angle.
struct ThetaSample {
    theta: f64,
    /// One entry a view of [`LineSide::others`].
    scores: Vec<ViewScore>,
}

/// Samples of one line side, ordered by theta.
pub(super) struct ThetaSearch<'a> {
    pub line_side: LineSide<'a>,
    params: &'a SweepParams,
    samples: Vec<ThetaSample>,
    /// The views that count, by position in [`LineSide::others`].
    pub valid: Vec<bool>,
}

/// An accepted maximum.
pub(super) struct AcceptedPeak {
    peak: Peak,
    sigma_theta: f64,
    probability: f64,
}

impl<'a> ThetaSearch<'a> {
    pub(super) fn new(line_side: LineSide<'a>, params: &'a SweepParams) -> Self {
        let valid = vec![false; line_side.others.len()];
        Self {
            line_side,
            params,
            samples: Vec::new(),
            valid,
        }
    }

    /// First pass, subdivision, validity, acceptance.
    pub(super) fn run(&mut self) -> Result<AcceptedPeak, SweepRejection> {
        // Steps of nothing would never end.
        const LEAST_STEP_DEG: f64 = 0.05;
        let max_deg = self.params.max_theta_deg.clamp(0.0, 89.0);
        let steps = (max_deg / self.params.first_step_deg.max(LEAST_STEP_DEG))
            .ceil()
            .max(1.0);
        let step = (max_deg / steps).to_radians();
        let last_step = self.params.last_step_deg.max(LEAST_STEP_DEG).to_radians();
        let steps = steps as i32;
        for i in -steps..=steps {
            self.evaluate(step * f64::from(i));
        }
        for theta in self.highest_maxima() {
            self.subdivide(theta, step, last_step);
        }
        let best = self.best().ok_or(SweepRejection::NoValidView)?;
        self.valid = self.valid_at(best);
        self.accept(best, step)
    }

    /// Samples all views at an angle, unless the reference view cannot see the half-plane there.
    pub(super) fn evaluate(&mut self, theta: f64) {
        let place = self.samples.partition_point(|s| s.theta < theta);
        let known = self.samples.get(place).is_some_and(|s| s.theta == theta);
        if known || !self.line_side.is_visible(theta) {
            return;
        }
        let scores = (0..self.line_side.others.len())
            .map(|i| self.line_side.score(self.line_side.others[i], theta))
            .collect();
        self.samples.insert(place, ThetaSample { theta, scores });
    }

    /// Halves the step around the highest sample near `theta` until it is below the last step.
    fn subdivide(&mut self, theta: f64, first_step: f64, last_step: f64) {
        let mut step = first_step;
        let mut centre = theta;
        while step >= last_step {
            step *= 0.5;
            let mut best = (f64::NEG_INFINITY, centre);
            for theta in [centre - step, centre, centre + step] {
                self.evaluate(theta);
                if let Some(i) = self.samples.iter().position(|s| s.theta == theta) {
                    let sum = self.valid_sum(i);
                    if sum > best.0 {
                        best = (sum, theta);
                    }
                }
            }
            centre = best.1;
        }
    }

    /// Angles of the highest local maxima of the sum over valid views, highest first.
    fn highest_maxima(&self) -> Vec<f64> {
        let sums: Vec<f64> = (0..self.samples.len()).map(|i| self.valid_sum(i)).collect();
        let mut maxima: Vec<usize> = (0..sums.len())
            .filter(|&i| {
                sums[i] > 0.0
                    && (i == 0 || sums[i] > sums[i - 1])
                    && (i + 1 == sums.len() || sums[i] >= sums[i + 1])
            })
            .collect();
        maxima.sort_by(|&a, &b| sums[b].total_cmp(&sums[a]).then(a.cmp(&b)));
        let highest = maxima.first().map_or(0.0, |&i| sums[i]);
        maxima.truncate(self.params.max_peaks);
        // Half a step from its top, a peak still has half its height.
        maxima.retain(|&i| sums[i] >= 0.5 * highest);
        maxima.iter().map(|&i| self.samples[i].theta).collect()
    }

    /// The sample with the largest sum over its valid views; `None` when none has enough of them.
    pub(super) fn best(&self) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        for i in 0..self.samples.len() {
            let sum = self.valid_sum(i);
            if sum > best.map_or(0.0, |b| b.1) {
                best = Some((i, sum));
            }
        }
        best.map(|b| b.0)
    }

    /// Which views are valid at a sample: enough of their correlations are high.
    pub(super) fn valid_at(&self, sample: usize) -> Vec<bool> {
        let scores = &self.samples[sample].scores;
        scores
            .iter()
            .map(|s| s.high >= self.params.min_high_share)
            .collect()
    }

    /// Sum of the similarities of the views valid at a sample; 0 when there are too few.
    fn valid_sum(&self, sample: usize) -> f64 {
        let valid = self.samples[sample]
            .scores
            .iter()
            .filter(|s| s.high >= self.params.min_high_share);
        let (count, sum) = valid.fold((0, 0.0), |(n, sum), s| (n + 1, sum + s.similarity));
        if count >= self.params.min_valid_views {
            sum
        } else {
            0.0
        }
    }

    /// `Sim` at a sample over the views that count.
    fn similarity(&self, sample: &ThetaSample) -> f64 {
        let views = sample.scores.iter().zip(&self.valid).filter(|(_, v)| **v);
        let (count, sum) = views.fold((0.0, 0.0), |(n, sum), (s, _)| (n + 1.0, sum + s.similarity));
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Fits the maximum near a sample and tests it.
    fn accept(&self, best: usize, step: f64) -> Result<AcceptedPeak, SweepRejection> {
        if best == 0 || best + 1 == self.samples.len() {
            return Err(SweepRejection::AtIntervalEnd);
        }
        let at = self.samples[best].theta;
        let curve = || self.samples.iter().map(|s| (s.theta, self.similarity(s)));
        let wide =
            SimilarityParabola::fit(curve(), at, step).ok_or(SweepRejection::AtIntervalEnd)?;
        let reach = step * 0.5;
        let narrow = SimilarityParabola::fit(curve(), at, reach).unwrap_or(wide);
        let (theta, similarity) = narrow.maximum().ok_or(SweepRejection::FlatCurve)?;
        let lowest = curve().map(|(_, sim)| sim).fold(f64::INFINITY, f64::min);
        let peak = Peak {
            theta: theta.clamp(at - reach, at + reach),
            similarity: similarity.min(1.0),
            curvature: -wide.curvature,
            amplitude: similarity - lowest,
        };
        let probability = self.probability(peak.theta, step);
        peak.accept(probability, self.params)?;
        let slopes: Vec<f64> = (0..self.valid.len())
            .filter(|&v| self.valid[v])
            .filter_map(|v| {
                let curve = self
                    .samples
                    .iter()
                    .map(|s| (s.theta, s.scores[v].similarity));
                SimilarityParabola::fit(curve, peak.theta, reach).map(|p| p.slope)
            })
            .collect();
        Ok(AcceptedPeak {
            peak,
            sigma_theta: sigma_of_maximum(&slopes, narrow.curvature, reach),
            probability,
        })
    }

    /// Posterior probability of a plane within `reach` of `theta`.
    fn probability(&self, theta: f64, reach: f64) -> f64 {
        let thetas: Vec<f64> = self.samples.iter().map(|s| s.theta).collect();
        self.posterior(&thetas).probability(&thetas, theta, reach)
    }

    fn posterior(&self, thetas: &[f64]) -> Posterior {
        let sum = |s: &ThetaSample| s.scores.iter().map(|v| v.evidence).sum();
        let evidence: Vec<f64> = self.samples.iter().map(sum).collect();
        Posterior::new(thetas, &evidence)
    }

    pub(super) fn curve(&self) -> SimilarityCurve {
        let views = self
            .line_side
            .others
            .iter()
            .enumerate()
            .map(|(v, &view)| ViewCurve {
                view,
                valid: self.valid.get(v).copied().unwrap_or(false),
                similarity: self
                    .samples
                    .iter()
                    .map(|s| s.scores[v].similarity)
                    .collect(),
            });
        let thetas: Vec<f64> = self.samples.iter().map(|s| s.theta).collect();
        SimilarityCurve {
            reference: Some(self.line_side.reference),
            points: self.line_side.points(),
            posterior: self.posterior(&thetas),
            thetas,
            similarity: self.samples.iter().map(|s| self.similarity(s)).collect(),
            views: views.collect(),
        }
    }
}

impl AcceptedPeak {
    pub(super) fn half_plane(
        &self,
        search: &ThetaSearch,
        id: LineId,
        line: &Line3d,
        side: Side,
    ) -> HalfPlane {
        let line_side = &search.line_side;
        let plane = line_side.frame.plane(&line.segment, self.peak.theta);
        // A line that lies above its plane by e tilts the plane that fits its neighbourhood by
        // e / distance. The ends count as independent, so the middle has a quarter of their sum.
        let ends = line.covariance[0] + line.covariance[1];
        let height_m = 0.5 * plane.normal.dot(&(ends * plane.normal)).max(0.0).sqrt();
        let from_line = height_m * crate::base::math::cos(self.peak.theta) / line_side.lever_m();
        let views = line_side.others.iter().zip(&search.valid);
        HalfPlane {
            line: id,
            side,
            theta: self.peak.theta,
            sigma_theta: crate::base::math::hypot(self.sigma_theta, from_line),
            similarity: self.peak.similarity,
            curvature: self.peak.curvature,
            amplitude: self.peak.amplitude,
            probability: self.probability,
            views: views.filter(|(_, v)| **v).map(|(&id, _)| id).collect(),
            plane,
        }
    }
}
