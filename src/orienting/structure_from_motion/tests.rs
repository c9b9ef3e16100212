//! The whole chain on rendered photographs.

use std::collections::BTreeMap;
use std::sync::Mutex;

use nalgebra::{Matrix3, Point2, Point3};

use super::similarity::Similarity;
use super::*;
use crate::base::execution::MergedShards;
use crate::orienting::orientation::{InputFile, rotation_from_omega_phi_kappa};
use crate::orienting::scene::Scene;
use crate::orienting::synthetic::{drone_scene, to_files, tower_scene_of};
use crate::photographs::camera::Camera;

const SIZE_PX: u32 = 300;

/// The photographs of a scene without their orientation.
fn photographs(scene: &Scene) -> Vec<InputFile> {
    let files = to_files(scene).into_iter();
    let images = files.filter(|(path, _)| path.ends_with(".png"));
    images
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect()
}

/// [`orient`], where a photograph that several tests give is read once.
fn orient_again(files: &[InputFile], options: &OrientOptions) -> crate::Result<Oriented> {
    static READ: Mutex<BTreeMap<(String, Vec<u8>), ReadPhoto>> = Mutex::new(BTreeMap::new());
    let mut chain = OrientChain::new(options.clone());
    chain.set_lists(files)?;
    for file in files.iter().filter(|file| file.path.ends_with(".png")) {
        let mut read = READ.lock().unwrap();
        let key = (file.path.clone(), file.bytes.clone());
        let read = read
            .entry(key)
            .or_insert_with(|| ReadPhoto::read(file, options));
        chain.add(read.clone());
    }
    chain.connect(MergedShards::default())?;
    chain.orient(None)
}

fn options() -> OrientOptions {
    OrientOptions {
        features: FeatureOptions {
            most: 1200,
            ..FeatureOptions::default()
        },
        ..OrientOptions::default()
    }
}

fn png(width: u32, pixel: impl Fn(u32, u32) -> u8) -> Vec<u8> {
    let image = image::GrayImage::from_fn(width, width, |x, y| image::Luma([pixel(x, y)]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn photographs_alone_are_oriented_and_go_on_to_a_scene() {
    let (scene, _) = drone_scene(SIZE_PX);
    let mut files = photographs(&scene);
    // One photograph of something else, one of nothing.
    let hash = |x: u32, y: u32| {
        (x / 3)
            .wrapping_mul(2_654_435_761)
            .wrapping_add((y / 3).wrapping_mul(40_503_977))
            >> 13
    };
    files.push(InputFile::new(
        "images/stranger.png",
        png(SIZE_PX, |x, y| (hash(x, y) % 251) as u8),
    ));
    files.push(InputFile::new("images/sky.png", png(SIZE_PX, |_, _| 200)));
    let oriented = orient(&files, &options()).unwrap();
    let report = &oriented.report;
    assert_eq!(report.photos.len(), 9, "{}", report.to_text());
    let reasons: Vec<_> = report
        .left_out
        .iter()
        .map(|l| (l.file.as_str(), &l.reason))
        .collect();
    assert!(
        matches!(
            reasons[..],
            [
                ("images/sky.png", NotJoined::FewFeatures { keypoints: 0 }),
                ("images/stranger.png", NotJoined::NoOverlap)
            ]
        ),
        "{reasons:?}"
    );
    assert!(
        report.rms_px < 0.3 && !report.is_metric,
        "{}",
        report.to_text()
    );
    // Nothing states the focal length.
    let focal = oriented.model.cameras[0].focal / f64::from(SIZE_PX);
    assert!((focal - 0.9).abs() < 0.02, "{focal}");
    let found: Vec<Point3<f64>> = oriented
        .model
        .photos
        .iter()
        .map(|p| p.pose.center)
        .collect();
    let truth: Vec<Point3<f64>> = scene.views.iter().map(|v| v.camera.center).collect();
    let similarity = Similarity::between(&found, &truth, &[1.0; 9]).unwrap();
    for (photo, view) in oriented.model.photos.iter().zip(&scene.views) {
        let pose = similarity.pose(&photo.pose);
        // A ground pixel is 0.17 m.
        let off = (pose.center - view.camera.center).norm();
        assert!(off < 0.17, "{}: {off} m", photo.path);
        let turn = (pose.rotation.matrix() - view.camera.r).norm().to_degrees();
        assert!(turn < 0.3, "{}: {turn} degrees", photo.path);
    }
    // The ray of a point is seen through the point in every other photograph.
    let model = &oriented.model;
    let [(slot, ray), (other, other_ray)] = model.points[0].rays[..2] else {
        panic!("a point has two rays")
    };
    let [(pixel, _), (seen, _)] = [
        &model.photos[slot].rays[ray],
        &model.photos[other].rays[other_ray],
    ];
    let curve = model.epipolar_curve(slot, other, &(*pixel).into());
    let seen = nalgebra::Point2::from(*seen);
    let beside = (curve.windows(2)).map(|ends| {
        let along = ends[1] - ends[0];
        let t = ((seen - ends[0]).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (ends[0] + along * t - seen).norm()
    });
    assert!(beside.fold(f64::INFINITY, f64::min) < 1.5);
    // A known length sets the scale.
    let mut measured = oriented.clone();
    assert!(measured.set_length(0.0, 3.0, "nothing").is_err());
    let [a, b] = [0, 1].map(|i| found[i]);
    (measured.set_length((b - a).norm(), 12.5, "the distance of two cameras")).unwrap();
    let [a, b] = [0, 1].map(|i| measured.model.photos[i].pose.center);
    assert!(((b - a).norm() - 12.5).abs() < 1e-9 && measured.report.is_metric);
    assert!(measured.report.frame.ends_with("two cameras, 12.5 m"));
    assert!(
        measured.report.warnings.is_empty(),
        "{:?}",
        measured.report.warnings
    );
    // What is written is read on: photographs, and the model beside them.
    files.truncate(9);
    let written = oriented.files().into_iter();
    files
        .extend(written.map(|(name, bytes)| InputFile::new(&format!("orientation/{name}"), bytes)));
    let loaded = crate::load_scene(&files, &crate::LoadOptions::default()).unwrap();
    assert_eq!(loaded.views.len(), 9);
}

/// A JPEG whose header asks for a turn or a mirror.
fn with_exif_orientation(jpeg: &[u8], orientation: u8) -> Vec<u8> {
    let mut exif = b"Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".to_vec();
    exif.extend([orientation, 0, 0, 0, 0, 0, 0, 0]);
    let length = (exif.len() + 2) as u16;
    let segment = [&[0xff, 0xe1][..], &length.to_be_bytes(), &exif].concat();
    [&jpeg[..2], &segment, &jpeg[2..]].concat()
}

#[test]
fn a_list_of_control_points_beside_the_photographs_gives_the_map() {
    let (scene, _) = drone_scene(SIZE_PX);
    let mut files = photographs(&scene);
    let map = nalgebra::Vector3::new(432_150.0, 5_412_340.0, 0.0);
    let mut list = "WGS84 UTM 32N\n".to_owned();
    let places = [
        [-9.0, -8.0, 0.0],
        [9.0, -7.0, 0.0],
        [8.0, 9.0, 0.0],
        [-8.0, 7.0, 3.0],
    ];
    for [x, y, z] in places {
        for (view, file) in scene.views.iter().zip(&files) {
            let seen = view.camera.project(&Point3::new(x, y, z)).unwrap();
            let name = file.name();
            let [e, n] = [x + map.x, y + map.y];
            list += &format!("{e} {n} {z} {} {} {name}\n", seen.x, seen.y);
        }
    }
    files.push(InputFile::new("gcp_list.txt", list.into_bytes()));
    let oriented = orient_again(&files, &options()).unwrap();
    let report = &oriented.report;
    assert!(
        report.is_metric && report.epsg == Some(32632),
        "{}",
        report.to_text()
    );
    assert_eq!(report.control.len(), 4);
    assert!(
        report.frame.contains("4 of 4 ground control points"),
        "{}",
        report.to_text()
    );
    for (photo, view) in oriented.model.photos.iter().zip(&scene.views) {
        let on_map = photo.pose.center + oriented.model.offset;
        let off = (on_map - (view.camera.center + map)).norm();
        // A ground pixel is 0.17 m; heights follow the focal length, which nothing states.
        assert!(off < 0.5, "{}: {off} m", photo.path);
    }
    // A length would take the coordinates of the map away.
    let mut scaled = oriented.clone();
    let refused = scaled.set_length(2.0, 3.0, "a length").unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("ground control points give the scale")
    );
    assert_eq!(scaled.files(), oriented.files());
    let images = String::from_utf8(oriented.files()[1].1.clone()).unwrap();
    let third = images.lines().nth(2).unwrap();
    let far = third
        .split(' ')
        .skip(5)
        .take(3)
        .map(|t| t.parse::<f64>().unwrap().abs());
    assert!(far.fold(0.0, f64::max) > 5e6, "{third}");
}

#[test]
fn places_beside_the_photographs_count_as_those_in_headers() {
    let (scene, _) = drone_scene(SIZE_PX);
    let mut files = photographs(&scene);
    let anchor = crate::orienting::orientation::Anchor {
        lon_deg: -71.1,
        lat_deg: 42.3,
        height_m: 30.0,
    };
    let mut text = "EPSG:4326\n".to_owned();
    for (photo, view) in files.iter().zip(&scene.views) {
        let name = photo.name().split('.').next().unwrap();
        let [lon, lat, height] = anchor.geographic(&view.camera.center);
        text += &format!("{name} {lon:.10} {lat:.10} {height:.4} 0 0 0 0.02 0.03\n");
    }
    files.push(InputFile::new("geo.txt", text.into_bytes()));
    let oriented = orient_again(&files, &options()).unwrap();
    let report = &oriented.report;
    assert!(
        report.frame.contains("the stated positions of 9 of 9"),
        "{}",
        report.to_text()
    );
    assert!(report.is_metric);
    let photos = &oriented.model.photos;
    let apart = (photos[8].pose.center - photos[0].pose.center).norm();
    let truth = (scene.views[8].camera.center - scene.views[0].camera.center).norm();
    assert!((apart / truth - 1.0).abs() < 0.01, "{apart} {truth}");
}

#[test]
fn a_stated_focal_length_that_the_photographs_contradict_is_named_and_mended() {
    let files = photographs(&drone_scene(SIZE_PX).0);
    let truth = 0.9 * f64::from(SIZE_PX);
    let stated = |focal_px: f64| OrientOptions {
        focal_px: Some(focal_px),
        ..options()
    };
    let is_named = |words: &str| words.contains("contradict the stated focal length");
    for (factor, is_wrong) in [
        (1.0, false),
        (1.04, false),
        (1.3, true),
        (0.4, true),
        (3.0, true),
    ] {
        let report = orient_again(&files, &stated(factor * truth))
            .unwrap()
            .report;
        let named = report.warnings.iter().any(|w| is_named(w));
        assert_eq!(named, is_wrong, "{factor}: {}", report.to_text());
        assert_eq!(report.photos.len(), 9, "{factor}");
        let focal = report.cameras[0].parameters[0];
        assert!((focal / truth - 1.0).abs() < 0.02, "{factor}: {focal}");
        assert!((report.cameras[0].stated_focal_px - factor * truth).abs() < 1e-9);
    }
    // Where too few photographs join to say which it is, they are refused.
    let mut few = files[..2].to_vec();
    few.push(InputFile::new(
        "images/stranger.png",
        png(SIZE_PX, |x, y| ((x / 3 * 7919) ^ (y / 3 * 104_729)) as u8),
    ));
    let message = |focal: f64| orient_again(&few, &stated(focal)).unwrap_err().to_string();
    assert!(!is_named(&message(truth)), "{}", message(truth));
    let wrong = message(3.0 * truth);
    assert!(
        is_named(&wrong) && wrong.contains("state the focal length in pixels"),
        "{wrong}"
    );
}

#[test]
fn a_length_is_measured_between_places_that_are_marked_in_photographs() {
    let (scene, _) = drone_scene(SIZE_PX);
    let mut oriented = orient_again(&photographs(&scene), &options()).unwrap();
    let ends = [Point3::new(-8.0, -6.0, 0.0), Point3::new(7.0, 5.0, 3.0)];
    let marks = ends.map(|end| {
        let seen = scene.views.iter().zip(&oriented.model.photos).step_by(3);
        let mark = |(view, photo): (&crate::orienting::scene::View, &OrientedPhoto)| {
            let pixel = view.camera.project(&end).unwrap();
            (photo.path.clone(), Point2::new(pixel.x, pixel.y))
        };
        seen.map(mark).collect::<Vec<_>>()
    });
    let model = &oriented.model;
    let found = model.measure_length([&marks[0], &marks[1]]).unwrap();
    assert!(found.rms_px < 0.5, "{found:?}");
    let few = model.measure_length([&marks[0], &marks[1][..1]]);
    assert_eq!(few, Err(NotMeasured::FewMarks));
    let same = [marks[0][0].clone(), marks[0][0].clone()];
    let parallel = model.measure_length([&marks[0], &same]);
    assert_eq!(parallel, Err(NotMeasured::NoMeeting));
    // The scale of the world follows: the cameras stand as far apart as they were.
    let truth = (ends[1] - ends[0]).norm();
    (oriented.set_length(found.length, truth, "a length measured in the photographs")).unwrap();
    let apart = |a: Point3<f64>, b: Point3<f64>| (b - a).norm();
    let photos = &oriented.model.photos;
    let (first, last) = (photos[0].pose.center, photos[8].pose.center);
    let [a, b] = [0, 8].map(|i| scene.views[i].camera.center);
    assert!((apart(first, last) / apart(a, b) - 1.0).abs() < 0.01);
    assert!(
        found.sigma > 0.0 && found.sigma < 0.05 * found.length,
        "{found:?}"
    );
}

#[test]
fn a_turned_photograph_is_worked_on_as_it_is_stored() {
    let (scene, _) = drone_scene(SIZE_PX);
    let rgb = &scene.views[0].rgb;
    let cut = image::imageops::crop_imm(rgb, 0, 0, 300, 200).to_image();
    let mut jpeg = std::io::Cursor::new(Vec::new());
    cut.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
    let jpeg = jpeg.into_inner();
    let read = |bytes: Vec<u8>| ReadPhoto::read(&InputFile::new("a.jpg", bytes), &options());
    let plain = read(jpeg.clone());
    assert_eq!(plain.size(), Some([300, 200]));
    for turn in [3, 6, 8] {
        let turned = read(with_exif_orientation(&jpeg, turn));
        assert_eq!(turned.to_bytes(), plain.to_bytes(), "{turn}");
    }
    let mirrored = read(with_exif_orientation(&jpeg, 2)).problem().unwrap();
    assert!(mirrored.contains("mirror"), "{mirrored}");
}

#[test]
fn four_photographs_tell_the_focal_length() {
    let (scene, _) = drone_scene(SIZE_PX);
    let mut files = photographs(&scene);
    files.truncate(4);
    let oriented = orient_again(&files, &options()).unwrap();
    assert_eq!(oriented.report.photos.len(), 4);
    let focal = oriented.model.cameras[0].focal / f64::from(SIZE_PX);
    assert!((focal - 0.9).abs() < 0.02, "{focal}");
}

#[test]
fn a_camera_that_only_turns_is_refused_by_name() {
    let size = SIZE_PX;
    let (focal, middle) = (0.9 * f64::from(size), f64::from(size) / 2.0);
    let k = Matrix3::new(focal, 0.0, middle, 0.0, focal, middle, 0.0, 0.0, 1.0);
    let cameras: Vec<(String, Camera)> = [[0.0, 0.0, 0.0], [0.08, 0.05, 0.6], [-0.06, 0.1, -0.4]]
        .iter()
        .enumerate()
        .map(|(i, [o, p, q])| {
            let r = rotation_from_omega_phi_kappa(*o, *p, *q);
            let at = Point3::new(1.0, -2.0, 45.0);
            (format!("t{i}.png"), Camera::new(k, r, at, size, size))
        })
        .collect();
    let files = photographs(&tower_scene_of(&cameras).0);
    let stated = OrientOptions {
        focal_px: Some(focal),
        ..options()
    };
    let message = orient(&files, &stated).unwrap_err().to_string();
    assert!(message.contains("the camera only turned"), "{message}");
}

#[test]
fn what_cannot_be_oriented_is_refused_with_advice() {
    let flat = |name: &str| InputFile::new(name, png(120, |_, _| 90));
    let message = |files: &[InputFile]| orient(files, &options()).unwrap_err().to_string();
    let two = message(&[flat("a.png"), flat("b.png")]);
    assert!(two.starts_with("2 photographs"), "{two}");
    let blurred = message(&[flat("a.png"), flat("b.png"), flat("c.png")]);
    assert!(
        blurred.contains("a.png: 0 keypoints: it is blurred"),
        "{blurred}"
    );
    let noise = |seed: u32| {
        let bytes = png(160, |x, y| {
            let h = ((x / 4) ^ seed).wrapping_mul(0x9e37_79b1) ^ (y / 4).wrapping_mul(0x85eb_ca77);
            (h.wrapping_mul(0x2c1b_3c6d) >> 24) as u8
        });
        InputFile::new(&format!("{seed}.png"), bytes)
    };
    let apart = message(&[noise(91), noise(5_003), noise(70_001)]);
    assert!(
        apart.contains("no two photographs show enough of the same"),
        "{apart}"
    );
}

#[test]
fn divided_between_instances_the_result_is_the_same() {
    let files = photographs(&drone_scene(SIZE_PX).0);
    let options = OrientOptions {
        features: FeatureOptions {
            most: 400,
            ..FeatureOptions::default()
        },
        ..OrientOptions::default()
    };
    let whole = orient(&files, &options).unwrap();
    // Photographs come in any order, as bytes; pairs are dealt to two.
    let mut chain = OrientChain::new(options.clone());
    for file in files.iter().rev() {
        let read = ReadPhoto::read(file, &options).to_bytes();
        assert!(ReadPhoto::from_bytes(&read[..read.len() - 1]).is_none());
        chain.add(ReadPhoto::from_bytes(&read).unwrap());
    }
    let mut merged = MergedShards::default();
    for map in OrientChain::shard_maps() {
        for index in 0..2 {
            let shard = chain.run_shard(map, [index, 2], merged.clone(), &crate::silent());
            assert!(merged.merge(map, &shard));
        }
    }
    chain.connect(merged).unwrap();
    let pairs = chain.pairs();
    assert_eq!(chain.pair_matches(0).len(), pairs[0].matches);
    let mut grown = Vec::new();
    let divided = chain.orient(Some(&mut |snapshot: Snapshot| {
        grown.push((snapshot.photos.len(), snapshot.points.len()));
    }));
    assert_eq!(divided.unwrap().files(), whole.files());
    assert!(
        grown.len() > 3 && grown.is_sorted_by_key(|g| g.0),
        "{grown:?}"
    );
}
