//! What the live figures of the page show and no trace holds: it depends on where the reader
//! points.
//!
//! ```text
//! beam      a segment's epipolar beams, candidates and what became of them   B99 3.1, 3.2, figures 1 to 4
//! point     pointwise correspondence x' = l' x (F x), and its two windows    B99 3.1, figure 3
//! warp      the neighbourhood of a line side under H(theta), view by view    B99 4.1, figures 10, 11 and 13
//! before    the parts of 3D lines that segments showed before growing        B99 3.3, figures 5 to 8
//! ```
//!
//! Invariant: nothing here feeds a stage. The stages' own functions are called wherever they exist.

mod beam;
mod before;
mod point;
mod warp;

pub use beam::{Beam, Candidate, Prediction, SegmentStory, segment_story};
pub use before::detected_stretches;
pub use point::{Correspondence, correspondence};
pub use warp::{WarpedView, WarpedViews, warped_views};
