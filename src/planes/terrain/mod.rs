//! Height of the ground: from the images by a sweep of horizontal planes and the smooth surface
//! under what it finds, and from a terrain model where one is known (`given`).
//!
//! Every view, reduced four times, is compared with the others on horizontal planes at steps of
//! height (the measure that verifies facets, `photoconsistency`). Each position takes the
//! height at which the views agree best. The ground is the surface of least energy under those
//! positions (`surface`): roofs and trees only rise above it, wrong matches below it are few, and
//! it hardly leaves the plane that it lies in as a whole.
//!
//! Invariant: the ground has a height at every plan position, also outside of what was swept.

mod common_plane;
mod given;
mod surface;
mod sweep;

pub(crate) use given::ROOF_M;

use common_plane::{MIN_SAMPLES, STANDS_OUT, is_within};
use nalgebra::{Point2, Point3, Vector2};
use serde::{Deserialize, Serialize};
use surface::ROUGHNESS;

use crate::base::execution::Sharded;
use crate::base::geometry::{Plane, Segment3};
use crate::base::math::{larger, smaller};
use crate::lines::lines3d::Line3d;
use crate::orienting::known::KnownComparison;
use crate::orienting::scene::Scene;

/// The ground: a plane and, on a coarse grid over the scene, how far it rises above that.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ground {
    min: Point2<f64>,
    /// Side of a block, metres.
    block_m: f64,
    columns: usize,
    rows: usize,
    /// Rise of the middle of each block above the plane, metres, row by row; empty for none.
    rises: Vec<f64>,
    /// The plane that the ground lies in as a whole; local frame.
    plane: Plane,
    /// How a terrain model that is known compares with the images.
    terrain: Option<KnownComparison>,
}

/// Positions within this distance of a block's middle settle its height, metres.
const SETTLING: f64 = 7.5;
impl Ground {
    /// Side of the blocks in which it is estimated, metres.
    pub(crate) const BLOCK_M: f64 = 5.0;

    /// The same height everywhere.
    pub fn level(z: f64) -> Self {
        Self {
            min: Point2::origin(),
            block_m: Self::BLOCK_M,
            columns: 0,
            rows: 0,
            rises: Vec::new(),
            plane: Plane::level(z),
            terrain: None,
        }
    }

    /// Do both ends of a line lie lower than this above the ground, metres?
    pub fn is_near(&self, line: &Segment3, height_m: f64) -> bool {
        let low = |p: &Point3<f64>| p.z - self.z_at(&p.xy()) < height_m;
        low(&line.p0) && low(&line.p1)
    }

    /// Sweeps the scene between the heights that its 3D lines span; the given height when there is
    /// one.
    pub fn estimate(scene: &Scene, lines: &[Line3d]) -> Sharded<Self> {
        let segments: Vec<Segment3> = lines.iter().map(|l| l.segment).collect();
        Self::of_segments(scene, &segments, None)
    }

    /// The same from 3D lines without their accuracy, swept between two heights where they are
    /// known: the lines may all be those of a roof.
    pub fn of_segments(
        scene: &Scene,
        lines: &[Segment3],
        z_range: Option<[f64; 2]>,
    ) -> Sharded<Self> {
        if let Some(z) = scene.ground_z {
            return Ok(Self::level(z));
        }
        let mut ends: Vec<Point3<f64>> = lines.iter().flat_map(|l| [l.p0, l.p1]).collect();
        if ends.is_empty() {
            return Ok(Self::level(0.0));
        }
        ends.sort_by(|a, b| a.z.total_cmp(&b.z));
        // A few wrong lines may lie far off.
        let share = |f: f64| ends[(f * (ends.len() - 1) as f64) as usize].z;
        let around_lines = [share(0.02) - 2.0, share(0.98) + 1.0];
        let [low, high] = z_range.unwrap_or(around_lines);
        let samples = sweep::matched_positions(scene, &ends, low, high)?;
        let elsewhere =
            common_plane::low_height(samples.iter().map(|s| s.z)).unwrap_or_else(|| share(0.1));
        let found = Self::from_samples(&samples, elsewhere);
        Ok(match &scene.known.terrain {
            Some(terrain) => found.with_terrain(terrain, &samples, &ends),
            None => found,
        })
    }

    fn from_samples(samples: &[Point3<f64>], elsewhere: f64) -> Self {
        let bound = |start: f64, f: fn(f64, f64) -> f64| {
            Point2::new(
                samples.iter().map(|s| s.x).fold(start, f),
                samples.iter().map(|s| s.y).fold(start, f),
            )
        };
        let (min, max) = (
            bound(f64::INFINITY, f64::min),
            bound(f64::NEG_INFINITY, f64::max),
        );
        if samples.is_empty() {
            return Self::level(elsewhere);
        }
        let (columns, rows) = (
            ((max.x - min.x) / Self::BLOCK_M) as usize + 1,
            ((max.y - min.y) / Self::BLOCK_M) as usize + 1,
        );
        let mut ground = Self {
            min,
            block_m: Self::BLOCK_M,
            columns,
            rows,
            rises: vec![0.0; columns * rows],
            plane: Plane::level(elsewhere),
            terrain: None,
        };
        let places: Vec<Point2<f64>> = (0..columns * rows).map(|k| ground.middle(k)).collect();
        let planes = common_plane::proposals(samples, &places);
        let surfaces = planes.into_iter().map(|plane| {
            let blocks = Self {
                plane,
                ..ground.clone()
            }
            .blocks(samples);
            (plane, surface::below(&blocks))
        });
        let least = surfaces.min_by(|a, b| a.1.energy.total_cmp(&b.1.energy));
        if let Some((plane, surface)) = least {
            ground.plane = plane;
            ground.rises = surface.heights;
        }
        ground.settle(samples);
        ground
    }

    /// The rises of the positions in each block.
    fn blocks(&self, samples: &[Point3<f64>]) -> surface::Blocks {
        let mut heights = vec![Vec::new(); self.rises.len()];
        for p in samples {
            heights[self.block_of(p)].push(self.above_plane(p));
        }
        for block in &mut heights {
            block.sort_by(f64::total_cmp);
        }
        surface::Blocks {
            columns: self.columns,
            heights,
        }
    }

    fn block_of(&self, p: &Point3<f64>) -> usize {
        let at = |x: f64, min: f64| ((x - min) / self.block_m) as usize;
        let (c, r) = (at(p.x, self.min.x), at(p.y, self.min.y));
        r * self.columns + c
    }

    fn above_plane(&self, p: &Point3<f64>) -> f64 {
        p.z - self.plane.z_at(p.x, p.y)
    }

    /// The plane that the ground lies in as a whole.
    pub fn plane(&self) -> Plane {
        self.plane
    }

    /// Middle of a block, in plan.
    fn middle(&self, k: usize) -> Point2<f64> {
        let (c, r) = ((k % self.columns) as f64, (k / self.columns) as f64);
        self.min + Vector2::new(c + 0.5, r + 0.5) * self.block_m
    }

    /// Moves every block to the middle of what is matched around it on the surface.
    fn settle(&mut self, samples: &[Point3<f64>]) {
        let rise = |p: &Point3<f64>| self.above_plane(p);
        let on_surface: Vec<&Point3<f64>> = (samples.iter())
            .filter(|p| (p.z - self.z_at(&p.xy())).abs() < ROUGHNESS)
            .collect();
        let blocks: Vec<usize> = (0..self.rises.len()).collect();
        let settled = crate::base::execution::map(&blocks, |_, &k| {
            let at = self.middle(k);
            let near = on_surface.iter().filter(|p| is_within(p, &at, SETTLING));
            let mut rises: Vec<f64> = near.map(|p| rise(p)).collect();
            let enough = rises.len() >= MIN_SAMPLES;
            let middle = crate::base::math::median(&mut rises).filter(|_| enough);
            middle.unwrap_or(self.rises[k])
        });
        self.rises = settled;
    }

    /// Ground height at a plan position, metres; between the middles of blocks it is bilinear.
    pub fn z_at(&self, p: &Point2<f64>) -> f64 {
        let plane = self.plane.z_at(p.x, p.y);
        if self.rises.is_empty() {
            return plane;
        }
        let at = |x: f64, min: f64, count: usize| {
            let x = ((x - min) / self.block_m - 0.5).clamp(0.0, (count - 1) as f64);
            let low = (x as usize).min(count.saturating_sub(2));
            (low, (low + 1).min(count - 1), x - low as f64)
        };
        let (c0, c1, u) = at(p.x, self.min.x, self.columns);
        let (r0, r1, v) = at(p.y, self.min.y, self.rows);
        let rise = |c: usize, r: usize| self.rises[r * self.columns + c];
        let row = |r: usize| rise(c0, r) + (rise(c1, r) - rise(c0, r)) * u;
        plane + row(r0) + (row(r1) - row(r0)) * v
    }

    /// Ground height below a building, metres: the middle one of those at its corners, the lowest
    /// on a slope, so that all walls end in the ground.
    pub fn below<'a>(&self, corners: impl Iterator<Item = &'a Point3<f64>>) -> f64 {
        let mut heights: Vec<f64> = corners.map(|p| self.z_at(&p.xy())).collect();
        let lowest = heights.iter().copied().fold(f64::INFINITY, smaller);
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, larger);
        if highest - lowest > STANDS_OUT {
            return lowest;
        }
        crate::base::math::median(&mut heights).unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing::uniform;

    /// Matched positions half a metre apart on 60 m by 60 m: rough ground that slopes, a roof on
    /// two thirds of the place around the middle, a few wrong matches below.
    fn samples() -> Vec<Point3<f64>> {
        let mut even = uniform(7);
        let mut samples = Vec::new();
        for (column, row) in (0..120).flat_map(|c| (0..120).map(move |r| (c, r))) {
            let (x, y) = (0.5 * f64::from(column), 0.5 * f64::from(row));
            let on_roof = (x - 30.0).abs() < 15.0 && (y - 30.0).abs() < 15.0;
            let z = match (on_roof, even()) {
                (_, chance) if chance < 0.02 => ground(x, y) - 3.0,
                (true, _) => ground(30.0, 30.0) + 2.4,
                (false, _) => ground(x, y) + 0.6 * (even() - 0.5),
            };
            samples.push(Point3::new(x, y, z));
        }
        samples
    }

    fn ground(x: f64, y: f64) -> f64 {
        50.0 + 0.02 * x - 0.01 * y
    }

    #[test]
    fn sloping_ground_is_found_beside_a_large_roof() {
        let found = Ground::from_samples(&samples(), 49.0);
        for (x, y) in [(30.0, 30.0), (8.0, 8.0), (52.0, 30.0), (30.0, 8.0)] {
            let miss = found.z_at(&Point2::new(x, y)) - ground(x, y);
            assert!(miss.abs() < 0.12, "{miss} m at {x}, {y}");
        }
    }

    #[test]
    fn a_slope_of_15_degrees_is_found_below_a_roof() {
        let steep = |x: f64, y: f64| 0.25 * x - 0.1 * y;
        let samples: Vec<Point3<f64>> = (samples().into_iter())
            .map(|p| Point3::new(p.x, p.y, p.z + steep(p.x, p.y)))
            .collect();
        let found = Ground::from_samples(&samples, 49.0);
        for (x, y) in [(30.0, 30.0), (8.0, 8.0), (52.0, 30.0), (30.0, 8.0)] {
            let miss = found.z_at(&Point2::new(x, y)) - ground(x, y) - steep(x, y);
            assert!(miss.abs() < 0.15, "{miss} m at {x}, {y}");
        }
    }

    /// Matched positions half a metre apart on 60 m by 60 m at heights by position.
    fn positions(z: impl Fn(f64, f64) -> f64) -> Vec<Point3<f64>> {
        let positions = (0..120).flat_map(|c| (0..120).map(move |r| (c, r)));
        positions
            .map(|(c, r)| (0.5 * f64::from(c), 0.5 * f64::from(r)))
            .map(|(x, y)| Point3::new(x, y, z(x, y)))
            .collect()
    }

    #[test]
    fn a_bank_is_followed_and_a_roof_on_its_top_is_not() {
        // A terrace 1.8 m higher on a third of the place; a flat roof of 12 m by 8 m on it.
        let terrace = |x: f64| ground(x, 0.0) + if x > 40.0 { 1.8 } else { 0.0 };
        let roof = |x: f64, y: f64| (x - 50.0).abs() < 6.0 && (y - 30.0).abs() < 4.0;
        let z = |x: f64, y: f64| terrace(x) + if roof(x, y) { 3.0 } else { 0.0 };
        let found = Ground::from_samples(&positions(z), 49.0);
        for (x, y) in [(10.0, 30.0), (30.0, 10.0), (55.0, 10.0), (50.0, 30.0)] {
            let miss = found.z_at(&Point2::new(x, y)) - terrace(x);
            assert!(miss.abs() < 0.15, "{miss} m at {x}, {y}");
        }
    }

    #[test]
    fn a_large_sloping_roof_over_level_ground_is_no_slope() {
        let roof = |x: f64| {
            if x > 36.0 {
                5.0 + 0.2 * (x - 36.0)
            } else {
                0.0
            }
        };
        let found = Ground::from_samples(&positions(|x, _| 50.0 + roof(x)), 49.0);
        for (x, y) in [(6.0, 30.0), (30.0, 50.0), (50.0, 30.0)] {
            let miss = found.z_at(&Point2::new(x, y)) - 50.0;
            assert!(miss.abs() < 0.3, "{miss} m at {x}, {y}");
        }
    }

    #[test]
    fn ground_without_matches_has_one_height() {
        let level = Ground::level(3.0);
        assert_eq!(level.z_at(&Point2::new(7.0, -2.0)), 3.0);
        assert_eq!(Ground::from_samples(&[], 3.0), level);
        assert!(common_plane::proposals(&[], &[]).is_empty());
    }
}
