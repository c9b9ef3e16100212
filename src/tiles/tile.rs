//! Tiles: cores that cover an area without gap or overlap, and regions with a margin around them.

use nalgebra::{Point2, Vector3};
use serde::{Deserialize, Serialize};

use super::model_parts::{middle, subset};
use crate::error::{Error, Result};
use crate::model::{Building, RoofModel};

/// Width of the margin around a core, metres. Assumption: a house and its neighbours' eaves, which
/// take part in what its lines mean.
pub const MARGIN_M: f64 = 30.0;

/// Buildings whose middle lies this far beyond the core are kept until the tiles are joined,
/// metres: the neighbour may see their middle on this side.
const SLACK_M: f64 = 3.0;

/// Most tiles of an area.
const MOST_TILES: f64 = 100_000.0;

/// A part of the area: x0, y0, x1, y1 in metres, world frame of the input.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tile {
    /// What the tile is responsible for.
    pub core: [f64; 4],
    /// What it looks at.
    pub region: [f64; 4],
}

/// Tiles of about `tile_m` metres that cover an area; from west to east, then from south to north.
pub fn plan_tiles(area: [f64; 4], tile_m: f64) -> Result<Vec<Tile>> {
    let [x0, y0, x1, y1] = area;
    let sizes = [x1 - x0, y1 - y0];
    let counts = sizes.map(|size| (size / tile_m).ceil().max(1.0));
    if !(tile_m >= MARGIN_M
        && sizes.iter().all(|&s| s > 0.0 && s.is_finite())
        && counts[0] * counts[1] <= MOST_TILES)
    {
        return Err(Error::Scene {
            problem: format!(
                "{:.0} x {:.0} m cannot be divided into tiles of {tile_m} m",
                sizes[0], sizes[1]
            ),
            advice: format!(
                "choose tiles of {MARGIN_M:.0} m or more, and no more than {MOST_TILES:.0} of them"
            ),
        });
    }
    let edge = |from: f64, axis: usize, i: usize| from + sizes[axis] * i as f64 / counts[axis];
    let mut tiles = Vec::new();
    for j in 0..counts[1] as usize {
        for i in 0..counts[0] as usize {
            let core = [
                edge(x0, 0, i),
                edge(y0, 1, j),
                edge(x0, 0, i + 1),
                edge(y0, 1, j + 1),
            ];
            let [a, b, c, d] = core;
            tiles.push(Tile {
                core,
                region: [a - MARGIN_M, b - MARGIN_M, c + MARGIN_M, d + MARGIN_M],
            });
        }
    }
    Ok(tiles)
}

impl Tile {
    /// How far a place lies inside the core, metres; negative outside.
    pub(super) fn depth(&self, p: &Point2<f64>) -> f64 {
        let [x0, y0, x1, y1] = self.core;
        (p.x - x0).min(x1 - p.x).min(p.y - y0).min(y1 - p.y)
    }

    /// Does the core hold this place? Cores share no place.
    pub(super) fn holds(&self, p: &Point2<f64>) -> bool {
        let [x0, y0, x1, y1] = self.core;
        p.x >= x0 && p.x < x1 && p.y >= y0 && p.y < y1
    }

    /// The buildings that this tile may be responsible for. `origin` is that of the model's frame.
    pub fn keep(&self, model: &RoofModel, origin: &Vector3<f64>) -> RoofModel {
        let near = |b: &Building| self.depth(&(middle(b) + origin.xy())) > -SLACK_M;
        let chosen: Vec<usize> = (0..model.buildings.len())
            .filter(|&b| near(&model.buildings[b]))
            .collect();
        subset(model, &chosen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiles::fixture::house;
    use crate::tiles::model_parts::append;

    #[test]
    fn only_buildings_near_the_core_are_kept() {
        let tile = plan_tiles([0.0, 0.0, 100.0, 50.0], 50.0).unwrap()[0];
        let origin = Vector3::new(-1000.0, 0.0, 0.0);
        let mut model = RoofModel::default();
        for x in [70.0, 20.0, 52.0] {
            append(&mut model, &house([x + 1000.0, 25.0]), 0);
        }
        let kept = tile.keep(&model, &origin);
        let middles: Vec<f64> = kept
            .buildings
            .iter()
            .map(|b| middle(b).x - 1000.0)
            .collect();
        assert_eq!(middles, [20.0, 52.0]);
        assert_eq!(crate::model::check_invariants(&kept), []);
    }

    #[test]
    fn every_place_lies_in_one_core() {
        let tiles = plan_tiles([100.0, -50.0, 351.0, 49.0], 50.0).unwrap();
        assert_eq!(tiles.len(), 6 * 2);
        for i in 0..1000 {
            let t = f64::from(i) / 1000.0;
            let p = Point2::new(100.0 + 251.0 * t, -50.0 + 99.0 * (t * 37.0).fract());
            assert_eq!(tiles.iter().filter(|tile| tile.holds(&p)).count(), 1, "{p}");
        }
        assert!(tiles.iter().all(|t| t.core[0] - t.region[0] == MARGIN_M));
        for (area, size) in [
            ([0.0, 0.0, 1.0, 1.0], 5.0),
            ([0.0, 0.0, 1e9, 1e9], 100.0),
            ([0.0, 0.0, f64::NAN, 1.0], 100.0),
        ] {
            assert!(
                plan_tiles(area, size)
                    .unwrap_err()
                    .to_string()
                    .contains("cannot be divided")
            );
        }
    }
}
