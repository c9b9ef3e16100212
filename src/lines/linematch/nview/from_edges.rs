//! A line completed from the edges measured along it, without any detected segment (B99 3.4): for
//! what somebody has drawn in one view.

use super::context::{CompletedLine, MIN_MEASURED, MatchContext};
use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::{SegmentId, ViewId};
use crate::base::params::{Lines3dParams, MatchParams};
use crate::lines::linematch::segment_geometry::{Compatibility, PreparedSegments, SegmentRef};
use crate::lines::lines2d::{GuidedEdge, ImageSegment, SegmentKind, measure_edge};
use crate::lines::lines3d::ProjectedLine;
use crate::orienting::scene::{Scene, View};

/// Number of measurements and fits: the second measures along the first one's line.
const MEASUREMENT_ROUNDS: usize = 2;
/// A step in grey values or in colour, either side of it bright.
const POLARITIES: [(SegmentKind, bool); 4] = [
    (SegmentKind::Edge, false),
    (SegmentKind::Edge, true),
    (SegmentKind::Color, false),
    (SegmentKind::Color, true),
];

/// The line near `start` that fits the edge `own` of one view and the edges that the other views
/// show along it, two of them at least, if it is likelier true than false; `None` where there is
/// none.
pub(crate) fn complete_from_edges(
    scene: &Scene,
    start: &Segment3,
    own: &GuidedEdge,
    z_range: [f64; 2],
    (params, fitting): (&MatchParams, &Lines3dParams),
) -> Option<CompletedLine> {
    let undetected: Vec<Vec<ImageSegment>> = vec![Vec::new(); scene.views.len()];
    let none = PreparedSegments::new(scene, &undetected);
    let context = MatchContext {
        scene,
        segments: &undetected,
        prepared: &none,
        z_range,
        params,
        fitting,
        compatibility: Compatibility::ANY,
    };
    let (mut line, mut found) = (*start, None);
    for _ in 0..MEASUREMENT_ROUNDS {
        let others = scene.view_ids().filter(|view| *view != own.view);
        let mut edges: Vec<GuidedEdge> = others
            .filter_map(|view| measured(view, scene.view(view), &line))
            .chain([own.clone()])
            .collect();
        edges.sort_by_key(|edge| edge.view);
        (edges.len() >= MIN_MEASURED).then_some(())?;
        let (fit, kept) = context.fit_edges(&line, &edges).ok()?;
        kept.iter().any(|e| e.view == own.view).then_some(())?;
        line = fit.line;
        found = Some((fit, kept));
    }
    let (fit, edges) = found?;
    let names: Vec<SegmentRef> = edges.iter().map(|e| name(e.view)).collect();
    let mut segments = undetected.clone();
    for edge in &edges {
        segments[edge.view.index()].push(ImageSegment {
            kind: edge.kind,
            segment: edge.segment,
            contrast: 0.0,
            edgels: edge.segment.length() as u32,
            covariance: edge.covariance,
        });
    }
    let prepared = PreparedSegments::new(scene, &segments);
    let context = MatchContext {
        segments: &segments,
        prepared: &prepared,
        ..context
    };
    let profile = context.profile(&fit.line, &names, &edges).ok()?;
    let whole = (0, profile.t.len().checked_sub(1)?);
    let ends = [profile.t[whole.0], profile.t[whole.1]];
    let (supports, seeing) = (
        context.supports(&profile, whole),
        context.seeing_views(&profile, whole),
    );
    context.judge_line(fit, ends, seeing, supports).ok()
}

/// The only segment of a view.
fn name(view: ViewId) -> SegmentRef {
    let segment = SegmentId(0);
    SegmentRef { view, segment }
}

/// The edge that a view shows along the image of a line, of the polarity that shows most of it.
fn measured(view: ViewId, seen: &View, line: &Segment3) -> Option<GuidedEdge> {
    let image = ProjectedLine::new(&seen.camera, line)?;
    most_of_edge(
        view,
        seen,
        &Segment2::new(image.at(0.0)?, image.at(line.length())?),
    )
}

/// The edge that a view shows along an image line, of the polarity that shows most of it.
pub(crate) fn most_of_edge(view: ViewId, seen: &View, expected: &Segment2) -> Option<GuidedEdge> {
    let of = |(kind, against): (SegmentKind, bool)| {
        let channel = seen.channel(kind.channel());
        let core = [0.0, expected.length()];
        measure_edge(view, channel, kind, expected, core, against)
    };
    // The first of the best.
    let found = POLARITIES.into_iter().rev().filter_map(of);
    found.max_by_key(|edge| edge.pieces.len())
}
