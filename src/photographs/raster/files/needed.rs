//! Which ranges of a file are needed for what is asked of it, so that a photograph is planned with
//! and decoded without all of its bytes.

use std::cell::Cell;
use std::ops::Range;

use super::excerpt::Excerpt;
use super::load::{image_format, image_header};
use super::tiff::{Tiff, is_height_raster, is_placed_band, is_tiff};
use super::unread::unread_image_format;
use crate::photographs::raster::photograph::PixelWindow;

/// The headers of most JPEG and PNG files fit into the first of these, bytes; what has its own
/// behind all of them is read whole. The directories of a TIFF are no more than the last, either.
const HEAD_BYTES: [u64; 3] = [64 << 10, 512 << 10, 2 << 20];

/// A TIFF is read in blocks of so many bytes: the values of a directory stand near it mostly.
const BLOCK: u64 = 16 << 10;

/// What else is to be read of a file until its header is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HeaderNeeds {
    /// This range.
    Range(Range<u64>),
    /// Nothing: it is a photograph that can be planned with.
    Nothing,
    /// All: it is short, or no photograph, or has no header that is understood.
    Whole,
}

/// What else is to be read of a file, by the pieces of it that are in memory. `file` is for
/// messages.
pub fn header_needs(file: &str, excerpt: Excerpt) -> HeaderNeeds {
    let [first, .., most] = HEAD_BYTES;
    let start = excerpt.start();
    if excerpt.length() <= first {
        return HeaderNeeds::Whole;
    }
    if start.is_empty() {
        return HeaderNeeds::Range(0..first);
    }
    if is_tiff(start) {
        return match lacking_of_tiff(file, excerpt) {
            Some(range) if excerpt.held() + (range.end - range.start) <= most => {
                HeaderNeeds::Range(range)
            }
            // What holds all bytes is no head.
            None if excerpt.held() < excerpt.length()
                && image_header(file, excerpt).is_ok()
                && !is_placed_band(excerpt) =>
            {
                HeaderNeeds::Nothing
            }
            _ => HeaderNeeds::Whole,
        };
    }
    if image_format(start).is_none() {
        return HeaderNeeds::Whole;
    }
    if image_header(file, excerpt).is_ok() {
        return HeaderNeeds::Nothing;
    }
    let here = start.len() as u64;
    match HEAD_BYTES.into_iter().find(|&size| size > here) {
        Some(size) if size < excerpt.length() => HeaderNeeds::Range(here..size),
        _ => HeaderNeeds::Whole,
    }
}

/// The ranges of a file that decoding a window of it reads beyond the header, in any order; `None`
/// where it reads all: of a JPEG, of a PNG, of a TIFF of 16 bits, which is scaled by its brightest
/// value, and of one that does not state how long its strips or tiles are. `file` is for messages.
pub(crate) fn window_ranges(
    file: &str,
    excerpt: Excerpt,
    window: PixelWindow,
) -> Option<Vec<Range<u64>>> {
    let tiff = is_tiff(excerpt.start()).then(|| Tiff::open(file, excerpt));
    tiff?.ok()?.ranges(window)
}

/// The first blocks that any reader of the tags asks for and that are not in memory.
fn lacking_of_tiff(file: &str, excerpt: Excerpt) -> Option<Range<u64>> {
    let cell = Cell::new(None);
    let noting = excerpt.noting(&cell);
    unread_image_format(file, noting);
    is_height_raster(noting);
    is_placed_band(noting);
    // What the header lacks is in the cell.
    let _ = image_header(file, noting);
    let lacking: Range<u64> = cell.take()?;
    let blocks = lacking.start / BLOCK..lacking.end.div_ceil(BLOCK);
    let blocks = blocks.map(|i| excerpt.within(i * BLOCK, BLOCK));
    let is_lacking = |block: &Range<u64>| excerpt.get(block.clone()).is_none();
    let mut lacking = blocks
        .skip_while(|block| !is_lacking(block))
        .take_while(is_lacking);
    let first = lacking.next()?;
    let last = lacking.last().unwrap_or(first.clone());
    Some(first.start..last.end)
}
