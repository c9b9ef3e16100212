//! `ridgeline reconstruct`: folder in, folder out.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use ridgeline::base::agreement::Finding;
use ridgeline::base::execution::progress::Listener;
use ridgeline::orienting::orientation::{FileKind, FileSource, InputFile, Needed};
use ridgeline::orienting::scene::Scene;
use ridgeline::orienting::scene_loader::{
    LoadOptions, MOST_VIEWS, PlannedScene, Project, files_of_ground, files_of_settling,
    inspect_files, settled,
};
use ridgeline::orienting::structure_from_motion::OrientOptions;
use ridgeline::pipeline::{Run, Stage, counted};
use ridgeline::tiles::{Area, CELL_M, refuse_corrections};

use super::args::ReconstructArgs;
use super::failure::Failure;
use super::input::{OpenedScene, open, read_params, refusal};
use super::scene_files::SceneFiles;
use super::{files, orient, table, tiles};

/// The folder below the results with the orientation of photographs that had none.
const ORIENTATION: &str = "orientation";

/// Steps of the progress bar per stage.
const BAR_STEPS: f64 = 100.0;

/// Reads the scene, runs every stage, writes the results and prints a summary.
pub(super) fn reconstruct(args: &ReconstructArgs) -> Result<(), Failure> {
    let params = read_params(&args.input)?;
    make_folder(&args.out)?;
    args.project
        .as_deref()
        .map_or(Ok(()), files::check_writable)?;
    let start = Instant::now();
    let OpenedScene {
        files: mut input,
        options,
        mut params,
        seen,
    } = open(&args.input, params, &args.out)?;
    let refuse = |e: ridgeline::Error| refusal(&e, &seen);
    orient_first(args, &mut input, &options, &seen)?;
    if let Some(method) = args.method {
        params.choose(method);
    }
    if let Some(tile_m) = args.tile {
        let area = Area::plan(&mut input, &options, None, &params, tile_m);
        let area = area.map_err(refuse)?;
        return tiles::reconstruct_tiles(area, &mut input, &args.out, &seen);
    }
    let of_settling = input.hold(&|files| files_of_settling(files, &options));
    of_settling.map_err(refuse)?;
    let options = settled(&input.files, &options);
    let of_ground = input.hold(&|files| files_of_ground(files, &options));
    of_ground.map_err(refuse)?;
    let inspection = inspect_files(&input.files, &options);
    let is_flight = options.roi.is_none() && inspection.views > MOST_VIEWS;
    if is_flight && !options.apply_fix && args.project.is_none() {
        refuse_corrections(&params).map_err(refuse)?;
        // What shows no area that three views share is told by loading it.
        if let Ok(area) = Area::plan(&mut input, &options, None, &params, CELL_M) {
            return tiles::reconstruct_tiles(area, &mut input, &args.out, &seen);
        }
    }
    if inspection.errors.is_empty() {
        println!(
            "{}, about {} MB of memory",
            counted(inspection.views, "views"),
            inspection.peak_mb
        );
    }
    let opened = OpenedScene {
        files: input,
        options,
        params,
        seen,
    };
    reconstruct_whole(args, opened, start)
}

/// Orients photographs that come without an orientation, and adds it to the files. It is written
/// beside the results: another run may name it.
fn orient_first(
    args: &ReconstructArgs,
    input: &mut SceneFiles,
    options: &LoadOptions,
    seen: &str,
) -> Result<(), Failure> {
    if options.orientation.is_some() || !are_photographs_alone(&input.files, options) {
        return Ok(());
    }
    println!("no orientation among the files: the photographs are oriented first");
    let wanted = OrientOptions {
        applies_fix: args.input.apply_fix,
        ..OrientOptions::default()
    };
    let oriented = orient::oriented(input, &wanted, seen)?;
    print!("{}", oriented.report.in_short());
    let written = oriented.files();
    let beside = args.out.join(ORIENTATION);
    make_folder(&beside)?;
    files::write_all(&beside, &written)?;
    if !oriented.report.is_metric {
        let found = ridgeline::Error::scene(
            "the photographs are oriented, but nothing tells their scale",
            "add ground control points (gcp_list.txt), or photographs with positions",
        );
        return Err(refusal(&found, seen));
    }
    let added = written.into_iter();
    let added = added.map(|(name, bytes)| InputFile::new(&format!("{ORIENTATION}/{name}"), bytes));
    input.files.extend(added);
    input.files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(())
}

/// Are there photographs, enough to be oriented, and nothing that is meant to orient them?
fn are_photographs_alone(files: &[InputFile], options: &LoadOptions) -> bool {
    let kinds = || {
        inspect_files(files, options)
            .files
            .into_iter()
            .map(|file| file.kind)
    };
    let is_beside = |kind: FileKind| {
        use FileKind::{Footprints, Ignored, Image, ReferenceSystem, Terrain, UnreadImage};
        matches!(
            kind,
            Footprints | Ignored | Image | ReferenceSystem | Terrain | UnreadImage
        )
    };
    kinds().all(is_beside) && kinds().filter(|kind| *kind == FileKind::Image).count() >= 3
}

/// Reconstructs a scene that is loaded as one.
fn reconstruct_whole(
    args: &ReconstructArgs,
    opened: OpenedScene,
    start: Instant,
) -> Result<(), Failure> {
    let OpenedScene {
        files: mut input,
        options,
        params,
        seen,
    } = opened;
    let refuse = |e: ridgeline::Error| refusal(&e, &seen);
    let planned = PlannedScene::new(&mut input, &options).map_err(refuse)?;
    let scene = planned.load(&input.files).map_err(refuse)?;
    eprintln!("{seen}");
    // Only a project needs the files once more.
    input.hold(&|_| Vec::new()).map_err(refuse)?;
    let input = args.project.as_ref().map(|_| input);
    let is_doubtful = !options.ignore_check && hardly_agrees(&scene);
    let load_seconds = start.elapsed().as_secs_f64();

    let mut run = Run::new(scene, params);
    let seconds = run_stages(&mut run);
    let is_empty = (run.results().roof_model()).is_none_or(|model| model.buildings.is_empty());
    if is_doubtful && is_empty {
        return Err(refuse(shows_nothing()));
    }
    let written = run.files(&seconds);
    files::write_all(&args.out, &written)?;
    if let (Some(path), Some(mut input)) = (&args.project, input) {
        let whole = input.hold(&Needed::all);
        whole.map_err(refuse)?;
        let project = Project::new(options, run.params().clone());
        let packed = project.pack(&input.files, &written);
        files::write_one(path, packed.map_err(|e| Failure::Output(e.to_string()))?)?;
    }
    print!(
        "{}",
        table::summary(&run, load_seconds, &seconds, &written, &args.out)
    );
    Ok(())
}

/// The refusal to write an empty model of images that hardly agree with their orientation.
fn shows_nothing() -> ridgeline::Error {
    ridgeline::Error::scene(
        "the images hardly agree with their orientation, and show no roof with it",
        "check that images and orientation belong together (names, folders, the same \
                 flight), or have the empty model written nevertheless (--ignore-check)",
    )
}

/// Do the images hardly agree with the orientation, though no mistake explains it?
fn hardly_agrees(scene: &Scene) -> bool {
    let report = scene.survey.agreement.as_ref();
    report.is_some_and(|report| report.finding == Finding::Unexplained)
}

fn make_folder(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(|e| {
        Failure::Input(format!(
            "{}: cannot be made: {e}; give --out a folder that can be written",
            path.display()
        ))
    })
}

/// Runs the stages under a progress bar (which indicatif hides where there is no terminal); seconds
/// each.
fn run_stages(run: &mut Run) -> Vec<(Stage, f64)> {
    let stages = run.stages();
    let bar = ProgressBar::new(stages.len() as u64 * BAR_STEPS as u64);
    let style = ProgressStyle::with_template("{msg:12} {bar:40} {elapsed}");
    bar.set_style(style.expect("the template is well formed"));
    let mut seconds = Vec::new();
    for (i, stage) in stages.into_iter().enumerate() {
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
