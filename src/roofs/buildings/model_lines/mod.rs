//! The lines of the finished model: which matched lines it contradicts or finds twice, and which
//! edges of it are new lines (B99 3.4, 4.2, 4.3).
//!
//! ```text
//! surfaces      roofs, walls and ground, and the share of a line that lies on them
//! judge         what speaks for a line in this model and against it
//! duplicates    lines of which a better one shows the same edge
//! model_edges   straight edges of the facets and what is beyond them
//! new_lines     edges of the model that no line explains, measured in all views
//! verify        the order of these steps
//! ```
//!
//! Invariant: no line is removed; the id of a rejected one is returned with the reason.

mod duplicates;
mod judge;
mod model_edges;
mod new_lines;
mod surfaces;
mod verify;

pub use verify::{VerifiedLines, verify_lines};
