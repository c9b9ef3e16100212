use super::*;
use crate::base::geometry::Segment2;
use crate::base::ids::SegmentId;
use crate::lines::lines2d::SegmentKind;
use crate::lines::lines3d::{Line3d, SupportKind, planted, reconstruct_lines};

fn matched() -> (Scene, Vec<LineTrack>, MatchTrace) {
    let scene = planted::scene();
    let segments = planted::segments(&scene);
    let (matches, trace) = match_lines(
        &scene,
        &segments,
        &MatchParams::default(),
        &Lines3dParams::default(),
    )
    .unwrap();
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
    let (matches, _) = match_lines(&scene, &segments, &params, &fitting).unwrap();
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
    // Edge 1 runs along the baseline of the first two views, so that only pairs with the other
    // strip determine it.
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
        let (matches, trace) = match_lines(&scene, &segments, &params, &fitting).unwrap();
        let own = |m: &&LineTrack| m.supports[0].segments.contains(&SegmentId(1));
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

/// The lines along a planted bar, of which each view shows one segment of this kind, every other
/// one reversed.
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
    let (matches, _) = match_lines(&scene, &segments, &params, &fitting).unwrap();
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
    // As steps only those that run the same way match, at a side of the bar; there are no dark
    // bars.
    let steps = lines_of_a_bar([SegmentKind::Edge; 5]);
    let beside = |l: &Line3d| planted::bar().line_distance(&l.at(0.5)) > 0.08;
    assert!(steps.iter().all(beside));
    assert!(lines_of_a_bar([SegmentKind::DarkBar; 5]).is_empty());
    // Where three views show its sides, the other two determine the bar, and its middle is
    // measured in all.
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
    let (matches, trace) = match_lines(&scene, &segments, &params, &fitting).unwrap();
    assert!(matches.is_empty());
    assert_eq!(trace.outcomes[0].len(), segments[0].len());
}

#[test]
fn no_views_and_no_segments_are_no_error() {
    let mut scene = planted::scene();
    let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
    let none = vec![Vec::new(); 5];
    assert!(
        match_lines(&scene, &none, &params, &fitting)
            .unwrap()
            .0
            .is_empty()
    );
    scene.views.clear();
    assert!(
        match_lines(&scene, &[], &params, &fitting)
            .unwrap()
            .0
            .is_empty()
    );
}
