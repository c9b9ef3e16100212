//! linematch::nview

mod adopt;
mod ends;
mod grow;
mod join;
mod nviews;
mod profile;

pub(crate) use join::join_lines;
pub(crate) use nviews::{Context, Line, complete_line};
pub use nviews::{MANY_VIEWS, Rejection};
pub(crate) use profile::AROUND_EDGE_PX;
