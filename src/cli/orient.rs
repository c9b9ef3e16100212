//! `ridgeline orient`: photographs in, their orientation out; with `--check` the control sheet.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use indicatif::{ProgressBar, ProgressStyle};
use ridgeline::base::execution::progress::{Listener, with_listener};
use ridgeline::orienting::orientation::{FileSource, InputFile, Needed};
use ridgeline::orienting::structure_from_motion::{
    ControlSheet, FeatureOptions, GroundControl, OrientOptions, Oriented, orient as orient_photos,
};

use super::args::OrientArgs;
use super::failure::Failure;
use super::scene_files::SceneFiles;
use super::{files, input};

/// Steps of the progress bar.
const BAR_STEPS: f64 = 1000.0;

/// Reads the photographs, orients them and writes COLMAP's text model and the report.
pub(super) fn orient(args: &OrientArgs) -> Result<(), Failure> {
    let Some(out) = &args.out else {
        print!("{}", finished_sheet(&args.photos)?);
        return Ok(());
    };
    fs::create_dir_all(out).map_err(|e| {
        Failure::Input(format!(
            "{}: cannot be made: {e}; give --out a folder that can be written",
            out.display()
        ))
    })?;
    input::set_threads(args.threads);
    let (mut read, seen) = files::read_scene(&args.photos, out)?;
    for notice in seen.notices() {
        eprintln!("warning: {notice}");
    }
    let seen = format!("{} holds {seen}", args.photos.display());
    if let Some(path) = &args.gcp {
        let list = fs::read(path).map_err(|e| {
            Failure::Input(format!(
                "{}: cannot be read: {e}; give --gcp a list of ground control points",
                path.display()
            ))
        })?;
        let is_list = |file: &InputFile| file.name().eq_ignore_ascii_case(GroundControl::FILE);
        read.files.retain(|file| !is_list(file));
        read.files.push(InputFile::new(GroundControl::FILE, list));
    }
    let defaults = FeatureOptions::default();
    let options = OrientOptions {
        features: FeatureOptions {
            working_px: args.working_size.map_or(defaults.working_px, usize::from),
            most: args.features.map_or(defaults.most, usize::from),
        },
        focal_px: args.focal,
        holds_center: args.hold_center,
        applies_fix: args.apply_fix,
    };
    let oriented = oriented(&mut read, &options, &seen)?;
    eprintln!("{seen}");
    files::write_all(out, &oriented.files())?;
    let report = &oriented.report;
    match args.check {
        true => print!("{}", sheet(&report.to_json()).unwrap_or_default()),
        false => print!("{}", report.to_text()),
    }
    let epsg =
        (oriented.report.epsg).map_or_else(String::new, |code| format!(" --crs EPSG:{code}"));
    println!(
        "written to {}; go on with: ridgeline reconstruct {} --orientation {}{epsg} --out MODEL",
        out.display(),
        args.photos.display(),
        out.display()
    );
    Ok(())
}

/// The report of an orientation, in its folder.
const REPORT: &str = "orientation.json";

/// The control sheet of a report as JSON.
fn sheet(json: &str) -> Option<String> {
    Some(ControlSheet::of_json(json)?.to_text())
}

/// That of an orientation that is finished: its folder, or the report itself.
fn finished_sheet(path: &Path) -> Result<String, Failure> {
    let path = match path.is_dir() {
        true => path.join(REPORT),
        false => path.to_owned(),
    };
    let refused = |problem: String| {
        let advice = "give the folder that `ridgeline orient PHOTOS --out DIR` wrote, or photographs \
                      with --out";
        Failure::Input(format!("{}: {problem}; {advice}", path.display()))
    };
    let json = fs::read_to_string(&path).map_err(|e| refused(format!("cannot be read: {e}")))?;
    sheet(&json).ok_or_else(|| refused("is no report of an orientation".to_owned()))
}

/// Orients all photographs of a folder under a progress bar; `seen` counts its files. Of the
/// photographs the heads are in memory afterwards.
pub(super) fn oriented(
    read: &mut SceneFiles,
    options: &OrientOptions,
    seen: &str,
) -> Result<Oriented, Failure> {
    let refuse = |e: ridgeline::Error| input::refusal(&e, seen);
    // All of them are matched.
    let whole = read.hold(&Needed::all);
    whole.map_err(refuse)?;
    let bar = ProgressBar::new(BAR_STEPS as u64);
    let style = ProgressStyle::with_template("{msg:12} {bar:40} {elapsed}");
    bar.set_style(style.expect("the template is well formed"));
    let shown = bar.clone();
    let listener: Listener = Arc::new(move |fraction| {
        shown.set_message(step_at(fraction));
        shown.set_position((fraction * BAR_STEPS) as u64);
    });
    let oriented = with_listener(listener, || orient_photos(&read.files, options));
    bar.finish_and_clear();
    read.hold(&|_| Vec::new()).map_err(refuse)?;
    oriented.map_err(refuse)
}

/// What is done at a fraction of the work.
fn step_at(fraction: f64) -> &'static str {
    match fraction {
        f if f < 0.4 => "features",
        f if f < 0.62 => "matches",
        f if f < 0.7 => "pairs",
        f if f < 0.9 => "poses",
        _ => "adjustment",
    }
}
