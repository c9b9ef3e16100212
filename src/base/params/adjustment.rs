//! Parameters of the adjustment of the views.

use serde::{Deserialize, Serialize};

/// Adjustment of single views to the matched lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct AdjustmentParams {
    /// Whether views that are shifted, turned or moved against the others by up to a few pixels are
    /// adjusted.
    pub enabled: bool,
}

impl Default for AdjustmentParams {
    fn default() -> Self {
        Self { enabled: true }
    }
}
