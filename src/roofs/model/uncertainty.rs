//! How well the geometry of a model is known.

use nalgebra::{Point2, Point3, Vector3};
use serde::{Deserialize, Serialize};

/// Standard deviations of a facet, from the adjustment of its building to the image edges of all
/// views.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FacetUncertainty {
    /// Of its height in its middle, metres.
    pub height_m: f64,
    /// Of its slope along the steepest direction, degrees.
    pub slope_deg: f64,
    /// Of its corners, outer ring first.
    pub corners: Vec<CornerUncertainty>,
    /// Of its sides, outer ring first; the side with index i begins at the corner with index i.
    pub sides: Vec<SideUncertainty>,
}

/// Standard deviations of a corner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CornerUncertainty {
    /// The corner, metres, local frame.
    pub at: Point3<f64>,
    /// Standard deviations of x, y and z, metres.
    pub sigma_m: Vector3<f64>,
}

/// A piece of an outline farther from a side lies on another one, metres. Assumption: closing a
/// building moves outlines by less.
const SAME_SIDE_M: f64 = 0.2;

/// How well the place of a side of a facet is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SideUncertainty {
    /// Its ends in plan, metres, local frame.
    pub ends: [Point2<f64>; 2],
    /// Standard deviation of its place across it in plan, metres.
    pub sigma_m: f64,
    /// What its place rests on.
    pub support: SideSupport,
}

/// What the place of a side rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub enum SideSupport {
    /// Image edges in three photographs and more.
    Edges,
    /// Image edges in one or two.
    FewEdges,
    /// No image edge, but the planes of two facets that meet there.
    Planes,
    /// None of these: it is where correlation ends, or an outline was closed.
    Nothing,
}

impl SideSupport {
    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Edges => "edges",
            Self::FewEdges => "fewEdges",
            Self::Planes => "planes",
            Self::Nothing => "nothing",
        }
    }

    /// The one with this name.
    pub fn named(name: &str) -> Option<Self> {
        let all = [Self::Edges, Self::FewEdges, Self::Planes, Self::Nothing];
        all.into_iter().find(|support| support.name() == name)
    }
}

impl FacetUncertainty {
    /// The side on which a piece of the outline lies, by the middle of the piece; `None` where no
    /// side lies there.
    pub fn side(&self, middle: &Point2<f64>) -> Option<&SideUncertainty> {
        let distance = |side: &SideUncertainty| {
            let [from, to] = side.ends;
            let along = to - from;
            let share = (middle - from).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
            (from + along * share.clamp(0.0, 1.0) - middle).norm_squared()
        };
        let nearest = (self.sides.iter()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.filter(|side| distance(side) < SAME_SIDE_M * SAME_SIDE_M)
    }

    /// The standard deviations of the corner nearest to a place: closing a building may add corners
    /// to a ring, where a neighbour has one.
    pub fn at(&self, place: &Point3<f64>) -> Option<Vector3<f64>> {
        let distance = |corner: &&CornerUncertainty| (corner.at - place).norm_squared();
        let nearest = (self.corners.iter()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map(|corner| corner.sigma_m)
    }
}
