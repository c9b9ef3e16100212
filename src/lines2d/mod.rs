//! Straight image segments (B99 3.2, "Implementation details").
//!
//! ```text
//! canny          gradient, sub-pixel edgels above a multiple of the local noise (noise)
//!    -> chain    edgels linked over gaps of one pixel, hysteresis
//!    -> worm     chains broken where the tangent turns
//!    -> fit      straight pieces by orthogonal regression, tight threshold, covariance
//!    -> grow     pieces grown along their line through the edgels ahead
//!    -> lines    length, curvature and significance decide
//!    -> refine   lines moved to the crest of the unsmoothed edge
//!    -> segments covariance and contrast; bars that edges stand for are refused
//!
//! bar            thin bright or dark lines as edgels, on the same way from chain to lines
//! ```

mod bar;
mod canny;
mod chain;
mod fit;
mod grow;
mod lines;
mod noise;
mod refine;
mod segments;
mod significance;
#[cfg(test)]
mod testing;
mod trace;
mod worm;

pub use canny::{Edgel, detect_edgels};
pub use chain::{Chain, link_chains};
pub use segments::detect_segments;
pub use trace::{RejectedSegment, SegmentRejection, SegmentTrace};

use nalgebra::Matrix2;
use serde::{Deserialize, Serialize};

use crate::geometry::Segment2;

/// What a segment was found on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SegmentKind {
    /// A step between two grey values.
    #[default]
    Edge,
    /// A thin line brighter than both its sides.
    BrightBar,
    /// A thin line darker than both its sides.
    DarkBar,
}

/// A straight segment detected in one view, directed by contrast: the brighter side lies in the
/// direction of [`Segment2::normal`], to the right of the direction as seen on the screen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageSegment {
    /// Edge or bar. A bar runs along its middle and is directed by the difference between its two sides, which may
    /// be small: its direction is no more than a hint.
    pub kind: SegmentKind,
    /// End points, pixels.
    pub segment: Segment2,
    /// Mean grey-value difference across the edge, bright minus dark side, 0 to 1.
    pub contrast: f32,
    /// Number of edgels that the line was fitted to.
    pub edgels: u32,
    /// Covariance of (offset along the normal at the midpoint in px, angle in rad), 2 x 2.
    pub covariance: Matrix2<f64>,
}
