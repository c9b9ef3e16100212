//! What the page asks for corrections by hand.

use nalgebra::{Point2, Point3};
use wasm_bindgen::prelude::*;

use super::convert::to_js;
use super::session::Session;
use crate::corrections::edge_in_space;
use crate::ids::ViewId;
use crate::model::RoofModel;

/// Roofs are looked for up to this far above those that were found, metres.
const ABOVE_M: f64 = 5.0;

#[wasm_bindgen]
impl Session {
    /// What became of the corrections; `null` before their stage.
    #[wasm_bindgen(unchecked_return_type = "CorrectionTrace | null")]
    pub fn corrected(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().corrections.as_ref();
        to_js(&found.map(|c| &c.trace))
    }

    /// The edge in space whose ends a view shows where it shows these two points (x, y, z each,
    /// metres, local frame); `undefined` where the other views show none.
    #[wasm_bindgen(js_name = edgeInSpace, unchecked_return_type = "Segment3 | undefined")]
    pub fn edge_in_space(&self, view: usize, points: &[f64]) -> Result<JsValue, JsValue> {
        let run = self.loaded()?;
        let (scene, model) = (run.scene(), run.results().roof_model());
        let ends: Option<Vec<Point2<f64>>> = scene.views.get(view).and_then(|v| {
            let points = points.chunks_exact(3).map(Point3::from_slice);
            points.map(|p| v.camera.project(&p)).collect()
        });
        let found = match (ends.as_deref(), model.and_then(heights)) {
            (Some(&[p, q]), Some(range)) => {
                edge_in_space(scene, ViewId::from_index(view), [p, q], range)
            }
            _ => None,
        };
        to_js(&found)
    }
}

/// The heights between which a model's roofs may lie, metres.
fn heights(model: &RoofModel) -> Option<[f64; 2]> {
    let grounds = model.buildings.iter().map(|b| b.ground_z);
    let low = grounds.reduce(f64::min)?;
    let corners = model.facets.iter().flat_map(|f| &f.outer);
    let high = corners.map(|p| p.z).reduce(f64::max)?;
    Some([low, high + ABOVE_M])
}
