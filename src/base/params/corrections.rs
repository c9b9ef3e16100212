//! What somebody corrects of a model by hand.
//!
//! A correction names what it is about by its place in the world, not by an id: so it holds after
//! another run of the earlier stages, where the model still has the same there. Places are metres
//! in the frame of the orientation, Z up; each correction is about the model that those before it
//! leave.

use nalgebra::{Point2, Point3, Vector3};
use serde::{Deserialize, Serialize};

/// Standard deviation of a corner or an edge that is put somewhere by hand, metres. Assumption: a
/// few pixels of a survey.
const BY_HAND_M: f64 = 0.02;

/// Standard deviation of a click across an edge, pixels of the photograph. Assumption: a hand hits
/// two pixels of a photograph that is shown at about its own size.
const CLICK_PX: f64 = 2.0;

/// A facet by its place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FacetPlace {
    /// A point of it.
    pub at: Point3<f64>,
    /// Its normal, upwards.
    pub normal: Vector3<f64>,
}

/// One correction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "correction", rename_all = "snake_case", deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub enum Correction {
    /// A facet is none.
    DeleteFacet {
        /// The facet.
        facet: FacetPlace,
        /// Do its neighbours close over its place? Where this is not said, they do if they border
        /// on half of its outline.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[cfg_attr(target_arch = "wasm32", tsify(optional))]
        filled: Option<bool>,
    },
    /// A building is none.
    DeleteBuilding {
        /// A point of its roof.
        building: Point3<f64>,
    },
    /// Nothing stands there.
    DeleteObstruction {
        /// A point of what stands on a facet.
        at: Point3<f64>,
    },
    /// Something stands on a facet. What was found at its place is this.
    AddObstruction {
        /// Its corners from above, in order; what lies beyond the facet below their middle is cut
        /// off.
        outline: Vec<Point3<f64>>,
        /// Height of its top above the facet, metres.
        height_m: f64,
    },
    /// A facet is a roof's face.
    Confirm {
        /// The facet.
        facet: FacetPlace,
    },
    /// A corner lies elsewhere.
    MoveCorner {
        /// Where it is.
        from: Point3<f64>,
        /// Where it should be.
        to: Point3<f64>,
        /// How well that is known: standard deviation, metres.
        #[serde(default = "by_hand_m")]
        sigma_m: f64,
    },
    /// An edge lies elsewhere.
    MoveEdge {
        /// Its ends as they are.
        from: [Point3<f64>; 2],
        /// Two points of the line on which it should lie.
        to: [Point3<f64>; 2],
        /// How well that is known: standard deviation, metres.
        #[serde(default = "by_hand_m")]
        sigma_m: f64,
    },
    /// An edge is parallel to another one, in plan and in slope.
    SetParallel {
        /// Its ends.
        edge: [Point3<f64>; 2],
        /// The ends of the other one.
        to: [Point3<f64>; 2],
    },
    /// A facet is level.
    SetLevel {
        /// The facet.
        facet: FacetPlace,
    },
    /// A facet has this slope, in its direction.
    SetSlope {
        /// The facet.
        facet: FacetPlace,
        /// Slope, degrees, less than 80.
        slope_deg: f64,
    },
    /// Two facets are equally steep; where they fall away from each other, in opposite directions.
    SetSymmetric {
        /// The facets.
        facets: [FacetPlace; 2],
    },
    /// The height of the ground below a building.
    SetGround {
        /// A point of its roof.
        building: Point3<f64>,
        /// Height, metres.
        height: f64,
    },
    /// The height of the lowest eave of a building; its whole roof follows.
    SetEave {
        /// A point of its roof.
        building: Point3<f64>,
        /// Height, metres.
        height: f64,
    },
    /// A facet goes on over another one.
    Merge {
        /// The facet, whose plane stays.
        facet: FacetPlace,
        /// The facet that becomes part of it.
        with: FacetPlace,
    },
    /// A facet is two that meet in an edge. Where the edge is off the facet, both turn about it.
    Split {
        /// The facet.
        facet: FacetPlace,
        /// Two points of the edge.
        along: [Point3<f64>; 2],
    },
    /// An edge is missing: it is drawn in one photograph, and found in the others.
    AddEdge {
        /// The file name of the photograph.
        photograph: String,
        /// Its ends, [x, y] in pixels of the photograph as it is shown, without the distortion of
        /// its lens: x right, y down, the centre of the first pixel at (0.5, 0.5).
        pixels: [Point2<f64>; 2],
        /// How well a hand hits them: standard deviation across the edge, pixels of the photograph.
        #[serde(default = "click_px")]
        sigma_px: f64,
    },
    /// A facet is missing. What is below it loses its place.
    AddFacet {
        /// Its corners, in order; its plane is fitted to them.
        outline: Vec<Point3<f64>>,
    },
    /// The counterpart of a facet beyond one of its edges is missing.
    Mirror {
        /// The facet.
        facet: FacetPlace,
        /// The ends of the edge.
        over: [Point3<f64>; 2],
    },
}

fn by_hand_m() -> f64 {
    BY_HAND_M
}

fn click_px() -> f64 {
    CLICK_PX
}

/// Corrections from JSON: an array of them.
///
/// # Errors
/// What is no such array, by the keys that lead to it.
pub fn corrections_from_json(
    text: &str,
) -> Result<Vec<Correction>, impl std::error::Error + use<>> {
    crate::base::json::read(text)
}
