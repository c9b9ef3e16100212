//! Where the walls of a building stand below its roof.

use serde::{Deserialize, Serialize};

use super::roof_model::Solid;
use crate::base::geometry::Segment3;

/// A wall below a straight side of a building's outline.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wall {
    /// The side, metres, the building to its left; at the height of the roof's rim.
    pub side: Segment3,
    /// How far the wall stands inside the rim of the roof, metres.
    pub depth_m: f64,
    /// Do photographs show it there? Otherwise the depth is assumed.
    pub seen: bool,
    /// Probability that it stands within 0.15 m of the depth that photographs tell best; `None`
    /// where too few show what is below the rim.
    pub probability: Option<f64>,
    /// Standard deviation of the depth where it is seen, metres.
    pub sigma_m: Option<f64>,
}

/// The walls of a building.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BuildingWalls {
    /// One for each side.
    pub walls: Vec<Wall>,
    /// The closed solid with its walls there (LoD 2.3); `None` where it is that of the building
    /// itself, whose walls stand below the rim.
    pub solid: Option<Solid>,
    /// Volume inside the walls, between roof and ground, cubic metres, where there is such a solid.
    pub volume_m3: Option<f64>,
}
