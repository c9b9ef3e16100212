//! What the cells of an area read, before they are worked off: one plan for the command line, the
//! page and many machines.

use serde::{Deserialize, Serialize};

use super::look::Site;
use super::seen_ground::{SeenGround, options_of};
use super::tile::{CELL_M, Cell, Tile};
use crate::base::error::{Error, Result};
use crate::base::math::{larger, smaller};
use crate::orienting::orientation::InputFile;
use crate::orienting::scene_loader::{Flight, LoadOptions, ViewWindow};

/// Photographs are not reduced further for want of memory. Assumption: no roof is seen then.
const MOST_REDUCTION: f64 = 16.0;

/// Photographs are reduced by so much more at a time for want of memory.
const REDUCTION_RATIO: f64 = 1.1;

/// The tiles of an area with what their cells read, and when.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct WorkPlan {
    /// The factor by which photographs are reduced.
    pub reduction: f64,
    /// The tiles by their index in the order in which they are worked off: those without cells,
    /// then what promises most roofs for its work.
    pub order: Vec<usize>,
    /// From west to east, then from south to north.
    pub tiles: Vec<PlannedTile>,
}

/// A tile of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct PlannedTile {
    /// Its number, from 1.
    pub tile: u32,
    /// What it is responsible for: x0, y0, x1, y1, metres, world frame of the input.
    pub core: [f64; 4],
    /// Memory that it takes at its peak, about, megabytes; 0 where the views show none of it.
    pub memory_mb: u64,
    /// The cells that are reconstructed one after the other.
    pub cells: Vec<PlannedCell>,
}

/// A cell of a tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct PlannedCell {
    /// What it is responsible for, and what it looks at.
    pub place: Cell,
    /// Memory that it takes at its peak, about, megabytes.
    pub memory_mb: u64,
    /// The views that it reads, and which part of each; none where too few show it.
    pub views: Vec<ViewWindow>,
    /// Why it is left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_out: Option<String>,
}

impl WorkPlan {
    /// Of tiles whose cells are not known yet.
    pub(super) fn unplanned(tiles: &[Tile]) -> Self {
        Self {
            reduction: 1.0,
            order: (0..tiles.len()).collect(),
            tiles: Vec::new(),
        }
    }

    /// Of tiles with their cells. Of the files their heads suffice; `heights` of the whole area's
    /// ground count where `ground` knows none.
    pub(super) fn new(
        files: &[InputFile],
        options: &LoadOptions,
        heights: Option<[f64; 2]>,
        (tiles, sites): (&[Tile], &[Site]),
        ground: &SeenGround,
    ) -> Result<Self> {
        let flight = Flight::new(files, options, heights)?;
        let planned = |_: usize, tile: &Tile| {
            let cells = tile.cells.iter();
            let cells = cells.map(|cell| {
                let roofs_m2 = sites.iter().map(|site| promised(site, cell)[1]).sum();
                let options = options_of(cell, options, ground);
                PlannedCell::new(cell, flight.windows(&options, Some(roofs_m2)))
            });
            cells.collect::<Vec<_>>()
        };
        let cells = crate::base::execution::map(tiles, planned);
        let tile = |(index, (tile, cells)): (usize, (&Tile, Vec<PlannedCell>))| PlannedTile {
            tile: u32::try_from(index + 1).expect("fewer than 2^32 tiles"),
            core: tile.core,
            memory_mb: cells.iter().map(|cell| cell.memory_mb).max().unwrap_or(0),
            cells,
        };
        Ok(Self {
            reduction: options.reduction.unwrap_or(1.0),
            order: order(tiles, sites),
            tiles: tiles.iter().zip(cells).enumerate().map(tile).collect(),
        })
    }

    /// By how much photographs are to be reduced so that all cells can be loaded; `None` where they
    /// can, or nothing helps.
    pub(super) fn fitting(&self) -> Option<f64> {
        let mut cells = self.tiles.iter().flat_map(|tile| &tile.cells);
        let is_any_too_large = cells.any(|cell| cell.left_out.is_some() && !cell.views.is_empty());
        let fitting = (10.0 * REDUCTION_RATIO * self.reduction).ceil() / 10.0;
        (is_any_too_large && self.reduction < MOST_REDUCTION).then_some(fitting)
    }
}

impl PlannedCell {
    fn new(cell: &Cell, windows: Result<(Vec<ViewWindow>, u64, Option<Error>)>) -> Self {
        let (views, memory_mb, left_out) = match windows {
            Ok((views, memory_mb, refusal)) => (views, memory_mb, refusal),
            Err(error) => (Vec::new(), 0, Some(error)),
        };
        Self {
            place: *cell,
            memory_mb,
            views,
            left_out: left_out.map(|error| error.to_string()),
        }
    }
}

/// The order in which tiles are worked off: those without cells, then what promises most roofs for
/// the ground that it looks at (Smith's rule), of equal ones by their number.
fn order(tiles: &[Tile], sites: &[Site]) -> Vec<usize> {
    let promise = |tile: &Tile| {
        let cells = tile.cells.iter();
        let promised = cells.flat_map(|cell| sites.iter().map(|site| promised(site, cell)[0]));
        let roofs: f64 = promised.sum();
        let work = tile.looked_at_m2();
        if work > 0.0 {
            roofs / work
        } else {
            f64::INFINITY
        }
    };
    let promises: Vec<f64> = tiles.iter().map(promise).collect();
    let mut order: Vec<usize> = (0..tiles.len()).collect();
    order.sort_by(|a, b| promises[*b].total_cmp(&promises[*a]));
    order
}

/// How many roofs a site promises in a cell, and how many square metres: of a row one every
/// [`CELL_M`], by the share of its extent that lies in the core.
fn promised(site: &Site, cell: &Cell) -> [f64; 2] {
    let [mut share, mut length] = [1.0, CELL_M];
    for axis in 0..2 {
        let at = site.outline.map(|corner| corner[axis]);
        let low = at.into_iter().fold(f64::INFINITY, smaller);
        let high = at.into_iter().fold(f64::NEG_INFINITY, larger);
        let (from, to) = (cell.core[axis], cell.core[axis + 2]);
        share *= larger(smaller(high, to) - larger(low, from), 0.0) / (high - low);
        length = larger(length, high - low);
    }
    let expected = if site.is_worked_on {
        site.probability * share
    } else {
        0.0
    };
    [expected * length / CELL_M, expected * site.area_m2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiles::tile::plan_tiles;

    fn site(x: f64, length: f64, probability: f64) -> Site {
        let outline = [[x, 20.0], [x + length, 20.0], [x + length, 30.0], [x, 30.0]];
        Site {
            outline,
            area_m2: 10.0 * length,
            surface_m2: 0.0,
            lines_m: 0.0,
            width_m: 10.0,
            is_given: false,
            probability,
            is_worked_on: true,
        }
    }

    #[test]
    fn what_promises_most_roofs_for_its_work_comes_first() {
        let mut tiles = plan_tiles([0.0, 0.0, 300.0, 60.0], 60.0).unwrap();
        tiles[2].cells.clear();
        let twice = tiles[4].cells[0];
        tiles[4].cells.push(Cell {
            core: [240.0, 0.0, 300.0, 1.0],
            ..twice
        });
        let sites = [
            site(10.0, 12.0, 0.1),
            site(70.0, 12.0, 0.5),
            site(200.0, 12.0, 0.5),
        ];
        let sites = [&sites[..], &[site(250.0, 12.0, 0.8)]].concat();
        assert_eq!(order(&tiles, &sites), [2, 1, 3, 4, 0]);
    }

    #[test]
    fn a_row_promises_roofs_in_every_cell_that_it_crosses() {
        let tiles = plan_tiles([0.0, 0.0, 300.0, 60.0], 60.0).unwrap();
        let row = site(30.0, 200.0, 0.6);
        let found = tiles.iter().map(|tile| promised(&row, &tile.cells[0]));
        for (found, share) in found.zip([0.5, 1.0, 1.0, 5.0 / 6.0, 0.0]) {
            let expected = [0.6 * share, 360.0 * share];
            assert!(
                (0..2).all(|i| (found[i] - expected[i]).abs() < 1e-9),
                "{found:?}"
            );
        }
    }
}
