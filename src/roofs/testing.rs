//! For tests: reproducible random numbers, facets and lines.

use nalgebra::{Matrix3, Point3};

use crate::base::geometry::{Plane, Segment3, vector_area};
use crate::base::ids::BuildingId;
use crate::lines::lines3d::Line3d;
use crate::roofs::model::Facet;

/// Uniformly distributed from 0 to 1: a linear congruential generator (Numerical Recipes 7.1), its
/// upper 24 bits.
pub(crate) fn uniform(seed: u32) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1u32 << 24)
    }
}

/// A facet over a ring of corners that lie in one plane.
pub(crate) fn facet(ring: &[Point3<f64>]) -> Facet {
    let normal = vector_area(ring.iter().copied());
    Facet {
        building: BuildingId(0),
        plane: Plane::from_point_normal(&ring[0], &normal).expect("an area"),
        outer: ring.to_vec(),
        holes: Vec::new(),
        similarity: 0.0,
        real_ratio: 0.0,
        uncertainty: None,
        probability: 1.0,
        lines: Vec::new(),
        half_planes: Vec::new(),
        proposals: Vec::new(),
        obstructions: Vec::new(),
    }
}

/// A line in space of which nothing else is known.
pub(crate) fn line(p0: Point3<f64>, p1: Point3<f64>) -> Line3d {
    Line3d {
        origin: Default::default(),
        segment: Segment3::new(p0, p1),
        sigma_m: 0.01,
        covariance: [Matrix3::zeros(); 2],
        probability: 1.0,
        supports: Vec::new(),
        contradiction: None,
    }
}
