//! facets::borders

mod arrangement;
mod border;
mod border_cost;
mod border_lines;
mod bounding;
mod extent;
mod line_index;

pub(crate) use arrangement::Arrangement;
pub use border::{Border, BorderKind};
pub(crate) use border_cost::{BorderCosts, LINE_HEIGHT};
pub(crate) use border_lines::border_lines;
pub(crate) use bounding::{bounding_lines, lies_in};
pub(crate) use line_index::LineIndex;
