//! lines2d::edgels

mod bar;
mod canny;
mod chain;
pub(crate) mod noise;
mod worm;

pub(crate) use bar::{Fan, Hessian, bar_points, fan_edgels};
pub use canny::{Edgel, detect_edgels};
pub(crate) use canny::{Gradient, suppress};
pub use chain::{Chain, link_chains};
pub(crate) use chain::{NONE, Raster, link_on};
pub(crate) use noise::LocalStrengths;
pub(crate) use worm::tangent_breaks;
