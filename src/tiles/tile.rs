//! Tiles and the cells that they consist of: cores that cover an area without gap or overlap, and
//! regions with a margin around them.
//!
//! A cell is what is reconstructed by itself, with its own views. Cells stand on a grid of the
//! world, so that a building is the same whatever the area and the tiles; a tile is a square of
//! cells that are worked off together.

use nalgebra::{Point2, Vector3};
use serde::{Deserialize, Serialize};

use super::model_parts::middle;
use crate::base::error::{Error, Result};
use crate::base::math::{larger, smaller};
use crate::roofs::model::{Building, RoofModel};

/// Side of a cell, metres. Assumption: twice the margin; the same views then say most about all of
/// it, and a long house reaches beyond the core by no more than the margin.
pub const CELL_M: f64 = 60.0;

/// Width of the margin around a core, metres. Assumption: a house and its neighbours' eaves, which
/// take part in what its lines mean.
pub const MARGIN_M: f64 = 30.0;

/// Buildings whose middle lies this far beyond the core are kept until the cells are joined,
/// metres: the neighbour may see their middle on this side.
pub(super) const SLACK_M: f64 = 3.0;

/// Most cells of an area.
const MOST_CELLS: f64 = 400_000.0;

/// A square of cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tile {
    /// The part of the area that it is responsible for: x0, y0, x1, y1, metres, world frame of the
    /// input.
    pub core: [f64; 4],
    /// Its cells, from west to east, then from south to north.
    pub cells: Vec<Cell>,
}

/// A part of the area that is reconstructed by itself: x0, y0, x1, y1 in metres, world frame of the
/// input.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// What it is responsible for, as far as it lies in the area: a square of the grid, or around
    /// what a first look shows of roofs.
    pub core: [f64; 4],
    /// What it looks at: that, whole, and a margin.
    pub region: [f64; 4],
}

/// Tiles of about `tile_m` metres that cover an area; from west to east, then from south to north.
pub fn plan_tiles(area: [f64; 4], tile_m: f64) -> Result<Vec<Tile>> {
    let [x0, y0, x1, y1] = area;
    let [first_column, first_row] = [x0, y0].map(|v| (v / CELL_M).floor());
    let [columns, rows] = [(x1, first_column), (y1, first_row)]
        .map(|(to, first)| larger((to / CELL_M).ceil() - first, 1.0));
    let sizes = [x1 - x0, y1 - y0];
    if !(tile_m >= CELL_M
        && tile_m.is_finite()
        && sizes.iter().all(|&s| s > 0.0 && s.is_finite())
        && columns * rows <= MOST_CELLS)
    {
        return Err(Error::scene(
            format!(
                "{:.0} x {:.0} m cannot be divided into tiles of {tile_m} m",
                sizes[0], sizes[1]
            ),
            format!(
                "choose tiles of {CELL_M:.0} m or more, and an area of no more than {MOST_CELLS:.0} squares of {CELL_M:.0} m"
            ),
        ));
    }
    let side = (tile_m / CELL_M).round() as usize;
    let (columns, rows) = (columns as usize, rows as usize);
    let square = |i: usize, j: usize| {
        let [west, south] = [first_column + i as f64, first_row + j as f64].map(|n| n * CELL_M);
        [west, south, west + CELL_M, south + CELL_M]
    };
    let clipped =
        |[a, b, c, d]: [f64; 4]| [larger(a, x0), larger(b, y0), smaller(c, x1), smaller(d, y1)];
    let cell = |i: usize, j: usize| {
        let [a, b, c, d] = square(i, j);
        Cell {
            core: clipped([a, b, c, d]),
            region: [a - MARGIN_M, b - MARGIN_M, c + MARGIN_M, d + MARGIN_M],
        }
    };
    let mut tiles = Vec::new();
    for j in (0..rows).step_by(side) {
        for i in (0..columns).step_by(side) {
            let (to_i, to_j) = ((i + side).min(columns), (j + side).min(rows));
            let ([a, b, ..], [.., c, d]) = (square(i, j), square(to_i - 1, to_j - 1));
            let cells = (j..to_j).flat_map(|j| (i..to_i).map(move |i| (i, j)));
            tiles.push(Tile {
                core: clipped([a, b, c, d]),
                cells: cells.map(|(i, j)| cell(i, j)).collect(),
            });
        }
    }
    Ok(tiles)
}

impl Tile {
    /// The ground that its cells look at, square metres, twice where two of them do: what it takes
    /// to work them off grows with it.
    pub fn looked_at_m2(&self) -> f64 {
        let area = |[x0, y0, x1, y1]: [f64; 4]| (x1 - x0) * (y1 - y0);
        self.cells.iter().map(|cell| area(cell.region)).sum()
    }
}

impl Cell {
    /// How far a place lies inside the core, metres; negative outside.
    pub(super) fn depth(&self, p: &Point2<f64>) -> f64 {
        let [x0, y0, x1, y1] = self.core;
        (p.x - x0).min(x1 - p.x).min(p.y - y0).min(y1 - p.y)
    }

    /// The buildings that this cell may be responsible for, by their indices. `origin` is that of
    /// the model's frame.
    pub fn keep(&self, model: &RoofModel, origin: &Vector3<f64>) -> Vec<usize> {
        let near = |b: &Building| self.depth(&(middle(b) + origin.xy())) > -SLACK_M;
        (0..model.buildings.len())
            .filter(|&b| near(&model.buildings[b]))
            .collect()
    }

    /// The square of the grid that holds its middle: column and row.
    pub(super) fn place(&self) -> [i64; 2] {
        square_at(self.core)
    }
}

/// The square of the grid that holds the middle of a box: column and row.
pub(super) fn square_at([x0, y0, x1, y1]: [f64; 4]) -> [i64; 2] {
    [x0 + x1, y0 + y1].map(|sum| (0.5 * sum / CELL_M).floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiles::fixture::house;
    use crate::tiles::model_parts::{append, subset};

    #[test]
    fn only_buildings_near_the_core_are_kept() {
        let cell = plan_tiles([0.0, 0.0, 100.0, 50.0], 60.0).unwrap()[0].cells[0];
        let origin = Vector3::new(-1000.0, 0.0, 0.0);
        let mut model = RoofModel::default();
        for x in [80.0, 20.0, 62.0] {
            append(&mut model, &house([x + 1000.0, 25.0]), 0);
        }
        let kept = subset(&model, &cell.keep(&model, &origin));
        let middles: Vec<f64> = kept
            .buildings
            .iter()
            .map(|b| middle(b).x - 1000.0)
            .collect();
        assert_eq!(middles, [20.0, 62.0]);
        assert_eq!(crate::roofs::model::check_invariants(&kept), []);
    }

    #[test]
    fn every_place_lies_in_one_core() {
        let tiles = plan_tiles([100.0, -50.0, 351.0, 49.0], 120.0).unwrap();
        assert_eq!(tiles.len(), 3);
        let cells: Vec<Cell> = tiles.iter().flat_map(|t| t.cells.clone()).collect();
        assert_eq!(cells.len(), 5 * 2);
        for i in 1..1000 {
            let t = f64::from(i) / 1000.0;
            let p = Point2::new(100.0 + 251.0 * t, -50.0 + 99.0 * (t * 37.0).fract());
            assert_eq!(
                cells.iter().filter(|cell| cell.depth(&p) > 0.0).count(),
                1,
                "{p}"
            );
        }
        for (area, size) in [
            ([0.0, 0.0, 1.0, 1.0], 5.0),
            ([0.0, 0.0, 1.0, 1.0], f64::INFINITY),
            ([0.0, 0.0, 1e9, 1e9], 100.0),
            ([0.0, 0.0, f64::NAN, 1.0], 100.0),
        ] {
            let refused = plan_tiles(area, size).unwrap_err().to_string();
            assert!(refused.contains("cannot be divided"), "{refused}");
        }
    }

    #[test]
    fn cells_look_at_the_same_whatever_the_area_and_the_tiles() {
        let regions = |area: [f64; 4], size: f64| {
            let tiles = plan_tiles(area, size).unwrap();
            let mut all: Vec<[f64; 4]> = (tiles.iter())
                .flat_map(|tile| tile.cells.iter().map(|cell| cell.region))
                .collect();
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            all
        };
        let area = [-70.0, 3.0, 301.0, 288.0];
        let cells = regions(area, 60.0);
        assert_eq!(cells, regions(area, 120.0));
        assert_eq!(cells, regions(area, 500.0));
        let part = regions([10.0, 70.0, 50.0, 90.0], 60.0);
        assert_eq!(part, [[-30.0, 30.0, 90.0, 150.0]]);
        assert!(cells.contains(&part[0]));
    }
}
