//! What became of corrections.

use serde::Serialize;

use crate::ids::FacetId;

/// Why a correction is not applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum NotApplied {
    /// No facet lies there.
    NoFacet,
    /// The facet there has another height.
    OtherHeight,
    /// The facet there has another slope or falls elsewhere.
    OtherSlope,
    /// No building stands there.
    NoBuilding,
    /// No corner lies there.
    NoCorner,
    /// No edge lies there.
    NoEdge,
    /// The two are not neighbours in one building.
    NotNeighbours,
    /// The line does not divide the facet.
    NotDivided,
    /// The place is not free, or the outline encloses no roof.
    NoRoom,
    /// Numbers that no roof has.
    Implausible,
    /// The building cannot be adjusted to that.
    NotAdjusted,
    /// Outlines would cross, or the building would not close.
    WouldNotClose,
}

impl NotApplied {
    /// In words, after "correction 3: ".
    pub fn words(self) -> &'static str {
        match self {
            Self::NoFacet => "no facet lies there any more",
            Self::OtherHeight => "the facet there has another height now",
            Self::OtherSlope => "the facet there has another slope now",
            Self::NoBuilding => "no building stands there any more",
            Self::NoCorner => "no corner lies there any more",
            Self::NoEdge => "no edge lies there any more",
            Self::NotNeighbours => "the two are no neighbours in one building",
            Self::NotDivided => "the line does not divide the facet",
            Self::NoRoom => "its place is taken, or its outline encloses no roof",
            Self::Implausible => "no roof has such numbers",
            Self::NotAdjusted => "the building cannot be adjusted to it",
            Self::WouldNotClose => "the building would not close",
        }
    }
}

/// What became of all corrections.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CorrectionTrace {
    /// For each correction why it is not applied; `None` for one that is.
    pub outcomes: Vec<Option<NotApplied>>,
    /// For each facet of the corrected model the one that it was before; `None` for a new one.
    pub sources: Vec<Option<FacetId>>,
}
