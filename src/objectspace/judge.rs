//! What the images say about a plane: are they alike when warped to it, and more alike than on planes above and below?

use nalgebra::{Point2, Point3, Vector2};

use super::solid::Solid;
use crate::geometry::Plane;
use crate::halfplane::{ConsistencyMap, PlanGrid, consistency_map, consistency_map_behind};
use crate::scene::Scene;

/// Signed area in plan, square metres.
pub(super) fn area_2d(ring: &[Point3<f64>]) -> f64 {
    (0..ring.len())
        .map(|i| {
            let (p, q) = (&ring[i], &ring[(i + 1) % ring.len()]);
            0.5 * (p.x * q.y - p.y * q.x)
        })
        .sum()
}

/// Compares the views on one plane and on planes beside it.
pub(super) struct Judge<'a> {
    scene: &'a Scene,
    solids: &'a [Solid],
    plane: Plane,
    grid: PlanGrid,
    /// How far a metre of height moves the images against each other, pixels.
    parallax_px: f64,
    map: ConsistencyMap,
}

/// What the views say about a polygon in the plane.
pub(super) struct OnPlane {
    /// How much its texture can tell, 0 to 1.
    pub weight: f64,
    /// Correlation of the views, weighted by texture.
    pub correlation: f64,
}

/// The views on planes above and below.
pub(super) struct Beside([ConsistencyMap; 2], PlanGrid);

/// Correlation of unrelated textures: only the better half of all pairs of views counts. No plane beside another one is taken to
/// be worse, so that hopeless planes need not be compared with any.
pub(super) const CHANCE: f64 = 0.45;

/// Largest number of cells of a plane's grid.
const MOST_CELLS: f64 = 60_000.0;

impl<'a> Judge<'a> {
    /// Compares the views on a plane where the rings are and no solid hides it; `None` without rings.
    pub fn new(
        scene: &'a Scene,
        plane: &Plane,
        rings: &[Vec<Point3<f64>>],
        solids: &'a [Solid],
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

    /// Looks inside a convex ring that runs counter-clockwise.
    pub fn on_plane(&self, ring: &[Point3<f64>]) -> OnPlane {
        let [weight, correlation] = mean_inside(&self.map, &core(ring, &self.grid));
        OnPlane {
            weight,
            correlation,
        }
    }

    /// Compares the views above and below the plane, where they move by so many pixels against each other.
    pub fn beside(&self, shift_px: f64) -> Beside {
        let rise = shift_px / self.parallax_px;
        let maps = [rise, -rise].map(|dz| {
            let lifted = Plane {
                d: self.plane.d - self.plane.normal.z * dz,
                ..self.plane
            };
            compare(self.scene, &lifted, &self.grid, self.solids)
        });
        Beside(maps, self.grid)
    }
}

impl Beside {
    /// The larger one of the correlations above and below inside a ring.
    pub fn correlation(&self, ring: &[Point3<f64>]) -> f64 {
        let core = core(ring, &self.1);
        let [above, below] = self.0.each_ref().map(|m| mean_inside(m, &core)[1]);
        above.max(below)
    }
}

fn compare(scene: &Scene, plane: &Plane, grid: &PlanGrid, solids: &[Solid]) -> ConsistencyMap {
    if solids.is_empty() {
        return consistency_map(scene, plane, grid);
    }
    consistency_map_behind(scene, plane, grid, |view, point| {
        let center = &scene.camera(view).center;
        solids.iter().any(|s| s.hides(point, center))
    })
}

/// A ring without its border: windows that reach over it show its edge, which is in the right place for many a false plane.
fn core(ring: &[Point3<f64>], grid: &PlanGrid) -> Vec<Point3<f64>> {
    shrunk(ring, REACH_CELLS * grid.step).unwrap_or_else(|| ring.to_vec())
}

/// A plan grid over all rings with cells as fine as the finest image.
fn grid_over(scene: &Scene, rings: &[Vec<Point3<f64>>], at: &Point3<f64>) -> Option<PlanGrid> {
    let corners = || rings.iter().flatten();
    let bound = |start: f64, f: fn(f64, f64) -> f64| {
        Point2::new(
            corners().map(|p| p.x).fold(start, f),
            corners().map(|p| p.y).fold(start, f),
        )
    };
    let (min, max) = (
        bound(f64::INFINITY, f64::min),
        bound(f64::NEG_INFINITY, f64::max),
    );
    let size = max - min;
    let step = finest_m(scene, at).max((size.x * size.y / MOST_CELLS).sqrt());
    (size.x > 0.0 && size.y > 0.0 && step.is_finite()).then_some(())?;
    let margin = Vector2::new(6.0, 6.0) * step;
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

/// Mean weight and weighted mean correlation inside a convex ring.
fn mean_inside(map: &ConsistencyMap, ring: &[Point3<f64>]) -> [f64; 2] {
    let grid = &map.grid;
    let (mut cells, mut weights, mut sum) = (0u32, 0.0, 0.0);
    let column = |x: f64| ((x - grid.origin.x) / grid.step - 0.5).ceil().max(0.0) as usize;
    for row in 0..grid.height {
        let Some([x0, x1]) = span(ring, grid.center(0, row).y) else {
            continue;
        };
        for c in column(x0)..column(x1).min(grid.width) {
            let k = row * grid.width + c;
            let weight = f64::from(map.common_weight(k));
            cells += 1;
            weights += weight;
            sum += weight * f64::from(map.correlation(k));
        }
    }
    let correlation = if weights > 0.0 { sum / weights } else { 0.0 };
    [weights / f64::from(cells.max(1)), correlation]
}

/// Half the window of the correlation and the pixel that an edge takes, cells.
const REACH_CELLS: f64 = 6.0;

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
    (inwards && area_2d(&moved) > 0.15 * area_2d(ring)).then_some(moved)
}

/// The range of x inside a convex ring at a y.
fn span(ring: &[Point3<f64>], y: f64) -> Option<[f64; 2]> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..ring.len() {
        let (p, q) = (&ring[i], &ring[(i + 1) % ring.len()]);
        if (p.y <= y) != (q.y <= y) {
            let x = p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y);
            low = low.min(x);
            high = high.max(x);
        }
    }
    (low < high).then_some([low, high])
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
        assert!((area_2d(&core) - 28.0).abs() < 1e-9);
        assert_eq!(span(&core, 3.0), Some([1.0, 8.0]));
        assert!(shrunk(&ring(1.5), 1.0).is_none());
    }
}
