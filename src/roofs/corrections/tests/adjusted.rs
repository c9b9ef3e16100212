//! Corners, edges and slopes stated.

use super::*;

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
            slope_deg: crate::base::math::atan(0.75).to_degrees(),
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
fn a_corner_that_goes_far_arrives() {
    let to = [6.0, -5.5, 6.0];
    let pulled = Correction::MoveCorner {
        from: world([6.0, -4.0, 6.0]),
        to: world(to),
        sigma_m: 0.02,
    };
    let found = mended(&truth(), &[pulled]);
    let all = found.facets.iter().flat_map(|f| &f.outer);
    let least = all.map(|p| (p - Point3::from(to)).norm());
    let least = least.fold(f64::MAX, f64::min);
    assert!(least < 0.02, "{least}");
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
