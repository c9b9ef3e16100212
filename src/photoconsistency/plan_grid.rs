//! The plan grid: a raster of square cells on the XY plane in which plane hypotheses are compared.

use std::ops::Range;

use nalgebra::{Matrix3, Point2, Point3, Vector2};
use serde::{Deserialize, Serialize};

use crate::camera::Camera;
use crate::geometry::Plane;
use crate::raster::{Gray, Outside, Warp};

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

/// The image seen from straight above under the hypothesis that the surface is `plane`: grey values
/// on the grid, NaN where the image does not reach, or everywhere when the plane rises to the
/// camera within the grid.
pub(crate) fn orthophoto(gray: &Gray, camera: &Camera, plane: &Plane, grid: &PlanGrid) -> Vec<f32> {
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

/// The same for a surface that is no plane: `z` gives its height over a plan position, metres.
pub(crate) fn orthophoto_of_surface(
    gray: &Gray,
    camera: &Camera,
    z: &dyn Fn(&Point2<f64>) -> f64,
    grid: &PlanGrid,
) -> Vec<f32> {
    let value = |k: usize| {
        let p = grid.center(k % grid.width, k / grid.width);
        let x = camera.project(&Point3::new(p.x, p.y, z(&p)))?;
        gray.sample(x.x as f32, x.y as f32)
    };
    let cells = 0..grid.width * grid.height;
    cells.map(|k| value(k).unwrap_or(f32::NAN)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::testing::crop_camera;
    use nalgebra::Vector3;

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
    fn windows_of_one_scene_share_cells() {
        let large = PlanGrid::covering(Point2::new(-10.03, 4.2), Point2::new(30.0, 40.0), 0.1);
        let small = PlanGrid::covering(Point2::new(1.234, 9.87), Point2::new(3.0, 12.0), 0.1);
        let (c, r) = small.offset_in(&large);
        let p = small.center(3, 5);
        assert_eq!(large.cell(&p), Some(((c + 3) as usize, (r + 5) as usize)));
    }
}
