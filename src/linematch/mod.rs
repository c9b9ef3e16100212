//! Line matching over two, three and N views (B99 3.1 - 3.4).
//!
//! ```text
//! height, partners    where lines can be, which views see the same ground
//!    -> pairs         two views: epipolar beam (sight, index), correlation of both sides (strip)   3.1
//!    -> triples       third views: trifocal transfer, segment at the predicted position          3.2
//!    -> select        winner takes all; each winner is completed:                                3.2
//!       -> nviews     fitted over all views, views counted                                       3.4
//!       -> adopt      segments near the reprojection adopted, edges measured again               3.4
//!       -> grow       merged and grown along its profile                                         3.3
//!       -> ends       where its ends are, to a pixel                                             3.3
//!    -> join         lines that reproject onto each other are one                                3.4
//! ```
//!
//! Pairs and triples are of segments of one kind (steps in grey values or in warmth, bright or dark bars) and, if they are steps,
//! bright on one side: that keeps mismatches rare. Where there are few views, too few for `min_views` to be a choice, a second pass takes what
//! is left without asking for either: of three views two may show an eave before a sunlit lawn, and the third before the
//! shadow of the house.

mod height;
mod index;
mod nview;
mod pairs;
#[cfg(test)]
pub(crate) mod planted;
mod select;
mod sight;
mod strip;
mod trace;
mod triples;
mod view_selection;

pub(crate) use nview::{AROUND_EDGE_PX, Context};
pub use nview::{MANY_VIEWS, Rejection};
pub use sight::{SegmentRef, epipolar_beam};
pub use strip::EdgelScore;
pub use trace::{MatchTrace, PairTrace, SegmentOutcome, StepCount};
pub use triples::Verification;

use std::ops::Range;

use self::pairs::{PairScope, Pairs};
use self::select::Selection;
use self::sight::Alike;
use self::triples::Bundle;

use crate::execution::SILENT;
use crate::lines2d::ImageSegment;
use crate::lines3d::LineMatch;
use crate::params::Lines3dParams;
use crate::params::MatchParams;
use crate::scene::Scene;

/// Matches the segments of all views (one list a view, in the order of the scene's views) over
/// three and more views. Fewer than three views, or views without common ground, give no match.
pub fn match_lines(
    scene: &Scene,
    segments: &[Vec<ImageSegment>],
    params: &MatchParams,
    fitting: &Lines3dParams,
) -> (Vec<LineMatch>, MatchTrace) {
    let mut trace = MatchTrace::default();
    let sights = sight::Sights::new(scene, segments);
    let estimated = match params.z_range_m {
        Some(z) => Some(z),
        None => height::height_range(scene, &sights).map(|range| {
            trace.heights_m = range.heights;
            range.z
        }),
    };
    let z_range = estimated.unwrap_or_else(|| height::any_height(scene));
    trace.z_range_m = Some(z_range);
    trace.view_pairs = view_selection::partner_views(scene, z_range, params);

    let alike = Alike {
        contrast: params.same_contrast,
        kind: true,
    };
    let scope = PairScope {
        scene,
        sights: &sights,
        partners: &trace.view_pairs,
        z_range,
        params,
        alike,
    };
    let context = Context {
        scene,
        segments,
        sights: &sights,
        z_range,
        params,
        fitting,
        alike,
    };
    let mut found = Found::nothing_yet(segments);
    found.search(&scope, &context, Pass::First);
    // Few views: each of them is needed, however it shows a line.
    let few = scene.views.len() <= params.min_views;
    if few && !found.selection.lines.is_empty() {
        let alike = Alike {
            contrast: false,
            kind: false,
        };
        found.search(
            &PairScope { alike, ..scope },
            &Context { alike, ..context },
            Pass::Second,
        );
    }
    let Found {
        pairs,
        bundles,
        mut selection,
    } = found;
    nview::join_lines(&context, &mut selection);
    trace.record(segments, &pairs, &bundles, &selection);
    let matches = selection.lines.into_iter().map(LineMatch::from).collect();
    (matches, trace)
}

/// All hypotheses, and what became of them.
struct Found {
    pairs: Pairs,
    bundles: Vec<Bundle>,
    selection: Selection,
}

impl Found {
    fn nothing_yet(segments: &[Vec<ImageSegment>]) -> Self {
        Self {
            pairs: Pairs::default(),
            bundles: Vec::new(),
            selection: Selection::none(segments),
        }
    }

    /// Matches the segments that no line owns yet.
    fn search(&mut self, scope: &PairScope, context: &Context, pass: Pass) {
        let taken = |s| self.selection.owner(s).is_some();
        let pairs = pairs::match_pairs(scope, taken, pass);
        let bundles = triples::verify_pairs(scope, &pairs, pass);
        select::winner_takes_all(context, &pairs, &bundles, pass, &mut self.selection);
        let before = self.pairs.pairs.len();
        self.bundles
            .extend(bundles.into_iter().map(|bundle| Bundle {
                pair: before + bundle.pair,
                ..bundle
            }));
        self.pairs.append(pairs);
    }
}

/// Which of the searches through the segments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pass {
    First,
    Second,
}

impl Pass {
    /// The name under which instances share a map. They share those of the first pass only: what is left for the second
    /// one depends on all of them.
    fn map(self, name: &'static str) -> &'static str {
        match self {
            Self::First => name,
            Self::Second => "of the second pass",
        }
    }

    /// The part of the stage's progress that a map is: the second pass is short and says nothing.
    fn part(self, part: Range<f64>) -> Range<f64> {
        match self {
            Self::First => part,
            Self::Second => SILENT,
        }
    }
}

/// The range of heights, metres, in which the lines of a scene lie: estimated from the segments of all views, or as wide as
/// the cameras allow.
pub fn scene_heights(scene: &Scene, segments: &[Vec<ImageSegment>]) -> [f64; 2] {
    let sights = sight::Sights::new(scene, segments);
    height::height_range(scene, &sights).map_or_else(|| height::any_height(scene), |range| range.z)
}

impl From<nview::Line> for LineMatch {
    fn from(line: nview::Line) -> Self {
        let sum: f64 = line.supports.iter().map(|s| s.score).sum();
        Self {
            score: sum / line.supports.len().max(1) as f64,
            supports: line.supports,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Segment2;
    use crate::ids::SegmentId;
    use crate::lines2d::SegmentKind;
    use crate::lines3d::SupportKind;
    use crate::lines3d::{Line3d, reconstruct_lines};

    fn matched() -> (Scene, Vec<LineMatch>, MatchTrace) {
        let scene = planted::scene();
        let segments = planted::segments(&scene);
        let (matches, trace) = match_lines(
            &scene,
            &segments,
            &MatchParams::default(),
            &Lines3dParams::default(),
        );
        (scene, matches, trace)
    }

    #[test]
    fn planted_edges_are_matched_and_nothing_else() {
        let (scene, matches, trace) = matched();
        let (lines, _) = reconstruct_lines(&scene, &matches, &Lines3dParams::default());
        assert_eq!(lines.len(), 4);
        for edge in planted::edges() {
            let found = lines.iter().any(|l| {
                (l.segment.p0 - edge.at(0.0)).norm() < 0.3
                    && (l.segment.p1 - edge.at(1.0)).norm() < 0.3
                    && edge.line_distance(&l.at(0.5)) < 4.0 * l.sigma_m
            });
            assert!(found, "edge {edge:?}");
        }
        for (view, outcomes) in trace.outcomes.iter().enumerate() {
            for (segment, outcome) in outcomes.iter().enumerate() {
                let planted = segment < 4 || (view == 1 && segment == 4);
                let matched = matches!(outcome, SegmentOutcome::Matched { .. });
                assert_eq!(
                    planted, matched,
                    "view {view} segment {segment}: {outcome:?}"
                );
            }
        }
    }

    #[test]
    fn the_height_range_holds_roof_and_ground() {
        let (_, _, trace) = matched();
        let [low, high] = trace.z_range_m.unwrap();
        assert!(low < 0.5 && low > -6.0, "low {low}");
        assert!(high > planted::ROOF_Z && high < 14.0, "high {high}");
        assert!(trace.heights_m.len() >= 8);
    }

    #[test]
    fn fragments_merge_and_short_segments_grow() {
        let (scene, matches, _) = matched();
        let first = SegmentId(0);
        let edge = matches
            .iter()
            .find(|m| m.supports[0].segments.contains(&first))
            .unwrap();
        let broken = &edge.supports[1];
        assert_eq!(broken.segments, vec![SegmentId(0), SegmentId(4)]);
        assert_eq!(broken.kind, SupportKind::Merged);
        let short = &edge.supports[2];
        assert_eq!(short.kind, SupportKind::Grown);
        let whole = planted::part_of(&scene, 2, 0, 0.02, 0.98);
        assert!(short.stretch.length() > 0.95 * whole.length());
    }

    #[test]
    fn an_edge_missing_in_one_view_is_verified_by_correlation() {
        let scene = planted::scene();
        let mut segments = planted::segments(&scene);
        segments[3].remove(2);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let (matches, _) = match_lines(&scene, &segments, &params, &fitting);
        let edge = matches
            .iter()
            .find(|m| m.supports[0].segments.contains(&SegmentId(2)))
            .unwrap();
        assert_eq!(edge.supports.len(), 5);
        assert!(edge.supports[3].segments.is_empty());
        assert_eq!(edge.supports[3].kind, SupportKind::Grown);
    }

    #[test]
    fn where_views_are_few_they_may_show_a_line_in_different_channels() {
        // Edge 1 runs along the baseline of the first two views: only pairs with the other strip determine it.
        let mut scene = planted::scene();
        let mut segments = planted::segments(&scene);
        segments[3][1].kind = SegmentKind::Color;
        for views in [4, 2] {
            scene.views.remove(views);
            segments.remove(views);
        }
        let matched = |min_views: usize| {
            let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
            let params = MatchParams {
                min_views,
                ..params
            };
            let (matches, trace) = match_lines(&scene, &segments, &params, &fitting);
            let own = |m: &&LineMatch| m.supports[0].segments.contains(&SegmentId(1));
            let outcomes = trace.outcomes.iter().map(|view| view[1]);
            let all = outcomes.filter(|o| matches!(o, SegmentOutcome::Matched { .. }));
            (
                matches.iter().find(own).map(|m| m.supports.len()),
                all.count(),
            )
        };
        assert_eq!(matched(4), (Some(3), 3));
        assert_eq!(matched(2), (None, 0), "three views are not few then");
    }

    /// The lines along a planted bar that each view shows as one segment of a kind, every other one running backwards.
    fn lines_of_a_bar(kinds: [SegmentKind; 5]) -> Vec<Line3d> {
        let scene = planted::scene_with_bar();
        let image = |(view, kind): (usize, SegmentKind)| {
            let camera = &scene.views[view].camera;
            let [start, end] = [0.05, 0.95].map(|t| camera.project(&planted::bar().at(t)).unwrap());
            let along = Segment2::new(start, end);
            let segment = if view.is_multiple_of(2) {
                along
            } else {
                along.reversed()
            };
            vec![ImageSegment {
                kind,
                ..planted::detected(segment, view)
            }]
        };
        let segments: Vec<_> = kinds.into_iter().enumerate().map(image).collect();
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let (matches, _) = match_lines(&scene, &segments, &params, &fitting);
        reconstruct_lines(&scene, &matches, &fitting).0
    }

    #[test]
    fn bars_are_matched_with_bars_whichever_way_they_run() {
        let lines = lines_of_a_bar([SegmentKind::BrightBar; 5]);
        assert_eq!(lines.len(), 1);
        for end in [lines[0].segment.p0, lines[0].segment.p1] {
            let miss = planted::bar().line_distance(&end);
            assert!(miss < 0.05, "{miss} m: half a pixel beside its middle");
        }
        assert!(lines[0].segment.length() > 7.0, "of eight metres");
        // Taken for steps, those that run the same way are: at a side of the bar. Of dark bars the photographs show nothing.
        let steps = lines_of_a_bar([SegmentKind::Edge; 5]);
        let beside = |l: &Line3d| planted::bar().line_distance(&l.at(0.5)) > 0.08;
        assert!(steps.iter().all(beside));
        assert!(lines_of_a_bar([SegmentKind::DarkBar; 5]).is_empty());
        // Where three views give its sides, the other two determine it, and its middle is measured in all.
        let mut kinds = [SegmentKind::BrightBar; 5];
        (kinds[0], kinds[1], kinds[4]) = (SegmentKind::Edge, SegmentKind::Edge, SegmentKind::Edge);
        let lines = lines_of_a_bar(kinds);
        let in_the_middle: Vec<_> = lines.iter().filter(|l| !beside(l)).collect();
        assert_eq!(in_the_middle.len(), 1);
        assert_eq!(in_the_middle[0].supports.len(), 5);
    }

    #[test]
    fn two_views_give_no_match() {
        let mut scene = planted::scene();
        let mut segments = planted::segments(&scene);
        scene.views.truncate(2);
        segments.truncate(2);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let (matches, trace) = match_lines(&scene, &segments, &params, &fitting);
        assert!(matches.is_empty());
        assert_eq!(trace.outcomes[0].len(), segments[0].len());
    }

    #[test]
    fn no_views_and_no_segments_are_no_error() {
        let mut scene = planted::scene();
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let none = vec![Vec::new(); 5];
        assert!(match_lines(&scene, &none, &params, &fitting).0.is_empty());
        scene.views.clear();
        assert!(match_lines(&scene, &[], &params, &fitting).0.is_empty());
    }
}
