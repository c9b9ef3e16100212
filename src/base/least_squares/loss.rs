//! What a residual costs, and how much it counts.

use crate::base::math;

/// rho of a squared residual e^2. All are e^2 near zero; beyond the scale, in the unit of the
/// residual, they rise less, so that one wrong observation does not move the unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Loss {
    /// e^2.
    Squares,
    /// `c^2 ln(1 + e^2 / c^2)`.
    Cauchy(f64),
    /// e^2 up to the scale k, `2 k |e| - k^2` beyond it.
    Huber(f64),
}

impl Loss {
    /// rho(e^2).
    #[inline]
    pub(crate) fn cost(self, e2: f64) -> f64 {
        match self {
            Self::Cauchy(c) => c * c * math::ln(1.0 + e2 / (c * c)),
            Self::Huber(k) if e2 > k * k => 2.0 * k * e2.sqrt() - k * k,
            Self::Squares | Self::Huber(_) => e2,
        }
    }

    /// rho'(e^2), 0 to 1: the weight with which the square has the same derivative.
    #[inline]
    pub(crate) fn weight(self, e2: f64) -> f64 {
        match self {
            Self::Cauchy(c) => 1.0 / (1.0 + e2 / (c * c)),
            Self::Huber(k) if e2 > k * k => k / e2.sqrt(),
            Self::Squares | Self::Huber(_) => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weight_is_the_derivative_and_small_residuals_cost_their_square() {
        for loss in [Loss::Squares, Loss::Cauchy(2.4), Loss::Huber(0.7)] {
            assert!((loss.cost(1e-8) - 1e-8).abs() < 1e-15);
            assert!((loss.weight(1e-8) - 1.0).abs() < 1e-7);
            for e2 in [0.1, 0.48, 0.5, 3.0, 40.0] {
                let slope = (loss.cost(e2 + 1e-6) - loss.cost(e2 - 1e-6)) / 2e-6;
                assert!((slope - loss.weight(e2)).abs() < 1e-6, "{loss:?} {e2}");
            }
        }
        assert_eq!(Loss::Cauchy(2.0).weight(4.0), 0.5);
        assert_eq!(Loss::Huber(2.0).weight(16.0), 0.5);
    }
}
