//! Why a facet is not part of a solid.

use serde::Serialize;

/// Why a facet, or a part of it, is not in any building.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum SolidRejection {
    /// Fewer than three corners, or coordinates that are not numbers.
    NoOutline,
    /// Vertical, nearly vertical or facing down.
    TooSteep,
    /// Next to no area in plan (after overlaps were taken out).
    TooSmall,
    /// Its outline crosses itself or an earlier facet's.
    Conflict,
    /// The faces of its building do not close.
    Open,
}
