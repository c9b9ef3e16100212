//! `ridgeline reconstruct`: folder in, folder out.

use std::fs;
use std::sync::Arc;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use ridgeline::params::Params;
use ridgeline::pipeline::{Run, Stage};
use ridgeline::progress::Listener;
use ridgeline::scene_loader::{LoadOptions, load_scene};

use super::{Failure, ReconstructArgs, files, table};

/// Steps of the progress bar per stage.
const BAR_STEPS: f64 = 100.0;

/// Reads the scene, runs every stage, writes the results and prints a summary.
pub(super) fn reconstruct(args: &ReconstructArgs) -> Result<(), Failure> {
    let mut params = read_params(args)?;
    if let Some(method) = args.method {
        params.method = method.into();
    }
    make_folder(args)?;
    set_threads(args);
    let start = Instant::now();
    let input = files::read_scene(&args.scene)?;
    let options = LoadOptions {
        orientation: args.orientation.clone(),
        views: args.views.clone(),
        roi: args.roi,
        ground_z: args.ground_z,
        epsg: args.crs,
        memory_mb: args.memory,
        apply_fix: args.apply_fix,
        adjust: args.adjust,
    };
    let scene = load_scene(&input, &options).map_err(|e| Failure::Input(e.to_string()))?;
    drop(input);
    let load_seconds = start.elapsed().as_secs_f64();

    let mut run = Run::new(scene, params);
    let seconds = run_stages(&mut run);
    let written = run.files(&seconds);
    files::write_all(&args.out, &written)?;
    print!(
        "{}",
        table::summary(&run, load_seconds, &seconds, &written, &args.out)
    );
    Ok(())
}

fn read_params(args: &ReconstructArgs) -> Result<Params, Failure> {
    let Some(path) = &args.params else {
        return Ok(Params::default());
    };
    let bad = |problem: String| Failure::Input(format!("{}: {problem}", path.display()));
    let text = fs::read_to_string(path).map_err(|e| bad(format!("cannot read: {e}")))?;
    serde_json::from_str(&text).map_err(|e| {
        bad(format!(
            "{e}; `ridgeline params` prints all parameters with their defaults"
        ))
    })
}

fn make_folder(args: &ReconstructArgs) -> Result<(), Failure> {
    fs::create_dir_all(&args.out).map_err(|e| {
        Failure::Input(format!(
            "{}: cannot be made: {e}; give --out a folder that can be written",
            args.out.display()
        ))
    })
}

fn set_threads(args: &ReconstructArgs) {
    if let Some(threads) = args.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads.into())
            .build_global()
            .expect("the pool is set once, before its first use");
    }
}

/// Runs the stages under a progress bar (which indicatif hides away from a terminal); seconds each.
fn run_stages(run: &mut Run) -> Vec<(Stage, f64)> {
    let stages = run.stages();
    let bar = ProgressBar::new(stages.len() as u64 * BAR_STEPS as u64);
    let style = ProgressStyle::with_template("{msg:12} {bar:40} {elapsed}");
    bar.set_style(style.expect("the template is well formed"));
    let mut seconds = Vec::new();
    for (i, &stage) in stages.iter().enumerate() {
        bar.set_message(stage.name());
        let start = Instant::now();
        let shown = bar.clone();
        let listener: Listener = Arc::new(move |fraction| {
            shown.set_position(((i as f64 + fraction) * BAR_STEPS) as u64);
        });
        run.step(stage, &listener);
        seconds.push((stage, start.elapsed().as_secs_f64()));
    }
    bar.finish_and_clear();
    seconds
}
