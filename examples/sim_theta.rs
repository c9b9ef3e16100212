//! Runs the stages up to the half-planes of a synthetic house, and draws `Sim(theta)` of the line
//! side that is known best from the stage's trace (B99 4.1, figure 12):
//! `cargo run --release --example sim_theta`.
#![allow(clippy::print_stdout, clippy::print_stderr, clippy::disallowed_methods)]

use ridgeline::orienting::synthetic::gable_scene;
use ridgeline::{Params, Run, Stage, silent};

/// Side of the photographs, pixels.
const SIZE_PX: u32 = 320;
/// Width of the plot, characters.
const WIDTH: f64 = 60.0;

fn main() {
    let (scene, _) = gable_scene(SIZE_PX);
    let mut run = Run::new(scene, Params::default());
    let summary = run.step(Stage::HalfPlanes, &silent());
    println!("{summary:?}\n");

    let stage = run
        .results()
        .half_planes
        .as_ref()
        .expect("the stage has run");
    let best = stage
        .value
        .iter()
        .max_by(|a, b| a.curvature.total_cmp(&b.curvature));
    let Some(best) = best else {
        println!("no side of a line has a half-plane");
        return;
    };
    let side = (stage.trace.sides.iter())
        .find(|side| side.line == best.line && side.side == best.side)
        .expect("every half-plane has its trace");
    println!(
        "line {}, {:?} side: theta = {:.1} degrees, sigma {:.2} degrees",
        best.line.0,
        best.side,
        best.theta.to_degrees(),
        best.sigma_theta.to_degrees()
    );
    for (theta, sim) in side.curve.thetas.iter().zip(&side.curve.similarity) {
        let bar = "#".repeat((sim * WIDTH) as usize);
        println!("{:6.1} {sim:.3} {bar}", theta.to_degrees());
    }
}
