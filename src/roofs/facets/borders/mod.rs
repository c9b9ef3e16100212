//! Border lines, the cells between them, and what a border costs (B99 4.2, 4.3).
//!
//! ```text
//! border        a border line in plan, and where it comes from
//! bounding      which real lines may bound a facet
//! extent        closing lines where the views cease to agree on a plane
//! border_lines  all border lines, with new lines by plane intersection (figures 19 to 22)
//! arrangement   the plan cut into cells by the border lines
//! line_index    which real lines run along a border
//! border_cost   what a border between two planes costs
//! side_cost     the same for a side of an outline, summed exactly along it
//! ```

mod arrangement;
mod border;
mod border_cost;
mod border_lines;
mod bounding;
mod extent;
mod line_index;
mod side_cost;

pub(crate) use arrangement::Arrangement;
pub use border::{Border, BorderKind};
pub(crate) use border_cost::{BorderCosts, LINE_HEIGHT};
pub(crate) use border_lines::border_lines;
pub(crate) use bounding::bounding_lines;
pub(crate) use line_index::LineIndex;
pub(crate) use side_cost::charged_length;
