//! From photographs to their orientation, in one go or step by step.
//!
//! ```text
//! photo      what is kept of a photograph
//! cameras    what the headers state
//! chain      pairs, block, frame: a step each
//! snapshot   the block while it grows
//! refusals   why something has no orientation
//! ```

mod adjustment;
mod cameras;
mod chain;
mod photo;
mod refusals;
mod snapshot;

pub use chain::{OnBlock, OrientChain, PairSummary};
pub use photo::ReadPhoto;
pub use snapshot::{Snapshot, SnapshotPhoto};

use super::features::FeatureOptions;
use super::output::{OrientReport, SparseModel};
use crate::error::Result;
use crate::execution::{MergedShards, map_part};
use crate::orientation::InputFile;
use crate::raster::image_format;

/// How photographs are oriented.
#[derive(Clone, Debug, Default)]
pub struct OrientOptions {
    /// Working size and number of features.
    pub features: FeatureOptions,
    /// Focal length of all photographs, pixels, instead of what their headers state.
    pub focal_px: Option<f64>,
    /// Keep the principal point in the middle of the photographs, also where the block determines
    /// it.
    pub holds_center: bool,
}

/// Oriented photographs.
#[derive(Clone, Debug)]
pub struct Oriented {
    /// Cameras, poses and points.
    pub model: SparseModel,
    /// How good they are.
    pub report: OrientReport,
}

impl Oriented {
    /// COLMAP's text model and the report, by name.
    pub fn files(&self) -> Vec<(String, Vec<u8>)> {
        let mut files = self.model.colmap_files();
        files.push((
            "orientation.json".into(),
            self.report.to_json().into_bytes(),
        ));
        files.push(("orientation.log".into(), self.report.to_text().into_bytes()));
        files
    }

    /// Sets the scale by a known length: what measures `measured` in the frame becomes `metres`;
    /// `words` say what it is. `false`, and nothing happens, where one of them is no length.
    pub fn set_length(&mut self, measured: f64, metres: f64, words: &str) -> bool {
        let factor = metres / measured;
        let is_length = |length: f64| length.is_finite() && length > 0.0;
        if !is_length(measured) || !is_length(metres) || !is_length(factor) {
            return false;
        }
        self.model.scale(factor);
        self.report.scale(factor, &format!("{words}, {metres} m"));
        true
    }
}

/// Orients the photographs among the files. Positions in the result are metres where the
/// photographs state theirs, z is up; pixels as in all of this crate.
///
/// # Errors
/// Where fewer than three photographs can be oriented; the message says why.
pub fn orient(files: &[InputFile], options: &OrientOptions) -> Result<Oriented> {
    let images: Vec<&InputFile> = (files.iter())
        .filter(|f| image_format(&f.bytes).is_some())
        .collect();
    let mut chain = OrientChain::new(options.clone());
    chain.has_enough(images.len())?;
    for photo in map_part(&images, 0.0..0.4, |_, file| ReadPhoto::read(file, options)) {
        chain.add(photo);
    }
    chain.connect(MergedShards::default())?;
    chain.orient(None)
}
