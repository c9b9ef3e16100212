//! The tiles of a block as a file, so that many processes, on as many computers as there are, make
//! one part each, and one joins them.
//!
//! The plan names every input file with its length and sum, of large photographs that of their
//! head, too. Each step compares all that it reads with these, so that a part made from
//! anything else is refused by the file's name; a part names the plan by the sum of the plan's
//! file.
//!
//! Invariant: the same plan and inputs give the same bytes of a part, and all parts the model that
//! [`Area`](super::Area) makes in one process.

use std::collections::BTreeMap;
use std::io::{self, Read};

use image::ImageFormat;
use serde::{Deserialize, Serialize};

use super::area::{Area, files_in_squares, join_cells, work_off};
use super::division::Division;
use super::look::Site;
use super::part_file::{PartKey, TileOutcome};
use super::seen_ground::SeenGround;
use super::tile::Tile;
use super::work_plan::PlannedTile;
use crate::base::error::{Error, Result};
use crate::base::execution::Listener;
use crate::base::execution::progress::silent;
use crate::base::params::Params;
use crate::orienting::orientation::{BLOCK_BYTES, FileSource, InputFile, Needed};
use crate::orienting::scene_loader::{LoadOptions, whole_views};
use crate::photographs::raster::image_format;

/// Where the files of a block came from, as it was stated: to find them again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockSource {
    /// The folder or archive.
    pub scene: String,
    /// The orientation that was chosen, or the folder beside the scene that holds it.
    pub orientation: Option<String>,
    /// Files of terrain and footprints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub known: Vec<String>,
}

/// An input file as it was when the plan was made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputStamp {
    /// Its path in the scene.
    pub file: String,
    /// Its length.
    pub bytes: u64,
    /// CRC-32 of its bytes. It tells accidents, not forgers; every change within 32 neighbouring
    /// bits is found, of others all but one in four thousand million.
    pub crc32: u32,
    /// Of a photograph the head, where steps that need no pixel of it read no more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub head: Option<HeadStamp>,
    /// Of a photograph that is read in blocks: CRC-32 of each block of 256 kB, eight hexadecimal
    /// digits each.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub blocks: String,
}

/// The head of a photograph as it was when the plan was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeadStamp {
    /// How many they are.
    pub bytes: u64,
    /// Their CRC-32.
    pub crc32: u32,
}

impl InputStamp {
    /// The stamp of a file that is whole.
    pub fn of_whole(file: &InputFile) -> Self {
        Self::new(file, file.bytes.len() as u64, crc32fast::hash(&file.bytes))
    }

    /// The stamp of a photograph of which the head is in memory; `whole` reads all of them.
    pub fn of_stream(file: &InputFile, mut whole: impl Read) -> io::Result<Self> {
        let (mut sum, mut length) = (crc32fast::Hasher::new(), 0);
        let mut blocks = String::new();
        let mut block = Vec::new();
        loop {
            block.clear();
            whole.by_ref().take(BLOCK_BYTES).read_to_end(&mut block)?;
            if block.is_empty() {
                break;
            }
            sum.update(&block);
            length += block.len() as u64;
            if image_format(&file.bytes) == Some(ImageFormat::Tiff) {
                blocks += &format!("{:08x}", crc32fast::hash(&block));
            }
        }
        Ok(Self {
            blocks,
            ..Self::new(file, length, sum.finalize())
        })
    }

    fn new(file: &InputFile, bytes: u64, crc32: u32) -> Self {
        let head = HeadStamp {
            bytes: file.head_length(),
            crc32: crc32fast::hash(&file.head()),
        };
        Self {
            file: file.path.clone(),
            bytes,
            crc32,
            head: (head.bytes < bytes).then_some(head),
            blocks: String::new(),
        }
    }

    /// Is a file as it was, as far as it is in memory?
    fn is_of(&self, file: &InputFile) -> bool {
        if file.lacking().is_none() {
            let bytes = &file.bytes;
            return (self.bytes, self.crc32) == (bytes.len() as u64, crc32fast::hash(bytes));
        }
        let found = Self {
            blocks: self.blocks.clone(),
            ..Self::new(file, file.length(), self.crc32)
        };
        found == *self && (file.filled_ranges()).all(|(place, bytes)| self.has(place.start, bytes))
    }

    /// Are these blocks, from a place on, as they were?
    fn has(&self, from: u64, blocks: &[u8]) -> bool {
        let first = (from / BLOCK_BYTES) as usize;
        let blocks = blocks.chunks(BLOCK_BYTES as usize).enumerate();
        blocks.into_iter().all(|(i, block)| {
            let at = 8 * (first + i);
            let stated = self.blocks.get(at..at + 8);
            stated == Some(&*format!("{:08x}", crc32fast::hash(block)))
        })
    }

    fn refuse(&self, problem: &str) -> Error {
        Error::file(
            &self.file,
            problem,
            "put back what the plan was made from, or plan again (ridgeline plan)",
        )
    }

    fn refuse_changed(&self) -> Error {
        self.refuse("the file has changed since the plan was made")
    }
}

/// The files of a plan, in its order; what becomes whole is compared with it.
struct Compared<'a> {
    source: &'a mut dyn FileSource,
    inputs: &'a [InputStamp],
}

impl FileSource for Compared<'_> {
    fn files(&self) -> &[InputFile] {
        self.source.files()
    }

    fn hold(&mut self, needed: &dyn Fn(&[InputFile]) -> Vec<Needed>) -> Result<()> {
        self.source.hold(needed)?;
        let held = self.inputs.iter().zip(self.source.files());
        let mut filled = held.filter(|(_, file)| file.is_filled());
        match filled.find(|(stamp, file)| !stamp.is_of(file)) {
            Some((stamp, _)) => Err(stamp.refuse_changed()),
            None => Ok(()),
        }
    }
}

/// A block divided into tiles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockPlan {
    /// Version of the program that made it.
    pub ridgeline: String,
    /// Where the files came from.
    pub source: BlockSource,
    /// Size of a tile as it was asked for, metres.
    pub tile_m: f64,
    /// Options of loading, with the region of interest.
    pub options: LoadOptions,
    /// Parameters of the stages.
    pub params: Params,
    /// The input files.
    pub inputs: Vec<InputStamp>,
    /// The tiles.
    pub tiles: Vec<PlannedTile>,
    /// The squares of the area that are left out because fewer than three views show their ground.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<[f64; 4]>,
    /// What a first look shows: the cells of the tiles lie around the sites that are worked on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sites: Vec<Site>,
    /// The ground as a first look shows it, centimetres.
    #[serde(default, skip_serializing_if = "SeenGround::is_empty")]
    pub(super) ground: SeenGround,
}

impl BlockPlan {
    /// Name of a plan's file in its folder.
    pub const FILE: &str = "tiles.json";

    /// Divides the region of interest into tiles of about `tile_m` metres; without a region the
    /// area that three views show. Photographs are decoded, which show where a roof may be.
    /// `inputs` are the stamps of all files.
    pub fn new(
        source: BlockSource,
        files: &mut dyn FileSource,
        inputs: Vec<InputStamp>,
        options: &LoadOptions,
        params: &Params,
        tile_m: f64,
    ) -> Result<Self> {
        let mut area = Area::plan(files, options, None, params, tile_m)?;
        area.look(files, &silent())?;
        Ok(Self {
            ridgeline: env!("CARGO_PKG_VERSION").to_owned(),
            source,
            tile_m,
            options: area.options,
            params: area.params,
            inputs,
            tiles: area.work.tiles,
            left_out: area.left_out,
            sites: area.sites,
            ground: area.seen.0.ground,
        })
    }

    /// How many squares are left out, and why; nothing where none are.
    pub fn left_out_in_words(&self) -> String {
        Division::left_out_in_words(&self.left_out)
    }

    /// The plan as a file.
    pub fn to_json(&self) -> Result<Vec<u8>> {
        let mut text = serde_json::to_vec_pretty(self).expect("a plan has string keys only");
        text.push(b'\n');
        // What is read is what counts, and long decimal fractions may be read otherwise in their
        // last bit.
        match Self::from_json(&text) {
            Ok(back) if back == *self => Ok(text),
            _ => Err(Error::scene(
                "the plan does not come back from its file as it was",
                "round the numbers of the region of interest and of the parameters to \
                         fifteen digits",
            )),
        }
    }

    /// A plan from its file.
    pub fn from_json(text: &[u8]) -> Result<Self> {
        let refuse = |problem: String, advice: &str| Error::file(Self::FILE, problem, advice);
        let plan: Self = serde_json::from_slice(text).map_err(|e| {
            refuse(
                format!("the plan cannot be read: {e}"),
                "make it again (ridgeline plan)",
            )
        })?;
        if plan.ridgeline != env!("CARGO_PKG_VERSION") {
            return Err(refuse(
                format!(
                    "the plan is of ridgeline {}, this is {}",
                    plan.ridgeline,
                    env!("CARGO_PKG_VERSION")
                ),
                "use the same version for all steps, or make the plan again",
            ));
        }
        Ok(plan)
    }

    /// Path of the part of a tile below the plan's folder; refused where there is no such tile.
    pub fn part_path(&self, tile: u32) -> Result<String> {
        self.planned(tile)?;
        Ok(PartKey { plan: 0, tile }.path())
    }

    /// The outcome of a tile in words, where these bytes are its part of this plan, whole.
    pub fn outcome_of(&self, text: &[u8], tile: u32, part: &[u8]) -> Option<String> {
        let outcome = key(text, tile).unpack(part).ok()?;
        Some(outcome.report.outcome)
    }

    /// Works off a tile: its part as a file, and the outcome in words. `text` is the plan's file;
    /// the files are those of [`Self::unchanged`], and photographs that have changed beyond their
    /// heads are refused when they become whole.
    pub fn work_off(
        &self,
        text: &[u8],
        tile: u32,
        files: &mut dyn FileSource,
        progress: &Listener,
    ) -> Result<(Vec<u8>, String)> {
        let planned = self.planned(tile)?;
        let whole = whole_views(files.files(), &self.options)?;
        let mut files = Compared {
            source: files,
            inputs: &self.inputs,
        };
        let place = Tile {
            core: planned.core,
            cells: planned.cells.iter().map(|cell| cell.place).collect(),
        };
        let (options, params) = (&self.options, &self.params);
        let known = (&whole, &self.ground);
        let worked = work_off(&mut files, options, params, &place, known, progress)?;
        let report = worked.report(&place);
        let words = report.outcome.clone();
        let outcome = TileOutcome {
            report,
            parts: worked.parts,
        };
        Ok((key(text, tile).pack(&outcome), words))
    }

    /// One model of all parts, as files. Of the scene's files, those of [`Self::unchanged`], no
    /// pixel is needed. `part` has the bytes of a tile's part, if there is one; missing, damaged
    /// and foreign ones are refused by name.
    pub fn join(
        &self,
        text: &[u8],
        files: &[InputFile],
        part: impl Fn(u32) -> Option<Vec<u8>>,
    ) -> Result<Vec<(String, Vec<u8>)>> {
        let bytes: Vec<Option<Vec<u8>>> = self.tiles.iter().map(|t| part(t.tile)).collect();
        let missing: Vec<u32> = (self.tiles.iter().zip(&bytes))
            .filter(|(_, bytes)| bytes.is_none())
            .map(|(planned, _)| planned.tile)
            .collect();
        if let Some(first) = missing.first() {
            return Err(missing_parts(&missing, *first));
        }
        let whole = whole_views(files, &self.options)?;
        let mut reports = Vec::new();
        let mut parts = Vec::new();
        for (planned, bytes) in self.tiles.iter().zip(bytes.iter().flatten()) {
            let outcome = key(text, planned.tile).unpack(bytes)?;
            reports.push(outcome.report);
            parts.extend(outcome.parts);
        }
        if let (true, Some(first)) = (parts.is_empty(), reports.first()) {
            return Err(Error::scene(
                format!("no tile could be read; the first one: {}", first.outcome),
                "plan again with another region, other views or another orientation",
            ));
        }
        let joined = join_cells(whole, &mut parts);
        let found = (&self.sites[..], &reports[..]);
        Ok(files_in_squares(&joined, &parts, &self.params, found, &[]))
    }

    fn planned(&self, tile: u32) -> Result<&PlannedTile> {
        let found = self.tiles.iter().find(|planned| planned.tile == tile);
        found.ok_or_else(|| {
            Error::scene(
                format!("the plan has no tile {tile}"),
                format!("choose one from 1 to {}", self.tiles.len()),
            )
        })
    }

    /// The files of the plan among these, in its order; refused by name where one is missing or
    /// has changed, as far as it is in memory. What has come since is left out: results, for
    /// example.
    pub fn unchanged(&self, files: Vec<InputFile>) -> Result<Vec<InputFile>> {
        let mut files: BTreeMap<String, InputFile> = (files.into_iter())
            .map(|file| (file.path.clone(), file))
            .collect();
        let mut same = |planned: &InputStamp| {
            let file = (files.remove(&planned.file))
                .ok_or_else(|| planned.refuse("the file is missing since the plan was made"))?;
            match planned.is_of(&file) {
                true => Ok(file),
                false => Err(planned.refuse_changed()),
            }
        };
        self.inputs.iter().map(&mut same).collect()
    }
}

fn key(plan: &[u8], tile: u32) -> PartKey {
    let plan = crc32fast::hash(plan);
    PartKey { plan, tile }
}

/// The refusal of parts that are not there.
fn missing_parts(missing: &[u32], first: u32) -> Error {
    // Assumption: whoever reads ten knows which machine they were lost on.
    const MOST_NAMED: usize = 10;
    let path = |tile: &u32| {
        PartKey {
            plan: 0,
            tile: *tile,
        }
        .path()
    };
    let mut names: Vec<String> = missing.iter().take(MOST_NAMED).map(path).collect();
    if missing.len() > MOST_NAMED {
        names.push(format!("and {} more", missing.len() - MOST_NAMED));
    }
    let are = if missing.len() == 1 {
        "the part is"
    } else {
        "the parts are"
    };
    Error::file(
        names.join(", "),
        format!("{are} missing"),
        format!("make what is missing (ridgeline tile PLAN {first})"),
    )
}
