//! Terrain and footprints that are known beforehand: planted ones are followed, wrong ones lose
//! against the images and are named.
#![allow(clippy::disallowed_methods)]

use nalgebra::{Point2, Point3, Vector3};
use ridgeline::base::geometry::{contains, plan_sides};
use ridgeline::base::params::Params;
use ridgeline::orienting::known::{
    KnownComparison, KnownThing, KnownVerdict, Register, Terrain, WorldSystem,
};
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene::Scene;
use ridgeline::orienting::scene_loader::{LoadOptions, load_scene};
use ridgeline::orienting::synthetic::{SyntheticTruth, gable_scene, slope_scene, to_files};
use ridgeline::pipeline::{Run, Stage};
use ridgeline::roofs::facets::{FootprintVerdict, RegisterTrace};

const SIZE_PX: u32 = 400;
/// Tangent of 15 degrees.
const SLOPE: f64 = 0.268;

/// The scene as files, with one more.
fn loaded(scene: &Scene, more: Option<(&str, String)>) -> Scene {
    loaded_with(scene, more, &LoadOptions::default())
}

fn loaded_with(scene: &Scene, more: Option<(&str, String)>, options: &LoadOptions) -> Scene {
    let mut files: Vec<InputFile> = (to_files(scene).into_iter())
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect();
    files.extend(more.map(|(path, text)| InputFile::new(path, text.into_bytes())));
    load_scene(&files, options).unwrap()
}

/// Runs all stages up to the facets.
fn run(scene: Scene) -> Run {
    let mut run = Run::new(scene, Params::default());
    run.step(Stage::Facets, &ridgeline::silent());
    run
}

/// An ASCII grid of these heights, 120 m by 120 m around the origin.
fn grid(height: impl Fn(f64, f64) -> f64) -> String {
    let mut text = "ncols 120\nnrows 120\nxllcorner -60\nyllcorner -60\ncellsize 1\n".to_owned();
    for row in 0..120 {
        for column in 0..120 {
            let (x, y) = (f64::from(column) - 59.5, 59.5 - f64::from(row));
            text += &format!("{:.2} ", height(x, y));
        }
        text.push('\n');
    }
    text
}

fn ground_is(run: &Run, height: impl Fn(f64, f64) -> f64, within_m: f64) {
    let ground = run.results().ground.as_ref().unwrap();
    for (x, y) in [
        (0.0, 0.0),
        (12.0, 0.0),
        (-12.0, 3.0),
        (2.0, 13.0),
        (-5.0, -13.0),
    ] {
        let miss = ground.z_at(&Point2::new(x, y)) - height(x, y);
        assert!(miss.abs() < within_m, "{miss} m at {x}, {y}");
    }
}

/// Both facets are found, and the walls below them end in the ground, not above it.
fn house_is(run: &Run, height: impl Fn(f64, f64) -> f64) {
    let model = run.results().roof_model().unwrap();
    assert_eq!((model.facets.len(), model.buildings.len()), (2, 1));
    let corners = model.facets.iter().flat_map(|f| &f.outer);
    let lowest = corners
        .map(|p| height(p.x, p.y))
        .fold(f64::INFINITY, f64::min);
    let base = model.buildings[0].ground_z;
    assert!((base - lowest).abs() < 0.6, "{base} instead of {lowest}");
}

fn comparison(run: &Run) -> &KnownComparison {
    let ground = run.results().ground.as_ref().unwrap();
    ground.terrain().unwrap()
}

#[test]
fn a_house_on_a_slope_of_15_degrees_is_found_with_and_without_a_terrain_model() {
    let (scene, truth) = slope_scene(SIZE_PX, SLOPE);
    let height = |x: f64, _: f64| truth.ground_z + SLOPE * x;
    let alone = run(loaded(&scene, None));
    ground_is(&alone, height, 0.5);
    house_is(&alone, height);

    let known = run(loaded(&scene, Some(("dtm.asc", grid(height)))));
    assert_eq!(comparison(&known).verdict, KnownVerdict::Used);
    ground_is(&known, height, 0.15);
    house_is(&known, height);

    // Heights above the ellipsoid, where those of the orientation are above the geoid.
    let other_datum = grid(|x, y| height(x, y) + 47.3);
    let moved = run(loaded(&scene, Some(("dtm.asc", other_datum))));
    let found = comparison(&moved);
    assert_eq!(found.verdict, KnownVerdict::Moved);
    assert!((found.shift_m.unwrap()[2] + 47.3).abs() < 0.3, "{found:?}");
    ground_is(&moved, height, 0.4);
    house_is(&moved, height);
    let warning = found.warning(KnownThing::Terrain).unwrap();
    assert!(warning.contains("another datum"));
}

#[test]
fn a_surface_model_is_no_terrain() {
    let (scene, truth) = gable_scene(SIZE_PX);
    // As high as the roof where it stands.
    let surface = |x: f64, y: f64| {
        let inside =
            (truth.facets.iter()).find(|(_, ring)| contains(plan_sides(ring), &Point2::new(x, y)));
        // One whole number in a model of fractions would count as none.
        let ground = truth.ground_z + 1e-3 * x;
        inside.map_or(ground, |(plane, _)| plane.z_at(x, y))
    };
    let found = run(loaded(&scene, Some(("heights.asc", grid(surface)))));
    assert_eq!(comparison(&found).verdict, KnownVerdict::Contradicted);
    house_is(&found, |_, _| truth.ground_z);
}

#[test]
fn a_building_under_which_a_terrain_is_wrong_stands_on_the_ground_of_the_images_and_is_named() {
    let (scene, truth) = gable_scene(SIZE_PX);
    let height = |x: f64, y: f64| truth.ground_z + 0.02 * x - 0.01 * y;
    let is_inside = |x: f64, y: f64| {
        let holds = |ring: &[Point3<f64>]| contains(plan_sides(ring), &Point2::new(x, y));
        truth.facets.iter().any(|(_, ring)| holds(ring))
    };
    let pit = grid(|x, y| height(x, y) - if is_inside(x, y) { 3.0 } else { 0.0 });
    let mut run = Run::new(loaded(&scene, Some(("dtm.asc", pit))), Params::default());
    run.run_all();
    assert_eq!(comparison(&run).verdict, KnownVerdict::Used);
    house_is(&run, |_, _| truth.ground_z);
    let said = "the images contradict dtm.asc below building-1 (";
    let mut warnings = run.summaries().iter().flat_map(|stage| &stage.warnings);
    assert!(warnings.any(|words| words.starts_with(said)));
    let files = run.files(&[]);
    let report = files.iter().find(|(name, _)| name == "report.json");
    let report: serde_json::Value = serde_json::from_slice(&report.unwrap().1).unwrap();
    let below = &report["known"]["terrain"]["contradicted_below"][0];
    assert_eq!(below["building"], "building-1");
    let up_m = below["up_m"].as_f64().unwrap();
    assert!((up_m - 3.0).abs() < 1.0, "{up_m}");
}

/// By GDAL and LASzip: strips and tiles, all predictors, whole and floating-point numbers, both
/// byte orders.
#[test]
fn files_of_other_programs_hold_the_planted_ground_and_house() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/known/");
    let file = |name: &str| InputFile::new(name, std::fs::read(format!("{folder}{name}")).unwrap());
    let system = WorldSystem {
        epsg: Some(25832),
        anchor: None,
    };
    let origin = Vector3::new(432_100.0, 5_412_300.0, 100.0);
    for (name, within_m) in [
        ("strips.tif", 1e-3),
        ("deflate_p3.tif", 1e-3),
        ("lzw_p3_double.tif", 1e-3),
        ("lzw_p2_short.tif", 1.01),
        ("zstd_big.tif", 1e-3),
        ("grid.asc", 1e-3),
        ("ground_1.las", 2e-3),
        // The first place lies in a gap, beside which some cells have points on one side alone.
        ("ground_3.laz", 0.05),
        ("ground_7.laz", 0.05),
    ] {
        let terrain = Terrain::read(&file(name), None, &system, origin, 0.3).unwrap();
        for (x, y) in [(0.0, 0.0), (-38.2, 27.0), (31.7, -28.1)] {
            let miss = terrain.z_at(x, y).unwrap() - (12.0 + 0.25 * x - 0.1 * y);
            assert!(miss.abs() < within_m, "{name}: {miss} m at {x}, {y}");
        }
        assert_eq!(terrain.z_at(41.0, 0.0), None, "{name}");
    }
    for (name, area) in [("houses.geojson", 96.0), ("houses.city.json", 100.0)] {
        let register = Register::read(&file(name), &system, origin, 0.5, &mut Vec::new()).unwrap();
        let [house] = &register.footprints[..] else {
            panic!("{name}: {}", register.footprints.len());
        };
        assert!((house.outline.signed_area() - area).abs() < 1e-6, "{name}");
    }
}

/// The outline of the planted house, moved, as GeoJSON in the frame of the orientation.
fn footprints(truth: &SyntheticTruth, moves: &[(&str, [f64; 2])]) -> String {
    // The four eave corners, which only one facet has.
    let all: Vec<&Point3<f64>> = truth.facets.iter().flat_map(|(_, ring)| ring).collect();
    let once = |p: &&&Point3<f64>| all.iter().filter(|q| (**q - **p).norm() < 1e-6).count() == 1;
    let mut corners: Vec<Point3<f64>> = all.iter().filter(once).map(|p| **p).collect();
    corners.sort_by(|a, b| a.y.atan2(a.x).total_cmp(&b.y.atan2(b.x)));
    let feature = |(name, [dx, dy]): &(&str, [f64; 2])| {
        let ring: Vec<String> = (corners.iter().chain(&corners[..1]))
            .map(|p| format!("[{},{}]", p.x + dx, p.y + dy))
            .collect();
        let ring = ring.join(",");
        format!(
            r#"{{"type":"Feature","id":"{name}","geometry":{{"type":"Polygon","coordinates":[[{ring}]]}}}}"#
        )
    };
    let features: Vec<String> = moves.iter().map(feature).collect();
    let features = features.join(",");
    format!(r#"{{"type":"FeatureCollection","crs":null,"features":[{features}]}}"#)
}

fn register(run: &Run) -> &RegisterTrace {
    let facets = run.results().facets.as_ref().unwrap();
    facets.trace.facets.register.as_ref().unwrap()
}

#[test]
fn right_moved_and_wrong_footprints_are_named_and_leave_the_house() {
    let (scene, truth) = gable_scene(SIZE_PX);
    let on_ground = |_: f64, _: f64| truth.ground_z;
    let with = |moves: &[(&str, [f64; 2])]| {
        let file = ("houses.geojson", footprints(&truth, moves));
        let found = run(loaded(&scene, Some(file)));
        house_is(&found, on_ground);
        found
    };
    let right = with(&[("h1", [0.0, 0.0])]);
    let found = register(&right);
    assert!(found.compared.belongs > 0.95, "{found:?}");
    assert_eq!(found.footprints[0].verdict, FootprintVerdict::Agrees);
    assert!(found.footprints[0].roofed > 0.9);

    let moved = with(&[("h1", [1.2, -0.9])]);
    let found = register(&moved);
    assert!(found.compared.belongs > 0.95, "{found:?}");
    assert_eq!(found.footprints[0].verdict, FootprintVerdict::Shifted);
    let [x, y] = found.footprints[0].shift_m.unwrap();
    assert!((x + 1.2).abs() < 0.5 && (y - 0.9).abs() < 0.5, "{found:?}");
    let [there, here] = [&right, &moved].map(|run| register(run).footprints[0].bounds_m);
    for (from, to) in there.iter().zip(here) {
        assert!((from[0] + 1.2 - to[0]).abs() < 1e-9 && (from[1] - 0.9 - to[1]).abs() < 1e-9);
    }

    let report = right.results().facets.as_ref().unwrap();
    assert_eq!(
        report.trace.facets.register.as_ref().unwrap().footprints[0].name,
        "h1"
    );
}

#[test]
fn what_is_left_out_is_not_used() {
    let (scene, truth) = gable_scene(SIZE_PX);
    let files = [
        ("houses.geojson", footprints(&truth, &[("h1", [0.0, 0.0])])),
        ("dtm.asc", grid(|_, _| truth.ground_z)),
    ];
    for (path, text) in files {
        let options = |unused: &[&str]| LoadOptions {
            unused: unused.iter().map(|path| (*path).to_owned()).collect(),
            ..LoadOptions::default()
        };
        let is_known = |unused: &[&str]| {
            let known = loaded_with(&scene, Some((path, text.clone())), &options(unused)).known;
            known.terrain.is_some() || known.footprints.is_some()
        };
        assert!(is_known(&["another.asc"]), "{path}");
        assert!(!is_known(&[path]), "{path}");
    }
}
