//! The ground of a terrain model, compared with what the images show of it.
//!
//! Datums of heights differ by decimetres to tens of metres (ellipsoid and geoid, old and new
//! levels), so the model may be wrong by one height as a whole. What the images match is compared
//! with it: the lowest difference that many positions share is that height, told where the model is
//! of one piece, not in a house that is left in it. It is taken out where it exceeds what both
//! accuracies explain.
//!
//! Then it is asked place by place. Where it differs around roofs by more than the accuracies
//! explain, one of the two grounds steps at the rim of the patch in which they differ and the other
//! passes: that of the images steps up onto crowns and wide roofs, the model where a hole was
//! filled badly or a house is left in it. The one that steps is wrong there. A bank or a terrace
//! under which the images pass is none of that: most of what they match lies on it, and no walls
//! are around.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::common_plane::{MIN_SAMPLES, ONE_HEIGHT, low_height};
use super::{Ground, surface};
use crate::base::geometry::Plane;
use crate::base::math::{hypot, larger, median, smaller};
use crate::orienting::known::{KnownComparison, KnownShift, Terrain};
use crate::orienting::orientation::MOST_DATUM_M;

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
pub(crate) const ROOF_M: f64 = 2.0;
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
        let offset = self.offset_of(terrain, samples);
        let certain = explained_m(terrain);
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
            comparison.contradicted_at = self.contradicting(samples, certain, known);
            let counted = |p: &Point2<f64>| {
                let z = known(p)?;
                let own = self.z_at(p);
                let is_wrong = (own - z).abs() > certain && is_contradicted(&comparison, p);
                Some(if is_wrong { own } else { z })
            };
            match Self::laid(around(ends), BLOCK_M, counted, Some(&self)) {
                Some(ground) => self = ground,
                None => comparison = unused,
            }
        }
        self.terrain = Some(comparison);
        self
    }

    /// How far the ground that the images show lies above the model, metres.
    fn offset_of(&self, terrain: &Terrain, samples: &[Point3<f64>]) -> Option<f64> {
        let is_in_piece = self.largest_piece(terrain);
        let above = |s: &Point3<f64>| Some(s.z - terrain.z_at(s.x, s.y)?);
        let told = samples.iter().filter(|s| is_in_piece(s));
        let above: Vec<f64> = told.filter_map(above).collect();
        let low = low_height(above.iter().copied())?;
        // Positions on the ground lie around it.
        let mut near: Vec<f64> = (above.into_iter())
            .filter(|rise| (rise - low).abs() < 0.5 * ONE_HEIGHT)
            .collect();
        median(&mut near)
    }

    /// Does a model have most of this ground's extent in one piece with a place, without a wall
    /// between?
    fn largest_piece(&self, terrain: &Terrain) -> impl Fn(&Point3<f64>) -> bool {
        let [width, height] = [self.columns, self.rows].map(|n| n as f64 * self.block_m);
        let extent = [
            self.min.x,
            self.min.y,
            self.min.x + width,
            self.min.y + height,
        ];
        let known = |p: &Point2<f64>| terrain.z_at(p.x, p.y);
        let model = Self::laid(extent, BLOCK_M, known, Some(self));
        let largest = model.as_ref().map(|model| {
            let rises = &model.rises;
            let goes_on = |k: usize, l: usize| (rises[k] - rises[l]).abs() < WALL_M;
            let pieces = patches(&model.beside(), |_| true, goes_on);
            let largest = pieces.into_iter().max_by_key(Vec::len).unwrap_or_default();
            let mut is_in = vec![false; rises.len()];
            largest.into_iter().for_each(|k| is_in[k] = true);
            is_in
        });
        move |p| {
            (model.as_ref().zip(largest.as_ref())).is_none_or(|(m, is_in)| is_in[m.block_of(p)])
        }
    }

    /// The neighbours of each block.
    fn beside(&self) -> Vec<Vec<usize>> {
        let mut beside = vec![Vec::new(); self.rises.len()];
        for [k, l] in surface::neighbours(self.columns, self.rises.len()) {
            beside[k].push(l);
            beside[l].push(k);
        }
        beside
    }

    /// From the terrain model to this ground at places of a building, metres up, where the images
    /// contradict the model there; of several the largest.
    pub fn above_terrain(
        &self,
        terrain: &Terrain,
        places: impl Iterator<Item = Point2<f64>>,
    ) -> Option<f64> {
        let comparison = self.terrain.as_ref()?;
        let lift = comparison.moved_m().z;
        places
            .filter(|p| is_contradicted(comparison, p))
            .filter_map(|p| Some(self.z_at(&p) - terrain.z_at(p.x, p.y)? - lift))
            .filter(|up| up.abs() > explained_m(terrain))
            .reduce(|most, up| if up.abs() > most.abs() { up } else { most })
    }

    /// Middles of the blocks of this ground, that of the images, in patches around roofs where it
    /// contradicts known heights.
    fn contradicting(
        &self,
        samples: &[Point3<f64>],
        certain: f64,
        known: impl Fn(&Point2<f64>) -> Option<f64>,
    ) -> Vec<[f64; 2]> {
        let count = self.rises.len();
        // From the model, as far as none of the heights that it has in a block is that of the
        // images.
        let above_model = |k: usize| {
            let part = |i: usize| Vector2::new((i % 3) as f64 - 1.0, (i / 3) as f64 - 1.0);
            let parts = (0..9).map(|i| self.middle(k) + part(i) * (self.block_m / 3.0));
            let rise = |at: Point2<f64>| Some(known(&at)? - self.plane.z_at(at.x, at.y));
            let rises: Vec<f64> = parts.filter_map(rise).collect();
            let low = rises.iter().copied().reduce(smaller)?;
            let high = rises.iter().copied().reduce(larger)?;
            Some(self.rises[k] - self.rises[k].clamp(low, high))
        };
        let up: Vec<f64> = (0..count).map(|k| above_model(k).unwrap_or(0.0)).collect();
        let is_one_patch = |k: usize, l: usize| up[l].abs() > certain && up[k] * up[l] > 0.0;
        if !up.iter().any(|up| up.abs() > certain) {
            return Vec::new();
        }
        let matched = self.matched_in_blocks(samples, |p| {
            known(&p.xy()).is_some_and(|z| (p.z - z).abs() < certain)
        });
        // From the middle of a block to the far side of the next one, which may be partly wrong.
        let is_wall_between = |k: usize, l: usize| {
            let (from, to) = (self.middle(k), self.middle(l));
            let step = (to - from) * (BLOCK_M / self.block_m);
            let on_way = |i: usize| known(&(from + step * i as f64));
            let steps = 1..=(1.5 * self.block_m / BLOCK_M) as usize;
            let mut rises = steps.filter_map(|i| Some(on_way(i)? - on_way(i - 1)?));
            rises.any(|rise| rise.abs() > WALL_M)
        };
        let beside = self.beside();
        let mut found = Vec::new();
        for patch in patches(&beside, |k| up[k].abs() > certain, is_one_patch) {
            // At the rim: its sides, those where the model has a wall, and how much more the model
            // steps than the images do.
            let (mut rim, mut walls, mut steps) = (0, 0, 0.0);
            for &k in &patch {
                rim += 4 - beside[k].len();
                for &l in beside[k].iter().filter(|l| !is_one_patch(k, **l)) {
                    rim += 1;
                    walls += usize::from(is_wall_between(k, l));
                    let of_images = self.rises[k] - self.rises[l];
                    steps += up[k].signum() * (up[k] - up[l] - 2.0 * of_images);
                }
            }
            let sum = |what: usize| patch.iter().map(|&k| matched[k][what]).sum::<usize>();
            let [all, roofs, on_model] = [0, 1, 2].map(sum);
            let is_walled = 2 * walls > rim;
            let is_rough = steps > 0.0 && 2 * on_model < all;
            if roofs >= MIN_SAMPLES && (is_walled || is_rough) {
                found.extend(patch.iter().map(|k| <[f64; 2]>::from(self.middle(*k))));
            }
        }
        found
    }

    /// Of the positions in each block: how many there are, and lie on roofs and on the model.
    fn matched_in_blocks(
        &self,
        samples: &[Point3<f64>],
        is_on_model: impl Fn(&Point3<f64>) -> bool,
    ) -> Vec<[usize; 3]> {
        let mut matched = vec![[0; 3]; self.rises.len()];
        for p in samples {
            let k = self.block_of(p);
            let is_roof = self.above_plane(p) > self.rises[k] + ROOF_M;
            for (n, is_so) in matched[k].iter_mut().zip([true, is_roof, is_on_model(p)]) {
                *n += usize::from(is_so);
            }
        }
        matched
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

/// The patches of blocks that start somewhere and go on from one neighbour to the next.
fn patches(
    beside: &[Vec<usize>],
    starts: impl Fn(usize) -> bool,
    goes_on: impl Fn(usize, usize) -> bool,
) -> Vec<Vec<usize>> {
    let (mut is_taken, mut all) = (vec![false; beside.len()], Vec::new());
    for first in 0..beside.len() {
        if is_taken[first] || !starts(first) {
            continue;
        }
        is_taken[first] = true;
        let (mut patch, mut next) = (vec![first], 0);
        while let Some(&k) = patch.get(next) {
            next += 1;
            for &l in &beside[k] {
                if !is_taken[l] && goes_on(k, l) {
                    is_taken[l] = true;
                    patch.push(l);
                }
            }
        }
        all.push(patch);
    }
    all
}

/// Largest difference between a terrain model and the ground of the images that both accuracies
/// explain, metres.
fn explained_m(terrain: &Terrain) -> f64 {
    SIGMAS * hypot(terrain.accuracy_m, IMAGE_SIGMA_M)
}

/// Does a place lie in a block where the images contradict a model, or beside one?
fn is_contradicted(comparison: &KnownComparison, at: &Point2<f64>) -> bool {
    let is_near = |middle: &[f64; 2]| (Point2::from(*middle) - at).amax() < 1.5 * Ground::BLOCK_M;
    comparison.contradicted_at.iter().any(is_near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::known::{KnownVerdict, WorldSystem};
    use crate::orienting::orientation::InputFile;

    /// Heights on 100 m by 100 m as an ASCII grid.
    fn terrain(z: impl Fn(f64, f64) -> f64) -> Terrain {
        let mut text = "ncols 100\nnrows 100\nxllcorner 0\nyllcorner 0\ncellsize 1\n".to_owned();
        for (row, column) in (0..100).flat_map(|r| (0..100).map(move |c| (r, c))) {
            let (x, y) = (f64::from(column) + 0.5, 99.5 - f64::from(row));
            text += &format!("{:.3} ", z(x, y));
        }
        let file = InputFile::new("dtm.asc", text.into_bytes());
        let system = WorldSystem::default();
        Terrain::read(&file, None, &system, Vector3::zeros(), 0.3).unwrap()
    }

    /// Matched positions on 60 m by 60 m around the middle of that.
    fn samples(z: impl Fn(f64, f64) -> f64) -> Vec<Point3<f64>> {
        let at = |i: i32| 20.0 + 0.75 * f64::from(i);
        let all = (0..80).flat_map(|c| (0..80).map(move |r| (at(c), at(r))));
        all.map(|(x, y)| Point3::new(x, y, z(x, y))).collect()
    }

    /// A slope with a bank on its east, 1.8 m high, beside the eastern one of two houses.
    fn ground(x: f64, y: f64) -> f64 {
        50.0 + 0.05 * x - 0.02 * y + 0.45 * (x - 67.0).clamp(0.0, 4.0)
    }

    const HOUSES: [[f64; 2]; 2] = [[36.0, 40.0], [60.0, 60.0]];

    fn in_house([mx, my]: [f64; 2], x: f64, y: f64, margin: f64) -> bool {
        (x - mx).abs() < 5.0 + margin && (y - my).abs() < 6.0 + margin
    }

    /// Houses 6 m high, and a wood of 9 m in the north-west.
    fn surface(x: f64, y: f64) -> f64 {
        let house = HOUSES.iter().find(|house| in_house(**house, x, y, 0.0));
        match house {
            Some([mx, my]) => ground(*mx, *my) + 6.0,
            None if x < 40.0 && y > 58.0 => ground(x, y) + 9.0,
            None => ground(x, y),
        }
    }

    /// How far the ground below each house lies above a terrain, where that is contradicted.
    fn contradicted(found: &Ground, terrain: &Terrain) -> [Option<f64>; 2] {
        HOUSES.map(|[x, y]| {
            let places = [
                (-1.0, -1.0),
                (1.0, -1.0),
                (1.0, 1.0),
                (-1.0, 1.0),
                (0.0, 0.0),
            ];
            let places = places.map(|(i, j)| Point2::new(x + 5.0 * i, y + 6.0 * j));
            found.above_terrain(terrain, places.into_iter())
        })
    }

    #[test]
    fn a_house_that_is_left_in_a_terrain_is_no_other_datum() {
        // Of the ground the images show little besides what lies around the house.
        let near = |p: &Point3<f64>| in_house(HOUSES[0], p.x, p.y, 6.0);
        let matched: Vec<Point3<f64>> = samples(surface).into_iter().filter(near).collect();
        let mut ends = matched.clone();
        ends.sort_by(|a, b| a.z.total_cmp(&b.z));
        let images = Ground::from_samples(&matched, 50.0);
        for datum in [0.0, 4.0] {
            let terrain = terrain(|x, y| {
                let is_left_in = in_house(HOUSES[0], x, y, 2.0);
                ground(x, y) - datum + if is_left_in { 7.0 } else { 0.0 }
            });
            let found = images.clone().with_terrain(&terrain, &matched, &ends);
            let comparison = found.terrain().unwrap();
            let [.., up] = comparison.shift_m.unwrap();
            assert!((up - datum).abs() < 0.1, "{up} m instead of {datum}");
            // It has the only roof of the place.
            assert_eq!(comparison.verdict, KnownVerdict::Contradicted);
            let [x, y] = HOUSES[0];
            let miss = found.z_at(&Point2::new(x, y)) - ground(x, y);
            assert!(miss.abs() < 0.3, "{miss} m below the house");
        }
    }

    #[test]
    fn a_house_stands_on_the_ground_of_the_images_where_a_terrain_is_wrong_under_it_alone() {
        let matched = samples(surface);
        let mut ends = matched.clone();
        ends.sort_by(|a, b| a.z.total_cmp(&b.z));
        let images = Ground::from_samples(&matched, 50.0);
        let known = |terrain: &Terrain| images.clone().with_terrain(terrain, &matched, &ends);

        let right = terrain(ground);
        let found = known(&right);
        let nowhere: Vec<[f64; 2]> = Vec::new();
        assert_eq!(found.terrain().unwrap().contradicted_at, nowhere);
        // Too high, as a house that is left in the model, too low.
        for wrong in [3.0, 6.0, -3.0] {
            for (house, margin) in [(0, 0.0), (0, 2.0), (1, 1.0)] {
                let terrain = terrain(|x, y| {
                    let is_wrong = in_house(HOUSES[house], x, y, margin);
                    ground(x, y) + if is_wrong { wrong } else { 0.0 }
                });
                let case = format!("{wrong} m under {house} and {margin} m around");
                let found = known(&terrain);
                let up = contradicted(&found, &terrain);
                assert_eq!(up[1 - house], None, "{case}");
                let up = up[house].expect(&case);
                assert!((up + wrong).abs() < 0.5, "{up}, {case}");
                let at = |[x, y]: [f64; 2]| found.z_at(&Point2::new(x, y)) - ground(x, y);
                let miss = at(HOUSES[house]);
                assert!(miss.abs() < 0.3, "{miss} m, {case}");
                // The rest is the model's.
                let miss = at([30.0, 70.0]);
                assert!(miss.abs() < 0.05, "{miss} m in the wood, {case}");
            }
        }
    }
}
