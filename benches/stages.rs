//! Time of every stage on the synthetic L-shaped house, six views of 320 x 320 pixels: `make bench`.
#![allow(missing_docs)] // criterion_group! makes a public function.

use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use ridgeline::params::Params;
use ridgeline::pipeline::Run;
use ridgeline::progress::silent;
use ridgeline::synthetic::l_scene;

fn stages(c: &mut Criterion) {
    let (scene, _) = l_scene(320);
    let mut run = Run::new(scene, Params::default());
    let mut group = c.benchmark_group("stages");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(5));
    for &stage in run.stages().to_vec().iter() {
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

criterion_group!(benches, stages);
criterion_main!(benches);
