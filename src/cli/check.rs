//! `ridgeline check`: the orientation check without a reconstruction.

use std::path::Path;

use nalgebra::Matrix3;
use ridgeline::Error;
use ridgeline::base::agreement::{AgreementReport, Finding};
use ridgeline::base::execution::progress::silent;
use ridgeline::orienting::orientation::FileSource;
use ridgeline::orienting::scene_loader::PlannedScene;
use ridgeline::pipeline::{Run, Stage};
use serde_json::{Value, json};

use super::args::CheckArgs;
use super::failure::Failure;
use super::input;

/// Loads the scene, adjusts its views as a run would, and prints what was found; a scene that is
/// refused is a failure as anywhere.
pub(super) fn check(args: &CheckArgs) -> Result<(), Failure> {
    let params = input::read_params(&args.input)?;
    let mut opened = input::open(&args.input, params, Path::new(""))?;
    let planned = PlannedScene::new(&mut opened.files, &opened.options);
    let outcome = planned.and_then(|planned| planned.load(opened.files.files()));
    let outcome = outcome.map(|scene| {
        let mut run = Run::new(scene, opened.params);
        if run.stages().contains(&Stage::Adjustment) {
            run.step(Stage::Adjustment, &silent());
        }
        run
    });
    if args.json {
        let json = match &outcome {
            Ok(run) => of_run(run),
            Err(error) => of_refusal(error),
        };
        println!("{json:#}");
    } else if let Ok(run) = &outcome {
        print!("{}", words(run));
    }
    outcome.map_err(|error| input::refusal(&error, &opened.seen))?;
    eprintln!("{}", opened.seen);
    Ok(())
}

/// The findings, and the cameras as they are used: an orientation file of its own (docs/formats.md,
/// K, R, C).
fn of_run(run: &Run) -> Value {
    let scene = run.scene();
    let views = scene.views.iter().enumerate().map(|(i, view)| {
        let camera = &view.camera;
        let rows = |m: &Matrix3<f64>| [0, 1, 2].map(|i| [m[(i, 0)], m[(i, 1)], m[(i, 2)]]);
        json!({
            "file": view.name,
            "width": camera.width,
            "height": camera.height,
            "K": rows(&camera.k),
            "R": rows(&camera.r),
            "C": camera.center.coords.as_slice(),
            "shift": scene.survey.shifts.get(i),
            "adjustment": scene.survey.adjustments.get(i),
        })
    });
    json!({
        "agreement": scene.survey.agreement,
        "origin": scene.origin.as_slice(),
        "views": views.collect::<Vec<_>>(),
        "warnings": warnings(run),
    })
}

fn of_refusal(error: &Error) -> Value {
    let report = match error {
        Error::Contradiction { report, .. } => Some(report),
        _ => None,
    };
    json!({ "agreement": report, "refusal": error.to_string() })
}

/// The findings as text.
fn words(run: &Run) -> String {
    let scene = run.scene();
    let mut text = scene
        .survey
        .agreement
        .as_ref()
        .map_or_else(String::new, found);
    if !scene.survey.shifts.is_empty() {
        text += "view                       shift x, y (px)   sigma   residual before, after (px)   places\n";
    }
    for (view, s) in scene.views.iter().zip(&scene.survey.shifts) {
        let [x, y] = s.shift_px;
        text += &format!(
            "{:<24}{x:>10.2}{y:>8.2}{:>8.2}{:>16.2}{:>8.2}{:>14}\n",
            view.name, s.sigma_px, s.before_px, s.after_px, s.places
        );
    }
    for warning in warnings(run) {
        text += &format!("warning: {warning}\n");
    }
    text
}

/// Those of the readers, and of the adjustment: of the other stages only a whole run tells.
fn warnings(run: &Run) -> Vec<&String> {
    let of_run = run.summaries().iter();
    let adjustment = of_run.filter(|summary| summary.stage == Stage::Adjustment);
    let found = adjustment.flat_map(|summary| &summary.warnings);
    run.scene().warnings.iter().chain(found).collect()
}

fn found(report: &AgreementReport) -> String {
    let finding = match report.finding {
        Finding::Sound => "images and orientation agree",
        Finding::Unknown => "the images show too little to tell",
        Finding::Explained => "images and orientation do not agree, and the mistake is known",
        Finding::Offset => "images and orientation agree, except for half a pixel",
        Finding::OutlierViews => "some views agree with no other one",
        Finding::Unexplained => {
            "images and orientation do not agree, and no usual mistake explains it"
        }
    };
    let score = report.stated.score;
    format!("{finding}: {score:.2}, where 0 is chance and 1 perfect\n")
}
