//! From a pair or triple to a line over N views (B99 3.4): the 3D line is projected into all views,
//! segments near the projection are adopted, the line is fitted again, merged and grown, and its
//! views are counted.

use super::context::{CompletedLine, IsTaken, MIN_MEASURED, MatchContext, MatchRejection};
use super::ends::located_ends;
use super::grow::supported_stretch;
use super::profile::LineProfile;
use crate::base::geometry::Segment3;
use crate::lines::linematch::segment_geometry::SegmentRef;
use crate::lines::lines2d::GuidedEdge;
use crate::lines::lines3d::LineFit;

/// Number of adoptions and fits. Assumption: the second round changes few lines, a third none.
const ADOPTION_ROUNDS: usize = 2;

/// Least sum of the views with an edge and the views with a detected segment: three and three, or
/// four and two where edges were measured again.
const MIN_EVIDENCE: usize = 6;

/// The same in a scene of three views, where two with segments suffice: there are fewer chances to
/// be wrong and no fourth view to replace a missed segment.
const MIN_EVIDENCE_OF_THREE: usize = 5;

/// Distance from a line, in gates, within which segments belong to it and start no other line.
/// Assumption: they may be half a gate beyond what supports it.
const OWN_GATES: f64 = 1.5;

/// Completes a hypothesis from some of its segments; `taken` names those of other lines.
pub(crate) fn complete_line(
    context: &MatchContext,
    start: &Segment3,
    seeds: &[SegmentRef],
    taken: IsTaken,
) -> Result<CompletedLine, MatchRejection> {
    let (mut fit, mut segments) = context.fit_consistent(start, seeds)?;
    for _ in 0..ADOPTION_ROUNDS {
        let adopted = context.adopt(&fit.line, &segments, &[], 1.0, taken);
        (fit, segments) = context.fit_consistent(&fit.line, &adopted)?;
    }
    let (fit, edges) = context.measure_again(fit, &segments, taken)?;
    let segments = context.adopt(&fit.line, &segments, &edges, OWN_GATES, taken);
    let evidence = edges.len() + views_of(&segments);
    if evidence < context.least_evidence() {
        return Err(MatchRejection::TooFewSegments);
    }
    let profile = context.profile(&fit.line, &segments, &edges)?;
    let stretch = supported_stretch(&profile, context.params).ok_or(MatchRejection::NoStretch)?;
    let stretch = located_ends(context.scene, &profile, stretch);
    if stretch.1 - stretch.0 + 1 < context.params.min_edgels {
        return Err(MatchRejection::TooShort);
    }
    let supports = context.supports(&profile, stretch);
    let ends = [profile.t[stretch.0], profile.t[stretch.1]];
    context.judge_line(fit, ends, context.seeing_views(&profile, stretch), supports)
}

impl MatchContext<'_> {
    pub(super) fn profile(
        &self,
        line: &Segment3,
        segments: &[SegmentRef],
        edges: &[GuidedEdge],
    ) -> Result<LineProfile, MatchRejection> {
        LineProfile::new(
            self.scene,
            self.prepared,
            line,
            segments,
            edges,
            self.params,
        )
        .ok_or(MatchRejection::NoFit)
    }

    /// Measures the edge again in every view that sees the line, and fits the line to the edges.
    fn measure_again(
        &self,
        mut fit: LineFit,
        segments: &[SegmentRef],
        taken: IsTaken,
    ) -> Result<(LineFit, Vec<GuidedEdge>), MatchRejection> {
        let mut edges = Vec::new();
        for _ in 0..ADOPTION_ROUNDS {
            let found: Vec<GuidedEdge> = (self.scene.view_ids())
                .filter_map(|view| self.measure(&fit.line, segments, view, taken))
                .collect();
            (fit, edges) = self.fit_edges(&fit.line, &found)?;
        }
        Ok((fit, edges))
    }

    fn least_evidence(&self) -> usize {
        if self.scene.views.len() > MIN_MEASURED {
            MIN_EVIDENCE
        } else {
            MIN_EVIDENCE_OF_THREE
        }
    }
}

/// Number of views among segments sorted by view.
fn views_of(segments: &[SegmentRef]) -> usize {
    segments.chunk_by(|a, b| a.view == b.view).count()
}
