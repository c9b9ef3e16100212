//! Planted blocks, and what is stated of them.

use nalgebra::{Matrix3, Point3};

use super::*;
use crate::base::geometry::rotation_from_axis_angle;
use crate::base::math;
use crate::orienting::orientation::geocentric_of;
use crate::orienting::structure_from_motion::bundle::tests::planted;
use crate::orienting::structure_from_motion::random::Random;

mod late;

const ANCHOR: Anchor = Anchor {
    lon_deg: 8.4,
    lat_deg: 49.0,
    height_m: 0.0,
};

/// A block in a frame of its own, and what the photographs state of their poses.
fn moved() -> (Block, Block, Vec<StatedPose>) {
    let truth = planted(0.1, 3);
    let mut random = Random::new(5);
    let stated = (truth.photos.iter())
        .map(|p| {
            let pose = p.pose.as_ref().unwrap();
            let noise = Vector3::from_fn(|_, _| 0.3 * random.normal());
            StatedPose {
                position: Some(pose.center + noise + Vector3::z() * 37.0),
                rotation: Some(pose.rotation),
                ..StatedPose::default()
            }
        })
        .collect();
    let mut block = truth.clone();
    let similarity = Similarity {
        scale: 0.02,
        rotation: rotation_from_axis_angle(&Vector3::new(1.2, -0.7, 0.5)),
        shift: Vector3::new(0.3, 0.1, 4.0),
    };
    similarity.apply(&mut block);
    (truth, block, stated)
}

const PATHS: [&str; 9] = [
    "0.jpg", "1.jpg", "2.jpg", "3.jpg", "4.jpg", "5.jpg", "6.jpg", "7.jpg", "8.jpg",
];

fn framed(
    block: &mut Block,
    stated: &[StatedPose],
    anchor: Option<Anchor>,
) -> (FrameBasis, Vec<String>) {
    to_frame(block, stated, anchor, false, &PATHS)
}

/// Largest distance of the centres in plan, and angle between the vertical directions.
fn off(block: &Block, truth: &Block) -> (f64, f64) {
    let mut off = (0.0f64, 0.0f64);
    for (a, b) in block.photos.iter().zip(&truth.photos) {
        let (a, b) = (a.pose.as_ref().unwrap(), b.pose.as_ref().unwrap());
        let d = a.center - b.center;
        off.0 = off.0.max(math::hypot(d.x, d.y));
        let up = a.rotation.inverse() * (b.rotation * Vector3::z());
        off.1 = off.1.max(math::acos(up.z.min(1.0)));
    }
    off
}

#[test]
fn stated_positions_give_metres_though_one_is_wrong() {
    let (truth, mut block, mut stated) = moved();
    stated[4].position = stated[4]
        .position
        .map(|p| p + Vector3::new(60.0, -20.0, 9.0));
    let (basis, _) = framed(&mut block, &stated, Some(ANCHOR));
    let FrameBasis::Positions {
        agreeing,
        stated,
        is_levelled,
        ..
    } = basis
    else {
        panic!("{basis:?}")
    };
    assert_eq!((agreeing, stated, is_levelled), (8, 9, false));
    let (plan, tilt) = off(&block, &truth);
    assert!(plan < 0.8 && tilt < 0.03, "{plan} {tilt}");
}

#[test]
fn a_single_strip_is_levelled() {
    let (truth, mut block, mut stated) = moved();
    for one in &mut stated[3..] {
        *one = StatedPose::default();
    }
    for (i, one) in stated[..3].iter_mut().enumerate() {
        let pose = truth.photos[i].pose.as_ref().unwrap();
        one.position = Some(pose.center);
        one.rotation = None;
    }
    let (basis, _) = framed(&mut block, &stated, Some(ANCHOR));
    assert!(
        matches!(
            basis,
            FrameBasis::Positions {
                is_levelled: true,
                ..
            }
        ),
        "{basis:?}"
    );
    let (_, tilt) = off(&block, &truth);
    assert!(tilt < 0.2, "{tilt}");
}

#[test]
fn without_positions_angles_or_the_ground_say_where_up_is() {
    let (truth, block, mut stated) = moved();
    stated.iter_mut().for_each(|s| s.position = None);
    let mut by_angles = block.clone();
    let (basis, _) = framed(&mut by_angles, &stated, None);
    assert!(
        matches!(basis, FrameBasis::Angles { rms_deg, .. } if rms_deg < 0.01),
        "{basis:?}"
    );
    assert!(off(&by_angles, &truth).1 < 1e-4);
    stated.iter_mut().for_each(|s| s.rotation = None);
    let mut by_plane = block;
    assert_eq!(
        framed(&mut by_plane, &stated, None),
        (
            FrameBasis::MainPlane,
            vec![words::NOTHING_STATED.to_owned()]
        )
    );
    let heights: Vec<f64> = centers(&by_plane).iter().map(|c| c.z).collect();
    assert!(
        heights.iter().all(|h| (80.0..120.0).contains(h)),
        "{heights:?}"
    );
    let off: f64 = (by_plane.photos.iter().zip(&truth.photos))
        .map(|(a, b)| {
            let [a, b] = [a, b].map(|p| p.pose.as_ref().unwrap().rotation * Vector3::z());
            a.z - b.z
        })
        .fold(0.0, |m, d| m.max(d.abs()));
    assert!(off < 0.05, "{off}");
}

/// What stated angles are in a header: yaw, pitch (-90 down), roll, degrees.
fn angles_of(cam_from_world: &Rotation3<f64>) -> [f64; 3] {
    // Image to world is Rz(-yaw) Rx(pitch) Ry(roll).
    let flip = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    let m = (flip * cam_from_world.matrix()).transpose();
    let pitch = math::asin(m[(2, 1)].clamp(-1.0, 1.0));
    let yaw = -math::atan2(-m[(0, 1)], m[(1, 1)]);
    let roll = math::atan2(-m[(2, 0)], m[(2, 2)]);
    let [yaw, pitch, roll] = [yaw, pitch, roll].map(f64::to_degrees);
    [yaw, pitch - 90.0, roll]
}

/// The block with angles in the headers, some of them changed, and what the frame says.
fn with_angles(
    change: impl Fn(usize, [f64; 3]) -> [f64; 3],
    applies_fix: bool,
) -> (f64, FrameBasis, String) {
    let (truth, mut block, mut stated) = moved();
    for (i, one) in stated.iter_mut().enumerate() {
        let angles = angles_of(&truth.photos[i].pose.as_ref().unwrap().rotation);
        let written = change(i, angles);
        *one = StatedPose {
            yaw_pitch_roll: Some(written),
            rotation: Some(rotation_of_angles(written)),
            ..StatedPose::default()
        };
    }
    let (basis, notes) = to_frame(&mut block, &stated, None, applies_fix, &PATHS);
    let deg = off(&block, &truth).1.to_degrees();
    (deg, basis, notes.join("\n"))
}

#[test]
fn angles_that_contradict_are_left_out_and_their_mistake_is_named() {
    let (deg, _, notes) = with_angles(|_, a| a, false);
    assert!(deg < 0.01 && notes.is_empty(), "{deg} {notes}");
    type Change = fn(usize, [f64; 3]) -> [f64; 3];
    let cases: [(Change, &str); 11] = [
        (
            |i, [y, p, r]| {
                if i % 2 == 0 {
                    [y + 180.0, p, r + 180.0]
                } else {
                    [y, p, r]
                }
            },
            "roll of 180",
        ),
        (
            |i, [y, p, r]| if i < 4 { [y, p, r + 180.0] } else { [y, p, r] },
            "roll of 180",
        ),
        (
            |i, [y, p, r]| if i == 3 { [y, p, r - 180.0] } else { [y, p, r] },
            "roll of 180",
        ),
        (|_, [y, p, r]| [y + 180.0, p, r + 180.0], "roll of 180"),
        (|_, [y, p, r]| [y, -p, r], "pitch of the other sign"),
        (
            |i, [y, p, r]| if i > 5 { [y, -p, r] } else { [y, p, r] },
            "pitch of the other sign",
        ),
        (
            |_, [y, p, r]| [y, p + 90.0, r],
            "counted from straight down",
        ),
        (
            |i, [y, p, r]| if i < 3 { [y, p + 90.0, r] } else { [y, p, r] },
            "counted from straight",
        ),
        (|_, [y, p, r]| [y, p - 90.0, r], "counted from the horizon"),
        (|_, angles| angles.map(f64::to_radians), "angles in radians"),
        (
            |i, [y, p, r]| {
                if i < 2 {
                    [y, p + 71.0, r - 40.0]
                } else {
                    [y, p, r]
                }
            },
            "correct them",
        ),
    ];
    for (i, (change, words)) in cases.into_iter().enumerate() {
        let (deg, basis, notes) = with_angles(change, false);
        // The plane of the planted points is off by 3 degrees.
        assert!(deg < 4.0, "{i}: {deg} degrees, {basis:?}, {notes}");
        assert!(notes.contains(words), "{i}: {notes}");
        let (deg, basis, notes) = with_angles(change, true);
        let is_explained = notes.contains("they were read as");
        assert_eq!(is_explained, words != "correct them", "{i}: {notes}");
        assert!(deg < 0.1, "{i}: {deg} degrees, {basis:?}");
        let FrameBasis::Angles {
            photos: [agreeing, 9],
            ..
        } = basis
        else {
            panic!("{basis:?}")
        };
        assert_eq!(agreeing == 9, is_explained, "{i}");
    }
}

#[test]
fn angles_that_scatter_by_more_than_half_a_right_angle_say_nothing() {
    // Up is above, left and right of the image by turns.
    let turned = [[0.0; 3], [0.0, -90.0, 90.0], [0.0, -90.0, -90.0]];
    let (deg, basis, notes) = with_angles(|i, _| turned[i % 3], false);
    assert_eq!(basis, FrameBasis::MainPlane, "{notes}");
    assert!(
        deg < 4.0 && notes.contains("contradict each other"),
        "{deg} {notes}"
    );
}

#[test]
fn mirrored_positions_do_not_turn_the_block_over() {
    for signs in [[-1.0, 1.0], [1.0, -1.0]] {
        for level in [0.0, 1.0] {
            let (truth, mut block, mut stated) = moved();
            for (one, photo) in stated.iter_mut().zip(&truth.photos) {
                let center = photo.pose.as_ref().unwrap().center;
                let [east, north] = signs;
                let z = 40.0 + level * (center.z - 40.0);
                one.position = Some(Point3::new(east * center.x, north * center.y, z));
            }
            let (basis, notes) = framed(&mut block, &stated, Some(ANCHOR));
            assert!(matches!(basis, FrameBasis::Angles { .. }), "{basis:?}");
            assert!(notes.join("").contains("mirror"), "{notes:?}");
            assert!(off(&block, &truth).1 < 0.01);
        }
    }
}

#[test]
fn positions_without_heights_count_in_plan() {
    // How many heights are left, of nine, and the largest tilt in degrees.
    for (left, tilt, has_angles) in [
        (0, 0.1, true),
        (0, 4.0, false),
        (2, 0.1, true),
        (6, 3.0, true),
    ] {
        let (truth, mut block, mut stated) = moved();
        for (i, one) in stated.iter_mut().enumerate() {
            one.lacks_height = i >= left;
            if one.lacks_height {
                one.position = one.position.map(|p| Point3::new(p.x, p.y, -400.0));
            }
            if !has_angles {
                one.rotation = None;
            }
        }
        let (basis, notes) = framed(&mut block, &stated, Some(ANCHOR));
        let FrameBasis::Positions {
            agreeing: 9,
            stated: 9,
            heights,
            ..
        } = basis
        else {
            panic!("{left}: {basis:?} {notes:?}")
        };
        assert_eq!(heights, left);
        let (_, found) = off(&block, &truth);
        assert!(found.to_degrees() < tilt, "{left}: {}", found.to_degrees());
        let apart = |b: &Block| {
            let [a, c] = [0, 8].map(|i| b.photos[i].pose.as_ref().unwrap().center);
            (a - c).norm()
        };
        assert!((apart(&block) / apart(&truth) - 1.0).abs() < 0.03);
    }
}

#[test]
fn positions_that_give_nothing_are_said_to() {
    type Change = fn(usize, &mut StatedPose);
    let all: [(Change, &str); 3] = [
        (
            |_, one| one.position = Some(Point3::new(1.0, 2.0, 3.0)),
            "all 9 positions state one place",
        ),
        (
            |i, one| {
                if i > 1 {
                    one.position = None;
                }
            },
            "2 of the oriented photographs state a position",
        ),
        (
            |i, one| {
                let h = |k: usize| ((i * 7 + k * 5) % 9) as f64 - 4.0;
                one.position = Some(Point3::new(h(1), h(2), h(3)));
            },
            "as much as they differ",
        ),
    ];
    for (change, words) in all {
        let (truth, mut block, mut stated) = moved();
        stated
            .iter_mut()
            .enumerate()
            .for_each(|(i, one)| change(i, one));
        let (basis, notes) = framed(&mut block, &stated, Some(ANCHOR));
        assert!(matches!(basis, FrameBasis::Angles { .. }), "{basis:?}");
        assert!(notes.join("").contains(words), "{words}: {notes:?}");
        assert!(off(&block, &truth).1 < 0.01);
    }
}

/// Whatever headers say of heights and places: a frame that stands, and the words for it.
#[test]
fn headers_that_are_wrong_in_usual_ways_never_turn_the_block_over() {
    type Change = fn(usize, Point3<f64>) -> Point3<f64>;
    let all: [(&str, Change, bool, &str); 13] = [
        (
            "heights below zero",
            |_, p| Point3::new(p.x, p.y, -p.z),
            true,
            "with heights of the other sign: only their plan",
        ),
        (
            "heights in feet",
            |_, p| Point3::new(p.x, p.y, p.z / 0.3048),
            true,
            "with heights in feet: only their plan",
        ),
        (
            "latitude before longitude",
            |_, p| {
                let [lat, lon, height] = Anchor {
                    lon_deg: 49.0,
                    lat_deg: 8.4,
                    ..ANCHOR
                }
                .geographic(&p);
                ANCHOR.local(&geocentric_of(lon, lat, height))
            },
            false,
            "latitude and longitude exchanged: they were not used",
        ),
        ("all in feet", |_, p| p / 0.3048, true, ""),
        (
            "latitude for longitude",
            |_, p| Point3::new(p.y, p.x, p.z),
            false,
            "mirror",
        ),
        (
            "E for W",
            |_, p| Point3::new(-p.x, p.y, p.z),
            false,
            "mirror",
        ),
        (
            "S without a letter",
            |_, p| Point3::new(p.x, -p.y, p.z),
            false,
            "mirror",
        ),
        (
            "S and W without letters",
            |_, p| Point3::new(-p.x, -p.y, p.z),
            true,
            "",
        ),
        (
            "a barometer that stuck",
            |_, p| Point3::new(p.x, p.y, 137.0),
            true,
            "",
        ),
        (
            "heights above take-off",
            |_, p| p - Vector3::z() * 300.0,
            true,
            "",
        ),
        (
            "one far off",
            |i, p| if i == 4 { p * 40.0 } else { p },
            true,
            "left out: 4.jpg",
        ),
        (
            "one height of 0",
            |i, p| {
                if i == 2 {
                    Point3::new(p.x, p.y, 0.0)
                } else {
                    p
                }
            },
            true,
            "2.jpg",
        ),
        (
            "a mark at zero",
            |i, p| if i == 7 { Point3::origin() } else { p },
            true,
            "7.jpg",
        ),
    ];
    let mut wrong = Vec::new();
    for has_angles in [true, false] {
        // Without angles five of nine heights below zero agree with a slope.
        for (what, change, is_placed, words) in &all[usize::from(!has_angles)..] {
            let (truth, mut block, mut stated) = moved();
            for (i, (one, photo)) in stated.iter_mut().zip(&truth.photos).enumerate() {
                let center = photo.pose.as_ref().unwrap().center;
                one.position = Some(change(i, center));
                one.rotation = one.rotation.filter(|_| has_angles);
                one.sigma_m = Some(0.1);
            }
            let (basis, notes) = framed(&mut block, &stated, Some(ANCHOR));
            let said = notes.join("\n");
            let tilt = off(&block, &truth).1.to_degrees();
            let is_by_positions = matches!(basis, FrameBasis::Positions { .. });
            // Heights that are wrong as a whole tilt a small block, by what their residuals allow.
            let most = if *what == "a barometer that stuck" {
                20.0
            } else {
                6.0
            };
            if tilt > most || is_by_positions != *is_placed || !said.contains(words) {
                wrong.push(format!(
                    "{what}, {has_angles}: {tilt} degrees, {basis:?} {said}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
