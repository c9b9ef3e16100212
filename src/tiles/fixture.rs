//! A planted house for the tests of tiles.

use nalgebra::{Point3, Vector3};

use crate::base::geometry::Plane;
use crate::base::ids::BuildingId;
use crate::roofs::model::{Facet, RoofModel};
use crate::roofs::solids::close_buildings;

/// A house of 8 x 8 m with a mono-pitch roof, its middle at a place.
pub(crate) fn house([x, y]: [f64; 2]) -> RoofModel {
    let plane = Plane::from_point_normal(&Point3::new(x, y, 6.0), &Vector3::new(-0.3, 0.0, 1.0))
        .expect("a plane");
    let corners = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
    let facet = Facet {
        building: BuildingId(0),
        plane,
        outer: corners.map(|[dx, dy]| plane.lift(x + dx, y + dy)).into(),
        holes: Vec::new(),
        similarity: 0.9,
        real_ratio: 0.8,
        uncertainty: None,
        probability: 1.0,
        lines: Vec::new(),
        half_planes: Vec::new(),
        proposals: Vec::new(),
        obstructions: Vec::new(),
    };
    close_buildings(&[facet], |_| 0.0).0
}
