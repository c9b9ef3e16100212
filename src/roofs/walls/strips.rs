//! The windows below a side of the outline: on its wall at every depth, and on the ground.
//!
//! Windows are as long as [`WINDOW_COLUMNS`] pixels along the side and [`WINDOW_ROWS`] rows high:
//! of a wall that views see at a slant little shows, but that is long. The rows on a wall are a
//! pixel apart in the view that sees it most from the side.

use nalgebra::{Matrix3, Point3, Vector2, Vector3};

use crate::base::evidence::WallEvidence;
use crate::base::geometry::Plane;
use crate::base::ids::ViewId;
use crate::base::math::{larger, smaller};
use crate::orienting::scene::Scene;
use crate::photographs::camera::Camera;
use crate::photographs::raster::{Outside, Warp};
use crate::planes::photoconsistency::{LEAST_VARIANCE, MAX_VIEWS, residual_variance};
use crate::roofs::model::Occluders;
use crate::roofs::solids::{RIM_M, Side};

/// Rows of a window, and about how many columns: as many cells as other windows have.
const WINDOW_ROWS: usize = 3;
const WINDOW_COLUMNS: usize = 40;

/// Shorter sides are not measured, pixels.
const LEAST_COLUMNS: usize = 20;

/// Views whose rays rise more steeply see no wall, horizontal metres a metre of height: three
/// metres of it would be two pixels.
const LEAST_TANGENT: f64 = 0.05;

/// Rows on a wall are no further apart, metres.
const HIGHEST_ROW_M: f64 = 0.6;

/// Lower roofs show no wall, metres.
const LEAST_HEIGHT_M: f64 = 1.5;

/// A view that looks under the side.
struct SideView<'a> {
    id: ViewId,
    camera: &'a Camera,
    /// For each window along the side the height at the rim, metres, above which nothing else
    /// hides what is below the roof.
    clear_above: Vec<f64>,
}

/// What is below a side of the outline, in the views that look there from outside.
pub(super) struct Strips<'a> {
    scene: &'a Scene,
    side: &'a Side,
    ground: &'a Plane,
    views: Vec<SideView<'a>>,
    along: Vector3<f64>,
    inward: Vector3<f64>,
    /// Distance of columns along the side, and of rows on the ground, metres.
    step: f64,
    /// Distance of rows on a wall, metres.
    rise: f64,
    /// Height of the lowest row of walls, and of the highest corner of the rim, metres.
    lowest: f64,
    highest: f64,
    columns: usize,
    rows: usize,
}

/// A raster below the side.
struct Raster<'a> {
    /// Its first corner.
    start: Point3<f64>,
    /// From column to column and from row to row, metres.
    steps: [Vector3<f64>; 2],
    rows: usize,
    /// How deep behind the rim a row lies, metres.
    depth: &'a dyn Fn(f64) -> f64,
}

/// The views that look under a side at a point of its wall, those whose rays rise least first; with
/// the horizontal metres of their rays a metre of height.
fn views_below(scene: &Scene, middle: &Point3<f64>, inward: &Vector3<f64>) -> Vec<(ViewId, f64)> {
    let tangent = |camera: &Camera| {
        let ray = camera.center - middle;
        let shows = camera
            .project(middle)
            .is_some_and(|p| camera.contains(&p, 0.0));
        (shows && ray.z > 0.0).then(|| -ray.dot(inward) / ray.z)
    };
    let mut views: Vec<(ViewId, f64)> = (scene.view_ids())
        .filter_map(|v| Some((v, tangent(scene.camera(v))?)))
        .filter(|(_, t)| *t > LEAST_TANGENT)
        .collect();
    views.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    views.truncate(MAX_VIEWS);
    views
}

impl<'a> Strips<'a> {
    /// `None` where fewer than two views look under the side, or it is too short or too low.
    pub(super) fn new(
        scene: &'a Scene,
        side: &'a Side,
        ground: &'a Plane,
        occluders: &Occluders,
    ) -> Option<Self> {
        let flat = |v: Vector2<f64>| Vector3::new(v.x, v.y, 0.0);
        let (along, inward) = (flat(side.along()), flat(side.inward()));
        let feet = [side.start(), side.end()].map(|p| ground.z_at(p.x, p.y));
        let lowest = smaller(feet[0], feet[1]);
        let highest = side.rim.iter().map(|p| p.z).fold(f64::MIN, larger);
        if highest - lowest < LEAST_HEIGHT_M {
            return None;
        }
        let mut middle = nalgebra::center(&side.start(), &side.end());
        middle.z = 0.5 * (lowest + highest);
        let views = views_below(scene, &middle, &inward);
        let pixels = views
            .iter()
            .map(|(v, _)| scene.camera(*v).ground_pixel(&middle));
        let step = pixels.fold(f64::INFINITY, smaller);
        let columns = (side.length() / step) as usize;
        if views.len() < 2 || columns < LEAST_COLUMNS {
            return None;
        }
        let rise = smaller(step / views[0].1, HIGHEST_ROW_M);
        let mut strips = Self {
            scene,
            side,
            ground,
            views: Vec::new(),
            along,
            inward,
            step,
            rise,
            lowest,
            highest,
            columns,
            rows: (((highest - lowest) / rise) as usize).next_multiple_of(WINDOW_ROWS),
        };
        strips.views = (views.iter())
            .map(|(id, _)| SideView {
                id: *id,
                camera: scene.camera(*id),
                clear_above: strips.clear_above(scene.camera(*id), occluders),
            })
            .collect();
        Some(strips)
    }

    /// What all windows say of each depth of the tables, nats: those on the wall there, and those
    /// on the ground before it.
    pub(super) fn nats(&self) -> Vec<f64> {
        let tables = WallEvidence::fitted();
        let deepest = tables.prior.last().map_or(0.0, |(depth, _)| *depth);
        let ground = self.ground_nats(tables, deepest);
        let window = WINDOW_ROWS as f64 * self.step;
        (tables.prior.iter())
            .map(|&(depth, _)| {
                let before = ground.iter().enumerate().map(|(row, nats)| {
                    let covered = (depth - row as f64 * window) / window;
                    covered.clamp(0.0, 1.0) * nats
                });
                self.wall_nats(tables, depth) + before.sum::<f64>()
            })
            .collect()
    }

    fn wall_nats(&self, tables: &WallEvidence, depth: f64) -> f64 {
        let mut start = self.side.start() + self.inward * depth;
        start.z = self.lowest;
        let raster = Raster {
            start,
            steps: [self.along * self.step, Vector3::z() * self.rise],
            rows: self.rows,
            depth: &|_| depth,
        };
        let windows = self.windows(&raster);
        let nats = windows
            .flatten()
            .map(|(weight, correlation)| tables.wall.nats_of(weight, correlation));
        nats.sum()
    }

    /// Of the windows on the ground, row by row from the rim inwards.
    fn ground_nats(&self, tables: &WallEvidence, deepest: f64) -> Vec<f64> {
        let on_ground = |p: Point3<f64>| self.ground.lift(p.x, p.y);
        let start = on_ground(self.side.start());
        let steps = [self.along, self.inward].map(|v| on_ground(start + v * self.step) - start);
        let rows = ((deepest / self.step) as usize + 1).next_multiple_of(WINDOW_ROWS);
        let raster = Raster {
            start,
            steps,
            rows,
            depth: &|row| row * self.step,
        };
        let windows: Vec<Option<(f32, f32)>> = self.windows(&raster).collect();
        let nats = |window: &Option<(f32, f32)>| {
            window.map_or(0.0, |(weight, correlation)| {
                tables.ground.nats_of(weight, correlation)
            })
        };
        (windows.chunks(self.windows_along()))
            .map(|row| row.iter().map(nats).sum())
            .collect()
    }

    fn windows_along(&self) -> usize {
        (self.columns as f64 / WINDOW_COLUMNS as f64)
            .round()
            .max(1.0) as usize
    }

    /// Columns of a window.
    fn columns_of(&self, window: usize) -> std::ops::Range<usize> {
        let cut = |i: usize| i * self.columns / self.windows_along();
        cut(window)..cut(window + 1)
    }

    /// Texture weight, and mean of the correlations of all pairs of views that see all of a
    /// window, row by row; `None` where fewer than two do.
    fn windows(&self, raster: &Raster) -> impl Iterator<Item = Option<(f32, f32)>> + use<'_, 'a> {
        let images: Vec<Option<Vec<f32>>> = (self.views.iter())
            .map(|view| self.image(view, raster))
            .collect();
        let rows = raster.rows / WINDOW_ROWS;
        let all = (0..rows).flat_map(|row| (0..self.windows_along()).map(move |i| (row, i)));
        all.map(move |(row, i)| {
            let columns = self.columns_of(i);
            let mut seen: Vec<Vec<f32>> = Vec::new();
            let mut ids = Vec::new();
            for (view, image) in self.views.iter().zip(&images) {
                let Some(image) = image else { continue };
                let rows = row * WINDOW_ROWS..(row + 1) * WINDOW_ROWS;
                let of_row = |r: usize| &image[r * self.columns..][columns.clone()];
                let values: Vec<f32> = rows.flat_map(of_row).copied().collect();
                // What the view does not see is not a number.
                if let Some(values) = centred(values) {
                    seen.push(values);
                    ids.push(view.id);
                }
            }
            compare(&seen, residual_variance(self.scene, &ids))
        })
    }

    /// A view on a raster; not a number where it does not see it below the rim of the roof.
    fn image(&self, view: &SideView, raster: &Raster) -> Option<Vec<f32>> {
        let p = view.camera.projection_matrix();
        let [column, row] = raster.steps.map(|v| p.fixed_view::<3, 3>(0, 0) * v);
        let start = p * raster.start.to_homogeneous();
        let image_from_raster = Matrix3::from_columns(&[column, row, start]);
        let size = [self.columns, raster.rows];
        let warp = Warp::new(&self.scene.view(view.id).gray, &image_from_raster, size)?;
        let mut image = vec![0.0; self.columns * raster.rows];
        for (r, values) in image.chunks_exact_mut(self.columns).enumerate() {
            let row = r as f64 + 0.5;
            let depth = (raster.depth)(row);
            let at = |column: f64| raster.start + raster.steps[0] * column + raster.steps[1] * row;
            // Most rows of deep walls are hidden by the rim as a whole.
            let ends = [0.0, self.columns as f64].map(|column| self.exit(view, &at(column), depth));
            if depth > 0.0 && ends.iter().all(|exit| exit.z > self.highest) {
                values.fill(f32::NAN);
                continue;
            }
            warp.fill(r, values, Outside::Nan, |gray| gray);
            for i in 0..self.windows_along() {
                for column in self.columns_of(i) {
                    let place = at(column as f64 + 0.5);
                    if !self.sees(view, i, &place, depth) {
                        values[column] = f32::NAN;
                    }
                }
            }
        }
        Some(image)
    }

    /// Where the ray to a view from a place so deep behind the rim leaves from under the roof.
    fn exit(&self, view: &SideView, place: &Point3<f64>, depth: f64) -> Point3<f64> {
        let ray = view.camera.center - place;
        place + ray * (larger(depth, 0.0) / -ray.dot(&self.inward))
    }

    /// Does a view see a place so deep behind the rim: above the ground, below the rim, and past
    /// other roofs?
    fn sees(&self, view: &SideView, window: usize, place: &Point3<f64>, depth: f64) -> bool {
        let exit = self.exit(view, place, depth);
        let s = (exit - self.side.start()).dot(&self.along);
        let is_below =
            depth <= 0.0 || (self.side.rim_at(s)).is_some_and(|rim| exit.z < rim - RIM_M);
        let above_ground = place.z - self.ground.z_at(place.x, place.y);
        is_below && above_ground > -1e-6 && exit.z > view.clear_above[window]
    }

    /// For each window along the side the height at the rim from which on no roof hides a view.
    fn clear_above(&self, camera: &Camera, occluders: &Occluders) -> Vec<f64> {
        /// Halvings of the height of the roof: to a few centimetres.
        const HALVINGS: usize = 6;
        let at = |window: usize| {
            let columns = self.columns_of(window);
            let s = 0.5 * (columns.start + columns.end) as f64 * self.step;
            // Beside the roof, not below it.
            let foot = self.side.start() + self.along * s - self.inward * self.step;
            let hidden = |z: f64| occluders.hide(&Point3::new(foot.x, foot.y, z), &camera.center);
            let (mut low, mut high) = (self.lowest - self.rise, self.highest);
            if !hidden(low) {
                return f64::MIN;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if hidden(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            high
        };
        (0..self.windows_along()).map(at).collect()
    }
}

/// Values less their mean; `None` where one is not a number.
fn centred(mut values: Vec<f32>) -> Option<Vec<f32>> {
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    values.iter_mut().for_each(|v| *v -= mean);
    mean.is_finite().then_some(values)
}

/// Texture weight, and mean of the correlations of all pairs.
fn compare(windows: &[Vec<f32>], residual: f32) -> Option<(f32, f32)> {
    let product = |a: &[f32], b: &[f32]| {
        let sum: f32 = a.iter().zip(b).map(|(x, y)| x * y).sum();
        sum / a.len() as f32
    };
    let variances: Vec<f32> = windows.iter().map(|w| product(w, w)).collect();
    let (mut sum, mut pairs) = (0.0, 0);
    for (j, b) in windows.iter().enumerate() {
        for (i, a) in windows[..j].iter().enumerate() {
            let known = |v: f32| {
                if v > LEAST_VARIANCE {
                    v
                } else {
                    LEAST_VARIANCE
                }
            };
            let deviations = (known(variances[i]) * known(variances[j])).sqrt();
            sum += (product(a, b) / deviations).clamp(-1.0, 1.0);
            pairs += 1;
        }
    }
    let variance = variances.iter().sum::<f32>() / variances.len() as f32;
    (pairs > 0).then(|| (variance / (variance + residual), sum / pairs as f32))
}
