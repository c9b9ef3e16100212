//! All tunables, one struct a stage, with the papers' values as defaults.
//!
//! Each field quotes its section; where the paper is silent it says "Assumption:" and why.

mod buildings;
mod lines;
mod objectspace;
mod planes;

pub use buildings::*;
pub use lines::*;
pub use objectspace::*;
pub use planes::*;

use serde::{Deserialize, Serialize};

/// The parameters of a whole run. Missing fields of a JSON file take their defaults.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Params {
    /// Which of the methods finds the roofs.
    pub method: Method,
    /// Image segments.
    pub segments: SegmentParams,
    /// Line matching.
    pub matching: MatchParams,
    /// 3D lines.
    pub lines3d: Lines3dParams,
    /// Half-plane sweep.
    pub sweep: SweepParams,
    /// Grouping, delineation, verification, conflicts.
    pub roof: RoofParams,
    /// Rectangles in object space.
    pub objectspace: ObjectSpaceParams,
    /// Texture atlas.
    pub texture: TextureParams,
}

/// How roofs are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Lines matched over the views, and half-planes at them (B99).
    #[default]
    Lines,
    /// Regions, and planes between parallel lines in object space (W96).
    Rectangles,
}
