//! 3D Tiles 1.1: `tileset.json`, one tile whose content is `model.glb`.
//!
//! Content has y up and is turned to z up by whoever draws it; then it is in the local frame of the
//! scene. The tile's transform places that on the Earth (EPSG:4978): the map from the frame to the
//! Earth, made linear in the middle of the model. So the convergence of the meridians and the scale
//! of the grid are in it; what is left is the curvature, d^2 / 2R, 1 cm at 350 m from the middle.
//! Where the place on the Earth is not known the transform is left out, and `extras` says so.

use nalgebra::{Matrix3, Point3, Vector3};
use serde_json::json;

use super::format::{rounded, to_bytes};
use crate::geometry::bounds;
use crate::model::RoofModel;
use crate::scene::Scene;

/// Half the step of the differences that make the map linear, metres: curvature cancels, and
/// rounding (1e-9 m of 6.4e6 m) stays far below a millimetre.
const STEP_M: f64 = 50.0;

/// Half a side of the box around nothing, metres.
const LEAST_HALF_M: f64 = 0.5;

/// The tileset of a model, whose content lies beside it under this name.
pub(super) fn tileset(scene: &Scene, model: &RoofModel, content: &str) -> Vec<u8> {
    let corners = || model.buildings.iter().flat_map(|b| &b.solid.vertices);
    let is_empty = corners().next().is_none();
    let [low, high] = match is_empty {
        true => [Point3::origin(); 2],
        false => bounds(corners().copied()),
    };
    let middle = nalgebra::center(&low, &high);
    let half = ((high - low) / 2.0).map(|h| h.max(LEAST_HALF_M));
    let mut root = json!({
        "boundingVolume": { "box": [
            middle.x, middle.y, middle.z,
            half.x, 0.0, 0.0,
            0.0, half.y, 0.0,
            0.0, 0.0, half.z,
        ] },
        "geometricError": 0.0,
        "refine": "REPLACE",
    });
    if !is_empty {
        root["content"] = json!({ "uri": content });
    }
    let mut extras = json!({ "origin": scene.origin.as_slice() });
    if let Some(system) = scene.survey.describe() {
        extras["crs"] = json!(system);
    }
    match placement(scene, &middle) {
        Some(transform) => {
            root["transform"] = json!(transform);
            if scene.survey.anchor.is_none() {
                extras["heights"] = json!("those of the grid, taken as ellipsoidal");
            }
        }
        None => extras["placement"] = json!("none: the place on the Earth is not known"),
    }
    to_bytes(&json!({
        "asset": { "version": "1.1" },
        // What is amiss where nothing is drawn: all of it.
        "geometricError": rounded(2.0 * half.norm(), 3),
        "root": root,
        "extras": extras,
    }))
}

/// The matrix, column by column, from the local frame to geocentric coordinates.
fn placement(scene: &Scene, middle: &Point3<f64>) -> Option<Vec<f64>> {
    let on_earth = |p: Point3<f64>| scene.survey.geocentric(&(p + scene.origin));
    let column = |axis: Vector3<f64>| {
        let ends = [STEP_M, -STEP_M].map(|step| on_earth(middle + axis * step));
        let [Some(a), Some(b)] = ends else {
            return None;
        };
        Some((a - b) / (2.0 * STEP_M))
    };
    let axes = Matrix3::from_columns(&[
        column(Vector3::x())?,
        column(Vector3::y())?,
        column(Vector3::z())?,
    ]);
    let zero = on_earth(*middle)? - axes * middle.coords;
    let last = zero.coords.push(1.0);
    let columns = axes.column_iter().map(|c| c.push(0.0)).chain([last]);
    let numbers: Vec<f64> = columns.flat_map(<[f64; 4]>::from).collect();
    // What is off the Earth (a wrong code) has no place there.
    numbers.iter().all(|n| n.is_finite()).then_some(numbers)
}
