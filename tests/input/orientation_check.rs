//! Orientations with the usual errors: the check names the error, and leaves correct scenes alone.

use std::fmt::Write;

use nalgebra::{Matrix3, Vector3};
use ridgeline::base::agreement::Finding;
use ridgeline::base::execution::progress::silent;
use ridgeline::base::params::Params;
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene::Scene;
use ridgeline::orienting::scene_loader::{LoadOptions, load_scene};
use ridgeline::orienting::synthetic::{
    gable_scene, l_scene, to_colmap, to_files, to_photogrammetric, to_projection,
};
use ridgeline::pipeline::{Run, Stage};

type Files = Vec<(String, Vec<u8>)>;

/// The images of the scene with this orientation, loaded.
fn load(scene: &Scene, orientation: Files) -> ridgeline::Result<Scene> {
    load_with(scene, orientation, &LoadOptions::default())
}

fn load_with(scene: &Scene, orientation: Files, options: &LoadOptions) -> ridgeline::Result<Scene> {
    let images = to_files(scene)
        .into_iter()
        .filter(|(path, _)| path.starts_with("images/"));
    let files: Vec<InputFile> = images
        .chain(orientation)
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect();
    load_scene(&files, options)
}

/// What loading has to say: a refusal or warnings.
fn words(scene: &Scene, orientation: Files) -> String {
    match load(scene, orientation) {
        Ok(scene) => scene.warnings.join("\n"),
        Err(error) => error.to_string(),
    }
}

/// The photogrammetric list with its angles changed, under the name of a unit.
fn list(scene: &Scene, unit: &str, angles: impl Fn([f64; 3]) -> [f64; 3]) -> Files {
    let mut files = to_photogrammetric(scene);
    let text = String::from_utf8(files[1].1.clone()).unwrap();
    let mut changed = format!("# angles in {unit}\n");
    for line in text.lines().filter(|l| !l.starts_with('#')) {
        let f: Vec<&str> = line.split(' ').collect();
        let a = angles([4, 5, 6].map(|i| f[i].parse().unwrap()));
        writeln!(changed, "{} {} {} {}", f[..4].join(" "), a[0], a[1], a[2]).unwrap();
    }
    files[1].1 = changed.into_bytes();
    files
}

/// The photogrammetric list with changed crop offsets (column, row).
fn crops(scene: &Scene, change: impl Fn([f64; 2]) -> [f64; 2]) -> Files {
    let mut files = to_photogrammetric(scene);
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    let line = |line: &str| {
        let f: Vec<&str> = line.split(' ').collect();
        if f[0] != "crop" {
            return format!("{line}\n");
        }
        let [column, row] = change([2, 3].map(|i| f[i].parse().unwrap()));
        format!("crop {} {column} {row} {} {}\n", f[1], f[4], f[5])
    };
    files[0].1 = text.lines().map(line).collect::<String>().into_bytes();
    files
}

/// The COLMAP model of the scene with changed cameras.
fn colmap(scene: &Scene, change: impl Fn(&mut Scene)) -> Files {
    let mut changed = scene.clone();
    change(&mut changed);
    to_colmap(&changed)
}

/// A way to break an orientation, and a word of what it is called.
type Broken = (&'static str, Files, &'static str);

fn broken(scene: &Scene) -> Vec<Broken> {
    let each = |change: &dyn Fn(&mut ridgeline::photographs::camera::Camera)| {
        colmap(scene, |s| {
            s.views.iter_mut().for_each(|v| change(&mut v.camera));
        })
    };
    let order = |order: &[usize]| {
        colmap(scene, |s| {
            for (view, &from) in s.views.iter_mut().zip(order) {
                view.camera = scene.views[from].camera.clone();
            }
        })
    };
    let up = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    let half = {
        let mut shifted = scene.clone();
        for view in &mut shifted.views {
            view.camera.k[(0, 2)] += 0.5;
            view.camera.k[(1, 2)] += 0.5;
        }
        to_projection(&shifted)
    };
    let size = f64::from(scene.views[0].camera.height);
    vec![
        (
            "gon called degrees",
            list(scene, "degrees", |a| a.map(|a| a / 0.9)),
            "kappa in gon",
        ),
        (
            "degrees called gon",
            list(scene, "gon", |a| a),
            "kappa in degrees",
        ),
        (
            "radians called degrees",
            list(scene, "degrees", |a| a.map(f64::to_radians)),
            "kappa in radians",
        ),
        (
            "phi first",
            list(scene, "degrees", |[o, p, k]| [p, o, k]),
            "phi, omega, kappa",
        ),
        (
            "kappa first",
            list(scene, "degrees", |[o, p, k]| [k, p, o]),
            "kappa, phi, omega",
        ),
        (
            "rows from the bottom",
            crops(scene, |[c, r]| [c, 9000.0 - r - size]),
            "from the bottom of the frame",
        ),
        (
            "column and row exchanged",
            crops(scene, |[c, r]| [r, c]),
            "exchanged",
        ),
        (
            "transposed rotation",
            each(&|c| c.r = c.r.transpose()),
            "transposed",
        ),
        (
            "inverse pose",
            each(&|c| {
                c.center = (-(c.r * c.center.coords)).into();
                c.r = c.r.transpose();
            }),
            "inverted",
        ),
        ("camera y up", each(&|c| c.r = up * c.r), "y axis runs up"),
        (
            "principal point from the bottom",
            each(&|c| c.k[(1, 2)] = size - c.k[(1, 2)]),
            "y up",
        ),
        (
            "focal length in millimetres",
            each(&|c| (c.k[(0, 0)], c.k[(1, 1)]) = (c.k[(0, 0)] * 0.012, c.k[(1, 1)] * 0.012)),
            "not in pixels",
        ),
        ("corner taken for centre", half, "half a pixel"),
        ("reverse order", order(&[5, 4, 3, 2, 1, 0]), "reverse order"),
        ("displaced by one", order(&[1, 2, 3, 4, 5, 0]), "displaced"),
        (
            "two exchanged",
            order(&[0, 4, 2, 3, 1, 5]),
            "s1_02.png and s2_02.png have each other",
        ),
    ]
}

#[test]
fn broken_orientations_are_named() {
    // All mistakes on one scene, some on another.
    for (scene, every) in [(gable_scene(320).0, 1), (l_scene(320).0, 6)] {
        let mut unnamed = Vec::new();
        for (what, orientation, name) in broken(&scene).into_iter().step_by(every) {
            let said = words(&scene, orientation);
            if !said.contains(name) {
                unnamed.push(format!("{what}: {said}"));
            }
        }
        assert!(unnamed.is_empty(), "{}", unnamed.join("\n"));
    }
}

/// The scene with these views only.
fn some_views(scene: &Scene, views: &[usize]) -> Scene {
    let mut some = scene.clone();
    some.views = views.iter().map(|&i| scene.views[i].clone()).collect();
    some
}

/// What is said of the scene with these two of its views exchanged, and what names them.
fn exchanged(scene: &Scene, [a, b]: [usize; 2]) -> (String, String) {
    let broken = colmap(scene, |s| {
        s.views[a].camera = scene.views[b].camera.clone();
        s.views[b].camera = scene.views[a].camera.clone();
    });
    let name = |i: usize| &scene.views[i].name;
    let expected = format!("{} and {} have each other's", name(a), name(b));
    (words(scene, broken), expected)
}

#[test]
fn two_exchanged_views_are_named_among_few_and_small_ones() {
    let all: &[usize] = &[0, 1, 2, 3, 4, 5];
    let of_four: &[usize] = &[1, 2, 4, 5];
    let mut unnamed = Vec::new();
    for (scene, views, pair) in [
        (gable_scene(320).0, all, [0, 1]),
        (gable_scene(256).0, all, [1, 4]),
        (gable_scene(320).0, of_four, [1, 2]),
    ] {
        let (said, expected) = exchanged(&some_views(&scene, views), pair);
        if !said.contains(&expected) {
            unnamed.push(format!("{expected}: {said}"));
        }
    }
    assert!(unnamed.is_empty(), "{}", unnamed.join("\n"));
    // Views at a like place of two strips may agree by half: that is called a shift.
    let (said, _) = exchanged(&some_views(&l_scene(480).0, of_four), [0, 3]);
    assert!(!said.is_empty());
}

#[test]
fn a_view_that_agrees_with_none_is_named_where_the_others_agree() {
    let scene = some_views(&gable_scene(320).0, &[0, 1, 2, 3]);
    let turned = colmap(&scene, |s| {
        let (sine, cosine) = libm::sincos(0.1_f64.to_radians());
        let camera = &mut s.views[2].camera;
        camera.r = Matrix3::new(1.0, 0.0, 0.0, 0.0, cosine, -sine, 0.0, sine, cosine) * camera.r;
    });
    let said = words(&scene, turned);
    assert!(
        said.contains("none of the others") && said.contains("s1_03.png"),
        "{said}"
    );
}

#[test]
fn a_refusal_says_what_was_tried() {
    let (scene, _) = gable_scene(320);
    let (what, orientation, name) = broken(&scene).into_iter().next().unwrap();
    let refusal = load(&scene, orientation).unwrap_err();
    assert_eq!(refusal.code(), "contradiction");
    let ridgeline::Error::Contradiction { report, .. } = refusal else {
        panic!("{what}: {refusal}");
    };
    assert_eq!(report.finding, Finding::Explained);
    let best = &report.tested[0];
    assert!(best.hypothesis.contains(name) && best.all_pairs, "{best:?}");
    assert_eq!(Some(best.agreement), report.corrected);
    assert!(best.agreement.score > report.stated.score);
    assert!(report.tested.len() > 4);

    let sound = load(&scene, to_colmap(&scene))
        .unwrap()
        .survey
        .agreement
        .unwrap();
    assert_eq!(sound.finding, Finding::Sound);
    assert!(sound.tested.is_empty() && sound.error.is_none());
}

#[test]
fn sound_orientations_are_left_alone() {
    for (scene, _) in [
        gable_scene(200),
        gable_scene(320),
        l_scene(320),
        l_scene(480),
    ] {
        for orientation in [
            to_colmap(&scene),
            to_photogrammetric(&scene),
            to_projection(&scene),
        ] {
            assert_eq!(words(&scene, orientation), "");
        }
    }
}

#[test]
fn a_world_that_lies_on_its_side_is_told_from_broken_cameras() {
    let (scene, _) = gable_scene(320);
    let y_up = Matrix3::new(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0);
    let turned = colmap(&scene, |s| {
        for view in &mut s.views {
            view.camera.center = y_up * view.camera.center;
            view.camera.r *= y_up.transpose();
        }
    });
    let said = words(&scene, turned);
    assert!(
        said.contains("it is the world") && said.contains("Z up"),
        "{said}"
    );
}

#[test]
fn images_without_texture_say_nothing() {
    let (mut scene, _) = gable_scene(200);
    for view in &mut scene.views {
        view.rgb.fill(90);
    }
    assert_eq!(words(&scene, to_colmap(&scene)), "");
}

/// Largest distance between the places where the cameras of two scenes put points of the roof,
/// pixels.
fn difference_px(found: &Scene, planted: &Scene, corners: &[nalgebra::Point3<f64>]) -> f64 {
    let views = found.views.iter().zip(&planted.views);
    let distances = views.flat_map(|(a, b)| {
        corners.iter().map(move |corner| {
            let (p, q) = (corner - found.origin, corner - planted.origin);
            (a.camera.project(&p).unwrap() - b.camera.project(&q).unwrap()).norm()
        })
    });
    distances.fold(0.0, f64::max)
}

#[test]
fn what_is_named_is_corrected_when_asked_for() {
    let (scene, truth) = gable_scene(320);
    let corners: Vec<_> = truth
        .facets
        .iter()
        .flat_map(|(_, ring)| ring.clone())
        .collect();
    let fix = LoadOptions {
        apply_fix: true,
        ..LoadOptions::default()
    };
    let mut left = Vec::new();
    for (what, orientation, _) in broken(&scene).into_iter().step_by(3) {
        match load_with(&scene, orientation, &fix) {
            Ok(found) => {
                let words = found.warnings.join("; ");
                let error = difference_px(&found, &scene, &corners);
                // A focal length is found to a percent: 600 pixels of principal point away it moves
                // by some.
                let bound = if what.contains("millimetres") {
                    20.0
                } else {
                    0.01
                };
                if !words.contains("was corrected") || error > bound {
                    left.push(format!("{what}: {error} px, {words}"));
                }
            }
            Err(error) => left.push(format!("{what}: {error}")),
        }
    }
    assert!(left.is_empty(), "{}", left.join("\n"));
    // A region of interest is cut after the correction: the wrong cameras see it elsewhere.
    let gon = list(&scene, "degrees", |a| a.map(|a| a / 0.9));
    let roi = LoadOptions {
        roi: Some([-2.0, -2.0, 2.0, 2.0]),
        ground_z: Some(truth.ground_z),
        ..fix
    };
    let cut = load_with(&scene, gon, &roi).unwrap();
    assert!(
        cut.views
            .iter()
            .all(|v| v.camera.width < 320 && v.rgb.width() == v.camera.width)
    );
}

#[test]
fn a_shifted_view_is_measured_and_shifted_back() {
    for (scene, _) in [gable_scene(320), l_scene(320)] {
        for (view, planted) in [(0, [0.5, 0.0]), (4, [0.0, -0.5]), (2, [0.4, 0.3])] {
            let shifted = || {
                colmap(&scene, |s| {
                    s.views[view].camera.k[(0, 2)] += planted[0];
                    s.views[view].camera.k[(1, 2)] += planted[1];
                })
            };
            let found = load(&scene, shifted()).unwrap();
            for (i, shift) in found.survey.shifts.iter().enumerate() {
                let expected = if i == view {
                    planted.map(|p| -p)
                } else {
                    [0.0; 2]
                };
                for (found, expected) in shift.shift_px.iter().zip(expected) {
                    assert!(
                        (found - expected).abs() < 0.1,
                        "view {i} of {view}, {planted:?}: {shift:?}"
                    );
                }
            }
            assert!(
                found.warnings[0].contains(&scene.views[view].name),
                "{:?}",
                found.warnings
            );
            let run = Run::new(found, Params::default());
            for (a, b) in run.scene().views.iter().zip(&scene.views) {
                assert!(
                    (a.camera.k - b.camera.k).amax() < 0.1,
                    "{} {}",
                    a.name,
                    a.camera.k
                );
            }
        }
    }
}

/// A small error of a view, in words, and the camera with it.
type SmallError = (
    &'static str,
    fn(&mut ridgeline::photographs::camera::Camera),
);

/// A turn of 0.005 degrees about the camera's own x axis (1.4 px), a move of 0.1 m, a shift of 1.5
/// px: what images of 320 pixels allow.
const SMALL_ERRORS: [SmallError; 3] = [
    ("turned", |c| {
        let (s, cos) = libm::sincos(0.005_f64.to_radians());
        c.r = Matrix3::new(1.0, 0.0, 0.0, 0.0, cos, -s, 0.0, s, cos) * c.r;
    }),
    ("moved", |c| c.center.x += 0.1),
    ("shifted", |c| c.k[(0, 2)] += 1.5),
];

#[test]
fn small_errors_of_a_view_are_found_and_the_model_comes_back() {
    let (scene, truth) = l_scene(320);
    let corners: Vec<_> = (truth.facets.iter())
        .flat_map(|(_, ring)| ring.clone())
        .collect();
    let adjusted = |orientation: Files| {
        let files: Vec<InputFile> = (to_files(&scene).into_iter())
            .filter(|(path, _)| path.starts_with("images/"))
            .chain(orientation)
            .map(|(path, bytes)| InputFile::new(&path, bytes))
            .collect();
        let scene = load_scene(&files, &LoadOptions::default()).unwrap();
        let mut run = Run::new(scene, Params::default());
        let summary = run.step(Stage::Adjustment, &silent());
        (run, summary)
    };
    // What is sound stays as it is.
    let (sound, summary) = adjusted(to_colmap(&scene));
    assert!(difference_px(sound.scene(), &scene, &corners) < 1e-6);
    assert!(summary.warnings.is_empty() && summary.counts == [("adjusted views", 0)]);
    for (what, error) in SMALL_ERRORS {
        let broken = || colmap(&scene, |s| error(&mut s.views[3].camera));
        let before = difference_px(&load(&scene, broken()).unwrap(), &scene, &corners);
        let (mut run, summary) = adjusted(broken());
        let after = difference_px(run.scene(), &scene, &corners);
        assert!(
            after < 0.3 * before && after < 0.35,
            "{what}: {before} px, {after} px, {summary:?}"
        );
        assert!(summary.warnings[0].contains("s2_01"), "{summary:?}");
        assert!(summary.counts == [("adjusted views", 1)], "{summary:?}");
        run.run_all();
        let model = run.results().roof_model().unwrap();
        assert_eq!((what, model.buildings.len()), (what, 1));
        assert!(
            model.facets.len() >= 4,
            "{what}: {} facets",
            model.facets.len()
        );
    }
}

#[test]
fn adjusting_leaves_sound_scenes_as_they_are() {
    for (scene, _) in [gable_scene(320), l_scene(480)] {
        let fix = LoadOptions {
            apply_fix: true,
            ..LoadOptions::default()
        };
        let found = load_with(&scene, to_colmap(&scene), &fix).unwrap();
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        assert_eq!(found.survey.shifts.len(), 6);
        let run = Run::new(found, Params::default());
        for (a, b) in run.scene().views.iter().zip(&scene.views) {
            assert!((a.camera.k - b.camera.k).amax() < 1e-9);
        }
    }
}

#[test]
fn renamed_images_are_taken_in_their_order_if_they_agree() {
    let scene = gable_scene(320).0;
    let load = |numbers: [usize; 6], ignore_check| {
        let mut files = to_files(&scene);
        let images = files.iter_mut().filter(|f| f.0.starts_with("images/"));
        for (file, number) in images.zip(numbers) {
            file.0 = format!("images/IMG_{number}.png");
        }
        let files = files.iter();
        let files: Vec<InputFile> = files
            .map(|(path, bytes)| InputFile::new(path, bytes.clone()))
            .collect();
        let options = LoadOptions {
            ignore_check,
            ..LoadOptions::default()
        };
        load_scene(&files, &options)
    };
    let found = load([1, 2, 3, 4, 5, 6], false).unwrap();
    let cameras = |scene: &Scene| {
        scene
            .views
            .iter()
            .map(|v| v.camera.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(cameras(&found).len(), cameras(&scene).len());
    for (found, planted) in cameras(&found).iter().zip(cameras(&scene)) {
        assert!((found.center - planted.center).norm() < 1e-4);
    }
    let words = found.warnings.join("\n");
    assert!(words.contains("IMG_2.png for s1_02.png"), "{words}");
    // Two are exchanged, and all are mixed.
    for numbers in [[1, 3, 2, 4, 5, 6], [3, 5, 1, 6, 2, 4]] {
        let refusal = load(numbers, false).unwrap_err().to_string();
        assert!(refusal.contains("give the images the names"), "{refusal}");
        assert!(load(numbers, true).is_ok(), "--ignore-check");
    }
}
