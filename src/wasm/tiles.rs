//! Large areas in the page: tile after tile in one worker, then one model.

use js_sys::Function;
use wasm_bindgen::prelude::*;

use super::convert::{input_error, listener_of, named_error, to_js};
use super::session::{Session, load_options};
use crate::execution::MergedShards;
use crate::tiles::Area;

#[wasm_bindgen]
impl Session {
    /// Divides the region of interest of the options of `load` into tiles of about `tile_m` metres:
    /// their cores, x0, y0, x1, y1 each. Results of an earlier run are dropped.
    #[wasm_bindgen(js_name = planTiles, unchecked_return_type = "[x0: number, y0: number, x1: number, y1: number][]")]
    pub fn plan_tiles(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
        tile_m: f64,
    ) -> Result<JsValue, JsValue> {
        self.run = None;
        self.merged = MergedShards::default();
        self.outputs = None;
        self.points = None;
        let options = load_options(&options)?;
        let area = Area::plan(&self.files, &options, &self.params, tile_m);
        let area = self.area.insert(area.map_err(|e| input_error(&e))?);
        to_js(&area.tiles().iter().map(|t| t.core).collect::<Vec<_>>())
    }

    /// Works off the next tile: `{core, outcome}`; null when all are done.
    #[wasm_bindgen(js_name = runTile, unchecked_return_type = "TileReport | null")]
    pub fn run_tile(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Result<JsValue, JsValue> {
        let area = self.area.as_mut().ok_or_else(not_planned)?;
        to_js(&area.step(&self.files, &listener_of(on_progress)))
    }

    /// Joins the models of all tiles: `exportNames` and `exportFile` then speak of the whole.
    #[wasm_bindgen(js_name = joinTiles)]
    pub fn join_tiles(&mut self) -> Result<(), JsValue> {
        let area = self.area.take().ok_or_else(not_planned)?;
        self.outputs = Some(area.finish(&[]).map_err(|e| input_error(&e))?);
        Ok(())
    }
}

fn not_planned() -> JsValue {
    named_error("RangeError", "no tiles are planned: call planTiles first")
}
