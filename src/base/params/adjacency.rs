//! Parameters of feature adjacency graphs.

use serde::{Deserialize, Serialize};

/// B99 2 (Bonn): planes from corners.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct AdjacencyParams {
    /// Whether corners that are matched over the views with their edges and regions propose planes
    /// beside half-planes and dense matching. By themselves they always do.
    pub enabled: bool,
}
