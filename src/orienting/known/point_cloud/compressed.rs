//! Records of a LAZ file, one by one, by the decompressors of crate `laz`.
//!
//! Chunks are walked here instead of by that crate: it believes what a file states of their number
//! and sizes, and a damaged one would take all memory. The table of chunks is not needed for that;
//! chunks lie one behind the other.

use std::io::Cursor;

use laz::record::{
    LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor,
};
use laz::{DecompressionSelection, LazItemType, LazVlr};

use super::header::{Header, u32_at};

/// What is decompressed of a record where the format can leave out parts: besides the position in
/// plan, which always is, height, class and flags.
const PARTS: u32 = DecompressionSelection::Z
    | DecompressionSelection::CLASSIFICATION
    | DecompressionSelection::FLAGS;

/// The bytes before the first chunk: where the table of chunks lies.
const PLACE_OF_TABLE: u64 = 8;

/// The records of a LAZ file.
pub(super) struct Compressed<'a> {
    bytes: &'a [u8],
    decoder: Box<dyn RecordDecompressor<Cursor<&'a [u8]>> + 'a>,
    description: LazVlr,
    /// The last record.
    record: Vec<u8>,
    chunks: Chunks,
    /// Records left in the chunk.
    left: u64,
}

/// How records are packed.
#[derive(Clone, Copy, PartialEq)]
enum Chunks {
    /// One chunk holds all.
    One,
    /// So many records in each.
    Of(u32),
    /// Each states how many it has, and how large its layers are: so many of them.
    Layered(usize),
}

impl<'a> Compressed<'a> {
    /// The records behind a header; otherwise why they cannot be read.
    pub(super) fn new(header: &Header, bytes: &'a [u8]) -> Result<Self, String> {
        let description = header
            .variable_record(bytes, LazVlr::USER_ID, LazVlr::RECORD_ID)
            .ok_or("it is compressed, and the record of LASzip that says how is missing")?;
        let compressor = description.first_chunk().copied().map(u16::from_le_bytes);
        let description = LazVlr::from_buffer(description).map_err(|e| e.to_string())?;
        let items = description.items();
        let first = items.first().map(|item| item.item_type());
        let is_layered = header.format >= 6;
        let expected = match is_layered {
            true => LazItemType::Point14,
            false => LazItemType::Point10,
        };
        if first != Some(expected) {
            return Err("its record of LASzip is of another point format".to_owned());
        }
        let chunks = match (compressor, is_layered) {
            (Some(1), false) => Chunks::One,
            (Some(2), false) if description.uses_variable_size_chunks() => {
                return Err(
                    "its chunks have various sizes, which is not read of point formats 0 to 5"
                        .to_owned(),
                );
            }
            (Some(2), false) if description.chunk_size() > 0 => {
                Chunks::Of(description.chunk_size())
            }
            (Some(3), true) => Chunks::Layered(items.iter().map(|i| layers(i.item_type())).sum()),
            _ => return Err("it is compressed in a way that is not known".to_owned()),
        };
        let mut source = Cursor::new(bytes);
        source.set_position(header.data as u64);
        if chunks != Chunks::One {
            source.set_position(header.data as u64 + PLACE_OF_TABLE);
        }
        let decoder: Box<dyn RecordDecompressor<_>> = match is_layered {
            true => Box::new(LayeredPointRecordDecompressor::new(source)),
            false => Box::new(SequentialPointRecordDecompressor::new(source)),
        };
        let mut compressed = Self {
            bytes,
            decoder,
            description,
            record: vec![0; usize::from(header.record_length)],
            chunks,
            left: 0,
        };
        compressed.begin()?;
        if compressed.decoder.record_size() != compressed.record.len() {
            return Err(format!(
                "its records have {} bytes, and {} by its record of LASzip",
                compressed.record.len(),
                compressed.decoder.record_size()
            ));
        }
        Ok(compressed)
    }

    /// The next record, as it would stand in a LAS file.
    pub(super) fn next(&mut self) -> Result<&[u8], String> {
        if self.left == 0 {
            self.begin()?;
            self.left = match self.chunks {
                Chunks::One => u64::MAX,
                Chunks::Of(count) => u64::from(count),
                Chunks::Layered(layers) => self.layered_chunk(layers)?,
            };
        }
        self.left -= 1;
        let read = self.decoder.decompress_next(&mut self.record);
        read.map_err(|e| e.to_string())?;
        Ok(&self.record)
    }

    /// Makes the decoder ready for a chunk.
    fn begin(&mut self) -> Result<(), String> {
        self.decoder.reset();
        let items = self.description.items();
        (self.decoder.set_fields_from(items)).map_err(|e| e.to_string())?;
        self.decoder.set_selection(DecompressionSelection(PARTS));
        Ok(())
    }

    /// How many records the layered chunk has that lies at the decoder's place, if its layers lie
    /// within the file.
    fn layered_chunk(&mut self, layers: usize) -> Result<u64, String> {
        let place = usize::try_from(self.decoder.get().position()).ok();
        let chunk = place
            .and_then(|at| self.bytes.get(at..))
            .unwrap_or_default();
        let (_, chunk) = (chunk.split_at_checked(self.record.len())).ok_or("the file ends")?;
        let (sizes, rest) = (chunk.split_at_checked(4 + 4 * layers)).ok_or("the file ends")?;
        let bytes = (1..=layers).map(|k| u64::from(u32_at(sizes, 4 * k)));
        if bytes.sum::<u64>() > rest.len() as u64 {
            return Err("the file ends".to_owned());
        }
        match u32_at(sizes, 0) {
            0 => Err("a chunk states that it is empty".to_owned()),
            count => Ok(u64::from(count)),
        }
    }
}

/// Layers of a chunk for each part of a record.
fn layers(item: LazItemType) -> usize {
    match item {
        LazItemType::Point14 => 9,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(count) => usize::from(count),
        _ => 1,
    }
}
