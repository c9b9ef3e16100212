use nalgebra::{Point2, Point3, Rotation3, Vector2, Vector3, Vector6};

use super::*;
use crate::base::geometry::rotation_from_axis_angle;
use crate::orienting::structure_from_motion::block::{Block, BlockPhoto, Observation, Pose, Track};
use crate::orienting::structure_from_motion::intrinsics::Intrinsics;
use crate::orienting::structure_from_motion::random::Random;
use crate::orienting::structure_from_motion::resection::moved;

/// Nine photographs in three strips over uneven ground, some of them tilted and turned; what
/// `sigma_px` of noise leaves of their keypoints.
pub(in super::super) fn planted(sigma_px: f64, seed: u64) -> Block {
    let mut random = Random::new(seed);
    let camera = Intrinsics {
        radial: [-0.08, 0.03],
        ..Intrinsics::new(900.0, [1000, 750])
    };
    let down = Rotation3::from_matrix_unchecked(nalgebra::Matrix3::from_diagonal(&Vector3::new(
        1.0, -1.0, -1.0,
    )));
    let poses: Vec<Pose> = (0..9)
        .map(|i| {
            let (column, row) = (f64::from(i % 3), f64::from(i / 3));
            let kappa = if i / 3 == 1 { 3.1 } else { 0.05 };
            let tilt = Vector3::new(0.3 * random.signed(), 0.3 * random.signed(), kappa);
            Pose {
                rotation: rotation_from_axis_angle(&tilt) * down,
                center: Point3::new(
                    20.0 * (column - 1.0),
                    20.0 * (row - 1.0),
                    60.0 + 6.0 * random.signed(),
                ),
            }
        })
        .collect();
    let mut photos: Vec<BlockPhoto> = (poses.into_iter())
        .map(|pose| BlockPhoto {
            keypoints: Vec::new(),
            camera: 0,
            sigma_px,
            factors: Vec::new(),
            pose: Some(pose),
        })
        .collect();
    let mut tracks = Vec::new();
    for _ in 0..400 {
        let world = Point3::new(
            45.0 * random.signed(),
            45.0 * random.signed(),
            6.0 * random.signed(),
        );
        let mut observations = Vec::new();
        for (i, photo) in photos.iter_mut().enumerate() {
            let p = photo.pose.as_ref().unwrap().in_camera(&world);
            let pixel = camera.project(&Vector2::new(p.x / p.z, p.y / p.z));
            let is_inside = (0.0..1000.0).contains(&pixel.x) && (0.0..750.0).contains(&pixel.y);
            if is_inside {
                let noise = Vector2::new(random.normal(), random.normal()) * sigma_px;
                observations.push(Observation {
                    photo: i,
                    keypoint: photo.keypoints.len(),
                    is_used: true,
                });
                photo.keypoints.push(Point2::from(pixel.coords + noise));
                photo.factors.push(1.0);
            }
        }
        if observations.len() >= 2 {
            let point = Some(world);
            tracks.push(Track {
                observations,
                point,
            });
        }
    }
    Block {
        photos,
        cameras: vec![camera],
        tracks,
    }
}

fn options() -> BundleOptions {
    BundleOptions {
        steps: 50,
        least_gain: 1e-10,
        prior: [0.2, 0.2, 0.2, 0.0, 0.0],
    }
}

/// Position and rotation differences after a similarity between two blocks.
fn differences(found: &Block, truth: &Block) -> (f64, f64) {
    let centers = |b: &Block| -> Vec<Point3<f64>> {
        b.photos
            .iter()
            .map(|p| p.pose.as_ref().unwrap().center)
            .collect()
    };
    let weights = vec![1.0; truth.photos.len()];
    let similarity = crate::orienting::structure_from_motion::similarity::Similarity::between(
        &centers(found),
        &centers(truth),
        &weights,
    )
    .unwrap();
    let (mut position, mut angle) = (0.0f64, 0.0f64);
    for (a, b) in found.photos.iter().zip(&truth.photos) {
        let (a, b) = (a.pose.as_ref().unwrap(), b.pose.as_ref().unwrap());
        let moved = similarity.pose(a);
        position = position.max((moved.center - b.center).norm());
        let off = moved.rotation.matrix() - b.rotation.matrix();
        angle = angle.max(off.norm() / std::f64::consts::SQRT_2);
    }
    (position, angle)
}

#[test]
fn a_disturbed_block_returns_to_what_was_planted() {
    let truth = planted(0.001, 5);
    let mut block = truth.clone();
    let mut random = Random::new(6);
    for photo in &mut block.photos {
        let step = Vector6::from_fn(|i, _| random.signed() * if i < 3 { 0.03 } else { 1.0 });
        photo.pose = photo.pose.as_ref().map(|p| moved(p, &step));
    }
    for track in &mut block.tracks {
        let shift = Vector3::from_fn(|_, _| random.signed());
        track.point = track.point.map(|p| p + shift);
    }
    block.cameras = vec![Intrinsics::new(840.0, [1000, 750])];
    for photo in &mut block.photos {
        photo.sigma_px = 0.5;
    }
    let means = block.cameras.clone();
    let mut loose = options();
    loose.prior = [10.0, 10.0, 10.0, 0.0, 0.0];
    adjust(&mut block, &means, &loose);
    let (position, angle) = differences(&block, &truth);
    assert!(position < 1e-2 && angle < 1e-4, "{position} {angle}");
    let camera = &block.cameras[0];
    assert!((camera.focal - 900.0).abs() < 0.1, "{camera:?}");
    assert!((camera.radial[0] + 0.08).abs() < 1e-3, "{camera:?}");
    assert_eq!(camera.center, [500.0, 375.0]);
}

#[test]
fn stated_deviations_are_those_of_many_throws() {
    let mut squares = 0.0;
    let mut stated = 0.0;
    let mut focal = [0.0; 2];
    let throws = 12;
    for seed in 0..throws {
        // The same block with other noise: the geometry is drawn first from the same numbers.
        let truth = planted(0.0, 5);
        let mut block = truth.clone();
        let mut random = Random::new(100 + seed);
        for photo in &mut block.photos {
            photo.sigma_px = 0.5;
            for pixel in &mut photo.keypoints {
                *pixel += Vector2::new(random.normal(), random.normal()) * 0.5;
            }
        }
        let means = block.cameras.clone();
        adjust(&mut block, &means, &options());
        let covariance = covariance(&block, &means, &options()).unwrap();
        let centers = |b: &Block| -> Vec<Point3<f64>> {
            b.photos
                .iter()
                .map(|p| p.pose.as_ref().unwrap().center)
                .collect()
        };
        let similarity = crate::orienting::structure_from_motion::similarity::Similarity::between(
            &centers(&block),
            &centers(&truth),
            &[1.0; 9],
        )
        .unwrap();
        for (i, (a, b)) in block.photos.iter().zip(&truth.photos).enumerate() {
            let moved = similarity.pose(a.pose.as_ref().unwrap());
            squares += (moved.center - b.pose.as_ref().unwrap().center).norm_squared();
            stated += covariance.centers[i].trace();
        }
        focal[0] += (block.cameras[0].focal - 900.0) * (block.cameras[0].focal - 900.0);
        focal[1] += covariance.cameras[0][0] * covariance.cameras[0][0];
    }
    let ratio = (squares / stated).sqrt();
    assert!((0.7..1.45).contains(&ratio), "{ratio}");
    let ratio = (focal[0] / focal[1]).sqrt();
    assert!((0.5..1.8).contains(&ratio), "{ratio}");
}

#[test]
fn a_wrong_observation_moves_nothing() {
    let truth = planted(0.3, 7);
    let mut block = truth.clone();
    let mut random = Random::new(8);
    for photo in &mut block.photos {
        for k in 0..photo.keypoints.len() / 25 {
            photo.keypoints[25 * k].x += 60.0 * random.signed();
        }
    }
    let means = block.cameras.clone();
    adjust(&mut block, &means, &options());
    let (position, angle) = differences(&block, &truth);
    assert!(position < 0.25 && angle < 3e-3, "{position} {angle}");
}
