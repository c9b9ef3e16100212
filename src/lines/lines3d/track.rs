//! Line tracks: the segments and measured edges of several views that are images of one 3D line
//! (B99 3.4).

use serde::{Deserialize, Serialize};

use crate::base::evidence::Evidence;
use crate::base::geometry::Segment2;
use crate::base::ids::{SegmentId, ViewId};
use crate::lines::lines2d::GuidedEdge;

/// How the support of a line in one view was found (the page colours it so).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum SupportKind {
    /// A detected segment, matched.
    Matched,
    /// A detected segment joined to another one across a gap (B99 3.3, merging).
    Merged,
    /// Extended past the detected end, or found by correlation alone (B99 3.3, growing).
    Grown,
}

/// The evidence for a line in one view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LineSupport {
    /// The view.
    pub view: ViewId,
    /// The detected segments that belong to the line in this view; none where the line was
    /// verified by correlation alone.
    pub segments: Vec<SegmentId>,
    /// The stretch of the line that is supported in this view, pixels, same direction as the 3D
    /// line.
    pub stretch: Segment2,
    /// Photometric score, 0 to 1.
    pub score: f64,
    /// How it was found.
    pub kind: SupportKind,
    /// The edge measured along the line, which the 3D line is fitted to; `None` where correlation
    /// alone supports it.
    #[serde(skip)]
    pub edge: Option<GuidedEdge>,
}

/// The supports of one line in at least three views.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LineTrack {
    /// Supports, at most one a view, ordered by view.
    pub supports: Vec<LineSupport>,
    /// Mean photometric score, 0 to 1.
    pub score: f64,
    /// What speaks for it and against it: is it the image of an edge in space?
    pub evidence: Evidence,
}
