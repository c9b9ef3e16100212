//! Random numbers that are the same on every target and in every run.

/// SplitMix64 (Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
pub(super) struct Random(u64);

impl Random {
    /// The sequence of a seed.
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Sixty-four random bits.
    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number below `n`, which is positive.
    pub(super) fn below(&mut self, n: usize) -> usize {
        (((self.bits() >> 32) * n as u64) >> 32) as usize
    }

    /// `N` different numbers below `n >= N`.
    pub(super) fn sample<const N: usize>(&mut self, n: usize) -> [usize; N] {
        let mut chosen = [usize::MAX; N];
        for i in 0..N {
            let mut next = self.below(n);
            while chosen[..i].contains(&next) {
                next = self.below(n);
            }
            chosen[i] = next;
        }
        chosen
    }
}

#[cfg(test)]
impl Random {
    /// A number from -1 to 1.
    pub(super) fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A normal deviate, as the sum of twelve uniform ones.
    pub(super) fn normal(&mut self) -> f64 {
        (0..12).map(|_| 0.5 * self.signed()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_hold_different_numbers_of_the_range() {
        let mut random = Random::new(3);
        let mut seen = [0; 6];
        for _ in 0..600 {
            let sample = random.sample::<4>(6);
            for (i, &s) in sample.iter().enumerate() {
                assert!(!sample[..i].contains(&s));
                seen[s] += 1;
            }
        }
        assert!(seen.iter().all(|&n| (330..470).contains(&n)), "{seen:?}");
    }

    #[test]
    fn deviates_have_mean_zero_and_variance_one() {
        let mut random = Random::new(5);
        let values: Vec<f64> = (0..4000).map(|_| random.normal()).collect();
        let mean = values.iter().sum::<f64>() / 4000.0;
        let variance = values.iter().map(|v| v * v).sum::<f64>() / 4000.0;
        assert!(
            mean.abs() < 0.06 && (variance - 1.0).abs() < 0.1,
            "{mean} {variance}"
        );
    }
}
