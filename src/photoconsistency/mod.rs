//! photoconsistency

mod agreement;
mod box_sum;
pub(crate) mod consistency_map;
mod plan_grid;
mod strip;
mod windows;

pub(crate) use agreement::FULL;
pub(crate) use box_sum::{BoxSum, HALF_WINDOW, RowSum, WINDOW};
pub use consistency_map::{ConsistencyMap, consistency_map, consistency_map_behind};
pub(crate) use consistency_map::{least_correlation, least_overall};
pub use plan_grid::{PlanGrid, image_from_plan, orthophoto};
pub(crate) use strip::{Patch, Strip};
pub(crate) use windows::Windows;
