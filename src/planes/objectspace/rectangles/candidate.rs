//! Plane candidates, and the outcome of each pair of parallel lines.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::ends::{Crossing, PlaneEnd};
use crate::base::evidence::{Evidence, EvidenceModel};
use crate::base::geometry::Plane;

/// A polygon in a plane, with the evidence for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneCandidate {
    /// The plane.
    pub plane: Plane,
    /// Corners, metres, counter-clockwise seen from above.
    pub ring: Vec<Point3<f64>>,
    /// The two lines (one for a triangle), as indices into the clusters of the window.
    pub lines: Vec<usize>,
    /// Mean correlation of the views inside, weighted by texture.
    pub correlation: f64,
    /// What its evidence is measured from.
    pub features: PlaneFeatures,
    /// The measure M: the energy of the labelling without the plane less that with it, nats.
    pub measure_nats: f64,
}

/// What is measured of a plane candidate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneFeatures {
    /// What the windows inside say of the plane, nats for a square metre in plan.
    pub plane_nats_per_m2: f64,
    /// By how much that is more than what they say of the better one of the planes a little above
    /// and below: smooth surfaces correlate on any plane near them.
    pub displaced_plane_margin_nats_per_m2: f64,
    /// Share of the outline that image lines cover, mean over the views.
    pub outline_on_lines: f64,
    /// Cosine of the slope.
    pub cos_slope: f64,
}

impl PlaneFeatures {
    /// What speaks for the plane and its outline, and against them.
    pub fn evidence(&self) -> Evidence {
        EvidenceModel::of_rectangles().weigh(&[
            ("plane_nats_per_m2", self.plane_nats_per_m2),
            (
                "displaced_plane_margin_nats_per_m2",
                self.displaced_plane_margin_nats_per_m2,
            ),
            ("outline_on_lines", self.outline_on_lines),
            ("cos_slope", self.cos_slope),
        ])
    }
}

/// Why a plane hypothesis gave no candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum PlaneRejection {
    /// Too steep, too narrow or too wide, or its lines stand beside each other.
    Shape,
    /// Not higher above the ground than a car.
    NearGround,
    /// Crossing lines make no two ends.
    NoEnds,
    /// Its best polygon is likelier false than true.
    Weak,
}

/// A pair of lines and its outcome (figure 11).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneTrace {
    /// The two lines.
    pub lines: [usize; 2],
    /// Why there is no candidate; `None` when there is.
    pub rejection: Option<PlaneRejection>,
    /// The image lines that cross the plane.
    pub crossings: Vec<Crossing>,
    /// Their clusters.
    pub ends: Vec<PlaneEnd>,
}
