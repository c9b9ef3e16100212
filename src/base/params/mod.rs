//! All parameters, one struct for each stage, with the papers' values as defaults.
//!
//! Each field quotes its section; where the paper gives no value, "Assumption:" gives the reason.

mod adjacency;
mod adjustment;
mod buildings;
mod coplanar;
mod corrections;
mod dense;
mod lines;
mod objectspace;
mod planes;
mod point_cloud;
mod register;

pub use self::adjacency::*;
pub use self::adjustment::*;
pub use self::buildings::*;
pub use self::coplanar::*;
pub use self::corrections::*;
pub use self::dense::*;
pub use self::lines::*;
pub use self::objectspace::*;
pub use self::planes::*;
pub use self::point_cloud::*;
pub use self::register::*;

use serde::{Deserialize, Serialize};

/// The parameters of a whole run. Missing fields of a JSON file take their defaults.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Params {
    /// Which of the methods finds the roofs.
    pub method: Method,
    /// Image segments.
    pub segments: SegmentParams,
    /// Line matching.
    pub matching: MatchParams,
    /// Adjustment of the views.
    pub adjustment: AdjustmentParams,
    /// 3D lines.
    pub lines3d: Lines3dParams,
    /// Coplanar grouping.
    pub coplanar: CoplanarParams,
    /// Feature adjacency graphs.
    pub adjacency: AdjacencyParams,
    /// Half-plane sweep.
    pub sweep: SweepParams,
    /// Dense matching.
    pub dense: DenseParams,
    /// A point cloud that is known beforehand.
    pub point_cloud: PointCloudParams,
    /// Grouping, delineation, verification, conflicts.
    pub roof: RoofParams,
    /// Rectangles in object space.
    pub objectspace: ObjectSpaceParams,
    /// Corrections by hand, in their order.
    pub corrections: Vec<Correction>,
    /// Texture atlas.
    pub texture: TextureParams,
}

/// How roofs are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Lines matched over the views, and half-planes at them (B99).
    #[default]
    Lines,
    /// Regions, and planes between parallel lines in object space (W96).
    Rectangles,
    /// Lines and planes of both compete for one model.
    Combined,
    /// Sets of coplanar lines and their polygons (B99 2: Leuven).
    Coplanar,
    /// Corners with their edges and regions, matched as wholes (B99 2: Bonn).
    Adjacency,
}

impl Params {
    /// From JSON; what it leaves out is as by default.
    ///
    /// # Errors
    /// The name of what is no parameter, or has no such value.
    pub fn from_json(text: &str) -> Result<Self, impl std::error::Error + use<>> {
        crate::base::json::read(text)
    }
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Lines,
        Self::Rectangles,
        Self::Combined,
        Self::Coplanar,
        Self::Adjacency,
    ];

    /// Are lines swept and grouped in pairs? Not where another source of planes is all that there
    /// is.
    pub fn pairs_lines(self) -> bool {
        !matches!(self, Self::Coplanar | Self::Adjacency)
    }

    /// The name in files, on the command line and on the page.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lines => "lines",
            Self::Rectangles => "rectangles",
            Self::Combined => "combined",
            Self::Coplanar => "coplanar",
            Self::Adjacency => "adjacency",
        }
    }
}
