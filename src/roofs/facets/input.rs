//! Input of the facet stage: the results of the stages before it.

use std::sync::Arc;

use nalgebra::Point3;

use crate::base::params::PointCloudParams;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::Line3d;
use crate::planes::grouping::ProposedPlane;
use crate::planes::half_planes::HalfPlane;
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

/// Everything that facets are reconstructed from.
#[derive(Clone, Copy, Debug)]
pub struct FacetInput<'a> {
    /// Segments of each view, in the order of the views.
    pub segments: &'a [Vec<ImageSegment>],
    /// 3D lines.
    pub lines: &'a [Line3d],
    /// Half-planes at them.
    pub half_planes: &'a [HalfPlane],
    /// Where the ground is.
    pub ground: &'a Ground,
    /// Planes that other sources propose.
    pub proposals: &'a [ProposedPlane],
    /// A point cloud that belongs here.
    pub cloud: Option<&'a Arc<PlacedCloud>>,
    /// Are half-planes and pairs of lines grouped beside them? Not where sets of coplanar lines
    /// are all that there is.
    pub line_pairs: bool,
}
