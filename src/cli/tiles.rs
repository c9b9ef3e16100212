//! `ridgeline reconstruct --tile M`: a large area, tile by tile, into one model.

use std::path::Path;
use std::time::Instant;

use ridgeline::base::execution::progress::silent;
use ridgeline::tiles::{Area, Tile};

use super::failure::Failure;
use super::files;
use super::input::refusal;
use super::scene_files::SceneFiles;

/// Reconstructs the tiles of an area and writes the results.
pub(super) fn reconstruct_tiles(
    mut area: Area,
    input: &mut SceneFiles,
    out: &Path,
    seen: &str,
) -> Result<(), Failure> {
    let refuse = |e: ridgeline::Error| refusal(&e, seen);
    eprintln!("{seen}");
    println!("{}", area.in_words());
    let start = Instant::now();
    area.look(input, &silent()).map_err(refuse)?;
    let time = start.elapsed().as_secs_f64();
    println!("{} ({time:.1} s)", area.seen_in_words());
    let work: Vec<f64> = area.tiles().iter().map(Tile::looked_at_m2).collect();
    let mut seconds = vec![0.0; work.len()];
    let (mut done, mut worked) = (0, 0.0);
    loop {
        let start = Instant::now();
        let Some((tile, report)) = area.step(input, &silent()).map_err(refuse)? else {
            break;
        };
        let time = start.elapsed().as_secs_f64();
        seconds[tile] = time;
        done += 1;
        worked += work[tile];
        let [spent, all] = [&seconds, &work].map(|part| part.iter().sum::<f64>());
        let left = if worked > 0.0 {
            spent / worked * (all - worked)
        } else {
            0.0
        };
        println!(
            "tile {done} of {}: {} ({time:.1} s{})",
            work.len(),
            report.outcome,
            left_in_words(left)
        );
    }
    let written = area.finish_in_squares(&seconds).map_err(refuse)?;
    files::write_all(out, &written)?;
    println!("written to {}", out.display());
    Ok(())
}

/// How long a run still takes, about.
fn left_in_words(seconds: f64) -> String {
    match (seconds / 60.0).ceil() {
        minutes if minutes <= 0.0 => String::new(),
        minutes if minutes <= 1.0 => "; less than a minute left".to_owned(),
        minutes => format!("; about {minutes:.0} minutes left"),
    }
}
