//! The command line as a user meets it: files out for a good scene, exit code 2 and a sentence for
//! a bad one.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::common::{names_in, synthetic_files, zipped};

/// What a run writes.
const OUTPUTS: [&str; 25] = [
    "buildings.csv",
    "edges.csv",
    "edges.geojson",
    "evidence.json",
    "facets.csv",
    "facets.geojson",
    "footprints.geojson",
    "halfplanes.json",
    "lines.csv",
    "lines.json",
    "model.city.json",
    "model.city.jsonl",
    "model.dxf",
    "model.glb",
    "model.ifc",
    "model.mtl",
    "model.obj",
    "model.ply",
    "model_atlas.jpg",
    "obstructions.geojson",
    "report.json",
    "roof_report.html",
    "roofs.json",
    "segments.json",
    "tileset.json",
];

/// A scene's folder that a test may damage, with a folder for the results.
pub(crate) struct Scene(pub(crate) tempfile::TempDir);

impl Scene {
    pub(crate) fn new() -> Self {
        let scene = Self(tempfile::tempdir().unwrap());
        for (path, bytes) in synthetic_files() {
            scene.write(&path, &bytes);
        }
        scene
    }

    fn write(&self, path: &str, bytes: &[u8]) {
        let path = self.0.path().join("scene").join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    fn read(&self, path: &str) -> Vec<u8> {
        fs::read(self.0.path().join("scene").join(path)).unwrap()
    }

    /// The same images with the photogrammetric list instead, its angles changed.
    fn with_list(angles: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let scene = Self::new();
        fs::remove_dir_all(scene.0.path().join("scene/colmap")).unwrap();
        let (rendered, _) = ridgeline::orienting::synthetic::l_scene(crate::common::SIZE_PX);
        for (path, bytes) in ridgeline::orienting::synthetic::to_photogrammetric(&rendered) {
            scene.write(&path, &bytes);
        }
        let path = "photogrammetric/exterior.txt";
        let text = String::from_utf8(scene.read(path)).unwrap();
        let line = |line: &str| {
            let f: Vec<&str> = line.split(' ').collect();
            if line.starts_with('#') {
                return format!("{line}\n");
            }
            let [o, p, k] = angles([4, 5, 6].map(|i| f[i].parse().unwrap()));
            format!("{} {o} {p} {k}\n", f[..4].join(" "))
        };
        scene.write(path, text.lines().map(line).collect::<String>().as_bytes());
        scene
    }

    fn remove(&self, path: &str) {
        fs::remove_file(self.0.path().join("scene").join(path)).unwrap();
    }

    fn edit(&self, path: &str, from: &str, to: &str) {
        let text = String::from_utf8(self.read(path)).unwrap();
        assert!(text.contains(from));
        self.write(path, text.replacen(from, to, 1).as_bytes());
    }

    pub(crate) fn out(&self) -> std::path::PathBuf {
        self.0.path().join("out")
    }

    pub(crate) fn run(&self, more: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_ridgeline"))
            .arg("reconstruct")
            .arg(self.0.path().join("scene"))
            .arg("--out")
            .arg(self.out())
            .args(more)
            .output()
            .unwrap()
    }

    fn check(&self, more: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_ridgeline"))
            .arg("check")
            .arg(self.0.path().join("scene"))
            .args(more)
            .output()
            .unwrap()
    }

    /// Runs, and expects a refusal that names all of `words` and leaves no model behind.
    fn is_refused(&self, more: &[&str], words: &[&str]) {
        let output = self.run(more);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for word in words {
            assert!(message.contains(word), "'{word}' is not in: {message}");
        }
        assert!(!message.contains("panicked"), "{message}");
        // Nothing is written, not even in part.
        let written = self.out().is_dir().then(|| names_in(&self.out()));
        assert_eq!(written.unwrap_or_default(), [""; 0]);
    }
}

#[test]
fn a_good_scene_gives_all_files() {
    let scene = Scene::new();
    let output = scene.run(&["--threads", "2", "--method", "lines"]);
    let printed = crate::printed(&output);
    assert_eq!(names_in(&scene.out()), OUTPUTS);
    for word in ["segments", "halfplanes", "facets", "model.glb"] {
        assert!(printed.contains(word), "'{word}' is not in: {printed}");
    }
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(scene.out().join("report.json")).unwrap()).unwrap();
    assert!(report["seconds"]["matches"].as_f64().unwrap() > 0.0);
    let stages = report["stages"].as_array().unwrap();
    let facets = stages.iter().find_map(|s| s["counts"]["facets"].as_u64());
    assert!(facets.unwrap() >= 4);
    assert_eq!(report["params"]["sweep"]["min_similarity"], 0.4);
}

#[test]
fn archives_and_folders_stand_for_their_files() {
    let scene = Scene::new();
    let (images, others): (Vec<_>, Vec<_>) =
        (synthetic_files().into_iter()).partition(|(path, _)| path.starts_with("images/"));
    fs::remove_dir_all(scene.0.path().join("scene/images")).unwrap();
    scene.write("flight/photographs.zip", &zipped(&images));
    assert!(!others.is_empty());
    let checked = scene.check(&[]);
    let printed = String::from_utf8_lossy(&checked.stdout);
    assert!(
        printed.contains("agree:") && printed.contains("s2_03.png"),
        "{printed}"
    );
}

#[test]
fn images_without_orientation_are_left_out_until_too_few_remain() {
    let scene = Scene::new();
    scene.write("images/stray.png", &scene.read("images/s1_01.png"));
    let output = scene.run(&["--method", "lines", "--views", "s1_01,s1_02,s1_03,stray"]);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{printed}");
    assert!(
        printed.contains("3 views") && printed.contains("left out: images/stray.png"),
        "{printed}"
    );
    fs::remove_dir_all(scene.out()).unwrap();
    scene.is_refused(
        &["--views", "s1_01,s1_02,stray"],
        &["none for images/stray.png", "three are needed"],
    );
}

/// Photographs of other places under the names that the orientation states.
#[test]
fn what_hardly_agrees_is_refused_unless_asked_for() {
    let scene = Scene::new();
    let mut state = 1u32;
    let mut random = |below: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % below
    };
    for name in ["s1_01", "s1_02", "s1_03", "s2_01", "s2_02", "s2_03"] {
        let mut image = image::RgbImage::new(crate::common::SIZE_PX, crate::common::SIZE_PX);
        for _ in 0..400 {
            let (x, y) = (
                random(crate::common::SIZE_PX - 20),
                random(crate::common::SIZE_PX - 20),
            );
            let (w, h, gray) = (4 + random(16), 4 + random(16), random(256) as u8);
            for (column, row) in (0..w).flat_map(|i| (0..h).map(move |j| (i, j))) {
                image.put_pixel(x + column, y + row, image::Rgb([gray; 3]));
            }
        }
        let mut png = std::io::Cursor::new(Vec::new());
        image.write_to(&mut png, image::ImageFormat::Png).unwrap();
        scene.write(&format!("images/{name}.png"), &png.into_inner());
    }
    scene.is_refused(&[], &["hardly agree", "--ignore-check"]);
    let output = scene.run(&["--method", "lines", "--ignore-check"]);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{printed}");
    assert!(
        printed.contains("warning: the images hardly agree"),
        "{printed}"
    );
}

#[test]
fn a_truncated_jpeg_is_refused() {
    let scene = Scene::new();
    let png = image::load_from_memory(&scene.read("images/s1_02.png")).unwrap();
    let mut jpeg = std::io::Cursor::new(Vec::new());
    png.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
    let jpeg = jpeg.into_inner();
    fs::remove_file(scene.0.path().join("scene/images/s1_02.png")).unwrap();
    scene.edit("colmap/images.txt", "s1_02.png", "s1_02.jpg");
    scene.write("images/s1_02.jpg", &jpeg[..jpeg.len() / 2]);
    scene.is_refused(&[], &["s1_02.jpg"]);
}

#[test]
fn two_views_are_too_few() {
    let scene = Scene::new();
    scene.is_refused(&["--views", "s1_01,s1_02"], &["three"]);
}

#[test]
fn a_camera_that_is_not_a_number_is_refused() {
    let scene = Scene::new();
    let text = String::from_utf8(scene.read("colmap/images.txt")).unwrap();
    let line = text.lines().find(|l| l.contains("s2_02.png")).unwrap();
    let mut words: Vec<&str> = line.split(' ').collect();
    words[5] = "NaN";
    scene.edit("colmap/images.txt", line, &words.join(" "));
    scene.is_refused(&[], &["colmap/images.txt"]);
}

#[test]
fn bad_arguments_are_explained() {
    let scene = Scene::new();
    scene.is_refused(&["--method", "triangles"], &["lines", "combined"]);
    scene.is_refused(&["--roi", "5,0,1,1"], &["x0 must be less than x1"]);
    scene.is_refused(&["--ground-z", "NaN"], &["not a number"]);
    scene.is_refused(&["--views", "nothing.png"], &["nothing.png"]);
    scene.is_refused(&["--crs", "mercator"], &["EPSG:25832"]);
    scene.is_refused(
        &["--project", "no/such/folder/a.zip"],
        &["no/such/folder/a.zip", "cannot be written"],
    );
    scene.is_refused(
        &["--tile", "5", "--roi", "-10,-10,10,10"],
        &["tiles of 60 m or more"],
    );
    let params = scene.0.path().join("params.json");
    fs::write(&params, r#"{"sweep": {"min_simularity": 0.5}}"#).unwrap();
    let words = ["params.json", "min_simularity", "min_similarity"];
    scene.is_refused(&["--params", params.to_str().unwrap()], &words);
}

#[test]
fn a_folder_that_is_not_there_is_refused() {
    let nowhere = Command::new(env!("CARGO_BIN_EXE_ridgeline"))
        .args(["reconstruct", "no/such/folder", "--out"])
        .arg(tempfile::tempdir().unwrap().path())
        .output()
        .unwrap();
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&nowhere.stderr).contains("no/such/folder"));
}

#[test]
fn the_printed_parameters_are_accepted() {
    let output = Command::new(env!("CARGO_BIN_EXE_ridgeline"))
        .arg("params")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let params: ridgeline::Params = ridgeline::Params::from_json(&text).unwrap();
    assert_eq!(params, ridgeline::base::params::Params::default());
}

#[test]
fn an_orientation_without_its_image_leaves_too_few() {
    let scene = Scene::new();
    for name in ["s1_01", "s1_02", "s1_03", "s2_01"] {
        scene.remove(&format!("images/{name}.png"));
    }
    scene.is_refused(&[], &["s2_02.png, s2_03.png", "three are needed"]);
}

#[test]
fn what_is_no_image_is_refused() {
    let scene = Scene::new();
    scene.write("images/s1_02.png", b"<html>not found</html>");
    scene.is_refused(&[], &["images/s1_02.png", "neither JPEG nor PNG nor TIFF"]);
}

#[test]
fn duplicate_names_are_refused() {
    let scene = Scene::new();
    let image = scene.read("images/s1_02.png");
    scene.write("again/s1_02.png", &image);
    scene.write("more/s1_02.png", &image);
    // What lies in `images` is taken.
    assert!(scene.check(&[]).status.success());
    fs::remove_file(scene.0.path().join("scene/images/s1_02.png")).unwrap();
    scene.is_refused(&[], &["again/s1_02.png", "more/s1_02.png", "same name"]);
}

#[test]
fn an_image_of_another_size_is_refused() {
    let scene = Scene::new();
    scene.edit(
        "colmap/cameras.txt",
        "3 PINHOLE 320 320",
        "3 PINHOLE 640 480",
    );
    scene.is_refused(&[], &["images/s1_03.png", "320 x 320", "640 x 480"]);
}

#[test]
fn a_singular_camera_is_refused() {
    let scene = Scene::new();
    fs::remove_dir_all(scene.0.path().join("scene/colmap")).unwrap();
    let (rendered, _) = ridgeline::orienting::synthetic::l_scene(crate::common::SIZE_PX);
    for (path, bytes) in ridgeline::orienting::synthetic::to_projection(&rendered) {
        scene.write(&path, &bytes);
    }
    scene.write("projection/s1_02.P", b"1 0 0 0\n0 1 0 0\n1 1 0 5\n");
    scene.is_refused(&[], &["projection/s1_02.P", "singular"]);
}

#[test]
fn cameras_in_impossible_places_are_refused() {
    let scene = Scene::new();
    scene.is_refused(
        &["--ground-z", "1500"],
        &["s1_01.png", "below the ground (1500.0 m)"],
    );
    // Two strips two kilometres apart, two views each: nowhere do three meet.
    let scene = Scene::with_list(|a| a);
    let path = "photogrammetric/exterior.txt";
    let text = String::from_utf8(scene.read(path)).unwrap();
    let line = |line: &str| match line.split(' ').collect::<Vec<_>>()[..] {
        [name, x, y, z, o, p, k] if name.starts_with("s2") => {
            let y: f64 = y.parse().unwrap();
            format!("{name} {x} {} {z} {o} {p} {k}\n", y + 2000.0)
        }
        _ => format!("{line}\n"),
    };
    scene.write(path, text.lines().map(line).collect::<String>().as_bytes());
    let views = "s1_01,s1_02,s2_01,s2_02";
    scene.is_refused(&["--views", views], &["do not overlap"]);
}

#[test]
fn an_orientation_that_contradicts_the_images_is_named() {
    let named = |scene: Scene, word: &str| scene.is_refused(&[], &["contradict", word]);
    named(Scene::with_list(|[o, p, k]| [p, o, k]), "phi, omega, kappa");
    named(Scene::with_list(|a| a.map(|a| a / 0.9)), "kappa in gon");
    let scene = Scene::new();
    let (mut rendered, _) = ridgeline::orienting::synthetic::l_scene(crate::common::SIZE_PX);
    for view in &mut rendered.views {
        let size = f64::from(view.camera.height);
        view.camera.k[(1, 2)] = size - view.camera.k[(1, 2)];
    }
    for (path, bytes) in ridgeline::orienting::synthetic::to_colmap(&rendered) {
        scene.write(&path, &bytes);
    }
    named(scene, "y up");
}

#[test]
fn too_much_for_memory_is_refused_with_the_figure() {
    let scene = Scene::new();
    scene.is_refused(
        &["--memory", "30"],
        &["MB of memory, more than 30 MB", "region of interest"],
    );
}

#[test]
fn a_region_that_the_views_do_not_show_is_refused() {
    let scene = Scene::new();
    scene.is_refused(
        &["--roi", "500,-800,520,-780"],
        &["seen by 0 views", "510 m east", "-790 m north"],
    );
}

#[test]
fn a_corrected_scene_survives_the_way_through_a_project() {
    let scene = Scene::with_list(|a| a.map(|a| a / 0.9));
    let project = scene.0.path().join("house.zip");
    let output = scene.run(&[
        "--apply-fix",
        "--crs",
        "EPSG:25832",
        "--project",
        project.to_str().unwrap(),
    ]);
    let printed = crate::printed(&output);
    assert!(
        printed.contains("was corrected") && printed.contains("kappa in gon"),
        "{printed}"
    );
    assert!(printed.contains("6 views, about"), "{printed}");
    let again = scene.0.path().join("again");
    let output = Command::new(env!("CARGO_BIN_EXE_ridgeline"))
        .arg("reconstruct")
        .args([&project, Path::new("--out"), &again])
        .output()
        .unwrap();
    crate::printed(&output);
    assert_eq!(names_in(&again), OUTPUTS);
    for name in OUTPUTS.into_iter().filter(|&name| name != "report.json") {
        let read = |folder: &Path| fs::read(folder.join(name)).unwrap();
        assert!(read(&scene.out()) == read(&again), "{name} differs");
    }
    let model = fs::read_to_string(again.join("model.city.json")).unwrap();
    assert!(model.contains("https://www.opengis.net/def/crs/EPSG/0/25832"));
}

#[test]
fn a_failure_of_writing_leaves_nothing_half() {
    let scene = Scene::new();
    // A folder stands where a file is to be written.
    fs::create_dir_all(scene.out().join("model.glb/inside")).unwrap();
    let output = scene.run(&[]);
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(
        message.contains("model.glb") && message.contains("cannot write"),
        "{message}"
    );
    assert!(
        names_in(&scene.out())
            .iter()
            .all(|name| !name.contains("part"))
    );
}

#[test]
fn a_refusal_says_what_was_seen() {
    let scene = Scene::new();
    for (path, _) in synthetic_files() {
        if path.starts_with("images/") {
            scene.remove(&path);
        }
    }
    scene.write("images/plan.pdf", b"%PDF");
    scene.is_refused(&[], &["no image", "scene holds 2 text; not read: 1 PDF"]);
}

#[cfg(unix)]
#[test]
fn linked_folders_belong_to_the_scene() {
    use std::os::unix::fs::symlink;
    let scene = Scene::new();
    let folder = scene.0.path().join("scene");
    fs::rename(folder.join("images"), scene.0.path().join("flight")).unwrap();
    symlink("../flight", folder.join("images")).unwrap();
    symlink(".", folder.join("around")).unwrap();
    symlink("nowhere", folder.join("old")).unwrap();
    let checked = scene.check(&[]);
    let notices = String::from_utf8_lossy(&checked.stderr);
    assert!(checked.status.success(), "{notices}");
    for words in [
        "holds 6 PNG, 2 text",
        "lead nowhere, left out: old -> nowhere",
        "not followed: around -> .",
    ] {
        assert!(notices.contains(words), "'{words}' is not in: {notices}");
    }
}

#[test]
fn earlier_results_within_the_scene_are_not_part_of_it() {
    let scene = Scene::new();
    scene.write("results/model_atlas.png", &scene.read("images/s1_01.png"));
    let output = Command::new(env!("CARGO_BIN_EXE_ridgeline"))
        .arg("reconstruct")
        .arg(scene.0.path().join("scene"))
        .arg("--out")
        .arg(scene.0.path().join("scene/results"))
        .args(["--memory", "30"])
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains("MB of memory"), "{message}");
}

#[test]
fn tiles_give_the_model_of_the_whole() {
    let scene = Scene::new();
    let output = scene.run(&["--roi", "-31,-31,31,31", "--tile", "60", "--ground-z", "0"]);
    let printed = crate::printed(&output);
    assert!(printed.contains("tile 4 of 4"), "{printed}");
    assert_eq!(names_in(&scene.out()), OUTPUTS);
    // The house stands in the middle, where four tiles meet: it is taken once, and whole.
    let city: serde_json::Value =
        serde_json::from_slice(&fs::read(scene.out().join("model.city.json")).unwrap()).unwrap();
    let buildings = city["CityObjects"].as_object().unwrap();
    assert_eq!(buildings.len(), 1, "{printed}");
    let facets = buildings.values().next().unwrap()["attributes"]["roofFacets"]
        .as_u64()
        .unwrap();
    assert!(facets >= 4, "{facets}");
}

#[test]
fn a_check_says_what_the_images_say() {
    let scene = Scene::new();
    let printed = scene.check(&[]);
    let words = String::from_utf8_lossy(&printed.stdout);
    assert!(printed.status.success());
    assert!(
        words.contains("images and orientation agree:") && words.contains("s2_03.png"),
        "{words}"
    );
    let json = scene.check(&["--json"]).stdout;
    let found: serde_json::Value = serde_json::from_slice(&json).unwrap();
    assert_eq!(found["agreement"]["finding"], "sound");
    let adjustment = |more: &[&str]| {
        let found = scene.check(more).stdout;
        let found: serde_json::Value = serde_json::from_slice(&found).unwrap();
        found["views"][0]["adjustment"].clone()
    };
    assert_eq!(found["views"][0]["adjustment"]["rms_motion_px"], 0.0);
    assert!(adjustment(&["--json", "--no-adjust"]).is_null());
    assert!(adjustment(&["--json", "--adjust"]).is_object());
    assert!(!scene.check(&["--adjust", "--no-adjust"]).status.success());
    // What it prints is an orientation itself.
    fs::remove_dir_all(scene.0.path().join("scene/colmap")).unwrap();
    scene.write("checked.json", &json);
    let again = scene.check(&["--json"]).stdout;
    let again: serde_json::Value = serde_json::from_slice(&again).unwrap();
    for (a, b) in found["views"]
        .as_array()
        .unwrap()
        .iter()
        .zip(again["views"].as_array().unwrap())
    {
        assert_eq!(
            (&a["file"], &a["K"], &a["R"]),
            (&b["file"], &b["K"], &b["R"])
        );
    }

    let broken = Scene::with_list(|a| a.map(|a| a / 0.9));
    let refused = broken.check(&["--json"]);
    assert_eq!(refused.status.code(), Some(2));
    let found: serde_json::Value = serde_json::from_slice(&refused.stdout).unwrap();
    assert_eq!(found["agreement"]["finding"], "explained");
    assert!(found["refusal"].as_str().unwrap().contains("kappa in gon"));
}
