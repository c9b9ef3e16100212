//! Robust estimation: a model that explains most of some observations, though many of them are
//! wrong.
//!
//! Hypotheses from minimal samples (Fischler, Bolles 1981) are scored by a likelihood ratio instead
//! of a count within a threshold. An observation with normalised residual r is
//!
//! ```text
//! ln((1 - g) + g q(r)),   q(r) = p(r | inlier) / p(r | outlier)
//! ```
//!
//! nats likelier with the model than without any; its standard deviation is unknown, so p(r |
//! inlier) is the mean over three (compare MAGSAC, Barath et al. 2019). The best hypothesis so far
//! is refined by expectation maximisation with the posterior probabilities as weights (local
//! optimisation: Chum, Matas, Kittler 2003). Models of different kinds are compared in the same
//! unit.

use super::random::Random;
use crate::base::math;

/// Standard deviations of an inlier, multiples of the stated one.
const SIGMAS: [f64; 3] = [0.5, 1.0, 2.0];

/// Prior share of inliers.
const SHARE: f64 = 0.5;

/// Entries of the table of scores for a squared residual of one.
const ENTRIES_PER_UNIT: f64 = 16.0;

/// Squared residual at which the table ends: twelve standard deviations.
const END: usize = 144;

/// Probability with which a sample of inliers is to be drawn.
const CONFIDENCE: f64 = 0.9999;

/// Expectation-maximisation steps after each new best hypothesis, and at the end.
const LOCAL_EM_STEPS: usize = 3;
const FINAL_EM_STEPS: usize = 10;

/// What is estimated, from what.
pub(super) trait Estimator {
    /// A hypothesis.
    type Model: Clone;

    /// Number of observations.
    fn len(&self) -> usize;

    /// Observations in a minimal sample.
    fn sample_size(&self) -> usize;

    /// All models that a random minimal sample allows.
    fn hypotheses(&self, random: &mut Random) -> Vec<Self::Model>;

    /// Squared residual of an observation, in standard deviations; infinite where it contradicts.
    fn residual2(&self, model: &Self::Model, i: usize) -> f64;

    /// A better model by weighted least squares from a model.
    fn refined(&self, model: &Self::Model, weights: &[f64]) -> Option<Self::Model>;
}

/// The log-likelihood ratio of a residual, and the probability of being an inlier.
pub(super) struct Likelihood {
    scores: Vec<f64>,
    posteriors: Vec<f64>,
}

impl Likelihood {
    /// For residuals of `dimensions` (1 or 2) components, where an outlier's lies anywhere within
    /// `range` standard deviations (in each).
    pub(super) fn new(dimensions: u32, range: f64) -> Self {
        let ratio = |r2: f64| {
            let of_sigma = |s: &f64| {
                let one = range / (s * (2.0 * std::f64::consts::PI).sqrt());
                let factor = if dimensions == 2 { one * one } else { one };
                factor * math::exp(-0.5 * r2 / (s * s))
            };
            SIGMAS.iter().map(of_sigma).sum::<f64>() / SIGMAS.len() as f64
        };
        let entries = 0..=END * ENTRIES_PER_UNIT as usize;
        let ratios: Vec<f64> = entries
            .map(|i| ratio(i as f64 / ENTRIES_PER_UNIT))
            .collect();
        let mixture = |q: &f64| 1.0 - SHARE + SHARE * q;
        Self {
            scores: ratios.iter().map(|q| math::ln(mixture(q))).collect(),
            posteriors: ratios.iter().map(|q| SHARE * q / mixture(q)).collect(),
        }
    }

    fn of(table: &[f64], end: f64, r2: f64) -> f64 {
        let x = r2 * ENTRIES_PER_UNIT;
        if x.is_nan() || x >= (table.len() - 1) as f64 {
            return end;
        }
        let i = x as usize;
        table[i] + (table[i + 1] - table[i]) * (x - i as f64)
    }

    /// Nats for a squared residual.
    pub(super) fn score(&self, r2: f64) -> f64 {
        Self::of(&self.scores, self.scores[self.scores.len() - 1], r2)
    }

    /// Probability of being an inlier.
    pub(super) fn posterior(&self, r2: f64) -> f64 {
        Self::of(&self.posteriors, 0.0, r2)
    }
}

/// The likeliest model.
#[derive(Clone, Debug)]
pub(super) struct Estimate<M> {
    /// The model.
    pub model: M,
    /// Nats by which it is likelier than none.
    pub score: f64,
    /// Observations that are more likely inliers than not.
    pub inliers: Vec<usize>,
}

/// The likeliest model of at most `most` samples; `None` where there are too few observations or
/// none makes them likelier.
pub(super) fn estimate<E: Estimator>(
    problem: &E,
    likelihood: &Likelihood,
    random: &mut Random,
    most: usize,
) -> Option<Estimate<E::Model>> {
    let n = problem.len();
    if n < problem.sample_size() {
        return None;
    }
    let mut best: Option<(E::Model, f64)> = None;
    let mut needed = most;
    let mut drawn = 0;
    while drawn < needed {
        drawn += 1;
        for model in problem.hypotheses(random) {
            let least = best.as_ref().map_or(0.0, |b| b.1);
            let Some(score) = score_above(problem, likelihood, &model, least) else {
                continue;
            };
            let (model, score) = optimised(problem, likelihood, (model, score), LOCAL_EM_STEPS);
            needed = samples_needed(problem, likelihood, &model).clamp(1, most);
            best = Some((model, score));
        }
    }
    let (model, score) = optimised(problem, likelihood, best?, FINAL_EM_STEPS);
    let inliers = (0..n)
        .filter(|&i| likelihood.posterior(problem.residual2(&model, i)) > 0.5)
        .collect();
    Some(Estimate {
        model,
        score,
        inliers,
    })
}

/// The sum of the scores, if it exceeds `least`.
fn score_above<E: Estimator>(
    problem: &E,
    likelihood: &Likelihood,
    model: &E::Model,
    least: f64,
) -> Option<f64> {
    let n = problem.len();
    let most_of_one = likelihood.scores[0];
    let mut sum = 0.0;
    for i in 0..n {
        sum += likelihood.score(problem.residual2(model, i));
        if i % 64 == 63 && sum + (n - i - 1) as f64 * most_of_one <= least {
            return None;
        }
    }
    (sum > least).then_some(sum)
}

/// Steps of expectation maximisation as long as they make the observations likelier.
pub(super) fn optimised<E: Estimator>(
    problem: &E,
    likelihood: &Likelihood,
    start: (E::Model, f64),
    steps: usize,
) -> (E::Model, f64) {
    let mut best = start;
    for _ in 0..steps {
        let weight = |i: usize| likelihood.posterior(problem.residual2(&best.0, i));
        let weights: Vec<f64> = (0..problem.len()).map(weight).collect();
        let refined = problem.refined(&best.0, &weights);
        let scored = refined.and_then(|model| {
            let score = score_above(problem, likelihood, &model, best.1)?;
            Some((model, score))
        });
        match scored {
            Some(better) => {
                let ends = better.1 - best.1 < 1e-3;
                best = better;
                if ends {
                    break;
                }
            }
            None => break,
        }
    }
    best
}

/// Samples until one of inliers alone was drawn.
fn samples_needed<E: Estimator>(problem: &E, likelihood: &Likelihood, model: &E::Model) -> usize {
    let n = problem.len();
    let inliers = (0..n)
        .filter(|&i| likelihood.posterior(problem.residual2(model, i)) > 0.5)
        .count();
    let share = inliers as f64 / n as f64;
    let good = (0..problem.sample_size()).fold(1.0, |p, _| p * share);
    if good >= 1.0 - 1e-9 {
        return 1;
    }
    let needed = math::ln(1.0 - CONFIDENCE) / math::ln(1.0 - good);
    if needed.is_finite() {
        needed.ceil() as usize
    } else {
        usize::MAX
    }
}
