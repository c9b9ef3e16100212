//! The height at which the views agree best on a level plane, on a grid.

use nalgebra::{Point2, Vector3};

use crate::base::execution::{Sharded, sharded_map};
use crate::base::geometry::Plane;
use crate::orienting::scene::Scene;
use crate::planes::photoconsistency::{PlanGrid, consistency_map};

/// Most levels of a sweep. Assumption: more are the fault of a line far too high.
const MOST_LEVELS: usize = 96;

/// The height of the best level at the middle of every cell of `coarse`, between two heights by
/// steps that move the images by a pixel against each other; `None` where fewer than two views see
/// it. `step` is the size of the cells compared, metres.
pub(super) fn best_levels(
    scene: &Scene,
    coarse: &PlanGrid,
    step: f64,
    [low, high]: [f64; 2],
    z_per_pixel: f64,
) -> Sharded<Vec<Option<f64>>> {
    let size = Point2::new(coarse.width as f64, coarse.height as f64) * coarse.step;
    let far = coarse.origin + size.coords;
    let fine = PlanGrid::covering(coarse.origin, far, step);
    let levels = (((high - low) / z_per_pixel).ceil() as usize).clamp(2, MOST_LEVELS);
    let heights: Vec<f64> = (0..levels)
        .map(|i| low + (high - low) * i as f64 / (levels - 1) as f64)
        .collect();
    let cells: Vec<usize> = (0..coarse.width * coarse.height)
        .filter_map(|k| {
            let at = coarse.center(k % coarse.width, k / coarse.width);
            fine.cell(&at)
                .map(|(column, row)| row * fine.width + column)
        })
        .collect();
    let of_levels = sharded_map("levels", &heights, 0.0..0.4, |_, &z| {
        let level = Plane {
            normal: Vector3::z(),
            d: -z,
        };
        let map = consistency_map(scene, &level, &fine);
        let seen = |&k: &usize| (map.weight[k] > 0).then(|| map.correlation[k]);
        cells.iter().map(seen).collect::<Vec<Option<i8>>>()
    })?;
    let best_at = |cell: usize| {
        let seen = of_levels.iter().zip(&heights);
        let seen = seen.filter_map(|(level, z)| level[cell].map(|correlation| (correlation, *z)));
        // The lowest of equal ones.
        seen.max_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)))
            .map(|(_, z)| z)
    };
    Ok((0..cells.len()).map(best_at).collect())
}
