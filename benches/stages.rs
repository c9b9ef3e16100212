//! Time of every stage on the synthetic L-shaped house, six views of 320 x 320 pixels: `cargo bench
//! --bench stages`; whole runs of scenes are measured by `make bench`. With the folder of a scene
//! in `SCENE`, also its way from images to 3D lines (B99 3), in grey values and with colours.
//! `RAYON_NUM_THREADS=1` makes the times those of one core.
#![allow(missing_docs)] // criterion_group! makes a public function.

use std::path::Path;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use ridgeline::base::execution::progress::silent;
use ridgeline::base::params::Params;
use ridgeline::orienting::orientation::InputFile;
use ridgeline::orienting::scene::Scene;
use ridgeline::orienting::scene_loader::{LoadOptions, load_scene};
use ridgeline::orienting::synthetic::l_scene;
use ridgeline::pipeline::{Run, Stage};

fn stages(c: &mut Criterion) {
    let (scene, _) = l_scene(320);
    let run = Run::new(scene, Params::default());
    let all = run.stages().to_vec();
    time_of(c, "stages", run, &all);
}

/// B99 3 on the scene in `SCENE`; nothing without one.
fn lines(c: &mut Criterion) {
    let Some(folder) = std::env::var_os("SCENE") else {
        return;
    };
    for (kind, colors) in [("in grey values", false), ("with colours", true)] {
        let mut params = Params::default();
        params.segments.colors.detect = colors;
        let run = Run::new(read_scene(folder.as_ref()), params);
        let stages = [Stage::Segments, Stage::Matches, Stage::Lines];
        time_of(c, &format!("lines {kind}"), run, &stages);
    }
}

/// Each stage after those before it.
fn time_of(c: &mut Criterion, name: &str, mut run: Run, stages: &[Stage]) {
    let mut group = c.benchmark_group(name);
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(5));
    for &stage in stages {
        group.bench_function(stage.name(), |b| {
            b.iter_custom(|times| {
                let start = Instant::now();
                for _ in 0..times {
                    run.step(stage, &silent());
                }
                start.elapsed()
            });
        });
    }
    group.finish();
}

/// The photographs and the files beside their folder, as the command line takes them.
fn read_scene(folder: &Path) -> Scene {
    let mut files = Vec::new();
    for part in ["", "images"] {
        let entries = std::fs::read_dir(folder.join(part)).expect("a folder with images/");
        let paths = entries.map(|entry| entry.expect("readable").path());
        for path in paths.filter(|path| path.is_file()) {
            let bytes = std::fs::read(&path).expect("readable");
            files.push(InputFile::new(&path.to_string_lossy(), bytes));
        }
    }
    load_scene(&files, &LoadOptions::default()).expect("a scene")
}

criterion_group!(benches, stages, lines);
criterion_main!(benches);
