//! Height of the ground from the images: a sweep of horizontal planes, and the smooth surface
//! under what it finds.
//!
//! Every view, reduced four times, is compared with the others on horizontal planes at steps of
//! height (the measure that verifies facets, `photoconsistency`). Each position takes the
//! height at which the views agree best. The ground is the surface of least energy under those
//! positions ([`surface`]): roofs and trees only rise above it, wrong matches below it are few, and
//! it hardly leaves the plane that it lies in as a whole.

mod surface;

use nalgebra::{Point2, Point3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::execution::{Sharded, sharded_map};
use crate::geometry::{Plane, Segment3};
use crate::lines3d::Line3d;
use crate::model::Facet;
use crate::photoconsistency::{PlanGrid, consistency_map};
use crate::scene::{Scene, View};

/// The ground: a plane and, on a coarse grid over the scene, how far it rises above that.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ground {
    min: Point2<f64>,
    columns: usize,
    rows: usize,
    /// Rise of the middle of each block above the plane, metres, row by row; empty for none.
    rises: Vec<f64>,
    /// The plane that the ground lies in as a whole; local frame.
    plane: Plane,
}

/// Blocks further than this from a plane do not lie in it, metres: lower than any eave.
const STANDS_OUT: f64 = 1.0;
/// Ground as a whole slopes less than this (normal's z of 18 degrees). Assumption: a steeper fit
/// follows a roof.
const LEAST_LEVEL: f64 = 0.95;
/// Cell of the ground grid, metres.
const CELL: f64 = 5.0;
/// Within this distance of a block ground is matched, metres: more than half the width of a
/// building.
const RADIUS: f64 = 18.0;
/// Positions within this distance of a block's middle settle its height, metres.
const SETTLING: f64 = 7.5;
/// What lies closer than this to the surface is ground, metres: as rough as ground is.
const ROUGHNESS: f64 = 0.5;
/// Images are reduced by this factor for the sweep.
const REDUCE: usize = 4;
/// Most planes in the sweep.
const MAX_LEVELS: usize = 64;
/// A position counts as matched from this correlation and texture weight on.
const MIN_CORRELATION: f32 = 0.7;
const MIN_WEIGHT: f32 = 0.5;
/// What fewer views see may agree by chance: a third one checks it.
const LEAST_VIEWS: usize = 3;
/// Fewer matched positions determine no height.
const MIN_SAMPLES: usize = 30;
/// Positions within this height share it, metres: as rough as ground is.
const ONE_HEIGHT: f64 = 1.0;
/// The ground has at least this share of the positions of the height that most share, which may be
/// a roof's. Assumption: wrong matches on real photographs have up to a sixth.
const LEAST_OF_MOST: f64 = 0.25;

impl Ground {
    /// The same height everywhere.
    pub fn level(z: f64) -> Self {
        Self {
            min: Point2::origin(),
            columns: 0,
            rows: 0,
            rises: Vec::new(),
            plane: level_plane(z),
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
        let samples = sweep(scene, &ends, low, high)?;
        let elsewhere = low_height(samples.iter().map(|s| s.z)).unwrap_or_else(|| share(0.1));
        Ok(Self::from_samples(&samples, elsewhere))
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
            ((max.x - min.x) / CELL) as usize + 1,
            ((max.y - min.y) / CELL) as usize + 1,
        );
        let mut ground = Self {
            min,
            columns,
            rows,
            rises: vec![0.0; columns * rows],
            plane: level_plane(elsewhere),
        };
        let blocks: Vec<usize> = (0..columns * rows).collect();
        let lowest = crate::execution::map(&blocks, |_, &k| {
            let at = ground.middle(k);
            let near = samples.iter().filter(|s| is_within(s, &at, RADIUS));
            low_height(near.map(|s| s.z)).map(|z| Point3::new(at.x, at.y, z))
        });
        let lowest: Vec<Point3<f64>> = lowest.into_iter().flatten().collect();
        let planes = planes_through(&lowest);
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
            let (c, r) = ((p.x - self.min.x) / CELL, (p.y - self.min.y) / CELL);
            heights[r as usize * self.columns + c as usize].push(self.above_plane(p));
        }
        for block in &mut heights {
            block.sort_by(f64::total_cmp);
        }
        surface::Blocks {
            columns: self.columns,
            heights,
        }
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
        self.min + Vector2::new(c + 0.5, r + 0.5) * CELL
    }

    /// Moves every block to the middle of what is matched around it on the surface.
    fn settle(&mut self, samples: &[Point3<f64>]) {
        let rise = |p: &Point3<f64>| self.above_plane(p);
        let on_surface: Vec<&Point3<f64>> = (samples.iter())
            .filter(|p| (p.z - self.z_at(&p.xy())).abs() < ROUGHNESS)
            .collect();
        let blocks: Vec<usize> = (0..self.rises.len()).collect();
        let settled = crate::execution::map(&blocks, |_, &k| {
            let at = self.middle(k);
            let near = on_surface.iter().filter(|p| is_within(p, &at, SETTLING));
            let mut rises: Vec<f64> = near.map(|p| rise(p)).collect();
            let enough = rises.len() >= MIN_SAMPLES;
            let middle = crate::math::median(&mut rises).filter(|_| enough);
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
            let x = ((x - min) / CELL - 0.5).clamp(0.0, (count - 1) as f64);
            let low = (x as usize).min(count.saturating_sub(2));
            (low, (low + 1).min(count - 1), x - low as f64)
        };
        let (c0, c1, u) = at(p.x, self.min.x, self.columns);
        let (r0, r1, v) = at(p.y, self.min.y, self.rows);
        let rise = |c: usize, r: usize| self.rises[r * self.columns + c];
        let row = |r: usize| rise(c0, r) + (rise(c1, r) - rise(c0, r)) * u;
        plane + row(r0) + (row(r1) - row(r0)) * v
    }

    /// Ground height below a building, metres: the middle one of those at its corners.
    pub fn below(&self, members: &[&Facet]) -> f64 {
        let mut heights: Vec<f64> = members
            .iter()
            .flat_map(|f| &f.outer)
            .map(|p| self.z_at(&p.xy()))
            .collect();
        crate::math::median(&mut heights).unwrap_or(f64::NAN)
    }
}

fn level_plane(z: f64) -> Plane {
    Plane {
        normal: Vector3::z(),
        d: -z,
    }
}

/// Planes that the ground may lie in as a whole: fits to the blocks from several heights.
fn planes_through(blocks: &[Point3<f64>]) -> Vec<Plane> {
    const STARTS: usize = 10;
    const ROUNDS: usize = 10;
    let near = |plane: &Plane| -> Vec<(Point3<f64>, f64)> {
        let near = |p: &&Point3<f64>| plane.signed_distance(p).abs() < STANDS_OUT;
        blocks.iter().filter(near).map(|p| (*p, 1.0)).collect()
    };
    let mut heights: Vec<f64> = blocks.iter().map(|p| p.z).collect();
    heights.sort_by(f64::total_cmp);
    let at_share = |i: usize| heights.get(i * heights.len() / STARTS);
    let starts = (0..STARTS).filter_map(at_share).map(|z| level_plane(*z));
    let fits = starts.flat_map(|level| {
        let mut plane = level;
        for _ in 0..ROUNDS {
            let Some(next) = Plane::fit(&near(&plane)).filter(|p| p.normal.z > LEAST_LEVEL) else {
                break;
            };
            plane = next;
        }
        [level, plane]
    });
    let mut planes: Vec<Plane> = Vec::new();
    for plane in fits {
        if !planes.contains(&plane) {
            planes.push(plane);
        }
    }
    planes
}

/// Is a matched position within a distance of a place in plan, metres?
fn is_within(sample: &Point3<f64>, at: &Point2<f64>, distance: f64) -> bool {
    (sample.xy() - at).norm_squared() <= distance * distance
}

/// The lowest height that many share; `None` with too few samples.
fn low_height(heights: impl Iterator<Item = f64>) -> Option<f64> {
    let mut heights: Vec<f64> = heights.collect();
    if heights.len() < MIN_SAMPLES {
        return None;
    }
    heights.sort_by(f64::total_cmp);
    // From each height on, how many share it.
    let mut end = 0;
    let sharing: Vec<usize> = (heights.iter().enumerate())
        .map(|(start, low)| {
            while end < heights.len() && heights[end] <= low + ONE_HEIGHT {
                end += 1;
            }
            end - start
        })
        .collect();
    let most = *sharing.iter().max()? as f64;
    let first = (sharing.iter()).position(|n| *n as f64 >= LEAST_OF_MOST * most)?;
    // That is where the height begins to be shared: most do so a little above.
    let near = first..first + sharing[first];
    let start = near.max_by_key(|&i| (sharing[i], std::cmp::Reverse(i)))?;
    Some(heights[start + sharing[start] / 2])
}

fn sweep(scene: &Scene, ends: &[Point3<f64>], low: f64, high: f64) -> Sharded<Vec<Point3<f64>>> {
    let reduced = scene.reduced(REDUCE);
    let middle = ends[ends.len() / 2];
    let Some(view) = reduced.views.first() else {
        return Ok(Vec::new());
    };
    let step = view.camera.ground_pixel(&middle);
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
    if grid.width * grid.height > 4_000_000 {
        return Ok(Vec::new());
    }
    let levels = (((high - low) / 0.5).ceil() as usize).clamp(2, MAX_LEVELS);
    let heights: Vec<f64> = (0..levels)
        .map(|i| low + (high - low) * i as f64 / (levels - 1) as f64)
        .collect();
    let maps = sharded_map("ground", &heights, 0.0..0.1, |_, &z| {
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
            let seen = |z: &f64| views_of(scene, &Point3::new(p.x, p.y, *z)) >= LEAST_VIEWS;
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
    use crate::testing::uniform;

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
    fn wrong_matches_below_and_a_larger_roof_above_are_not_the_ground() {
        let mut even = uniform(3);
        let mut around = |z: f64, count: usize| -> Vec<f64> {
            (0..count).map(|_| z + 0.6 * (even() - 0.5)).collect()
        };
        let heights = [around(48.2, 160), around(50.0, 1000), around(56.0, 2500)].concat();
        let low = low_height(heights.into_iter()).unwrap();
        assert!((low - 50.0).abs() < 0.05, "{low}");
        let scattered = (0..1000).map(|i| 40.0 + 0.02 * f64::from(i));
        let low = low_height(scattered.chain(around(50.0, 1000))).unwrap();
        assert!((low - 50.0).abs() < 0.1, "{low}");
        assert_eq!(low_height(around(50.0, MIN_SAMPLES - 1).into_iter()), None);
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
    fn a_slope_of_fifteen_degrees_is_ground() {
        let slope = |x: f64| 50.0 + 0.268 * x;
        let roof = |x: f64, y: f64| (x - 30.0).abs() < 6.0 && (y - 30.0).abs() < 5.0;
        let z = |x: f64, y: f64| if roof(x, y) { 62.0 } else { slope(x) };
        let found = Ground::from_samples(&positions(z), 49.0);
        for (x, y) in [(10.0, 30.0), (30.0, 30.0), (52.3, 11.0)] {
            let miss = found.z_at(&Point2::new(x, y)) - slope(x);
            assert!(miss.abs() < 0.15, "{miss} m at {x}, {y}");
        }
        assert!((found.plane().normal.z - crate::math::cos(0.262)).abs() < 0.01);
    }

    #[test]
    fn ground_without_matches_has_one_height() {
        let level = Ground::level(3.0);
        assert_eq!(level.z_at(&Point2::new(7.0, -2.0)), 3.0);
        assert_eq!(Ground::from_samples(&[], 3.0), level);
        assert!(planes_through(&[]).is_empty());
    }

    #[test]
    fn the_top_lies_between_the_levels() {
        let parabola = |t: f64| 0.9 - 0.2 * (t - 0.3) * (t - 0.3);
        let beside = [Some(parabola(-1.0)), Some(parabola(1.0))];
        assert!((top_between(beside, parabola(0.0)) - 0.3).abs() < 1e-9);
        assert_eq!(top_between([None, Some(0.5)], 0.6), 0.0);
        assert_eq!(top_between([Some(0.5), Some(0.5)], 0.5), 0.0);
    }
}
