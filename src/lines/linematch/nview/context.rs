//! What the completion of a line reads, and the line that it returns.

use serde::Serialize;

use crate::base::evidence::Evidence;
use crate::base::geometry::Segment3;
use crate::base::params::{Lines3dParams, MatchParams};
use crate::lines::linematch::segment_geometry::{Compatibility, PreparedSegments, SegmentRef};
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::{LineFit, LineSupport, LineTrack};
use crate::orienting::scene::Scene;

/// Least number of views with a measured edge. Two interpretation planes always meet in a line;
/// only the third is evidence, to which correlation without a segment adds.
pub(super) const MIN_MEASURED: usize = 3;

/// Why a hypothesis was rejected whose segments no other line took.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum MatchRejection {
    /// No line fits the segments.
    NoFit,
    /// The line is not determined well enough across itself.
    IllConditioned,
    /// Fewer than three views have an edge.
    TooFewEdges,
    /// Too few views have a segment of their own on it.
    TooFewSegments,
    /// No stretch of it is supported by three views.
    NoStretch,
    /// Likelier false than true.
    Improbable,
    /// The supported stretch is shorter than the minimum of edgels.
    TooShort,
    /// It leaves the height range.
    OutsideHeights,
}

/// A line over N views, before lines are joined.
#[derive(Clone)]
pub struct CompletedLine {
    /// The fitted line, directed by contrast where that is the same in all views.
    pub segment: Segment3,
    /// The fit: the same line between other ends.
    pub fit: LineFit,
    /// Its supports, by view.
    pub supports: Vec<LineSupport>,
    /// What speaks for it.
    pub evidence: Evidence,
}

impl From<CompletedLine> for LineTrack {
    fn from(line: CompletedLine) -> Self {
        let sum: f64 = line.supports.iter().map(|s| s.score).sum();
        Self {
            score: sum / line.supports.len().max(1) as f64,
            evidence: line.evidence,
            supports: line.supports,
        }
    }
}

/// The input of a completion.
pub(crate) struct MatchContext<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The detected segments.
    pub segments: &'a [Vec<ImageSegment>],
    /// The same, prepared.
    pub prepared: &'a PreparedSegments,
    /// Heights between which lines are sought, metres.
    pub z_range: [f64; 2],
    /// Matching parameters.
    pub params: &'a MatchParams,
    /// Fitting parameters.
    pub fitting: &'a Lines3dParams,
    /// The properties in which the segments of a line must agree.
    pub compatibility: Compatibility,
}

/// The predicate of the segments that belong to other lines.
pub(crate) type IsTaken<'a> = &'a dyn Fn(SegmentRef) -> bool;

#[cfg(test)]
impl<'a> MatchContext<'a> {
    /// That of a first pass over a planted scene.
    pub(crate) fn of_planted(
        scene: &'a Scene,
        segments: &'a [Vec<ImageSegment>],
        prepared: &'a PreparedSegments,
        (params, fitting): (&'a MatchParams, &'a Lines3dParams),
    ) -> Self {
        Self {
            scene,
            segments,
            prepared,
            z_range: [-2.0, 8.0],
            params,
            fitting,
            compatibility: Compatibility {
                contrast: true,
                kind: true,
            },
        }
    }
}
