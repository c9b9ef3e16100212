//! Why a building is not adjusted.

use serde::Serialize;

/// Why a building is not adjusted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case", tag = "reason")]
pub enum RefineRejection {
    /// More unknowns than are adjusted at once.
    TooLarge {
        /// Number of unknowns.
        unknowns: usize,
    },
    /// Too few of its sides show in the images.
    FewObservations {
        /// Measured edges.
        observations: usize,
    },
    /// The adjustment has no solution.
    Singular,
    /// The reprojection error does not fall.
    NoGain,
    /// The new outlines fold, cross, or do not close.
    Broken,
    /// The views agree less inside the new facets.
    Dissimilar {
        /// Mean correlation inside the facets before.
        before: f64,
        /// ... and after.
        after: f64,
    },
}
