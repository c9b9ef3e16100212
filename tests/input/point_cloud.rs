//! Point clouds as evidence for roofs: what photographs do not show is found; clouds that are moved
//! or of another place are named.
#![allow(clippy::disallowed_methods)]

use std::sync::{Arc, OnceLock};

use crate::common::clouds::{is_inside, las, plan, points};
use nalgebra::{Point2, Point3, Vector2};
use ridgeline::base::ids::ProposalOrigin;
use ridgeline::base::params::Params;
use ridgeline::orienting::known::{KnownThing, KnownVerdict, PointCloud};
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene::Scene;
use ridgeline::orienting::scene_loader::{LoadOptions, load_scene};
use ridgeline::orienting::synthetic::{SyntheticTruth, gable_scene, to_files};
use ridgeline::pipeline::{Run, Stage};
use ridgeline::planes::dense::CloudComparison;

const SIZE_PX: u32 = 400;

fn cloud(points: &[Point3<f64>], by: [f64; 3]) -> Option<Arc<PointCloud>> {
    let moved = points
        .iter()
        .map(|p| (p + nalgebra::Vector3::from(by)).cast());
    Some(Arc::new(PointCloud {
        file: "cloud.laz".to_owned(),
        points: moved.collect(),
        accuracy_m: 0.15,
    }))
}

fn files(scene: &Scene) -> Vec<InputFile> {
    (to_files(scene).into_iter())
        .map(|(path, bytes)| InputFile::new(&path, bytes))
        .collect()
}

fn loaded(scene: &Scene) -> Scene {
    load_scene(&files(scene), &LoadOptions::default()).unwrap()
}

/// A gabled house as it is loaded, and what it is, once for all tests.
fn house() -> &'static (Scene, SyntheticTruth) {
    static HOUSE: OnceLock<(Scene, SyntheticTruth)> = OnceLock::new();
    HOUSE.get_or_init(|| {
        let (scene, truth) = gable_scene(SIZE_PX);
        (loaded(&scene), truth)
    })
}

/// What its photographs alone show.
fn without_a_cloud() -> &'static Run {
    static RUN: OnceLock<Run> = OnceLock::new();
    RUN.get_or_init(|| run(&house().0, None))
}

/// Runs all stages up to the facets.
fn run(scene: &Scene, cloud: Option<Arc<PointCloud>>) -> Run {
    let mut scene = scene.clone();
    scene.known.point_cloud = cloud;
    let mut run = Run::new(scene, Params::default());
    run.step(Stage::Facets, &ridgeline::silent());
    run
}

fn comparison(run: &Run) -> &CloudComparison {
    let dense = run.results().dense.as_ref().unwrap();
    dense.trace.point_cloud.as_ref().unwrap()
}

/// Share of the plan of a true facet under facets of its plane.
fn found(run: &Run, truth: &SyntheticTruth, facet: usize) -> f64 {
    let (plane, ring) = &truth.facets[facet];
    let model = run.results().roof_model().unwrap();
    let own: Vec<Vec<Point2<f64>>> = (model.facets.iter())
        .filter(|f| f.plane.angle_to(plane) < 0.05)
        .filter(|f| {
            f.outer
                .iter()
                .all(|p| plane.signed_distance(p).abs() < 0.25)
        })
        .map(|f| plan(&f.outer))
        .collect();
    let ring = plan(ring);
    let places = (-100..100).flat_map(|i| (-100..100).map(move |j| (i, j)));
    let inside: Vec<Point2<f64>> = places
        .map(|(i, j)| Point2::new(f64::from(i) * 0.2, f64::from(j) * 0.2))
        .filter(|p| is_inside(&ring, p))
        .collect();
    let covered = inside
        .iter()
        .filter(|p| own.iter().any(|o| is_inside(o, p)));
    covered.count() as f64 / inside.len() as f64
}

/// The scene with one slope, and what lies around it, in one colour: no photograph shows its plane
/// or its eave.
fn with_a_bare_slope() -> (Scene, SyntheticTruth) {
    let (mut scene, truth) = gable_scene(SIZE_PX);
    let (plane, ring) = &truth.facets[0];
    let middle = ring
        .iter()
        .map(|p| p.coords)
        .sum::<nalgebra::Vector3<f64>>()
        / ring.len() as f64;
    let other = &truth.facets[1].1;
    let far = other
        .iter()
        .map(|p| p.coords)
        .sum::<nalgebra::Vector3<f64>>()
        / other.len() as f64;
    let across: Vector2<f64> = (middle - far).xy().normalize();
    let along = Vector2::new(-across.y, across.x);
    // From the ridge on, to the borders of the photographs: a border in them would lie in a plane.
    let ridge = (middle + far) * 0.5;
    let corner = |t: f64, u: f64| {
        let p = ridge.xy() + along * t + across * u;
        plane.lift(p.x, p.y)
    };
    let reach = |d: &Vector2<f64>| {
        let at = ring
            .iter()
            .map(|p| (p.xy() - Point2::from(ridge.xy())).dot(d));
        at.fold(0.0, f64::max)
    };
    let (t, u) = (reach(&along) + 40.0, reach(&across) + 40.0);
    let bare = [corner(-t, 0.0), corner(t, 0.0), corner(t, u), corner(-t, u)];
    for view in &mut scene.views {
        let image: Vec<Point2<f64>> = (bare.iter())
            .map(|p| view.camera.project(p).unwrap())
            .collect();
        for (column, row, pixel) in view.rgb.enumerate_pixels_mut() {
            let at = Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            if is_inside(&image, &at) {
                *pixel = image::Rgb([150, 110, 100]);
            }
        }
    }
    (scene, truth)
}

#[test]
fn a_slope_that_no_photograph_shows_is_found_by_the_cloud() {
    let (scene, truth) = with_a_bare_slope();
    let scene = loaded(&scene);
    let without = run(&scene, None);
    assert!(
        found(&without, &truth, 0) < 0.3,
        "{}",
        found(&without, &truth, 0)
    );
    let with = run(&scene, cloud(&points(&truth), [0.0; 3]));
    assert!(comparison(&with).counts());
    let shares = [0, 1].map(|facet| found(&with, &truth, facet));
    assert!(shares.iter().all(|share| *share > 0.85), "{shares:?}");
    let model = with.results().roof_model().unwrap();
    let of_cloud = |f: &&ridgeline::roofs::model::Facet| {
        (f.proposals.iter()).any(|p| matches!(p, ProposalOrigin::CloudPlane(_)))
    };
    assert!(model.facets.iter().any(|f| of_cloud(&f)));
}

#[test]
fn a_moved_cloud_is_named_and_moved_back() {
    let (scene, truth) = house();
    let points = points(truth);
    let right = run(scene, cloud(&points, [0.0; 3]));
    assert_eq!(comparison(&right).compared.verdict, KnownVerdict::Used);
    assert!(comparison(&right).compared.belongs > 0.95);
    for by in [[0.8, 0.6, 0.0], [0.0, 0.0, 46.2], [-1.2, 0.5, -31.0]] {
        let moved = run(scene, cloud(&points, by));
        let found = comparison(&moved);
        assert_eq!(found.compared.verdict, KnownVerdict::Moved, "{found:?}");
        // Along the ridge only the verges tell.
        for ((moved, by), within) in found.compared.moved_m().iter().zip(by).zip([0.4, 0.4, 0.1]) {
            assert!((moved + by).abs() < within, "{found:?}");
        }
        assert!(
            found
                .compared
                .warning(KnownThing::PointCloud)
                .unwrap()
                .contains("was moved by")
        );
        for facet in [0, 1] {
            assert!(self::found(&moved, truth, facet) > 0.9);
        }
    }
}

#[test]
fn a_cloud_of_another_place_is_left_out_and_changes_nothing() {
    let (scene, truth) = house();
    // The house stands 14 m away there, and another one higher and turned.
    let elsewhere = |p: &Point3<f64>| Point3::new(p.y + 9.0, 11.0 - p.x, 1.3 * p.z);
    let foreign: Vec<Point3<f64>> = points(truth).iter().map(elsewhere).collect();
    let with = run(scene, cloud(&foreign, [0.0; 3]));
    let found = comparison(&with);
    assert_eq!(
        found.compared.verdict,
        KnownVerdict::Contradicted,
        "{found:?}"
    );
    assert!(
        found
            .compared
            .warning(KnownThing::PointCloud)
            .unwrap()
            .contains("contradict")
    );
    let models = [without_a_cloud(), &with].map(|run| run.results().roof_model().unwrap());
    assert_eq!(models[0], models[1]);
}

#[test]
fn clouds_of_few_points_do_nothing() {
    let (scene, truth) = house();
    for few in [0, 1, 20] {
        let some: Vec<Point3<f64>> = points(truth).into_iter().take(few).collect();
        let with = run(scene, cloud(&some, [0.0; 3]));
        assert_eq!(comparison(&with).compared.verdict, KnownVerdict::Elsewhere);
        let models = [without_a_cloud(), &with].map(|run| run.results().roof_model().unwrap());
        assert_eq!(models[0], models[1]);
    }
}

#[test]
fn a_file_among_the_photographs_is_terrain_and_roofs_unless_it_has_no_ground() {
    let (scene, truth) = gable_scene(SIZE_PX);
    let all = points(&truth);
    let loaded = |bytes: Vec<u8>, options: &LoadOptions| {
        let mut files = files(&scene);
        files.push(InputFile::new("cloud.las", bytes));
        load_scene(&files, options)
    };
    let is_ground = |p: &Point3<f64>| (p.z - truth.ground_z).abs() < 0.1;
    let none = LoadOptions::default();
    let both = loaded(las(&all, is_ground), &none).unwrap();
    assert!(both.known.terrain.is_some());
    let cloud = both.known.point_cloud.as_ref().unwrap();
    assert!(cloud.points.len() > all.len() / 2);
    let roofs = loaded(las(&all, |_| false), &none).unwrap();
    assert!(roofs.known.terrain.is_none() && roofs.known.point_cloud.is_some());
    let warned = |scene: &Scene, what: &str| scene.warnings.iter().any(|w| w.contains(what));
    assert!(
        warned(&roofs, "classified as ground"),
        "{:?}",
        roofs.warnings
    );
    let unused = LoadOptions {
        unused: vec!["cloud.las".to_owned()],
        ..LoadOptions::default()
    };
    let neither = loaded(las(&all, is_ground), &unused).unwrap();
    assert!(neither.known.terrain.is_none() && neither.known.point_cloud.is_none());
    let named = LoadOptions {
        point_cloud: Some("cloud.las".to_owned()),
        point_cloud_accuracy_m: Some(0.4),
        ..LoadOptions::default()
    };
    let stated = loaded(las(&all, is_ground), &named).unwrap();
    assert_eq!(stated.known.point_cloud.unwrap().accuracy_m, 0.4);
    // Empty, cut and damaged ones.
    let empty = loaded(las(&[], is_ground), &none).unwrap();
    assert!(empty.known.point_cloud.unwrap().points.is_empty());
    let mut cut = las(&all, is_ground);
    cut.truncate(5000);
    assert!(loaded(cut.clone(), &named).is_err());
    // What lies there by chance refuses nothing.
    let left_out = loaded(cut, &none).unwrap();
    assert!(left_out.known.point_cloud.is_none());
    let mut scale = las(&all, is_ground);
    scale[131..139].copy_from_slice(&f64::NAN.to_le_bytes());
    assert!(
        loaded(scale, &named)
            .unwrap_err()
            .to_string()
            .contains("no number")
    );
    let text = LoadOptions {
        point_cloud: Some("none.las".to_owned()),
        ..LoadOptions::default()
    };
    assert!(loaded(las(&all, is_ground), &text).is_err());
}

#[test]
fn of_a_large_cloud_only_what_the_photographs_show_is_kept() {
    let (scene, truth) = gable_scene(SIZE_PX);
    let mut all = points(&truth);
    let here = all.len();
    // A grid of points over square kilometres around.
    let far = (-40..=40).flat_map(|i| (-40..=40).map(move |j| [i, j].map(|n| 50.0 * f64::from(n))));
    all.extend(far.map(|[x, y]| Point3::new(x, y, truth.ground_z)));
    let kept = |roi: Option<[f64; 4]>| {
        let mut files = files(&scene);
        files.push(InputFile::new("cloud.las", las(&all, |_| false)));
        let options = LoadOptions {
            roi,
            ..LoadOptions::default()
        };
        let loaded = load_scene(&files, &options).unwrap();
        let cloud = loaded.known.point_cloud.as_ref().unwrap();
        let reach = |p: &Point3<f32>| {
            let world = p.cast::<f64>() + loaded.origin;
            world.x.abs().max(world.y.abs())
        };
        let reach = cloud.points.iter().map(reach).fold(0.0, f64::max);
        (cloud.points.len(), reach)
    };
    // The house's frames show some tens of metres of ground, and 30 m around them may count.
    let (count, reach) = kept(None);
    assert!(count > here / 3 && count < here + 200, "{count} of {here}");
    assert!(reach > 30.0 && reach < 200.0, "{reach}");
    // A region of interest bounds it further.
    let (_, reach) = kept(Some([-5.0, -5.0, 5.0, 5.0]));
    assert!(reach < 35.01, "{reach}");
}

#[test]
fn beside_a_grid_a_cloud_is_roofs_only_and_of_several_none_is_taken() {
    let (scene, truth) = gable_scene(SIZE_PX);
    let all = points(&truth);
    let is_ground = |p: &Point3<f64>| (p.z - truth.ground_z).abs() < 0.1;
    let grid = format!(
        "ncols 40\nnrows 40\nxllcorner -40\nyllcorner -40\ncellsize 2\n{}",
        format!("{} ", truth.ground_z).repeat(1600)
    );
    let loaded = |names: &[&str], options: &LoadOptions| {
        let mut files = files(&scene);
        for name in names {
            let bytes = match name.ends_with(".las") {
                true => las(&all, is_ground),
                false => grid.clone().into_bytes(),
            };
            files.push(InputFile::new(name, bytes));
        }
        load_scene(&files, options).unwrap()
    };
    let none = LoadOptions::default();
    let both = loaded(&["cloud.las", "ground.asc"], &none);
    assert_eq!(both.known.terrain.as_ref().unwrap().file, "ground.asc");
    assert_eq!(both.known.point_cloud.as_ref().unwrap().file, "cloud.las");
    // With its height given, the ground is not asked for; the clouds are named all the same.
    for ground_z in [None, Some(truth.ground_z)] {
        let options = LoadOptions {
            ground_z,
            ..LoadOptions::default()
        };
        let several = loaded(&["a.las", "b.las"], &options);
        assert!(several.known.terrain.is_none() && several.known.point_cloud.is_none());
        let said = several
            .warnings
            .iter()
            .filter(|w| w.contains("name the one"));
        assert_eq!(said.count(), 1, "{:?}", several.warnings);
    }
}

#[test]
fn shares_of_all_and_nothing_and_no_error_at_all_give_numbers() {
    let (scene, truth) = house();
    let mut params = Params::default();
    params.point_cloud.belongs = 1.0;
    params.point_cloud.agreement = 1.0;
    params.point_cloud.chance = 0.0;
    params.point_cloud.place_sigma_m = 0.0;
    let mut scene = scene.clone();
    let exact = PointCloud {
        accuracy_m: 0.0,
        ..(*cloud(&points(truth), [0.0; 3]).unwrap()).clone()
    };
    scene.known.point_cloud = Some(Arc::new(exact));
    let mut run = Run::new(scene, params);
    run.step(Stage::Facets, &ridgeline::silent());
    assert!((0.0..=1.0).contains(&comparison(&run).compared.belongs));
    let model = run.results().roof_model().unwrap();
    let is_number = |f: &ridgeline::roofs::model::Facet| f.probability.is_finite();
    assert!(model.facets.iter().all(is_number));
}
