//! Method "lines": from 3D lines and half-planes to a roof model (B99 4.2, 4.3, figure 24).

use serde::Serialize;

use super::{Ground, RoofModel, SolidTrace, close_buildings};
use crate::halfplane::{FacetTrace, HalfPlane, reconstruct_facets};
use crate::lines2d::ImageSegment;
use crate::lines3d::Line3d;
use crate::params::RoofParams;
use crate::scene::Scene;

/// What happened on the way from half-planes to buildings.
#[derive(Clone, Debug, Default, Serialize)]
pub struct RoofTrace {
    /// Grouping, delineation and verification.
    pub facets: FacetTrace,
    /// Walls and ground.
    pub solids: SolidTrace,
    /// Lines that the model adds to the matched ones (B99 4.2, 4.3).
    pub new_lines: Vec<Line3d>,
}

/// Groups, delineates and verifies facets, estimates the ground below each building and closes the solids.
pub fn reconstruct_roofs(
    scene: &Scene,
    segments: &[Vec<ImageSegment>],
    lines: &[Line3d],
    half_planes: &[HalfPlane],
    params: &RoofParams,
) -> (RoofModel, RoofTrace) {
    let ground = Ground::estimate(scene, lines);
    let (facets, facet_trace) =
        reconstruct_facets(scene, segments, lines, half_planes, &ground, params);
    let (model, solids) = close_buildings(&facets, |members| ground.below(members));
    (
        model,
        RoofTrace {
            facets: facet_trace,
            solids,
            new_lines: Vec::new(),
        },
    )
}
