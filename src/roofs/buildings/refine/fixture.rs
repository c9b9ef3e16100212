//! Small roofs for the tests of refinement.

use nalgebra::Point3;

use crate::roofs::model::Facet;
pub(crate) use crate::roofs::testing::facet;

/// A gable roof, 12 m long in x and 8 m wide: eaves at 6 m, ridge at 9 m, above y = 0.
pub(crate) fn gable() -> Vec<Facet> {
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
pub(crate) fn facets_of(facets: &[Facet]) -> Vec<&Facet> {
    facets.iter().collect()
}
