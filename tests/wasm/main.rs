//! The page's session in Node: the whole pipeline on a synthetic scene finds what it finds natively
//! (`tests/wasm/identical.mjs` compares the bytes), and bad input is refused in words.
//!
//! `wasm-pack test --node tests/wasm --profile page`
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;

use common::{golden, synthetic_files, zipped};
use js_sys::{Array, Error, Function, Object, Reflect};
use ridgeline::wasm::Session;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_test::wasm_bindgen_test;

fn session_of(files: &[(String, Vec<u8>)]) -> Session {
    let mut session = Session::new();
    for (path, bytes) in files {
        session.add_file(path, bytes.clone()).unwrap();
    }
    session
}

fn refusal(session: &mut Session) -> (String, String) {
    let error: Error = session
        .load(JsValue::UNDEFINED)
        .unwrap_err()
        .unchecked_into();
    (error.name().into(), error.message().into())
}

#[track_caller]
fn member(object: &JsValue, name: &str) -> JsValue {
    Reflect::get(object, &name.into()).unwrap()
}

#[wasm_bindgen_test]
fn the_house_is_as_it_is_natively() {
    let mut session = session_of(&synthetic_files());
    let info = session.load(Object::new().into()).unwrap();
    assert_eq!(Array::from(&member(&info, "views")).length(), 6);
    let fractions = Array::new();
    let push = Function::new_with_args("fraction", "this.push(fraction)").bind0(&fractions);
    for stage in session.chosen_stages() {
        let summary = session.run_stage(&stage, &push).unwrap();
        assert_eq!(member(&summary, "stage"), JsValue::from(stage));
    }
    assert_eq!(fractions.get(0), 0.0);
    assert_eq!(fractions.get(fractions.length() - 1), 1.0);

    let names = session.export_names().unwrap();
    let files: Vec<_> = names
        .into_iter()
        .map(|name| {
            let bytes = session.export_file(&name).unwrap();
            (name, bytes)
        })
        .collect();
    let expected = golden::section_of(include_str!("../golden/l.txt"), "lines");
    let differences = golden::differences(expected, &golden::section("lines", &files));
    assert!(differences.is_empty(), "{}", differences.join("\n"));

    // What the page draws.
    assert!(
        session.segments(0).unwrap().length().is_multiple_of(4)
            && session.segments(0).unwrap().length() > 0
    );
    assert!(
        session
            .matched_segments(5)
            .unwrap()
            .length()
            .is_multiple_of(6)
    );
    assert!(session.lines().unwrap().length() >= 6);
    let half_plane = Array::from(&session.half_planes().unwrap()).get(0);
    assert!(member(&half_plane, "theta").as_f64().unwrap().abs() < 1.6);
    let facet = Array::from(&session.facets().unwrap()).get(0);
    assert!(Array::from(&member(&facet, "outer")).length() >= 3);
    let image = session.image(2).unwrap();
    assert_eq!(image.rgba.length(), 4 * image.width * image.height);
    the_figures_answer(&mut session, &half_plane);
}

/// What the live figures ask, about the line of an accepted half-plane.
fn the_figures_answer(session: &mut Session, half_plane: &JsValue) {
    let line = member(half_plane, "line").as_f64().unwrap();
    let left = member(half_plane, "side").as_string().as_deref() == Some("left");
    let records = Array::from(&session.line_records().unwrap());
    assert_eq!(records.length() * 6, session.lines().unwrap().length());
    let supports = Array::from(&member(&records.get(line as u32), "supports"));
    assert!(supports.length() >= 3);
    let support = supports.get(0);
    let view = member(&support, "view").as_f64().unwrap() as u32;
    let segments = Array::from(&member(&support, "segments"));
    if let Some(segment) = segments.get(0).as_f64() {
        let story = session.segment_matching(view, segment as u32).unwrap();
        assert_eq!(
            member(&member(&story, "outcome"), "kind"),
            JsValue::from("matched")
        );
        assert_eq!(Array::from(&member(&story, "beams")).length(), 5);
    }
    assert!(session.detected_stretches().unwrap().length() >= 7);

    let theta = member(half_plane, "theta").as_f64().unwrap();
    let side = session.side(line as usize, left).unwrap();
    assert!(member(&side, "rejection").is_null());
    let picture = session.warped(line as usize, left, theta).unwrap().unwrap();
    let number = |name: &str| member(&picture.about, name).as_f64().unwrap() as u32;
    let views = Array::from(&member(&picture.about, "views")).length();
    assert_eq!(
        picture.rgba.length(),
        4 * number("columns") * number("rows") * views
    );
    assert!(session.warped(9999, true, 0.0).is_err());
    let groups = member(&session.grouping().unwrap(), "groups");
    assert!(Array::from(&groups).length() > 0);
    assert!(session.regions(0).unwrap().is_null());

    let refinement = session.refinement().unwrap();
    let sources = Array::from(&member(&member(&refinement, "before"), "sources"));
    assert_eq!(
        sources.length(),
        Array::from(&session.facets().unwrap()).length()
    );
    let buildings = Array::from(&member(&refinement, "buildings"));
    let relations = Array::from(&member(&buildings.get(0), "relations"));
    assert!(
        member(&relations.get(0), "chi2")
            .as_f64()
            .is_some_and(|c| c >= 0.0)
    );
    let written = session.export_file("lines.json").unwrap();
    let written: serde_json::Value = serde_json::from_slice(&written).unwrap();
    let written = written["lines"].as_array().unwrap().iter();
    let origins: Vec<JsValue> = written
        .map(|l| l["origin"].as_str().unwrap().into())
        .collect();
    // The files leave out what the model refutes.
    let standing = records
        .iter()
        .filter(|r| member(r, "contradiction").is_null());
    let shown: Vec<JsValue> = standing.map(|r| member(&r, "origin")).collect();
    assert_eq!(shown, origins);
    assert!(shown.len() > 15);
}

/// Both methods in one session, and another one that does a shard of the last of their stages.
#[wasm_bindgen_test]
fn both_methods_share_their_planes() {
    let mut sessions = [(); 2].map(|()| session_of(&synthetic_files()));
    let silent = Function::new_no_args("");
    for session in &mut sessions {
        session.set_params(combined()).unwrap();
        session.load(Object::new().into()).unwrap();
    }
    let [first, helper] = &mut sessions;
    let stages = first.chosen_stages();
    for stage in &stages {
        if stage == "groups" {
            let shard = |helper: &mut Session| helper.run_shard(stage, "planes", 0, 1, &silent);
            assert!(shard(helper).unwrap().is_empty(), "nothing is known yet");
            let earlier = [
                "segments",
                "lines",
                "ground",
                "rectangles",
                "halfplanes",
                "dense",
            ];
            for earlier in earlier {
                let found = first.hand_over(earlier).unwrap();
                helper.take_over(earlier, found).unwrap();
            }
            assert!(shard(helper).unwrap().len() > 13, "not a list of no calls");
        }
        first.run_stage(stage, &silent).unwrap();
    }
    assert!(stages.iter().any(|s| s == "regions"), "{stages:?}");
    let groups = Array::from(&member(&first.grouping().unwrap(), "groups"));
    let joined = |g: &JsValue| Array::from(&member(g, "proposals")).length() > 0;
    assert!(groups.iter().any(|g| joined(&g)));
    assert!(Array::from(&first.facets().unwrap()).length() > 0);
}

fn combined() -> JsValue {
    let params = Object::new();
    Reflect::set(&params, &"method".into(), &"combined".into()).unwrap();
    params.into()
}

#[wasm_bindgen_test]
fn an_archive_stands_for_its_files() {
    let mut session = session_of(&[("scene.zip".to_owned(), zipped(&synthetic_files()))]);
    let info = session.load(JsValue::UNDEFINED).unwrap();
    assert_eq!(Array::from(&member(&info, "views")).length(), 6);
}

#[wasm_bindgen_test]
fn an_image_without_orientation_is_left_out_and_named() {
    let mut files = synthetic_files();
    files.push(("images/stray.png".into(), files[0].1.clone()));
    let info = session_of(&files).load(JsValue::UNDEFINED).unwrap();
    let said = String::from(Array::from(&member(&info, "warnings")).join("\n"));
    assert!(said.contains("stray.png"), "{said}");
}

#[wasm_bindgen_test]
fn a_truncated_image_is_refused_and_the_session_goes_on() {
    let mut files = synthetic_files();
    let (path, whole) = files[0].clone();
    files[0].1.truncate(whole.len() / 2);
    let mut session = session_of(&files);
    let (name, message) = refusal(&mut session);
    assert_eq!(name, "InputError");
    assert!(
        message.contains(&path) || path.ends_with(&message),
        "{message}"
    );
    session.add_file(&path, whole).unwrap();
    assert!(session.load(JsValue::UNDEFINED).is_ok());
}

#[wasm_bindgen_test]
fn a_session_without_a_scene_says_so() {
    let mut session = Session::new();
    assert!(session.lines().is_err() && session.export_names().is_err());
    let error: Error = session
        .run_stage("segments", &Function::new_no_args(""))
        .unwrap_err()
        .unchecked_into();
    assert!(String::from(error.message()).contains("load"));
}

#[wasm_bindgen_test]
fn parameters_come_back_as_they_went() {
    let mut session = Session::new();
    let params = Session::default_params().unwrap();
    session.set_params(params.clone()).unwrap();
    Reflect::set(&params, &"colour".into(), &1.into()).unwrap();
    let error: Error = session.set_params(params).unwrap_err().unchecked_into();
    assert!(String::from(error.message()).contains("colour"));
}
