//! Lines that the finished model contradicts (B99 3.4: no mismatches).
//!
//! Matching knows no surfaces. An eave in one view and the foot of the wall in two others, or
//! parallel edges of two buildings, may meet in a line inside a house or under the street, and no
//! view shows that. Once there are roofs and a ground, two kinds of lines are impossible and two
//! unlikely:
//!
//! * occluded: fewer than three of its views can see the line past the roofs, so that it was never
//!   verified (B99 3.2);
//! * below the ground: a line that starts at the ground or above it and goes into it was matched
//!   with a wrong slope. What lies below the ground as a whole stays, because there the ground is
//!   more likely to be wrong;
//! * too few views: three views show the line where six can see it, although "a match has to be
//!   supported by a minimal number of views (here 4)". Matching lets it pass if the three are very
//!   alike, because houses may occlude it in all others;
//! * on no surface: the line lies on neither roof nor wall nor ground. Fences, cars and missed
//!   roofs have such lines, but one in twenty of them is a mismatch, of the others one in eight
//!   hundred. Its views therefore need the evidence that three views must give by themselves (150 %
//!   of the threshold, B99 3.2); each counts with its score, weighted by the residual of its edge,
//!   and each view that should show the line and does not is a penalty. Most lines of buildings are
//!   horizontal, and of those that slope most lie on roofs: a sloping line on no surface is a
//!   mismatch seven times as often as a horizontal one, and needs a fourth view.

use nalgebra::Point3;

use super::surfaces::{Surfaces, share_where};
use crate::ids::{LineId, ViewId};
use crate::linematch::EDGE_MARGIN_PX;
use crate::lines2d::GuidedEdge;
use crate::lines3d::{
    Line3d, LineContradiction, LineOrigin, LineSupport, Observation, ProjectedLine,
};
use crate::model::{Facet, Occluders};
use crate::params::{Lines3dParams, Params};
use crate::scene::Scene;
use crate::terrain::Ground;

/// Number of views of a line from which on [`crate::params::MatchParams::min_views`] must support
/// it (B99 3.4).
const MANY_VIEWS: usize = 6;
/// Least number of views that must be able to see a line.
const MIN_VIEWS: usize = 3;
/// Photometric score of a view that shows a line which lies on no surface. B99 3.2: half as much
/// again as that of a pair.
const ALIKE: f64 = 0.75;
/// A view does not see a stretch of which this share is occluded.
const OCCLUDED_SHARE: f64 = 0.5;
/// Walls stand back below their eaves by up to this, metres. Assumption.
const EAVE_OVERHANG_M: f64 = 0.8;
/// Roughness of the ground about its map, metres. Assumption.
const ROUGHNESS_M: f64 = 0.25;
/// Standard deviations by which a depth below the ground, or a slope, is significant.
const SIGNIFICANT_SIGMAS: f64 = 2.0;
/// Least slope of a line (sine of 6 degrees): the map of the ground may miss less, and gutters and
/// flat roofs have less.
const LEAST_SLOPE: f64 = 0.1;
/// Least share of a line that lies on surfaces.
const MIN_SURFACE_SHARE: f64 = 0.8;
/// Penalty on the sum of scores for each view that should show a line and does not. Assumption.
const MISSING_VIEW_PENALTY: f64 = 0.1;

/// The lines that roofs and ground contradict, and why.
pub(super) fn contradicted_lines(
    scene: &Scene,
    lines: &[Line3d],
    facets: &[Facet],
    ground: &Ground,
    params: &Params,
) -> Vec<(LineId, LineContradiction)> {
    let surfaces = Surfaces::new(facets, ground);
    let reasons = crate::execution::map(lines, |_, line| {
        if dips_below_ground(line, ground) {
            Some(LineContradiction::Underground)
        } else if is_occluded(scene, line, &surfaces.roofs) {
            Some(LineContradiction::Hidden)
        } else if lies_on_no_surface(scene, line, &surfaces, params) {
            Some(LineContradiction::OffSurface)
        } else if has_too_few_views(scene, line, &surfaces.roofs, params) {
            Some(LineContradiction::TooFewViews)
        } else {
            None
        }
    });
    let contradicted =
        |(i, why): (usize, Option<LineContradiction>)| Some((LineId::from_index(i), why?));
    reasons
        .into_iter()
        .enumerate()
        .filter_map(contradicted)
        .collect()
}

/// Does a matched or clustered line lie on no surface, with too little evidence in the views to
/// stand without one?
fn lies_on_no_surface(scene: &Scene, line: &Line3d, surfaces: &Surfaces, params: &Params) -> bool {
    let views = MIN_VIEWS + usize::from(slopes(line));
    let required = views as f64 * ALIKE;
    matches!(line.origin, LineOrigin::Matched | LineOrigin::Clustered)
        && surfaces.share_of(line) < MIN_SURFACE_SHARE
        && image_evidence(scene, line, &surfaces.roofs, &params.lines3d) < required
}

/// Is one end of a line significantly higher than the other?
fn slopes(line: &Line3d) -> bool {
    let rise = (line.segment.p1.z - line.segment.p0.z).abs();
    rise >= LEAST_SLOPE * line.segment.length()
        && rise > SIGNIFICANT_SIGMAS * std::f64::consts::SQRT_2 * line.sigma_m
}

/// Does a line start above the ground and end significantly below it?
fn dips_below_ground(line: &Line3d, ground: &Ground) -> bool {
    let height = |p: &Point3<f64>| p.z - ground.z_at(&p.xy());
    let (start, end) = (height(&line.segment.p0), height(&line.segment.p1));
    let tolerance = ROUGHNESS_M + SIGNIFICANT_SIGMAS * line.sigma_m;
    let slopes = (start - end).abs() >= LEAST_SLOPE * line.segment.length();
    slopes && start.min(end) < -tolerance && start.max(end) > -ROUGHNESS_M
}

/// Is the line occluded in all but two of its views, or in one of two? An intersection of planes
/// needs no view.
fn is_occluded(scene: &Scene, line: &Line3d, occluders: &Occluders) -> bool {
    let sees = |support: &&LineSupport| sees(scene, line, support, occluders);
    line.supports.iter().filter(sees).count() < MIN_VIEWS.min(line.supports.len())
}

/// Can a view see most of the stretch that it supports?
fn sees(scene: &Scene, line: &Line3d, support: &LineSupport, occluders: &Occluders) -> bool {
    let camera = scene.camera(support.view);
    let Some(image) = ProjectedLine::new(camera, &line.segment) else {
        return false;
    };
    let length = line.segment.length();
    let [from, to] = [support.stretch.p0, support.stretch.p1].map(|p| image.t_of(&p) / length);
    share_where(line, [from, to], |p| {
        !occluders.hide_past_eaves(p, &camera.center, EAVE_OVERHANG_M)
    }) > 1.0 - OCCLUDED_SHARE
}

/// Do fewer views than required show a matched line that six can see (B99 3.4)? Three are enough
/// for the foot of a wall, which is occluded in the other strip.
fn has_too_few_views(scene: &Scene, line: &Line3d, occluders: &Occluders, params: &Params) -> bool {
    let can_see = |view: &ViewId| can_see(scene, line, *view, occluders);
    line.origin == LineOrigin::Matched
        && line.supports.len() < params.matching.min_views
        && scene.view_ids().filter(can_see).count() >= MANY_VIEWS
}

/// Sum of the scores of the views that show the edge, each weighted by its residual, less the
/// penalty of the views that should show it and do not.
fn image_evidence(
    scene: &Scene,
    line: &Line3d,
    occluders: &Occluders,
    fitting: &Lines3dParams,
) -> f64 {
    let supports = line.supports.iter();
    let shown: Vec<(f64, &GuidedEdge)> = supports
        .filter_map(|s| Some((s.score, s.edge.as_ref()?)))
        .collect();
    let missing = (scene.view_ids())
        .filter(|view| shown.iter().all(|(_, edge)| edge.view != *view))
        .filter(|view| can_see(scene, line, *view, occluders));
    let weighted_scores = shown.iter().map(|(score, edge)| {
        let seen = Observation::of(edge, scene.camera(edge.view));
        score * seen.weight(&line.segment, fitting)
    });
    weighted_scores.sum::<f64>() - MISSING_VIEW_PENALTY * missing.count() as f64
}

/// Does a view's image contain most of a line, without a roof in front of it?
fn can_see(scene: &Scene, line: &Line3d, view: ViewId, occluders: &Occluders) -> bool {
    let camera = scene.camera(view);
    let visible = |p: &Point3<f64>| {
        let image = camera.project(p);
        image.is_some_and(|x| camera.contains(&x, EDGE_MARGIN_PX))
            && !occluders.hide_past_eaves(p, &camera.center, EAVE_OVERHANG_M)
    };
    share_where(line, [0.0, 1.0], visible) > 1.0 - OCCLUDED_SHARE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Segment2;
    use crate::lines2d::SegmentKind;
    use crate::lines3d::SupportKind;
    use crate::synthetic::{SyntheticTruth, gable_scene};
    use crate::testing;

    /// A line that these views of a scene show along all its length.
    fn line(scene: &Scene, ends: [Point3<f64>; 2], views: impl Iterator<Item = u32>) -> Line3d {
        let support = |view: u32| {
            let camera = scene.camera(ViewId(view));
            let [p0, p1] = ends.map(|p| camera.project(&p).expect("in front"));
            LineSupport {
                view: ViewId(view),
                segments: Vec::new(),
                stretch: Segment2::new(p0, p1),
                score: 0.9,
                kind: SupportKind::Matched,
                edge: Some(GuidedEdge {
                    view: ViewId(view),
                    kind: SegmentKind::Edge,
                    segment: Segment2::new(p0, p1),
                    covariance: nalgebra::Matrix2::identity(),
                    pieces: Vec::new(),
                }),
            }
        };
        Line3d {
            supports: views.map(support).collect(),
            ..testing::line(ends[0], ends[1])
        }
    }

    #[test]
    fn a_line_that_roofs_occlude_in_all_but_two_views_is_contradicted() {
        let (scene, truth) = gable_scene(64);
        let roof = roof_of(&truth);
        let corners = roof.iter().flat_map(|f| &f.outer);
        let top = corners.clone().fold(f64::MIN, |top, p| top.max(p.z));
        let ridge: Vec<Point3<f64>> = (roof[0].outer.iter())
            .filter(|p| top - p.z < 1e-9)
            .copied()
            .collect();
        let below = |depth: f64| [0, 1].map(|i| ridge[i] - nalgebra::Vector3::z() * depth);
        let lines = [
            line(&scene, below(0.0), 0..6),
            line(&scene, below(2.0), 0..6),
            // Nothing occludes a line high above the roof; an intersection of planes has no views.
            line(&scene, below(-2.0), 0..4),
            Line3d {
                origin: LineOrigin::Intersection,
                ..line(&scene, below(2.0), 0..0)
            },
        ];
        let ground = Ground::level(top - 100.0);
        let contradicted = |roof: &[Facet]| contradicted(&scene, &lines, roof, &ground);
        assert_eq!(
            contradicted(&roof),
            [(LineId(1), LineContradiction::Hidden)]
        );
        assert_eq!(contradicted(&[]), []);
    }

    fn roof_of(truth: &SyntheticTruth) -> Vec<Facet> {
        let rings = truth.facets.iter().map(|(_, ring)| ring);
        rings.map(|ring| testing::facet(ring)).collect()
    }

    fn contradicted(
        scene: &Scene,
        lines: &[Line3d],
        facets: &[Facet],
        ground: &Ground,
    ) -> Vec<(LineId, LineContradiction)> {
        contradicted_lines(scene, lines, facets, ground, &Params::default())
    }

    #[test]
    fn a_line_on_no_surface_needs_more_evidence_in_the_views() {
        let (scene, truth) = gable_scene(320);
        let roof = roof_of(&truth);
        let ground = Ground::level(truth.ground_z);
        let ridge = truth.edges[0];
        let raised =
            |by: [f64; 2]| [0, 1].map(|i| ridge.at(i as f64) + nalgebra::Vector3::z() * by[i]);
        // The edge of the first view lies `beside_px` beside the image of the line.
        let reason_for = |ends: [Point3<f64>; 2], views: u32, score: f64, beside_px: f64| {
            let mut line = line(&scene, ends, 0..views);
            for support in &mut line.supports {
                support.score = score;
            }
            let edge = line.supports[0].edge.as_mut().expect("measured");
            let across = edge.segment.normal() * beside_px;
            edge.segment = Segment2::new(edge.segment.p0 + across, edge.segment.p1 + across);
            let contradicted = contradicted(&scene, &[line], &roof, &ground);
            contradicted.first().map(|(_, why)| *why)
        };
        let reason =
            |by: f64, views: u32, score: f64| reason_for(raised([by, by]), views, score, 0.0);
        assert_eq!(reason(0.0, 4, 0.3), None, "on the roof");
        assert_eq!(reason(2.0, 4, 0.3), Some(LineContradiction::OffSurface));
        // Four fifths of it have to lie on something.
        let prolonged = |by: f64| reason_for([ridge.at(0.0), ridge.at(1.0 + by)], 4, 0.3, 0.0);
        assert_eq!(prolonged(0.1), None);
        assert_eq!(prolonged(0.4), Some(LineContradiction::OffSurface));
        // Four of six views at 0.6 are 2.4, less a tenth for each of the two that do not show it;
        // 2.25 are required.
        assert_eq!(reason(2.0, 4, 0.6), Some(LineContradiction::OffSurface));
        assert_eq!(reason(2.0, 4, 0.65), None);
        assert_eq!(reason(2.0, 6, 0.4), None);
        // An edge five standard deviations beside the line hardly counts.
        assert_eq!(reason_for(raised([2.0, 2.0]), 4, 0.7, 1.0), None);
        let beside = reason_for(raised([2.0, 2.0]), 4, 0.7, 5.0);
        assert_eq!(beside, Some(LineContradiction::OffSurface));
        // A sloping line on no surface needs a fourth view, 3.0; four at 0.8 are 3.2, less two
        // tenths.
        assert_eq!(reason(2.0, 4, 0.8), None);
        assert_eq!(
            reason_for(raised([2.0, 3.5]), 4, 0.7, 0.0),
            Some(LineContradiction::OffSurface)
        );
        assert_eq!(reason_for(raised([2.0, 3.5]), 4, 0.9, 0.0), None);
        // As level as a gutter.
        assert_eq!(reason_for(raised([2.0, 2.2]), 4, 0.7, 0.0), None);
        // Clustered lines without views have no evidence, and intersections need none.
        let unseen = |origin| Line3d {
            origin,
            supports: Vec::new(),
            ..line(&scene, raised([2.0, 2.0]), 0..3)
        };
        let others = [LineOrigin::Clustered, LineOrigin::Intersection].map(unseen);
        let clustered = (LineId(0), LineContradiction::OffSurface);
        assert_eq!(contradicted(&scene, &others, &roof, &ground), [clustered]);
    }

    #[test]
    fn three_views_do_where_fewer_than_six_can_see_a_line() {
        let (mut scene, truth) = gable_scene(320);
        let roof = roof_of(&truth);
        let ground = Ground::level(truth.ground_z);
        let ridge = truth.edges[0];
        let reason = |scene: &Scene, views: u32, roof: &[Facet]| {
            let lines = [line(scene, [ridge.p0, ridge.p1], 0..views)];
            let contradicted = contradicted(scene, &lines, roof, &ground);
            contradicted.first().map(|(_, why)| *why)
        };
        let too_few = Some(LineContradiction::TooFewViews);
        assert_eq!(reason(&scene, 3, &roof), too_few);
        assert_eq!(reason(&scene, 4, &roof), None);
        // A roof 40 m above, where the rays of the last view pass.
        let hides = |view: u32| {
            let center = scene.camera(ViewId(view)).center;
            let passing =
                [ridge.p0, ridge.p1].map(|p| p + (center - p) * (40.0 / (center.z - p.z)));
            let [low, high] = [passing[0].inf(&passing[1]), passing[0].sup(&passing[1])];
            let (x, y) = ([low.x - 2.0, high.x + 2.0], [low.y - 2.0, high.y + 2.0]);
            let corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])];
            testing::facet(&corners.map(|(x, y)| Point3::new(x, y, low.z)))
        };
        let hidden = [&roof[..], &[hides(5)]].concat();
        assert_eq!(reason(&scene, 3, &hidden), None);
        scene.views[5].camera.k[(0, 2)] += 1000.0;
        assert_eq!(
            reason(&scene, 3, &roof),
            None,
            "its image ends before the line"
        );
    }

    #[test]
    fn a_line_that_dips_into_the_ground_is_contradicted_and_one_below_it_is_not() {
        let dips = |z0: f64, z1: f64, sigma_m: f64| {
            let ends = [Point3::new(1.0, 2.0, z0), Point3::new(4.0, 6.0, z1)];
            let line = Line3d {
                sigma_m,
                ..testing::line(ends[0], ends[1])
            };
            dips_below_ground(&line, &Ground::level(50.0))
        };
        // 5 m in plan.
        assert!(dips(50.4, 49.2, 0.05) && dips(49.2, 50.4, 0.05));
        assert!(!dips(50.4, 49.2, 0.5), "not certain enough");
        assert!(!dips(50.4, 49.8, 0.05), "the ground is rough");
        assert!(!dips(49.9, 49.5, 0.05), "as level as ground is");
        assert!(!dips(49.6, 48.4, 0.05), "a hollow");
        assert!(!dips(53.0, 50.1, 0.05));
    }
}
