//! The cases that people brought (`../shared/cases`, or the folder that CASES names): each with its
//! right value, or the words of its refusal. Without that folder they are skipped, and say so.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use nalgebra::Point3;
use ridgeline::Scene;
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene_loader::{LoadOptions, load_scene, unpack};
use ridgeline::orienting::structure_from_motion::{
    OrientChain, OrientOptions, Oriented, ReadPhoto,
};
use ridgeline::results::export::ReportedModel;

use crate::common::zipped;

/// The folder of the cases.
fn cases() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = std::env::var("CASES").unwrap_or_else(|_| "../shared/cases".to_owned());
    let found = fs::canonicalize(root.join(folder)).ok();
    if found.is_none() {
        // Past the harness, which keeps what a passing test prints.
        let words = "skipped: ../shared/cases is not there, and CASES names no other folder\n";
        std::io::stderr().write_all(words.as_bytes()).unwrap();
    }
    found
}

/// The folder of a case by its number, and what is below it.
fn case(cases: &Path, path: &str) -> PathBuf {
    let (number, below) = path.split_once('/').unwrap_or((path, ""));
    let mut folders = fs::read_dir(cases)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let is_it = |p: &PathBuf| p.file_name().unwrap().to_string_lossy().starts_with(number);
    let folder = folders
        .find(is_it)
        .unwrap_or_else(|| panic!("no case {path}"));
    folder.join(below)
}

/// All files below a folder, in the order of their names, or one file.
fn files(path: &Path) -> Vec<(String, Vec<u8>)> {
    if path.is_file() {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        return vec![(name, fs::read(path).unwrap())];
    }
    let mut found = Vec::new();
    for name in crate::common::names_in(path) {
        let inner = path.join(&name);
        let prefix = if inner.is_dir() {
            format!("{name}/")
        } else {
            String::new()
        };
        found.extend(
            files(&inner)
                .into_iter()
                .map(|(p, b)| (format!("{prefix}{p}"), b)),
        );
    }
    found
}

fn inputs(files: Vec<(String, Vec<u8>)>) -> Vec<InputFile> {
    let input = |(path, bytes): (String, Vec<u8>)| InputFile::new(&path, bytes);
    files.into_iter().map(input).collect()
}

/// A scene of the cases, the file that an option names, its reference system, words of a warning
/// ("" where there is to be none of what is known), and what must be so.
type SceneCase = (
    &'static str,
    &'static str,
    u32,
    &'static str,
    fn(&Scene) -> bool,
);

/// Height of the terrain in the middle of the scene, world frame, metres.
fn ground_z(scene: &Scene) -> f64 {
    let terrain = scene.known.terrain.as_ref().expect("terrain");
    terrain.z_at(0.0, 0.0).expect("covered") + scene.origin.z
}

/// No height near zero anywhere, and holes.
fn holes_are_none(scene: &Scene) -> bool {
    let terrain = scene.known.terrain.as_ref().expect("terrain");
    let places = (-40..40).flat_map(|x| (-40..40).map(move |y| (f64::from(x), f64::from(y))));
    let all: Vec<Option<f64>> = places.map(|(x, y)| terrain.z_at(x, y)).collect();
    let is_ground = |z: &f64| (z + scene.origin.z - 352.75).abs() < 15.0;
    all.iter().any(Option::is_none) && all.iter().flatten().all(is_ground)
}

fn houses(scene: &Scene) -> usize {
    let register = scene.known.footprints.as_ref();
    register.map_or(0, |register| register.footprints.len())
}

/// Distance of the first two cameras, metres.
fn baseline(scene: &Scene) -> f64 {
    let [a, b] = [0, 1].map(|i| scene.views[i].camera.center);
    (a - b).norm()
}

/// The first two cameras are as far apart as their coordinates say in US survey feet.
fn is_in_feet(scene: &Scene) -> bool {
    scene.survey.epsg == Some(32118) && (baseline(scene) - 78.017_927).abs() < 1e-5
}

fn uses_nothing(scene: &Scene) -> bool {
    scene.known.terrain.is_none() && houses(scene) == 0 && scene.known.point_cloud.is_none()
}

#[rustfmt::skip]
const SCENES: &[SceneCase] = &[
    ("45/scene", "dtm_zero.tif", 25832, "heights are no ground", holes_are_none),
    ("45/scene", "dtm_tagged.tif", 25832, "", holes_are_none),
    ("46/scene", "dtm_unit_of_band.tif", 25832, "", |s| (ground_z(s) - 352.75).abs() < 0.2),
    ("46/scene", "dtm_vertical_code.tif", 25832, "", |s| (ground_z(s) - 352.75).abs() < 0.2),
    ("46/scene", "cloud_vertical_code.laz", 25832, "", |s| {
        (ground_z(s) - 352.75).abs() < 0.2 && s.known.point_cloud.is_some()
    }),
    ("47/scene_with_grid", "", 0, "--crs", |s| s.survey.epsg.is_none()),
    ("47/scene_with_shapefile", "", 0, "--crs", |s| s.survey.epsg.is_none()),
    ("48/scene", "", 2263, "feet", is_in_feet),
    ("48/scene_with_prj", "", 0, "feet", is_in_feet),
    ("49/folder_with_dsm", "", 0, "surface model", uses_nothing),
    ("49/folder_with_bounds", "", 0, "lies where the photographs do", uses_nothing),
    ("49/folder_with_cloud", "", 0, "is used", |s| s.known.point_cloud.is_some()),
    ("50/scene", "", 0, "3602 m2 holds most of what the photographs show", uses_nothing),
    ("52/scene", "cloud_5555.laz", 25832, "", |s| s.known.point_cloud.is_some()),
    ("52/scene", "houses_5555.city.json", 25832, "", |s| houses(s) == 2),
    ("52/scene", "houses_7415.city.json", 28992, "", |s| houses(s) == 2),
    ("52/scene", "houses_crs_compound.city.json", 25832, "", |s| houses(s) == 2),
    ("52/scene", "houses_two_codes.geojson", 25832, "", |s| houses(s) == 2),
    ("53/scene", "houses.geojsonl", 25832, "", |s| houses(s) == 2),
    ("53/scene", "houses.city.jsonl", 25832, "", |s| houses(s) == 2),
    ("57/folder_with_asc", "", 25832, "is used", |s| s.known.terrain.is_some()),
    ("57/folder_with_laz", "", 25832, "is used", |s| s.known.point_cloud.is_some()),
    ("59/scene", "", 0, "images_2/", |s| s.views.len() == 3),
    ("60/scene", "", 0, "", |s| {
        let k = s.views[0].camera.k;
        (k[(0, 0)] - 400.0).abs() < 0.01 && k[(0, 2)] == 160.0 && k[(1, 2)] == 120.0
    }),
    ("61/scene", "", 0, "", |s| (baseline(s) - 15.17).abs() < 0.05),
];

#[test]
fn scenes_have_their_right_values() {
    let Some(cases) = cases() else { return };
    let mut wrong = Vec::new();
    for (path, beside, crs, words, is_right) in SCENES {
        let mut read = files(&case(&cases, path));
        let number = path.split('/').next().unwrap();
        if !beside.is_empty() {
            read.extend(files(&case(&cases, &format!("{number}/{beside}"))));
        }
        let named = |ends: &[&str]| {
            let is_it = ends.iter().any(|end| beside.ends_with(end));
            is_it.then(|| (*beside).to_owned())
        };
        let options = LoadOptions {
            terrain: named(&[".tif"]),
            footprints: named(&["json", "jsonl"]),
            point_cloud: named(&[".laz"]),
            epsg: Some(*crs).filter(|crs| *crs > 0),
            // Small drawn images, of which only the numbers count here.
            ignore_check: true,
            ..LoadOptions::default()
        };
        // The same from a folder and from an archive.
        let archive = InputFile::new("all.zip", zipped(&read));
        for files in [inputs(read), unpack(archive).unwrap()] {
            let prefix = if files[0].path.starts_with("all/") {
                "all/"
            } else {
                ""
            };
            let at = |path: &Option<String>| path.as_ref().map(|path| format!("{prefix}{path}"));
            let options = LoadOptions {
                terrain: at(&options.terrain),
                footprints: at(&options.footprints),
                point_cloud: at(&options.point_cloud),
                ..options.clone()
            };
            let scene = match load_scene(&files, &options) {
                Ok(scene) => scene,
                Err(e) => {
                    wrong.push(format!("{path} {beside}: {e}"));
                    continue;
                }
            };
            let said = scene.warnings.join("\n");
            if !is_right(&scene) || !said.contains(words) {
                wrong.push(format!("{path} {beside}, '{words}': {said}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_report_of_a_model_in_feet_is_in_metres() {
    let Some(cases) = cases() else { return };
    let model = files(&case(&cases, "48/model_feet.city.json")).remove(0).1;
    let written = ReportedModel::read(&model).unwrap().files(&[]);
    let table = &written
        .iter()
        .find(|(name, _)| name == "buildings.csv")
        .unwrap()
        .1;
    let text = String::from_utf8_lossy(table);
    assert!(text.contains("21.8") && text.contains("107.6"), "{text}");
}

/// Folder and archive say the same of what lies in them.
#[test]
fn clouds_and_grids_of_a_folder_are_read_as_those_of_an_archive() {
    let Some(cases) = cases() else { return };
    let folder = tempfile::tempdir().unwrap();
    for (path, name) in [
        ("57/folder_with_laz", "good.laz"),
        ("57/folder_with_asc", "dgm10.asc"),
    ] {
        let scene = case(&cases, path);
        let archive = folder.path().join("scene.zip");
        fs::write(&archive, zipped(&files(&scene))).unwrap();
        for scene in [scene, archive] {
            let mut check = Command::new(env!("CARGO_BIN_EXE_ridgeline"));
            check
                .arg("check")
                .arg(scene)
                .args(["--crs", "EPSG:25832", "--no-adjust"]);
            let printed = crate::printed(&check.output().unwrap());
            assert!(printed.contains(&format!("{name} is used")), "{printed}");
        }
    }
}

/// Photographs that are oriented, with what lists beside them may say.
struct Flight(OrientChain);

impl Flight {
    fn of(folder: &Path, applies_fix: bool) -> Self {
        let mut options = OrientOptions {
            applies_fix,
            ..OrientOptions::default()
        };
        // Small and few: what is said of a frame does not depend on them.
        (options.features.most, options.features.working_px) = (400, 500);
        let mut chain = OrientChain::new(options.clone());
        let files = inputs(files(folder));
        chain.set_lists(&files).unwrap();
        for file in files.iter().filter(|file| file.path.ends_with(".jpg")) {
            chain.add(ReadPhoto::read(file, &options));
        }
        chain.connect(Default::default()).unwrap();
        Self(chain)
    }

    /// Oriented, and all that is said.
    fn oriented(&self) -> (Oriented, String) {
        let oriented = self.0.orient(None).unwrap();
        let said = oriented.report.to_text();
        (oriented, said)
    }
}

/// Heights of the cameras, and how far the lowest one is above the mean point.
fn heights(oriented: &Oriented) -> [f64; 3] {
    let model = &oriented.model;
    let cameras: Vec<f64> = model.photos.iter().map(|p| p.pose.center.z).collect();
    let low = cameras.iter().copied().fold(f64::INFINITY, f64::min);
    let high = cameras.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let ground = model.points.iter().map(|p| p.position.z).sum::<f64>();
    [low, high, low - ground / model.points.len() as f64]
}

/// Photographs, a list beside them ("" without one), whether usual mistakes are mended, all words
/// of what is said (without one: no warning), and what must be so.
type FlightCase = (
    &'static str,
    &'static str,
    bool,
    &'static [&'static str],
    fn(&Oriented) -> bool,
);

fn is_true_to_metres(oriented: &Oriented) -> bool {
    let [low, high, above] = heights(oriented);
    (low - 407.1).abs() < 0.5 && (high - 414.8).abs() < 0.5 && (74.0..82.0).contains(&above)
}

/// Above the ground, and as far apart as they are.
fn is_upright_and_scaled(oriented: &Oriented) -> bool {
    let centers: Vec<Point3<f64>> = oriented
        .model
        .photos
        .iter()
        .map(|p| p.pose.center)
        .collect();
    let span = centers
        .iter()
        .map(|c| (c - centers[0]).norm())
        .fold(0.0, f64::max);
    let [.., above] = heights(oriented);
    (70.0..86.0).contains(&above) && (span / SPAN_M - 1.0).abs() < 0.05
}

/// From the first photograph to the farthest one, metres.
const SPAN_M: f64 = 47.02;

fn is_upright(oriented: &Oriented) -> bool {
    heights(oriented)[2] > 0.0
}

const EXCHANGED: &[&str] = &["x and y exchanged", "--apply-fix"];

#[rustfmt::skip]
const FLIGHTS: &[FlightCase] = &[
    ("40/photos", "40/right", false, &[], is_true_to_metres),
    ("40/photos", "40/lat_lon", false, EXCHANGED, is_upright),
    ("40/photos", "40/north_east", false, EXCHANGED, is_upright),
    ("40/photos", "40/north_east_with_relief", false, EXCHANGED, is_upright),
    ("40/photos", "42/feet", false, &["US survey feet"], is_true_to_metres),
    ("40/photos", "42/feet_heights_in_metres", false, &["metres"], is_true_to_metres),
    ("40/photos", "55/marked_in_the_originals", false, &["photographs 3.75 times"], is_upright),
    ("40/photos", "55/names_without_extension", false, &[], is_true_to_metres),
    ("40/photos", "55/windows_paths", false, &[], is_true_to_metres),
    ("40/photos", "55/row_before_column", false, &["row and column"], is_upright),
    ("40/photos", "40/lat_lon", true, &["was read with x and y exchanged"], is_true_to_metres),
    ("40/photos", "40/north_east", true, &["was read with"], is_true_to_metres),
    ("40/photos", "40/north_east_with_relief", true, &["was read with"], is_true_to_metres),
    ("40/photos", "55/marked_in_the_originals", true, &["was read with"], is_true_to_metres),
    ("40/photos", "55/row_before_column", true, &["was read with"], is_true_to_metres),
    ("41/photos", "", false, &["mirror", "GPSLatitudeRef"], is_upright),
    ("43/photos_none_has_altitude", "", false, &["heights count from the ground"], is_upright_and_scaled),
    ("43/photos_five_of_eight_state_0", "", false, &["height"], is_upright_and_scaled),
    ("44/photos", "", false, &["a roll of 180 degrees"], is_upright),
    ("44/photos", "", true, &["were read as"], is_upright),
    ("54/photos_altitude_0_of_0", "", false, &["height"], is_upright_and_scaled),
    ("54/photos_seconds_0_of_0", "", false, &[], is_true_to_metres),
    ("54/photos_one_place", "", false, &["state one place"], is_upright),
    ("58/photos", "", false, &[], is_true_to_metres),
];

#[test]
fn flights_have_their_right_values() {
    let Some(cases) = cases() else { return };
    let mut flight: Option<(&str, bool, Flight)> = None;
    for (photos, list, applies_fix, words, is_right) in FLIGHTS {
        // Photographs in a row are connected once.
        if flight
            .as_ref()
            .is_none_or(|(p, f, _)| (p, f) != (photos, applies_fix))
        {
            flight = Some((
                photos,
                *applies_fix,
                Flight::of(&case(&cases, photos), *applies_fix),
            ));
        }
        let flight = &mut flight.as_mut().unwrap().2;
        if !list.is_empty() {
            flight
                .0
                .set_lists(&inputs(files(&case(&cases, list))))
                .unwrap();
        }
        let (oriented, said) = flight.oriented();
        assert!(
            is_right(&oriented),
            "{photos} {list}: {:?}\n{said}",
            heights(&oriented)
        );
        for word in *words {
            assert!(
                said.contains(word),
                "{photos} {list}: '{word}' is not in:\n{said}"
            );
        }
        assert!(
            !words.is_empty() || !said.contains("warning:"),
            "{photos} {list}:\n{said}"
        );
    }
}

/// Cases 51 and 56: place and system of what `orient` finds are those of the next step.
#[test]
fn what_orient_finds_goes_along() {
    let Some(cases) = cases() else { return };
    let photos = case(&cases, "51/photos");
    let mut flight = Flight::of(&photos, false);
    let with_houses = |scene: &Scene| houses(scene) == 8;
    let with_ground = |scene: &Scene| (ground_z(scene) - 331.0).abs() < 0.5;
    type Right<'a> = &'a dyn Fn(&Scene) -> bool;
    let steps: [(&str, &str, Option<u32>, Right); 3] = [
        ("", "51/houses_lonlat.geojson", None, &with_houses),
        ("", "51/dtm_utm32.tif", None, &with_ground),
        (
            "56/gcp_list.txt",
            "51/dtm_utm32.tif",
            Some(32632),
            &with_ground,
        ),
    ];
    for (list, beside, epsg, is_right) in steps {
        if !list.is_empty() {
            let lists = inputs(files(&case(&cases, list)));
            flight.0.set_lists(&lists).unwrap();
        }
        let (oriented, _) = flight.oriented();
        assert_eq!(oriented.report.epsg, epsg);
        let mut all = files(&photos);
        let in_folder = |(name, bytes)| (format!("ORI/{name}"), bytes);
        all.extend(oriented.files().into_iter().map(in_folder));
        all.extend(files(&case(&cases, beside)));
        let options = LoadOptions {
            orientation: Some("ORI".to_owned()),
            ignore_check: true,
            ..LoadOptions::default()
        };
        let scene = load_scene(&inputs(all), &options).unwrap_or_else(|e| panic!("{beside}: {e}"));
        let said = scene.warnings.join("\n");
        assert_eq!(scene.survey.epsg, epsg, "{said}");
        assert_eq!(scene.survey.anchor.is_some(), epsg.is_none(), "{said}");
        assert!(is_right(&scene), "{beside}: {said}");
    }
}
