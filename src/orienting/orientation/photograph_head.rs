//! The head of a photograph: what of it has to be in memory to plan with it.

use std::ops::Range;

use crate::photographs::raster::{Excerpt, HeaderNeeds, Piece, header_needs};

/// The head of a file, as it is read range by range. Of a JPEG and a PNG it is the first bytes, of
/// a TIFF also its directories, wherever they stand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhotographHead {
    /// The path under which the file is read.
    pub(super) path: String,
    /// The pieces, one after the other.
    pub(super) bytes: Vec<u8>,
    /// Where they stand, in ascending order and apart from each other.
    pub(super) pieces: Vec<Piece>,
    /// Bytes of the whole file.
    pub(super) whole: u64,
}

impl PhotographHead {
    /// Nothing yet of a file of `whole` bytes.
    pub fn new(path: &str, whole: u64) -> Self {
        Self {
            path: path.replace('\\', "/"),
            bytes: Vec::new(),
            pieces: Vec::new(),
            whole,
        }
    }

    /// Is it read under this path?
    pub fn is_of(&self, path: &str) -> bool {
        self.path == path.replace('\\', "/")
    }

    /// What is to be read next.
    pub fn needs(&self) -> HeaderNeeds {
        let excerpt = Excerpt::new(&self.bytes, &self.pieces, self.whole);
        header_needs(&self.path, excerpt)
    }

    /// Adds the bytes of the range that [`Self::needs`] named. False where they are fewer: the file
    /// has become shorter.
    pub fn add(&mut self, range: Range<u64>, bytes: &[u8]) -> bool {
        if bytes.len() as u64 != range.end - range.start {
            return false;
        }
        let after = self
            .pieces
            .partition_point(|piece| piece.place.end <= range.start);
        let at = match after.checked_sub(1) {
            Some(before) => end_of(&self.pieces[before]),
            None => 0,
        };
        self.bytes.splice(at..at, bytes.iter().copied());
        self.pieces.insert(after, Piece { place: range, at });
        // Neighbours become one, so that a range across their border is found.
        let mut joined: Vec<Piece> = Vec::new();
        for Piece { place, .. } in self.pieces.drain(..) {
            match joined.last_mut() {
                Some(last) if last.place.end == place.start => last.place.end = place.end,
                last => {
                    let at = last.map_or(0, |last| end_of(last));
                    joined.push(Piece { place, at });
                }
            }
        }
        self.pieces = joined;
        true
    }
}

/// What stands at these places of a whole file.
pub(super) fn gathered(pieces: &[Piece], whole: &[u8]) -> Vec<u8> {
    let range = |place: &Range<u64>| whole.get(place.start as usize..place.end as usize);
    let found = pieces.iter().filter_map(|piece| range(&piece.place));
    found.collect::<Vec<_>>().concat()
}

/// Where the bytes of a piece end among those in memory.
fn end_of(piece: &Piece) -> usize {
    piece.at + piece.length() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_stand_in_the_order_of_the_file_and_neighbours_are_one() {
        let whole: Vec<u8> = (0..100).collect();
        let mut head = PhotographHead::new("in\\a.tif", 100);
        for range in [0..10, 60..70, 30..40, 40..60, 90..100] {
            let bytes = &whole[range.start as usize..range.end as usize];
            assert!(head.add(range, bytes));
        }
        assert_eq!(head.path, "in/a.tif");
        let places: Vec<_> = head
            .pieces
            .iter()
            .map(|p| (p.place.clone(), p.at))
            .collect();
        assert_eq!(places, [(0..10, 0), (30..70, 10), (90..100, 50)]);
        assert_eq!(head.bytes, gathered(&head.pieces, &whole));
        assert_eq!(head.bytes.len(), 60);
        assert!(!head.add(70..80, &whole[70..79]));
    }
}
