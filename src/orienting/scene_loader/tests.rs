//! Each kind of bad input and the words of its refusal.

mod beside;

use nalgebra::Point2;

use super::{LoadOptions, inspect_files, load_scene};
use crate::orienting::orientation::InputFile;
use crate::orienting::scene::{Scene, View};
use crate::orienting::synthetic::{
    gable_scene, to_colmap, to_files, to_photogrammetric, to_projection,
};
use crate::photographs::camera::Distortion;

fn inputs(files: Vec<(String, Vec<u8>)>) -> Vec<InputFile> {
    files
        .into_iter()
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect()
}

fn gable_files() -> Vec<InputFile> {
    inputs(to_files(&gable_scene(48).0))
}

fn find<'a>(files: &'a mut [InputFile], path: &str) -> &'a mut InputFile {
    files
        .iter_mut()
        .find(|f| f.path == path)
        .expect("a file of the scene")
}

/// Replaces text in a file of the scene.
fn edit(files: &mut [InputFile], path: &str, from: &str, to: &str) {
    let file = find(files, path);
    let text = file.text().replace(from, to);
    assert_ne!(text, file.text(), "{from} stands in {path}");
    file.bytes = text.into_bytes();
}

/// The scene must be refused in these words, and the page must say the same.
fn refused(files: &[InputFile], options: &LoadOptions, words: &[&str]) {
    let message = load_scene(files, options).unwrap_err().to_string();
    for word in words {
        assert!(message.contains(word), "{message}\nlacks: {word}");
    }
    if *options == LoadOptions::default() {
        let inspection = inspect_files(files, &LoadOptions::default());
        // Only decoding finds an image whose header is sound.
        assert!(inspection.errors.is_empty() || inspection.errors[0] == message);
    }
}

fn all() -> LoadOptions {
    LoadOptions::default()
}

fn only(views: &[&str]) -> LoadOptions {
    LoadOptions {
        views: Some(views.iter().map(|&v| v.to_owned()).collect()),
        ..all()
    }
}

#[test]
fn a_scene_survives_the_way_through_files() {
    let (mut scene, _) = gable_scene(48);
    scene.origin = nalgebra::Vector3::new(432_100.0, 5_412_300.0, 0.0);
    let images = to_files(&scene);
    let images = images
        .iter()
        .filter(|(path, _)| path.starts_with("images/"));
    for orientation in [
        to_colmap(&scene),
        to_photogrammetric(&scene),
        to_projection(&scene),
    ] {
        let files = inputs(images.clone().cloned().chain(orientation).collect());
        let found = load_scene(&files, &all()).unwrap();
        assert_eq!(found.origin, scene.origin);
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        for (a, b) in found.views.iter().zip(&scene.views) {
            assert_eq!((&a.name, &a.rgb, &a.gray), (&b.name, &b.rgb, &b.gray));
            assert!((a.camera.center - b.camera.center).norm() < 1e-4);
            assert!((a.camera.k - b.camera.k).norm() < 1e-2);
            assert!((a.camera.r - b.camera.r).norm() < 1e-8);
        }
    }
}

#[test]
fn images_and_orientations_without_each_other() {
    let mut files = gable_files();
    edit(&mut files, "colmap/images.txt", "s2_01.png", "other.png");
    // Five are left: the sixth is named, by run and page alike.
    let scene = load_scene(&files, &all()).unwrap();
    assert_eq!(scene.views.len(), 5);
    let named = "images without an orientation in COLMAP text model: colmap/cameras.txt + colmap/images.txt, left out: \
                 images/s2_01.png";
    assert!(
        scene.warnings.iter().any(|w| w == named),
        "{:?}",
        scene.warnings
    );
    assert_eq!(inspect_files(&files, &all()).warnings, scene.warnings);
    refused(
        &files,
        &only(&["s1_01", "s1_02", "s2_01"]),
        &[
            "2 images have an orientation in COLMAP",
            "none for images/s2_01.png",
            "it names",
            "other.png",
        ],
    );
    // Left out by the choice of views, it does not matter.
    let names = ["s1_01", "s1_02.png", "S1_03"];
    let scene = load_scene(&files, &only(&names)).unwrap();
    assert_eq!(scene.views.len(), 3);
    // An orientation without an image is ignored and named.
    files.retain(|f| f.path != "images/s2_01.png");
    let scene = load_scene(&files, &all()).unwrap();
    assert!(scene.warnings.iter().any(|w| w.contains("other.png")));
    files.retain(|f| !f.path.starts_with("colmap/images"));
    refused(
        &files,
        &all(),
        &["no orientation was found: colmap/cameras.txt has no COLMAP image list"],
    );
    files.retain(|f| !f.path.starts_with("images/"));
    refused(&files, &all(), &["the one file that was given is no image"]);
}

#[test]
fn names_that_are_not_unique() {
    let mut files = gable_files();
    let copy = find(&mut files, "images/s1_02.png").bytes.clone();
    files.push(InputFile::new("more\\S1_02.tif", copy.clone()));
    let scene = load_scene(&files, &all()).unwrap();
    assert_eq!(scene.views[1].name, "s1_02.png", "the name that is stated");
    let named = "more/S1_02.tif (images/s1_02.png was taken)";
    assert!(scene.warnings[0].ends_with(named), "{:?}", scene.warnings);
    files.push(InputFile::new("again\\s1_02.png", copy));
    find(&mut files, "images/s1_02.png").path = "first/s1_02.png".to_owned();
    refused(
        &files,
        &all(),
        &[
            "again/s1_02.png and first/s1_02.png have the same name",
            "colmap/images.txt, line 5",
        ],
    );
    let mut files = gable_files();
    edit(&mut files, "colmap/images.txt", "s2_01.png", "s1_01.png");
    refused(
        &files,
        &all(),
        &["images/s1_01.png: two orientations", "line 3", "line 9"],
    );
    refused(
        &gable_files(),
        &only(&["s1_01", "s9"]),
        &["no image called s9", "s2_03.png"],
    );
}

#[test]
fn fewer_than_three_views() {
    let two = only(&["s1_01", "s2_02"]);
    refused(
        &gable_files(),
        &two,
        &[
            "2 oriented views",
            "s1_01.png, s2_02.png",
            "three are needed",
        ],
    );
}

#[test]
fn a_truncated_image() {
    let mut files = gable_files();
    find(&mut files, "images/s1_03.png").bytes.truncate(1500);
    refused(
        &files,
        &all(),
        &[
            "images/s1_03.png: the image cannot be read",
            "save it as JPEG",
        ],
    );
    find(&mut files, "images/s1_03.png").bytes.clear();
    refused(
        &files,
        &all(),
        &["images/s1_03.png: the image cannot be read"],
    );
}

#[test]
fn an_image_of_another_size() {
    let mut files = gable_files();
    edit(
        &mut files,
        "colmap/cameras.txt",
        "3 PINHOLE 48 48",
        "3 PINHOLE 96 80",
    );
    refused(
        &files,
        &all(),
        &[
            "images/s1_03.png",
            "48 x 48",
            "96 x 80",
            "colmap/images.txt, line 7",
        ],
    );
}

#[test]
fn cameras_that_are_none() {
    let mut files = gable_files();
    edit(
        &mut files,
        "colmap/cameras.txt",
        "1 PINHOLE 48 48 15294",
        "1 PINHOLE 48 48 NaN",
    );
    refused(
        &files,
        &all(),
        &["colmap/cameras.txt, line 2", "\"NaN\"", "finite number"],
    );
    let (scene, _) = gable_scene(48);
    let mut files = inputs(
        to_files(&scene)
            .into_iter()
            .chain(to_projection(&scene))
            .collect(),
    );
    files.retain(|f| !f.path.starts_with("colmap"));
    find(&mut files, "projection/s1_02.P").bytes = b"1 0 0 0\n0 1 0 0\n1 1 0 5\n".to_vec();
    refused(&files, &all(), &["projection/s1_02.P", "singular"]);
}

#[test]
fn cameras_in_the_wrong_place() {
    let ground = |z| LoadOptions {
        ground_z: Some(z),
        ..all()
    };
    refused(
        &gable_files(),
        &ground(1500.0),
        &["s1_01.png", "below the ground (1500.0 m)"],
    );
    refused(
        &gable_files(),
        &ground(700.0),
        &["do not overlap", "height 700.0 m"],
    );
    assert_eq!(
        load_scene(&gable_files(), &ground(1.5)).unwrap().ground_z,
        Some(1.5)
    );

    // Image y up instead of down: the second row of P changes its sign.
    let (mut scene, _) = gable_scene(48);
    for view in &mut scene.views {
        let flip = nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, -1.0, -1.0));
        view.camera.r = flip * view.camera.r;
    }
    refused(&inputs(to_files(&scene)), &all(), &["looks up", "angles"]);
    // Geocentric coordinates: millions of metres high.
    let (mut scene, _) = gable_scene(48);
    scene.origin.z = 4.5e6;
    refused(&inputs(to_files(&scene)), &all(), &["high", "geocentric"]);
}

#[test]
fn views_that_see_different_places() {
    // Two strips a kilometre apart, two views each: nowhere do three meet.
    let (mut scene, _) = gable_scene(48);
    scene.views.truncate(4);
    for view in &mut scene.views[2..] {
        view.camera.center.y += 2000.0;
    }
    refused(&inputs(to_files(&scene)), &all(), &["do not overlap"]);
    // One stray view is a warning.
    let (mut scene, _) = gable_scene(48);
    scene.views[4].camera.center.y += 2000.0;
    let found = load_scene(&inputs(to_files(&scene)), &all()).unwrap();
    assert!(
        found
            .warnings
            .iter()
            .any(|w| w.contains("images/s2_02.png")),
        "{:?}",
        found.warnings
    );
}

#[test]
fn a_region_of_interest_cuts_images_and_keeps_projections() {
    let (scene, truth) = gable_scene(400);
    let files = inputs(to_files(&scene));
    let options = |roi| LoadOptions {
        roi: Some(roi),
        ground_z: Some(truth.ground_z),
        ..all()
    };
    let cut = load_scene(&files, &options([-1.0, -1.0, 1.0, 1.0])).unwrap();
    for (part, whole) in cut.views.iter().zip(&scene.views) {
        assert!(part.camera.width * part.camera.height < 400 * 400 * 3 / 4);
        let ridge = nalgebra::Point3::new(0.0, 0.0, 9.375);
        let (p, q) = (
            part.camera.project(&ridge).unwrap(),
            whole.camera.project(&ridge).unwrap(),
        );
        assert!(part.camera.contains(&p, 20.0));
        let gray = |v: &View, p: Point2<f64>| v.gray.sample(p.x as f32, p.y as f32).unwrap();
        assert!(
            (gray(part, p) - gray(whole, q)).abs() < 1e-4,
            "the same pixels"
        );
    }
    refused(
        &files,
        &options([500.0, 0.0, 510.0, 10.0]),
        &["region of interest", "0 views"],
    );
    refused(
        &files,
        &options([5.0, 0.0, 1.0, 10.0]),
        &["region of interest", "is empty"],
    );
}

#[test]
fn of_many_views_of_a_region_the_most_telling_ones_are_read() {
    let (scene, truth) = gable_scene(400);
    let files = inputs(to_files(&scene));
    let loaded = |max_views, ground_z| {
        let options = LoadOptions {
            roi: Some([-1.0, -1.0, 1.0, 1.0]),
            ground_z,
            max_views,
            ..all()
        };
        load_scene(&files, &options).unwrap()
    };
    let said = |scene: &Scene| scene.warnings.join(" ").contains("that say most");
    let given = Some(truth.ground_z);
    let (whole, chosen, measured) = (
        loaded(None, given),
        loaded(Some(4), given),
        loaded(Some(4), None),
    );
    assert_eq!(
        [&whole, &chosen, &measured].map(|s| s.views.len()),
        [6, 4, 4]
    );
    assert_eq!([&whole, &chosen, &measured].map(said), [false, true, true]);
    // One strip alone would leave the other direction undetermined.
    let spread = |axis: usize| {
        let along: Vec<f64> = chosen.views.iter().map(|v| v.camera.center[axis]).collect();
        along.iter().fold(f64::MIN, |a, b| a.max(*b))
            - along.iter().fold(f64::MAX, |a, b| a.min(*b))
    };
    assert!(
        spread(0) > 10.0 && spread(1) > 10.0,
        "{} {}",
        spread(0),
        spread(1)
    );
    // Where nobody states the height of the ground, the photographs show it.
    let pixels = |scene: &Scene| -> u32 {
        let views = scene.views.iter().map(|v| v.camera.width * v.camera.height);
        views.sum()
    };
    let (exact, found) = (pixels(&chosen), pixels(&measured));
    assert!(found < exact * 3 / 2, "{found} {exact}");
}

/// The photograph that a lens takes where the pinhole takes `ideal`: found by iteration, the other
/// way round than the loader.
fn distorted(view: &View, lens: &Distortion) -> image::RgbImage {
    let k = &view.camera.k;
    image::RgbImage::from_fn(view.camera.width, view.camera.height, |column, row| {
        let seen = Point2::new(
            (f64::from(column) + 0.5 - k[(0, 2)]) / k[(0, 0)],
            (f64::from(row) + 0.5 - k[(1, 2)]) / k[(1, 1)],
        );
        let mut ideal = seen;
        for _ in 0..10 {
            ideal += seen - lens.distort(&ideal);
        }
        let (x, y) = (
            ideal.x * k[(0, 0)] + k[(0, 2)],
            ideal.y * k[(1, 1)] + k[(1, 2)],
        );
        let gray = view.gray.sample(x as f32, y as f32).unwrap_or(0.0);
        image::Rgb([(gray * 255.0).round() as u8; 3])
    })
}

#[test]
fn a_distorting_lens_is_removed() {
    let (mut scene, _) = gable_scene(160);
    let original = scene.clone();
    let lens = Distortion::brown([-0.02, 0.001], [1e-4, -2e-4]).unwrap();
    for view in &mut scene.views {
        view.rgb = distorted(view, &lens);
    }
    let difference = |scene: &Scene| {
        let (a, b) = (&scene.views[0].gray, &original.views[0].gray);
        let inner = (30..130).flat_map(|y| (30..130).map(move |x| (x, y)));
        inner
            .map(|(x, y)| (a.get(x, y) - b.get(x, y)).abs())
            .sum::<f32>()
            / 1e4
    };
    let mut files = inputs(to_files(&scene));
    let before = difference(&load_scene(&files, &all()).unwrap());
    let cameras = find(&mut files, "colmap/cameras.txt");
    let lines = cameras.text().replace(" PINHOLE", " OPENCV");
    let lines = lines.lines().map(|line| match line.starts_with('#') {
        true => format!("{line}\n"),
        false => format!("{line} -0.02 0.001 1e-4 -2e-4\n"),
    });
    cameras.bytes = lines.collect::<String>().into_bytes();
    let after = difference(&load_scene(&files, &all()).unwrap());
    assert!(after < 0.006 && after < before / 3.0, "{before} {after}");
    edit(&mut files, "colmap/cameras.txt", "-0.02 0.001", "-80 0.001");
    refused(&files, &all(), &["s1_01.png: the lens distortion", "folds"]);
}

#[test]
fn a_part_of_a_large_frame_has_the_pixels_of_the_whole() {
    let (mut scene, truth) = gable_scene(400);
    let lens = Distortion::brown([-0.02, 0.001], [1e-4, -2e-4]).unwrap();
    for view in &mut scene.views {
        view.rgb = distorted(view, &lens);
    }
    let mut files = inputs(to_files(&scene));
    for file in files.iter_mut().filter(|f| f.path.ends_with(".png")) {
        let image = image::load_from_memory(&file.bytes).unwrap();
        let mut bytes = std::io::Cursor::new(Vec::new());
        image
            .write_to(&mut bytes, image::ImageFormat::Tiff)
            .unwrap();
        file.bytes = bytes.into_inner();
    }
    let cameras = find(&mut files, "colmap/cameras.txt");
    let lines = cameras.text().replace(" PINHOLE", " OPENCV");
    let lines = lines.lines().map(|line| match line.starts_with('#') {
        true => format!("{line}\n"),
        false => format!("{line} -0.02 0.001 1e-4 -2e-4\n"),
    });
    cameras.bytes = lines.collect::<String>().into_bytes();
    let ground = LoadOptions {
        ground_z: Some(truth.ground_z),
        ..all()
    };
    let whole = load_scene(&files, &ground).unwrap();
    let roi = LoadOptions {
        roi: Some([-2.0, -1.0, 1.0, 1.0]),
        ..ground
    };
    let cut = load_scene(&files, &roi).unwrap();
    let mut moved = 0;
    for (part, whole) in cut.views.iter().zip(&whole.views) {
        let offset = [0, 1].map(|i| (whole.camera.k[(i, 2)] - part.camera.k[(i, 2)]) as u32);
        assert!(part.camera.width * part.camera.height < 400 * 400);
        moved += offset[0] + offset[1];
        for (x, y, pixel) in part.rgb.enumerate_pixels() {
            let expected = whole.rgb.get_pixel(x + offset[0], y + offset[1]);
            assert!(
                pixel
                    .0
                    .iter()
                    .zip(expected.0)
                    .all(|(a, b)| a.abs_diff(b) <= 1)
            );
        }
    }
    assert!(moved > 0);
    // Less is needed for a part, and the figure says so.
    let peak = |options: &LoadOptions| inspect_files(&files, options).peak_mb;
    assert!(peak(&roi) < peak(&all()) && peak(&all()) > 40);
}

#[test]
fn a_region_behind_tilted_views_is_not_shown_by_them() {
    let (mut scene, truth) = gable_scene(48);
    // The cameras fly south of the house and look north, down by 40 degrees.
    let tilt = crate::base::geometry::rotation_from_axis_angle(&nalgebra::Vector3::new(
        50f64.to_radians(),
        0.0,
        0.0,
    ));
    for view in &mut scene.views {
        view.camera.center = tilt * view.camera.center;
        view.camera.r *= tilt.inverse().matrix();
    }
    let files = inputs(to_files(&scene));
    let options = |roi| LoadOptions {
        roi: Some(roi),
        ground_z: Some(truth.ground_z),
        ..all()
    };
    assert_eq!(
        load_scene(&files, &options([-20.0, -20.0, 20.0, 20.0]))
            .unwrap()
            .views
            .len(),
        6
    );
    // Beside it, below the cameras, behind them, and near the horizon.
    for (x, y) in [
        (100.0, 0.0),
        (0.0, -1000.0),
        (0.0, -5000.0),
        (0.0, 20_000.0),
    ] {
        let elsewhere = [x - 20.0, y - 20.0, x + 20.0, y + 20.0];
        refused(
            &files,
            &options(elsewhere),
            &["seen by 0 views", "three are needed"],
        );
    }
}

#[test]
fn a_geocentric_scene_stands_on_the_ground() {
    let (mut scene, truth) = gable_scene(48);
    // East, north, up at 8.412 E, 49.013 N in geocentric coordinates, and that place itself.
    let (lon, lat) = (8.412f64.to_radians(), 49.013f64.to_radians());
    let ((sl, cl), (sp, cp)) = (
        crate::base::math::sin_cos(lon),
        crate::base::math::sin_cos(lat),
    );
    let axes = nalgebra::Matrix3::new(-sl, cl, 0.0, -sp * cl, -sp * sl, cp, cp * cl, cp * sl, sp);
    let n = 6_378_137.0 / (1.0 - 6.694_379_990_141_316e-3 * sp * sp).sqrt();
    let zero = nalgebra::Vector3::new(
        n * cp * cl,
        n * cp * sl,
        n * (1.0 - 6.694_379_990_141_316e-3) * sp,
    );
    let planted = scene.clone();
    for view in &mut scene.views {
        view.camera.center = (axes.transpose() * view.camera.center.coords + zero).into();
        view.camera.r *= axes;
    }
    let mut files = inputs(to_files(&planted));
    files.retain(|f| !f.path.starts_with("colmap"));
    files.extend(inputs(crate::orienting::synthetic::to_colmap(&scene)));
    let found = load_scene(&files, &all()).unwrap();
    assert!(
        found.warnings[0].contains("8.412 degrees of longitude"),
        "{:?}",
        found.warnings
    );
    let anchor = found.survey.anchor.unwrap();
    assert_eq!(
        (anchor.lon_deg, anchor.lat_deg, found.survey.epsg),
        (8.412, 49.013, None)
    );
    for (a, b) in found.views.iter().zip(&planted.views) {
        for corner in truth.facets.iter().flat_map(|(_, ring)| ring) {
            let (p, q) = (
                a.camera.project(corner).unwrap(),
                b.camera.project(corner).unwrap(),
            );
            assert!((p - q).norm() < 0.01, "{p} {q}");
        }
    }
}

#[test]
fn the_reference_system_is_that_of_the_files_or_the_one_asked_for() {
    let mut files = gable_files();
    let epsg = |files: &[InputFile], options: &LoadOptions| {
        load_scene(files, options).unwrap().survey.epsg
    };
    assert_eq!(epsg(&files, &all()), None);
    files.push(InputFile::new(
        "gable_wkt.prj",
        br#"PROJCS["x",AUTHORITY["EPSG","31467"]]"#.to_vec(),
    ));
    assert_eq!(epsg(&files, &all()), Some(31467));
    let asked = LoadOptions {
        epsg: Some(25832),
        ..all()
    };
    assert_eq!(epsg(&files, &asked), Some(25832));
}
