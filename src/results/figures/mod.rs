//! What the live figures of the page show and no trace holds, since it depends on where the reader
//! points.
//!
//! ```text
//! segment_matching    epipolar beams, candidates and outcome of a segment   B99 3.1, 3.2
//! correspondence      correspondence x' = l' x (F x), two windows           B99 3.1
//! warp                a line side under H(theta), view by view              B99 4.1
//! detected_stretches  parts of 3D lines that segments showed before growing B99 3.3
//! ```
//!
//! Invariant: nothing here feeds a stage. The stages' own functions are called wherever they exist.

mod correspondence;
mod detected_stretches;
mod segment_matching;
mod warp;

pub use correspondence::{Correspondence, correspondence};
pub use detected_stretches::detected_stretches;
pub use segment_matching::{
    Beam, PairCandidate, ReprojectedLine, SegmentMatching, segment_matching,
};
pub use warp::{WarpedView, WarpedViews, warped_views};
