//! Lists of corrections, ground and buildings, and what is not applied.

use nalgebra::Point2;

use super::*;
use crate::base::params::corrections_from_json;
use crate::roofs::model::Obstruction;
use crate::roofs::testing::uniform;

#[test]
fn without_corrections_a_model_keeps_its_bits() {
    let model = truth();
    let (found, trace) = corrected(&model, &[]);
    assert_eq!(found, model);
    assert_eq!(trace.sources.len(), 2);
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
fn what_stands_on_a_facet_goes_and_the_facet_stays() {
    let mut model = truth();
    let box_at = |x: f64| Obstruction {
        outline: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(dx, dy)| Point2::new(x + dx, 1.0 + dy))
            .into(),
        height_m: 1.0,
        height_sigma_m: None,
        probability: 0.8,
    };
    let at = FacetPlace {
        at: world([0.5, 1.5, 0.0]),
        ..place(&model, 0.5, 1.5)
    };
    let on = (model
        .facets
        .iter()
        .position(|f| f.covers(&Point2::new(0.5, 1.5))))
    .unwrap();
    model.facets[on].obstructions = vec![box_at(-2.0), box_at(0.0)];
    let delete = Correction::DeleteObstruction { at: at.at };
    let found = mended(&model, std::slice::from_ref(&delete));
    let mut expected = model.clone();
    expected.facets[on].obstructions.pop();
    assert_eq!(found, expected);
    assert_eq!(why_not(&found, delete), NotApplied::NoObstruction);
    let beside = Correction::DeleteObstruction {
        at: world([100.0, 0.0, 0.0]),
    };
    assert_eq!(why_not(&model, beside), NotApplied::NoFacet);
}

#[test]
fn what_a_person_sees_on_a_facet_stands_there_as_far_as_the_facet_reaches() {
    let mut model = truth();
    let on = (model
        .facets
        .iter()
        .position(|f| f.covers(&Point2::new(0.5, 1.5))))
    .unwrap();
    let add = |corners: &[[f64; 2]], height_m| Correction::AddObstruction {
        outline: corners.iter().map(|&[x, y]| world([x, y, 0.0])).collect(),
        height_m,
    };
    // Across the ridge, drawn clockwise; its middle lies on the facet to the north.
    let drawn = [[0.0, -0.5], [0.0, 1.5], [1.0, 1.5], [1.0, -0.5]];
    let found = mended(&model, &[add(&drawn, 0.8)]);
    let [added] = &found.facets[on].obstructions[..] else {
        panic!("{:?}", found.facets[on].obstructions);
    };
    let area = crate::base::geometry::signed_area(added.outline.iter().copied());
    assert!(
        (area - 1.5).abs() < 1e-6,
        "to the ridge, from above: {area}"
    );
    assert_eq!((added.height_m, added.probability), (0.8, 1.0));
    // What was found there is this, and not a second one.
    model.facets[on].obstructions = vec![Obstruction {
        probability: 0.8,
        height_m: 0.3,
        ..added.clone()
    }];
    let again = mended(&model, &[add(&drawn, 0.8)]);
    assert_eq!(again, found);
    let delete = Correction::DeleteObstruction {
        at: world([0.5, 1.0, 0.0]),
    };
    assert_eq!(mended(&found, &[delete]), truth());

    let why = |corners: &[[f64; 2]], height_m| why_not(&model, add(corners, height_m));
    for height in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(why(&drawn, height), NotApplied::Implausible, "{height}");
    }
    assert_eq!(why(&drawn[..2], 0.8), NotApplied::Implausible);
    assert_eq!(
        why(&[[0.0, 1.0], [1.0, 2.0], [1.0, 1.0], [0.0, 2.0]], 0.8),
        NotApplied::NoRoom
    );
    assert_eq!(
        why(&[[0.0, 1.0], [0.05, 1.0], [0.05, 1.05]], 0.8),
        NotApplied::NoRoom
    );
    assert_eq!(
        why(&drawn.map(|[x, y]| [x + 50.0, y]), 0.8),
        NotApplied::NoFacet
    );
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
        Correction::AddEdge {
            photograph: "a photograph.jpg".to_owned(),
            pixels: [[1.5, 2.0], [30.25, 1e3]].map(nalgebra::Point2::from),
            sigma_px: 0.75,
        },
    ];
    let text = serde_json::to_string(&all).unwrap();
    assert_eq!(corrections_from_json(&text).unwrap(), all);
    let short = r#"[{"correction": "move_corner", "from": [1,2,3], "to": [1,2,4]}]"#;
    assert!(matches!(
        corrections_from_json(short).unwrap()[0],
        Correction::MoveCorner { sigma_m: 0.02, .. }
    ));
    // As projects had it before the hand stated its accuracy.
    let short =
        r#"[{"correction": "add_edge", "photograph": "a.jpg", "pixels": [[1, 2], [9, 2]]}]"#;
    assert!(matches!(
        corrections_from_json(short).unwrap()[0],
        Correction::AddEdge { sigma_px: 2.0, .. }
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
            r#"[{"correction": "add_edge", "photograph": "a.jpg", "pixels": [[1, 2]]}]"#,
            "[0]",
        ),
        (
            r#"[{"correction": "add_edge", "photograph": "a.jpg", "pixels": [[1, 2], [1e999, 3]]}]"#,
            "number",
        ),
        (
            r#"[{"correction": "add_edge", "photograph": "a", "pixels": [[1, 2], [9, 3]], "sigma_px": "x"}]"#,
            "[0]",
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
                match number(0.0, 9.0) as usize {
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
                    5 => Correction::AddEdge {
                        photograph: gable_scene(16).0.views[0].name.clone(),
                        pixels: [[p[0] + 8.0, p[1] + 8.0], [q[0] + 8.0, q[1] + 8.0]]
                            .map(nalgebra::Point2::from),
                        sigma_px: 2.0,
                    },
                    6 => Correction::Merge {
                        facet: here,
                        with: place(&model, -x, -y),
                    },
                    7 => Correction::AddObstruction {
                        outline: vec![world(p), world(q), corner],
                        height_m: number(0.1, 3.0),
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
