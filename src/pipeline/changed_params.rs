//! What new parameters leave of the results.

use super::{Run, Stage};
use crate::base::execution::progress::silent;
use crate::base::params::{Method, Params};
use crate::orienting::synthetic::l_scene;

/// A stage that reads a parameter and does not say so keeps a result of the old value.
#[test]
fn new_parameters_of_roofs_give_what_a_new_run_gives() {
    let (scene, _) = l_scene(320);
    let mut before = Run::new(scene, Params::default());
    before.step(Stage::Dense, &silent());
    let mut done = before.clone();
    done.step(Stage::Refinement, &silent());
    let found = |mut run: Run, params: &Params| {
        run.set_params(params.clone());
        run.step(Stage::Refinement, &silent());
        let results = run.results();
        let groups = &results.groups.as_ref().unwrap().trace;
        let facets = &results.facets.as_ref().unwrap().trace;
        let refined = results.refinement.as_ref().unwrap();
        let traces = serde_json::to_string(&(groups, facets, &refined.trace)).unwrap();
        format!("{:?} {traces}", refined.value)
    };
    let of_defaults = found(done.clone(), &Params::default());
    let defaults = serde_json::to_value(Params::default()).unwrap();
    let mut changed = 0;
    for group in ["/roof", "/roof/refine"] {
        let numbers = defaults.pointer(group).unwrap().as_object().unwrap();
        for (name, value) in numbers.iter().filter(|(_, value)| value.is_number()) {
            let mut params = defaults.clone();
            params.pointer_mut(group).unwrap()[name] = match value.as_u64() {
                Some(count) => (2 * count + 1).into(),
                None => (1.7 * value.as_f64().unwrap() + 0.8).into(),
            };
            let params: Params = serde_json::from_value(params).unwrap();
            let again = found(done.clone(), &params);
            assert!(again == found(before.clone(), &params), "{group}/{name}");
            changed += usize::from(again != of_defaults);
        }
    }
    assert!(changed > 8, "these parameters decide something: {changed}");
    let mut params = Params::default();
    params.roof.least_nats = 2.0;
    done.set_params(params.clone());
    assert!(done.has(Stage::Groups) && !done.has(Stage::Facets));
    done.step(Stage::Refinement, &silent());
    params.roof.refine.reach_px += 1.0;
    done.set_params(params);
    assert!(done.has(Stage::Facets) && !done.has(Stage::Refinement));
}

#[test]
fn new_parameters_drop_what_they_change() {
    let (scene, _) = l_scene(64);
    let mut run = Run::new(scene, Params::default());
    run.step(Stage::HalfPlanes, &silent());
    let mut params = run.params().clone();
    params.sweep.min_similarity = 0.9;
    run.set_params(params);
    assert!(run.has(Stage::Lines) && !run.has(Stage::HalfPlanes));
    run.step(Stage::Segments, &silent());
    assert!(run.has(Stage::Segments) && !run.has(Stage::Matches));
    assert!(
        run.files(&[]).is_empty(),
        "an unfinished run offers nothing"
    );
}

#[test]
fn new_parameters_of_one_method_keep_what_the_other_found_before() {
    let (scene, _) = l_scene(64);
    let params = Params {
        method: Method::Combined,
        ..Params::default()
    };
    let mut run = Run::new(scene, params);
    run.step(Stage::HalfPlanes, &silent());
    let mut params = run.params().clone();
    params.sweep.min_similarity = 0.9;
    run.set_params(params.clone());
    assert!(run.has(Stage::Rectangles) && run.has(Stage::Lines) && !run.has(Stage::HalfPlanes));
    params.objectspace.planes.min_area_m2 = 5.0;
    run.set_params(params.clone());
    assert!(run.has(Stage::Ground) && !run.has(Stage::Rectangles));
    params.choose(Method::Lines);
    run.set_params(params.clone());
    assert!(run.summaries().is_empty(), "other sources");
    run.step(Stage::Segments, &silent());
    params.objectspace.oris.vector_bits = 20.0;
    run.set_params(params);
    assert!(run.has(Stage::Segments), "nothing here reads this");
}
