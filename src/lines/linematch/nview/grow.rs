//! Merging and growing (B99 3.3): the stretch of a 3D line that the views support.
//!
//! * A place is supported where most of the views with an edge have it there, of those whose image
//!   reaches the place.
//! * Growing: where one view too few has the edge, the place counts if the neighbourhoods
//!   correlate over three views ("the end points may be extended provided the grown edgels satisfy
//!   the photometric correlation tests over the three views").
//! * Merging: a gap between fragments in all views is bridged by the same test. A stretch that has
//!   only grown beyond the gap is no fragment, because on textured ground single pieces line up by
//!   chance.

use super::profile::LineProfile;
use crate::base::params::MatchParams;

/// Gaps of this many edgels are closed without a test, as in chains ("jumping up to a one pixel
/// gap", 3.2).
const CLOSED_GAP_PX: usize = 1;
/// Share of a gap's edgels that must correlate over three views.
const GAP_SHARE: f64 = 0.8;

/// The supported stretch: first and last edgel of the profile. `None` where too few views agree.
pub(super) fn supported_stretch(
    profile: &LineProfile,
    params: &MatchParams,
) -> Option<(usize, usize)> {
    let n = profile.t.len();
    let needed = needed_views(profile.measured());
    let detections: Vec<usize> = (0..n).map(|e| profile.detections(e)).collect();
    let agreeing: Vec<bool> = (0..n).map(|e| profile.agreeing(e, params) >= 3).collect();
    let support: Vec<Support> = (0..n)
        .map(|e| match detections[e] {
            d if d >= needed.min(needed_of(profile.reaching(e))) => Support::Detected,
            d if d + 1 >= needed.max(3) && agreeing[e] => Support::Grown,
            _ => Support::None,
        })
        .collect();
    let (start, end) = longest_run(&detections, needed)?;
    let forward = extend(&support[end..], &agreeing[end..], params);
    let backward = extend(
        &reversed(&support[..=start]),
        &reversed(&agreeing[..=start]),
        params,
    );
    Some((start - backward, end + forward))
}

/// How a place of the line is supported.
#[derive(Clone, Copy, PartialEq)]
enum Support {
    /// Enough views detected the edge there.
    Detected,
    /// One too few did, but the neighbourhoods correlate.
    Grown,
    /// Neither.
    None,
}

fn reversed<T: Copy>(values: &[T]) -> Vec<T> {
    values.iter().rev().copied().collect()
}

/// Number of views that must have the edge at a place, of those that have it anywhere: more than
/// half, because in a textured neighbourhood single pieces line up by chance.
fn needed_views(measured: usize) -> usize {
    (measured / 2 + 1).max(2)
}

/// The same for a place that so many of them reach: a single one suffices where no other reaches.
fn needed_of(reaching: usize) -> usize {
    needed_views(reaching).min(reaching.max(1))
}

/// The longest run of edgels that enough views detected.
fn longest_run(detections: &[usize], needed: usize) -> Option<(usize, usize)> {
    let mut best: Option<(usize, usize)> = None;
    let mut start = 0;
    for (e, d) in detections.iter().enumerate() {
        if *d < needed {
            start = e + 1;
        } else if best.is_none_or(|(s, t)| e - start > t - s) {
            best = Some((start, e));
        }
    }
    best
}

/// Number of edgels by which support extends beyond the first one, which is supported.
fn extend(support: &[Support], agreeing: &[bool], params: &MatchParams) -> usize {
    let mut reached = 0;
    while reached + 1 < support.len() {
        let beyond = &support[reached + 1..];
        if beyond[0] != Support::None {
            reached += 1;
            continue;
        }
        let Some(gap) = beyond.iter().position(|s| *s == Support::Detected) else {
            break;
        };
        let bridged = &agreeing[reached + 1..reached + 1 + gap];
        let agreed = bridged.iter().filter(|a| **a).count() as f64;
        let by_correlation = gap as f64 <= params.max_gap_px && agreed >= GAP_SHARE * gap as f64;
        if gap > CLOSED_GAP_PX && !by_correlation {
            break;
        }
        reached += gap + 1;
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::super::profile::ViewProfile;
    use super::*;
    use crate::base::geometry::Segment2;
    use crate::base::ids::ViewId;
    use crate::lines::lines2d::GuidedEdge;
    use crate::lines::lines2d::SegmentKind;
    use crate::lines::lines3d::ProjectedLine;
    use crate::lines::lines3d::planted;
    use nalgebra::{Matrix2, Point2};

    fn bools(s: &str) -> Vec<bool> {
        s.bytes().map(|b| b == b'x').collect()
    }

    /// The extension of `support`: x where enough views detected the edge, g where it has grown.
    fn reach(support: &str, agreeing: &str) -> usize {
        let at = |b| match b {
            b'x' => Support::Detected,
            b'g' => Support::Grown,
            _ => Support::None,
        };
        let support: Vec<Support> = support.bytes().map(at).collect();
        extend(&support, &bools(agreeing), &MatchParams::default())
    }

    #[test]
    fn holes_are_closed_and_gaps_need_correlation() {
        assert_eq!(reach("xxxx.xxxx", "........."), 8, "one edgel");
        assert_eq!(reach("xxx..xxx", "........"), 2, "two");
        assert_eq!(
            reach("xx........xx", "............"),
            1,
            "an unsupported gap"
        );
        assert_eq!(reach("xx........xx", ".xxxxxxxxxx."), 11, "a bridged gap");
        assert_eq!(
            reach("xxxx........", "xxxxxxxxxxxx"),
            3,
            "nothing beyond a gap"
        );
    }

    #[test]
    fn gaps_are_bridged_to_fragments_only() {
        let agreeing = "xxxxxxxxxxxxxx";
        assert_eq!(reach("xxgg......gggg", agreeing), 3, "grown beyond a gap");
        assert_eq!(
            reach("xxgg......ggxx", agreeing),
            13,
            "a fragment behind it"
        );
        assert_eq!(reach("xxgg..ggg.....", agreeing), 3, "beyond a small one");
    }

    /// The last edgel of a line that five views show up to edgel 25 and one of them up to 39; the
    /// images of the others end at `reach`.
    fn end_where_one_goes_on(reach: usize) -> usize {
        let (scene, line) = (planted::scene(), planted::edges()[0]);
        let camera = |view: usize| &scene.views[view % scene.views.len()].camera;
        let view = |index: usize| {
            let end = if index == 0 { 40 } else { 25 };
            let image_end = if index == 0 { 40 } else { reach };
            ViewProfile {
                view: ViewId(index as u32),
                image: ProjectedLine::new(camera(index), &line).expect("in front"),
                segments: Vec::new(),
                edge: Some(GuidedEdge {
                    view: ViewId(index as u32),
                    kind: SegmentKind::Edge,
                    segment: Segment2::new(Point2::origin(), Point2::new(40.0, 0.0)),
                    covariance: Matrix2::identity(),
                    pieces: Vec::new(),
                }),
                detected: (0..40).map(|e| e < end).collect(),
                inside: (0..40).map(|e| e < image_end).collect(),
                correlation: vec![0.0; 40],
                agreement: 1.0,
            }
        };
        let profile = LineProfile {
            t: (0..40).map(|e| e as f64 * 0.1).collect(),
            reference: 0,
            views: (0..5).map(view).collect(),
        };
        let (start, end) = supported_stretch(&profile, &MatchParams::default()).expect("a line");
        assert_eq!(start, 0);
        end
    }

    #[test]
    fn a_line_goes_on_where_one_view_is_left_but_not_where_the_others_show_none() {
        assert_eq!(end_where_one_goes_on(25), 39);
        assert_eq!(end_where_one_goes_on(40), 24);
        // Of two views that reach a place one alone is not enough.
        assert_eq!(end_where_one_goes_on(32), 24);
    }

    #[test]
    fn most_of_the_views_that_reach_a_place_must_see_the_edge_there() {
        // Of five views three must, and of fewer most; the last one alone is enough.
        assert_eq!([5, 4, 3, 2, 1].map(needed_of), [3, 3, 2, 2, 1]);
        assert_eq!(needed_of(0), 1, "where none reaches, none sees it");
    }

    #[test]
    fn the_longest_run_starts() {
        assert_eq!(longest_run(&[2, 1, 2, 3, 2, 0, 2, 2], 2), Some((2, 4)));
        assert_eq!(longest_run(&[1, 0, 1], 2), None);
    }
}
