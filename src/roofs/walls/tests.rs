//! A planted house whose walls stand inside its roof's rim, or below it.

use super::*;
use crate::orienting::synthetic::{SyntheticTruth, gable_scene, oblique_scene};
use crate::roofs::solids::close_buildings;
use crate::roofs::testing::facet;

fn walls_of((scene, truth): &(Scene, SyntheticTruth)) -> BuildingWalls {
    let facets: Vec<Facet> = truth.facets.iter().map(|(_, ring)| facet(ring)).collect();
    let (model, _) = close_buildings(&facets, |_| truth.ground_z);
    let ground = Ground::level(truth.ground_z);
    let mut walls = place_walls(scene, &model, Some(&ground));
    assert_eq!(walls.len(), 1);
    walls.remove(0)
}

#[test]
fn walls_below_an_overhang_are_found_in_oblique_views() {
    let planted = oblique_scene(400, 0.6);
    let found = walls_of(&planted);
    assert_eq!(found.walls.len(), 4);
    for wall in &found.walls {
        assert!(wall.seen, "{wall:?}");
        assert!((wall.depth_m - 0.6).abs() < 0.05, "{wall:?}");
        assert!(wall.sigma_m.unwrap() < 0.08, "{wall:?}");
    }
    // 14 m by 9 m, eaves 4.5 m above the ground, slope 0.75.
    let depths: Vec<f64> = found.walls.iter().map(|w| w.depth_m).collect();
    let mean = depths.iter().sum::<f64>() / 4.0;
    let half = 4.5 - mean;
    let inside = (14.0 - 2.0 * mean) * 2.0 * (7.875 * half - 0.375 * half * half);
    let volume = found.volume_m3.unwrap();
    assert!((volume - inside).abs() < 0.02 * inside, "{volume} {inside}");
    let ceilings = found.solid.unwrap().faces.into_iter();
    assert_eq!(
        ceilings.filter(|f| f.surface == Surface::Ceiling).count(),
        2
    );
}

#[test]
fn walls_below_the_rim_stay_there() {
    let found = walls_of(&oblique_scene(400, 0.0));
    for wall in &found.walls {
        assert!(wall.seen && wall.depth_m < 0.06, "{wall:?}");
    }
}

#[test]
fn views_from_above_tell_nothing_and_walls_are_assumed() {
    let found = walls_of(&gable_scene(320));
    assert!(found.walls.iter().all(|w| !w.seen && w.depth_m == 0.0));
    assert!(found.walls.iter().all(|w| w.sigma_m.is_none()));
    assert_eq!((found.solid, found.volume_m3), (None, None));
}

#[test]
fn what_is_not_seen_is_assumed_as_its_like() {
    let eave = |y: f64, z: [f64; 3]| Side {
        rim: vec![
            Point3::new(0.0, y, z[0]),
            Point3::new(5.0, y, z[1]),
            Point3::new(10.0, y, z[2]),
        ],
    };
    let level = [5.0; 3];
    let gabled = [5.0, 8.0, 5.0];
    let sides = [
        eave(0.0, level),
        eave(4.0, level),
        eave(8.0, gabled),
        eave(12.0, gabled),
    ];
    let seen = |depth_m: f64| {
        Some(DepthEstimate {
            depth_m,
            probability: 0.9,
            sigma_m: 0.05,
        })
    };
    let unsure = Some(DepthEstimate {
        probability: 0.4,
        ..seen(1.0).unwrap()
    });
    let depths = |estimates: [Option<DepthEstimate>; 4]| {
        let walls = walls(&sides, &estimates);
        walls.iter().map(|w| w.depth_m).collect::<Vec<_>>()
    };
    assert_eq!(
        depths([seen(0.5), None, seen(0.2), unsure]),
        [0.5, 0.5, 0.2, 0.2]
    );
    assert_eq!(depths([seen(0.5), None, None, unsure]), [0.5; 4]);
    assert_eq!(depths([None, unsure, None, None]), [0.0; 4]);
    assert_eq!(depths([seen(0.03), None, None, None]), [0.0; 4]);
}
