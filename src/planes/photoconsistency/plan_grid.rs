//! The plan grid: a raster of square cells on the XY plane in which plane hypotheses are compared.
//!
//! A view is sampled at four positions of every cell. What is said of windows changes little from
//! one sample to the next, so that it is kept by cell: a quarter of the sums and of the memory.

use std::ops::Range;

use nalgebra::{Matrix3, Point2, Vector2};
use serde::{Deserialize, Serialize};

use crate::base::geometry::Plane;
use crate::base::math::larger;
use crate::photographs::camera::Camera;
use crate::photographs::raster::{Gray, Outside, Warp};

/// Positions along each side of a cell at which the views are sampled.
pub(crate) const CELL_SAMPLES: usize = 2;
/// Grey values of a view in every cell of a plan grid, row by row, a raster for each position
/// within the cells; NaN where the view does not reach.
pub(crate) type SampledCells = [Vec<f32>; CELL_SAMPLES * CELL_SAMPLES];

/// A window of plan positions; the centre of cell (column, row) is `origin + (column + 0.5, row +
/// 0.5) step`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PlanGrid {
    /// Least x and y, metres.
    pub origin: Point2<f64>,
    /// Cell size, metres.
    pub step: f64,
    /// Columns (along x).
    pub width: usize,
    /// Rows (along y).
    pub height: usize,
}

impl PlanGrid {
    /// The grid that covers a box, aligned to multiples of `step` so that windows of one scene
    /// share cells.
    pub(crate) fn covering(min: Point2<f64>, max: Point2<f64>, step: f64) -> Self {
        let (c0, r0) = ((min.x / step).floor(), (min.y / step).floor());
        let (c1, r1) = ((max.x / step).ceil(), (max.y / step).ceil());
        Self {
            origin: Point2::new(c0 * step, r0 * step),
            step,
            width: (c1 - c0).max(1.0) as usize,
            height: (r1 - r0).max(1.0) as usize,
        }
    }

    /// The same place in the samples in which what is known is laid over a plan.
    pub(crate) fn in_samples(&self) -> Self {
        // Finest sample, metres, and most samples.
        const SAMPLE_M: f64 = 0.25;
        const MOST_SAMPLES: f64 = 4e6;
        let size = Vector2::new(self.width as f64, self.height as f64) * self.step;
        let step = larger(SAMPLE_M, (size.x * size.y / MOST_SAMPLES).sqrt());
        Self::covering(self.origin, self.origin + size, step)
    }

    /// Centre of a cell, metres.
    pub(crate) fn center(&self, column: usize, row: usize) -> Point2<f64> {
        self.origin + Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * self.step
    }

    /// The cell that holds a plan position, when it is inside.
    pub(crate) fn cell(&self, p: &Point2<f64>) -> Option<(usize, usize)> {
        let (c, r) = (
            (p.x - self.origin.x) / self.step,
            (p.y - self.origin.y) / self.step,
        );
        (c >= 0.0 && r >= 0.0 && c < self.width as f64 && r < self.height as f64)
            .then_some((c as usize, r as usize))
    }

    /// Some of its columns and rows.
    pub(super) fn part(&self, columns: Range<usize>, rows: Range<usize>) -> Self {
        let offset = Vector2::new(columns.start as f64, rows.start as f64) * self.step;
        Self {
            origin: self.origin + offset,
            step: self.step,
            width: columns.len(),
            height: rows.len(),
        }
    }

    /// With so many cells more on all sides, as far as `whole` reaches, of which it is a part.
    pub(super) fn widened(&self, cells: usize, whole: &PlanGrid) -> Self {
        let (c, r) = self.offset_in(whole);
        let wide = |first: isize, count: usize, most: usize| {
            let first = first as usize;
            first.saturating_sub(cells)..(first + count + cells).min(most)
        };
        whole.part(
            wide(c, self.width, whole.width),
            wide(r, self.height, whole.height),
        )
    }

    /// The size of cells whose samples are so far apart, metres: a ground pixel.
    pub(crate) fn cell_of_pixels(pixel_m: f64) -> f64 {
        CELL_SAMPLES as f64 * pixel_m
    }

    /// The grid whose cells lie around the samples of this one's cells.
    pub(crate) fn of_samples(&self) -> Self {
        Self {
            step: self.step / CELL_SAMPLES as f64,
            width: self.width * CELL_SAMPLES,
            height: self.height * CELL_SAMPLES,
            ..*self
        }
    }

    /// Column and row, in the grid of the samples, of those of a cell.
    pub(crate) fn samples_of(
        &self,
        [column, row]: [usize; 2],
    ) -> [[usize; 2]; CELL_SAMPLES * CELL_SAMPLES] {
        let [c, r] = [column, row].map(|i| i * CELL_SAMPLES);
        std::array::from_fn(|k| [c + k % CELL_SAMPLES, r + k / CELL_SAMPLES])
    }

    /// For each position within the cells the grid that has it in the middle of its cells.
    fn at_samples(&self) -> [Self; CELL_SAMPLES * CELL_SAMPLES] {
        std::array::from_fn(|k| {
            let [column, row] = [k % CELL_SAMPLES, k / CELL_SAMPLES];
            let from_middle = |i: usize| (i as f64 + 0.5) / CELL_SAMPLES as f64 - 0.5;
            let offset = Vector2::new(from_middle(column), from_middle(row)) * self.step;
            Self {
                origin: self.origin + offset,
                ..*self
            }
        })
    }

    /// Column and row of this window's first cell in `larger`, which has the same step.
    pub(crate) fn offset_in(&self, larger: &PlanGrid) -> (isize, isize) {
        let d = (self.origin - larger.origin) / self.step;
        (d.x.round() as isize, d.y.round() as isize)
    }
}

/// The map from plan positions (x, y, 1) on a plane to the image of a camera: 3 x 3.
///
/// A point of the plane is (x, y, z(x, y)) with z linear, so its image is a homography of (x, y).
pub(crate) fn image_from_plan(camera: &Camera, plane: &Plane) -> Matrix3<f64> {
    let p = camera.projection_matrix();
    let n = plane.normal;
    let lift = nalgebra::Matrix4x3::new(
        1.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        -n.x / n.z,
        -n.y / n.z,
        -plane.d / n.z,
        0.0,
        0.0,
        1.0,
    );
    p * lift
}

/// The image seen from straight above under the hypothesis that the surface is `plane`; NaN
/// everywhere when the plane rises to the camera within the grid.
pub(crate) fn orthophoto(
    gray: &Gray,
    camera: &Camera,
    plane: &Plane,
    grid: &PlanGrid,
) -> SampledCells {
    (grid.at_samples()).map(|grid| orthophoto_at_centers(gray, camera, plane, &grid))
}

// One copy of the code for all samples of a cell.
#[inline(never)]
fn orthophoto_at_centers(gray: &Gray, camera: &Camera, plane: &Plane, grid: &PlanGrid) -> Vec<f32> {
    let plan_from_grid = Matrix3::new(
        grid.step,
        0.0,
        grid.origin.x,
        0.0,
        grid.step,
        grid.origin.y,
        0.0,
        0.0,
        1.0,
    );
    let m = image_from_plan(camera, plane) * plan_from_grid;
    let mut out = vec![f32::NAN; grid.width * grid.height];
    if let Some(warp) = Warp::new(gray, &m, [grid.width, grid.height]) {
        for (row, line) in out.chunks_exact_mut(grid.width).enumerate() {
            warp.fill(row, line, Outside::Nan, |values| values);
        }
    }
    out
}

/// The heights of a surface that is no plane at the samples of the cells of a grid.
pub(super) struct SurfaceHeights {
    grid: PlanGrid,
    /// Metres, in the order of [`SampledCells`].
    z: SampledCells,
}

impl SurfaceHeights {
    /// `z` gives the height over a plan position, metres.
    pub(super) fn new(z: &dyn Fn(&Point2<f64>) -> f64, grid: &PlanGrid) -> Self {
        let of_samples = grid.at_samples().map(|at| {
            let cells = 0..grid.width * grid.height;
            let height = |k: usize| z(&at.center(k % grid.width, k / grid.width)) as f32;
            cells.map(height).collect()
        });
        Self {
            grid: *grid,
            z: of_samples,
        }
    }

    /// The orthophoto of the surface over a part of the grid.
    pub(super) fn orthophoto(&self, gray: &Gray, camera: &Camera, part: &PlanGrid) -> SampledCells {
        let (first, top) = part.offset_in(&self.grid);
        let (first, top) = (first as usize, top as usize);
        let samples = part.at_samples();
        std::array::from_fn(|at| {
            let mut out = vec![f32::NAN; part.width * part.height];
            for (row, line) in out.chunks_exact_mut(part.width).enumerate() {
                let heights = &self.z[at][(top + row) * self.grid.width + first..][..part.width];
                fill_row(
                    gray,
                    camera,
                    &samples[at].center(0, row),
                    part.step,
                    heights,
                    line,
                );
            }
            out
        })
    }
}

/// Grey values at places along x from `start` on, `step` apart, at these heights.
// One copy of the code for all samples of a cell.
#[inline(never)]
fn fill_row(
    gray: &Gray,
    camera: &Camera,
    start: &Point2<f64>,
    step: f64,
    heights: &[f32],
    out: &mut [f32],
) {
    // As many as are sampled at once.
    const LANES: usize = 8;
    let m = camera.k * camera.r;
    let from_camera = start - camera.center.xy();
    for (block, (heights, out)) in (heights.chunks(LANES).zip(out.chunks_mut(LANES))).enumerate() {
        let mut image = [[f32::NAN; LANES]; 2];
        for (lane, z) in heights.iter().enumerate() {
            let column = (block * LANES + lane) as f64;
            let dz = f64::from(*z) - camera.center.z;
            let [dx, dy] = [from_camera.x + column * step, from_camera.y];
            let [u, v, depth] = [0, 1, 2].map(|i| m[(i, 0)] * dx + m[(i, 1)] * dy + m[(i, 2)] * dz);
            if depth > 0.0 {
                image[0][lane] = (u / depth) as f32;
                image[1][lane] = (v / depth) as f32;
            }
        }
        let values = gray.sample_eight(image[0], image[1]).to_array();
        out.copy_from_slice(&values[..out.len()]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photographs::camera::testing::crop_camera;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn a_plane_given_by_its_heights_has_the_same_orthophoto() {
        let camera = crop_camera(100.0, -50.0, 0.3);
        let gray = Gray::from_fn(camera.width as usize, camera.height as usize, |x, y| {
            0.5 + 0.3 * crate::base::math::sin(0.1 * x as f64) as f32 + 0.001 * y as f32
        });
        let shown = camera.at_height(&Point2::new(300.0, 300.0), 8.0).unwrap();
        let plane = Plane::from_point_normal(&shown, &Vector3::new(0.3, -0.1, 1.0)).unwrap();
        let [low, high] = [-4.0, 5.0].map(|by| shown.xy() + Vector2::new(by, by));
        let whole = PlanGrid::covering(low, high, 0.3);
        let part = whole.part(3..21, 5..16);
        let heights = SurfaceHeights::new(&|p| plane.z_at(p.x, p.y), &whole);
        let by_heights = heights.orthophoto(&gray, &camera, &part);
        let of_plane = orthophoto(&gray, &camera, &plane, &part);
        let pairs = by_heights.iter().flatten().zip(of_plane.iter().flatten());
        let mut compared = 0;
        for (a, b) in pairs {
            assert_eq!(a.is_nan(), b.is_nan());
            if !a.is_nan() {
                assert!((a - b).abs() < 1e-3, "{a} {b}");
                compared += 1;
            }
        }
        assert!(compared > 500, "{compared}");
    }

    #[test]
    fn plan_map_agrees_with_projection() {
        let camera = crop_camera(100.0, -50.0, 0.3);
        let plane =
            Plane::from_point_normal(&Point3::new(0.0, 0.0, 8.0), &Vector3::new(0.3, -0.1, 1.0))
                .unwrap();
        let x = image_from_plan(&camera, &plane) * Vector3::new(4.0, 7.0, 1.0);
        let expected = camera.project(&plane.lift(4.0, 7.0)).unwrap();
        assert!((Point2::new(x.x / x.z, x.y / x.z) - expected).norm() < 1e-6);
    }

    #[test]
    fn the_samples_of_a_cell_lie_around_its_middle() {
        let grid = PlanGrid::covering(Point2::new(-10.03, 4.2), Point2::new(30.0, 40.0), 0.2);
        let samples = grid.at_samples().map(|at| at.center(3, 5));
        let mean = samples.iter().map(|p| p.coords).sum::<Vector2<f64>>() / 4.0;
        assert!((grid.center(3, 5).coords - mean).norm() < 1e-12);
        let fine = grid.of_samples();
        let cells = [(6, 10), (7, 10), (6, 11), (7, 11)];
        for (sample, (column, row)) in samples.iter().zip(cells) {
            assert!((fine.center(column, row) - sample).norm() < 1e-12);
        }
    }

    #[test]
    fn windows_of_one_scene_share_cells() {
        let large = PlanGrid::covering(Point2::new(-10.03, 4.2), Point2::new(30.0, 40.0), 0.1);
        let small = PlanGrid::covering(Point2::new(1.234, 9.87), Point2::new(3.0, 12.0), 0.1);
        let (c, r) = small.offset_in(&large);
        let p = small.center(3, 5);
        assert_eq!(large.cell(&p), Some(((c + 3) as usize, (r + 5) as usize)));
    }
}
