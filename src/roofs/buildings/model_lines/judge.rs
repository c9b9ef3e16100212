//! Every line weighed once more, now that there are roofs and a ground (B99 3.4: no mismatches).
//!
//! Matching knows no surfaces. An eave in one view and the foot of the wall in two others, or
//! parallel edges of two buildings, may meet in a line inside a house or under the street, and no
//! view shows that. The finished model adds to what the views said of a line:
//!
//! * how much of it lies on roofs, walls or the ground. Fences, cars and missed roofs have lines
//!   that lie on nothing, and so have mismatches;
//! * how many views that support it cannot see it past the roofs (B99 3.2 wants three);
//! * how many facets were found with it.

use super::surfaces::{Surfaces, share_where};
use crate::base::evidence::{Evidence, EvidenceModel};
use crate::base::math::ln;
use crate::lines::lines3d::{Line3d, LineOrigin, LineSupport, ProjectedLine};
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;
use crate::roofs::model::{Facet, Occluders};

/// A view does not see a stretch of which this share is occluded.
const OCCLUDED_SHARE: f64 = 0.5;
/// Walls stand back below their eaves by up to this, metres. Assumption.
const EAVE_OVERHANG_M: f64 = 0.8;
/// The odds of a line before there was a model count as far as these, nats.
const PRIOR_NATS: f64 = 6.0;

/// What speaks for each line and against it, in the finished model. `facets_on_it` is the number of
/// facets that were found with a line, by its position.
pub(super) fn judge_lines(
    scene: &Scene,
    lines: &[Line3d],
    facets_on_it: impl Fn(usize) -> usize + Sync,
    facets: &[Facet],
    ground: &Ground,
) -> Vec<Evidence> {
    let surfaces = Surfaces::new(facets, ground);
    crate::base::execution::map(lines, |i, line| {
        let features = features(scene, line, facets_on_it(i), &surfaces);
        EvidenceModel::of_model_lines().weigh(&features)
    })
}

fn features(
    scene: &Scene,
    line: &Line3d,
    facets_on_it: usize,
    surfaces: &Surfaces,
) -> [(&'static str, f64); 6] {
    let is_of = |origin: LineOrigin| f64::from(u8::from(line.origin == origin));
    let supports = line.supports.iter();
    let hidden = supports.filter(|support| !sees(scene, line, support, &surfaces.roofs));
    [
        ("nats_before", nats_before(line)),
        ("is_border", is_of(LineOrigin::Border)),
        ("is_intersection", is_of(LineOrigin::Intersection)),
        ("share_on_surfaces", surfaces.share_of(line)),
        ("hidden_views", hidden.count() as f64),
        ("facets_on_it", facets_on_it as f64),
    ]
}

/// Logarithm of the odds of a line before there was a model; even where nothing weighed it.
fn nats_before(line: &Line3d) -> f64 {
    if line.origin == LineOrigin::Clustered {
        return 0.0;
    }
    let [for_it, against] = [line.probability, 1.0 - line.probability].map(|p| p.max(1e-9));
    (ln(for_it) - ln(against)).clamp(-PRIOR_NATS, PRIOR_NATS)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::{Segment2, Segment3};
    use crate::base::ids::ViewId;
    use crate::lines::lines3d::SupportKind;
    use crate::orienting::synthetic::{SyntheticTruth, gable_scene};
    use crate::roofs::testing;
    use nalgebra::{Point3, Vector3};

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
                edge: None,
            }
        };
        Line3d {
            probability: 0.9,
            supports: views.map(support).collect(),
            ..testing::line(ends[0], ends[1])
        }
    }

    fn roof_of(truth: &SyntheticTruth) -> Vec<Facet> {
        let rings = truth.facets.iter().map(|(_, ring)| ring);
        rings.map(|ring| testing::facet(ring)).collect()
    }

    /// The values of a feature of these lines, of which so many facets were found with each, and
    /// the probabilities of the lines.
    fn judged(
        scene: &Scene,
        truth: &SyntheticTruth,
        lines: &[Line3d],
        facets_on_it: impl Fn(usize) -> usize + Sync,
        feature: &str,
    ) -> (Vec<f64>, Vec<f64>) {
        let ground = Ground::level(truth.ground_z);
        let evidence = judge_lines(scene, lines, facets_on_it, &roof_of(truth), &ground);
        let value = |e: &Evidence| {
            let term = e.terms.iter().find(|t| t.feature == feature);
            term.expect("a feature of the model").value
        };
        (
            evidence.iter().map(value).collect(),
            evidence.iter().map(Evidence::probability).collect(),
        )
    }

    fn lifted(line: Segment3, up: f64) -> [Point3<f64>; 2] {
        [0.0, 1.0].map(|t| line.at(t) + Vector3::z() * up)
    }

    #[test]
    fn views_that_cannot_see_a_line_past_the_roofs_speak_against_it() {
        let (scene, truth) = gable_scene(64);
        let corners = roof_of(&truth).remove(0).outer;
        let top = corners.iter().fold(f64::MIN, |top, p| top.max(p.z));
        let ends: Vec<_> = corners.iter().filter(|p| top - p.z < 1e-9).collect();
        let ridge = Segment3::new(*ends[0], *ends[1]);
        // Nothing occludes a line high above the roof; an intersection of planes has no views.
        let lines = [
            line(&scene, lifted(ridge, 0.0), 0..6),
            line(&scene, lifted(ridge, -2.0), 0..6),
            line(&scene, lifted(ridge, 2.0), 0..4),
            line(&scene, lifted(ridge, -2.0), 0..0),
        ];
        let (hidden, probability) = judged(&scene, &truth, &lines, |_| 1, "hidden_views");
        assert_eq!(hidden, [0.0, 4.0, 0.0, 0.0]);
        assert!(probability[1] < probability[0], "{probability:?}");
    }

    #[test]
    fn a_line_on_no_surface_is_less_likely_than_one_on_a_roof() {
        let (scene, truth) = gable_scene(64);
        let ridge = truth.edges[0];
        let lines = [0.0, 2.0].map(|up| line(&scene, lifted(ridge, up), 0..4));
        let (share, probability) = judged(&scene, &truth, &lines, |_| 1, "share_on_surfaces");
        assert_eq!(share, [1.0, 0.0]);
        assert!(probability[1] < probability[0], "{probability:?}");
    }

    #[test]
    fn facets_that_were_found_with_a_line_speak_for_it() {
        let (scene, truth) = gable_scene(64);
        let ridge = line(&scene, lifted(truth.edges[0], 0.0), 0..4);
        let lines = [ridge.clone(), ridge.clone(), ridge];
        let (found_with, probability) = judged(&scene, &truth, &lines, |i| i, "facets_on_it");
        assert_eq!(found_with, [0.0, 1.0, 2.0]);
        assert!(probability.is_sorted(), "{probability:?}");
    }

    #[test]
    fn the_odds_before_there_was_a_model_count_up_to_a_bound() {
        let (scene, truth) = gable_scene(64);
        let with = |probability: f64, origin: LineOrigin| Line3d {
            probability,
            origin,
            ..line(&scene, lifted(truth.edges[0], 0.0), 0..4)
        };
        let lines = [
            with(0.5, LineOrigin::Matched),
            with(0.88, LineOrigin::Matched),
            with(1.0, LineOrigin::Matched),
            with(0.0, LineOrigin::Border),
            with(1.0, LineOrigin::Clustered),
        ];
        let (nats, probability) = judged(&scene, &truth, &lines, |_| 1, "nats_before");
        for (nats, expected) in nats.iter().zip([0.0, 2.0, 6.0, -6.0, 0.0]) {
            assert!((nats - expected).abs() < 0.01, "{nats} {expected}");
        }
        assert!(probability[0] < probability[1] && probability[1] <= probability[2]);
    }
}
