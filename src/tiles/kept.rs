//! The outcomes of an area's tiles as bytes that outlive the process: who keeps them goes on where
//! it ended, and holds one tile in memory at a time.
//!
//! Invariant: outcomes that were kept give the model of [`Area::step`], bit by bit.

use super::area::{Area, TileReport};
use super::join::join;
use super::part_file::{PartKey, TileOutcome};
use super::seen_ground::options_of;
use crate::base::error::{Error, Result};
use crate::base::execution::Listener;
use crate::orienting::orientation::InputFile;
use crate::orienting::scene_loader::LoadOptions;
use crate::results::export::{atlas_jpeg, glb};

impl Area {
    /// The options with which a cell of a tile is loaded; `None` where there is none.
    pub fn options_of(&self, index: usize, cell: usize) -> Option<LoadOptions> {
        let cell = self.tiles.get(index)?.cells.get(cell)?;
        Some(options_of(cell, &self.options, &self.seen.0.ground))
    }

    /// Loads a cell of a tile; `None` where there is none.
    pub fn load(&mut self, mut files: &[InputFile], index: usize, cell: usize) -> Option<()> {
        let options = self.options_of(index, cell)?;
        let loaded = self.begun.load(&mut files, &options);
        loaded.expect("files in memory can be had");
        Some(())
    }

    /// Works off a cell of a tile that is loaded, the others of which have been worked off before;
    /// [`Self::outcome_of`] has what all of them came to. `None` where there is none.
    pub fn work_off(&mut self, index: usize, cell: usize, progress: &Listener) -> Option<()> {
        let cell = self.tiles.get(index)?.cells.get(cell)?;
        let known = (&self.whole, &self.seen.0.ground);
        self.begun.run(&self.params, cell, known, progress);
        Some(())
    }

    /// What the cells of a tile came to, which have been worked off, as bytes; `None` where there
    /// is no such tile.
    pub fn outcome_of(&mut self, index: usize) -> Option<Vec<u8>> {
        let tile = self.tiles.get(index)?;
        let worked = std::mem::take(&mut self.begun);
        let outcome = TileOutcome {
            report: worked.report(tile),
            parts: worked.parts,
        };
        Some(self.key(index).pack(&outcome))
    }

    /// What a tile came to, and its model by itself (glTF, in the frame of the whole); refused
    /// where these bytes are not its outcome, whole.
    pub fn outcome(&self, index: usize, kept: &[u8]) -> Result<(TileReport, Option<Vec<u8>>)> {
        let TileOutcome { report, parts } = self.key(index).unpack(kept)?;
        let is_built = parts.iter().any(|part| !part.model.buildings.is_empty());
        let model = is_built.then(|| {
            let joined = join(self.whole.clone(), &parts);
            let atlas = atlas_jpeg(&joined.textured, self.params.texture.jpeg_quality);
            glb(&joined.scene, &joined.model, &joined.textured, &atlas)
        });
        Ok((report, model))
    }

    /// Takes the outcome of the next tile instead of working it off; [`Area::finish`] joins them.
    pub fn take(&mut self, kept: &[u8]) -> Result<()> {
        let TileOutcome { report, parts } = self.key(self.reports.len()).unpack(kept)?;
        if report.is_left_out {
            self.first_error.get_or_insert_with(|| {
                Error::scene(
                    format!("no tile could be read; the first one: {}", report.outcome),
                    "choose another region, other views or another orientation",
                )
            });
        }
        self.parts.extend(parts);
        self.reports.insert(self.reports.len(), report);
        Ok(())
    }

    fn key(&self, index: usize) -> PartKey {
        PartKey {
            plan: self.sum(),
            tile: u32::try_from(index + 1).expect("fewer than 2^32 tiles"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::execution::progress::silent;
    use crate::orienting::synthetic::{gable_scene, to_files};

    fn files() -> Vec<InputFile> {
        let (scene, _) = gable_scene(48);
        let files = to_files(&scene).into_iter();
        files
            .map(|(path, bytes)| InputFile::new(&path, bytes))
            .collect()
    }

    /// Two tiles that no view shows: nothing is computed.
    fn area(mut files: &[InputFile], east: f64) -> Area {
        let options = LoadOptions {
            orientation: Some("colmap".to_owned()),
            roi: Some([5040.0, 0.0, 5040.0 + east, 50.0]),
            ground_z: Some(0.0),
            ..LoadOptions::default()
        };
        Area::plan(
            &mut files,
            &options,
            None,
            &crate::base::params::Params::default(),
            60.0,
        )
        .unwrap()
    }

    #[test]
    fn what_is_kept_belongs_to_one_tile_of_one_area() {
        let files = files();
        let mut planned = area(&files, 100.0);
        let kept: Vec<Vec<u8>> = (0..2)
            .map(|tile| {
                planned.load(&files, tile, 0).unwrap();
                planned.work_off(tile, 0, &silent()).unwrap();
                planned.outcome_of(tile).unwrap()
            })
            .collect();
        assert_eq!(planned.load(&files, 1, 1), None);
        assert_eq!(planned.work_off(2, 0, &silent()), None);
        assert_eq!(planned.outcome_of(2), None);
        let (report, model) = planned.outcome(0, &kept[0]).unwrap();
        assert!(report.outcome.contains("seen by 0 views"), "{report:?}");
        assert_eq!(model, None);

        let refusal = |error: Error| error.to_string();
        let other_tile = refusal(planned.outcome(1, &kept[0]).unwrap_err());
        assert!(other_tile.contains("is that of tile 1"), "{other_tile}");
        let other = area(&files, 90.0);
        let other_area = refusal(other.outcome(0, &kept[0]).unwrap_err());
        assert!(other_area.contains("another plan"), "{other_area}");
        let mut changed = files.clone();
        changed[0].bytes.push(0);
        assert!(area(&changed, 100.0).outcome(0, &kept[0]).is_err());

        // In their order, and then there is nothing to join.
        assert!(planned.take(&kept[1]).is_err());
        for outcome in &kept {
            planned.take(outcome).unwrap();
        }
        let nothing = refusal(planned.finish(&[]).unwrap_err());
        assert!(nothing.contains("no tile could be read"), "{nothing}");
    }

    #[test]
    fn the_order_of_tiles_does_not_change_the_model() {
        let (scene, truth) = gable_scene(96);
        let files: Vec<InputFile> = (to_files(&scene).into_iter())
            .map(|(path, bytes)| InputFile::new(&path, bytes))
            .collect();
        let [x, y, z] = scene.origin.into();
        let options = LoadOptions {
            orientation: Some("colmap".to_owned()),
            roi: Some([x - 31.0, y - 31.0, x + 31.0, y + 31.0]),
            ground_z: Some(z + truth.ground_z),
            ..LoadOptions::default()
        };
        let params = crate::base::params::Params::default();
        let model = |turned: bool| {
            let mut files = &files[..];
            let mut area = Area::plan(&mut files, &options, None, &params, 60.0).unwrap();
            if turned {
                area.work.order.reverse();
            }
            let mut tiles = Vec::new();
            while let Some((tile, _)) = area.step(&mut files, &silent()).unwrap() {
                tiles.push(tile);
            }
            (tiles, area.finish(&[]).unwrap().0)
        };
        let ((tiles, expected), (turned, found)) = (model(false), model(true));
        assert!(tiles.len() > 1 && tiles.iter().eq(turned.iter().rev()));
        assert!(found == expected);
    }
}
