//! Photo-consistency: how well the views agree on a plane.
//!
//! Two measures, both of centred normalised cross-correlation. Beside a line the sweep correlates
//! windows of one reference view with every other view under `H(theta)` (B99 4.1); over the plan
//! all pairs of views are correlated on a plane at once (B99 4.3, verification).
//!
//! ```text
//! line_side_strip       the neighbourhood of a line side, and how a view is warped into it
//! windows               correlations of all windows of two strips by running sums
//! plan_grid             a raster of plan positions, and the orthophoto of a view on a plane
//! box_sum               sums over windows of the plan grid
//! consistency_map       the photo-consistency map, and what windows correlate by chance
//! pairwise_correlation  correlations of all pairs of orthophotos by running sums
//! plane_consistency     view selection and the map of a plane over the image set
//! plane_window          the same in a single window
//! shiftable_windows     windows that stay on one side of a line
//! ```
//!
//! Invariant: nothing here knows lines of the model, half-planes or facets; a plane and a grid are
//! all that a map needs.

mod box_sum;
mod consistency_map;
mod line_side_strip;
mod pairwise_correlation;
mod plan_grid;
mod plane_consistency;
mod plane_window;
mod shiftable_windows;
mod windows;

pub(crate) use box_sum::{BoxSum, HALF_WINDOW, RowSum, WINDOW, WINDOW_CELLS};
pub(crate) use consistency_map::{ConsistencyMap, MAX_VIEWS};
pub(crate) use line_side_strip::{LineSideStrip, StripPatch};
pub(crate) use pairwise_correlation::LEAST_VARIANCE;
pub(crate) use plan_grid::{CELL_SAMPLES, PlanGrid, orthophoto};
pub(crate) use plane_consistency::{
    LEAST_SLOPE, consistency_map, consistency_map_behind, consistency_map_of_surface,
    residual_variance,
};
pub(crate) use plane_window::{Agreement, WindowMatcher};
pub(crate) use shiftable_windows::ShiftableWindows;
pub(crate) use windows::CorrelationWindows;
