//! Intensity similarity of a plane over the complete image set (B99 4.3, verification).
//!
//! B99 verifies a delineated face "by assessing intensity similarity over the complete image set,
//! at corresponding points within the projected delineation". Here every view is warped to the plan
//! by the plane under test, once; centred normalised cross-correlations of small windows over all
//! pairs of views follow from running sums. Two deviations, both against failure on real roofs:
//!
//! * Occlusion: while planes compete their occluders are unknown, so only the better half of the
//!   pairs counts at each plan position: one or two occluded views do not reject a plane. Once
//!   there are facets, all pairs of views that see one past the others count
//!   ([`consistency_map_behind`]).
//! * Weak texture: where the grey values vary no more than the noise, correlation is no evidence
//!   for or against; each position carries the weight `s^2 / (s^2 + n^2)` with s the standard
//!   deviation within the window and n that of the noise. It is also about what the views of a true
//!   plane correlate by beyond chance; what a correlation says at a weight is a fitted table
//!   ([`crate::base::evidence`]).

use nalgebra::{Point2, Point3, Vector2};

use super::box_sum::{HALF_WINDOW, WINDOW};
use super::consistency_map::{ConsistencyMap, MAX_VIEWS};
use super::pairwise_correlation::correlate_views;
use super::plan_grid::{PlanGrid, SampledCells, SurfaceHeights, orthophoto};
use crate::base::geometry::Plane;
use crate::base::ids::ViewId;
use crate::base::math::smaller;
use crate::orienting::scene::Scene;
use crate::photographs::camera::Camera;

/// Standard deviation between two views of one surface over that of the pixel noise: sampling and
/// shading add to the noise. Measured on true planes.
const RESIDUAL_NOISE: f64 = 1.25;

/// Compares all views on `plane` over `grid`.
pub(crate) fn consistency_map(scene: &Scene, plane: &Plane, grid: &PlanGrid) -> ConsistencyMap {
    compared(scene, plane, grid, &|v, part| {
        orthophoto(&scene.view(v).gray, scene.camera(v), plane, part)
    })
}

/// The same on a surface near `plane`: `z` gives its height over a plan position, metres.
pub(crate) fn consistency_map_of_surface(
    scene: &Scene,
    plane: &Plane,
    z: &dyn Fn(&Point2<f64>) -> f64,
    grid: &PlanGrid,
) -> ConsistencyMap {
    let heights = SurfaceHeights::new(z, grid);
    compared(scene, plane, grid, &|v, part| {
        heights.orthophoto(&scene.view(v).gray, scene.camera(v), part)
    })
}

/// The same on a plane with known occluders: `hidden` tells whether a point of the plane is
/// occluded in a view.
pub(crate) fn consistency_map_behind(
    scene: &Scene,
    plane: &Plane,
    grid: &PlanGrid,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> ConsistencyMap {
    compared(scene, plane, grid, &|v, part| {
        let mut photo = orthophoto(&scene.view(v).gray, scene.camera(v), plane, part);
        for k in 0..part.width * part.height {
            let at = part.center(k % part.width, k / part.width);
            if hidden(v, &plane.lift(at.x, at.y)) {
                photo.iter_mut().for_each(|samples| samples[k] = f32::NAN);
            }
        }
        photo
    })
}

/// Compares the orthophotos of the views that see most of a window. Where there are more than are
/// compared and each shows a part of the window only, its halves are compared by views of their
/// own.
fn compared(
    scene: &Scene,
    plane: &Plane,
    grid: &PlanGrid,
    orthophoto: &dyn Fn(ViewId, &PlanGrid) -> SampledCells,
) -> ConsistencyMap {
    let ViewsOfPlane { views, suffice } = views_of_plane(scene, plane, grid);
    let halves = if suffice { None } else { halves(grid) };
    let Some(halves) = halves else {
        let variance = residual_variance(scene, &views);
        return correlate_views(views.iter().map(|v| orthophoto(*v, grid)), variance, grid);
    };
    let mut map = ConsistencyMap::unseen(grid);
    for half in halves {
        // Windows around the cells beside the cut reach beyond it.
        let around = half.widened(HALF_WINDOW, grid);
        map.copy(&compared(scene, plane, &around, orthophoto), &half);
    }
    map
}

/// Least side of a part that is compared by itself, cells: a few windows, of which those beside
/// the cuts are compared twice.
const LEAST_PART: usize = 5 * WINDOW;

/// The two halves of a window across its longer side; `None` where it is small.
fn halves(grid: &PlanGrid) -> Option<[PlanGrid; 2]> {
    let side = grid.width.max(grid.height);
    let at = side / 2;
    let cut = |columns: std::ops::Range<usize>, rows| grid.part(columns, rows);
    (side >= 2 * LEAST_PART).then(|| match grid.width >= grid.height {
        true => [cut(0..at, 0..grid.height), cut(at..side, 0..grid.height)],
        false => [cut(0..grid.width, 0..at), cut(0..grid.width, at..side)],
    })
}

/// Positions along each side of the window at which the visibility is sampled.
const SAMPLES: usize = 6;

/// Least difference of two rays' slopes for a parallax. Assumption: that of neighbours in a strip
/// of normal-angle photographs is 0.3.
pub(crate) const LEAST_SLOPE: f64 = 0.1;

/// How much of a parallax a view has with those that are chosen, 0 to 1, by the slopes of their
/// rays: photographs from one place agree about every plane.
pub(super) fn share_of_parallax<'a>(
    slope: &Vector2<f64>,
    chosen: impl Iterator<Item = &'a Vector2<f64>>,
) -> f64 {
    let apart = chosen.map(|other| (slope - other).norm());
    apart.fold(LEAST_SLOPE, smaller) / LEAST_SLOPE
}

/// The views to compare.
struct ViewsOfPlane {
    views: Vec<ViewId>,
    /// These are all that see the window, or see all of it.
    suffice: bool,
}

/// At most [`MAX_VIEWS`], such that every part of the window is seen by as many as possible,
/// frontal ones first. Crops of large photographs often show a part only.
fn views_of_plane(scene: &Scene, plane: &Plane, grid: &PlanGrid) -> ViewsOfPlane {
    let candidates: Vec<CandidateView> = (scene.view_ids())
        .filter_map(|v| CandidateView::new(v, scene.camera(v), plane, grid))
        .collect();
    let apart = |i: usize, chosen: &[usize]| {
        share_of_parallax(
            &candidates[i].slope,
            chosen.iter().map(|&c| &candidates[c].slope),
        )
    };
    let mut seen_by = [0u32; SAMPLES * SAMPLES];
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < MAX_VIEWS {
        let best = (0..candidates.len())
            .filter(|i| !chosen.contains(i))
            .map(|i| (candidates[i].gain(&seen_by) * apart(i, &chosen), i))
            .filter(|(gain, _)| *gain > 0.0)
            .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let Some((_, best)) = best else { break };
        let sees = candidates[best].sees.iter();
        (seen_by.iter_mut().zip(sees)).for_each(|(n, sees)| *n += u32::from(*sees));
        chosen.push(best);
    }
    let sees_all = |i: &usize| !candidates[*i].sees.contains(&false);
    let are_all = chosen.len() < MAX_VIEWS || chosen.len() == candidates.len();
    ViewsOfPlane {
        suffice: are_all || chosen.iter().all(sees_all),
        views: chosen.into_iter().map(|i| candidates[i].view).collect(),
    }
}

/// A view that sees part of the window.
struct CandidateView {
    view: ViewId,
    /// Cosine of the angle between the plane's normal and the direction to the camera.
    cosine: f64,
    /// That of the ray from the middle of the window, plan over height.
    slope: Vector2<f64>,
    sees: [bool; SAMPLES * SAMPLES],
}

impl CandidateView {
    fn new(view: ViewId, camera: &Camera, plane: &Plane, grid: &PlanGrid) -> Option<Self> {
        let at = |fx: f64, fy: f64| {
            let (x, y) = (fx * grid.width as f64, fy * grid.height as f64);
            plane.lift(grid.origin.x + x * grid.step, grid.origin.y + y * grid.step)
        };
        let middle = at(0.5, 0.5);
        let ray = camera.center - middle;
        let cosine = ray.normalize().dot(&plane.normal);
        let sees = std::array::from_fn(|k| {
            let part = |i: usize| (i as f64 + 0.5) / SAMPLES as f64;
            let p = at(part(k % SAMPLES), part(k / SAMPLES));
            (camera.project(&p)).is_some_and(|x| camera.contains(&x, 1.0))
        });
        // A plane seen at a grazing angle (below 15 degrees) has no usable pixels.
        (cosine > 0.26 && sees.contains(&true)).then_some(Self {
            view,
            cosine,
            slope: ray.xy() / ray.z,
            sees,
        })
    }

    /// The gain in coverage: less where others see the position already.
    fn gain(&self, seen_by: &[u32]) -> f64 {
        let seen = seen_by.iter().zip(&self.sees).filter(|(_, sees)| **sees);
        self.cosine * seen.map(|(n, _)| 1.0 / f64::from(1 + n * n)).sum::<f64>()
    }
}

/// Variance of the grey values of one surface point between views.
pub(crate) fn residual_variance(scene: &Scene, views: &[ViewId]) -> f32 {
    let sum: f64 = views.iter().map(|v| scene.view(*v).noise).sum();
    let noise = RESIDUAL_NOISE * sum / views.len().max(1) as f64;
    (noise * noise) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::rendered_planes::{level_ground, strip};

    #[test]
    fn a_window_that_each_view_shows_a_part_of_is_compared_everywhere() {
        let ground = level_ground();
        let plane = ground.plane;
        // Every place of it is seen by two or three of ten views, 25 m by 25 m each.
        let scene = strip(&[ground]);
        let grid = PlanGrid::covering(Point2::new(-40.0, -3.0), Point2::new(40.0, 3.0), 0.4);
        let agrees_at = |plane: &Plane| {
            let map = consistency_map(&scene, plane, &grid);
            let inside = |k: &usize| {
                let (column, row) = (k % grid.width, k / grid.width);
                let within =
                    |at: usize, size: usize| (HALF_WINDOW..size - HALF_WINDOW).contains(&at);
                within(column, grid.width) && within(row, grid.height)
            };
            let cells: Vec<usize> = (0..grid.width * grid.height).filter(inside).collect();
            assert!(cells.iter().all(|k| map.weight(*k) > 0.0), "unseen");
            let agree = cells.iter().filter(|k| map.correlation(**k) > 0.8).count();
            agree as f64 / cells.len() as f64
        };
        assert!(agrees_at(&plane) > 0.98);
        assert!(agrees_at(&Plane { d: -3.0, ..plane }) < 0.05);
    }

    #[test]
    fn photographs_from_one_place_count_once() {
        let ground = level_ground();
        let plane = ground.plane;
        let mut scene = strip(&[ground]);
        let grid = PlanGrid::covering(Point2::new(-3.0, -3.0), Point2::new(3.0, 3.0), 0.4);
        let views = |scene: &Scene| views_of_plane(scene, &plane, &grid).views;
        let before = views(&scene);
        // Each twice, as a drone that hovers takes them.
        let repeated = scene.views.clone();
        scene.views.extend(repeated);
        assert_eq!(views(&scene), before);
    }

    #[test]
    fn halves_hold_every_cell_once() {
        let grid = PlanGrid::covering(Point2::new(3.0, -7.0), Point2::new(33.0, 8.0), 0.2);
        let [left, right] = halves(&grid).expect("it is large");
        assert_eq!(left.width + right.width, grid.width);
        assert_eq!([left.height, right.height], [grid.height; 2]);
        assert_eq!(right.offset_in(&grid), (left.width as isize, 0));
        let around = right.widened(HALF_WINDOW, &grid);
        assert_eq!(
            around.width,
            right.width + HALF_WINDOW,
            "no farther than the whole"
        );
        let small = PlanGrid::covering(Point2::origin(), Point2::new(9.0, 9.0), 0.2);
        assert!(halves(&small).is_none());
    }
}
