//! Numbers by chance that are the same in every run, for tests.

/// Evenly distributed from 0 to 1: a linear congruential generator (Numerical Recipes 7.1), its upper 24 bits.
pub fn uniform(seed: u32) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1u32 << 24)
    }
}
