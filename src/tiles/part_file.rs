//! A part as a file: whose it is, and whether it is whole.
//!
//! ```text
//! "ridgeline part\n"   15 bytes
//! layout               u32, changes with the fields of a part
//! plan                 u32, CRC-32 of the plan's file
//! tile                 u32, from 1
//! length               u64, of what follows the sum
//! sum                  u32, CRC-32 of what follows
//! outcome              postcard
//! ```
//!
//! All numbers have their lowest byte first. A CRC-32 suffices: it tells accidents, not forgers,
//! and misses one in four thousand million of them.

use serde::{Deserialize, Serialize};

use super::area::TileReport;
use super::join::CellPart;
use crate::base::error::{Error, Result};

const MAGIC: &[u8; 15] = b"ridgeline part\n";

/// Layout of the bytes: to be raised whenever a type in [`CellPart`] changes.
const LAYOUT: u32 = 3;

/// Bytes before the outcome.
const HEADER: usize = MAGIC.len() + 4 * 4 + 8;

/// What became of a tile.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct TileOutcome {
    /// In words.
    pub report: TileReport,
    /// What was found in the cells that the views show.
    pub parts: Vec<CellPart>,
}

/// Plan and tile that a part belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartKey {
    /// CRC-32 of the plan's file.
    pub plan: u32,
    /// Number of the tile, from 1.
    pub tile: u32,
}

impl PartKey {
    /// Path of the part's file below the plan's folder.
    pub(super) fn path(self) -> String {
        format!("parts/{}.part", self.tile)
    }

    /// The outcome as a file.
    pub(super) fn pack(self, outcome: &TileOutcome) -> Vec<u8> {
        let packed = postcard::to_stdvec(outcome).expect("bytes can be written to memory");
        let mut bytes = MAGIC.to_vec();
        for number in [LAYOUT, self.plan, self.tile] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend((packed.len() as u64).to_le_bytes());
        bytes.extend(crc32fast::hash(&packed).to_le_bytes());
        bytes.extend(packed);
        bytes
    }

    /// Reads a part; refuses one that is not whole, or of something else.
    pub(super) fn unpack(self, bytes: &[u8]) -> Result<TileOutcome> {
        let refuse = |problem: &str| {
            Error::file(
                self.path(),
                problem,
                format!(
                    "remove it and make it again (ridgeline tile PLAN {})",
                    self.tile
                ),
            )
        };
        let begins = &bytes[..bytes.len().min(MAGIC.len())];
        if !MAGIC.starts_with(begins) {
            return Err(refuse("the file is no part of a model"));
        }
        let Some((header, packed)) = bytes.split_at_checked(HEADER) else {
            return Err(refuse("the part is truncated: it ends in its first line"));
        };
        let number = |at: usize| {
            let four = &header[MAGIC.len() + at..][..4];
            u32::from_le_bytes(four.try_into().expect("four bytes"))
        };
        let (layout, plan, tile) = (number(0), number(4), number(8));
        let length = u64::from(number(12)) | u64::from(number(16)) << 32;
        if layout != LAYOUT {
            return Err(refuse("another version of ridgeline wrote the part"));
        }
        if plan != self.plan {
            return Err(refuse("the part is foreign: it belongs to another plan"));
        }
        if tile != self.tile {
            return Err(refuse(&format!("the part is that of tile {tile}")));
        }
        if packed.len() as u64 != length {
            return Err(refuse(&format!(
                "the part is truncated: it holds {} of {length} bytes",
                packed.len()
            )));
        }
        if crc32fast::hash(packed) != number(20) {
            return Err(refuse("the part is damaged: its sum is wrong"));
        }
        postcard::from_bytes(packed)
            .map_err(|_| refuse("another version of ridgeline wrote the part"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: PartKey = PartKey { plan: 7, tile: 3 };

    fn refusal(key: PartKey, bytes: &[u8]) -> String {
        key.unpack(bytes).unwrap_err().to_string()
    }

    #[test]
    fn a_part_comes_back_and_every_damage_is_named() {
        let report = TileReport {
            core: [0.0, 1.0, 2.0, 3.0],
            outcome: "no view shows it".to_owned(),
            is_left_out: false,
        };
        let bytes = KEY.pack(&TileOutcome {
            report: report.clone(),
            parts: Vec::new(),
        });
        let back = KEY.unpack(&bytes).unwrap();
        assert!(back.report == report && back.parts.is_empty());
        for length in 0..bytes.len() {
            let message = refusal(KEY, &bytes[..length]);
            assert!(
                message.contains("parts/3.part") && message.contains("truncated"),
                "{length}: {message}"
            );
        }
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x10;
            assert!(
                refusal(KEY, &damaged).contains("ridgeline tile PLAN 3"),
                "{at}"
            );
        }
        let foreign = refusal(PartKey { plan: 8, ..KEY }, &bytes);
        assert!(foreign.contains("belongs to another plan"), "{foreign}");
        let other = refusal(PartKey { tile: 4, ..KEY }, &bytes);
        assert!(
            other.contains("parts/4.part: the part is that of tile 3"),
            "{other}"
        );
        assert!(refusal(KEY, b"PK and more").contains("no part of a model"));
    }
}
