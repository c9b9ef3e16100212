//! What the page asks for corrections by hand.

use nalgebra::Point3;
use wasm_bindgen::prelude::*;

use super::convert::to_js;
use super::session::Session;
use crate::corrections::edge_in_space;
use crate::ids::ViewId;

#[wasm_bindgen]
impl Session {
    /// What became of the corrections; `null` before their stage.
    #[wasm_bindgen(unchecked_return_type = "CorrectionTrace | null")]
    pub fn corrected(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().corrections.as_ref();
        to_js(&found.map(|c| &c.trace))
    }

    /// The edge in space whose ends a view shows where it shows two points (x, y, z each, metres,
    /// local frame); `null` where the other views show none.
    #[wasm_bindgen(js_name = edgeInSpace, unchecked_return_type = "Segment3 | null")]
    pub fn edge_in_space(&self, view: usize, points: &[f64]) -> Result<JsValue, JsValue> {
        let run = self.loaded()?;
        let ends: Vec<Point3<f64>> = points.chunks_exact(3).map(Point3::from_slice).collect();
        let found = match (run.results().roof_model(), &ends[..]) {
            (Some(model), &[p, q]) => {
                edge_in_space(run.scene(), model, ViewId::from_index(view), [p, q])
            }
            _ => None,
        };
        to_js(&found)
    }
}
