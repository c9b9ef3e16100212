//! Images that were oriented as their EXIF header shows them, not as they are stored.
//!
//! Some programs orient the pixels as stored, others turn them first. Where width and height are
//! exchanged between orientation and file, and the EXIF header asks for a quarter turn, the second
//! is certain; half a turn leaves the size as it is, and the pixels are taken as stored.

use crate::orientation::Orientation;
use crate::raster::{ImageHeader, Turn};

/// The quarter turn after which the image has the size that its orientation states.
pub(super) fn turn_of(header: &ImageHeader, orientation: &Orientation) -> Option<Turn> {
    let stored = (header.width, header.height);
    let shown = (header.height, header.width);
    let is_exchanged = orientation.size == Some(shown) && stored != shown;
    Turn::from_exif(header.orientation).filter(|_| is_exchanged)
}

/// Width and height of the image as its orientation describes it.
pub(super) fn shown_size(header: &ImageHeader, turn: Option<Turn>) -> (u32, u32) {
    match turn {
        Some(_) => (header.height, header.width),
        None => (header.width, header.height),
    }
}
