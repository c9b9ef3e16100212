//! Input of the facet stage: the results of the stages before it.

use std::sync::Arc;

use nalgebra::Point3;

use crate::base::params::PointCloudParams;
use crate::lines::lines2d::ImageSegment;
use crate::orienting::scene::Scene;
use crate::planes::dense::CloudComparison;
use crate::planes::grouping::GroupedPlanes;
use crate::planes::terrain::Ground;

/// A point cloud in the frame of the images.
#[derive(Clone, Debug)]
pub struct PlacedCloud {
    /// Its points, local frame.
    pub points: Vec<Point3<f64>>,
    /// Standard deviation of its heights, metres.
    pub accuracy_m: f64,
    /// Probability that it belongs to this place.
    pub belongs: f64,
    /// How far its points are believed.
    pub params: PointCloudParams,
}

impl PlacedCloud {
    /// As it was compared with the images; `None` in an instance without the points, of which only
    /// the one that weighs the planes has them.
    pub fn new(
        scene: &Scene,
        compared: &CloudComparison,
        params: &PointCloudParams,
    ) -> Option<Self> {
        Some(Self {
            points: compared.placed(scene.known.point_cloud.as_ref()?),
            accuracy_m: compared.compared.accuracy_m,
            belongs: compared.compared.belongs,
            params: params.clone(),
        })
    }
}

/// Everything that facets are reconstructed from.
#[derive(Clone, Copy, Debug)]
pub struct FacetInput<'a> {
    /// Segments of each view, in the order of the views.
    pub segments: &'a [Vec<ImageSegment>],
    /// Groups of lines, half-planes and proposed planes.
    pub grouped: &'a GroupedPlanes<'a>,
    /// Where the ground is.
    pub ground: &'a Ground,
    /// A point cloud that belongs here.
    pub cloud: Option<&'a Arc<PlacedCloud>>,
}
