//! A file, or the pieces of it that are in memory.
//!
//! What a TIFF says of itself stands anywhere in the file, and its pixels are most of it. So its
//! readers ask for ranges of the file, and where one is not in memory it is noted: reading it and
//! asking again finds the next one. What the readers say in the end is the same as of the whole
//! file, since they have read nothing but these ranges.

use std::cell::Cell;
use std::ops::Range;

/// Bytes of a file from a place on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Their place in the file.
    pub place: Range<u64>,
    /// Where the first of them stands among the bytes in memory.
    pub at: usize,
}

impl Piece {
    /// How many they are.
    pub fn length(&self) -> u64 {
        self.place.end - self.place.start
    }
}

/// A file, or the pieces of it that are in memory, of which one begins at the first byte.
#[derive(Clone, Copy)]
pub struct Excerpt<'a> {
    bytes: &'a [u8],
    /// `None` where all is in memory.
    pieces: Option<&'a [Piece]>,
    length: u64,
    lacking: Option<&'a Cell<Option<Range<u64>>>>,
}

impl<'a> Excerpt<'a> {
    /// Pieces of a file of this length.
    pub fn new(bytes: &'a [u8], pieces: &'a [Piece], length: u64) -> Self {
        Self {
            bytes,
            pieces: Some(pieces),
            length,
            lacking: None,
        }
    }

    /// The same, which notes the first range that is asked for and not in memory.
    pub(super) fn noting(self, lacking: &'a Cell<Option<Range<u64>>>) -> Self {
        Self {
            lacking: Some(lacking),
            ..self
        }
    }

    /// Bytes of the whole file.
    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// Bytes that are in memory.
    pub(super) fn held(&self) -> u64 {
        self.bytes.len() as u64
    }

    /// Of so many bytes from a place on those within the file.
    pub(super) fn within(&self, from: u64, count: u64) -> Range<u64> {
        from.min(self.length)..from.saturating_add(count).min(self.length)
    }

    /// The bytes from the first on, as far as they are in memory.
    pub(crate) fn start(&self) -> &'a [u8] {
        let Some(pieces) = self.pieces else {
            return self.bytes;
        };
        let first = pieces.iter().find(|piece| piece.place.start == 0);
        first.map_or(&[], |piece| self.of_piece(piece, piece.place.clone()))
    }

    /// A range of the file; `None` where it reaches beyond the end, or is not in memory.
    pub(super) fn get(&self, range: Range<u64>) -> Option<&'a [u8]> {
        if range.start > range.end || range.end > self.length {
            return None;
        }
        if range.is_empty() {
            return Some(&[]);
        }
        let Some(pieces) = self.pieces else {
            return self.bytes.get(range.start as usize..range.end as usize);
        };
        let holds =
            |piece: &&Piece| piece.place.start <= range.start && range.end <= piece.place.end;
        let found = pieces.iter().find(holds);
        if let (None, Some(lacking)) = (found, self.lacking) {
            lacking.set(lacking.take().or(Some(range.clone())));
        }
        found.map(|piece| self.of_piece(piece, range))
    }

    fn of_piece(&self, piece: &Piece, range: Range<u64>) -> &'a [u8] {
        let from = piece.at + (range.start - piece.place.start) as usize;
        let to = from + (range.end - range.start) as usize;
        self.bytes.get(from..to).unwrap_or_default()
    }
}

impl<'a> From<&'a [u8]> for Excerpt<'a> {
    fn from(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            pieces: None,
            length: bytes.len() as u64,
            lacking: None,
        }
    }
}

impl<'a> From<&'a Vec<u8>> for Excerpt<'a> {
    fn from(bytes: &'a Vec<u8>) -> Self {
        bytes.as_slice().into()
    }
}

impl<'a, const N: usize> From<&'a [u8; N]> for Excerpt<'a> {
    fn from(bytes: &'a [u8; N]) -> Self {
        bytes.as_slice().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_memory_is_found_and_the_first_that_is_not_is_noted() {
        let whole: Vec<u8> = (0..100).collect();
        let held = [&whole[..10], &whole[40..60]].concat();
        let pieces = [(0..10, 0), (40..60, 10)].map(|(place, at)| Piece { place, at });
        let lacking = Cell::new(None);
        let excerpt = Excerpt::new(&held, &pieces, 100).noting(&lacking);
        assert_eq!(excerpt.start(), &whole[..10]);
        for range in [0..10, 3..3, 40..60, 45..50] {
            let expected = &whole[range.start as usize..range.end as usize];
            assert_eq!(excerpt.get(range), Some(expected));
        }
        assert_eq!(excerpt.get(90..101), None);
        assert_eq!(lacking.take(), None);
        assert_eq!(excerpt.get(55..65), None);
        assert_eq!(excerpt.get(20..21), None);
        assert_eq!(lacking.take(), Some(55..65));
        assert_eq!(Excerpt::from(&whole).get(20..22), Some(&[20, 21][..]));
        assert_eq!(Excerpt::from(&whole).get(99..101), None);
    }
}
