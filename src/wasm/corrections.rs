//! What the page asks for corrections by hand.

use wasm_bindgen::prelude::*;

use super::convert::to_js;
use super::session::Session;

#[wasm_bindgen]
impl Session {
    /// What became of the corrections; `null` before their stage.
    #[wasm_bindgen(unchecked_return_type = "CorrectionTrace | null")]
    pub fn corrected(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().corrections.as_ref();
        to_js(&found.map(|c| &c.trace))
    }
}
