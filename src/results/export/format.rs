//! What several formats share: file names, rounding, world coordinates, lines of text, JSON bytes.

use std::fmt::Write;

use nalgebra::Point3;
use serde_json::Value;

use crate::orienting::scene::Scene;

/// Name of the atlas beside the CityJSON file.
pub const ATLAS_FILE: &str = "model_atlas.jpg";

/// Name of the material file beside the OBJ file.
pub const MATERIAL_FILE: &str = "model.mtl";

/// Decimals of a coordinate: 0.1 mm.
const DECIMALS: u8 = 4;

/// A number rounded to a few decimals: shorter in a file, and it hides what is not significant.
pub(crate) fn rounded(value: f64, decimals: u8) -> f64 {
    let scale = (0..decimals).fold(1.0, |scale, _| scale * 10.0);
    let r = (value * scale).round() / scale;
    // No "-0.0" in files.
    if r == 0.0 { 0.0 } else { r }
}

/// A point in the world frame of the input, rounded.
pub(crate) fn world(scene: &Scene, p: &Point3<f64>) -> [f64; 3] {
    (p + scene.origin)
        .coords
        .map(|v| rounded(v, DECIMALS))
        .into()
}

/// Adds a line of text.
pub(crate) fn push_line(text: &mut String, content: std::fmt::Arguments) {
    writeln!(text, "{content}").expect("a String takes all that is written");
}

/// Compact JSON. Numbers that are not finite become `null`; keys are in a fixed order.
pub(crate) fn to_bytes(value: &Value) -> Vec<u8> {
    serde_json::to_vec(value).expect("a JSON value has string keys only")
}
