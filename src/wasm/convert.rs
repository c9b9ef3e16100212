//! Between Rust's values and JavaScript's.

use js_sys::{Float32Array, Float64Array, Reflect};
use nalgebra::Matrix3x4;
use serde::Serialize;
use serde::de::DeserializeOwned;
use wasm_bindgen::{JsError, JsValue};

use crate::error::Error;
use crate::geometry::Segment2;
use crate::lines3d::Line3d;

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

/// A plain JavaScript object, by way of JSON: the writer of it is there anyway.
pub(crate) fn to_js(value: &impl Serialize) -> Result<JsValue, JsValue> {
    let text = serde_json::to_string(value).map_err(JsError::from)?;
    js_sys::JSON::parse(&text)
}

/// A Rust value from a plain JavaScript object; `what` names it in the message. By way of JSON, so
/// that the page's parameters are read, and misspelt names refused, exactly as the command line's.
pub(crate) fn from_js<T: DeserializeOwned>(value: &JsValue, what: &str) -> Result<T, JsValue> {
    let text = if value.is_undefined() {
        "null".to_owned()
    } else {
        String::from(js_sys::JSON::stringify(value)?)
    };
    crate::json::read(&text).map_err(|e| named_error("InputError", &format!("{what}: {e}")))
}

/// (x0, y0, x1, y1) per segment, pixels.
pub(crate) fn segment_array<'a>(segments: impl Iterator<Item = &'a Segment2>) -> Float32Array {
    let numbers: Vec<f32> = segments.flat_map(end_points_px).collect();
    Float32Array::from(&numbers[..])
}

/// The end points in single precision.
pub(crate) fn end_points_px(s: &Segment2) -> [f32; 4] {
    [s.p0.x, s.p0.y, s.p1.x, s.p1.y].map(|v| v as f32)
}

/// The twelve numbers of a 3 x 4 matrix, row by row.
pub(crate) fn row_major(matrix: &Matrix3x4<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}

/// (x, y, z) of both end points per line, metres, local frame.
pub(crate) fn line_array(lines: &[Line3d]) -> Float64Array {
    let numbers: Vec<f64> = lines
        .iter()
        .flat_map(|l| [l.segment.p0, l.segment.p1])
        .flat_map(|p| [p.x, p.y, p.z])
        .collect();
    Float64Array::from(&numbers[..])
}
