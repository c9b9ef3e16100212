//! What is reported of a ground control point.

use serde::Serialize;

/// How well a ground control point agrees with the block.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ControlResidual {
    /// Its name.
    pub name: String,
    /// Coordinates as they are stated.
    pub stated: [f64; 3],
    /// Photographs that show it, and those among them whose marks agree.
    pub marks: [usize; 2],
    /// Photographs whose marks disagree with the others.
    pub wrong_marks: Vec<String>,
    /// The block's place minus the stated one, x y z: metres; absent where two marks do not meet.
    pub residual_m: Option<[f64; 3]>,
    /// Standard deviation of a component of that, metres.
    pub sigma_m: Option<f64>,
    /// Does it agree with the other points?
    pub agrees: bool,
}
