//! How deep behind the rim of the roof a wall stands: the posterior of what the windows say.

use crate::base::evidence::WallEvidence;
use crate::base::math::exp;

/// A wall is seen where it is known within this distance, metres: two pixels of a survey.
pub const DEPTH_TOLERANCE_M: f64 = 0.15;

/// Odds of that, nats. Assumption: ln 3, as for the lines of the result; a wall put in a wrong
/// place misleads more than one that is left under the eave.
pub const LEAST_ODDS_NATS: f64 = 1.0986;

/// Half a step between depths: what lies at the edge of a window counts to it.
const ROUNDING_M: f64 = 0.01;

/// Where a wall stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DepthEstimate {
    /// Behind the rim of the roof, metres; 0 where it may stand before it.
    pub depth_m: f64,
    /// Probability that it stands within [`DEPTH_TOLERANCE_M`] of the likeliest place.
    pub probability: f64,
    /// Standard deviation within that, metres.
    pub sigma_m: f64,
}

impl DepthEstimate {
    /// From the nats of each depth of the tables.
    pub(super) fn of(nats: &[f64]) -> Self {
        let fitted = WallEvidence::fitted();
        let depths: Vec<f64> = fitted.prior.iter().map(|(depth, _)| *depth).collect();
        let log: Vec<f64> = (nats.iter().zip(&fitted.prior))
            .map(|(nats, (_, prior))| fitted.independent * nats + prior)
            .collect();
        let highest = log.iter().copied().fold(f64::MIN, f64::max);
        let density: Vec<f64> = log.iter().map(|l| exp(l - highest)).collect();
        let total: f64 = density.iter().sum();
        let within = |middle: f64| {
            let all = depths.iter().zip(&density);
            all.filter(move |(d, _)| (**d - middle).abs() < DEPTH_TOLERANCE_M + ROUNDING_M)
        };
        let share = |middle: f64| within(middle).map(|(_, p)| p).sum::<f64>() / total;
        let likeliest = depths.iter().copied().fold((0.0, f64::MIN), |best, depth| {
            let share = share(depth);
            if share > best.1 { (depth, share) } else { best }
        });
        let (middle, probability) = likeliest;
        let sum = probability * total;
        let mean = within(middle).map(|(d, p)| d * p).sum::<f64>() / sum;
        let spread = |(d, p): (&f64, &f64)| (d - mean) * (d - mean) * p;
        let step = depths[1] - depths[0];
        let variance = within(middle).map(spread).sum::<f64>() / sum + step * step / 12.0;
        Self {
            depth_m: mean.max(0.0),
            probability,
            sigma_m: variance.sqrt(),
        }
    }

    /// Do the views show it?
    pub(super) fn is_seen(&self) -> bool {
        self.probability >= 1.0 - 1.0 / (1.0 + exp(LEAST_ODDS_NATS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_seen_leaves_the_prior_and_a_peak_is_found() {
        let depths: Vec<f64> = (WallEvidence::fitted().prior.iter())
            .map(|(depth, _)| *depth)
            .collect();
        let nothing = DepthEstimate::of(&vec![0.0; depths.len()]);
        assert!(!nothing.is_seen(), "{nothing:?}");
        let peak = |at: f64, nats: f64| {
            let of = |d: &f64| -nats * ((d - at) / 0.1) * ((d - at) / 0.1);
            DepthEstimate::of(&depths.iter().map(of).collect::<Vec<_>>())
        };
        for at in [0.2, 0.6, 1.1] {
            let found = peak(at, 6.0);
            assert!(
                found.is_seen() && (found.depth_m - at).abs() < 0.02,
                "{found:?}"
            );
            assert!(found.sigma_m < 0.06);
            assert!(!peak(at, 0.1).is_seen());
        }
        assert_eq!(peak(-0.2, 20.0).depth_m, 0.0);
    }
}
