//! Edgels, points of edges and of bars, and their chains (B99 3.2 and 5).
//!
//! ```text
//! canny, bar    edgels of steps and of thin lines, with sub-pixel positions
//! noise         local statistics of the strengths, to which thresholds are relative
//! chain         edgels linked across gaps of one pixel, with hysteresis
//! worm          chains broken where their tangent turns
//! ```
//!
//! Invariant: an edgel lies inside the pixel that found it, and a pixel holds one edgel at most.

mod bar;
mod canny;
mod chain;
mod noise;
mod worm;

pub(crate) use bar::{Fan, Hessian, bar_points, fan_edgels};
pub use canny::{Edgel, detect_edgels};
pub(crate) use canny::{Gradient, suppress};
pub use chain::{Chain, link_chains};
pub(crate) use chain::{NONE, Raster, link_on};
pub(crate) use noise::LocalStrengths;
pub(crate) use worm::tangent_breaks;
