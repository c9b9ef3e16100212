//! The height of the ground as a first look shows it, so that a cell need not look far around
//! itself to know it.

use std::collections::BTreeMap;

use nalgebra::{Point2, Vector3};
use serde::{Deserialize, Serialize};

use super::tile::Cell;
use crate::orienting::scene_loader::LoadOptions;
use crate::pipeline::Run;
use crate::planes::terrain::Ground;

/// Squares of [`Ground::BLOCK_M`] of the world, by row and column.
type Block = [i64; 2];

/// Heights of the ground, block by block.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<Row>", into = "Vec<Row>")]
pub(super) struct SeenGround(BTreeMap<Block, i32>);

/// Neighbouring blocks from west to east, as they are kept.
#[derive(Serialize, Deserialize)]
struct Row {
    /// Row and column of the first one.
    first: Block,
    /// Their heights, centimetres, world frame of the input.
    cm: String,
}

impl SeenGround {
    /// The ground that a run shows in a square; none where something known says it better.
    pub(super) fn of_run(run: &Run, square: &Cell) -> Self {
        let (scene, mut seen) = (run.scene(), Self::default());
        let ground = (run.results().ground.as_ref()).filter(|_| scene.known.terrain.is_none());
        let Some(ground) = ground else {
            return seen;
        };
        for block in blocks_in(square.core) {
            let z = ground.z_at(&(middle_of(block) - scene.origin.xy())) + scene.origin.z;
            seen.0.insert(block, (100.0 * z).round() as i32);
        }
        seen
    }

    /// Adds what another square shows.
    pub(super) fn add(&mut self, other: Self) {
        self.0.extend(other.0);
    }

    /// Is nothing known of the ground?
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The ground in a box of the world, metres, in the frame of this origin; `None` where less
    /// than half of it is known.
    pub(super) fn within(&self, region: [f64; 4], origin: &Vector3<f64>) -> Option<Ground> {
        let [x0, y0, x1, y1] = [0, 1, 2, 3].map(|i| region[i] - origin[i % 2]);
        // Whole blocks of the world.
        let [dx, dy] = [0, 1].map(|i| region[i].rem_euclid(Ground::BLOCK_M));
        let z = |p: &Point2<f64>| {
            let cm = self.0.get(&block_at(p + origin.xy()))?;
            Some(0.01 * f64::from(*cm) - origin.z)
        };
        Ground::laid([x0 - dx, y0 - dy, x1, y1], Ground::BLOCK_M, z, None)
    }

    /// Its lowest and highest height in a box of the world, metres, world frame; `None` where
    /// [`Self::within`] knows no ground.
    pub(super) fn range(&self, region: [f64; 4]) -> Option<[f64; 2]> {
        self.within(region, &Vector3::zeros())?;
        let known = blocks_in(region).filter_map(|block| self.0.get(&block).copied());
        let [low, high] = known.fold([i32::MAX, i32::MIN], |[low, high], cm| {
            [low.min(cm), high.max(cm)]
        });
        Some([low, high].map(|cm| 0.01 * f64::from(cm)))
    }
}

impl From<SeenGround> for Vec<Row> {
    fn from(SeenGround(blocks): SeenGround) -> Self {
        let mut rows: Vec<Row> = Vec::new();
        let mut next = None;
        for ([row, column], cm) in blocks {
            match rows.last_mut().filter(|_| next == Some([row, column])) {
                Some(last) => last.cm += &format!(" {cm}"),
                None => rows.push(Row {
                    first: [row, column],
                    cm: cm.to_string(),
                }),
            }
            next = Some([row, column + 1]);
        }
        rows
    }
}

impl From<Vec<Row>> for SeenGround {
    fn from(rows: Vec<Row>) -> Self {
        let blocks = rows.iter().flat_map(|Row { first, cm }| {
            let heights = cm.split(' ').map_while(|cm| cm.parse().ok());
            (first[1]..).map(|column| [first[0], column]).zip(heights)
        });
        Self(blocks.collect())
    }
}

fn block_at(p: Point2<f64>) -> Block {
    [p.y, p.x].map(|v| (v / Ground::BLOCK_M).floor() as i64)
}

fn middle_of([row, column]: Block) -> Point2<f64> {
    let at = |i: i64| (i as f64 + 0.5) * Ground::BLOCK_M;
    Point2::new(at(column), at(row))
}

/// The blocks of a box, also those that it cuts.
fn blocks_in([x0, y0, x1, y1]: [f64; 4]) -> impl Iterator<Item = Block> {
    let [[first_row, first], [last_row, last]] =
        [[x0, y0], [x1, y1]].map(|corner| block_at(corner.into()));
    (first_row..=last_row).flat_map(move |row| (first..=last).map(move |column| [row, column]))
}

/// The options with which a cell is loaded, on ground that a first look has shown.
pub(super) fn options_of(cell: &Cell, options: &LoadOptions, ground: &SeenGround) -> LoadOptions {
    LoadOptions {
        roi: Some(cell.region),
        ground_range: ground.range(cell.region),
        ..options.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slope() -> SeenGround {
        let z = |block: Block| (1000.0 + 10.0 * middle_of(block).x) as i32;
        let blocks = blocks_in([-40.0, -20.0, 39.0, 19.0]);
        SeenGround(blocks.map(|block| (block, z(block))).collect())
    }

    #[test]
    fn a_slope_is_the_same_in_the_frame_of_any_origin() {
        let origin = Vector3::new(3.0, -2.0, 7.0);
        let ground = slope().within([-11.0, -12.0, 17.0, 9.0], &origin).unwrap();
        for (x, y) in [(-11.0, -12.0), (4.0, 0.5), (17.0, 9.0)] {
            let z = ground.z_at(&Point2::new(x - origin.x, y - origin.y)) + origin.z;
            assert!((z - (10.0 + 0.1 * x)).abs() < 0.01, "{z} at {x}, {y}");
        }
    }

    #[test]
    fn half_of_a_box_is_enough_and_less_is_not() {
        let origin = Vector3::zeros();
        assert!(slope().within([0.0, -20.0, 60.0, 20.0], &origin).is_some());
        assert!(slope().within([30.0, -20.0, 60.0, 20.0], &origin).is_none());
        assert_eq!(slope().range([30.0, -20.0, 60.0, 20.0]), None);
        assert_eq!(slope().range([-9.0, -20.0, 12.0, 4.0]), Some([9.25, 11.25]));
    }

    #[test]
    fn what_is_kept_comes_back() {
        let mut seen = slope();
        seen.0.retain(|block, _| block[1] != 3);
        let text = serde_json::to_string(&seen).unwrap();
        assert_eq!(serde_json::from_str::<SeenGround>(&text).unwrap(), seen);
        let bytes = postcard::to_stdvec(&seen).unwrap();
        assert_eq!(postcard::from_bytes::<SeenGround>(&bytes).unwrap(), seen);
    }
}
