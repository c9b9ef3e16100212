//! Facets deleted, merged, divided, added.

use super::*;

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
