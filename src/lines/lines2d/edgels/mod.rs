//! Edgels, the points of edges, and their chains (B99 3.2).
//!
//! ```text
//! canny    edgels with sub-pixel positions
//! noise    local statistics of the strengths, to which thresholds are relative
//! chain    edgels linked across gaps of one pixel, with hysteresis
//! worm     chains broken where their tangent turns
//! ```
//!
//! Invariant: an edgel lies inside the pixel that found it, and a pixel holds one edgel at most.

mod canny;
mod chain;
mod noise;
mod worm;

pub use canny::{Edgel, detect_edgels};
pub(crate) use canny::{Gradient, suppress};
pub use chain::{Chain, link_chains};
pub(crate) use chain::{NONE, Raster, link_on};
pub(crate) use noise::LocalStrengths;
pub(crate) use worm::tangent_breaks;
