//! How the views agree on a facet's plane, and how much better than on the same plane moved up and
//! down: the sweep of B99 4.1 over heights instead of angles and over the whole facet at once.
//!
//! Chance correlation depends on the place: on its texture, its shading, its vegetation. The moved
//! plane shows the same place with the same chance correlation, so no threshold is needed: a roof
//! is where the views agree better than above and below it. Pooled over a facet this separates weak
//! texture from none, and a slope between two roofs from a roof.

use nalgebra::{Point2, Point3, Vector2};

use super::interior::{InteriorWindows, interior_map};
use crate::base::evidence::WindowCounts;
use crate::base::geometry::Plane;
use crate::base::ids::ViewId;
use crate::base::math::larger;
use crate::orienting::scene::Scene;
use crate::planes::photoconsistency::{LEAST_SLOPE, PlanGrid};
use crate::roofs::model::Facet;

/// Least parallax between the two views farthest apart by which the plane is moved, cells: half a
/// window. Rendered scenes give the same models from 2 to 2.5.
const PARALLAX: f64 = 2.5;
/// How far the plane is moved, in such steps.
const STEPS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
/// Side of the parts of a facet whose visibility is sampled once, cells: half a window.
const PART: f64 = 2.5;

/// How the views that see a facet agree on its plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct PlaneAgreement {
    /// Margin over the best of some displaced planes, in standard deviations; 0 without windows.
    pub margin_sigmas: f64,
    /// The windows inside it, on its plane and on the displaced ones.
    pub windows: WindowCounts,
}

impl PlaneAgreement {
    /// Measures it. `scene` has pixels about as wide as the samples of cells of `step` metres are
    /// apart, `visibility` tells which views do not see a part of the facet.
    pub(super) fn measure(
        scene: &Scene,
        facet: &Facet,
        step: f64,
        visibility: &PartVisibility,
    ) -> Self {
        // Occluders are those of the facet itself: it must not occlude its own displaced plane.
        let hidden = |view: ViewId, p: &Point3<f64>| visibility.is_hidden(view, &p.xy());
        let map = interior_map(scene, facet, step, &hidden);
        let inside = InteriorWindows::of(facet, &map);
        let places: Vec<Point3<f64>> = (inside.places())
            .map(|p| facet.plane.lift(p.x, p.y))
            .collect();
        let Some(middle) = places.get(places.len() / 2) else {
            return Self::default();
        };
        let shift = PARALLAX * step / largest_slope(scene, middle, &hidden);
        let mut windows = WindowCounts::default();
        inside.count(&map, &mut windows.on);
        let advantages = STEPS.map(|steps| {
            let moved = Facet {
                plane: Plane {
                    d: facet.plane.d - steps * shift * facet.plane.normal.z,
                    ..facet.plane
                },
                ..facet.clone()
            };
            let moved = interior_map(scene, &moved, step, &hidden);
            inside.count(&moved, &mut windows.beside);
            inside.advantage_of(&moved)
        });
        Self {
            margin_sigmas: -advantages.into_iter().fold(f64::NEG_INFINITY, larger),
            windows,
        }
    }
}

/// Visibility of the parts of a facet in each view.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PartVisibility {
    parts: PlanGrid,
    /// By view, then row by row.
    hidden: Vec<Vec<bool>>,
}

impl PartVisibility {
    /// Samples one point of every part, [`PART`] cells wide; `hidden` tells which views do not see
    /// a point.
    pub(crate) fn new(
        scene: &Scene,
        facet: &Facet,
        step: f64,
        hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
    ) -> Self {
        let [min, max] = facet.plan_bounds();
        let parts = PlanGrid::covering(min, max, PART * step);
        let points: Vec<Point3<f64>> = (0..parts.width * parts.height)
            .map(|k| parts.center(k % parts.width, k / parts.width))
            .map(|p| facet.plane.lift(p.x, p.y))
            .collect();
        let by_view = |v: ViewId| points.iter().map(|p| hidden(v, p)).collect();
        Self {
            parts,
            hidden: scene.view_ids().map(by_view).collect(),
        }
    }

    /// Does a view not see the part around a place in plan?
    pub(crate) fn is_hidden(&self, view: ViewId, p: &Point2<f64>) -> bool {
        let part = self.parts.cell(p);
        part.is_some_and(|(c, r)| self.hidden[view.index()][r * self.parts.width + c])
    }
}

/// Largest difference of the slopes (plan over height) of the rays from a point to the views that
/// see it.
pub(crate) fn largest_slope(
    scene: &Scene,
    point: &Point3<f64>,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> f64 {
    let sees = |v: &ViewId| {
        let camera = scene.camera(*v);
        let image = camera.project(point);
        image.is_some_and(|x| camera.contains(&x, 0.0)) && !hidden(*v, point)
    };
    let rays = scene.view_ids().filter(sees);
    let slopes: Vec<Vector2<f64>> = rays
        .map(|v| scene.camera(v).center - point)
        .map(|ray| ray.xy() / ray.z)
        .collect();
    let pairs = (slopes.iter()).flat_map(|a| slopes.iter().map(move |b| (a - b).norm()));
    pairs.fold(LEAST_SLOPE, larger)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::synthetic::gable_scene;
    use crate::roofs::testing;
    use nalgebra::Vector3;

    fn measure(scene: &Scene, facet: &Facet, hidden: bool) -> PlaneAgreement {
        let visibility = PartVisibility::new(scene, facet, 0.2, &|_, _| hidden);
        PlaneAgreement::measure(scene, facet, 0.2, &visibility)
    }

    #[test]
    fn a_roof_stands_out_and_a_plane_beside_it_does_not() {
        let (mut scene, truth) = gable_scene(320);
        let ring = &truth.facets[0].1;
        let raised = |scene: &Scene, by: f64| {
            let ring = ring.iter().map(|p| p + Vector3::z() * by);
            let facet = testing::facet(&ring.collect::<Vec<_>>());
            measure(scene, &facet, false)
        };
        let found = raised(&scene, 0.0);
        assert!(found.margin_sigmas > 3.0, "{found:?}");
        // Farther than the views' rays, whose slopes differ by 0.4 and more, are apart by half a
        // window of cells of 0.2 m.
        for by in [-1.25, 1.25] {
            assert!(raised(&scene, by).margin_sigmas < -3.0, "{by}");
        }
        // Unrelated views give no margin.
        (scene.views.iter_mut().enumerate()).for_each(|(i, v)| v.gray.data.rotate_left(7919 * i));
        let found = raised(&scene, 0.0);
        assert!(found.margin_sigmas < 1.0, "{found:?}");
        let unseen = measure(&scene, &testing::facet(ring), true);
        assert_eq!(unseen, PlaneAgreement::default(), "nobody sees it");
    }
}
