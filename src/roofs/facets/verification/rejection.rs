//! Why facets are rejected.

use nalgebra::Point3;
use serde::Serialize;

use crate::base::evidence::Evidence;

/// Why a facet was rejected.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum FacetRejection {
    /// Smaller than the least area.
    TooSmall {
        /// Sloped area, square metres.
        area_m2: f64,
    },
    /// On the ground, or too little above it.
    NearGround {
        /// Height of its middle above the ground, metres.
        height_m: f64,
    },
    /// Its low side lies on the ground: a bank, or the shadow of an eave, but no roof.
    ReachesGround {
        /// Height of its lowest corner above the ground, metres.
        lowest_m: f64,
    },
    /// Likelier false than true.
    Improbable {
        /// What speaks for it and against it.
        evidence: Evidence,
    },
}

/// A rejected facet.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct RejectedFacet {
    /// Index of the group whose plane it has.
    pub group: u32,
    /// Its outline, metres, local frame.
    pub outline: Vec<Point3<f64>>,
    /// Why.
    pub reason: FacetRejection,
}
