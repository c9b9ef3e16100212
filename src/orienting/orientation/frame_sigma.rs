//! What a frame's scale and level are worth.

use serde::{Deserialize, Serialize};

/// Standard deviations of a frame as a whole: every length is too long by the same share, every
/// slope too steep by the same angle. What measuring adds is independent of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameSigma {
    /// Of a length of 10 m by the scale, metres; `None` where nothing tells.
    pub length_of_10_m: Option<f64>,
    /// Of a difference of height over 10 m of level distance by the level, metres; `None` where
    /// nothing tells.
    pub height_over_10_m: Option<f64>,
}

impl FrameSigma {
    /// From those of the logarithm of the scale and of the worst tilt, radians.
    pub(crate) fn of(scale: Option<f64>, tilt: Option<f64>) -> Self {
        let over_10_m = |sigma: Option<f64>| sigma.map(|s| 10.0 * s).filter(|s| s.is_finite());
        Self {
            length_of_10_m: over_10_m(scale),
            height_over_10_m: over_10_m(tilt),
        }
    }

    /// Of the scale, as a share of it; 0 where nothing tells.
    pub fn scale(&self) -> f64 {
        self.length_of_10_m.unwrap_or(0.0) / 10.0
    }

    /// Of the worst tilt, radians; 0 where nothing tells.
    pub fn tilt(&self) -> f64 {
        self.height_over_10_m.unwrap_or(0.0) / 10.0
    }

    /// In words.
    pub fn words(&self) -> String {
        let scale = match self.length_of_10_m {
            Some(sigma) => format!("a length of 10 m is known to +- {sigma:.3} m by the scale"),
            None => "nothing tells how well the scale is known".to_owned(),
        };
        let level = match self.height_over_10_m {
            Some(sigma) => {
                format!("a height over 10 m of level distance to +- {sigma:.3} m by the level")
            }
            None => "nothing tells how level it is".to_owned(),
        };
        format!("{scale}, {level}")
    }
}
