//! What is needed of a file, all of it or blocks of it, and who gives it.

use std::collections::BTreeMap;
use std::ops::Range;

use super::input_file::InputFile;
use crate::base::error;
use crate::photographs::raster::{PixelWindow, window_ranges};

/// Files are read in blocks of so many bytes where not all of them is needed, so that a plan can
/// state the sum of each. Assumption: about a tile of a cloud optimised GeoTIFF.
pub const BLOCK_BYTES: u64 = 256 << 10;

/// What is needed of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Needed {
    /// The index of the file.
    pub file: usize,
    /// Ranges of whole blocks, in ascending order and apart from each other; `None` for all.
    pub ranges: Option<Vec<Range<u64>>>,
}

impl Needed {
    /// All of a file.
    pub fn whole(file: usize) -> Self {
        Self { file, ranges: None }
    }

    /// All of all files.
    pub fn all(files: &[InputFile]) -> Vec<Self> {
        (0..files.len()).map(Self::whole).collect()
    }

    /// What decoding a window of a photograph needs, as its head says.
    pub(crate) fn of_window(files: &[InputFile], file: usize, window: PixelWindow) -> Self {
        let photograph = &files[file];
        let ranges = match photograph.is_always_whole() {
            true => None,
            false => window_ranges(&photograph.path, photograph.content(), window),
        };
        let ranges = ranges.map(|ranges| blocks_of(&ranges, photograph.length()));
        Self { file, ranges }
    }

    /// The same with each file once.
    pub(crate) fn merged(all: impl IntoIterator<Item = Self>, files: &[InputFile]) -> Vec<Self> {
        let mut by_file: BTreeMap<usize, Option<Vec<Range<u64>>>> = BTreeMap::new();
        for Self { file, ranges } in all {
            match by_file.entry(file) {
                std::collections::btree_map::Entry::Vacant(entry) => {
                    entry.insert(ranges);
                }
                std::collections::btree_map::Entry::Occupied(mut entry) => {
                    let both = entry.get_mut().take().zip(ranges);
                    let both = both.map(|(a, b)| blocks_of(&[a, b].concat(), files[file].length()));
                    entry.insert(both);
                }
            }
        }
        let needed = by_file.into_iter();
        needed.map(|(file, ranges)| Self { file, ranges }).collect()
    }

    /// Is it in memory?
    pub fn is_in(&self, files: &[InputFile]) -> bool {
        files[self.file].has(self.ranges.as_deref())
    }

    /// Bytes that are read for it beyond the head.
    pub(crate) fn bytes(&self, files: &[InputFile]) -> u64 {
        let file = &files[self.file];
        match &self.ranges {
            Some(ranges) => ranges.iter().map(|range| range.end - range.start).sum(),
            None => file.length().saturating_sub(file.head_length()),
        }
    }
}

/// The files of a scene, and who gives photographs their whole bytes when their pixels are needed.
pub trait FileSource {
    /// All files.
    fn files(&self) -> &[InputFile];

    /// Fills files with what is needed of them, and lets go of all else; refused by name where one
    /// cannot be had any more.
    fn hold(&mut self, needed: &dyn Fn(&[InputFile]) -> Vec<Needed>) -> error::Result<()>;
}

/// Files that are whole, or were made whole before.
impl FileSource for &[InputFile] {
    fn files(&self) -> &[InputFile] {
        self
    }

    fn hold(&mut self, _: &dyn Fn(&[InputFile]) -> Vec<Needed>) -> error::Result<()> {
        Ok(())
    }
}

/// The blocks that hold these ranges, of a file of this length.
fn blocks_of(ranges: &[Range<u64>], length: u64) -> Vec<Range<u64>> {
    let ranges = ranges.iter().filter(|range| !range.is_empty());
    let mut blocks: Vec<Range<u64>> = ranges
        .map(|range| {
            let start = range.start / BLOCK_BYTES * BLOCK_BYTES;
            start..(range.end.div_ceil(BLOCK_BYTES) * BLOCK_BYTES).min(length)
        })
        .collect();
    blocks.sort_by_key(|range| (range.start, range.end));
    let mut joined: Vec<Range<u64>> = Vec::new();
    for block in blocks {
        match joined.last_mut() {
            Some(last) if last.end >= block.start => last.end = last.end.max(block.end),
            _ => joined.push(block),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_become_blocks_and_neighbours_one_range() {
        let block = BLOCK_BYTES;
        let found = blocks_of(&[5 * block + 7..5 * block + 9, 3..block + 1], 100 * block);
        assert_eq!(found, [0..2 * block, 5 * block..6 * block]);
        assert_eq!(blocks_of(&[10..20, 15..30, 40..40], 25), vec![0..25]);
    }

    #[test]
    fn all_of_a_file_and_a_part_of_it_are_all_of_it() {
        let file = InputFile::new("a", vec![0; 3 << 20]);
        let part = |range: Range<u64>| Needed {
            file: 0,
            ranges: Some(vec![range]),
        };
        let (first, third) = (0..BLOCK_BYTES, 2 * BLOCK_BYTES..3 * BLOCK_BYTES);
        let merged = |all: Vec<Needed>| Needed::merged(all, std::slice::from_ref(&file));
        let both = merged(vec![
            part(third.clone()),
            part(first.clone()),
            part(first.clone()),
        ]);
        assert_eq!(both[0].ranges, Some(vec![first.clone(), third]));
        let whole = merged(vec![part(first.clone()), Needed::whole(0), part(first)]);
        assert_eq!(whole, [Needed::whole(0)]);
    }
}
