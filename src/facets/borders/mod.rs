//! facets::borders

mod arrangement;
mod border_cost;
pub(crate) mod border_lines;
mod bounding;
mod extent;
mod line_index;

pub(crate) use arrangement::{Arrangement, DisjointSets};
pub(crate) use border_cost::{BorderCosts, LINE_HEIGHT};
pub(crate) use border_lines::border_lines;
pub use border_lines::{Border, BorderKind};
pub(crate) use bounding::{bounding_lines, lies_in};
pub(crate) use line_index::LineIndex;
