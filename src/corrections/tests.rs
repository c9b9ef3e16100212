//! Mistakes planted in models, and corrected.

use nalgebra::{Point3, Vector3};

use super::*;
use crate::buildings::gable;
use crate::geometry::mean_point;
use crate::model::{Facet, check_invariants};
use crate::params::{Params, corrections_from_json};
use crate::solids::close_buildings;
use crate::synthetic::gable_scene;
use crate::testing::{facet, uniform};

/// The world's origin of the scene.
const ORIGIN: [f64; 3] = [500_000.0, 5_400_000.0, 250.0];
const GROUND_Z: f64 = 1.0;

fn closed(facets: &[Facet]) -> RoofModel {
    let (model, trace) = close_buildings(facets, |_| GROUND_Z);
    assert_eq!(trace.rejected, []);
    model
}

fn roof(rings: &[&[[f64; 3]]]) -> RoofModel {
    let ring = |ring: &&[[f64; 3]]| ring.iter().map(|&p| Point3::from(p)).collect::<Vec<_>>();
    closed(&rings.iter().map(|r| facet(&ring(r))).collect::<Vec<_>>())
}

/// A point or an edge in the world.
fn world(p: [f64; 3]) -> Point3<f64> {
    Point3::from(p) + Vector3::from(ORIGIN)
}

fn edge(ends: [[f64; 3]; 2]) -> [Point3<f64>; 2] {
    ends.map(world)
}

/// The place of a facet that covers a plan position.
fn place(model: &RoofModel, x: f64, y: f64) -> FacetPlace {
    let draft = Draft::new(model);
    let at = draft
        .facet_below(&nalgebra::Point2::new(x, y))
        .expect("a facet");
    let plane = draft.get(at).facet.plane;
    FacetPlace {
        at: plane.lift(x, y) + Vector3::from(ORIGIN),
        normal: plane.normal,
    }
}

fn corrected(model: &RoofModel, corrections: &[Correction]) -> (RoofModel, CorrectionTrace) {
    let mut scene = gable_scene(16).0;
    scene.origin = Vector3::from(ORIGIN);
    let (found, trace) = correct(&scene, model, corrections, &Params::default().roof.refine);
    assert_eq!(check_invariants(&found), []);
    assert_eq!(trace.outcomes.len(), corrections.len());
    assert_eq!(trace.sources.len(), found.facets.len());
    (found, trace)
}

/// The corrected model, all corrections being applied.
fn mended(model: &RoofModel, corrections: &[Correction]) -> RoofModel {
    let (found, trace) = corrected(model, corrections);
    assert_eq!(trace.outcomes, vec![None; corrections.len()]);
    found
}

fn why_not(model: &RoofModel, correction: Correction) -> NotApplied {
    let (found, trace) = corrected(model, &[correction]);
    assert_eq!(&found, model, "a refused correction changes nothing");
    trace.outcomes[0].expect("a refusal")
}

/// Every facet of the truth is found with its corners, and nothing else.
fn assert_is(found: &RoofModel, truth: &RoofModel, within_m: f64) {
    assert_eq!(found.facets.len(), truth.facets.len());
    assert_eq!(found.buildings.len(), truth.buildings.len());
    for facet in &truth.facets {
        let middle = mean_point(&facet.outer).xy();
        let own = (found.facets.iter())
            .find(|f| crate::model::inside(&f.outer, &middle))
            .expect("a facet at the place");
        for (from, to) in [(facet, own), (own, facet)] {
            for p in &from.outer {
                let height = (to.plane.z_at(p.x, p.y) - p.z).abs();
                assert!(height < within_m, "{p}: {height} m too high");
                let distance = distance_m(p, &to.outer);
                assert!(distance < within_m, "{p}: {distance} m from the outline");
            }
        }
    }
}

/// Distance of a point from a ring.
fn distance_m(p: &Point3<f64>, ring: &[Point3<f64>]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    let of_side = |(a, b): (&Point3<f64>, &Point3<f64>)| {
        let t = (p - a).dot(&(b - a)) / (b - a).norm_squared();
        (a + (b - a) * t.clamp(0.0, 1.0) - p).norm()
    };
    ring.iter().zip(next).map(of_side).fold(f64::MAX, f64::min)
}

fn truth() -> RoofModel {
    closed(&gable())
}

#[test]
fn without_corrections_a_model_keeps_its_bits() {
    let model = truth();
    let (found, trace) = corrected(&model, &[]);
    assert_eq!(found, model);
    assert_eq!(trace.sources.len(), 2);
}

#[test]
fn a_false_facet_inside_a_slope_is_closed_over() {
    let mut facets = gable();
    // A tree above the southern slope.
    facets.push(facet(
        &[
            [0.0, -3.0, 9.5],
            [2.0, -3.0, 9.5],
            [2.0, -1.0, 9.5],
            [0.0, -1.0, 9.5],
        ]
        .map(Point3::from),
    ));
    let model = closed(&facets);
    let delete = |filled| Correction::DeleteFacet {
        facet: place(&model, 1.0, -2.0),
        filled,
    };
    assert_is(&mended(&model, &[delete(None)]), &truth(), 1e-3);
    let open = mended(&model, &[delete(Some(false))]);
    assert_eq!(open.facets.iter().map(|f| f.holes.len()).sum::<usize>(), 1);
}

#[test]
fn neighbours_of_a_false_facet_meet_in_ridge_or_valley() {
    let flat = roof(&[
        &[
            [-6.0, -4.0, 6.0],
            [6.0, -4.0, 6.0],
            [6.0, -1.0, 8.25],
            [-6.0, -1.0, 8.25],
        ],
        &[
            [-6.0, -1.0, 8.25],
            [6.0, -1.0, 8.25],
            [6.0, 1.0, 8.25],
            [-6.0, 1.0, 8.25],
        ],
        &[
            [-6.0, 1.0, 8.25],
            [6.0, 1.0, 8.25],
            [6.0, 4.0, 6.0],
            [-6.0, 4.0, 6.0],
        ],
    ]);
    let delete = Correction::DeleteFacet {
        facet: place(&flat, 0.0, 0.0),
        filled: None,
    };
    assert_is(&mended(&flat, &[delete]), &truth(), 1e-3);
    let butterfly = roof(&[
        &[
            [-6.0, -4.0, 9.0],
            [6.0, -4.0, 9.0],
            [6.0, -1.0, 6.75],
            [-6.0, -1.0, 6.75],
        ],
        &[
            [-6.0, -1.0, 6.75],
            [6.0, -1.0, 6.75],
            [6.0, 1.0, 6.75],
            [-6.0, 1.0, 6.75],
        ],
        &[
            [-6.0, 1.0, 6.75],
            [6.0, 1.0, 6.75],
            [6.0, 4.0, 9.0],
            [-6.0, 4.0, 9.0],
        ],
    ]);
    let valley = roof(&[
        &[
            [-6.0, -4.0, 9.0],
            [6.0, -4.0, 9.0],
            [6.0, 0.0, 6.0],
            [-6.0, 0.0, 6.0],
        ],
        &[
            [-6.0, 0.0, 6.0],
            [6.0, 0.0, 6.0],
            [6.0, 4.0, 9.0],
            [-6.0, 4.0, 9.0],
        ],
    ]);
    let delete = Correction::DeleteFacet {
        facet: place(&butterfly, 0.0, 0.0),
        filled: None,
    };
    assert_is(&mended(&butterfly, &[delete]), &valley, 1e-3);
}

#[test]
fn a_facet_at_the_rim_is_lost_to_the_building() {
    let mut facets = gable();
    facets.push(facet(
        &[
            [6.0, -2.0, 5.0],
            [9.0, -2.0, 5.0],
            [9.0, 2.0, 5.0],
            [6.0, 2.0, 5.0],
        ]
        .map(Point3::from),
    ));
    let model = closed(&facets);
    let delete = Correction::DeleteFacet {
        facet: place(&model, 8.0, 0.0),
        filled: None,
    };
    assert_is(&mended(&model, &[delete]), &truth(), 1e-3);
}

/// The gable with its northern slope too flat: the eave at 7.8 m.
fn too_flat() -> RoofModel {
    roof(&[
        &[
            [-6.0, -4.0, 6.0],
            [6.0, -4.0, 6.0],
            [6.0, 0.0, 9.0],
            [-6.0, 0.0, 9.0],
        ],
        &[
            [-6.0, 0.0, 9.0],
            [6.0, 0.0, 9.0],
            [6.0, 4.0, 7.8],
            [-6.0, 4.0, 7.8],
        ],
    ])
}

#[test]
fn a_wrong_slope_is_mended_by_its_eave_a_corner_or_a_number() {
    let model = too_flat();
    let north = place(&model, 0.0, 2.0);
    let ways = [
        Correction::MoveEdge {
            from: edge([[6.0, 4.0, 7.8], [-6.0, 4.0, 7.8]]),
            to: edge([[6.0, 4.0, 6.0], [-6.0, 4.0, 6.0]]),
            sigma_m: 0.02,
        },
        Correction::MoveCorner {
            from: world([6.1, 4.1, 7.9]),
            to: world([6.0, 4.0, 6.0]),
            sigma_m: 0.02,
        },
        Correction::SetSlope {
            facet: north,
            slope_deg: crate::math::atan(0.75).to_degrees(),
        },
    ];
    for way in ways {
        assert_is(&mended(&model, &[way]), &truth(), 0.05);
    }
}

#[test]
fn slopes_become_symmetric() {
    let model = too_flat();
    let facets = [place(&model, 0.0, -2.0), place(&model, 0.0, 2.0)];
    let found = mended(&model, &[Correction::SetSymmetric { facets }]);
    let [south, north] = [0, 1].map(|i| found.facets[i].plane.normal);
    assert!((south.xy() + north.xy()).norm() < 1e-3, "{south} {north}");
    // Which of the two was wrong, nothing says; the ridge stays level, and between both eaves.
    let ridge = found.facets[0]
        .outer
        .iter()
        .map(|p| p.z)
        .fold(f64::MIN, f64::max);
    assert!((8.0..10.0).contains(&ridge), "{ridge}");
    assert_eq!(found.facets.len(), 2);
}

#[test]
fn an_end_of_a_ridge_takes_the_other_with_it() {
    let low = roof(&[
        &[
            [-6.0, -4.0, 6.0],
            [6.0, -4.0, 6.0],
            [6.0, 0.0, 8.0],
            [-6.0, 0.0, 8.0],
        ],
        &[
            [-6.0, 0.0, 8.0],
            [6.0, 0.0, 8.0],
            [6.0, 4.0, 6.0],
            [-6.0, 4.0, 6.0],
        ],
    ]);
    let lift = Correction::MoveCorner {
        from: world([6.0, 0.0, 8.0]),
        to: world([6.0, 0.0, 9.0]),
        sigma_m: 0.02,
    };
    assert_is(&mended(&low, &[lift]), &truth(), 0.03);
}

#[test]
fn corners_put_one_after_the_other_all_stay() {
    let places = [
        [-6.5, -4.5, 6.0],
        [6.5, -4.5, 6.0],
        [6.5, 4.5, 6.0],
        [-6.5, 4.5, 6.0],
    ];
    let from = [[-6.0, -4.0], [6.0, -4.0], [6.0, 4.0], [-6.0, 4.0]];
    let mut model = truth();
    let mut corrections = Vec::new();
    for (to, [x, y]) in places.into_iter().zip(from) {
        // Where the corner is by then.
        let near = (model.facets.iter().flat_map(|f| &f.outer))
            .min_by(|p, q| {
                let d = |p: &Point3<f64>| (p.xy() - nalgebra::Point2::new(x, y)).norm();
                d(p).total_cmp(&d(q))
            })
            .copied()
            .expect("corners");
        corrections.push(Correction::MoveCorner {
            from: near + Vector3::from(ORIGIN),
            to: world(to),
            sigma_m: 0.02,
        });
        model = mended(&truth(), &corrections);
    }
    for to in places.map(Point3::from) {
        let distance = |p: &Point3<f64>| (p - to).norm();
        let all = model.facets.iter().flat_map(|f| &f.outer);
        let least = all.map(distance).fold(f64::MAX, f64::min);
        assert!(least < 0.05, "{to}: {least}");
    }
}

#[test]
fn a_flat_roof_becomes_level_and_an_eave_parallel() {
    let tilted = roof(&[&[
        [0.0, 0.0, 5.0],
        [8.0, 0.0, 5.4],
        [8.0, 6.0, 5.7],
        [0.0, 6.0, 5.3],
    ]]);
    let level = Correction::SetLevel {
        facet: place(&tilted, 4.0, 3.0),
    };
    let found = mended(&tilted, &[level]);
    let heights = || found.facets[0].outer.iter().map(|p| p.z);
    let range = heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min);
    assert!(range < 0.01, "{range}");
    assert!((found.facets[0].outer[0].z - 5.35).abs() < 0.1);

    let skewed = roof(&[&[
        [0.0, 0.0, 5.0],
        [8.0, 0.0, 5.0],
        [8.0, 6.0, 5.0],
        [0.0, 5.0, 5.0],
    ]]);
    let parallel = Correction::SetParallel {
        edge: edge([[8.0, 6.0, 5.0], [0.0, 5.0, 5.0]]),
        to: edge([[0.0, 0.0, 5.0], [8.0, 0.0, 5.0]]),
    };
    let found = mended(&skewed, &[parallel]);
    let y = |x: f64| {
        let corners = found.facets[0]
            .outer
            .iter()
            .filter(|p| (p.x - x).abs() < 1.0);
        corners.map(|p| p.y).fold(f64::MIN, f64::max)
    };
    assert!((y(0.0) - y(8.0)).abs() < 0.02, "{} {}", y(0.0), y(8.0));
}

#[test]
fn a_missing_slope_is_added_drawn_or_as_a_counterpart() {
    let half = closed(&gable()[..1]);
    let mirror = Correction::Mirror {
        facet: place(&half, 0.0, -2.0),
        over: edge([[6.0, 0.0, 9.0], [-6.0, 0.0, 9.0]]),
    };
    assert_is(
        &mended(&half, std::slice::from_ref(&mirror)),
        &truth(),
        1e-3,
    );
    // Drawn by hand, a decimetre beside the ridge.
    let drawn = Correction::AddFacet {
        outline: [
            [-6.1, 0.1, 9.1],
            [-6.0, 4.0, 6.0],
            [6.0, 4.0, 6.0],
            [6.1, -0.1, 8.9],
        ]
        .map(world)
        .to_vec(),
    };
    let found = mended(&half, &[drawn]);
    assert_is(&found, &truth(), 0.02);
    assert_eq!(found.facets[1].probability, 1.0);
    assert_eq!(why_not(&truth(), mirror), NotApplied::NoRoom);
}

#[test]
fn what_is_drawn_takes_the_place_of_what_is_below() {
    let level = roof(&[&[
        [-6.0, -4.0, 6.0],
        [6.0, -4.0, 6.0],
        [6.0, 4.0, 6.0],
        [-6.0, 4.0, 6.0],
    ]]);
    let slopes = gable().into_iter().map(|f| Correction::AddFacet {
        outline: f.outer.iter().map(|p| p + Vector3::from(ORIGIN)).collect(),
    });
    let slopes: Vec<Correction> = slopes.collect();
    assert_is(&mended(&level, &slopes), &truth(), 1e-3);
    assert_is(&mended(&RoofModel::default(), &slopes), &truth(), 1e-3);
}

#[test]
fn a_missing_ridge_divides_a_facet_whose_halves_turn_about_it() {
    let level = roof(&[&[
        [-6.0, -4.0, 6.0],
        [6.0, -4.0, 6.0],
        [6.0, 4.0, 6.0],
        [-6.0, 4.0, 6.0],
    ]]);
    let split = Correction::Split {
        facet: place(&level, 1.0, 2.0),
        along: edge([[-5.0, 0.0, 9.0], [5.0, 0.0, 9.0]]),
    };
    assert_is(&mended(&level, &[split]), &truth(), 1e-3);
    let beside = Correction::Split {
        facet: place(&level, 1.0, 2.0),
        along: edge([[-5.0, 9.0, 9.0], [5.0, 9.0, 9.0]]),
    };
    assert_eq!(why_not(&level, beside), NotApplied::NotDivided);
}

#[test]
fn facets_that_are_one_are_merged() {
    let parted = roof(&[
        &[
            [-6.0, -4.0, 6.0],
            [2.0, -4.0, 6.0],
            [2.0, 0.0, 9.0],
            [-6.0, 0.0, 9.0],
        ],
        &[
            [2.0, -4.0, 5.0],
            [6.0, -4.0, 5.0],
            [6.0, 0.0, 9.0],
            [2.0, 0.0, 9.0],
        ],
        &[
            [-6.0, 0.0, 9.0],
            [2.0, 0.0, 9.0],
            [6.0, 0.0, 9.0],
            [6.0, 4.0, 6.0],
            [-6.0, 4.0, 6.0],
        ],
    ]);
    let merge = |with: [f64; 2]| Correction::Merge {
        facet: place(&parted, -2.0, -2.0),
        with: place(&parted, with[0], with[1]),
    };
    assert_is(&mended(&parted, &[merge([4.0, -2.0])]), &truth(), 1e-3);
    assert_eq!(
        why_not(&parted, merge([-2.0, -2.0])),
        NotApplied::NotNeighbours
    );
}

#[test]
fn ground_and_eave_are_set_in_the_world() {
    let model = truth();
    let building = world([0.0, 1.0, 8.0]);
    let found = mended(
        &model,
        &[
            Correction::SetGround {
                building,
                height: ORIGIN[2] - 2.0,
            },
            Correction::SetEave {
                building,
                height: ORIGIN[2] + 5.0,
            },
        ],
    );
    assert_eq!(found.buildings[0].ground_z, -2.0);
    let low = found.facets[0]
        .outer
        .iter()
        .map(|p| p.z)
        .fold(f64::MAX, f64::min);
    assert!((low - 5.0).abs() < 1e-9);
    assert!((found.buildings[0].solid.volume() - (12.0 * 8.0 * 8.5)).abs() < 1e-6);
    let above = Correction::SetGround {
        building,
        height: ORIGIN[2] + 7.0,
    };
    assert_eq!(why_not(&model, above), NotApplied::Implausible);
}

#[test]
fn a_building_goes_and_the_others_keep_their_bits() {
    let mut facets = gable();
    for f in gable() {
        let ring: Vec<Point3<f64>> = f.outer.iter().map(|p| p + Vector3::x() * 20.0).collect();
        facets.push(facet(&ring));
    }
    let model = closed(&facets);
    let delete = Correction::DeleteBuilding {
        building: world([0.0, 1.0, 8.0]),
    };
    let mut doubtful = model.clone();
    doubtful.facets.iter_mut().for_each(|f| f.probability = 0.4);
    let confirm = Correction::Confirm {
        facet: place(&model, 20.0, 1.0),
    };
    let (found, trace) = corrected(&doubtful, &[delete, confirm]);
    assert_eq!(trace.outcomes, [None, None]);
    assert_eq!(found.facets.len(), 2);
    assert_eq!(found.facets[0].outer, model.facets[2].outer);
    let probabilities: Vec<f64> = found.facets.iter().map(|f| f.probability).collect();
    assert_eq!(probabilities, [0.4, 1.0]);
    let sources: Vec<usize> = trace.sources.iter().flatten().map(|f| f.index()).collect();
    assert_eq!(sources, [2, 3]);
}

#[test]
fn what_no_longer_applies_says_why() {
    let model = truth();
    let there = place(&model, 1.0, 2.0);
    let delete = |facet| Correction::DeleteFacet {
        facet,
        filled: None,
    };
    let moved = |by: Vector3<f64>| FacetPlace {
        at: there.at + by,
        ..there
    };
    let turned = FacetPlace {
        normal: Vector3::new(0.0, 0.0, 1.0),
        ..there
    };
    let outcome = |facet| why_not(&model, delete(facet));
    assert_eq!(outcome(moved(Vector3::x() * 30.0)), NotApplied::NoFacet);
    assert_eq!(outcome(moved(Vector3::z() * 3.0)), NotApplied::OtherHeight);
    assert_eq!(outcome(turned), NotApplied::OtherSlope);
    let corner = |from, to| Correction::MoveCorner {
        from: world(from),
        to: world(to),
        sigma_m: 0.02,
    };
    let aside = corner([5.0, -4.0, 6.0], [5.0, -4.0, 7.0]);
    assert_eq!(why_not(&model, aside), NotApplied::NoCorner);
    let far = corner([6.0, -4.0, 6.0], [600.0, -4.0, 7.0]);
    assert_eq!(why_not(&model, far), NotApplied::Implausible);
    let inside_out = corner([6.0, -4.0, 6.0], [-20.0, 30.0, 6.0]);
    assert_eq!(why_not(&model, inside_out), NotApplied::WouldNotClose);
    // What it was about goes with an earlier correction.
    let (_, trace) = corrected(
        &model,
        &[
            Correction::DeleteBuilding { building: there.at },
            delete(there),
        ],
    );
    assert_eq!(trace.outcomes, [None, Some(NotApplied::NoFacet)]);
}

#[test]
fn corrections_are_read_as_they_were_written_and_refused_otherwise() {
    let model = truth();
    let all = vec![
        Correction::DeleteFacet {
            facet: place(&model, 1.0, 2.0),
            filled: Some(true),
        },
        Correction::MoveEdge {
            from: edge([[6.0, 4.0, 6.0], [-6.0, 4.0, 6.0]]),
            to: edge([[6.0, 4.0, 7.0], [-6.0, 4.0, 7.0]]),
            sigma_m: 0.1,
        },
        Correction::SetEave {
            building: world([0.0; 3]),
            height: 7.0,
        },
    ];
    let text = serde_json::to_string(&all).unwrap();
    assert_eq!(corrections_from_json(&text).unwrap(), all);
    let short = r#"[{"correction": "move_corner", "from": [1,2,3], "to": [1,2,4]}]"#;
    assert!(matches!(
        corrections_from_json(short).unwrap()[0],
        Correction::MoveCorner { sigma_m: 0.02, .. }
    ));
    for (bad, named) in [
        (r#"{"correction": "confirm"}"#, "sequence"),
        (r#"[{"correction": "move_korner"}]"#, "move_korner"),
        (r#"[{"correction": "set_level"}]"#, "facet"),
        (
            r#"[{"correction": "delete_building", "building": [1, 2]}]"#,
            "[0]",
        ),
        (
            r#"[{"correction": "delete_building", "building": [1, 2, 3], "x": 1}]"#,
            "unknown field",
        ),
        (
            r#"[{"correction": "set_eave", "building": [1, 2, 3], "height": 1e999}]"#,
            "number",
        ),
        ("[", "EOF"),
    ] {
        let problem = corrections_from_json(bad).unwrap_err().to_string();
        assert!(problem.contains(named), "{bad}: {problem}");
    }
}

#[test]
fn whatever_is_corrected_the_invariants_hold() {
    let model = truth();
    let mut random = uniform(7);
    let mut applied = 0;
    for _ in 0..60 {
        let mut number = |from: f64, to: f64| from + (to - from) * random();
        let corrections: Vec<Correction> = (0..3)
            .map(|_| {
                let p = [number(-7.0, 7.0), number(-5.0, 5.0), number(5.0, 10.0)];
                let q = [number(-7.0, 7.0), number(-5.0, 5.0), number(5.0, 10.0)];
                let [x, y] = [number(-5.9, 5.9), number(-3.9, 3.9)];
                let here = place(&model, x, y);
                let corners: Vec<Point3<f64>> =
                    model.facets.iter().flat_map(|f| f.outer.clone()).collect();
                let corner = corners[(number(0.0, 7.99)) as usize] + Vector3::from(ORIGIN);
                match number(0.0, 7.0) as usize {
                    0 => Correction::DeleteFacet {
                        facet: here,
                        filled: None,
                    },
                    1 => Correction::Split {
                        facet: here,
                        along: edge([p, q]),
                    },
                    2 => Correction::MoveCorner {
                        from: corner,
                        to: world(p),
                        sigma_m: 0.02,
                    },
                    3 => Correction::AddFacet {
                        outline: vec![world(p), world(q), corner, world([y, x, 8.0])],
                    },
                    4 => Correction::SetSlope {
                        facet: here,
                        slope_deg: number(0.0, 79.0),
                    },
                    5 => Correction::Merge {
                        facet: here,
                        with: place(&model, -x, -y),
                    },
                    _ => Correction::MoveEdge {
                        from: edge([[6.0, 0.0, 9.0], [-6.0, 0.0, 9.0]]),
                        to: edge([[6.0, y, p[2]], [-6.0, y, q[2]]]),
                        sigma_m: 0.1,
                    },
                }
            })
            .collect();
        // Invariants are looked at there.
        let (_, trace) = corrected(&model, &corrections);
        applied += trace.outcomes.iter().filter(|why| why.is_none()).count();
    }
    assert!(applied > 40, "{applied}");
}
