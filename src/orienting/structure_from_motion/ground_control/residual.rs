//! What is reported of a ground control point.

use serde::{Deserialize, Serialize};

use super::role::Role;

/// How well a ground control point agrees with the block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ControlResidual {
    /// Its name.
    pub name: String,
    /// What it is for.
    #[serde(default)]
    pub role: Role,
    /// Coordinates as they are stated.
    pub stated: [f64; 3],
    /// Photographs that show it, and those among them whose marks agree.
    pub marks: [usize; 2],
    /// Photographs whose marks disagree with the others.
    pub wrong_marks: Vec<String>,
    /// Where the block has it in the frame, x y z: metres; absent where two marks do not meet.
    #[serde(default)]
    pub place_m: Option<[f64; 3]>,
    /// That minus the stated place; of each coordinate that is known.
    pub residual_m: Option<[Option<f64>; 3]>,
    /// Standard deviation of a component of that, metres.
    pub sigma_m: Option<f64>,
    /// Does it agree with the other points?
    pub agrees: bool,
}
