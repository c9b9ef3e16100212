//! The evidence of the images for a plane: how well they agree when warped to it, and how much
//! better than on planes displaced up and down.

use nalgebra::{Point3, Vector2};

use super::occluding_solids::OccludingSolid;
use crate::base::evidence::WindowEvidenceTable;
use crate::base::geometry::{Plane, bounds, plan_sides, signed_area, span};
use crate::base::math::larger;
use crate::orienting::scene::Scene;
use crate::planes::photoconsistency::{
    ConsistencyMap, PlanGrid, consistency_map, consistency_map_behind,
};

/// Signed area in plan, square metres.
pub(super) fn plan_area(ring: &[Point3<f64>]) -> f64 {
    signed_area(ring.iter().map(Point3::xy))
}

/// Compares the views on one plane and on planes beside it.
pub(crate) struct PlaneConsistency<'a> {
    scene: &'a Scene,
    solids: &'a [OccludingSolid],
    plane: Plane,
    grid: PlanGrid,
    /// How far a metre of height moves the images against each other, pixels.
    parallax_px: f64,
    map: ConsistencyMap,
}

/// Agreement of the views inside a polygon in the plane.
pub(crate) struct PlaneAgreement {
    /// Correlation of the views, weighted by texture.
    pub correlation: f64,
    /// What the windows say of the plane, nats for a square metre in plan: windows a metre apart
    /// are independent.
    pub nats_per_m2: f64,
    /// Texture weight of the windows, 0 to 1.
    pub weight: f64,
}

/// The comparison of the views on planes above and below.
pub(crate) struct DisplacedMaps([ConsistencyMap; 2]);

/// Largest number of cells of a plane's grid.
const MOST_CELLS: f64 = 15_000.0;

impl<'a> PlaneConsistency<'a> {
    /// Compares the views on a plane where the rings are and no solid hides it; `None` without
    /// rings.
    pub(super) fn new(
        scene: &'a Scene,
        plane: &Plane,
        rings: &[Vec<Point3<f64>>],
        solids: &'a [OccludingSolid],
    ) -> Option<Self> {
        let first = rings.iter().flatten().next()?;
        let grid = grid_over(scene, rings, first)?;
        let parallax_px = parallax_px(scene, first);
        (parallax_px > 0.0).then(|| Self {
            scene,
            solids,
            plane: *plane,
            grid,
            parallax_px,
            map: compare(scene, plane, &grid, solids),
        })
    }

    /// The agreement inside a convex ring that runs counter-clockwise.
    pub(super) fn agreement(&self, ring: &[Point3<f64>]) -> PlaneAgreement {
        let cells = self.cells(ring);
        let (mut weights, mut sum) = (0.0, 0.0);
        for &k in &cells {
            let (weight, c) = (self.map.common_weight(k), self.map.correlation(k));
            weights += f64::from(weight);
            sum += f64::from(weight) * f64::from(c);
        }
        PlaneAgreement {
            correlation: if weights > 0.0 { sum / weights } else { 0.0 },
            nats_per_m2: mean_nats(&self.map, &cells),
            weight: weights / cells.len().max(1) as f64,
        }
    }

    /// What the windows say of the better one of the planes above and below inside a ring, nats for
    /// a square metre in plan.
    pub(super) fn best_displaced_nats(
        &self,
        displaced: &DisplacedMaps,
        ring: &[Point3<f64>],
    ) -> f64 {
        let cells = self.cells(ring);
        let nats = displaced.0.each_ref().map(|map| mean_nats(map, &cells));
        larger(nats[0], nats[1])
    }

    /// The cells inside a ring without its border: windows that reach over it show its edge, which
    /// is in the right place for many a false plane.
    fn cells(&self, ring: &[Point3<f64>]) -> Vec<usize> {
        let grid = &self.grid;
        let core = shrunk(ring, REACH_CELLS * grid.step);
        let ring = core.as_deref().unwrap_or(ring);
        let column = |x: f64| ((x - grid.origin.x) / grid.step - 0.5).ceil().max(0.0) as usize;
        let mut cells = Vec::new();
        for row in 0..grid.height {
            if let Some([x0, x1]) = span(plan_sides(ring), grid.center(0, row).y) {
                let columns = column(x0)..column(x1).min(grid.width);
                cells.extend(columns.map(|c| row * grid.width + c));
            }
        }
        cells
    }

    /// Compares the views above and below the plane, where they move by so many pixels against each
    /// other.
    pub(super) fn displaced(&self, shift_px: f64) -> DisplacedMaps {
        let rise = shift_px / self.parallax_px;
        let maps = [rise, -rise].map(|dz| {
            let lifted = Plane {
                d: self.plane.d - self.plane.normal.z * dz,
                ..self.plane
            };
            compare(self.scene, &lifted, &self.grid, self.solids)
        });
        DisplacedMaps(maps)
    }
}

/// Mean of what the windows of some cells say of the plane of a map, nats.
fn mean_nats(map: &ConsistencyMap, cells: &[usize]) -> f64 {
    let table = WindowEvidenceTable::fitted();
    let nats = cells
        .iter()
        .map(|&k| table.nats_of(map.common_weight(k), map.correlation(k)));
    nats.sum::<f64>() / cells.len().max(1) as f64
}

fn compare(
    scene: &Scene,
    plane: &Plane,
    grid: &PlanGrid,
    solids: &[OccludingSolid],
) -> ConsistencyMap {
    if solids.is_empty() {
        return consistency_map(scene, plane, grid);
    }
    consistency_map_behind(scene, plane, grid, &|view, point| {
        let center = &scene.camera(view).center;
        solids.iter().any(|s| s.hides(point, center))
    })
}

/// A plan grid over all rings with samples as fine as the finest image.
fn grid_over(scene: &Scene, rings: &[Vec<Point3<f64>>], at: &Point3<f64>) -> Option<PlanGrid> {
    let [min, max] = bounds(rings.iter().flatten().map(Point3::xy));
    let size = max - min;
    let step =
        PlanGrid::cell_of_pixels(finest_m(scene, at)).max((size.x * size.y / MOST_CELLS).sqrt());
    (size.x > 0.0 && size.y > 0.0 && step.is_finite()).then_some(())?;
    let margin = Vector2::new(3.0, 3.0) * step;
    Some(PlanGrid::covering(min - margin, max + margin, step))
}

/// Ground pixel of the finest image, metres.
fn finest_m(scene: &Scene, at: &Point3<f64>) -> f64 {
    let pixels = scene.views.iter().map(|v| v.camera.ground_pixel(at));
    pixels.fold(f64::INFINITY, f64::min)
}

/// How far a metre of height moves the images of a point against each other at most, pixels.
fn parallax_px(scene: &Scene, at: &Point3<f64>) -> f64 {
    let slopes: Vec<Vector2<f64>> = scene
        .views
        .iter()
        .map(|v| {
            let d = v.camera.center - at;
            d.xy() / d.z
        })
        .collect();
    let pairs = slopes
        .iter()
        .flat_map(|a| slopes.iter().map(move |b| (a - b).norm()));
    pairs.fold(0.0, f64::max) / finest_m(scene, at)
}

/// Half the window of the correlation and the pixel that an edge takes, cells.
const REACH_CELLS: f64 = 3.0;

/// A convex ring with its sides moved inwards; `None` where little is left.
fn shrunk(ring: &[Point3<f64>], by: f64) -> Option<Vec<Point3<f64>>> {
    let n = ring.len();
    // Lines a x + b y = c through the moved sides; the inside is to the left.
    let side = |i: usize| {
        let (p, q) = (&ring[i], &ring[(i + 1) % n]);
        let d = (q - p).xy().normalize();
        (-d.y, d.x, -d.y * p.x + d.x * p.y + by)
    };
    let moved: Vec<Point3<f64>> = (0..n)
        .map(|i| {
            let ((a, b, c), (d, e, f)) = (side((i + n - 1) % n), side(i));
            let det = a * e - b * d;
            Point3::new((c * e - b * f) / det, (a * f - c * d) / det, 0.0)
        })
        .collect();
    let inwards = (0..n).all(|i| {
        let j = (i + 1) % n;
        (moved[j] - moved[i]).xy().dot(&(ring[j] - ring[i]).xy()) > 0.0
    });
    (inwards && plan_area(&moved) > 0.15 * plan_area(ring)).then_some(moved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_shrinks_on_all_sides_and_a_sliver_does_not() {
        let ring = |w: f64| {
            [[0.0, 0.0], [9.0, 0.0], [9.0, w], [0.0, w]]
                .map(|[x, y]| Point3::new(x, y, 1.0))
                .to_vec()
        };
        let core = shrunk(&ring(6.0), 1.0).unwrap();
        assert!((plan_area(&core) - 28.0).abs() < 1e-9);
        assert_eq!(span(plan_sides(&core), 3.0), Some([1.0, 8.0]));
        assert!(shrunk(&ring(1.5), 1.0).is_none());
    }
}
