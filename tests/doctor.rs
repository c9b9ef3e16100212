//! Orientations broken in the usual ways: the doctor names the mistake, and leaves sound scenes alone.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used)]

use std::fmt::Write;

use nalgebra::{Matrix3, Vector3};
use ridgeline::scene::Scene;
use ridgeline::scene_loader::{InputFile, LoadOptions, load_scene};
use ridgeline::synthetic::{
    gable_scene, l_scene, to_colmap, to_files, to_photogrammetric, to_projection,
};

type Files = Vec<(String, Vec<u8>)>;

/// The images of the scene with this orientation, loaded.
fn load(scene: &Scene, orientation: Files) -> ridgeline::Result<Scene> {
    let images = to_files(scene)
        .into_iter()
        .filter(|(path, _)| path.starts_with("images/"));
    let files: Vec<InputFile> = images
        .chain(orientation)
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect();
    load_scene(&files, &LoadOptions::default())
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
    let each = |change: &dyn Fn(&mut ridgeline::camera::Camera)| {
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
