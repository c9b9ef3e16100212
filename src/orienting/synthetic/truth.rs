//! What is known of a synthetic scene.

use nalgebra::Point3;

use crate::base::geometry::{Plane, Segment3};

/// What a reconstruction of a synthetic scene should find. Local frame, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntheticTruth {
    /// Ridges, hips, valleys, eaves and rakes, each once.
    pub edges: Vec<Segment3>,
    /// The roof facets with their overhangs: plane with its normal upwards, and outer ring,
    /// counter-clockwise seen from above.
    pub facets: Vec<(Plane, Vec<Point3<f64>>)>,
    /// Height of the ground.
    pub ground_z: f64,
}
