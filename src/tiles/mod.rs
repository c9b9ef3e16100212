//! Large areas in overlapping cells, one at a time, whose models join.
//!
//! ```text
//! division     which tiles and squares of an area are worked off; the plan that the page shows
//! look         a first look at small photographs: cells lie where a roof may be
//! tile         cells on a grid of the world, with a margin around them; tiles of cells
//! model_parts  buildings of a model in another model and frame
//! atlases      where the atlases of all cells stand in one
//! join         one model: each building once, ids renumbered, whole images, one atlas
//! area         one cell after the other
//! kept         outcomes of its tiles as bytes, to go on from
//! fields       what the bytes of a part hold beyond what its types write by themselves
//! part_file    a part as a file: whose it is, and whether it is whole
//! work_plan    what the cells read, and the order in which tiles are worked off
//! plan         the tiles of a block as a file, for many machines
//! ```
//!
//! Invariant: a building is reconstructed whole in the cell that holds its middle, as long as what
//! a first look shows of it is no longer than 90 m, so that no seam runs through a building.
//! Buildings that touch each other and come from different cells may overlap by the accuracy of
//! their eaves.
//!
//! Invariant: an area has the same model whatever the size of its tiles.

mod area;
mod atlases;
mod division;
mod fields;
#[cfg(test)]
mod fixture;
mod join;
mod kept;
mod look;
mod model_parts;
mod part_file;
mod plan;
mod seen_ground;
mod tile;
mod work_plan;

pub use area::{Area, TileReport, refuse_corrections};
pub use division::FlightPlan;
pub use join::{CellPart, Joined, join};
pub use look::Site;
pub use plan::{BlockPlan, BlockSource, HeadStamp, InputStamp};
pub use tile::{CELL_M, Cell, MARGIN_M, Tile, plan_tiles};
pub use work_plan::{PlannedCell, PlannedTile, WorkPlan};
