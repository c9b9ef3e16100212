//! `ridgeline plan`, `tile` and `join`: a large area on many machines. What hands the tiles out,
//! repeats and resumes is an engine of its own (`examples/cluster`); each command is one step for
//! it.

use std::fs;
use std::path::Path;
use std::time::Instant;

use ridgeline::base::execution::progress::silent;
use ridgeline::tiles::{BlockPlan, BlockSource};

use super::args::{InputArgs, JoinArgs, PlanArgs, TileArgs};
use super::failure::Failure;
use super::files;
use super::input::{self, OpenedScene, ReadFiles, refusal};
use super::scene_files::SceneFiles;

/// Writes the plan of a block and says what its tiles need.
pub(super) fn plan(args: &PlanArgs) -> Result<(), Failure> {
    let params = input::read_params(&args.input)?;
    let OpenedScene {
        mut files,
        options,
        mut params,
        seen,
    } = input::open(&args.input, params, &args.out)?;
    if let Some(method) = args.method {
        params.choose(method);
    }
    let InputArgs {
        terrain,
        footprints,
        point_cloud,
        ..
    } = &args.input;
    let known = [terrain, footprints, point_cloud].into_iter().flatten();
    let source = BlockSource {
        scene: args.input.scene.to_string_lossy().into_owned(),
        orientation: args.input.orientation.clone(),
        known: known
            .map(|path| path.to_string_lossy().into_owned())
            .collect(),
    };
    let refuse = |e: ridgeline::Error| refusal(&e, &seen);
    let inputs = files.stamps().map_err(refuse)?;
    let plan = BlockPlan::new(source, &mut files, inputs, &options, &params, args.tile);
    let plan = plan.map_err(refuse)?;
    let text = plan.to_json().map_err(refuse)?;
    eprintln!("{seen}");
    let path = args.out.join(BlockPlan::FILE);
    // An engine goes by the time of the file: what is the same is not written again.
    if fs::read(&path).ok().as_deref() != Some(&text) {
        files::write_durably(&path, &text)?;
    }
    let shown = plan.tiles.iter().filter(|t| t.memory_mb > 0).count();
    let most = plan.tiles.iter().map(|t| t.memory_mb).max().unwrap_or(0);
    println!(
        "{} tiles, {shown} that the views show, at most {most} MB of memory each{}",
        plan.tiles.len(),
        plan.left_out_in_words()
    );
    println!(
        "written to {}; go on with: ridgeline tile {} K, K from 1 to {}, then: ridgeline join {} --out DIR",
        path.display(),
        args.out.display(),
        plan.tiles.len(),
        args.out.display()
    );
    Ok(())
}

/// Makes the part of a tile, unless it is there.
pub(super) fn tile(args: &TileArgs) -> Result<(), Failure> {
    input::set_threads(args.threads);
    let start = Instant::now();
    let (plan, text) = read_plan(&args.plan)?;
    let path = plan.part_path(args.tile).map_err(named)?;
    let path = args.plan.join(path);
    let there = fs::read(&path).ok();
    if let Some(outcome) = there.and_then(|part| plan.outcome_of(&text, args.tile, &part)) {
        println!("tile {}: {outcome} (made before)", args.tile);
        return Ok(());
    }
    let (mut files, seen) = read_inputs(&plan, &args.plan)?;
    let (part, outcome) = plan
        .work_off(&text, args.tile, &mut files, &silent())
        .map_err(|e| refusal(&e, &seen))?;
    files::write_durably(&path, &part)?;
    println!(
        "tile {} of {}: {outcome} ({:.1} s)",
        args.tile,
        plan.tiles.len(),
        start.elapsed().as_secs_f64()
    );
    Ok(())
}

/// Joins all parts and writes the model.
pub(super) fn join(args: &JoinArgs) -> Result<(), Failure> {
    let (plan, text) = read_plan(&args.plan)?;
    let (files, _) = read_inputs(&plan, &args.plan)?;
    let part = |tile: u32| fs::read(args.plan.join(plan.part_path(tile).ok()?)).ok();
    let written = plan.join(&text, &files.files, part).map_err(named)?;
    fs::create_dir_all(&args.out).map_err(|e| {
        Failure::Input(format!(
            "{}: cannot be made: {e}; give --out a folder that can be written",
            args.out.display()
        ))
    })?;
    files::write_all(&args.out, &written)?;
    println!("{} tiles joined", plan.tiles.len());
    println!("written to {}", args.out.display());
    Ok(())
}

/// A plan, and its file as it is.
fn read_plan(folder: &Path) -> Result<(BlockPlan, Vec<u8>), Failure> {
    let path = folder.join(BlockPlan::FILE);
    let text = fs::read(&path).map_err(|e| {
        Failure::Input(format!(
            "{}: cannot be read: {e}; make a plan first (ridgeline plan SCENE --tile M --out {})",
            path.display(),
            folder.display()
        ))
    })?;
    let plan = BlockPlan::from_json(&text).map_err(named)?;
    Ok((plan, text))
}

/// The files that a plan was made from, and a count of what is there now. What is in memory of them
/// is as it was then.
fn read_inputs(plan: &BlockPlan, folder: &Path) -> Result<(SceneFiles, String), Failure> {
    let BlockSource {
        scene,
        orientation,
        known,
    } = &plan.source;
    let read = input::read_files(Path::new(scene), orientation.as_deref(), folder)?;
    let ReadFiles {
        mut files, seen, ..
    } = read;
    let mut inner = std::mem::take(&mut files.files);
    for path in known {
        input::add_known(&mut inner, Path::new(path))?;
    }
    let unchanged = plan.unchanged(inner).map_err(|e| refusal(&e, &seen))?;
    Ok((files.with(unchanged), seen))
}

fn named(error: ridgeline::Error) -> Failure {
    Failure::Input(error.to_string())
}
