//! A hypothesis completed over all views (B99 3.3, 3.4).
//!
//! ```text
//! complete          the order of the steps
//!    -> fitting     the line fitted to segments or edges, the worst of which are dropped
//!    -> adopt       segments near the reprojection, and edges measured again along it       3.4
//!    -> profile     detection and correlation of every view along the line
//!    -> grow, ends  the supported stretch, merged and grown, and its ends to a pixel        3.3
//!    -> support     the views that support the stretch                                      3.2
//!    -> checks      precision and heights; what speaks for the line                         3.4
//!
//! from_edges        the same from measured edges alone, for a drawn line
//! context           the input of a completion, its result and the reasons for a rejection
//! ```
//!
//! Invariant: a completed line has measured edges in three views at least.

mod adopt;
mod checks;
mod complete;
mod context;
mod ends;
mod fitting;
mod from_edges;
mod grow;
mod profile;
mod support;

pub(crate) use complete::complete_line;
pub use context::MatchRejection;
pub(crate) use context::{CompletedLine, IsTaken, MatchContext};
pub(crate) use from_edges::{complete_from_edges, most_of_edge};
pub(crate) use profile::EDGE_MARGIN_PX;
