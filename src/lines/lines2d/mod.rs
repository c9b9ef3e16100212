//! Straight image segments (B99 3.2, "Implementation details").
//!
//! ```text
//! edgels         edges as edgels with local noise, linked into chains, broken at bends
//!    -> regression     straight pieces by orthogonal regression, tight threshold, covariance
//!    -> grow     pieces grown along their line through the edgels ahead
//!    -> significant_lines    length, curvature and significance (significance) decide
//!    -> refine   lines moved to the steepest place of the unsmoothed edge
//!    -> detect   the stage: edges in grey values and in the red-blue difference
//!    -> overlap  colour edges along an edge in grey values are rejected
//!
//! segment        a segment: kind, end points, contrast, covariance
//! guided         an edge measured again along the line that other views predict
//! trace          counts, and every rejected line with its reason
//! ```
//!
//! Invariant: a step has its bright side (or the redder one) to its right as seen on the screen.

mod detect;
mod edgels;
mod grow;
mod guided;
mod overlap;
mod refine;
mod regression;
mod segment;
mod significance;
mod significant_lines;
#[cfg(test)]
mod testing;
mod trace;

pub use detect::detect_segments;
pub use edgels::{Chain, Edgel, detect_edgels, link_chains};
pub(crate) use guided::PIECE_PX;
pub use guided::{GuidedEdge, measure_edge};
pub use segment::{ImageSegment, SegmentKind};
pub use trace::{RejectedSegment, SegmentRejection, SegmentTrace};
