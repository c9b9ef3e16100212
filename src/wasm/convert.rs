//! Between Rust's values and JavaScript's.

use std::sync::Arc;

use js_sys::{Function, Reflect, Uint8Array};
use nalgebra::Matrix3x4;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_wasm_bindgen::Serializer;
use wasm_bindgen::JsValue;

use super::memory::grow_ahead;
use crate::base::error::Error;
use crate::base::execution::{Listener, MergedShards};
use crate::photographs::camera::Camera;

/// A JavaScript `Error` with the refusal's message, called "InputError": the page shows it as
/// advice, and anything else as a fault of the program. Its `code` is the kind of refusal, its
/// `agreement` the report where the images speak against the orientation.
pub(crate) fn input_error(error: &Error) -> JsValue {
    let thrown = named_error("InputError", &error.to_string());
    let set = |name: &str, value: &JsValue| Reflect::set(&thrown, &name.into(), value);
    let report = match error {
        Error::Contradiction { report, .. } => to_js(report),
        _ => Ok(JsValue::NULL),
    };
    // A plain object takes every property.
    let _ = set("code", &error.code().into());
    let _ = set("agreement", &report.unwrap_or(JsValue::NULL));
    thrown
}

/// A JavaScript `Error` of this name.
pub(crate) fn named_error(name: &str, message: &str) -> JsValue {
    let error = js_sys::Error::new(message);
    error.set_name(name);
    error.into()
}

/// Has what a panic says written to the console, where the worker finds it.
pub(crate) fn write_panics() {
    std::panic::set_hook(Box::new(|panic| {
        web_sys::console::error_1(&panic.to_string().into());
    }));
}

/// A plain JavaScript object, as JSON would give it.
pub(crate) fn to_js(value: &impl Serialize) -> Result<JsValue, JsValue> {
    Ok(value.serialize(&Serializer::json_compatible())?)
}

/// A Rust value from a plain JavaScript object; `what` names it in the message. By way of JSON, so
/// that the page's parameters are read, and misspelt names refused, exactly as the command line's.
pub(crate) fn from_js<T: DeserializeOwned>(value: &JsValue, what: &str) -> Result<T, JsValue> {
    let text = if value.is_undefined() {
        "null".to_owned()
    } else {
        String::from(js_sys::JSON::stringify(value)?)
    };
    crate::base::json::read(&text).map_err(|e| named_error("InputError", &format!("{what}: {e}")))
}

/// A view of the scene; its centre in metres, local frame, and its 3 x 4 matrix from there to
/// pixels, row by row.
#[derive(Serialize, tsify::Tsify)]
pub(crate) struct ViewInfo {
    name: String,
    width: u32,
    height: u32,
    center: [f64; 3],
    projection: Vec<f64>,
}

impl ViewInfo {
    pub(crate) fn new(name: &str, camera: &Camera) -> Self {
        Self {
            name: name.to_owned(),
            width: camera.width,
            height: camera.height,
            center: camera.center.coords.into(),
            projection: row_major(&camera.projection_matrix()),
        }
    }
}

/// Tells the page how far the work is, and makes room for what comes.
pub(crate) fn listener_of(on_progress: &Function) -> Listener {
    let on_progress = on_progress.clone();
    Arc::new(move |fraction| {
        grow_ahead();
        // A listener that throws is the page's own fault, and no reason to lose the stage.
        let _ = on_progress.call1(&JsValue::NULL, &fraction.into());
    })
}

/// Adds the shards of a map, in the order of their index; none is kept where one is foreign.
pub(crate) fn merge_all(
    merged: &mut MergedShards,
    map: &str,
    shards: &[Uint8Array],
) -> Result<(), JsValue> {
    for shard in shards {
        if !merged.merge(map, &shard.to_vec()) {
            *merged = MergedShards::default();
            return Err(foreign("a shard of a map"));
        }
    }
    Ok(())
}

/// Bytes that are not what they are taken for.
pub(crate) fn foreign(what: &str) -> JsValue {
    named_error("TypeError", &format!("these bytes are not {what}"))
}

/// The twelve numbers of a 3 x 4 matrix, row by row.
fn row_major(matrix: &Matrix3x4<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}
