//! Newtypes for the things that stages refer to by index.

use serde::{Deserialize, Serialize};

macro_rules! id {
    ($(#[$doc:meta] $name:ident),* $(,)?) => {$(
        #[$doc]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The position in the vector that this id refers to.
            pub fn index(self) -> usize {
                self.0 as usize
            }

            /// The number by which people know it, in files too: they count from 1.
            pub fn number(self) -> u32 {
                self.0 + 1
            }

            /// The id of the element at `index`.
            pub fn from_index(index: usize) -> Self {
                Self(u32::try_from(index).expect("fewer than 2^32 elements"))
            }
        }
    )*};
}

id! {
    /// A view: index into [`crate::orienting::scene::Scene::views`].
    ViewId,
    /// An image segment: index into the segments of its own view.
    SegmentId,
    /// A reconstructed 3D line: index into the list of 3D lines.
    LineId,
    /// An accepted half-plane: index into the list of half-planes.
    HalfPlaneId,
    /// A roof facet: index into [`crate::roofs::model::RoofModel::facets`].
    FacetId,
    /// A building: index into [`crate::roofs::model::RoofModel::buildings`].
    BuildingId,
}

impl BuildingId {
    /// Its name in all files.
    pub fn name(self) -> String {
        format!("building-{}", self.number())
    }
}

impl FacetId {
    /// Its name in all files.
    pub fn name(self) -> String {
        format!("facet-{}", self.number())
    }
}

/// Which source proposed a plane, and the index in what its stage found; half-planes and lines are
/// named by their own ids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum ProposalOrigin {
    /// A candidate of W96.
    Rectangle(u32),
    /// A plane of dense matching.
    DensePlane(u32),
    /// A set of coplanar lines.
    CoplanarSet(u32),
    /// A plane of corners.
    CornerPlane(u32),
    /// A plane of a point cloud.
    CloudPlane(u32),
}
