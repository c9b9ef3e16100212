//! All parameters, one struct for each stage, with the papers' values as defaults.
//!
//! Each field quotes its section; where the paper gives no value, "Assumption:" gives the reason.

mod adjustment;
mod buildings;
mod corrections;
mod lines;
mod objectspace;
mod planes;
mod point_cloud;
mod register;
mod sources;

pub use self::adjustment::*;
pub use self::buildings::*;
pub use self::corrections::*;
pub use self::lines::*;
pub use self::objectspace::*;
pub use self::planes::*;
pub use self::point_cloud::*;
pub use self::register::*;
pub use self::sources::*;

use serde::{Deserialize, Serialize};

/// The parameters of a whole run. Missing fields of a JSON file take their defaults.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Params {
    /// A name for a set of sources of planes.
    pub method: Method,
    /// The sources of planes; those of the method where none is given.
    pub sources: Vec<Source>,
    /// Image segments.
    pub segments: SegmentParams,
    /// Line matching.
    pub matching: MatchParams,
    /// Adjustment of the views.
    pub adjustment: AdjustmentParams,
    /// 3D lines.
    pub lines3d: Lines3dParams,
    /// Half-plane sweep.
    pub sweep: SweepParams,
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

impl Params {
    /// From JSON; what it leaves out is as by default.
    ///
    /// # Errors
    /// The name of what is no parameter, or has no such value.
    pub fn from_json(text: &str) -> Result<Self, impl std::error::Error + use<>> {
        crate::base::json::read(text)
    }

    /// The sources that propose planes.
    pub fn sources(&self) -> &[Source] {
        match &self.sources[..] {
            [] => self.method.sources(),
            given => given,
        }
    }

    /// Takes the sources of a method.
    pub fn choose(&mut self, method: Method) {
        self.method = method;
        self.sources.clear();
    }
}
