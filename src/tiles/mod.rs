//! Large areas as overlapping tiles, one at a time, whose models join.
//!
//! ```text
//! tile         cores that cover the area without gap or overlap, regions with a margin around them
//! model_parts  buildings of a model in another model and frame
//! join         one model: each building once, ids renumbered, whole images, one atlas
//! area         one tile after the other
//! kept         outcomes of its tiles as bytes, to go on from
//! fields       what the bytes of a part hold beyond what its types write by themselves
//! part_file    a part as a file: whose it is, and whether it is whole
//! plan         the tiles of a block as a file, for many machines
//! ```
//!
//! Invariant: a building is reconstructed whole in the tile that holds its middle, as long as it
//! reaches less than [`MARGIN_M`] beyond the core, so that no seam runs through a building.
//! Buildings that touch each other and come from different tiles may overlap by the accuracy of
//! their eaves.

mod area;
mod fields;
#[cfg(test)]
mod fixture;
mod join;
mod kept;
mod model_parts;
mod part_file;
mod plan;
mod tile;

pub use area::{Area, TileReport};
pub use join::{Joined, TilePart, join};
pub use plan::{BlockPlan, BlockSource, InputStamp, PlannedTile};
pub use tile::{MARGIN_M, Tile, plan_tiles};
