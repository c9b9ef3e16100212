//! The posterior over theta, and whether there is a plane at all.
//!
//! B99 5 asks for "a probabilistic framework" to "compute a posterior estimate for the plane angle
//! and the likelihood that a plane is there"; this is ours.
//!
//! **One window.** A surface of texture variance `s^2`, seen in two views with noise of variance
//! `n^2` in each, correlates by `rho = s^2 / (s^2 + n^2)` under the homography of its plane, with a
//! scatter `tau`; windows of different surfaces correlate by chance, about 0 with a scatter
//! `tau_0`. The evidence of a window with the correlation c is `ln N(c; rho, tau) - ln N(c; 0,
//! tau_0)`: nothing where the texture drowns in noise (rho is 0 there), and a window that is not on
//! the plane (a chimney, the next facet) takes back no more than [`LEAST_EVIDENCE`].
//!
//! **One view.** Windows overlap, so their mean, weighted as in Sim(theta), counts for as many as
//! lie side by side: `L_i`. A view may not see the plane at all, with the probability [`OCCLUDED`]:
//! `ln ((1 - OCCLUDED) e^L_i + OCCLUDED)`. The baseline enters by itself: the shorter it is, the
//! more slowly the correlations, and so `L_i`, change with theta.
//!
//! **All views.** With as many angles and as many planes as none expected beforehand, `p(theta) =
//! e^L(theta) / (integral of e^L + range of theta)`, L the sum over the views; its integral is the
//! likelihood that a plane is there.

use serde::{Deserialize, Serialize};
use wide::f64x4;

use crate::base::math;

/// What is known of theta.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Posterior {
    /// Density at the samples of theta, per radian; its integral is `plane`.
    pub density: Vec<f64>,
    /// Probability that a plane is there, 0 to 1.
    pub plane: f64,
}

/// The correlation that a window on the plane has, and how far it scatters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WindowModel {
    rho: f64,
    /// `1 / (2 tau^2)`.
    precision: f64,
    /// `ln(tau_0 / tau)`.
    log_ratio: f64,
}

/// Scatter of correlations by chance. Assumption: windows of 225 pixels hold about ten independent
/// ones, since roofs are smooth and their tiles repeat.
const CHANCE_SCATTER: f64 = 0.3;
/// Scatter of correlations on a true plane without noise: shading, sampling, relief. Assumption.
const SCATTER: f64 = 0.15;
/// The most that views of one surface correlate by.
const LARGEST_RHO: f64 = 0.9;
/// Least evidence of a window.
const LEAST_EVIDENCE: f64 = -1.5;
/// Probability that a view does not see the neighbourhood. Assumption: one of five.
const OCCLUDED: f64 = 0.2;
/// The views share the reference and its noise, and neighbouring windows their texture: their
/// evidence counts for less than that of as many independent ones. Calibrated: with a quarter,
/// probabilities are about the shares of half-planes that lie on true surfaces of two rendered
/// scenes; with a half, they were far too close to 1.
const INDEPENDENT: f64 = 0.25;

impl WindowModel {
    /// For a window of standard deviation `contrast` in a view with noise of standard deviation
    /// `noise`.
    pub(super) fn new(contrast: f64, noise: f64) -> Self {
        let share = (noise * noise) / (contrast * contrast).max(1e-12);
        let rho = (1.0 - share).clamp(0.0, LARGEST_RHO);
        let by_chance = (1.0 - rho * rho) * CHANCE_SCATTER;
        let variance = by_chance * by_chance + SCATTER * SCATTER * rho * rho;
        Self {
            rho,
            precision: 0.5 / variance,
            log_ratio: 0.5 * math::ln(CHANCE_SCATTER * CHANCE_SCATTER / variance),
        }
    }

    /// Correlation that a window on the plane is expected to have.
    pub(super) fn rho(&self) -> f64 {
        self.rho
    }
}

/// The models of four windows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FourModels {
    rho: f64x4,
    precision: f64x4,
    log_ratio: f64x4,
}

impl FourModels {
    /// Side by side.
    pub(super) fn new(models: [WindowModel; 4]) -> Self {
        Self {
            rho: f64x4::new(models.map(|m| m.rho)),
            precision: f64x4::new(models.map(|m| m.precision)),
            log_ratio: f64x4::new(models.map(|m| m.log_ratio)),
        }
    }

    /// Logarithm of how much likelier each correlation is on the plane than by chance. More than
    /// expected is as good as expected.
    #[inline]
    pub(super) fn evidence(&self, correlation: f64x4) -> f64x4 {
        let short = (self.rho - correlation).fast_max(f64x4::ZERO);
        let chance = correlation.fast_min(self.rho) * f64x4::splat(1.0 / CHANCE_SCATTER);
        let ratio =
            self.log_ratio - short * short * self.precision + f64x4::splat(0.5) * chance * chance;
        ratio.fast_max(f64x4::splat(LEAST_EVIDENCE))
    }
}

/// Evidence of a view from the `mean` evidence of its windows and the number of `windows` that fit
/// side by side.
pub(crate) fn evidence_of_view(mean: f64, windows: f64) -> f64 {
    let sum = INDEPENDENT * windows * mean;
    if sum > 30.0 {
        return sum + math::ln(1.0 - OCCLUDED);
    }
    math::ln((1.0 - OCCLUDED) * math::exp(sum) + OCCLUDED)
}

impl Posterior {
    /// From the evidence of all views at the samples of theta (radians, ascending); between them it
    /// is linear.
    pub(crate) fn new(thetas: &[f64], evidence: &[f64]) -> Self {
        let [Some(first), Some(last)] = [thetas.first(), thetas.last()] else {
            return Self::default();
        };
        let range = last - first;
        // Against overflow everything is taken relative to the highest.
        let top = evidence.iter().copied().fold(0.0, f64::max);
        let scaled: Vec<f64> = evidence.iter().map(|e| e - top).collect();
        let plane: f64 = pieces(thetas, &scaled).map(|p| p.integral()).sum();
        let total = plane + range * math::exp(-top);
        if total <= 0.0 {
            return Self::default();
        }
        Self {
            density: scaled.iter().map(|e| math::exp(*e) / total).collect(),
            plane: plane / total,
        }
    }

    /// Probability that there is a plane within `reach` of `theta`, radians. `thetas` are the
    /// samples.
    pub fn probability(&self, thetas: &[f64], theta: f64, reach: f64) -> f64 {
        let logs: Vec<f64> = (self.density.iter())
            .map(|d| math::ln(d.max(f64::MIN_POSITIVE)))
            .collect();
        pieces(thetas, &logs)
            .filter_map(|p| p.within(theta - reach, theta + reach))
            .map(|p| p.integral())
            .sum()
    }
}

/// A piece between two samples, the logarithm linear.
struct LogPiece {
    from: f64,
    to: f64,
    a: f64,
    b: f64,
}

fn pieces<'a>(thetas: &'a [f64], logs: &'a [f64]) -> impl Iterator<Item = LogPiece> + 'a {
    let pairs = thetas.windows(2).zip(logs.windows(2));
    pairs.map(|(t, l)| LogPiece {
        from: t[0],
        to: t[1],
        a: l[0],
        b: l[1],
    })
}

impl LogPiece {
    /// The part between two angles.
    fn within(&self, low: f64, high: f64) -> Option<Self> {
        let (from, to) = (self.from.max(low), self.to.min(high));
        let at = |t: f64| self.a + (self.b - self.a) * (t - self.from) / (self.to - self.from);
        (to > from).then(|| Self {
            from,
            to,
            a: at(from),
            b: at(to),
        })
    }

    /// Integral of the exponential.
    fn integral(&self) -> f64 {
        let (width, rise) = (self.to - self.from, self.b - self.a);
        let (low, high) = (math::exp(self.a), math::exp(self.b));
        if rise.abs() < 1e-4 {
            0.5 * width * (low + high)
        } else {
            width * (high - low) / rise
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evidence of a planted normal distribution, `height` at its top.
    fn bell(theta: f64, sigma: f64, height: f64) -> (Vec<f64>, Vec<f64>) {
        let thetas: Vec<f64> = (-600..=600).map(|i| f64::from(i) * 0.002).collect();
        let evidence = thetas.iter().map(|t| {
            let z = (t - theta) / sigma;
            height - 0.5 * z * z
        });
        let evidence = evidence.collect();
        (thetas, evidence)
    }

    #[test]
    fn a_planted_distribution_is_recovered() {
        let (thetas, evidence) = bell(0.3, 0.02, 40.0);
        let posterior = Posterior::new(&thetas, &evidence);
        assert!(posterior.plane > 1.0 - 1e-9);
        let within = |sigmas: f64| posterior.probability(&thetas, 0.3, sigmas * 0.02);
        assert!((within(1.0) - 0.6827).abs() < 2e-3, "{}", within(1.0));
        assert!((within(2.0) - 0.9545).abs() < 2e-3);
        assert!(posterior.probability(&thetas, -0.3, 0.1) < 1e-9);
    }

    #[test]
    fn a_plane_is_as_likely_as_its_evidence_against_the_range_of_angles() {
        let (thetas, evidence) = bell(0.0, 0.05, 2.0);
        let posterior = Posterior::new(&thetas, &evidence);
        // Integral of the bell over that of "no plane", by hand.
        let bell = math::exp(2.0) * 0.05 * (2.0 * std::f64::consts::PI).sqrt();
        let expected = bell / (bell + 2.4);
        assert!((posterior.plane - expected).abs() < 1e-3);
        // No evidence: one half.
        let unsampled = Posterior::new(&thetas, &vec![0.0; thetas.len()]);
        assert!((unsampled.plane - 0.5).abs() < 1e-12);
        assert_eq!(Posterior::new(&[], &[]).plane, 0.0);
    }

    #[test]
    fn noise_lowers_what_is_expected_and_texture_decides() {
        let clear = WindowModel::new(0.1, 0.005);
        let noisy = WindowModel::new(0.01, 0.007);
        let drowned = WindowModel::new(0.01, 0.02);
        assert!(clear.rho() > 0.89 && (noisy.rho() - 0.51).abs() < 0.01);
        assert_eq!(drowned.rho(), 0.0);
        // A correlation of one half speaks for a noisy plane and against a clear one.
        let models = FourModels::new([clear, noisy, drowned, clear]);
        let evidence = |c: f64| models.evidence(f64x4::splat(c)).to_array();
        let [of_clear, of_noisy, ..] = evidence(0.5);
        assert!(of_noisy > 0.5 && of_clear < of_noisy);
        assert!(evidence(0.9)[0] > of_noisy);
        for c in [-0.5, 0.0, 0.5, 1.0] {
            assert!(evidence(c)[2].abs() < 1e-9, "{c}");
            assert_eq!(evidence(c)[0], evidence(c)[3]);
        }
    }

    #[test]
    fn a_hidden_view_costs_little() {
        let against = evidence_of_view(LEAST_EVIDENCE, 100.0);
        assert!((against - math::ln(OCCLUDED)).abs() < 1e-6);
        assert!((evidence_of_view(2.0, 40.0) - (20.0 + math::ln(1.0 - OCCLUDED))).abs() < 1e-9);
        assert_eq!(evidence_of_view(0.0, 10.0), 0.0);
    }
}
