//! Line matching over two, three and N views (B99 3.1 - 3.4).
//!
//! ```text
//! height            the range of heights in which lines can lie
//! view_selection    pairs of views that see the same ground
//!    -> pairs       two views: epipolar beam, correlation of both sides (line_strip)         3.1
//!    -> triples     third views: trifocal transfer, a segment at the predicted position      3.2
//!    -> selection   winner takes all; each winner is completed over all views (nview)    3.2 - 3.4
//!       ahead          bundles that come next, completed on all cores
//!    -> join        lines that reproject onto each other become one                          3.4
//!
//! drawn             the line of an edge that somebody draws in one view
//!
//! segment_geometry  rays and interpretation plane of a segment; compatibility of two segments
//! index             the segments near a place of an image
//! pass, trace       first and second search; the outcome of every segment
//! ```
//!
//! Pairs and triples are of segments of one kind (steps in grey values or in the red-blue
//! difference) with the same bright side: that keeps mismatches rare. Where the scene has no more
//! than `min_views` views, a second pass matches the remaining segments without either condition:
//! of three views two may show an eave before a sunlit lawn, and the third before the shadow of the
//! house.
//!
//! Invariant: a segment belongs to at most one line. The result does not depend on the order of the
//! hypotheses.

mod ahead;
mod drawn;
mod height;
mod index;
mod join;
mod line_strip;
mod nview;
mod pairs;
mod pass;
mod segment_geometry;
mod selection;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod trace;
mod triples;
mod view_selection;

pub(crate) use drawn::shown_along;
pub use drawn::{DrawnEdge, line_of_drawn};
pub use line_strip::EdgelScore;
pub(crate) use nview::EDGE_MARGIN_PX;
pub use nview::MatchRejection;
pub use segment_geometry::{SegmentRef, epipolar_beam};
pub use trace::{MatchTrace, PairTrace, SegmentOutcome, StepCount};
pub use triples::Verification;

use self::nview::MatchContext;
use self::pairs::{PairScope, SegmentPairs};
use self::pass::Pass;
use self::segment_geometry::{Compatibility, PreparedSegments};
use self::selection::Selection;
use self::triples::TripleBundle;
use crate::base::execution::Sharded;
use crate::base::params::{Lines3dParams, MatchParams};
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::LineTrack;
use crate::orienting::scene::Scene;

/// Matches the segments of all views (one list a view, in the order of the scene's views) over
/// three and more views. Fewer than three views, or views without common ground, give no line
/// track.
pub fn match_lines(
    scene: &Scene,
    segments: &[Vec<ImageSegment>],
    params: &MatchParams,
    fitting: &Lines3dParams,
) -> Sharded<(Vec<LineTrack>, MatchTrace)> {
    let mut trace = MatchTrace::default();
    let prepared = PreparedSegments::new(scene, segments);
    let z_range = z_range(scene, &prepared, params, &mut trace)?;
    trace.view_pairs = view_selection::select_view_pairs(scene, z_range, params);
    let compatibility = Compatibility {
        contrast: params.same_contrast,
        kind: true,
    };
    let scope = PairScope {
        scene,
        prepared: &prepared,
        view_pairs: &trace.view_pairs,
        z_range,
        params,
        compatibility,
    };
    let context = MatchContext {
        scene,
        segments,
        prepared: &prepared,
        z_range,
        params,
        fitting,
        compatibility,
    };
    let mut search = MatchSearch::new(segments);
    search.run(&scope, &context, Pass::First)?;
    // With few views each of them is needed, however it shows a line.
    let few = scene.views.len() <= params.min_views;
    if few && !search.selection.lines.is_empty() {
        let compatibility = Compatibility::ANY;
        let scope = PairScope {
            compatibility,
            ..scope
        };
        let context = MatchContext {
            compatibility,
            ..context
        };
        search.run(&scope, &context, Pass::Second)?;
    }
    let MatchSearch {
        pairs,
        bundles,
        mut selection,
    } = search;
    join::join_lines(&context, &mut selection);
    trace.record(segments, &pairs, &bundles, &selection);
    let tracks = selection.lines.into_iter().map(LineTrack::from).collect();
    Ok((tracks, trace))
}

/// The heights between which lines are sought, metres: stated, estimated, or any.
fn z_range(
    scene: &Scene,
    prepared: &PreparedSegments,
    params: &MatchParams,
    trace: &mut MatchTrace,
) -> Sharded<[f64; 2]> {
    let estimated = match params.z_range_m {
        Some(z) => Some(z),
        None => height::height_range(scene, prepared)?.map(|range| {
            trace.heights_m = range.heights;
            range.z
        }),
    };
    let z_range = estimated.unwrap_or_else(|| height::any_height(scene));
    trace.z_range_m = Some(z_range);
    Ok(z_range)
}

/// All hypotheses and their outcomes.
struct MatchSearch {
    pairs: SegmentPairs,
    bundles: Vec<TripleBundle>,
    selection: Selection,
}

impl MatchSearch {
    fn new(segments: &[Vec<ImageSegment>]) -> Self {
        Self {
            pairs: SegmentPairs::default(),
            bundles: Vec::new(),
            selection: Selection::empty(segments),
        }
    }

    /// Matches the segments that no line owns yet.
    fn run(&mut self, scope: &PairScope, context: &MatchContext, pass: Pass) -> Sharded<()> {
        let taken = |s| self.selection.owner(s).is_some();
        let pairs = pairs::match_pairs(scope, taken, pass)?;
        let bundles = triples::verify_pairs(scope, &pairs, pass)?;
        selection::winner_takes_all(context, &pairs, &bundles, pass, &mut self.selection)?;
        let before = self.pairs.pairs.len();
        self.bundles
            .extend(bundles.into_iter().map(|bundle| TripleBundle {
                pair: before + bundle.pair,
                ..bundle
            }));
        self.pairs.append(pairs);
        Ok(())
    }
}

/// The range of heights in which the lines of a scene lie, metres: estimated from the segments of
/// all views, or as wide as the cameras allow.
pub fn scene_heights(scene: &Scene, segments: &[Vec<ImageSegment>]) -> Sharded<[f64; 2]> {
    let prepared = PreparedSegments::new(scene, segments);
    let range = height::height_range(scene, &prepared)?;
    Ok(range.map_or_else(|| height::any_height(scene), |range| range.z))
}
