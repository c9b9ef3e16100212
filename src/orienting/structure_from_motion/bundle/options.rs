//! What is free in an adjustment, and what is known before it.

use crate::orienting::structure_from_motion::intrinsics::{Intrinsics, PARAMETERS};

/// What is free and how long it is adjusted.
#[derive(Clone, Debug)]
pub(in super::super) struct BundleOptions {
    /// Steps at most.
    pub steps: usize,
    /// A step that lowers the cost by a smaller share is the last one.
    pub least_gain: f64,
    /// Prior standard deviations of f (a share of it), k1, k2, and of cx, cy (pixels); 0 where a
    /// parameter is held.
    pub prior: [f64; PARAMETERS],
}

/// The prior's mean: what a camera is before its first adjustment.
#[derive(Clone, Debug)]
pub(super) struct Prior {
    pub mean: Intrinsics,
    /// Standard deviations of the parameters; 0 holds one.
    pub sigma: [f64; PARAMETERS],
}

impl BundleOptions {
    /// The priors of cameras that were these before their first adjustment.
    pub(super) fn priors(&self, means: &[Intrinsics]) -> Vec<Prior> {
        (means.iter())
            .map(|mean| {
                let mut sigma = self.prior;
                sigma[0] *= mean.focal;
                let mean = mean.clone();
                Prior { mean, sigma }
            })
            .collect()
    }
}
