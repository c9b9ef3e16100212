//! Height of the ground: from the images by a sweep of horizontal planes, and from a terrain model
//! where one is known (`given`).
//!
//! Every view, reduced four times, is compared with the others on horizontal planes at steps of
//! height (the measure that verifies facets, `photoconsistency`). Each position takes the
//! height at which the views agree best; the ground near a building is the lowest height that many
//! positions around it share, since roofs and trees only rise above it and wrong matches share
//! none. What is matched at about the height of the plane through those then settles the height.
//!
//! Invariant: the ground has a height at every plan position, also outside of what was swept.

mod given;

pub use given::{TerrainComparison, TerrainVerdict};

use nalgebra::{Point2, Point3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::execution::{Sharded, sharded_map};
use crate::geometry::{Plane, Segment3};
use crate::lines3d::Line3d;
use crate::math::{larger, smaller};
use crate::model::Facet;
use crate::photoconsistency::{PlanGrid, consistency_map};
use crate::scene::Scene;

/// Ground heights, metres, local frame, on a coarse grid over the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ground {
    min: Point2<f64>,
    /// Side of a block, metres.
    block_m: f64,
    columns: usize,
    rows: usize,
    /// How far each block lies above the plane, row by row; empty where all of it is the plane.
    rises: Vec<f64>,
    /// The plane that the ground lies in as a whole.
    plane: Plane,
    /// How a terrain model that is known compares with the images.
    terrain: Option<TerrainComparison>,
}

/// Blocks higher than this above the common plane show no ground, metres: lower than any eave.
/// Assumption: the ground of one scene is nearly plane.
const STANDS_OUT: f64 = 1.0;
/// Ground as a whole slopes less than this against the common slope (normal's z of 8 degrees).
/// Assumption: a steeper fit follows a roof.
const LEAST_LEVEL: f64 = 0.99;
/// Cell of the ground grid, metres.
const CELL: f64 = 5.0;
/// Matched positions within this distance determine the ground height of a cell, metres: more than
/// half the width of a building.
const RADIUS: f64 = 18.0;
/// The steepest common slope, metres a metre (17 degrees), and the steps in which it is sought.
/// Assumption: the steepest that is built on with gardens around.
const STEEPEST: f64 = 0.3;
const SLOPE_STEPS: i32 = 6;
/// Above a common slope so many times as many positions share a height as above the sea.
/// Assumption: a slope of less than 8 degrees needs no other treatment than level ground.
const SHARED_ON_SLOPE: f64 = 2.0;
/// Below a slope that is the ground lie fewer positions than this share. Assumption: wrong matches
/// have up to a sixth; below a roof lies the ground.
const MOST_BELOW: f64 = 0.15;
/// So many positions show the slope.
const SLOPE_SAMPLES: usize = 4000;
/// Images are reduced by this factor for the sweep.
const REDUCE: usize = 4;
/// Most planes in the sweep.
const MAX_LEVELS: usize = 64;
/// A position counts as matched from this correlation and texture weight on.
const MIN_CORRELATION: f32 = 0.7;
const MIN_WEIGHT: f32 = 0.5;
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
            block_m: CELL,
            columns: 0,
            rows: 0,
            rises: Vec::new(),
            plane: level_plane(z),
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
        let samples = sweep(scene, &ends, low, high)?;
        let elsewhere = low_height(samples.iter().map(|s| s.z)).unwrap_or_else(|| share(0.1));
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
            ((max.x - min.x) / CELL) as usize + 1,
            ((max.y - min.y) / CELL) as usize + 1,
        );
        let mut ground = Self {
            min,
            block_m: CELL,
            columns,
            rows,
            rises: vec![0.0; columns * rows],
            plane: level_plane(elsewhere),
            terrain: None,
        };
        // On a slope heights are shared above it, not above the sea.
        let slope = common_slope(samples);
        let trend = move |x: f64, y: f64| slope.x * x + slope.y * y;
        if let Some(rest) = common_plane(&ground.lowest_blocks(samples, trend)) {
            ground.plane = sloped(&rest, slope);
        }
        ground.settle(samples);
        ground
    }

    /// The middle of every block with the lowest height above a slope that many positions around it
    /// share.
    fn lowest_blocks(
        &self,
        samples: &[Point3<f64>],
        slope: impl Fn(f64, f64) -> f64 + Sync,
    ) -> Vec<Point3<f64>> {
        let blocks: Vec<usize> = (0..self.rises.len()).collect();
        let lowest = crate::execution::map(&blocks, |_, &k| {
            let at = self.middle(k);
            let near = samples.iter().filter(|s| is_near(s, &at));
            let rise = low_height(near.map(|s| s.z - slope(s.x, s.y)))?;
            Some(Point3::new(at.x, at.y, rise))
        });
        lowest.into_iter().flatten().collect()
    }

    /// The plane that the ground lies in as a whole.
    pub fn plane(&self) -> Plane {
        self.plane
    }

    /// How far the ground lies above that plane, least and most, metres.
    pub fn rises(&self) -> [f64; 2] {
        (self.rises.iter()).fold([0.0, 0.0], |[low, high], &rise| {
            [smaller(rise, low), larger(rise, high)]
        })
    }

    /// Middle of a block in plan.
    fn middle(&self, k: usize) -> Point2<f64> {
        let (c, r) = ((k % self.columns) as f64, (k / self.columns) as f64);
        self.min + Vector2::new(c + 0.5, r + 0.5) * self.block_m
    }

    /// Lays every block in the common plane, and then to the middle of what is matched around it at
    /// about that height.
    fn settle(&mut self, samples: &[Point3<f64>]) {
        let plane = self.plane;
        let rise = |p: &Point3<f64>| p.z - plane.z_at(p.x, p.y);
        let level: Vec<&Point3<f64>> = (samples.iter())
            .filter(|p| rise(p).abs() < STANDS_OUT)
            .collect();
        let blocks: Vec<usize> = (0..self.rises.len()).collect();
        self.rises = crate::execution::map(&blocks, |_, &k| {
            let at = self.middle(k);
            let near = level.iter().filter(|p| is_near(p, &at));
            let mut rises: Vec<f64> = near.map(|p| rise(p)).collect();
            let enough = rises.len() >= MIN_SAMPLES;
            let middle = crate::math::median(&mut rises).filter(|_| enough);
            middle.unwrap_or(0.0)
        });
    }

    /// Ground height at a plan position, metres.
    pub fn z_at(&self, p: &Point2<f64>) -> f64 {
        let [c, r] = [p.x - self.min.x, p.y - self.min.y].map(|along| along / self.block_m);
        let on_plane = self.plane.z_at(p.x, p.y);
        if c < 0.0 || r < 0.0 || c >= self.columns as f64 || r >= self.rows as f64 {
            return on_plane;
        }
        on_plane + self.rises[r as usize * self.columns + c as usize]
    }

    /// Ground height below a building, metres: the middle one of those at its corners, the lowest
    /// on a slope, so that all walls end in the ground.
    pub fn below(&self, members: &[&Facet]) -> f64 {
        let corners = members.iter().flat_map(|f| &f.outer);
        let mut heights: Vec<f64> = corners.map(|p| self.z_at(&p.xy())).collect();
        let lowest = heights.iter().copied().fold(f64::INFINITY, smaller);
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, larger);
        if highest - lowest > STANDS_OUT {
            return lowest;
        }
        crate::math::median(&mut heights).unwrap_or(f64::NAN)
    }
}

fn level_plane(z: f64) -> Plane {
    Plane {
        normal: Vector3::z(),
        d: -z,
    }
}

/// A plane, steeper by a slope.
fn sloped(plane: &Plane, slope: Vector2<f64>) -> Plane {
    let n = plane.normal / plane.normal.z;
    let normal = Vector3::new(n.x - slope.x, n.y - slope.y, 1.0);
    let at_zero = Point3::new(0.0, 0.0, plane.z_at(0.0, 0.0));
    Plane::from_point_normal(&at_zero, &normal).expect("it is not upright")
}

/// The slope of the ground as a whole, metres a metre east and north, above which many more
/// positions share one height than above level ground, and below which hardly any lie; none where
/// there is no such.
fn common_slope(samples: &[Point3<f64>]) -> Vector2<f64> {
    let every = samples.len() / SLOPE_SAMPLES + 1;
    let some: Vec<Point3<f64>> = samples.iter().copied().step_by(every).collect();
    let steps = -SLOPE_STEPS..=SLOPE_STEPS;
    let slope = |step: i32| STEEPEST * f64::from(step) / f64::from(SLOPE_STEPS);
    let slopes: Vec<Vector2<f64>> = (steps.clone())
        .flat_map(|y| steps.clone().map(move |x| Vector2::new(slope(x), slope(y))))
        .filter(|slope| slope.norm() <= STEEPEST)
        .collect();
    // How many share one height, and how many lie below it.
    let shared = |slope: &Vector2<f64>| -> [usize; 2] {
        let mut rises: Vec<f64> = some
            .iter()
            .map(|s| s.z - slope.dot(&s.coords.xy()))
            .collect();
        rises.sort_by(f64::total_cmp);
        let mut end = 0;
        let mut most = [0, 0];
        for (start, low) in rises.iter().enumerate() {
            while end < rises.len() && rises[end] <= low + ONE_HEIGHT {
                end += 1;
            }
            if end - start > most[0] {
                most = [end - start, start];
            }
        }
        most
    };
    let found = crate::execution::map(&slopes, |_, slope| shared(slope));
    let level = shared(&Vector2::zeros())[0] as f64;
    let is_ground = |[count, below]: [usize; 2]| {
        count as f64 > SHARED_ON_SLOPE * level && (below as f64) < MOST_BELOW * some.len() as f64
    };
    let grounds = (0..slopes.len()).filter(|&i| is_ground(found[i]));
    let best = grounds.max_by_key(|&i| (found[i][0], std::cmp::Reverse(i)));
    best.map_or_else(Vector2::zeros, |i| slopes[i])
}

/// The plane that most of the blocks lie in, or the lowest of those that at least half as many do:
/// a town may have more flat roofs of one height than ground. `None` without blocks.
fn common_plane(blocks: &[Point3<f64>]) -> Option<Plane> {
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
    let found: Vec<(Plane, usize)> = starts
        .map(|mut plane| {
            for _ in 0..ROUNDS {
                let Some(next) = Plane::fit(&near(&plane)).filter(|p| p.normal.z > LEAST_LEVEL)
                else {
                    break;
                };
                plane = next;
            }
            (plane, near(&plane).len())
        })
        .collect();
    let most = found.iter().map(|(_, n)| *n).max()?;
    let middle = blocks.iter().map(|p| p.coords.xy()).sum::<Vector2<f64>>() / blocks.len() as f64;
    let common = found.iter().filter(|(_, n)| 2 * n >= most);
    common.map(|(plane, _)| *plane).min_by(|a, b| {
        a.z_at(middle.x, middle.y)
            .total_cmp(&b.z_at(middle.x, middle.y))
    })
}

/// Is a matched position near enough to determine the ground height here?
fn is_near(sample: &Point3<f64>, at: &Point2<f64>) -> bool {
    (sample.xy() - at).norm_squared() <= RADIUS * RADIUS
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
            if let Some(i) = best {
                let p = grid.center(column, row);
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
            // Heights are those of blocks of 5 m.
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

    #[test]
    fn a_large_sloping_roof_over_level_ground_is_no_slope() {
        let positions = (0..120).flat_map(|c| (0..120).map(move |r| (c, r)));
        let samples: Vec<Point3<f64>> = positions
            .map(|(c, r)| (0.5 * f64::from(c), 0.5 * f64::from(r)))
            .map(|(x, y)| {
                Point3::new(
                    x,
                    y,
                    if x > 12.0 {
                        55.0 + 0.2 * (x - 12.0)
                    } else {
                        50.0
                    },
                )
            })
            .collect();
        assert_eq!(common_slope(&samples), Vector2::zeros());
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

    #[test]
    fn of_two_planes_the_lower_is_the_ground_unless_hardly_anything_lies_in_it() {
        let plane = |z: f64, count: i32| {
            (0..count).map(move |i| {
                let (x, y) = (5.0 * f64::from(i % 10), 5.0 * f64::from(i / 10));
                Point3::new(x, y, z + 0.03 * x)
            })
        };
        let at_origin = |blocks: Vec<Point3<f64>>| common_plane(&blocks).unwrap().z_at(0.0, 0.0);
        let found = at_origin(plane(50.0, 60).chain(plane(56.0, 100)).collect());
        assert!((found - 50.0).abs() < 0.01, "{found}");
        let found = at_origin(plane(48.0, 12).chain(plane(50.0, 60)).collect());
        assert!((found - 50.0).abs() < 0.01, "{found}");
        assert!(common_plane(&[]).is_none());
    }

    #[test]
    fn ground_may_rise_above_its_plane() {
        let mound = |x: f64| if x > 40.0 { 0.7 } else { 0.0 };
        let positions = (0..120).flat_map(|c| (0..120).map(move |r| (c, r)));
        let samples: Vec<Point3<f64>> = positions
            .map(|(c, r)| (0.5 * f64::from(c), 0.5 * f64::from(r)))
            .map(|(x, y)| Point3::new(x, y, ground(x, y) + mound(x)))
            .collect();
        let found = Ground::from_samples(&samples, 49.0);
        for (x, y) in [(10.0, 30.0), (57.0, 30.0)] {
            let miss = found.z_at(&Point2::new(x, y)) - ground(x, y) - mound(x);
            assert!(miss.abs() < 0.15, "{miss} m at {x}, {y}");
        }
        let [low, high] = found.rises();
        assert!(high - low > 0.2 && high - low < 0.8, "{low} to {high}");
        assert_eq!(Ground::level(3.0).rises(), [0.0, 0.0]);
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
