//! Small roofs for the tests of refinement.

use nalgebra::{Point3, Vector3};

use crate::geometry::Plane;
use crate::ids::BuildingId;
use crate::roof::Facet;

/// A facet over a ring of corners that lie in one plane.
pub fn facet(ring: &[Point3<f64>]) -> Facet {
    let normal = (0..ring.len()).fold(Vector3::zeros(), |sum, i| {
        let (p, q) = (ring[i] - ring[0], ring[(i + 1) % ring.len()] - ring[0]);
        sum + p.cross(&q)
    });
    Facet {
        building: BuildingId(0),
        plane: Plane::from_point_normal(&ring[0], &normal).expect("an area"),
        outer: ring.to_vec(),
        holes: Vec::new(),
        similarity: 0.0,
        real_ratio: 0.0,
        lines: Vec::new(),
        half_planes: Vec::new(),
        rectangles: Vec::new(),
    }
}

/// A gable roof, 12 m long in x and 8 m wide: eaves at 6 m, ridge at 9 m, above y = 0.
pub fn gable() -> Vec<Facet> {
    let ring = |corners: [[f64; 3]; 4]| facet(&corners.map(Point3::from));
    vec![
        ring([
            [-6.0, -4.0, 6.0],
            [6.0, -4.0, 6.0],
            [6.0, 0.0, 9.0],
            [-6.0, 0.0, 9.0],
        ]),
        ring([
            [-6.0, 0.0, 9.0],
            [6.0, 0.0, 9.0],
            [6.0, 4.0, 6.0],
            [-6.0, 4.0, 6.0],
        ]),
    ]
}

/// References to all facets.
pub fn facets_of(facets: &[Facet]) -> Vec<&Facet> {
    facets.iter().collect()
}
