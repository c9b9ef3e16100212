//! Large areas in the page: the plan of a flight, tile after tile in one worker, then one model.

use js_sys::Function;
use wasm_bindgen::prelude::*;

use super::convert::{from_js, input_error, listener_of, named_error, to_js};
use super::session::{Session, load_options};
use crate::base::execution::MergedShards;
use crate::orienting::orientation::{InputFile, Needed};
use crate::orienting::scene_loader::{
    LoadOptions, files_of_ground, files_of_views, ground_files, ground_heights,
};
use crate::tiles::{Area, FlightPlan, TileReport};

/// What a tile came to, and its model (glTF) where it has one.
#[wasm_bindgen]
pub struct TileModel {
    report: TileReport,
    glb: Option<Vec<u8>>,
}

#[wasm_bindgen]
impl TileModel {
    /// Core and outcome in words.
    #[wasm_bindgen(getter, unchecked_return_type = "TileReport")]
    pub fn report(&self) -> Result<JsValue, JsValue> {
        to_js(&self.report)
    }

    /// The model by itself; undefined where there is none.
    #[wasm_bindgen(getter, unchecked_return_type = "Uint8Array<ArrayBuffer> | undefined")]
    pub fn glb(&self) -> Option<Vec<u8>> {
        self.glb.clone()
    }
}

#[wasm_bindgen]
impl Session {
    /// All photographs seen from above, and the tiles of about `tile_m` metres of the region of
    /// interest, or of what three photographs show; no pixel is read. `heights` are those that
    /// `groundHeights` found, or null.
    #[wasm_bindgen(js_name = planFlight, unchecked_return_type = "FlightPlan")]
    pub fn plan_flight(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
        tile_m: f64,
        #[wasm_bindgen(unchecked_param_type = "[number, number] | null")] heights: JsValue,
    ) -> Result<JsValue, JsValue> {
        let options = load_options(&options)?;
        let heights: Option<[f64; 2]> = from_js(&heights, "heights")?;
        let plan = FlightPlan::new(&self.files, &options, heights, tile_m);
        to_js(&plan.map_err(|e| input_error(&e))?)
    }

    /// The photographs in which `groundHeights` measures: to be filled.
    #[wasm_bindgen(js_name = groundFiles, unchecked_return_type = "LackingFile[]")]
    pub fn ground_files(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<JsValue, JsValue> {
        let needed = ground_files(&self.files, &load_options(&options)?);
        self.lacking(&needed)
    }

    /// Lowest and highest ground as the photographs in the middle of a flight show it, metres; null
    /// where they show too little.
    #[wasm_bindgen(js_name = groundHeights, unchecked_return_type = "[low: number, high: number] | null")]
    pub fn ground_heights(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<JsValue, JsValue> {
        to_js(&ground_heights(&self.files, &load_options(&options)?))
    }

    /// The tiles of `planFlight` with the same arguments, to be worked off. `heights` are those of
    /// its overview; null measures them in files that are whole. Results of an earlier run are
    /// dropped.
    #[wasm_bindgen(js_name = planTiles)]
    pub fn plan_tiles(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
        tile_m: f64,
        #[wasm_bindgen(unchecked_param_type = "[number, number] | null")] heights: JsValue,
    ) -> Result<(), JsValue> {
        self.run = None;
        self.merged = MergedShards::default();
        self.outputs = None;
        self.points = None;
        let options = load_options(&options)?;
        let heights: Option<[f64; 2]> = from_js(&heights, "heights")?;
        let mut files = &self.files[..];
        let area = Area::plan(&mut files, &options, heights, &self.params, tile_m);
        self.area = Some(area.map_err(|e| input_error(&e))?);
        Ok(())
    }

    /// How many squares of the area are looked at before its tiles are worked off: the tiles then
    /// work where a roof may be.
    #[wasm_bindgen(js_name = squaresToLookAt)]
    pub fn squares_to_look_at(&self) -> Result<usize, JsValue> {
        Ok(self.planned()?.squares_to_look_at())
    }

    /// The photographs that a look needs first, to measure the ground: to be filled.
    #[wasm_bindgen(js_name = groundFilesOfLook, unchecked_return_type = "LackingFile[]")]
    pub fn ground_files_of_look(&self, index: usize) -> Result<JsValue, JsValue> {
        let options = self.planned()?.options_of_look(index);
        self.lacking_of(options, files_of_ground)
    }

    /// The photographs that a look makes views of, once the others are filled.
    #[wasm_bindgen(js_name = viewFilesOfLook, unchecked_return_type = "LackingFile[]")]
    pub fn view_files_of_look(&self, index: usize) -> Result<JsValue, JsValue> {
        let options = self.planned()?.options_of_look(index);
        self.lacking_of(options, files_of_views)
    }

    /// What a square shows at a first look, as bytes, to be kept; `takeLook` goes on from it.
    #[wasm_bindgen(js_name = lookAt, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn look_at(
        &self,
        index: usize,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Result<Vec<u8>, JsValue> {
        let area = self.planned()?;
        let seen = area.look_at(&self.files, index, &listener_of(on_progress));
        seen.ok_or_else(no_tile)
    }

    /// Takes what the next square shows, from the first on.
    #[wasm_bindgen(js_name = takeLook)]
    pub fn take_look(&mut self, seen: &[u8]) -> Result<(), JsValue> {
        let area = self.area.as_mut().ok_or_else(not_planned)?;
        let taken = area.take_look(&self.files, seen);
        taken.map_err(|e| input_error(&e))
    }

    /// What the cells of the tiles read and the order in which tiles are to be worked off, once all
    /// squares were looked at.
    #[wasm_bindgen(js_name = workPlan, unchecked_return_type = "WorkPlan")]
    pub fn work_plan(&self) -> Result<JsValue, JsValue> {
        to_js(self.planned()?.work())
    }

    /// The photographs that a cell of a tile needs first, to measure the ground: to be filled.
    #[wasm_bindgen(js_name = groundFilesOfCell, unchecked_return_type = "LackingFile[]")]
    pub fn ground_files_of_cell(&self, index: usize, cell: usize) -> Result<JsValue, JsValue> {
        self.lacking_of(self.planned()?.options_of(index, cell), files_of_ground)
    }

    /// The photographs that a cell makes views of, once the others are filled.
    #[wasm_bindgen(js_name = viewFilesOfCell, unchecked_return_type = "LackingFile[]")]
    pub fn view_files_of_cell(&self, index: usize, cell: usize) -> Result<JsValue, JsValue> {
        self.lacking_of(self.planned()?.options_of(index, cell), files_of_views)
    }

    /// Loads a cell of a tile, from the first on; its photographs may be left then.
    #[wasm_bindgen(js_name = loadCell)]
    pub fn load_cell(&mut self, index: usize, cell: usize) -> Result<(), JsValue> {
        let area = self.area.as_mut().ok_or_else(not_planned)?;
        area.load(&self.files, index, cell).ok_or_else(no_tile)
    }

    /// Works off the cell that was loaded.
    #[wasm_bindgen(js_name = runCell)]
    pub fn run_cell(
        &mut self,
        index: usize,
        cell: usize,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Result<(), JsValue> {
        let area = self.area.as_mut().ok_or_else(not_planned)?;
        let done = area.work_off(index, cell, &listener_of(on_progress));
        done.ok_or_else(no_tile)
    }

    /// The outcome of a tile whose cells are worked off as bytes, to be kept. `tileModel` shows it,
    /// `takeTile` goes on from it.
    #[wasm_bindgen(js_name = tileOutcome, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn tile_outcome(&mut self, index: usize) -> Result<Vec<u8>, JsValue> {
        let area = self.area.as_mut().ok_or_else(not_planned)?;
        area.outcome_of(index).ok_or_else(no_tile)
    }

    /// What a tile came to, and its model; refused where the bytes are not its outcome.
    #[wasm_bindgen(js_name = tileModel)]
    pub fn tile_model(&self, index: usize, kept: &[u8]) -> Result<TileModel, JsValue> {
        let found = self.planned()?.outcome(index, kept);
        let (report, glb) = found.map_err(|e| input_error(&e))?;
        Ok(TileModel { report, glb })
    }

    /// Takes the outcome of the next tile, from the first on.
    #[wasm_bindgen(js_name = takeTile)]
    pub fn take_tile(&mut self, kept: &[u8]) -> Result<(), JsValue> {
        let area = self.area.as_mut().ok_or_else(not_planned)?;
        area.take(kept).map_err(|e| input_error(&e))
    }

    /// Joins the models of all tiles: `exportNames` and `exportFile` then speak of the whole.
    #[wasm_bindgen(js_name = joinTiles)]
    pub fn join_tiles(&mut self) -> Result<(), JsValue> {
        let area = self.area.take().ok_or_else(not_planned)?;
        let (files, reported) = area.finish(&[]).map_err(|e| input_error(&e))?;
        (self.outputs, self.joined) = (Some(files), Some(reported));
        Ok(())
    }

    /// The photographs that are not whole among those that are needed to load this.
    fn lacking_of(
        &self,
        loaded: Option<LoadOptions>,
        needed: fn(&[InputFile], &LoadOptions) -> Vec<Needed>,
    ) -> Result<JsValue, JsValue> {
        self.lacking(&needed(&self.files, &loaded.ok_or_else(no_tile)?))
    }

    fn planned(&self) -> Result<&Area, JsValue> {
        self.area.as_ref().ok_or_else(not_planned)
    }
}

fn not_planned() -> JsValue {
    named_error("RangeError", "no tiles are planned: call planTiles first")
}

fn no_tile() -> JsValue {
    named_error("RangeError", "there is no such tile")
}
