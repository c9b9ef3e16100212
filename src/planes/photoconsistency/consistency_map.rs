//! The photo-consistency map of a plane.

use serde::{Deserialize, Serialize};

use super::plan_grid::PlanGrid;
use crate::base::evidence::WindowEvidenceTable;

/// Most views compared: pairs grow with the square and six views saturate the measure.
pub(crate) const MAX_VIEWS: usize = 6;

/// How well the views agree on a plane, at every cell of a plan grid.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ConsistencyMap {
    /// The window of the plan.
    pub grid: PlanGrid,
    /// Correlation in steps of 1 / 127. A scene has hundreds of maps: a byte a value keeps them
    /// small.
    pub(crate) correlation: Vec<i8>,
    /// Weight in steps of 1 / 255.
    pub(crate) weight: Vec<u8>,
    /// The same from the median of the views instead of their mean.
    pub(crate) common_weight: Vec<u8>,
}

impl ConsistencyMap {
    /// What nobody sees.
    pub(super) fn unseen(grid: &PlanGrid) -> Self {
        let cells = grid.width * grid.height;
        Self {
            grid: *grid,
            correlation: vec![0; cells],
            weight: vec![0; cells],
            common_weight: vec![0; cells],
        }
    }

    /// Takes over the cells of `window`, which lies in both, from another map.
    pub(super) fn copy(&mut self, other: &Self, window: &PlanGrid) {
        let from_first = |map: &PlanGrid, row: usize| {
            let (c, r) = window.offset_in(map);
            let first = (r as usize + row) * map.width + c as usize;
            first..first + window.width
        };
        for row in 0..window.height {
            let (to, from) = (from_first(&self.grid, row), from_first(&other.grid, row));
            self.correlation[to.clone()].copy_from_slice(&other.correlation[from.clone()]);
            self.weight[to.clone()].copy_from_slice(&other.weight[from.clone()]);
            self.common_weight[to].copy_from_slice(&other.common_weight[from]);
        }
    }

    /// Mean of the better half of the pairwise correlations at cell `k` (row by row), -1 to 1; 0
    /// where the weight is 0.
    pub(crate) fn correlation(&self, k: usize) -> f32 {
        f32::from(self.correlation[k]) / 127.0
    }

    /// Of maps of one grid, at every cell the one with the highest correlation. `None` without
    /// maps.
    pub(crate) fn best_of(maps: &[Self]) -> Option<Self> {
        let mut best = maps.first()?.clone();
        for k in 0..best.correlation.len() {
            let Some(map) = maps.iter().max_by_key(|m| m.correlation[k]) else {
                continue;
            };
            best.correlation[k] = map.correlation[k];
            best.weight[k] = map.weight[k];
            best.common_weight[k] = map.common_weight[k];
        }
        Some(best)
    }

    /// What the window at cell `k` says of the plane, nats.
    pub(crate) fn nats(&self, k: usize) -> f64 {
        WindowEvidenceTable::fitted().nats(self.weight[k], self.correlation[k])
    }

    /// Texture weight of the window at cell `k`, 0 to 1; 0 where fewer than two views see the
    /// window.
    pub(crate) fn weight(&self, k: usize) -> f32 {
        f32::from(self.weight[k]) / 255.0
    }

    /// The same from the median of the views, which an occluder in some of them does not change.
    pub(crate) fn common_weight(&self, k: usize) -> f32 {
        f32::from(self.common_weight[k]) / 255.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_several_maps_the_best_is_taken_with_its_weight() {
        let map = |correlation: [i8; 2], weight: u8| ConsistencyMap {
            grid: PlanGrid {
                origin: nalgebra::Point2::origin(),
                step: 1.0,
                width: 1,
                height: 2,
            },
            correlation: correlation.to_vec(),
            weight: vec![weight; 2],
            common_weight: vec![weight + 1; 2],
        };
        let maps = [map([10, 90], 1), map([60, 20], 3)];
        let best = ConsistencyMap::best_of(&maps).unwrap();
        assert_eq!(best.correlation, [60, 90]);
        assert_eq!(best.weight, [3, 1]);
        assert_eq!(best.common_weight, [4, 2]);
        assert!(ConsistencyMap::best_of(&[]).is_none());
    }
}
