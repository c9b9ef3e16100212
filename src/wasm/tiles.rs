//! Large areas in the page: the plan of a flight, tile after tile in one worker, then one model.

use std::collections::BTreeSet;

use js_sys::Function;
use serde::Serialize;
use wasm_bindgen::prelude::*;

use super::convert::{from_js, input_error, listener_of, named_error, to_js};
use super::session::{Session, load_options};
use crate::execution::MergedShards;
use crate::orientation::InputFile;
use crate::scene_loader::{
    Flight, FlightOverview, LoadOptions, ViewWindow, files_of_ground, files_of_views, ground_files,
    ground_heights,
};
use crate::tiles::{Area, Tile, TileReport, plan_tiles};

/// Most tiles that the page plans: so many take it days.
const MOST_TILES: usize = 1000;

/// What `planFlight` returns.
#[derive(Serialize, tsify::Tsify)]
struct FlightPlan {
    overview: FlightOverview,
    tiles: Vec<TilePlan>,
    /// Why there are no tiles; null where there are.
    problem: Option<String>,
}

/// A tile before it is worked off.
#[derive(Serialize, tsify::Tsify)]
struct TilePlan {
    /// x0, y0, x1, y1, metres, world frame of the input.
    core: [f64; 4],
    /// The box of what its squares look at.
    region: [f64; 4],
    /// The views that it reads, and which part of each; none where it is left out.
    views: Vec<ViewWindow>,
    /// Memory that it takes at its peak, about, megabytes.
    memory_mb: u64,
    /// Why it is left out.
    left_out: Option<String>,
}

impl TilePlan {
    /// Without a view.
    fn new(tile: &Tile) -> Self {
        let regions = tile.cells.iter().map(|cell| cell.region);
        let around = |a: [f64; 4], b: [f64; 4]| {
            [
                a[0].min(b[0]),
                a[1].min(b[1]),
                a[2].max(b[2]),
                a[3].max(b[3]),
            ]
        };
        Self {
            core: tile.core,
            region: regions.reduce(around).unwrap_or(tile.core),
            views: Vec::new(),
            memory_mb: 0,
            left_out: None,
        }
    }

    /// Adds what one of its squares reads.
    fn add(&mut self, views: Vec<ViewWindow>, memory_mb: u64) {
        self.memory_mb = self.memory_mb.max(memory_mb);
        self.views.extend(views);
    }
}

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
        let flight = Flight::new(&self.files, &options, heights).map_err(|e| input_error(&e))?;
        let overview = flight.overview();
        // What whole photographs have beyond their first bytes: those of a tile are filled at once.
        let filled_mb = |views: &[ViewWindow]| {
            let is_read = |name: &str| views.iter().any(|view| view.view == name);
            let read = (overview.footprints.iter()).filter(|one| is_read(&one.view));
            let read = read.filter_map(|one| self.files.iter().find(|file| file.path == one.path));
            let beyond = read.map(|file| file.length() - file.first_bytes().len() as u64);
            beyond.sum::<u64>() >> 20
        };
        let tile = |tile: &Tile| {
            let mut planned = TilePlan::new(tile);
            for cell in &tile.cells {
                match flight.windows(cell.region) {
                    Ok((views, memory_mb)) => {
                        let unfilled = memory_mb.saturating_sub(filled_mb(&views));
                        planned.add(views, unfilled);
                    }
                    Err(error) => planned.left_out = planned.left_out.or(Some(error.to_string())),
                }
            }
            planned.left_out = planned.left_out.filter(|_| planned.views.is_empty());
            planned.memory_mb += filled_mb(&planned.views);
            planned
        };
        let planned = (options.roi.or(overview.shown)).map(|area| plan_tiles(area, tile_m));
        let (tiles, problem) = match planned {
            Some(Ok(tiles)) if tiles.len() > MOST_TILES => (
                Vec::new(),
                Some(format!(
                    "{} tiles are more than the page plans; choose a region, or larger tiles",
                    tiles.len()
                )),
            ),
            Some(Ok(tiles)) => (tiles, None),
            Some(Err(error)) => (Vec::new(), Some(error.to_string())),
            None => (
                Vec::new(),
                Some("no place is shown by three photographs".to_owned()),
            ),
        };
        let tiles = tiles.iter().map(tile).collect();
        to_js(&FlightPlan {
            overview,
            tiles,
            problem,
        })
    }

    /// The paths of the photographs in which `groundHeights` measures: to be filled.
    #[wasm_bindgen(js_name = groundFiles)]
    pub fn ground_files(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
        area: Vec<f64>,
    ) -> Result<Vec<String>, JsValue> {
        let needed = ground_files(&self.files, &load_options(&options)?, four(&area)?);
        Ok(self.lacking(&needed))
    }

    /// Lowest and highest ground of an area as the photographs in its middle show it, metres; null
    /// where they show too little.
    #[wasm_bindgen(js_name = groundHeights, unchecked_return_type = "[low: number, high: number] | null")]
    pub fn ground_heights(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
        area: Vec<f64>,
    ) -> Result<JsValue, JsValue> {
        to_js(&ground_heights(
            &self.files,
            &load_options(&options)?,
            four(&area)?,
        ))
    }

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
        let mut files = &self.files[..];
        let area = Area::plan(&mut files, &options, &self.params, tile_m);
        let area = self.area.insert(area.map_err(|e| input_error(&e))?);
        to_js(&area.tiles().iter().map(|t| t.core).collect::<Vec<_>>())
    }

    /// The paths of the photographs that a tile needs first, to measure the ground: to be filled.
    #[wasm_bindgen(js_name = groundFilesOfTile)]
    pub fn ground_files_of_tile(&self, index: usize) -> Result<Vec<String>, JsValue> {
        self.lacking_of_tile(index, files_of_ground)
    }

    /// The paths of the photographs that a tile makes views of, once the others are filled.
    #[wasm_bindgen(js_name = viewFilesOfTile)]
    pub fn view_files_of_tile(&self, index: usize) -> Result<Vec<String>, JsValue> {
        self.lacking_of_tile(index, files_of_views)
    }

    /// Works off a tile: its outcome as bytes, to be kept. `tileModel` shows it, `takeTile` goes on
    /// from it.
    #[wasm_bindgen(js_name = runTile, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn run_tile(
        &self,
        index: usize,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Result<Vec<u8>, JsValue> {
        let done = self
            .planned()?
            .work_off(&self.files, index, &listener_of(on_progress));
        done.ok_or_else(no_tile)
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
        self.outputs = Some(area.finish(&[]).map_err(|e| input_error(&e))?);
        Ok(())
    }

    /// The paths of the photographs that are not whole among those that the squares of a tile need.
    fn lacking_of_tile(
        &self,
        index: usize,
        needed: fn(&[InputFile], &LoadOptions) -> Vec<usize>,
    ) -> Result<Vec<String>, JsValue> {
        let cells = self.planned()?.options_of(index).ok_or_else(no_tile)?;
        let needed = cells.iter().flat_map(|cell| needed(&self.files, cell));
        let needed: BTreeSet<usize> = needed.collect();
        let needed: Vec<usize> = needed.into_iter().collect();
        Ok(self.lacking(&needed))
    }

    fn planned(&self) -> Result<&Area, JsValue> {
        self.area.as_ref().ok_or_else(not_planned)
    }
}

fn four(numbers: &[f64]) -> Result<[f64; 4], JsValue> {
    <[f64; 4]>::try_from(numbers)
        .map_err(|_| named_error("RangeError", "an area is x0, y0, x1, y1"))
}

fn not_planned() -> JsValue {
    named_error("RangeError", "no tiles are planned: call planTiles first")
}

fn no_tile() -> JsValue {
    named_error("RangeError", "there is no such tile")
}
