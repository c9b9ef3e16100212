//! How a facet stands out from its plane moved up and down: the sweep of B99 4.1 once more, of heights instead of angles,
//! and over the whole facet at once.
//!
//! What views correlate by chance depends on the place: on its texture, its shading, what grows there. The moved plane shows the same place with
//! the same chances, so that no limit need be known: a roof is where the views agree better than above and below it. Pooled
//! over a facet this tells weak texture from none, and a slope between two roofs from a roof.

use nalgebra::{Point2, Point3, Vector2};

use super::interior::{Inside, bounds, map_inside};
use super::plan::PlanGrid;
use crate::geometry::Plane;
use crate::ids::ViewId;
use crate::math::larger;
use crate::roof::Facet;
use crate::scene::Scene;

/// Least parallax between the two views farthest apart by which the plane is moved, cells: half a window. Rendered scenes give the same models
/// from 4 to 5.
const PARALLAX: f64 = 5.0;
/// How far the plane is moved, in such steps.
const STEPS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
/// Side of the parts of a facet that are seen or not as a whole, cells: half a window.
const PART: f64 = 5.0;
/// Least difference of two rays' slopes for a parallax. Assumption: that of neighbours in a strip of normal-angle photographs is 0.3.
const LEAST_SLOPE: f64 = 0.1;

/// By how many standard deviations the views agree better on the facet's plane than on the one of some moved ones that they agree on best, inside the facet. The planes are
/// moved by `least_m` metres or more. `scene` has pixels about `step` (metres) wide, `hidden` says which views do not see a point of the facet.
/// Zero where no window tells.
pub fn prominence(
    scene: &Scene,
    facet: &Facet,
    step: f64,
    least_m: f64,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> f64 {
    let sight = Sight::new(scene, facet, step, hidden);
    // What stands in front of the facet does so of the moved one, and the facet itself is in nobody's way.
    let hidden = |view: ViewId, p: &Point3<f64>| sight.is_hidden(view, &p.xy());
    let map = map_inside(scene, facet, step, &hidden);
    let inside = Inside::of(facet, &map);
    let places: Vec<Point3<f64>> = (inside.places())
        .map(|p| facet.plane.lift(p.x, p.y))
        .collect();
    let Some(middle) = places.get(places.len() / 2) else {
        return 0.0;
    };
    let shift = larger(
        PARALLAX * step / largest_slope(scene, middle, &hidden),
        least_m,
    );
    let behind = STEPS.map(|steps| {
        let moved = Facet {
            plane: Plane {
                d: facet.plane.d - steps * shift * facet.plane.normal.z,
                ..facet.plane
            },
            ..facet.clone()
        };
        inside.advantage_of(&map_inside(scene, &moved, step, &hidden))
    });
    -behind.into_iter().fold(f64::NEG_INFINITY, larger)
}

/// Which views do not see the parts of a facet.
struct Sight {
    parts: PlanGrid,
    /// By view, then row by row.
    hidden: Vec<Vec<bool>>,
}

impl Sight {
    /// Asks for one point of every part, [`PART`] cells wide.
    fn new(
        scene: &Scene,
        facet: &Facet,
        step: f64,
        hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
    ) -> Self {
        let (min, max) = bounds(facet);
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

    fn is_hidden(&self, view: ViewId, p: &Point2<f64>) -> bool {
        let part = self.parts.cell(p);
        part.is_some_and(|(c, r)| self.hidden[view.index()][r * self.parts.width + c])
    }
}

/// Largest difference of the slopes (plan over height) of the rays from a point to the views that see it.
fn largest_slope(
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
    use crate::synthetic::gable_scene;
    use crate::testing;
    use nalgebra::Vector3;

    #[test]
    fn a_roof_stands_out_and_a_plane_beside_it_does_not() {
        let (mut scene, truth) = gable_scene(320);
        let ring = &truth.facets[0].1;
        let raised = |scene: &Scene, by: f64| {
            let ring = ring.iter().map(|p| p + Vector3::z() * by);
            let facet = testing::facet(&ring.collect::<Vec<_>>());
            prominence(scene, &facet, 0.1, 0.0, &|_, _| false)
        };
        let unit = 0.1 / 0.4;
        assert!(raised(&scene, 0.0) > 3.0);
        for by in [-5.0 * unit, 5.0 * unit] {
            assert!(raised(&scene, by) < -3.0, "{by}");
        }
        // Views of something else have nothing to say.
        (scene.views.iter_mut().enumerate()).for_each(|(i, v)| v.gray.data.rotate_left(7919 * i));
        assert!(raised(&scene, 0.0) < 1.0);
        assert_eq!(
            prominence(&scene, &testing::facet(ring), 0.1, 0.0, &|_, _| true),
            0.0,
            "nobody sees it"
        );
    }
}
