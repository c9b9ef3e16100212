//! `ridgeline check`: the orientation check without a reconstruction.

use std::path::Path;

use nalgebra::Matrix3;
use ridgeline::Error;
use ridgeline::agreement::{AgreementReport, Finding};
use ridgeline::pipeline::load_adjusted;
use ridgeline::scene::Scene;
use serde_json::{Value, json};

use super::args::CheckArgs;
use super::failure::Failure;
use super::input;

/// Loads the scene and prints what the orientation check found; a scene that is refused is a
/// failure as anywhere.
pub(super) fn check(args: &CheckArgs) -> Result<(), Failure> {
    let params = input::read_params(&args.input)?;
    let opened = input::open(&args.input, params, Path::new(""))?;
    let outcome = load_adjusted(&opened.files, &opened.options, &opened.params);
    if args.json {
        let json = match &outcome {
            Ok(scene) => of_scene(scene),
            Err(error) => of_refusal(error),
        };
        println!("{json:#}");
    } else if let Ok(scene) = &outcome {
        print!("{}", words(scene));
    }
    outcome.map_err(|error| input::refusal(&error, &opened.seen))?;
    eprintln!("{}", opened.seen);
    Ok(())
}

/// The findings, and the cameras as they are used: an orientation file of its own (docs/formats.md,
/// K, R, C).
fn of_scene(scene: &Scene) -> Value {
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
        "doctor": scene.survey.agreement,
        "origin": scene.origin.as_slice(),
        "views": views.collect::<Vec<_>>(),
        "warnings": scene.warnings,
    })
}

fn of_refusal(error: &Error) -> Value {
    let report = match error {
        Error::Contradiction { report, .. } => Some(report),
        _ => None,
    };
    json!({ "doctor": report, "refusal": error.to_string() })
}

/// The findings as text.
fn words(scene: &Scene) -> String {
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
    for warning in &scene.warnings {
        text += &format!("warning: {warning}\n");
    }
    text
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
