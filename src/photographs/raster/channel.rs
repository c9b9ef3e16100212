//! The two channels of a photograph in which lines are sought.

use serde::Serialize;

/// What of a pixel is compared between images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Channel {
    /// Its grey value.
    Grey,
    /// The difference of its red and its blue ([`super::RedBlueDifference`]).
    #[serde(rename = "warmth")]
    RedBlue,
}

impl Channel {
    /// The other channel.
    pub fn other(self) -> Self {
        match self {
            Self::Grey => Self::RedBlue,
            Self::RedBlue => Self::Grey,
        }
    }
}
