//! Significance of a fitted line against its surroundings (Helmholtz principle).
//!
//! Were the edgels of a line ordinary pixels of their surroundings, their `-ln H(g)`
//! ([`super::edgels::LocalStrengths`]) would be independent exponential variables; the sum over
//! `n` of them is then Gamma(n, 1) distributed (Fisher's method). The line is significant when the
//! expected number of lines with such a sum by chance among all tested ones is below one. So a
//! long weak ridge is kept and a short strong streak of foliage is not.

/// Expected number of lines by chance among `tests` of them.
pub(super) struct FalseAlarms {
    ln_tests: f64,
    /// ln k! for k = 0, 1, ..., computed as needed.
    ln_factorials: Vec<f64>,
}

impl FalseAlarms {
    /// Among this many lines.
    pub(super) fn new(tests: usize) -> Self {
        Self {
            ln_tests: crate::base::math::ln(tests.max(1) as f64),
            ln_factorials: vec![0.0],
        }
    }

    /// Natural logarithm of the number of false alarms: `tests * P(Gamma(n) >= sum)`.
    pub(super) fn ln(&mut self, n: f64, sum: f64) -> f64 {
        self.ln_tests + self.ln_gamma_tail(n, sum)
    }

    /// `ln P(Gamma(shape) >= x)` with the shape rounded to a whole number of at least one:
    /// `exp(-x) * sum over k < shape of x^k / k!`.
    fn ln_gamma_tail(&mut self, shape: f64, x: f64) -> f64 {
        let shape = shape.round().max(1.0) as usize;
        if x <= 0.0 {
            return 0.0;
        }
        // Summed from the last term backwards, relative to it: no overflow for any length.
        let (mut term, mut sum) = (1.0, 1.0);
        for k in (1..shape).rev() {
            term *= k as f64 / x;
            sum += term;
            if !sum.is_finite() {
                return 0.0;
            }
        }
        let last = shape - 1;
        let ln_last = last as f64 * crate::base::math::ln(x) - self.ln_factorial(last);
        (ln_last + crate::base::math::ln(sum) - x).min(0.0)
    }

    fn ln_factorial(&mut self, k: usize) -> f64 {
        while self.ln_factorials.len() <= k {
            let (next, so_far) = (self.ln_factorials.len(), self.ln_factorials.last());
            let so_far = so_far.expect("0! is known");
            self.ln_factorials
                .push(so_far + crate::base::math::ln(next as f64));
        }
        self.ln_factorials[k]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tail_is_that_of_a_gamma_distribution() {
        let ln_gamma_tail = |shape, x| FalseAlarms::new(1).ln_gamma_tail(shape, x);
        // Shape 1 is the exponential distribution; the others are from tables of chi-squared:
        // P(chi2(2n) > 2x).
        assert!((ln_gamma_tail(1.0, 3.0) + 3.0).abs() < 1e-12);
        assert!((crate::base::math::exp(ln_gamma_tail(5.0, 18.307 / 2.0)) - 0.05).abs() < 1e-4);
        assert!((crate::base::math::exp(ln_gamma_tail(10.0, 37.566 / 2.0)) - 0.01).abs() < 1e-5);
        assert_eq!(ln_gamma_tail(2000.0, 10.0), 0.0);
    }

    #[test]
    fn the_same_weak_contrast_counts_for_more_along_a_longer_line() {
        // Edgels in the strongest 20 % of their surroundings.
        let each = -crate::base::math::ln(0.2);
        let mut alarms = FalseAlarms::new(5000);
        let short = alarms.ln(8.0, 8.0 * each);
        let long = alarms.ln(60.0, 60.0 * each);
        assert!(short > 0.0 && long < 0.0, "{short} {long}");
    }
}
