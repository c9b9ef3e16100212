//! Photo-consistency of a plane in a single window: what the map of the plane has at one cell,
//! for searches over planes that differ from place to place.

use nalgebra::{Matrix3, Point2, Point3, Vector2};
use wide::f32x8;

use super::box_sum::WINDOW;
use super::consistency_map::MAX_VIEWS;
use super::pairwise_correlation::LEAST_VARIANCE;
use super::plan_grid::{CELL_SAMPLES, image_from_plan};
use super::plane_consistency::{residual_variance, share_of_parallax};
use crate::base::geometry::Plane;
use crate::base::ids::ViewId;
use crate::base::math::larger;
use crate::orienting::scene::Scene;

/// Samples along a side of a window.
const SIDE: usize = WINDOW * CELL_SAMPLES;
/// Samples of a window.
const POSITIONS: usize = SIDE * SIDE;
/// The same in whole registers of eight.
const REGISTERS: usize = POSITIONS.div_ceil(8);

/// How well the views agree in a window on a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Agreement {
    /// Mean of the better half of the pairwise correlations, -1 to 1.
    pub correlation: f32,
    /// Texture weight, 0 to 1.
    pub weight: f32,
}

/// Compares views in windows of the plan, of [`WINDOW`] cells a side.
pub(crate) struct WindowMatcher<'s> {
    /// Its pixels are about as far apart as samples.
    scene: &'s Scene,
    /// Cell size, metres.
    step: f64,
    /// Columns and rows of the samples from the middle of the window, cells, and 1 where there is
    /// one.
    positions: [[f32x8; 3]; REGISTERS],
}

impl<'s> WindowMatcher<'s> {
    /// Windows of cells of `step` metres.
    pub(crate) fn new(scene: &'s Scene, step: f64) -> Self {
        let at = |k: usize| {
            let place = |i: usize| ((i as f32 + 0.5) - 0.5 * SIDE as f32) / CELL_SAMPLES as f32;
            match k < POSITIONS {
                true => [place(k % SIDE), place(k / SIDE), 1.0],
                false => [0.0; 3],
            }
        };
        let positions = std::array::from_fn(|register| {
            let lanes: [[f32; 3]; 8] = std::array::from_fn(|lane| at(8 * register + lane));
            [0, 1, 2].map(|i| f32x8::from(lanes.map(|p| p[i])))
        });
        Self {
            scene,
            step,
            positions,
        }
    }

    /// The views that show all of a window around a point, the steepest first: at most
    /// [`MAX_VIEWS`], one of those from one place.
    pub(crate) fn views_of(&self, middle: &Point3<f64>) -> Vec<ViewId> {
        let ray = |v: ViewId| {
            let camera = self.scene.camera(v);
            let margin = WINDOW as f64 * self.step / camera.ground_pixel(middle);
            let at = camera.project(middle)?;
            let ray = (camera.center - middle).normalize();
            (camera.contains(&at, margin)).then(|| (v, ray.z, ray.xy() / ray.z))
        };
        let rays: Vec<(ViewId, f64, Vector2<f64>)> =
            self.scene.view_ids().filter_map(ray).collect();
        let mut chosen: Vec<(ViewId, Vector2<f64>)> = Vec::new();
        while chosen.len() < MAX_VIEWS {
            let gain = |(v, steepness, slope): &(ViewId, f64, Vector2<f64>)| {
                let parallax = share_of_parallax(slope, chosen.iter().map(|c| &c.1));
                (*v, *slope, steepness * parallax)
            };
            let best = (rays.iter().map(gain))
                .filter(|(.., gain)| *gain > 0.0)
                .max_by(|a, b| a.2.total_cmp(&b.2).then(b.0.cmp(&a.0)));
            let Some((view, slope, _)) = best else { break };
            chosen.push((view, slope));
        }
        chosen.into_iter().map(|(v, _)| v).collect()
    }

    /// The agreement of some views on a plane around a place; `None` where fewer than two see it.
    pub(crate) fn agreement(
        &self,
        views: &[ViewId],
        plane: &Plane,
        middle: &Point2<f64>,
    ) -> Option<Agreement> {
        let mut windows: Vec<NormalisedWindow> = Vec::with_capacity(MAX_VIEWS);
        let seen = views.iter().filter_map(|v| self.window(*v, plane, middle));
        windows.extend(seen);
        let mut correlations = [0.0f32; MAX_VIEWS * (MAX_VIEWS - 1) / 2];
        let mut pairs = 0;
        for (i, a) in windows.iter().enumerate() {
            for b in &windows[i + 1..] {
                correlations[pairs] = a.correlation(b);
                pairs += 1;
            }
        }
        if pairs == 0 {
            return None;
        }
        let correlations = &mut correlations[..pairs];
        correlations.sort_unstable_by(|a, b| b.total_cmp(a));
        let better = &correlations[..pairs.div_ceil(2)];
        let variance = windows.iter().map(|w| w.variance).sum::<f32>() / windows.len() as f32;
        Some(Agreement {
            correlation: better.iter().sum::<f32>() / better.len() as f32,
            weight: variance / (variance + residual_variance(self.scene, views)),
        })
    }

    /// A view in the window; `None` where it does not show all of it.
    fn window(
        &self,
        view: ViewId,
        plane: &Plane,
        middle: &Point2<f64>,
    ) -> Option<NormalisedWindow> {
        let plan_from_window = Matrix3::new(
            self.step, 0.0, middle.x, 0.0, self.step, middle.y, 0.0, 0.0, 1.0,
        );
        let h = image_from_plan(self.scene.camera(view), plane) * plan_from_window;
        let h = h.map(|x| f32x8::splat((x / h[(2, 2)]) as f32));
        let gray = &self.scene.view(view).gray;
        let mut window = [f32x8::ZERO; REGISTERS];
        let mut sum = f32x8::ZERO;
        for (values, [x, y, is_one]) in window.iter_mut().zip(&self.positions) {
            let across = |row: usize| h[(row, 0)] * *x + h[(row, 1)] * *y + h[(row, 2)];
            let depth = across(2);
            let at = [across(0) / depth, across(1) / depth].map(|v| v.to_array());
            *values = gray.sample_eight(at[0], at[1]) * *is_one;
            sum += *values;
        }
        let sum = total(sum);
        // Samples outside the image are not numbers.
        if sum.is_nan() {
            return None;
        }
        let mean = f32x8::splat(sum / POSITIONS as f32);
        let mut squares = f32x8::ZERO;
        for (values, [.., is_one]) in window.iter_mut().zip(&self.positions) {
            *values = (*values - mean) * *is_one;
            squares += *values * *values;
        }
        let variance = total(squares) / POSITIONS as f32;
        Some(NormalisedWindow {
            values: window,
            variance,
            inverse_deviation: 1.0 / larger(variance, LEAST_VARIANCE).sqrt(),
        })
    }
}

/// The sum of a register, in the same order on every target.
fn total(register: f32x8) -> f32 {
    register.to_array().iter().sum()
}

/// A view in a window.
struct NormalisedWindow {
    /// Less their mean.
    values: [f32x8; REGISTERS],
    variance: f32,
    inverse_deviation: f32,
}

impl NormalisedWindow {
    /// Centred normalised cross-correlation.
    fn correlation(&self, other: &Self) -> f32 {
        let products = self.values.iter().zip(&other.values);
        let sum = products.fold(f32x8::ZERO, |sum, (a, b)| sum + *a * *b);
        let r = total(sum) / POSITIONS as f32;
        (r * self.inverse_deviation * other.inverse_deviation).clamp(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::photoconsistency::{PlanGrid, consistency_map};
    use crate::planes::rendered_planes::{TexturedPlane, scene};
    use nalgebra::Vector3;

    #[test]
    fn a_window_has_what_the_map_of_its_plane_has() {
        let slope = Vector3::new(-0.2, 0.1, 1.0);
        let plane = Plane::from_point_normal(&Point3::new(0.0, 0.0, 5.0), &slope).unwrap();
        let roof = TexturedPlane {
            plane,
            exists: |_, _| true,
            texture: 0.3,
        };
        let scene = scene(&[roof]);
        let step = 0.2;
        let grid = PlanGrid::covering(Point2::new(-2.0, -2.0), Point2::new(2.0, 2.0), step);
        let matcher = WindowMatcher::new(&scene, step);
        for lift in [0.0, 0.4] {
            let lifted = Plane {
                d: plane.d - lift,
                ..plane
            };
            let map = consistency_map(&scene, &lifted, &grid);
            let (column, row) = (8, 11);
            let k = row * grid.width + column;
            let middle = grid.center(column, row);
            let views = matcher.views_of(&lifted.lift(middle.x, middle.y));
            let found = matcher.agreement(&views, &lifted, &middle).unwrap();
            assert!(
                (found.correlation - map.correlation(k)).abs() < 0.02,
                "{found:?}"
            );
            assert!((found.weight - map.weight(k)).abs() < 0.01, "{found:?}");
            assert_eq!(found.correlation > 0.9, lift == 0.0, "{found:?}");
        }
        let far = Point2::new(1e3, 0.0);
        assert!(matcher.views_of(&plane.lift(far.x, far.y)).is_empty());
        let views: Vec<ViewId> = scene.view_ids().collect();
        assert!(matcher.agreement(&views, &plane, &far).is_none());
    }
}
