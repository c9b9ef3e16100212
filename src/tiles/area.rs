//! A large area, worked off tile by tile: the command line and the page both go this way.
//!
//! Only one cell is in memory at a time, beside what earlier ones found and the heads of all
//! photographs: its views are read anew from the files.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::division::Division;
use super::join::{CellPart, Joined, join};
use super::look::{self, FirstLook, Sightings, Site};
use super::model_parts::{subset, walls_of};
use super::seen_ground::{SeenGround, options_of};
use super::tile::{Cell, Tile};
use super::work_plan::WorkPlan;
use crate::base::error::{Error, Result};
use crate::base::execution::Listener;
use crate::base::ids::ViewId;
use crate::base::params::Params;
use crate::orienting::orientation::{FileSource, InputFile};
use crate::orienting::scene::{Scene, View};
use crate::orienting::scene_loader::{
    LoadOptions, PlannedScene, ShownArea, finer_than, ground_files, ground_heights, settled_on,
    whole_views,
};
use crate::pipeline::{Run, Stage, counted};
use crate::planes::terrain::Ground;
use crate::results::export::ReportedModel;
use crate::results::texture::texture_model;
use crate::roofs::walls::place_walls_of;

/// Names and bytes.
type Files = Vec<(String, Vec<u8>)>;

/// An area, its tiles, and what those that are done have found.
#[derive(Clone, Debug)]
pub struct Area {
    pub(super) whole: Scene,
    pub(super) options: LoadOptions,
    /// Did the person state by how much photographs are reduced?
    is_reduction_stated: bool,
    /// Lowest and highest ground, metres, world frame, where it is known.
    heights: Option<[f64; 2]>,
    pub(super) params: Params,
    pub(super) tiles: Vec<Tile>,
    pub(super) left_out: Vec<[f64; 4]>,
    pub(super) look: FirstLook,
    /// What the squares show that were looked at, and how many those are.
    pub(super) seen: (Sightings, usize),
    /// What is connected of that.
    pub(super) sites: Vec<Site>,
    /// What the cells read, and the order in which they are worked off, after the look.
    pub(super) work: WorkPlan,
    /// Sum of all that the tiles are made from, but for their cells.
    made_from: u32,
    /// What the cells of the tile have found that is being worked off cell by cell.
    pub(super) begun: WorkedTile,
    pub(super) parts: Vec<CellPart>,
    pub(super) reports: BTreeMap<usize, TileReport>,
    pub(super) first_error: Option<Error>,
}

/// The outcome of a tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct TileReport {
    /// The part of the area that it is responsible for: x0, y0, x1, y1, metres.
    pub core: [f64; 4],
    /// How many buildings it found, or why none was sought.
    pub outcome: String,
    /// Could none of its cells be loaded?
    pub is_left_out: bool,
}

impl Area {
    /// Divides the region of interest into tiles of about `tile_m` metres; without a region the
    /// area that three views show. `ground` has its lowest and highest height where they were
    /// measured, metres, world frame: they are not measured again then.
    pub fn plan(
        source: &mut dyn FileSource,
        options: &LoadOptions,
        ground: Option<[f64; 2]>,
        params: &Params,
        tile_m: f64,
    ) -> Result<Self> {
        refuse_corrections(params)?;
        if options.apply_fix {
            return Err(Error::scene(
                "tiles take the orientation as it is",
                "correct the orientation file, or work off all at once (without --tile)",
            ));
        }
        let stated = options.ground_z.map(|z| [z, z]);
        let mut heights = stated.or(ground);
        if heights.is_none() {
            source.hold(&|files| ground_files(files, options))?;
            heights = ground_heights(source.files(), options);
            source.hold(&|_| Vec::new())?;
        }
        let files = source.files();
        let mut settled = settled_on(files, options, heights);
        let divided = match options.roi {
            Some(roi) => Division::of_region(roi, tile_m)?,
            None => Division::of_shown(&ShownArea::new(files, &settled, heights)?, tile_m)?,
        };
        let Division {
            area,
            tiles,
            left_out,
        } = divided;
        settled.roi = Some(area);
        let small = finer_than(look::LOOK_PIXEL_M, files, &settled, heights);
        Ok(Self {
            made_from: sum_of(files, &settled, params),
            work: WorkPlan::unplanned(&tiles),
            tiles,
            left_out,
            look: FirstLook::new(area, small, params)?,
            seen: (Sightings::default(), 0),
            sites: Vec::new(),
            whole: whole_views(files, &settled)?,
            options: settled,
            is_reduction_stated: options.reduction.is_some(),
            heights,
            params: params.clone(),
            begun: WorkedTile::default(),
            parts: Vec::new(),
            reports: BTreeMap::new(),
            first_error: None,
        })
    }

    /// All tiles, in their order.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    /// Views, area and tiles, in a sentence.
    pub fn in_words(&self) -> String {
        let [x0, y0, x1, y1] = self.options.roi.expect("an area has one");
        format!(
            "{}; area {x0:.0},{y0:.0},{x1:.0},{y1:.0} ({:.0} x {:.0} m) in {}{}",
            counted(self.whole.views.len(), "views"),
            x1 - x0,
            y1 - y0,
            counted(self.tiles.len(), "tiles"),
            Division::left_out_in_words(&self.left_out)
        )
    }

    /// Looks at the whole area, in small photographs: the cells of the tiles then lie where a roof
    /// may be. Before, they cover the area. An error says which photograph cannot be had.
    pub fn look(&mut self, source: &mut dyn FileSource, progress: &Listener) -> Result<()> {
        self.seen.0 = self.look.all(source, progress)?;
        self.place_cells(source.files())
    }

    /// How many squares [`Self::look`] looks at.
    pub fn squares_to_look_at(&self) -> usize {
        self.look.len()
    }

    /// The options with which such a square is loaded; `None` where there is no such square.
    pub fn options_of_look(&self, index: usize) -> Option<LoadOptions> {
        self.look.options(index)
    }

    /// What a square shows that is looked at, as bytes to be kept; `None` where there is no such
    /// square.
    pub fn look_at(
        &self,
        mut files: &[InputFile],
        index: usize,
        progress: &Listener,
    ) -> Option<Vec<u8>> {
        (index < self.look.len()).then(|| {
            let seen = self.look.at(index, &mut files, progress);
            seen.expect("files in memory can be had").to_bytes()
        })
    }

    /// Takes what the next square shows; after the last one the cells lie where a roof may be. Of
    /// the files their heads suffice. Refused where the bytes are not that.
    pub fn take_look(&mut self, files: &[InputFile], seen: &[u8]) -> Result<()> {
        self.seen.0.add(Sightings::of_bytes(seen)?);
        self.seen.1 += 1;
        match self.seen.1 == self.look.len() {
            true => self.place_cells(files),
            false => Ok(()),
        }
    }

    /// Lays the cells where a roof may be, and plans what they read; photographs are reduced as far
    /// as memory asks for, unless somebody states by how much.
    fn place_cells(&mut self, files: &[InputFile]) -> Result<()> {
        let area = self.options.roi.expect("an area has one");
        let seen = &self.seen.0;
        self.sites = seen.place_cells(&mut self.tiles, area);
        let planned = |options: &LoadOptions| {
            let laid = (&self.tiles[..], &self.sites[..]);
            WorkPlan::new(files, options, self.heights, laid, &seen.ground)
        };
        self.work = planned(&self.options)?;
        while let Some(reduction) = self.work.fitting()
            && !self.is_reduction_stated
        {
            self.options.reduction = Some(reduction);
            self.work = planned(&self.options)?;
        }
        self.whole = whole_views(files, &self.options)?;
        self.made_from = sum_of(files, &self.options, &self.params);
        Ok(())
    }

    /// What the cells read and the order in which they are worked off, once all was looked at.
    pub fn work(&self) -> &WorkPlan {
        &self.work
    }

    /// Sum of all that the tiles are made from.
    pub(super) fn sum(&self) -> u32 {
        let tiles = serde_json::to_vec(&self.tiles).expect("all keys are strings");
        let mut sum = crc32fast::Hasher::new_with_initial(self.made_from);
        sum.update(&tiles);
        sum.finalize()
    }

    /// What a first look shows, in a sentence.
    pub fn seen_in_words(&self) -> String {
        let worked_on: Vec<&Site> = self.sites.iter().filter(|site| site.is_worked_on).collect();
        let area_m2: f64 = worked_on.iter().map(|site| site.area_m2).sum();
        let tiles = self.tiles.iter().filter(|tile| !tile.cells.is_empty());
        format!(
            "a first look: {} where a roof may be, {area_m2:.0} m² in {}; {} where none is",
            counted(worked_on.len(), "places"),
            counted(tiles.count(), "tiles"),
            self.sites.len() - worked_on.len(),
        )
    }

    /// Works off the next tile in their order, and says which; `None` when all are done. A tile
    /// that the views do not show is left out; an error says which photograph cannot be had any
    /// more. `progress` hears fractions of this tile's work.
    pub fn step(
        &mut self,
        source: &mut dyn FileSource,
        progress: &Listener,
    ) -> Result<Option<(usize, &TileReport)>> {
        let Some(&index) = self.work.order.get(self.reports.len()) else {
            return Ok(None);
        };
        let (options, params) = (&self.options, &self.params);
        let known = (&self.whole, &self.seen.0.ground);
        let tile = &self.tiles[index];
        let worked = work_off(source, options, params, tile, known, progress)?;
        let report = worked.report(tile);
        self.parts.extend(worked.parts);
        if let Some(error) = worked.first_error {
            self.first_error.get_or_insert(error);
        }
        Ok(Some((index, self.reports.entry(index).or_insert(report))))
    }

    /// One model of all tiles, as files, and as the roof report states it, whatever the order in
    /// which they were done; the first error where no tile could be read. `seconds` of each tile go
    /// into `report.json` and may be empty.
    pub fn finish(mut self, seconds: &[f64]) -> Result<(Files, ReportedModel)> {
        let joined = self.join()?;
        let reports: Vec<TileReport> = self.reports.into_values().collect();
        let done = (&self.sites[..], &reports[..]);
        let reported = ReportedModel::of(&joined.scene, &joined.model, &joined.walls);
        Ok((model_files(&joined, &self.params, done, seconds), reported))
    }

    /// The same with 3D Tiles of a file for each square, so that a viewer fetches what it shows.
    pub fn finish_in_squares(mut self, seconds: &[f64]) -> Result<Files> {
        let joined = self.join()?;
        let reports: Vec<TileReport> = self.reports.into_values().collect();
        let done = (&self.sites[..], &reports[..]);
        Ok(files_in_squares(
            &joined,
            &self.parts,
            &self.params,
            done,
            seconds,
        ))
    }

    fn join(&mut self) -> Result<Joined> {
        match self.first_error.take() {
            Some(error) if self.parts.is_empty() => Err(error),
            _ => Ok(join_cells(self.whole.clone(), &mut self.parts)),
        }
    }
}

/// CRC-32 of the version, the options, the parameters and the files; of photographs the head may
/// stand for all.
fn sum_of(files: &[InputFile], options: &LoadOptions, params: &Params) -> u32 {
    #[derive(Serialize)]
    struct Made<'a> {
        version: &'a str,
        options: &'a LoadOptions,
        params: &'a Params,
        files: Vec<(&'a str, u32)>,
    }
    let made = Made {
        version: env!("CARGO_PKG_VERSION"),
        options,
        params,
        files: (files.iter())
            .map(|file| (&*file.path, crc32fast::hash(&file.head())))
            .collect(),
    };
    crc32fast::hash(&serde_json::to_vec(&made).expect("all keys are strings"))
}

/// Refuses corrections by hand. A building at a seam is in the models of several cells; whether a
/// correction applies in the one that keeps it is known only when they are joined.
pub fn refuse_corrections(params: &Params) -> Result<()> {
    match params.corrections.is_empty() {
        true => Ok(()),
        false => Err(Error::scene(
            "corrections by hand do not go with tiles",
            "reconstruct the part that they are about by itself (--roi), or leave them out",
        )),
    }
}

/// What is said of a tile without cells.
pub(super) const NOTHING_SEEN: &str = "a first look shows nothing here that may be a roof";

/// What the cells of a tile have come to.
#[derive(Clone, Debug, Default)]
pub(super) struct WorkedTile {
    /// The cell that is loaded and not worked off yet.
    loaded: Option<Scene>,
    /// What was found in the cells that the views show.
    pub parts: Vec<CellPart>,
    /// Why the first of the others was left out.
    pub first_error: Option<Error>,
}

impl WorkedTile {
    /// Loads a cell with these options. An error says which photograph cannot be had.
    pub(super) fn load(
        &mut self,
        source: &mut dyn FileSource,
        options: &LoadOptions,
    ) -> Result<()> {
        let planned = PlannedScene::new(source, options)?;
        match planned.load(source.files()) {
            Ok(scene) => self.loaded = Some(scene),
            Err(error) => {
                self.first_error.get_or_insert(error);
            }
        }
        source.hold(&|_| Vec::new())
    }

    /// Works off the cell that was loaded, if it could be. `whole` has all views.
    pub(super) fn run(
        &mut self,
        params: &Params,
        cell: &Cell,
        (whole, ground): (&Scene, &SeenGround),
        progress: &Listener,
    ) {
        if let Some(scene) = self.loaded.take() {
            let ground = ground.within(cell.region, &scene.origin);
            (self.parts).push(part(scene, params, (cell, ground), whole, progress));
        }
        progress(1.0);
    }

    pub(super) fn report(&self, tile: &Tile) -> TileReport {
        let parts = self.parts.iter();
        let buildings = parts.map(|part| part.model.buildings.len()).sum();
        let outcome = match &self.first_error {
            Some(error) if self.parts.is_empty() => error.to_string(),
            _ if tile.cells.is_empty() => NOTHING_SEEN.to_owned(),
            _ => counted(buildings, "buildings"),
        };
        TileReport {
            core: tile.core,
            outcome,
            is_left_out: self.parts.is_empty() && self.first_error.is_some(),
        }
    }
}

/// Works off the cells of a tile, one after the other: the photographs of one are whole while it is
/// loaded. `known` has all views, and the ground. An error says which photograph cannot be had.
pub(super) fn work_off(
    source: &mut dyn FileSource,
    options: &LoadOptions,
    params: &Params,
    tile: &Tile,
    known: (&Scene, &SeenGround),
    progress: &Listener,
) -> Result<WorkedTile> {
    let mut worked = WorkedTile::default();
    let count = tile.cells.len() as f64;
    for (i, cell) in tile.cells.iter().enumerate() {
        let of_tile = Listener::clone(progress);
        let listener: Listener = Arc::new(move |fraction| of_tile((i as f64 + fraction) / count));
        worked.load(source, &options_of(cell, options, known.1))?;
        worked.run(params, cell, known, &listener);
    }
    Ok(worked)
}

/// Joins the parts of all cells in the order of the grid, whatever the tiles were.
pub(super) fn join_cells(whole: Scene, parts: &mut [CellPart]) -> Joined {
    let place = |part: &CellPart| {
        let [x0, y0, x1, y1] = part.cell.core;
        [y0, x0, y1, x1]
    };
    parts.sort_by(|a, b| place(a).partial_cmp(&place(b)).unwrap_or(Ordering::Equal));
    join(whole, parts)
}

/// The files of the model of all tiles, with a report and 3D Tiles of a file for each square, where
/// several have buildings; `parts` are those that were joined.
pub(super) fn files_in_squares(
    joined: &Joined,
    parts: &[CellPart],
    params: &Params,
    done: (&[Site], &[TileReport]),
    seconds: &[f64],
) -> Files {
    let mut files = model_files(joined, params, done, seconds);
    if joined.squares_with_buildings() > 1 {
        let squares = joined.squares(parts, params.texture.jpeg_quality);
        files.retain(|(name, _)| squares.iter().all(|(other, _)| other != name));
        files.extend(squares);
    }
    files
}

/// The files of the model of all tiles, with a report.
pub(super) fn model_files(
    joined: &Joined,
    params: &Params,
    (sites, reports): (&[Site], &[TileReport]),
    seconds: &[f64],
) -> Files {
    let left_out = sites.iter().filter(|site| !site.is_worked_on);
    let mut files = joined.files(&params.texture);
    let report = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "origin": joined.scene.origin.as_slice(),
        "coordinates": joined.scene.survey.describe(),
        "buildings": joined.model.buildings.len(),
        "facets": joined.model.facets.len(),
        "tiles": reports,
        "left_out": left_out.collect::<Vec<&Site>>(),
        "seconds": seconds,
        "warnings": joined.scene.warnings,
        "params": params,
    });
    let report = serde_json::to_vec_pretty(&report).expect("a report has string keys only");
    files.push(("report.json".to_owned(), report));
    files
}

/// What one cell shows.
fn part(
    scene: Scene,
    params: &Params,
    (cell, mut ground): (&Cell, Option<Ground>),
    whole: &Scene,
    progress: &Listener,
) -> CellPart {
    let views = places(&scene, whole);
    let mut run = Run::new(scene, params.clone());
    let stages: Vec<Stage> = (run.stages().into_iter())
        .filter(|&stage| stage != Stage::Model)
        .collect();
    for (i, &stage) in stages.iter().enumerate() {
        let (done, all) = (i as f64, stages.len() as f64);
        let of_cell = Listener::clone(progress);
        let listener: Listener = Arc::new(move |fraction| of_cell((done + fraction) / all));
        match ground.take_if(|_| stage == Stage::Ground) {
            Some(ground) => run.take_ground(ground),
            None => {
                run.step(stage, &listener);
            }
        }
    }
    let (scene, results) = (run.scene(), run.results());
    let found = "the stages have run";
    let all = results.roof_model().expect(found);
    let kept = cell.keep(all, &scene.origin);
    let model = subset(all, &kept);
    let walls = (place_walls_of(scene, all, &kept, results.ground.as_ref()).into_iter())
        .zip(kept.iter().zip(&model.buildings))
        .map(|(walls, (&b, own))| walls_of(&walls, &all.buildings[b], own, &Vector3::zeros()))
        .collect();
    let (textured, _) = texture_model(scene, &model, &params.texture);
    let (segments, lines) = results.segments_and_lines(scene).expect(found);
    let half_planes = results
        .half_planes
        .as_ref()
        .map(|found| found.value.clone());
    CellPart {
        cell: *cell,
        origin: scene.origin,
        views,
        segments: segments.into_owned(),
        lines: lines.into_owned(),
        half_planes: half_planes.unwrap_or_default(),
        candidates: results.candidates(),
        model,
        walls,
        textured,
    }
}

/// Where the parts of the views lie in the whole images, pixels.
fn places(scene: &Scene, whole: &Scene) -> Vec<(ViewId, [f64; 4])> {
    let place = |view: &View| {
        let named = whole.views.iter().position(|w| w.name == view.name);
        let index = named.expect("tiles show views of the scene");
        let (a, b) = (&whole.views[index].camera, &view.camera);
        let [x, y] = [0, 1].map(|i| (a.k[(i, 2)] - b.k[(i, 2)]).round());
        let place = [x, y, f64::from(b.width), f64::from(b.height)];
        (ViewId::from_index(index), place)
    };
    scene.views.iter().map(place).collect()
}
