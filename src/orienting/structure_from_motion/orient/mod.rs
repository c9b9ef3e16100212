//! From photographs to their orientation, in one go or step by step.
//!
//! ```text
//! options    what is asked for, and what comes out
//! photo      what is kept of a photograph
//! cameras    what the headers state
//! chain      pairs, block, frame: a step each
//! hypotheses guesses of the focal length, of which the likeliest block stays
//! adjustment observations and priors of the block
//! snapshot   the block while it grows
//! refusals   why something has no orientation
//! ```

mod adjustment;
mod cameras;
mod chain;
mod hypotheses;
mod options;
mod photo;
mod refusals;
mod snapshot;

pub use chain::{OnBlock, OrientChain, PairSummary};
pub use options::{OrientOptions, Oriented};
pub use photo::ReadPhoto;
pub use snapshot::{Snapshot, SnapshotPhoto};

use crate::base::error::Result;
use crate::base::execution::{MergedShards, map_part};
use crate::orienting::orientation::InputFile;
use crate::photographs::raster::image_format;

/// Orients the photographs among the files. Positions in the result are metres where the
/// photographs state theirs, z is up; pixels as in all of this crate. A `gcp_list.txt` among the
/// files gives the frame, a `geo.txt` the places of photographs.
///
/// # Errors
/// Where fewer than three photographs can be oriented, or one of these lists cannot be read; the
/// message says why.
pub fn orient(files: &[InputFile], options: &OrientOptions) -> Result<Oriented> {
    let images: Vec<&InputFile> = (files.iter())
        .filter(|f| image_format(&f.bytes).is_some())
        .collect();
    let mut chain = OrientChain::new(options.clone());
    chain.has_enough(images.len())?;
    chain.set_lists(files)?;
    for photo in map_part(&images, 0.0..0.4, |_, file| ReadPhoto::read(file, options)) {
        chain.add(photo);
    }
    chain.connect(MergedShards::default())?;
    chain.orient(None)
}
