//! Which views show a facet.

use nalgebra::{Point2, Point3};

use crate::base::ids::ViewId;
use crate::orienting::scene::Scene;
use crate::roofs::model::{Facet, Occluders, RoofModel};

/// Places that are looked at, in a row over the facet.
const PLACES: usize = 6;

/// A view shows a facet of which it shows at least this share.
const LEAST_SHARE: f64 = 0.5;

/// For every facet of a model the views that show at least half of it: inside the image, from
/// above, and not behind another roof.
pub fn views_of_facets(scene: &Scene, model: &RoofModel) -> Vec<Vec<ViewId>> {
    let occluders = Occluders::new(&model.facets);
    let views_of = |facet: &Facet| {
        let places = places_on(facet);
        let shows = |view: &ViewId| {
            let camera = scene.camera(*view);
            let sees = |p: &&Point3<f64>| {
                let in_image = camera.project(p).is_some_and(|q| camera.contains(&q, 0.0));
                let from_above = facet.plane.signed_distance(&camera.center) > 0.0;
                in_image && from_above && !occluders.hide(p, &camera.center)
            };
            let seen = places.iter().filter(sees).count();
            seen > 0 && seen as f64 >= LEAST_SHARE * places.len() as f64
        };
        scene.view_ids().filter(shows).collect()
    };
    crate::base::execution::map(&model.facets, |_, facet| views_of(facet))
}

/// A grid of places on a facet.
fn places_on(facet: &Facet) -> Vec<Point3<f64>> {
    let [low, high] = facet.plan_bounds();
    let at = |i: usize, axis: usize| {
        let share = (i as f64 + 0.5) / PLACES as f64;
        low[axis] + share * (high[axis] - low[axis])
    };
    let grid = (0..PLACES * PLACES).map(|i| Point2::new(at(i % PLACES, 0), at(i / PLACES, 1)));
    grid.filter(|p| facet.covers(p))
        .map(|p| facet.plane.lift(p.x, p.y))
        .collect()
}
