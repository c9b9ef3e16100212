//! Planes that the ground may lie in as a whole.
//!
//! Around each place the ground is the lowest height that many positions share: roofs and trees
//! only rise above it, and wrong matches share none. On a slope heights are shared above the slope,
//! not above the sea; so it is done twice, above no slope and above the one over which most
//! positions share one height.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use crate::base::geometry::Plane;

/// Blocks further than this from a plane do not lie in it, metres: lower than any eave.
pub(super) const STANDS_OUT: f64 = 1.0;
/// Fewer matched positions determine no height.
pub(super) const MIN_SAMPLES: usize = 30;
/// Ground as a whole slopes less than this (normal's z of 18 degrees). Assumption: a steeper fit
/// follows a roof.
const LEAST_LEVEL: f64 = 0.95;
/// Within this distance of a block ground is matched, metres: more than half the width of a
/// building.
const RADIUS: f64 = 18.0;
/// Positions within this height share it, metres: as rough as ground is.
pub(super) const ONE_HEIGHT: f64 = 1.0;
/// The ground has at least this share of the positions of the height that most share, which may be
/// a roof's. Assumption: wrong matches on real photographs have up to a sixth.
const LEAST_OF_MOST: f64 = 0.25;

/// The steepest slope that is tried, metres a metre (17 degrees), and the steps in which it is
/// sought. Assumption: the steepest that is built on with gardens around.
const STEEPEST: f64 = 0.3;
const SLOPE_STEPS: i32 = 6;
/// So many positions show the slope.
const SLOPE_SAMPLES: usize = 4000;

/// Is a matched position within a distance of a place in plan, metres?
pub(super) fn is_within(sample: &Point3<f64>, at: &Point2<f64>, distance: f64) -> bool {
    (sample.xy() - at).norm_squared() <= distance * distance
}

/// Planes through what is lowest around these places.
pub(super) fn proposals(samples: &[Point3<f64>], places: &[Point2<f64>]) -> Vec<Plane> {
    let mut planes = Vec::new();
    let slope = most_shared_slope(samples);
    for slope in [Vector2::zeros(), slope] {
        for plane in planes_through(&lowest(samples, places, slope)) {
            let plane = sloped(&plane, slope);
            if !planes.contains(&plane) {
                planes.push(plane);
            }
        }
    }
    planes
}

/// The places with the lowest height above a slope that many positions around them share.
fn lowest(
    samples: &[Point3<f64>],
    places: &[Point2<f64>],
    slope: Vector2<f64>,
) -> Vec<Point3<f64>> {
    let lowest = crate::base::execution::map(places, |_, at| {
        let near = samples.iter().filter(|s| is_within(s, at, RADIUS));
        let rise = low_height(near.map(|s| s.z - slope.dot(&s.coords.xy())))?;
        Some(Point3::new(at.x, at.y, rise))
    });
    lowest.into_iter().flatten().collect()
}

/// The slope, metres a metre east and north, above which most positions share one height.
fn most_shared_slope(samples: &[Point3<f64>]) -> Vector2<f64> {
    let every = samples.len() / SLOPE_SAMPLES + 1;
    let some: Vec<Point3<f64>> = samples.iter().copied().step_by(every).collect();
    let along = |step: i32| STEEPEST * f64::from(step) / f64::from(SLOPE_STEPS);
    let steps = -SLOPE_STEPS..=SLOPE_STEPS;
    let slopes = (steps.clone())
        .flat_map(|y| steps.clone().map(move |x| Vector2::new(along(x), along(y))))
        .filter(|slope| slope.norm() <= STEEPEST);
    let shared = |slope: &Vector2<f64>| {
        let rises = some.iter().map(|s| s.z - slope.dot(&s.coords.xy()));
        let mut rises: Vec<f64> = rises.collect();
        rises.sort_by(f64::total_cmp);
        sharing(&rises).into_iter().max().unwrap_or(0)
    };
    let level = Vector2::zeros();
    let best = slopes.map(|slope| (shared(&slope), slope));
    // Of equal ones the first.
    let best = best.reduce(|a, b| if b.0 > a.0 { b } else { a });
    best.map_or(level, |(_, slope)| slope)
}

/// A plane, steeper by a slope.
fn sloped(plane: &Plane, slope: Vector2<f64>) -> Plane {
    if slope == Vector2::zeros() {
        return *plane;
    }
    let n = plane.normal / plane.normal.z;
    let normal = Vector3::new(n.x - slope.x, n.y - slope.y, 1.0);
    let at_zero = Point3::new(0.0, 0.0, plane.z_at(0.0, 0.0));
    Plane::from_point_normal(&at_zero, &normal).expect("it is not upright")
}

/// Fits to places from several heights, and the level planes at these.
fn planes_through(blocks: &[Point3<f64>]) -> Vec<Plane> {
    // Assumption: a start at every tenth of the heights is near every plane, and ten fits lead
    // there.
    const STARTS: usize = 10;
    const ROUNDS: usize = 10;
    let near = |plane: &Plane| -> Vec<(Point3<f64>, f64)> {
        let near = |p: &&Point3<f64>| plane.signed_distance(p).abs() < STANDS_OUT;
        blocks.iter().filter(near).map(|p| (*p, 1.0)).collect()
    };
    let mut heights: Vec<f64> = blocks.iter().map(|p| p.z).collect();
    heights.sort_by(f64::total_cmp);
    let at_share = |i: usize| heights.get(i * heights.len() / STARTS);
    let starts = (0..STARTS).filter_map(at_share).map(|z| Plane::level(*z));
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

/// The lowest height that many share; `None` with too few samples.
pub(super) fn low_height(heights: impl Iterator<Item = f64>) -> Option<f64> {
    let mut heights: Vec<f64> = heights.collect();
    if heights.len() < MIN_SAMPLES {
        return None;
    }
    heights.sort_by(f64::total_cmp);
    let sharing = sharing(&heights);
    let most = *sharing.iter().max()? as f64;
    let first = (sharing.iter()).position(|n| *n as f64 >= LEAST_OF_MOST * most)?;
    // That is where the height begins to be shared: most do so a little above.
    let near = first..first + sharing[first];
    let start = near.max_by_key(|&i| (sharing[i], std::cmp::Reverse(i)))?;
    Some(heights[start + sharing[start] / 2])
}

/// From each of the heights on, which rise, how many share it.
fn sharing(heights: &[f64]) -> Vec<usize> {
    let mut end = 0;
    let count = |(start, low): (usize, &f64)| {
        while end < heights.len() && heights[end] <= low + ONE_HEIGHT {
            end += 1;
        }
        end - start
    };
    heights.iter().enumerate().map(count).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing::uniform;

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
    fn the_slope_above_which_most_share_a_height_is_found() {
        let samples: Vec<Point3<f64>> = (0..2500)
            .map(|i| (f64::from(i % 50), f64::from(i / 50)))
            .map(|(x, y)| Point3::new(x, y, 50.0 + 0.2 * x - 0.1 * y))
            .collect();
        let slope = most_shared_slope(&samples);
        assert!((slope - Vector2::new(0.2, -0.1)).norm() < 1e-9, "{slope}");
        let steep = sloped(&Plane::level(50.0), slope);
        assert!((steep.z_at(10.0, 20.0) - 50.0).abs() < 1e-9);
    }
}
