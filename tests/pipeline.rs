//! The whole pipeline on the synthetic L-shaped house: what it finds is the planted truth, what it
//! finds in other scenes is as the goldens say and the same whatever the number of threads, and it
//! keeps no result that is out of date.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used)]

mod common;

use common::golden;
use common::scenes::{SIZE_PX, scenes};
use common::solid_checks;
use nalgebra::Point3;
use ridgeline::base::execution::progress::silent;
use ridgeline::base::execution::shard::MergedShards;
use ridgeline::base::geometry::{Plane, Segment3, contains, plan_sides};
use ridgeline::base::ids::ProposalOrigin;
use ridgeline::base::params::{Method, Params, Source};
use ridgeline::lines::lines3d::{Line3d, LineOrigin};
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene::Scene;
use ridgeline::orienting::scene_loader::{LoadOptions, load_scene};
use ridgeline::orienting::synthetic::{SyntheticTruth, l_scene, to_files};
use ridgeline::photographs::raster::RedBlueDifference;
use ridgeline::pipeline::{PackedView, Run, Stage};
use ridgeline::planes::grouping::PlaneGroup;
use ridgeline::roofs::model::{Facet, check_invariants};

/// Side of the photographs, pixels, where it is asked whether bytes are the same: they show the
/// middle of the house.
const PART_PX: u32 = 224;

/// Accuracy that six views at 8.5 cm ground pixel allow, metres.
const NEAR_M: f64 = 0.25;

const METHODS: [(Method, &str); 5] = [
    (Method::Lines, "lines"),
    (Method::Rectangles, "rectangles"),
    (Method::Combined, "combined"),
    (Method::Coplanar, "coplanar"),
    (Method::Adjacency, "adjacency"),
];

/// Coplanar lines alone and corners alone are looked at in a few scenes: time.
const FEW_SCENES: [&str; 3] = ["gable", "hip", "l"];

fn is_of_few_scenes(method: Method) -> bool {
    matches!(method, Method::Coplanar | Method::Adjacency)
}

fn finished(size_px: u32) -> (Run, SyntheticTruth) {
    let (scene, truth) = l_scene(size_px);
    let mut run = Run::new(scene, Params::default());
    run.run_all();
    (run, truth)
}

#[test]
fn the_planted_house_is_found() {
    let (run, truth) = finished(SIZE_PX);
    let results = run.results();

    let lines: Vec<Segment3> = results
        .lines
        .as_ref()
        .unwrap()
        .value
        .iter()
        .map(|l| l.segment)
        .collect();
    let covered: f64 = truth
        .edges
        .iter()
        .map(|e| e.length() * covered_share(e, &lines))
        .sum();
    let total: f64 = truth.edges.iter().map(Segment3::length).sum();
    assert!(
        covered >= 0.6 * total,
        "{covered:.1} m of {total:.1} m of the edges"
    );

    let model = &results.refinement.as_ref().unwrap().value;
    assert_eq!(check_invariants(model), vec![]);
    assert_eq!(model.buildings.len(), 1);
    assert!((model.buildings[0].ground_z - truth.ground_z).abs() < 0.5);
    let found = truth
        .facets
        .iter()
        .filter(|(plane, outer)| is_found(plane, outer, &model.facets));
    assert!(
        found.count() * 5 >= truth.facets.len() * 4,
        "at least four of five facets"
    );
    for facet in &model.facets {
        let middle = inner_point(&facet.outer);
        let true_plane = truth
            .facets
            .iter()
            .any(|(plane, _)| agrees(plane, &facet.plane, &middle));
        assert!(true_plane, "{:?} is no plane of the house", facet.plane);
    }

    let textured = &results.model.as_ref().unwrap().value;
    let faces: usize = model.buildings.iter().map(|b| b.solid.faces.len()).sum();
    assert_eq!(textured.faces.iter().map(Vec::len).sum::<usize>(), faces);
}

/// One method after the other, on photographs that are read once.
fn is_found_as_its_golden_says(name: &str) {
    let (_, scene) = scenes().into_iter().find(|(n, _)| *n == name).unwrap();
    let input: Vec<_> = (to_files(&scene).into_iter())
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect();
    let scene = load_scene(&input, &LoadOptions::default()).unwrap();
    let path = format!("{}/tests/golden/{name}.txt", env!("CARGO_MANIFEST_DIR"));
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    let mut found = golden::heading(name);
    for (method, title) in METHODS {
        if is_of_few_scenes(method) && !FEW_SCENES.contains(&name) {
            continue;
        }
        let params = Params {
            method,
            ..Params::default()
        };
        let mut run = Run::new(scene.clone(), params);
        run.run_all();
        let files = run.files(&[]);
        let city = files.iter().find(|(name, _)| name == "model.city.json");
        let city = serde_json::from_slice(&city.unwrap().1).unwrap();
        for (solid, errors) in solid_checks::solid_errors(&city) {
            assert!(errors.is_empty(), "{name}, {title}: {solid}: {errors:?}");
        }
        found += &golden::section(title, &files);
    }
    if std::env::var_os("RIDGELINE_REWRITE").is_some() {
        std::fs::write(path, found).unwrap();
        return;
    }
    let told = golden::differences(&expected, &found);
    let told: Vec<String> = (told.iter())
        .map(|d| format!("tests/golden/{name}.txt, {d}"))
        .collect();
    assert!(
        told.is_empty(),
        "{}\nif the change is intended: make golden",
        told.join("\n")
    );
}

/// A test for each golden, named as its scene: they share the cores.
macro_rules! each_is_found_as_its_golden_says {
    ($($name:ident),*) => {
        mod golden_of {
            $(#[test]
            fn $name() {
                super::is_found_as_its_golden_says(stringify!($name));
            })*

            #[test]
            fn every_scene() {
                let scenes = super::scenes().map(|(name, _)| name);
                assert_eq!(scenes, [$(stringify!($name)),*]);
            }
        }
    };
}

each_is_found_as_its_golden_says!(gable, l, row, askew, sheared, skewed, tower, hip);

/// Two sides of a roof, eaves at 3 m and ridge at 6 m.
const ROOF: [[[f64; 3]; 4]; 2] = [
    [
        [0.0, 0.0, 3.0],
        [10.0, 0.0, 3.0],
        [10.0, 4.0, 6.0],
        [0.0, 4.0, 6.0],
    ],
    [
        [0.0, 8.0, 3.0],
        [0.0, 4.0, 6.0],
        [10.0, 4.0, 6.0],
        [10.0, 8.0, 3.0],
    ],
];

/// The golden section of a run that found these facets, and so many segments.
fn section_of_roof(roof: &[[[f64; 3]; 4]], segments: usize) -> String {
    let corners: Vec<[f64; 3]> = roof.iter().flatten().copied().collect();
    let ring = |i: usize| (0..4).map(|j| 4 * i + j).collect::<Vec<_>>();
    let kinds = vec![serde_json::json!({ "type": "RoofSurface" }); roof.len()];
    let rings: Vec<_> = (0..roof.len()).map(|i| [ring(i)]).collect();
    let city = serde_json::json!({
        "transform": { "scale": [1.0, 1.0, 1.0], "translate": [0.0, 0.0, 0.0] },
        "vertices": corners,
        "CityObjects": { "building-0": {
            "attributes": { "groundHeight": 0.0, "volume": 360.0 },
            "geometry": [{ "boundaries": [rings], "semantics": { "surfaces": kinds } }],
        } },
    });
    let stage = serde_json::json!({ "stage": "segments", "counts": { "segments": segments } });
    let report = serde_json::json!({ "stages": [stage] });
    let files = [("report.json", report), ("model.city.json", city)];
    let files = files.map(|(name, json)| (name.to_owned(), json.to_string().into_bytes()));
    golden::section("lines", &files)
}

#[test]
fn a_golden_tells_planted_changes_and_bears_small_ones() {
    let golden = section_of_roof(&ROOF, 100);
    let facet = "  facet: slope 36.9, azimuth 180.0, height 4.50, area 50.00, corners 4\n";
    assert!(golden.contains(facet), "{golden}");
    let told = |roof: &[[[f64; 3]; 4]], segments| {
        golden::differences(&golden, &section_of_roof(roof, segments)).join("\n")
    };
    let raised = |by_m: f64| {
        let mut roof = ROOF;
        roof[1].iter_mut().for_each(|corner| corner[2] += by_m);
        roof
    };
    let mut moved = ROOF;
    moved[0][0][0] += 0.05;
    let mut turned = ROOF;
    turned.swap(0, 1);
    turned[0].rotate_left(3);

    assert_eq!(told(&ROOF, 100), "");
    assert_eq!(told(&turned, 100), "", "the order says nothing");
    assert_eq!(told(&raised(0.01), 104), "");
    assert!(told(&raised(0.05), 100).contains("height differs by 0.050, more than 0.030"));
    assert!(told(&moved, 100).contains("corner differs by 0.050"));
    assert!(told(&ROOF[..1], 100).contains("is missing"));
    assert!(told(&[ROOF[0], ROOF[1], raised(2.0)[1]], 100).contains("is new"));
    assert!(told(&ROOF, 106).contains("line 2: segments differs by 6.000, more than 5.000"));
    let azimuth = |deg| format!("facet: azimuth {deg}");
    assert!(golden::differences(&azimuth("359.9"), &azimuth("0.1")).is_empty());
    assert!(!golden::differences(&azimuth("359.9"), &azimuth("0.3")).is_empty());
    assert!(!golden::differences(&azimuth("359.9"), &azimuth("none")).is_empty());
    let faces = |n| format!("stage model: faces {n}");
    assert!(!golden::differences(&faces(100), &faces(101)).is_empty());
}

#[test]
fn one_thread_gives_the_bytes_of_many() {
    let files_with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| finished(SIZE_PX).0.files(&[]))
    };
    assert_eq!(files_with(1), files_with(5));
}

/// Most bytes of a shard without calls: who made it, and of what.
const NO_CALLS: usize = 13;

/// A run that several instances divide between them, as the page's workers do it.
fn divided(scene: Scene, params: &Params, of: usize) -> Run {
    let mut first = Run::new(scene, params.clone());
    let packed = || {
        let views = (0..6).map(|v| PackedView::new(first.scene(), v, true).unwrap().to_bytes());
        views
            .map(|bytes| PackedView::from_bytes(&bytes).unwrap())
            .collect()
    };
    let mut others: Vec<Run> = (1..of)
        .map(|_| Run::of_packed(packed(), params.clone()))
        .collect();
    while let Some(stage) = first.stages().into_iter().find(|&s| !first.has(s)) {
        let cameras = first.pack_cameras();
        for run in &mut others {
            assert!(run.take_cameras(&cameras));
        }
        let mut merged = MergedShards::default();
        for map in stage.shard_maps() {
            let runs = std::iter::once(&mut first).chain(&mut others);
            let shards = runs.enumerate().map(|(index, run)| {
                run.run_shard(stage, map, [index, of], merged.clone(), &silent())
            });
            for shard in shards.collect::<Vec<_>>() {
                // Longer than a list of no calls: the map of this name was reached.
                assert!(shard.len() > NO_CALLS, "{map} of {}", stage.name());
                assert!(merged.merge(map, &shard));
            }
        }
        if stage == Stage::Adjustment {
            // Where views move, the matches come next.
            let _ = first.adjust_once(&silent());
        } else {
            first.step_merged(stage, merged, &silent());
        }
        let found = first.hand_over(stage);
        for run in others.iter_mut().filter(|_| !found.is_empty()) {
            assert!(run.take_over(stage, &found));
        }
    }
    first
}

#[test]
fn instances_that_divide_a_run_give_the_bytes_of_one() {
    for (method, _) in METHODS {
        // What each method divides is divided by both of them together, on the whole house.
        let size_px = if method == Method::Combined {
            SIZE_PX
        } else {
            PART_PX
        };
        let (scene, _) = l_scene(size_px);
        let params = Params {
            method,
            ..Params::default()
        };
        let mut alone = Run::new(scene.clone(), params.clone());
        alone.run_all();
        // Coplanar lines and corners alone have no shards of their own.
        let most = if is_of_few_scenes(method) { 2 } else { 3 };
        for of in 2..=most {
            assert!(divided(scene.clone(), &params, of).files(&[]) == alone.files(&[]));
        }
    }
}

/// On halved photographs the house is found in the accuracy of their pixels, and a region holds.
#[test]
fn a_first_look_at_smaller_photographs_shows_the_planted_house() {
    let (mut scene, truth) = l_scene(480);
    let run = Run::new(scene.clone(), Params::default());
    let packed = run.pack_preliminary();
    let mut preliminary = Run::of_preliminary(&packed, run.params()).unwrap();
    let seen = preliminary.scene().views[0].gray.width;
    assert_eq!(seen, 240);
    let model = preliminary.first_look();
    assert_eq!(check_invariants(&model), vec![]);
    let found = truth
        .facets
        .iter()
        .filter(|(plane, outer)| is_found(plane, outer, &model.facets));
    assert!(
        found.count() * 5 >= truth.facets.len() * 4,
        "{} facets",
        model.facets.len()
    );

    scene.region = Some([100.0, 100.0, 120.0, 120.0]);
    let elsewhere = Run::new(scene, Params::default()).pack_preliminary();
    let mut preliminary = Run::of_preliminary(&elsewhere, run.params()).unwrap();
    assert_eq!(preliminary.first_look().facets, vec![]);

    assert!(Run::of_preliminary(&packed[..packed.len() / 2], run.params()).is_none());
    let small = Run::new(l_scene(64).0, Params::default());
    assert_eq!(small.pack_preliminary(), Vec::<u8>::new());
}

/// The view of [`moved_scene`] that is wrong.
const MOVED: usize = 2;

/// The house, with a view shifted by a pixel.
fn moved_scene() -> Scene {
    let (mut scene, _) = l_scene(SIZE_PX);
    scene.views[MOVED].camera.k[(0, 2)] += 1.0;
    scene
}

#[test]
fn instances_that_divide_a_run_have_the_same_adjusted_cameras() {
    let params = Params::default();
    let mut alone = Run::new(moved_scene(), params.clone());
    alone.run_all();
    let survey = &alone.scene().survey;
    assert!(survey.adjustments[MOVED].moves() && survey.adjustment_rounds > 0);
    let shared = divided(moved_scene(), &params, 2);
    assert!(shared.files(&[]) == alone.files(&[]));
    assert!(!alone.clone().take_cameras(&[255; 3]));
}

/// Whatever is turned on and off in which order, the results are those of a fresh run.
#[test]
fn views_are_adjusted_or_as_stated_by_a_parameter() {
    let off = || {
        let mut params = Params::default();
        params.adjustment.enabled = false;
        params
    };
    let stated = moved_scene();
    let mut run = Run::new(stated.clone(), Params::default());
    run.step(Stage::Lines, &silent());
    let cameras =
        |scene: &Scene| -> Vec<_> { scene.views.iter().map(|v| v.camera.clone()).collect() };
    let adjusted = run.clone();
    assert!(cameras(run.scene())[MOVED] != stated.views[MOVED].camera);
    // Once more changes nothing.
    for &stage in &[
        Stage::Segments,
        Stage::Lines,
        Stage::Adjustment,
        Stage::Lines,
    ] {
        run.step(stage, &silent());
    }
    assert_eq!(cameras(run.scene()), cameras(adjusted.scene()));
    assert_eq!(run.summaries(), adjusted.summaries());

    run.set_params(off());
    assert!(run.has(Stage::Segments) && !run.has(Stage::Matches));
    assert_eq!(cameras(run.scene()), cameras(&stated));
    assert!(run.scene().survey.adjustments.is_empty());
    run.step(Stage::Lines, &silent());
    let mut fresh = Run::new(stated.clone(), off());
    fresh.step(Stage::Lines, &silent());
    assert_eq!(run.summaries(), fresh.summaries());
    assert_eq!(cameras(run.scene()), cameras(&stated));

    run.set_params(Params::default());
    run.step(Stage::Lines, &silent());
    assert_eq!(cameras(run.scene()), cameras(adjusted.scene()));
    assert_eq!(run.summaries(), adjusted.summaries());

    // A later stage's parameters leave the cameras as they are.
    let mut params = Params::default();
    params.sweep.min_similarity = 0.9;
    run.set_params(params);
    assert!(run.has(Stage::Lines));
    assert_eq!(cameras(run.scene()), cameras(adjusted.scene()));
}

/// Two starts of one run that overlap deliver every shard twice: the planes then had the
/// photo-consistency maps of others, whose grids end earlier.
#[test]
fn shards_that_come_twice_do_not_mix_up_the_planes() {
    let (scene, _) = l_scene(SIZE_PX);
    let mut run = Run::new(scene, Params::default());
    run.step(Stage::HalfPlanes, &silent());
    let mut merged = MergedShards::default();
    for map in Stage::Groups.shard_maps() {
        let mut shard = |k| run.run_shard(Stage::Groups, map, [k, 2], merged.clone(), &silent());
        let dealt = [shard(0), shard(1)];
        for shard in dealt.iter().chain(&dealt) {
            merged.merge(map, shard);
        }
    }
    let mut alone = run.clone();
    run.step_merged(Stage::Groups, merged, &silent());
    run.step(Stage::Facets, &silent());
    alone.step(Stage::Facets, &silent());
    let facets = |run: &Run| format!("{:?}", run.results().facets.as_ref().unwrap().value);
    assert_eq!(facets(&run), facets(&alone));
}

/// In their order: what a stage takes in has been found before.
#[test]
fn both_methods_find_one_model() {
    let stages = |method: Method| Stage::of(method.sources());
    let of_both = stages(Method::Combined);
    for method in [Method::Lines, Method::Rectangles] {
        assert!(stages(method).iter().all(|stage| of_both.contains(stage)));
    }
    assert!(of_both.is_sorted() && Stage::of(&Source::ALL) == Stage::ALL);
    let (scene, truth) = l_scene(SIZE_PX);
    let params = Params {
        method: Method::Combined,
        ..Params::default()
    };
    let mut run = Run::new(scene, params);
    run.run_all();
    let results = run.results();
    let model = results.roof_model().unwrap();
    assert_eq!(check_invariants(model), vec![]);
    assert_eq!(model.buildings.len(), 1);
    let found = truth.facets.iter();
    let found = found.filter(|(plane, outer)| is_found(plane, outer, &model.facets));
    assert!(found.count() * 5 >= truth.facets.len() * 4);

    // Matched lines keep their ids; adopted ones follow, and no other method's parts are in the
    // files.
    let lines = &results.lines.as_ref().unwrap().value;
    let adopted = |l: &Line3d| l.origin == LineOrigin::Clustered;
    assert!(lines.is_sorted_by_key(adopted) && !adopted(&lines[0]));
    let rectangles = &results.rectangles.as_ref().unwrap().trace.candidates;
    let groups = &results.groups.as_ref().unwrap().trace.groups;
    let of_both = groups.iter().filter(|g| rectangles_of(g).count() > 0);
    assert!(
        of_both.clone().count() > 0,
        "planes that both methods found"
    );
    let mut joined: Vec<u32> = of_both.flat_map(rectangles_of).collect();
    joined.sort_unstable();
    joined.dedup();
    assert_eq!(
        joined.len(),
        rectangles.len(),
        "every candidate is somewhere, once"
    );
}

/// The candidates of W96 in a group's plane.
fn rectangles_of(group: &PlaneGroup) -> impl Iterator<Item = u32> {
    group.proposals.iter().filter_map(|origin| match origin {
        ProposalOrigin::Rectangle(index) => Some(*index),
        _ => None,
    })
}

/// Grey values say nothing here: detection, pairs, third views and the second look at the edges
/// have to look at the colour.
#[test]
fn the_lines_of_a_house_that_shows_in_colour_alone_are_found() {
    let (mut scene, truth) = l_scene(SIZE_PX);
    for view in &mut scene.views {
        view.red_blue = Some(RedBlueDifference::new(view.gray.clone()));
        view.gray.data.fill(0.5);
    }
    let mut params = Params::default();
    // Heights are found in grey values.
    params.matching.z_range_m = Some([truth.ground_z, truth.ground_z + 15.0]);
    let mut run = Run::new(scene, params);
    run.step(Stage::Lines, &silent());
    let lines = &run.results().lines.as_ref().unwrap().value;
    let lines: Vec<Segment3> = lines.iter().map(|l| l.segment).collect();
    let covered = |e: &Segment3| e.length() * covered_share(e, &lines);
    let covered: f64 = truth.edges.iter().map(covered).sum();
    let total: f64 = truth.edges.iter().map(Segment3::length).sum();
    assert!(
        covered >= 0.6 * total,
        "{covered:.1} m of {total:.1} m of the edges"
    );
}

#[test]
fn images_without_structure_give_an_empty_model_and_say_so() {
    let (mut scene, _) = l_scene(64);
    for view in &mut scene.views {
        view.gray.data.fill(0.5);
        view.red_blue = None;
    }
    let mut run = Run::new(scene, Params::default());
    run.run_all();
    assert!(
        run.results()
            .facets
            .as_ref()
            .unwrap()
            .value
            .facets
            .is_empty()
    );
    assert_eq!(run.summaries()[0].warnings.len(), 6, "one for each view");
    assert!(!run.files(&[]).is_empty());
}

/// The share of an edge that lies near lines of its own direction.
fn covered_share(edge: &Segment3, lines: &[Segment3]) -> f64 {
    const SAMPLES: usize = 50;
    let parallel = |l: &&Segment3| l.direction().cross(&edge.direction()).norm() < 0.05;
    let lines: Vec<&Segment3> = lines.iter().filter(parallel).collect();
    let covered = (0..SAMPLES).filter(|&i| {
        let p = edge.at((i as f64 + 0.5) / SAMPLES as f64);
        lines.iter().any(|l| distance(l, &p) < NEAR_M)
    });
    covered.count() as f64 / SAMPLES as f64
}

/// From a point to a finite segment, metres.
fn distance(segment: &Segment3, p: &Point3<f64>) -> f64 {
    let t = (p - segment.p0).dot(&segment.direction()) / segment.length();
    (segment.at(t.clamp(0.0, 1.0)) - p).norm()
}

/// Does a facet lie over the middle of the true one, in its plane?
fn is_found(plane: &Plane, outer: &[Point3<f64>], facets: &[Facet]) -> bool {
    let middle = inner_point(outer);
    let covers = |f: &&Facet| f.covers(&middle.xy());
    facets
        .iter()
        .filter(covers)
        .any(|f| agrees(plane, &f.plane, &middle))
}

fn agrees(truth: &Plane, found: &Plane, at: &Point3<f64>) -> bool {
    truth.angle_to(found).to_degrees() < 4.0
        && (truth.z_at(at.x, at.y) - found.z_at(at.x, at.y)).abs() < NEAR_M
}

/// The middle of a ring, or of its largest convex corner where the middle lies outside.
fn inner_point(ring: &[Point3<f64>]) -> Point3<f64> {
    let mean = ring
        .iter()
        .fold(nalgebra::Vector3::zeros(), |s, p| s + p.coords)
        / ring.len() as f64;
    let corners = (0..ring.len()).map(|i| {
        let around = [
            ring[(i + ring.len() - 1) % ring.len()],
            ring[i],
            ring[(i + 1) % ring.len()],
        ];
        Point3::from(
            around
                .iter()
                .fold(nalgebra::Vector3::zeros(), |s, p| s + p.coords)
                / 3.0,
        )
    });
    std::iter::once(Point3::from(mean))
        .chain(corners)
        .find(|p| contains(plan_sides(ring), &p.xy()))
        .expect("every polygon has an ear")
}
