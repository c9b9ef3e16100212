//! TIFF and BigTIFF: the first image of full resolution, as grey or RGB of 8 or 16 bits.
//!
//! ```text
//! directory     tags and their values
//! layout        what the tags say, or the refusal of what is not read
//! compression   one strip or tile to bytes
//! chunks        the strips and tiles that touch a window, to samples
//! numbers       one band of numbers that are no colours: heights
//! ```
//!
//! One path decodes every combination of bands, planes, strips, tiles and predictor, for whole
//! images and for windows. Crate `tiff` was used before: it takes one unspecified band for no band
//! when it undoes the predictor, and panics at the edge tiles of separate planes.

mod chunks;
mod compression;
mod directory;
mod layout;
mod numbers;

pub(super) use chunks::Tiff;
pub(crate) use directory::{Directory, is_tiff, tags};
pub use layout::Bands;
pub(super) use numbers::is_placed_band;
pub(crate) use numbers::{NumberRaster, is_height_raster};
