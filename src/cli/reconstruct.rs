//! `ridgeline reconstruct`: folder in, folder out.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use ridgeline::execution::progress::Listener;
use ridgeline::orientation::InputFile;
use ridgeline::params::Params;
use ridgeline::pipeline::{Run, Stage, load_adjusted};
use ridgeline::scene_loader::{LoadOptions, Project, inspect_files, open_project};

use super::{Failure, InputArgs, ReconstructArgs, files, table, tiles};

/// Steps of the progress bar per stage.
const BAR_STEPS: f64 = 100.0;

/// Reads the scene, runs every stage, writes the results and prints a summary.
pub(super) fn reconstruct(args: &ReconstructArgs) -> Result<(), Failure> {
    let params = read_params(&args.input)?;
    make_folder(args)?;
    args.project
        .as_deref()
        .map_or(Ok(()), files::check_writable)?;
    let start = Instant::now();
    let Opened {
        files: input,
        options,
        mut params,
        seen,
    } = open(&args.input, params, &args.out)?;
    if let Some(method) = args.method {
        params.method = method.into();
    }
    if let Some(tile_m) = args.tile {
        return tiles::reconstruct_tiles(&input, &options, &params, tile_m, &args.out, &seen);
    }
    let inspection = inspect_files(&input, &options);
    if inspection.errors.is_empty() {
        println!(
            "{} views, about {} MB of memory",
            inspection.views, inspection.peak_mb
        );
    }
    let scene = load_adjusted(&input, &options, &params);
    let scene = scene.map_err(|e| refusal(&e, &seen))?;
    eprintln!("{seen}");
    // Only a project needs the files once more.
    let input = args.project.as_ref().map(|_| input);
    let load_seconds = start.elapsed().as_secs_f64();

    let mut run = Run::new(scene, params);
    let seconds = run_stages(&mut run);
    let written = run.files(&seconds);
    files::write_all(&args.out, &written)?;
    if let (Some(path), Some(input)) = (&args.project, input) {
        let project = Project::new(options, run.params().clone());
        let packed = project.pack(&input, &written);
        files::write_one(path, packed.map_err(|e| Failure::Output(e.to_string()))?)?;
    }
    print!(
        "{}",
        table::summary(&run, load_seconds, &seconds, &written, &args.out)
    );
    Ok(())
}

/// A scene's files and what is wanted of them.
pub(super) struct Opened {
    pub files: Vec<InputFile>,
    pub options: LoadOptions,
    pub params: Params,
    /// What the files are, in a sentence.
    pub seen: String,
}

/// A refusal of a scene, with what was seen of it.
pub(super) fn refusal(error: &ridgeline::Error, seen: &str) -> Failure {
    Failure::Input(format!("{error}\n{seen}"))
}

/// Reads the files. What the arguments leave out is as in the project, where one is opened.
pub(super) fn open(
    args: &InputArgs,
    params: Option<Params>,
    results: &Path,
) -> Result<Opened, Failure> {
    set_threads(args);
    let (files, seen) = files::read_scene(&args.scene, results)?;
    for notice in seen.notices() {
        eprintln!("warning: {notice}");
    }
    let seen = format!("{} holds {seen}", args.scene.display());
    let (files, project) = open_project(files).map_err(|e| refusal(&e, &seen))?;
    let project = project.unwrap_or_default();
    let stated = project.options;
    let options = LoadOptions {
        orientation: args
            .orientation
            .as_deref()
            .map(|path| below(&args.scene, path))
            .or(stated.orientation),
        views: args.views.clone().or(stated.views),
        roi: args.roi.or(stated.roi),
        ground_z: args.ground_z.or(stated.ground_z),
        epsg: args.crs.or(stated.epsg),
        memory_mb: args.memory.or(stated.memory_mb),
        apply_fix: args.apply_fix || stated.apply_fix,
        adjust: args.adjust || stated.adjust,
    };
    Ok(Opened {
        files,
        options,
        params: params.unwrap_or(project.params),
        seen,
    })
}

/// A path as it stands in the scene's folder, also where the whole path was given.
fn below(scene: &Path, path: &str) -> String {
    let inner = Path::new(path).strip_prefix(scene);
    inner.map_or_else(
        |_| path.to_owned(),
        |inner| inner.to_string_lossy().into_owned(),
    )
}

/// The parameters of `--params`.
pub(super) fn read_params(args: &InputArgs) -> Result<Option<Params>, Failure> {
    let Some(path) = &args.params else {
        return Ok(None);
    };
    let bad = |problem: String| Failure::Input(format!("{}: {problem}", path.display()));
    let text = fs::read_to_string(path).map_err(|e| bad(format!("cannot read: {e}")))?;
    ridgeline::plain_json::read(&text).map(Some).map_err(|e| {
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

fn set_threads(args: &InputArgs) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_path_counts_from_the_scene() {
        let scene = Path::new("data/scene");
        assert_eq!(below(scene, "data/scene/a/cameras.json"), "a/cameras.json");
        assert_eq!(below(scene, "cameras.json"), "cameras.json");
        assert_eq!(below(scene, "data/scenery/a.json"), "data/scenery/a.json");
    }
}
