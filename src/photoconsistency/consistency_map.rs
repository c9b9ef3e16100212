//! Intensity similarity of a plane over the complete image set (B99 4.3, verification).
//!
//! B99 verifies a delineated face "by assessing intensity similarity over the complete image set, at
//! corresponding points within the projected delineation". Here every view is warped to the plan by
//! the plane under test, once; centred normalised cross-correlations of small windows over all pairs
//! of views follow from running sums. Two deviations, both against failure on real roofs:
//!
//! * Occlusion: while planes compete nobody knows what hides them, so that at each plan position only the better half of the
//!   pairs counts: one or two views in which something stands in front do not condemn a plane. Once there are facets, all
//!   pairs are asked that see one past the others ([`consistency_map_behind`]).
//! * Weak texture: where the grey values vary no more than the noise, correlation says nothing for or
//!   against; each position carries the weight `s^2 / (s^2 + n^2)` with s the standard deviation
//!   within the window and n that of the noise. It is also about what the views of a true plane correlate
//!   by more than chance, so that as little is asked of them ([`least_correlation`]).

use std::ops::Range;

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::agreement::compare;
use super::plan_grid::{PlanGrid, orthophoto};
use crate::camera::Camera;
use crate::geometry::Plane;
use crate::ids::ViewId;
use crate::scene::Scene;

/// How well the views agree on a plane, at every cell of a plan grid.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ConsistencyMap {
    /// The window of the plan.
    pub grid: PlanGrid,
    /// Correlation in steps of 1 / 127. A scene has hundreds of maps: a byte a value keeps them small.
    pub(crate) correlation: Vec<i8>,
    /// The same of all pairs.
    pub(crate) overall: Vec<i8>,
    /// Weight in steps of 1 / 255.
    pub(crate) weight: Vec<u8>,
    /// The same from the median of the views instead of their mean.
    pub(crate) common_weight: Vec<u8>,
}

impl ConsistencyMap {
    /// Mean of the better half of the pairwise correlations at cell `k` (row by row), -1 to 1; 0 where
    /// the weight is 0.
    pub fn correlation(&self, k: usize) -> f32 {
        f32::from(self.correlation[k]) / 127.0
    }

    /// At every cell the one of some maps of the same grid that the views agree best on, of those that `among` names for its
    /// column and row. `None` without maps.
    pub(crate) fn best_of(
        maps: &[Self],
        among: impl Fn(usize, usize) -> Range<usize>,
    ) -> Option<Self> {
        let mut best = maps.first()?.clone();
        let (width, cells) = (best.grid.width, best.correlation.len());
        for k in 0..cells {
            let named = &maps[among(k % width, k / width)];
            let Some(map) = named.iter().max_by_key(|m| m.correlation[k]) else {
                continue;
            };
            best.correlation[k] = map.correlation[k];
            best.overall[k] = map.overall[k];
            best.weight[k] = map.weight[k];
            best.common_weight[k] = map.common_weight[k];
        }
        Some(best)
    }

    /// Mean of all pairwise correlations, whatever stands in front of the cell in some of the views.
    pub fn overall(&self, k: usize) -> f32 {
        f32::from(self.overall[k]) / 127.0
    }

    /// How much the texture at cell `k` can tell, 0 to 1; 0 where fewer than two views see the window.
    pub fn weight(&self, k: usize) -> f32 {
        f32::from(self.weight[k]) / 255.0
    }

    /// The same for the texture that most views show: what hides the cell in some of them has no say.
    pub fn common_weight(&self, k: usize) -> f32 {
        f32::from(self.common_weight[k]) / 255.0
    }
}

/// What windows that hardly have anything in common correlate by, in the better half of the pairs. Measured: 0.2 to 0.4 on
/// planes a metre beside the true ones.
const CHANCE: f64 = 0.3;

/// The same of all pairs. Measured: 0.1 to 0.3.
const CHANCE_OVERALL: f64 = 0.2;

/// Correlation at which a plane is as good as no plane, for a texture `weight`: `textured` where the texture
/// is strong, chance where there is none.
pub fn least_correlation(weight: f64, textured: f64) -> f64 {
    CHANCE + (textured - CHANCE) * weight
}

/// The same for [`ConsistencyMap::overall`].
pub fn least_overall(weight: f64, textured: f64) -> f64 {
    CHANCE_OVERALL + (textured - CHANCE_OVERALL) * weight
}

/// What keeps two views of one surface from being alike, against the noise of a pixel: besides the noise, the sampling and
/// the shading. Measured on true planes.
const UNLIKE: f64 = 1.25;
/// Most views compared: pairs grow with the square and six views saturate the measure.
pub(crate) const MAX_VIEWS: usize = 6;

/// Compares all views on `plane` over `grid`.
pub fn consistency_map(scene: &Scene, plane: &Plane, grid: &PlanGrid) -> ConsistencyMap {
    let views = views_of_plane(scene, plane, grid);
    let photo = |&v: &ViewId| orthophoto(&scene.view(v).gray, scene.camera(v), plane, grid);
    compare(views.iter().map(photo), unlike(scene, &views), grid)
}

/// The same where something known stands in front of the plane: `hidden` says whether a view sees a point of it.
pub fn consistency_map_behind(
    scene: &Scene,
    plane: &Plane,
    grid: &PlanGrid,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> ConsistencyMap {
    let views = views_of_plane(scene, plane, grid);
    let photo = |&v: &ViewId| {
        let mut photo = orthophoto(&scene.view(v).gray, scene.camera(v), plane, grid);
        for (k, gray) in photo.iter_mut().enumerate() {
            let at = grid.center(k % grid.width, k / grid.width);
            if hidden(v, &plane.lift(at.x, at.y)) {
                *gray = f32::NAN;
            }
        }
        photo
    };
    compare(views.iter().map(photo), unlike(scene, &views), grid)
}

/// Positions along each side of the window at which views are asked whether they see it.
const SAMPLES: usize = 6;

/// The views to compare: at most [`MAX_VIEWS`], such that every part of the window is seen by as many as
/// possible, frontal ones first. Crops of large photographs often show a part only.
fn views_of_plane(scene: &Scene, plane: &Plane, grid: &PlanGrid) -> Vec<ViewId> {
    let candidates: Vec<Candidate> = (scene.view_ids())
        .filter_map(|v| Candidate::new(v, scene.camera(v), plane, grid))
        .collect();
    let mut seen_by = [0u32; SAMPLES * SAMPLES];
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < MAX_VIEWS {
        let best = (0..candidates.len())
            .filter(|i| !chosen.contains(i))
            .map(|i| (candidates[i].gain(&seen_by), i))
            .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let Some((_, best)) = best else { break };
        let sees = candidates[best].sees.iter();
        (seen_by.iter_mut().zip(sees)).for_each(|(n, sees)| *n += u32::from(*sees));
        chosen.push(best);
    }
    chosen.into_iter().map(|i| candidates[i].view).collect()
}

/// A view that sees some of the window.
struct Candidate {
    view: ViewId,
    /// Cosine of the angle between the plane's normal and the direction to the camera.
    toward: f64,
    sees: [bool; SAMPLES * SAMPLES],
}

impl Candidate {
    fn new(view: ViewId, camera: &Camera, plane: &Plane, grid: &PlanGrid) -> Option<Self> {
        let at = |fx: f64, fy: f64| {
            let (x, y) = (fx * grid.width as f64, fy * grid.height as f64);
            plane.lift(grid.origin.x + x * grid.step, grid.origin.y + y * grid.step)
        };
        let middle = at(0.5, 0.5);
        let toward = (camera.center - middle).normalize().dot(&plane.normal);
        let sees = std::array::from_fn(|k| {
            let part = |i: usize| (i as f64 + 0.5) / SAMPLES as f64;
            let p = at(part(k % SAMPLES), part(k / SAMPLES));
            (camera.project(&p)).is_some_and(|x| camera.contains(&x, 1.0))
        });
        // A plane seen at a grazing angle (below 15 degrees) has no usable pixels.
        (toward > 0.26 && sees.contains(&true)).then_some(Self { view, toward, sees })
    }

    /// What the view adds: less where others see the position already.
    fn gain(&self, seen_by: &[u32]) -> f64 {
        let seen = seen_by.iter().zip(&self.sees).filter(|(_, sees)| **sees);
        self.toward * seen.map(|(n, _)| 1.0 / f64::from(1 + n * n)).sum::<f64>()
    }
}

/// Variance by which the grey values of the views differ at random.
fn unlike(scene: &Scene, views: &[ViewId]) -> f32 {
    let sum: f64 = views.iter().map(|v| scene.view(*v).noise).sum();
    let noise = UNLIKE * sum / views.len().max(1) as f64;
    (noise * noise) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn less_is_asked_of_weak_texture() {
        assert_eq!(least_correlation(1.0, 0.45), 0.45);
        assert_eq!(least_correlation(0.0, 0.45), CHANCE);
        assert!(least_correlation(0.3, 0.45) < least_correlation(0.6, 0.45));
    }

    #[test]
    fn the_best_of_the_named_maps_is_taken_with_its_weight() {
        let map = |correlation: [i8; 2], weight: u8| ConsistencyMap {
            grid: PlanGrid {
                origin: nalgebra::Point2::origin(),
                step: 1.0,
                width: 1,
                height: 2,
            },
            correlation: correlation.to_vec(),
            overall: correlation.to_vec(),
            weight: vec![weight; 2],
            common_weight: vec![weight + 1; 2],
        };
        let maps = [map([10, 90], 1), map([60, 20], 3), map([99, 99], 5)];
        let best = ConsistencyMap::best_of(&maps, |_, row| row..2).unwrap();
        assert_eq!(best.correlation, [60, 20]);
        assert_eq!(best.weight, [3, 3]);
        assert_eq!(best.common_weight, [4, 4]);
        let all = ConsistencyMap::best_of(&maps[..2], |_, _| 0..2).unwrap();
        assert_eq!(all.correlation, [60, 90]);
        assert_eq!(all.weight, [3, 1]);
        assert!(ConsistencyMap::best_of(&[], |_, _| 0..0).is_none());
    }
}
