//! Input of the facet stage: the results of the stages before it.

use crate::lines2d::ImageSegment;
use crate::lines3d::Line3d;
use crate::planes::{HalfPlane, ProposedPlane};
use crate::terrain::Ground;

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
    /// Are half-planes and pairs of lines grouped beside them? Not where sets of coplanar lines
    /// are all that there is.
    pub line_pairs: bool,
}
