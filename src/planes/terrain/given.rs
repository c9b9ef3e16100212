//! The ground of a terrain model, compared with what the images show of it.
//!
//! Datums of heights differ by decimetres to tens of metres (ellipsoid and geoid, old and new
//! levels), so the model may be wrong by one height as a whole. What the images match is compared
//! with it: the lowest difference that many positions share is that height. It is taken out where
//! it exceeds what both accuracies explain.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::Ground;
use super::common_plane::{ONE_HEIGHT, low_height};
use crate::base::geometry::Plane;
use crate::base::math::{hypot, larger, median};
use crate::orienting::known::{KnownComparison, KnownShift, MOST_DATUM_M, Terrain};

/// Standard deviation of the ground as the images show it, metres, as in the comparison of the
/// views on it: a few decimetres.
const IMAGE_SIGMA_M: f64 = 0.3;
/// A difference of so many standard deviations is one of datums.
const SIGMAS: f64 = 3.0;
/// The ground is known this far around the lines, metres.
const MARGIN_M: f64 = 40.0;
/// Block of a terrain model's ground, metres, and most blocks. Assumption: finer relief is that of
/// ditches.
const BLOCK_M: f64 = 1.0;
const MOST_BLOCKS: f64 = 1e6;
/// Least share of the blocks whose heights are known.
const LEAST_COVERED: f64 = 0.5;
/// What stands higher than this above the ground, metres, is a roof or a tree.
const ROOF_M: f64 = 2.0;
/// A rise of this much within a block is a wall of a surface model, not relief, metres.
const WALL_M: f64 = 1.5;
/// More walls than this for each high place, and fewer roofs left than this share: a surface model.
/// Assumption: a hall of 40 m by 40 m has that many walls; matches spread by half a window around a
/// roof, over as much again where it is small.
const WALLS: f64 = 0.1;
const ROOFS_LEFT: f64 = 0.7;

impl Ground {
    /// How a terrain model compares with the images, where one is known.
    pub fn terrain(&self) -> Option<&KnownComparison> {
        self.terrain.as_ref()
    }

    /// This ground, as the images show it, with the heights of a terrain model where it has any.
    /// `samples` are the matched positions, `ends` those of lines, sorted by height.
    pub(super) fn with_terrain(
        mut self,
        terrain: &Terrain,
        samples: &[Point3<f64>],
        ends: &[Point3<f64>],
    ) -> Self {
        let offset = offset_of(terrain, samples);
        let certain = SIGMAS * hypot(terrain.accuracy_m, IMAGE_SIGMA_M);
        let shift = offset.map(|up| KnownShift {
            by: Vector3::z() * up,
            explained_m: [f64::INFINITY, certain],
        });
        let is_surface = offset.is_some_and(|up| self.is_surface(terrain, samples, up));
        // Of a scene whose heights count from anywhere any shift may be.
        let is_far_off = terrain.is_placed() && offset.is_some_and(|up| up.abs() > MOST_DATUM_M);
        let is_none = is_surface || is_far_off;
        let belongs = if is_none { 0.0 } else { 1.0 };
        let unused = KnownComparison::new(&terrain.file, terrain.accuracy_m);
        let mut comparison = unused.clone().judged(shift, belongs);
        if !is_none {
            let lift = comparison.moved_m().z;
            let known = |p: &Point2<f64>| Some(terrain.z_at(p.x, p.y)? + lift);
            match Self::laid(around(ends), BLOCK_M, known, Some(&self)) {
                Some(ground) => self = ground,
                None => comparison = unused,
            }
        }
        self.terrain = Some(comparison);
        self
    }

    /// The ground in blocks of this size at known heights of a box (x0, y0, x1, y1, metres, local
    /// frame), and elsewhere as another one or a plane has it; `None` where hardly any are known.
    pub(crate) fn laid(
        [x0, y0, x1, y1]: [f64; 4],
        block_m: f64,
        known: impl Fn(&Point2<f64>) -> Option<f64>,
        otherwise: Option<&Self>,
    ) -> Option<Self> {
        let block_m = larger(block_m, ((x1 - x0) * (y1 - y0) / MOST_BLOCKS).sqrt());
        let mut ground = Self {
            min: Point2::new(x0, y0),
            block_m,
            columns: ((x1 - x0) / block_m) as usize + 1,
            rows: ((y1 - y0) / block_m) as usize + 1,
            ..Self::level(0.0)
        };
        let blocks = ground.columns * ground.rows;
        let heights: Vec<Option<f64>> = (0..blocks).map(|k| known(&ground.middle(k))).collect();
        let lying = |(k, z): (usize, &Option<f64>)| {
            let at = ground.middle(k);
            z.map(|z| (Point3::new(at.x, at.y, z), 1.0))
        };
        let lying: Vec<(Point3<f64>, f64)> = heights.iter().enumerate().filter_map(lying).collect();
        if (lying.len() as f64) < LEAST_COVERED * blocks as f64 {
            return None;
        }
        let plane = Plane::fit(&lying).map(Plane::upwards);
        ground.plane =
            (plane.filter(|p| p.normal.z > 0.5)).or(otherwise.map(|other| other.plane))?;
        ground.rises = (heights.iter().enumerate())
            .map(|(k, z)| {
                let at = ground.middle(k);
                let plane = ground.plane.z_at(at.x, at.y);
                z.unwrap_or_else(|| otherwise.map_or(plane, |other| other.z_at(&at))) - plane
            })
            .collect();
        Some(ground)
    }

    /// Does a model follow the roofs? Then what stands above the ground in the images does not
    /// stand above it, and what is high in it has walls around.
    fn is_surface(&self, terrain: &Terrain, samples: &[Point3<f64>], offset: f64) -> bool {
        let known = |p: Point2<f64>| Some(terrain.z_at(p.x, p.y)? + offset);
        let above_images = |s: &&Point3<f64>| s.z - self.z_at(&s.xy()) > ROOF_M;
        let above_model = |s: &&Point3<f64>| known(s.xy()).is_some_and(|z| s.z - z > ROOF_M);
        let [roofs, left] = [
            samples.iter().filter(above_images).count(),
            samples.iter().filter(above_model).count(),
        ];
        // Near walls nothing is matched, so these are sought everywhere.
        let [columns, rows] =
            [self.columns, self.rows].map(|n| (n as f64 * self.block_m / BLOCK_M) as usize);
        let places = (0..columns * rows).map(|k| {
            let (c, r) = ((k % columns) as f64, (k / columns) as f64);
            self.min + Vector2::new(c, r) * BLOCK_M
        });
        let (mut high, mut walls) = (0.0, 0.0);
        for place in places {
            let Some(z) = known(place) else {
                continue;
            };
            let beside = [Vector2::x(), Vector2::y()].map(|step| known(place + step * BLOCK_M));
            if beside.iter().flatten().any(|b| (b - z).abs() > WALL_M) {
                walls += 1.0;
            }
            if z - self.z_at(&place) > ROOF_M {
                high += 1.0;
            }
        }
        walls > WALLS * high && walls > 0.0 && (left as f64) < ROOFS_LEFT * roofs as f64
    }
}

/// The box in which the ground is known around lines, of the sorted ends of these, metres.
fn around(ends: &[Point3<f64>]) -> [f64; 4] {
    let range = |axis: usize| {
        let mut all: Vec<f64> = ends.iter().map(|p| p[axis]).collect();
        all.sort_by(f64::total_cmp);
        // A few wrong lines may lie far off.
        let share = |f: f64| all[(f * (all.len() - 1) as f64) as usize];
        [share(0.01) - MARGIN_M, share(0.99) + MARGIN_M]
    };
    let ([x0, x1], [y0, y1]) = (range(0), range(1));
    [x0, y0, x1, y1]
}

/// How far the ground that the images show lies above the model, metres.
fn offset_of(terrain: &Terrain, samples: &[Point3<f64>]) -> Option<f64> {
    let above = |s: &Point3<f64>| Some(s.z - terrain.z_at(s.x, s.y)?);
    let above: Vec<f64> = samples.iter().filter_map(above).collect();
    let low = low_height(above.iter().copied())?;
    // Positions on the ground lie around it.
    let mut near: Vec<f64> = (above.into_iter())
        .filter(|rise| (rise - low).abs() < 0.5 * ONE_HEIGHT)
        .collect();
    median(&mut near)
}
