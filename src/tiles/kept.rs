//! The outcomes of an area's tiles as bytes that outlive the process: who keeps them goes on where
//! it ended, and holds one tile in memory at a time.
//!
//! Invariant: outcomes that were kept give the model of [`Area::step`], bit by bit.

use super::area::{Area, TileReport, work_off};
use super::join::join;
use super::part_file::{PartKey, TileOutcome};
use crate::error::{Error, Result};
use crate::execution::Listener;
use crate::export::{atlas_jpeg, glb};
use crate::orientation::InputFile;
use crate::scene_loader::LoadOptions;

impl Area {
    /// The options with which a tile is loaded; `None` where there is no such tile.
    pub fn options_of(&self, index: usize) -> Option<LoadOptions> {
        let tile = self.tiles.get(index)?;
        Some(LoadOptions {
            roi: Some(tile.region),
            ..self.options.clone()
        })
    }

    /// Works off a tile: its outcome as bytes; `None` where there is no such tile.
    pub fn work_off(
        &self,
        files: &[InputFile],
        index: usize,
        progress: &Listener,
    ) -> Option<Vec<u8>> {
        let tile = self.tiles.get(index)?;
        let (options, params) = (&self.options, &self.params);
        let (report, part) = work_off(files, options, params, tile, &self.whole, progress);
        let outcome = TileOutcome {
            report,
            part: part.ok(),
        };
        Some(self.key(index).pack(&outcome))
    }

    /// What a tile came to, and its model by itself (glTF, in the frame of the whole); refused where
    /// these bytes are not its outcome, whole.
    pub fn outcome(&self, index: usize, kept: &[u8]) -> Result<(TileReport, Option<Vec<u8>>)> {
        let TileOutcome { report, part } = self.key(index).unpack(kept)?;
        let model = part.filter(|part| !part.model.buildings.is_empty());
        let model = model.map(|part| {
            let joined = join(self.whole.clone(), std::slice::from_ref(&part));
            let atlas = atlas_jpeg(&joined.textured, self.params.texture.jpeg_quality);
            glb(&joined.scene, &joined.model, &joined.textured, &atlas)
        });
        Ok((report, model))
    }

    /// Takes the outcome of the next tile instead of working it off; [`Area::finish`] joins them.
    pub fn take(&mut self, kept: &[u8]) -> Result<()> {
        let TileOutcome { report, part } = self.key(self.reports.len()).unpack(kept)?;
        match part {
            Some(part) => self.parts.push(part),
            None => {
                self.first_error.get_or_insert_with(|| Error::Scene {
                    problem: format!("no tile could be read; the first one: {}", report.outcome),
                    advice: "choose another region, other views or another orientation".to_owned(),
                });
            }
        }
        self.reports.push(report);
        Ok(())
    }

    fn key(&self, index: usize) -> PartKey {
        PartKey {
            plan: self.sum,
            tile: u32::try_from(index + 1).expect("fewer than 2^32 tiles"),
        }
    }
}
