//! Parameters of dense matching.

use serde::{Deserialize, Serialize};

/// B99 2: planes from the images themselves, where no line starts one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct DenseParams {
    /// Whether dense matching proposes planes beside those of the lines.
    pub enabled: bool,
}

impl Default for DenseParams {
    fn default() -> Self {
        Self { enabled: true }
    }
}
