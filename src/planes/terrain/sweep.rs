//! Matched positions: where the views agree best among horizontal planes.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use crate::base::execution::{Sharded, sharded_map};
use crate::base::geometry::Plane;
use crate::orienting::scene::{Scene, View};
use crate::photographs::camera::FEWEST_VIEWS;
use crate::planes::photoconsistency::{PlanGrid, consistency_map};

/// Images are reduced by this factor for the sweep.
const REDUCE: usize = 4;
/// Most planes in the sweep.
const MAX_LEVELS: usize = 64;
/// A position counts as matched from this correlation and texture weight on.
const MIN_CORRELATION: f32 = 0.7;
const MIN_WEIGHT: f32 = 0.5;
/// The positions around `ends`, which are sorted by height, at which the views agree well between
/// two heights; metres, local frame.
pub(super) fn matched_positions(
    scene: &Scene,
    ends: &[Point3<f64>],
    low: f64,
    high: f64,
) -> Sharded<Vec<Point3<f64>>> {
    let reduced = scene.reduced(REDUCE);
    let middle = ends[ends.len() / 2];
    let Some(view) = reduced.views.first() else {
        return Ok(Vec::new());
    };
    let step = PlanGrid::cell_of_pixels(view.camera.ground_pixel(&middle));
    let bound = |f: fn(f64, f64) -> f64, start: f64| {
        let x = ends.iter().map(|p| p.x).fold(start, f);
        let y = ends.iter().map(|p| p.y).fold(start, f);
        Point2::new(x, y)
    };
    let margin = Vector2::new(5.0, 5.0);
    let (min, max) = (
        bound(f64::min, f64::INFINITY) - margin,
        bound(f64::max, f64::NEG_INFINITY) + margin,
    );
    let grid = PlanGrid::covering(min, max, step);
    // Bounds the memory of a window that a wrong line has stretched.
    if grid.width * grid.height > 1_000_000 {
        return Ok(Vec::new());
    }
    let levels = (((high - low) / 0.5).ceil() as usize).clamp(2, MAX_LEVELS);
    let heights: Vec<f64> = (0..levels)
        .map(|i| low + (high - low) * i as f64 / (levels - 1) as f64)
        .collect();
    let maps = sharded_map("ground", &heights, 0.0..1.0, |_, &z| {
        let plane = Plane {
            normal: Vector3::z(),
            d: -z,
        };
        consistency_map(&reduced, &plane, &grid)
    })?;
    let mut samples = Vec::new();
    for row in 0..grid.height {
        for column in 0..grid.width {
            let k = row * grid.width + column;
            let best = (0..levels)
                .filter(|&i| {
                    maps[i].weight(k) >= MIN_WEIGHT && maps[i].correlation(k) >= MIN_CORRELATION
                })
                .max_by(|&i, &j| {
                    maps[i]
                        .correlation(k)
                        .total_cmp(&maps[j].correlation(k))
                        .then(j.cmp(&i))
                });
            let p = grid.center(column, row);
            let seen = |z: &f64| views_of(scene, &Point3::new(p.x, p.y, *z)) >= FEWEST_VIEWS;
            if let Some(i) = best.filter(|i| seen(&heights[*i])) {
                let correlation = |i: usize| maps.get(i).map(|m| f64::from(m.correlation(k)));
                let beside = [i.checked_sub(1).and_then(correlation), correlation(i + 1)];
                let between = top_between(beside, f64::from(maps[i].correlation(k)));
                let z = heights[i] + between * (heights[1] - heights[0]);
                samples.push(Point3::new(p.x, p.y, z));
            }
        }
    }
    Ok(samples)
}

/// How many views see a point.
fn views_of(scene: &Scene, point: &Point3<f64>) -> usize {
    let sees = |v: &&View| {
        let image = v.camera.project(point);
        image.is_some_and(|x| v.camera.contains(&x, 0.0))
    };
    scene.views.iter().filter(sees).count()
}

/// Where the parabola through a correlation and those a level below and above it has its top, in
/// levels.
fn top_between([below, above]: [Option<f64>; 2], at: f64) -> f64 {
    let (Some(below), Some(above)) = (below, above) else {
        return 0.0;
    };
    let bend = 2.0 * at - below - above;
    if bend > 0.0 {
        (0.5 * (above - below) / bend).clamp(-0.5, 0.5)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_top_lies_between_the_levels() {
        let parabola = |t: f64| 0.9 - 0.2 * (t - 0.3) * (t - 0.3);
        let beside = [Some(parabola(-1.0)), Some(parabola(1.0))];
        assert!((top_between(beside, parabola(0.0)) - 0.3).abs() < 1e-9);
        assert_eq!(top_between([None, Some(0.5)], 0.6), 0.0);
        assert_eq!(top_between([Some(0.5), Some(0.5)], 0.5), 0.0);
    }
}
