//! A large area, worked off tile by tile: the command line and the page both go this way.
//!
//! Only one cell is in memory at a time, beside what earlier ones found and the heads of all
//! photographs: its views are read anew from the files.

use std::sync::Arc;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::division::Division;
use super::join::{CellPart, Joined, join};
use super::look::{self, FirstLook, Sightings, Site};
use super::model_parts::{subset, walls_of};
use super::seen_ground::SeenGround;
use super::tile::{Cell, Tile};
use crate::base::error::{Error, Result};
use crate::base::execution::Listener;
use crate::base::ids::ViewId;
use crate::base::params::Params;
use crate::orienting::orientation::{FileSource, InputFile};
use crate::orienting::scene::{Scene, View};
use crate::orienting::scene_loader::{
    LoadOptions, PlannedScene, ShownArea, files_of_settling, finer_than, settled, whole_views,
};
use crate::pipeline::{Run, Stage, counted};
use crate::planes::terrain::Ground;
use crate::results::texture::texture_model;
use crate::roofs::walls::place_walls_of;

/// An area, its tiles, and what those that are done have found.
#[derive(Clone, Debug)]
pub struct Area {
    pub(super) whole: Scene,
    pub(super) options: LoadOptions,
    pub(super) params: Params,
    pub(super) tiles: Vec<Tile>,
    left_out: Vec<[f64; 4]>,
    pub(super) look: FirstLook,
    /// What the squares show that were looked at, and how many those are.
    pub(super) seen: (Sightings, usize),
    /// What is connected of that.
    sites: Vec<Site>,
    /// Sum of all that the tiles are made from, but for their cells.
    made_from: u32,
    pub(super) parts: Vec<CellPart>,
    pub(super) reports: Vec<TileReport>,
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
        let (options, divided, look) = divided(source, options, ground, (params, tile_m))?;
        let Division {
            tiles, left_out, ..
        } = divided;
        let files = source.files();
        Ok(Self {
            made_from: sum_of(files, &options, params),
            tiles,
            left_out,
            look,
            seen: (Sightings::default(), 0),
            sites: Vec::new(),
            whole: whole_views(files, &options)?,
            options,
            params: params.clone(),
            parts: Vec::new(),
            reports: Vec::new(),
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
        self.place_cells();
        Ok(())
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

    /// Takes what the next square shows; after the last one the cells lie where a roof may be.
    /// Refused where the bytes are not that.
    pub fn take_look(&mut self, seen: &[u8]) -> Result<()> {
        self.seen.0.add(Sightings::of_bytes(seen)?);
        self.seen.1 += 1;
        if self.seen.1 == self.look.len() {
            self.place_cells();
        }
        Ok(())
    }

    fn place_cells(&mut self) {
        let area = self.options.roi.expect("an area has one");
        self.sites = self.seen.0.place_cells(&mut self.tiles, area);
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

    /// The reports of the tiles that are done.
    pub fn reports(&self) -> &[TileReport] {
        &self.reports
    }

    /// Works off the next tile; `None` when all are done. A tile that the views do not show is left
    /// out; an error says which photograph cannot be had any more. `progress` hears fractions of
    /// this tile's work.
    pub fn step(
        &mut self,
        source: &mut dyn FileSource,
        progress: &Listener,
    ) -> Result<Option<&TileReport>> {
        let Some(tile) = self.tiles.get(self.reports.len()) else {
            return Ok(None);
        };
        let (options, params) = (&self.options, &self.params);
        let known = (&self.whole, &self.seen.0.ground);
        let worked = work_off(source, options, params, tile, known, progress)?;
        self.parts.extend(worked.parts);
        if let Some(error) = worked.first_error {
            self.first_error.get_or_insert(error);
        }
        self.reports.push(worked.report);
        Ok(self.reports.last())
    }

    /// One model of all tiles, as files; the first error where no tile could be read. `seconds`
    /// of each tile go into `report.json` and may be empty.
    pub fn finish(mut self, seconds: &[f64]) -> Result<Vec<(String, Vec<u8>)>> {
        let joined = self.join()?;
        let done = (&self.sites[..], &self.reports[..]);
        Ok(model_files(&joined, &self.params, done, seconds))
    }

    /// The same with 3D Tiles of a file for each square, so that a viewer fetches what it shows.
    pub fn finish_in_squares(mut self, seconds: &[f64]) -> Result<Vec<(String, Vec<u8>)>> {
        let joined = self.join()?;
        let done = (&self.sites[..], &self.reports[..]);
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
        false => Err(Error::Scene {
            problem: "corrections by hand do not go with tiles".to_owned(),
            advice: "reconstruct the part that they are about by itself (--roi), or leave them out"
                .to_owned(),
        }),
    }
}

/// The tiles of the region of interest, or of the area that the views show, the options with all
/// that is decided once for the whole area, and the first look at it; refused where the options do
/// not go with tiles.
pub(super) fn divided(
    source: &mut dyn FileSource,
    options: &LoadOptions,
    ground: Option<[f64; 2]>,
    (params, tile_m): (&Params, f64),
) -> Result<(LoadOptions, Division, FirstLook)> {
    if options.apply_fix {
        return Err(Error::Scene {
            problem: "tiles take the orientation as it is".to_owned(),
            advice: "correct the orientation file, or work off all at once (without --tile)"
                .to_owned(),
        });
    }
    source.hold(&|files| files_of_settling(files, options))?;
    let files = source.files();
    let mut options = settled(files, options);
    let divided = match options.roi {
        Some(roi) => Division::of_region(roi, tile_m)?,
        None => Division::of_shown(&ShownArea::new(files, &options, ground)?, tile_m)?,
    };
    options.roi = Some(divided.area);
    let small = finer_than(look::LOOK_PIXEL_M, files, &options, ground);
    let look = FirstLook::new(divided.area, small, params)?;
    Ok((options, divided, look))
}

/// What is said of a tile without cells.
pub(super) const NOTHING_SEEN: &str = "a first look shows nothing here that may be a roof";

/// What became of a tile.
pub(super) struct WorkedTile {
    pub report: TileReport,
    /// What was found in the cells that the views show.
    pub parts: Vec<CellPart>,
    /// Why the first of the others was left out.
    pub first_error: Option<Error>,
}

/// Works off the cells of a tile, one after the other: the photographs of one are whole until those
/// of the next one are known. `whole` has all views. An error says which photograph cannot be had.
pub(super) fn work_off(
    source: &mut dyn FileSource,
    options: &LoadOptions,
    params: &Params,
    tile: &Tile,
    (whole, ground): (&Scene, &SeenGround),
    progress: &Listener,
) -> Result<WorkedTile> {
    let mut parts = Vec::new();
    let mut first_error = None;
    let count = tile.cells.len() as f64;
    for (i, cell) in tile.cells.iter().enumerate() {
        let options = LoadOptions {
            roi: Some(cell.region),
            ..options.clone()
        };
        let of_tile = Listener::clone(progress);
        let listener: Listener = Arc::new(move |fraction| of_tile((i as f64 + fraction) / count));
        let planned = PlannedScene::new(source, &options)?;
        match planned.load(source.files()) {
            Ok(scene) => {
                let ground = ground.within(cell.region, &scene.origin);
                parts.push(part(scene, params, (cell, ground), whole, &listener));
            }
            Err(error) => {
                first_error.get_or_insert(error);
            }
        }
        listener(1.0);
    }
    source.hold(&|_| Vec::new())?;
    let buildings = parts.iter().map(|part| part.model.buildings.len()).sum();
    let outcome = match &first_error {
        Some(error) if parts.is_empty() => error.to_string(),
        _ if tile.cells.is_empty() => NOTHING_SEEN.to_owned(),
        _ => counted(buildings, "buildings"),
    };
    Ok(WorkedTile {
        report: TileReport {
            core: tile.core,
            outcome,
            is_left_out: parts.is_empty() && first_error.is_some(),
        },
        parts,
        first_error,
    })
}

/// Joins the parts of all cells in the order of the grid, whatever the tiles were.
pub(super) fn join_cells(whole: Scene, parts: &mut [CellPart]) -> Joined {
    let place = |part: &CellPart| part.cell.core;
    parts.sort_by(|a, b| {
        let ([ax, ay, ..], [bx, by, ..]) = (place(a), place(b));
        ay.total_cmp(&by).then(ax.total_cmp(&bx))
    });
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
) -> Vec<(String, Vec<u8>)> {
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
) -> Vec<(String, Vec<u8>)> {
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
