//! Planes with their regions, photo-consistency and lines, ready to compete.
//!
//! ```text
//! line_sides   photo-consistency on both sides of a line
//! single_view  evidence where only one view sees a plane
//! plane_lines  new lines in a plane from segments of several views
//! hypothesis   all of it for one plane
//! ```

mod hypothesis;
mod line_sides;
pub(crate) mod plane_lines;
pub(crate) mod single_view;

pub(crate) use hypothesis::{PlaneHypothesis, PlaneMeasurement};
pub(crate) use line_sides::crosses_surface;
pub use plane_lines::PlaneLine;
