//! Parameters of coplanar grouping.

use serde::{Deserialize, Serialize};

/// B99 2, 5: planes from coplanar lines.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CoplanarParams {
    /// Whether coplanar lines propose planes beside half-planes and dense matching; the sides that
    /// they explain are not swept then. By itself the method always groups.
    pub enabled: bool,
}
