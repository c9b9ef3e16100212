//! Lines that the finished model refutes (B99 3.4: no mismatches).
//!
//! Matching knows no surfaces. An eave in one view and the foot of the wall in two others, or
//! parallel edges of two buildings, may meet in a line inside a house or under the street, and
//! nothing in the views tells. Once there are roofs and a ground, two things cannot be, and two are
//! hard to believe:
//!
//! * a line that fewer than three of its views can see past the roofs, for it was never verified
//!   (B99 3.2);
//! * a line that starts at the ground or above it and goes into it: it was matched with a wrong
//!   slope. What lies below the ground as a whole stays, for there the ground is more likely to be
//!   wrong;
//! * a line that three views show where six can see it: "a match has to be supported by a minimal
//!   number of views (here 4)". Matching lets it pass if the three are very alike, for they may be
//!   all that no house stands before;
//! * a line that lies on nothing, neither roof nor wall nor ground, unless the views are very sure
//!   of it: there are lines on fences, cars and roofs that were missed, but of those that lie on
//!   nothing one in twenty is a mismatch, and of the others one in eight hundred. It has to be
//!   borne out as much as three views are asked to bear out a line by themselves (150 % of the
//!   threshold, B99 3.2), the more so the more views ought to show it and do not. A view bears it
//!   out by its score as far as the fit believes its edge. Most lines of buildings are level, and
//!   of those that slope most lie on roofs: one that slopes and lies on nothing is a mismatch seven
//!   times as often as a level one, and needs a fourth view.

use nalgebra::Point3;

use super::duplicates::repeated_lines;
use super::new_lines::new_lines;
use super::surfaces::{Surfaces, share};
use crate::ids::LineId;
use crate::ids::ViewId;
use crate::linematch::{EDGE_MARGIN_PX, MANY_VIEWS};
use crate::lines2d::GuidedEdge;
use crate::lines3d::LineSupport;
use crate::lines3d::{Line3d, LineOrigin, Observation, ProjectedLine, Refutation};
use crate::model::{Facet, Occluders, RoofModel};
use crate::params::Lines3dParams;
use crate::params::Params;
use crate::scene::Scene;
use crate::terrain::Ground;

/// Views that must be able to see a line.
const MIN_VIEWS: usize = 3;
/// A view does not see a stretch of which this share is hidden.
const HIDDEN_SHARE: f64 = 0.5;
/// Walls stand back below their eaves by up to this, metres. Assumption.
const OVERHANG_M: f64 = 0.8;
/// In places the ground lies this much lower or higher than its map says, metres. Assumption.
const ROUGHNESS_M: f64 = 0.25;
/// Standard deviations by which a line must go deeper than that, and by which a line that slopes is
/// not level.
const SIGNIFICANT: f64 = 2.0;
/// Least slope of a line (sine of 6 degrees): less is what the map of the ground may miss, and what
/// gutters and flat roofs have.
const LEAST_SLOPE: f64 = 0.1;
/// Of a line that lies on surfaces this share does at least.
const LEAST_SHARE: f64 = 0.8;
/// How much a view that ought to show a line and does not takes from the scores of those that do.
/// Assumption.
const NOT_SHOWN: f64 = 0.1;

/// The new lines of a finished model, and the lines that it refutes, by their ids: the given ones,
/// and then the new ones. An edge that only refuted lines explain is sought again.
pub fn judge_lines(
    scene: &Scene,
    lines: &[Line3d],
    model: &RoofModel,
    ground: &Ground,
    params: &Params,
) -> (Vec<Line3d>, Vec<(LineId, Refutation)>) {
    let refuted_of = |lines: &[Line3d]| refuted_lines(scene, lines, &model.facets, ground, params);
    let mut refuted = refuted_of(lines);
    let mut judged = lines.to_vec();
    for (id, why) in &refuted {
        judged[id.index()].refuted = Some(*why);
    }
    for id in repeated_lines(scene, &judged, params.matching.gate_px) {
        refuted.push((id, Refutation::Repeated));
        judged[id.index()].refuted = Some(Refutation::Repeated);
    }
    let new = new_lines(scene, &judged, model, &params.matching, &params.lines3d);
    let number = |id: LineId| LineId::from_index(lines.len() + id.index());
    let of_new = refuted_of(&new).into_iter();
    refuted.extend(of_new.map(|(id, why)| (number(id), why)));
    (new, refuted)
}

/// The lines that cannot be, given the roofs and the ground, and why.
fn refuted_lines(
    scene: &Scene,
    lines: &[Line3d],
    facets: &[Facet],
    ground: &Ground,
    params: &Params,
) -> Vec<(LineId, Refutation)> {
    let surfaces = Surfaces::new(facets, ground);
    let verdicts = crate::execution::map(lines, |_, line| {
        if goes_underground(line, ground) {
            Some(Refutation::Underground)
        } else if is_hidden(scene, line, &surfaces.roofs) {
            Some(Refutation::Hidden)
        } else if is_afloat(scene, line, &surfaces, params) {
            Some(Refutation::Afloat)
        } else if has_too_few_views(scene, line, &surfaces.roofs, params) {
            Some(Refutation::TooFewViews)
        } else {
            None
        }
    });
    let refuted = |(i, why): (usize, Option<Refutation>)| Some((LineId::from_index(i), why?));
    verdicts
        .into_iter()
        .enumerate()
        .filter_map(refuted)
        .collect()
}

/// Does a line that was matched or clustered lie on nothing, and are the views not certain enough
/// of it to be believed alone?
fn is_afloat(scene: &Scene, line: &Line3d, surfaces: &Surfaces, params: &Params) -> bool {
    let views = MIN_VIEWS + usize::from(slopes(line));
    let alone = views as f64 * params.matching.pair_score * params.matching.without_segment;
    matches!(line.origin, LineOrigin::Matched | LineOrigin::Clustered)
        && surfaces.share_of(line) < LEAST_SHARE
        && certainty(scene, line, &surfaces.roofs, &params.lines3d) < alone
}

/// Is one end of a line higher than the other, by more than both are uncertain?
fn slopes(line: &Line3d) -> bool {
    let rise = (line.segment.p1.z - line.segment.p0.z).abs();
    rise >= LEAST_SLOPE * line.segment.length()
        && rise > SIGNIFICANT * std::f64::consts::SQRT_2 * line.sigma_m
}

fn goes_underground(line: &Line3d, ground: &Ground) -> bool {
    let height = |p: &Point3<f64>| p.z - ground.z_at(&p.xy());
    let (start, end) = (height(&line.segment.p0), height(&line.segment.p1));
    let tolerance = ROUGHNESS_M + SIGNIFICANT * line.sigma_m;
    let slopes = (start - end).abs() >= LEAST_SLOPE * line.segment.length();
    slopes && start.min(end) < -tolerance && start.max(end) > -ROUGHNESS_M
}

/// Is the line hidden from all but two of its views, or from one of two? An intersection of planes
/// needs none.
fn is_hidden(scene: &Scene, line: &Line3d, occluders: &Occluders) -> bool {
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
    share(line, [from, to], |p| {
        !occluders.hide_past_eaves(p, &camera.center, OVERHANG_M)
    }) > 1.0 - HIDDEN_SHARE
}

/// Do fewer views show a matched line than must where six can see it (B99 3.4)? The foot of a wall
/// is hidden from the other strip: there three are all there are.
fn has_too_few_views(scene: &Scene, line: &Line3d, occluders: &Occluders, params: &Params) -> bool {
    let can_see = |view: &ViewId| can_see(scene, line, *view, occluders);
    line.origin == LineOrigin::Matched
        && line.supports.len() < params.matching.min_views
        && scene.view_ids().filter(can_see).count() >= MANY_VIEWS
}

/// The sum of the scores of the views that show the edge, each as far as the line fits its edge,
/// less what those take that ought to show it and do not.
fn certainty(scene: &Scene, line: &Line3d, occluders: &Occluders, fitting: &Lines3dParams) -> f64 {
    let supports = line.supports.iter();
    let shown: Vec<(f64, &GuidedEdge)> = supports
        .filter_map(|s| Some((s.score, s.edge.as_ref()?)))
        .collect();
    let missing = (scene.view_ids())
        .filter(|view| shown.iter().all(|(_, edge)| edge.view != *view))
        .filter(|view| can_see(scene, line, *view, occluders));
    let borne_out = shown.iter().map(|(score, edge)| {
        let seen = Observation::of(edge, scene.camera(edge.view));
        score * seen.weight(&line.segment, fitting)
    });
    borne_out.sum::<f64>() - NOT_SHOWN * missing.count() as f64
}

/// Does a view's image hold most of a line, with no roof before it?
fn can_see(scene: &Scene, line: &Line3d, view: ViewId, occluders: &Occluders) -> bool {
    let camera = scene.camera(view);
    let visible = |p: &Point3<f64>| {
        let image = camera.project(p);
        image.is_some_and(|x| camera.contains(&x, EDGE_MARGIN_PX))
            && !occluders.hide_past_eaves(p, &camera.center, OVERHANG_M)
    };
    share(line, [0.0, 1.0], visible) > 1.0 - HIDDEN_SHARE
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
    fn what_roofs_hide_from_all_but_two_views_is_refuted() {
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
            // High above the roof nothing hides it; an intersection of planes has no views to hide
            // it from.
            line(&scene, below(-2.0), 0..4),
            Line3d {
                origin: LineOrigin::Intersection,
                ..line(&scene, below(2.0), 0..0)
            },
        ];
        let ground = Ground::level(top - 100.0);
        let refuted = |roof: &[Facet]| refuted(&scene, &lines, roof, &ground);
        assert_eq!(refuted(&roof), [(LineId(1), Refutation::Hidden)]);
        assert_eq!(refuted(&[]), []);
    }

    fn roof_of(truth: &SyntheticTruth) -> Vec<Facet> {
        let rings = truth.facets.iter().map(|(_, ring)| ring);
        rings.map(|ring| testing::facet(ring)).collect()
    }

    fn refuted(
        scene: &Scene,
        lines: &[Line3d],
        facets: &[Facet],
        ground: &Ground,
    ) -> Vec<(LineId, Refutation)> {
        refuted_lines(scene, lines, facets, ground, &Params::default())
    }

    #[test]
    fn what_lies_on_nothing_needs_views_that_are_certain_of_it() {
        let (scene, truth) = gable_scene(320);
        let roof = roof_of(&truth);
        let ground = Ground::level(truth.ground_z);
        let ridge = truth.edges[0];
        let raised =
            |by: [f64; 2]| [0, 1].map(|i| ridge.at(i as f64) + nalgebra::Vector3::z() * by[i]);
        // The edge of the first view lies `beside_px` beside the image of the line.
        let fate_of = |ends: [Point3<f64>; 2], views: u32, score: f64, beside_px: f64| {
            let mut line = line(&scene, ends, 0..views);
            for support in &mut line.supports {
                support.score = score;
            }
            let edge = line.supports[0].edge.as_mut().expect("measured");
            let across = edge.segment.normal() * beside_px;
            edge.segment = Segment2::new(edge.segment.p0 + across, edge.segment.p1 + across);
            let refuted = refuted(&scene, &[line], &roof, &ground);
            refuted.first().map(|(_, why)| *why)
        };
        let fate = |by: f64, views: u32, score: f64| fate_of(raised([by, by]), views, score, 0.0);
        assert_eq!(fate(0.0, 4, 0.3), None, "on the roof");
        assert_eq!(fate(2.0, 4, 0.3), Some(Refutation::Afloat));
        // Four fifths of it have to lie on something.
        let prolonged = |by: f64| fate_of([ridge.at(0.0), ridge.at(1.0 + by)], 4, 0.3, 0.0);
        assert_eq!(prolonged(0.1), None);
        assert_eq!(prolonged(0.4), Some(Refutation::Afloat));
        // Four of six views at 0.6 are 2.4, less a tenth for each of the two that do not show it;
        // 2.25 are asked.
        assert_eq!(fate(2.0, 4, 0.6), Some(Refutation::Afloat));
        assert_eq!(fate(2.0, 4, 0.65), None);
        assert_eq!(fate(2.0, 6, 0.4), None);
        // An edge five standard deviations beside the line hardly bears it out.
        assert_eq!(fate_of(raised([2.0, 2.0]), 4, 0.7, 1.0), None);
        let beside = fate_of(raised([2.0, 2.0]), 4, 0.7, 5.0);
        assert_eq!(beside, Some(Refutation::Afloat));
        // What slopes on nothing needs a fourth view, 3.0; four at 0.8 are 3.2, less two tenths.
        assert_eq!(fate(2.0, 4, 0.8), None);
        assert_eq!(
            fate_of(raised([2.0, 3.5]), 4, 0.7, 0.0),
            Some(Refutation::Afloat)
        );
        assert_eq!(fate_of(raised([2.0, 3.5]), 4, 0.9, 0.0), None);
        // As level as a gutter.
        assert_eq!(fate_of(raised([2.0, 2.2]), 4, 0.7, 0.0), None);
        // No view bears out what another method found, and planes need none.
        let unseen = |origin| Line3d {
            origin,
            supports: Vec::new(),
            ..line(&scene, raised([2.0, 2.0]), 0..3)
        };
        let others = [LineOrigin::Clustered, LineOrigin::Intersection].map(unseen);
        let clustered = (LineId(0), Refutation::Afloat);
        assert_eq!(refuted(&scene, &others, &roof, &ground), [clustered]);
    }

    #[test]
    fn three_views_do_where_fewer_than_six_can_see_a_line() {
        let (mut scene, truth) = gable_scene(320);
        let roof = roof_of(&truth);
        let ground = Ground::level(truth.ground_z);
        let ridge = truth.edges[0];
        let fate = |scene: &Scene, views: u32, roof: &[Facet]| {
            let lines = [line(scene, [ridge.p0, ridge.p1], 0..views)];
            let refuted = refuted(scene, &lines, roof, &ground);
            refuted.first().map(|(_, why)| *why)
        };
        let too_few = Some(Refutation::TooFewViews);
        assert_eq!(fate(&scene, 3, &roof), too_few);
        assert_eq!(fate(&scene, 4, &roof), None);
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
        assert_eq!(fate(&scene, 3, &hidden), None);
        scene.views[5].camera.k[(0, 2)] += 1000.0;
        assert_eq!(
            fate(&scene, 3, &roof),
            None,
            "its image ends before the line"
        );
    }

    #[test]
    fn what_dips_into_the_ground_is_refuted_and_what_lies_deeper_is_not() {
        let dips = |z0: f64, z1: f64, sigma_m: f64| {
            let ends = [Point3::new(1.0, 2.0, z0), Point3::new(4.0, 6.0, z1)];
            let line = Line3d {
                sigma_m,
                ..testing::line(ends[0], ends[1])
            };
            goes_underground(&line, &Ground::level(50.0))
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
