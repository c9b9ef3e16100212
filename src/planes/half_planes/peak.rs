//! The maximum of a sampled `Sim(theta)`: position, curvature, uncertainty, acceptance (B99 figure
//! 12).

use nalgebra::{RowVector3, Vector1};

use super::trace::SweepRejection;
use crate::base::least_squares::{Equations, Loss, NormalEquations};
use crate::base::params::{Acceptance, SweepParams};

/// A parabola `value + slope (theta - at) + curvature (theta - at)^2 / 2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SimilarityParabola {
    /// Where the coefficients hold, radians.
    pub at: f64,
    /// Sim there.
    pub value: f64,
    /// Sim', per radian.
    pub slope: f64,
    /// Sim'', per radian squared.
    pub curvature: f64,
}

impl SimilarityParabola {
    /// Least squares over the samples (theta, Sim) within `reach` of `at`; `None` for fewer than
    /// three.
    pub(super) fn fit(
        samples: impl Iterator<Item = (f64, f64)>,
        at: f64,
        reach: f64,
    ) -> Option<Self> {
        let mut equations = NormalEquations::default();
        let mut count = 0;
        for (theta, sim) in samples {
            // In units of the reach, which keeps the normal equations well conditioned.
            let t = (theta - at) / reach;
            if t.abs() <= 1.0 + 1e-9 {
                let row = RowVector3::new(1.0, t, 0.5 * t * t);
                equations.add(&Vector1::new(-sim), &row, Loss::Squares);
                count += 1;
            }
        }
        if count < 3 {
            return None;
        }
        let c = equations.step(0.0)?;
        Some(Self {
            at,
            value: c.x,
            slope: c.y / reach,
            curvature: c.z / (reach * reach),
        })
    }

    /// Position and height of the maximum; `None` when the parabola opens upwards.
    pub(super) fn maximum(&self) -> Option<(f64, f64)> {
        (self.curvature < 0.0).then(|| {
            let step = -self.slope / self.curvature;
            (self.at + step, self.value + 0.5 * self.slope * step)
        })
    }
}

/// The numbers that B99 figure 12 tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Peak {
    /// Angle of the maximum, radians.
    pub theta: f64,
    /// `Sim(theta_max)`.
    pub similarity: f64,
    /// `|Sim''(theta_max)|`, per radian squared.
    pub curvature: f64,
    /// `Sim(theta_max) - Sim(theta_min)`.
    pub amplitude: f64,
}

impl Peak {
    /// Accepts the maximum by the printed thresholds, by its posterior probability, or by both.
    pub(super) fn accept(
        &self,
        probability: f64,
        params: &SweepParams,
    ) -> Result<(), SweepRejection> {
        // What passes the thresholds but is no likelier than not is rejected.
        const LIKELY: f64 = 0.5;
        let at_least = |least: f64| match probability >= least {
            true => Ok(()),
            false => Err(SweepRejection::Improbable),
        };
        match params.acceptance {
            Acceptance::Printed => self.check(params, 1.0),
            Acceptance::Posterior => at_least(params.min_probability),
            Acceptance::Both => match self.check(params, 1.0) {
                Ok(()) => at_least(LIKELY),
                Err(reason) => {
                    self.check(params, params.ambiguous_share)?;
                    at_least(params.min_probability).map_err(|_| reason)
                }
            },
        }
    }

    /// The three validity criteria of figure 12, each at this share of its threshold.
    fn check(&self, params: &SweepParams, share: f64) -> Result<(), SweepRejection> {
        if self.similarity < share * params.min_similarity {
            Err(SweepRejection::LowPeak)
        } else if self.curvature < share * params.min_curvature {
            Err(SweepRejection::FlatCurve)
        } else if self.amplitude < share * params.min_amplitude {
            Err(SweepRejection::SmallAmplitude)
        } else {
            Ok(())
        }
    }
}

/// Standard deviation of the maximum from the slopes of the single views' curves there, radians.
///
/// The maximum of a mean of n curves is where their slopes cancel; it moves by the error of the
/// mean slope over the curvature of the mean (the sandwich covariance of an M-estimator). Each
/// slope has an error of its own view, which their scatter s shows, and one of the reference view,
/// which all share and the scatter hides; the photographs being of one kind, it is taken to be as
/// large: `sigma = s sqrt(1/n + 1) / |Sim''|`. A single view has no scatter; its maximum is then
/// only known to lie within `reach`.
pub(crate) fn sigma_of_maximum(slopes: &[f64], curvature: f64, reach: f64) -> f64 {
    if slopes.len() < 2 {
        return reach;
    }
    let n = slopes.len() as f64;
    let mean = slopes.iter().sum::<f64>() / n;
    let squares: f64 = slopes.iter().map(|s| (s - mean) * (s - mean)).sum();
    (squares / (n - 1.0) * (1.0 / n + 1.0)).sqrt() / curvature.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planted_parabola_is_recovered() {
        let sim = |t: f64| 0.7 - 6.0 * (t - 0.31) * (t - 0.31);
        let samples = [0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.9].map(|t| (t, sim(t)));
        let p = SimilarityParabola::fit(samples.into_iter(), 0.3, 0.12).unwrap();
        let (theta, value) = p.maximum().unwrap();
        assert!((theta - 0.31).abs() < 1e-9 && (value - 0.7).abs() < 1e-9);
        assert!((p.curvature + 12.0).abs() < 1e-6);
        assert!(SimilarityParabola::fit(samples.into_iter(), 0.9, 0.1).is_none());
    }

    #[test]
    fn the_scatter_of_the_slopes_gives_sigma() {
        // Parabolas of equal curvature whose maxima scatter with the variance v: their mean has v /
        // 4, the shared reference adds v.
        let maxima = [0.1, 0.12, 0.14, 0.16];
        let slopes = maxima.map(|m: f64| 5.0 * (m - 0.13));
        let variance = maxima.iter().map(|m| (m - 0.13) * (m - 0.13)).sum::<f64>() / 3.0;
        let sigma = sigma_of_maximum(&slopes, -5.0, 0.1);
        assert!((sigma - (variance * 1.25).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn the_posterior_decides_where_a_threshold_is_nearly_reached() {
        let of = |acceptance| SweepParams {
            acceptance,
            ..SweepParams::default()
        };
        let peak = |similarity| Peak {
            theta: 0.0,
            similarity,
            curvature: 8.0,
            amplitude: 0.3,
        };
        use Acceptance::{Both, Posterior, Printed};
        use SweepRejection::{Improbable, LowPeak};
        for (acceptance, similarity, probability, expected) in [
            (Printed, 0.6, 0.0, Ok(())),
            (Printed, 0.3, 1.0, Err(LowPeak)),
            (Posterior, 0.1, 0.99, Ok(())),
            (Posterior, 0.6, 0.9, Err(Improbable)),
            (Both, 0.6, 0.6, Ok(())),
            (Both, 0.6, 0.4, Err(Improbable)),
            (Both, 0.3, 0.99, Ok(())),
            (Both, 0.3, 0.9, Err(LowPeak)),
            (Both, 0.1, 1.0, Err(LowPeak)),
        ] {
            let found = peak(similarity).accept(probability, &of(acceptance));
            assert_eq!(found, expected, "{acceptance:?} {similarity} {probability}");
        }
    }

    #[test]
    fn each_criterion_rejects_by_itself() {
        let params = SweepParams::default();
        let good = Peak {
            theta: 0.0,
            similarity: 0.6,
            curvature: 8.0,
            amplitude: 0.3,
        };
        assert_eq!(good.check(&params, 1.0), Ok(()));
        let check = |peak: Peak| peak.check(&params, 1.0).unwrap_err();
        assert_eq!(
            check(Peak {
                similarity: 0.39,
                ..good
            }),
            SweepRejection::LowPeak
        );
        assert_eq!(
            check(Peak {
                curvature: 3.9,
                ..good
            }),
            SweepRejection::FlatCurve
        );
        assert_eq!(
            check(Peak {
                amplitude: 0.19,
                ..good
            }),
            SweepRejection::SmallAmplitude
        );
    }
}
