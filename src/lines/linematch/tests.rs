use super::*;
use crate::base::ids::SegmentId;
use crate::lines::lines2d::SegmentKind;
use crate::lines::lines3d::{SupportKind, planted, reconstruct_lines};

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
