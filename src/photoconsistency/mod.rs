//! photoconsistency

mod box_sum;
mod consistency_map;
mod pairwise_correlation;
mod plan_grid;
mod plane_consistency;
mod shiftable_windows;
mod strip;
mod windows;

pub(crate) use box_sum::{BoxSum, HALF_WINDOW, RowSum, WINDOW, WINDOW_CELLS};
pub use consistency_map::ConsistencyMap;
pub(crate) use consistency_map::{least_correlation, least_overall};
pub use plan_grid::{PlanGrid, image_from_plan, orthophoto};
pub use plane_consistency::{consistency_map, consistency_map_behind};
pub(crate) use shiftable_windows::ShiftableWindows;
pub(crate) use strip::{Patch, Strip};
pub(crate) use windows::Windows;
