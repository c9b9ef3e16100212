//! Draws a house of which every corner is known, reconstructs it from its six photographs, and says
//! how far off the model is: `cargo run --release --example recover_house`.
#![allow(clippy::print_stdout, clippy::print_stderr, clippy::disallowed_methods)]

use ridgeline::orienting::synthetic::gable_scene;
use ridgeline::{Params, Run};

/// Side of the photographs, pixels.
const SIZE_PX: u32 = 320;

fn main() {
    let (scene, truth) = gable_scene(SIZE_PX);
    let mut run = Run::new(scene, Params::default());
    run.run_all();
    let model = run.results().roof_model().expect("all stages have run");

    println!(
        "{} facets drawn, {} found",
        truth.facets.len(),
        model.facets.len()
    );
    for (plane, corners) in &truth.facets {
        // The facet whose plane runs closest to the drawn corners.
        let farthest = |facet: &&ridgeline::roofs::model::Facet| {
            let distances = corners.iter().map(|c| facet.plane.signed_distance(c).abs());
            distances.fold(0.0, f64::max)
        };
        let nearest = model
            .facets
            .iter()
            .min_by(|a, b| farthest(a).total_cmp(&farthest(b)));
        let Some(facet) = nearest else {
            println!("a facet was not found");
            continue;
        };
        let turn = facet.plane.normal.dot(&plane.normal).min(1.0).acos();
        println!(
            "plane within {:.3} m of the drawn corners, turned by {:.2} degrees; {} corners for {}",
            farthest(&facet),
            turn.to_degrees(),
            facet.outer.len(),
            corners.len()
        );
    }
}
