//! Which squares of an area are reconstructed: one answer for the command line and the page.

use serde::Serialize;

use super::tile::{Tile, plan_tiles};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;
use crate::orienting::scene_loader::{Flight, FlightOverview, LoadOptions, ShownArea};

/// Why a square of an area without a stated region is left out.
pub(super) const WHY_LEFT_OUT: &str = "fewer than three photographs show its ground";

/// Most tiles that the page plans: so many take it days.
const MOST_ON_PAGE: usize = 1000;

/// An area divided into tiles.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Division {
    /// The region of interest, or what three views show: x0, y0, x1, y1, metres, world frame.
    pub(super) area: [f64; 4],
    /// The tiles that are reconstructed, each with the squares that are.
    pub(super) tiles: Vec<Tile>,
    /// The other squares of the area, those of [`WHY_LEFT_OUT`]: what they would be responsible
    /// for.
    pub(super) left_out: Vec<[f64; 4]>,
}

impl Division {
    /// All squares of a region that is stated.
    pub(super) fn of_region(roi: [f64; 4], tile_m: f64) -> Result<Self> {
        Ok(Self {
            area: roi,
            tiles: plan_tiles(roi, tile_m)?,
            left_out: Vec::new(),
        })
    }

    /// The squares in which three views show some ground.
    pub(super) fn of_shown(shown: &ShownArea, tile_m: f64) -> Result<Self> {
        let mut tiles = plan_tiles(shown.bounds, tile_m)?;
        let mut left_out = Vec::new();
        for tile in &mut tiles {
            tile.cells.retain(|cell| {
                let is_shown = shown.meets(cell.core);
                if !is_shown {
                    left_out.push(cell.core);
                }
                is_shown
            });
        }
        tiles.retain(|tile| !tile.cells.is_empty());
        Ok(Self {
            area: shown.bounds,
            tiles,
            left_out,
        })
    }

    /// How many squares are left out, and why; nothing where none are.
    pub(super) fn left_out_in_words(left_out: &[[f64; 4]]) -> String {
        match left_out.len() {
            0 => String::new(),
            1 => format!("; 1 square is left out: {WHY_LEFT_OUT}"),
            count => format!("; {count} squares are left out: {WHY_LEFT_OUT}"),
        }
    }
}

/// A flight before a pixel is read: what the page shows of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FlightPlan {
    /// All photographs, seen from above.
    pub overview: FlightOverview,
    /// What the tiles are responsible for: x0, y0, x1, y1, metres, world frame. What they read is
    /// known after a first look ([`WorkPlan`](super::WorkPlan)).
    pub tiles: Vec<[f64; 4]>,
    /// What is left out of the area, neighbouring squares of a row as one: x0, y0, x1, y1, metres,
    /// world frame.
    pub left_out: Vec<[f64; 4]>,
    /// So many squares that is.
    pub squares_left_out: usize,
    /// Why they are.
    pub why_left_out: &'static str,
    /// Why there are no tiles; null where there are.
    pub problem: Option<String>,
}

impl FlightPlan {
    /// The tiles of about `tile_m` metres of the region of interest, or of what three photographs
    /// show. Of the files their heads suffice. `ground` has its lowest and highest height
    /// where they were measured, metres, world frame: the tiles are then those of
    /// [`BlockPlan`](super::BlockPlan).
    pub fn new(
        files: &[InputFile],
        options: &LoadOptions,
        ground: Option<[f64; 2]>,
        tile_m: f64,
    ) -> Result<Self> {
        let flight = Flight::new(files, options, ground)?;
        let divided = match (options.roi, flight.shown()) {
            (Some(roi), _) => Division::of_region(roi, tile_m),
            (None, Some(shown)) => Division::of_shown(shown, tile_m),
            (None, None) => Err(Error::scene(
                "no place is shown by three photographs",
                "state the region, and the height of the ground",
            )),
        };
        let count = divided.as_ref().map_or(0, |divided| divided.tiles.len());
        let (tiles, left_out, problem) = match divided {
            Ok(_) if count > MOST_ON_PAGE => {
                let problem = format!(
                    "{count} tiles are more than the page plans; choose a region, or larger tiles"
                );
                (Vec::new(), Vec::new(), Some(problem))
            }
            Ok(Division {
                tiles, left_out, ..
            }) => (tiles, left_out, None),
            Err(error) => (Vec::new(), Vec::new(), Some(error.to_string())),
        };
        Ok(Self {
            tiles: tiles.iter().map(|tile| tile.core).collect(),
            overview: flight.overview(),
            squares_left_out: left_out.len(),
            left_out: rows_of(left_out),
            why_left_out: WHY_LEFT_OUT,
            problem,
        })
    }
}

/// Neighbouring squares of a row as one: of a long flight there are a hundred thousand.
fn rows_of(mut squares: Vec<[f64; 4]>) -> Vec<[f64; 4]> {
    squares.sort_by(|a, b| a[1].total_cmp(&b[1]).then(a[0].total_cmp(&b[0])));
    let mut rows: Vec<[f64; 4]> = Vec::new();
    for square in squares {
        match rows.last_mut() {
            Some(last) if [last[2], last[1], last[3]] == [square[0], square[1], square[3]] => {
                last[2] = square[2];
            }
            _ => rows.push(square),
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_squares_of_a_row_are_one() {
        let square = |x: f64, y: f64| [x, y, x + 60.0, y + 60.0];
        let places = [(60.0, 0.0), (0.0, 60.0), (0.0, 0.0), (180.0, 0.0)];
        let rows = rows_of(places.map(|(x, y)| square(x, y)).to_vec());
        assert_eq!(
            rows,
            [
                [0.0, 0.0, 120.0, 60.0],
                square(180.0, 0.0),
                square(0.0, 60.0)
            ]
        );
    }
}
