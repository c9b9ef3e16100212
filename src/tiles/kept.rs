//! The outcomes of an area's tiles as bytes that outlive the process: who keeps them goes on where
//! it ended, and holds one tile in memory at a time.
//!
//! Invariant: outcomes that were kept give the model of [`Area::step`], bit by bit.

use super::area::{Area, TileReport, work_off};
use super::join::join;
use super::part_file::{PartKey, TileOutcome};
use super::tile::Cell;
use crate::base::error::{Error, Result};
use crate::base::execution::Listener;
use crate::orienting::orientation::InputFile;
use crate::orienting::scene_loader::LoadOptions;
use crate::results::export::{atlas_jpeg, glb};

impl Area {
    /// The options with which the cells of a tile are loaded; `None` where there is no such tile.
    pub fn options_of(&self, index: usize) -> Option<Vec<LoadOptions>> {
        let options = |cell: &Cell| LoadOptions {
            roi: Some(cell.region),
            ..self.options.clone()
        };
        let tile = self.tiles.get(index)?;
        Some(tile.cells.iter().map(options).collect())
    }

    /// Works off a tile: its outcome as bytes; `None` where there is no such tile.
    pub fn work_off(
        &self,
        mut files: &[InputFile],
        index: usize,
        progress: &Listener,
    ) -> Option<Vec<u8>> {
        let tile = self.tiles.get(index)?;
        let (options, params) = (&self.options, &self.params);
        let known = (&self.whole, &self.seen.0.ground);
        let worked = work_off(&mut files, options, params, tile, known, progress)
            .expect("files in memory can be had");
        let outcome = TileOutcome {
            report: worked.report,
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
            self.first_error.get_or_insert_with(|| Error::Scene {
                problem: format!("no tile could be read; the first one: {}", report.outcome),
                advice: "choose another region, other views or another orientation".to_owned(),
            });
        }
        self.parts.extend(parts);
        self.reports.push(report);
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
            .map(|tile| planned.work_off(&files, tile, &silent()).unwrap())
            .collect();
        assert_eq!(planned.work_off(&files, 2, &silent()), None);
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
}
