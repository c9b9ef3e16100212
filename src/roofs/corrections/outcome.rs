//! What became of corrections.

use serde::Serialize;

use crate::base::geometry::Segment3;
use crate::base::ids::FacetId;

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
    /// Nothing stands there.
    NoObstruction,
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
    /// No photograph has that name.
    NoPhotograph,
    /// The two points are not in the photograph, or too near to each other for an edge.
    NotInPhotograph,
    /// Too few other photographs show an edge there.
    NoLine,
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
            Self::NoObstruction => "nothing stands there any more",
            Self::NoCorner => "no corner lies there any more",
            Self::NoEdge => "no edge lies there any more",
            Self::NotNeighbours => "the two are no neighbours in one building",
            Self::NotDivided => "the line does not divide the facet",
            Self::NoRoom => "its place is taken, or its outline encloses no roof",
            Self::NoPhotograph => "no photograph has that name",
            Self::NotInPhotograph => "the two points are no edge in the photograph",
            Self::NoLine => "too few other photographs show an edge there",
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
    /// For each correction the line that was found for what it draws in a photograph, metres, local
    /// frame, also where that divides no facet; `None` for the others.
    pub lines: Vec<Option<Segment3>>,
    /// For each facet of the corrected model the one that it was before; `None` for a new one.
    pub sources: Vec<Option<FacetId>>,
}
