//! `ridgeline orient` as a user meets it.

use std::ffi::OsStr;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use crate::common::{contents_of, names_in};
use nalgebra::{Point3, Vector3};
use ridgeline::Scene;

/// A folder of photographs without orientation, and one for the results.
struct Photographs {
    folder: tempfile::TempDir,
    scene: Scene,
}

impl Photographs {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let (scene, _) = ridgeline::orienting::synthetic::drone_scene(240);
        for (path, bytes) in ridgeline::orienting::synthetic::to_files(&scene) {
            if path.ends_with(".png") {
                let path = folder.path().join("photos").join(path);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, bytes).unwrap();
            }
        }
        Self { folder, scene }
    }

    fn photos(&self) -> PathBuf {
        self.folder.path().join("photos")
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("oriented")
    }

    fn orient(&self, more: &[&str]) -> Output {
        let (photos, out) = (self.photos(), self.out());
        let fixed = [
            "orient".as_ref(),
            photos.as_os_str(),
            "--out".as_ref(),
            out.as_os_str(),
        ];
        run(fixed.into_iter().chain(more.iter().map(OsStr::new)))
    }

    /// A list of control points in the manner of OpenDroneMap; of the one in the middle the
    /// position is so many metres too far east.
    fn control(&self, wrong_m: f64) -> String {
        self.control_with_roles(wrong_m, |_| "")
    }

    /// The same with a role behind each name.
    fn control_with_roles(&self, wrong_m: f64, role: impl Fn(&str) -> &'static str) -> String {
        let places = [
            ("north", [-8.0, 7.0, 0.0]),
            ("south", [9.0, -7.0, 0.0]),
            ("east", [8.0, 9.0, 0.0]),
            ("west", [-9.0, -8.0, 0.0]),
            ("middle", [-3.0, -9.0, 0.0]),
            ("pole", [0.0, 9.0, 3.0]),
        ];
        let mut text = "EPSG:25832\n".to_owned();
        for (name, [x, y, z]) in places {
            for (i, view) in self.scene.views.iter().enumerate() {
                let seen = view.camera.project(&Point3::new(x, y, z)).unwrap();
                if !view.camera.contains(&seen, 0.0) {
                    continue;
                }
                let wrong = if name == "middle" { wrong_m } else { 0.0 };
                let (e, n) = (x + ON_MAP.x + wrong, y + ON_MAP.y);
                let role = role(name);
                let mark = format!("{} {} d{i}.png {name} {role}", seen.x, seen.y);
                writeln!(text, "{e} {n} {z} {mark}").unwrap();
            }
        }
        text
    }

    fn reconstruct(&self) -> Output {
        let (photos, out) = (self.photos(), self.out());
        run([
            "reconstruct".as_ref(),
            photos.as_os_str(),
            "--out".as_ref(),
            out.as_os_str(),
        ])
    }

    fn check(&self) -> Output {
        let (photos, out) = (self.photos(), self.out());
        run([
            "check".as_ref(),
            photos.as_os_str(),
            "--orientation".as_ref(),
            out.as_os_str(),
        ])
    }
}

fn run<'a>(arguments: impl IntoIterator<Item = &'a OsStr>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ridgeline"));
    command.args(arguments).output().unwrap()
}

#[test]
fn photographs_alone_are_oriented_into_a_folder_that_is_read_on() {
    let photographs = Photographs::new();
    let output = photographs.orient(&["--features", "800", "--focal", "216"]);
    let printed = crate::printed(&output);
    assert!(
        printed.starts_with("9 of 9 photographs oriented"),
        "{printed}"
    );
    let expected = [
        "cameras.txt",
        "images.txt",
        "orientation.json",
        "orientation.log",
        "points3D.txt",
    ];
    assert_eq!(names_in(&photographs.out()), expected);
    let report = std::fs::read(photographs.out().join("orientation.json")).unwrap();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    let coverage = &report["coverage"];
    let shares = coverage["shares"].as_array().unwrap().iter();
    let sum: f64 = shares.map(|share| share.as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{coverage}");
    let enough = (coverage["shares"][0].as_f64().unwrap() * 100.0).round();
    let words = format!("of the area {enough} % are shown by 5 photographs or more");
    assert!(printed.contains(&words), "{printed}");
    let first = contents_of(&photographs.out());
    assert!(
        photographs
            .orient(&["--features", "800", "--focal", "216", "--threads", "1"])
            .status
            .success()
    );
    assert_eq!(contents_of(&photographs.out()), first);
    let output = photographs.check();
    let printed = crate::printed(&output);
    assert!(
        printed.contains("images and orientation agree"),
        "{printed}"
    );
    // Two photographs are none.
    for i in 2..9 {
        fs::remove_file(photographs.photos().join(format!("images/d{i}.png"))).unwrap();
    }
    let output = photographs.orient(&[]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("2 photographs; give three or more"),
        "{message}"
    );
}

/// Where the map puts the zero of the scene.
const ON_MAP: Vector3<f64> = Vector3::new(432_150.0, 5_412_340.0, 0.0);

#[test]
fn control_points_give_the_map_and_a_wrong_one_is_named() {
    let photographs = Photographs::new();
    // It was read two metres too far east.
    let text = photographs.control(2.0);
    let list = photographs.folder.path().join("points.txt");
    fs::write(&list, &text).unwrap();
    let list = list.to_str().unwrap();
    let options = ["--features", "800", "--focal", "216"];
    let output = photographs.orient(&[&options[..], &["--gcp", list]].concat());
    let printed = crate::printed(&output);
    for words in [
        "EPSG:25832, x from 432100 and y from 5412300 m: 5 of 6 ground control points",
        "ground control point middle is -1.9",
        "from where the others put it: check its coordinates and marks",
        "--crs EPSG:25832 --out MODEL",
    ] {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let warnings = printed.lines().filter(|l| l.starts_with("warning:"));
    assert_eq!(warnings.count(), 1, "{printed}");
    // Beside the photographs, under the name that OpenDroneMap gives it, it says the same, and is
    // no orientation by itself.
    let with_option = contents_of(&photographs.out());
    fs::write(photographs.photos().join("gcp_list.txt"), &text).unwrap();
    assert!(photographs.orient(&options).status.success());
    assert_eq!(contents_of(&photographs.out()), with_option);
    let output = photographs.check();
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(
        printed.contains("images and orientation agree"),
        "{printed}"
    );
}

#[test]
fn the_control_sheet_is_that_of_the_run_and_of_what_it_wrote() {
    let photographs = Photographs::new();
    let role = |name: &str| match name {
        "middle" => "check",
        "pole" => "height",
        _ => "",
    };
    let list = photographs.photos().join("gcp_list.txt");
    fs::write(&list, photographs.control_with_roles(2.0, role)).unwrap();
    let options = ["--features", "800", "--focal", "216", "--check"];
    let printed = crate::printed(&photographs.orient(&options));
    for words in [
        "5 of 5 ground control points, rms ",
        "; check points: 1, rms 2.0",
        "a length of 10 m is known to +- 0.0",
        "control points: 5 of 5 agree, rms ",
        "check points: 0 of 1 agree, rms 2.0",
        "check point middle is -2.0",
        "from where the control points put it",
    ] {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let pole = printed.lines().find(|line| line.starts_with("pole"));
    assert!(
        pole.is_some_and(|line| line.contains("        -        -")),
        "{printed}"
    );
    let out = photographs.out();
    let check =
        |folder: &std::path::Path| run(["orient".as_ref(), folder.as_os_str(), "--check".as_ref()]);
    let sheet = crate::printed(&check(&out));
    assert!(printed.starts_with(&sheet), "{sheet}{printed}");
    let refused = check(&photographs.photos());
    let message = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(
        message.contains("orientation.json: cannot be read"),
        "{message}"
    );
}

#[test]
fn photographs_alone_are_oriented_and_reconstructed_in_one_run_where_their_scale_is_known() {
    let photographs = Photographs::new();
    let output = photographs.reconstruct();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("nothing tells their scale"), "{message}");
    fs::write(
        photographs.photos().join("gcp_list.txt"),
        photographs.control(0.0),
    )
    .unwrap();
    let printed = crate::printed(&photographs.reconstruct());
    assert!(printed.contains("oriented first"), "{printed}");
    assert!(printed.contains("9 of 9 photographs oriented"), "{printed}");
    let report = fs::read_to_string(photographs.out().join("report.json")).unwrap();
    assert!(report.contains("25832"), "{report}");
    assert!(photographs.out().join("orientation/images.txt").is_file());
}

#[test]
fn a_list_that_cannot_be_read_is_named_with_its_line() {
    let photographs = Photographs::new();
    let list = photographs.folder.path().join("points.txt");
    fs::write(&list, "EPSG:25832\n432150 5412340 0 12 left d0.png\n").unwrap();
    let refused = |path: &str| {
        let output = photographs.orient(&["--gcp", path]);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let message = refused(list.to_str().unwrap());
    assert!(
        message.contains("gcp_list.txt, line 2") && message.contains("geo_x geo_y"),
        "{message}"
    );
    let message = refused("nowhere.txt");
    assert!(message.contains("nowhere.txt: cannot be read"), "{message}");
}
