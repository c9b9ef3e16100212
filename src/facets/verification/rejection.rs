//! Why facets are rejected.

use nalgebra::Point3;
use serde::Serialize;

/// Why a facet was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum FacetRejection {
    /// Smaller than the least area.
    TooSmall {
        /// Sloped area, square metres.
        area_m2: f64,
    },
    /// Windows fit into little of it, so that only its edges are evidence for it.
    TooNarrow {
        /// Side of the window, metres.
        window_m: f64,
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
    /// The views do not agree inside the outline.
    Dissimilar {
        /// Mean correlation inside the outline.
        similarity: f64,
    },
    /// The views that nothing hides it from do not agree inside the outline.
    Contradicted {
        /// Mean correlation of all their pairs inside the outline.
        similarity: f64,
    },
    /// Steep, without a half-plane, and the views that nothing hides it from agree inside it by
    /// chance at most: it spans from one edge to a lower one across a gap.
    Bridge {
        /// Mean correlation of all their pairs inside the outline.
        similarity: f64,
    },
    /// The views agree better inside the outline on the plane moved up or down, and the outline is
    /// not on lines on most sides.
    Displaced {
        /// How much better, in standard deviations.
        sigmas: f64,
    },
    /// The part of a facet beyond a line that bounds it, on whose plane the views agree by chance
    /// at most there.
    BoundaryLeakage {
        /// Mean correlation of all their pairs inside that part.
        similarity: f64,
    },
    /// As green as plants, and a roof neither by its outline nor by its inside.
    Vegetation {
        /// (2 G - R - B) / (R + G + B).
        excess_green: f64,
    },
    /// Inside the outline the views agree better on the plane of another group.
    Dominated {
        /// Index of that group.
        by: u32,
        /// How much better, in standard deviations.
        sigmas: f64,
    },
    /// Too little of its outline lies on reconstructed lines, and the images do not clearly show
    /// it.
    Unsupported {
        /// tau_real, 0 to 1.
        real_ratio: f64,
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
