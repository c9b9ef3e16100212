//! Method "lines": from 3D lines and half-planes to a roof model (B99 4.2, 4.3, figure 24).

use nalgebra::Point2;
use serde::Serialize;

use super::{Facet, Ground, RoofModel, SolidTrace, close_buildings};
use crate::halfplane::{FacetTrace, HalfPlane, reconstruct_facets};
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
}

/// Groups, delineates and verifies facets, estimates the ground below each building and closes the solids.
pub fn reconstruct_roofs(
    scene: &Scene,
    lines: &[Line3d],
    half_planes: &[HalfPlane],
    params: &RoofParams,
) -> (RoofModel, RoofTrace) {
    let ground = Ground::estimate(scene, lines);
    let (facets, facet_trace) = reconstruct_facets(scene, lines, half_planes, &ground, params);
    let (model, solids) = close_buildings(&facets, |members| ground_below(&ground, members));
    (model, RoofTrace { facets: facet_trace, solids })
}

/// Ground height around a building: what lies within a few metres of its outline.
fn ground_below(ground: &Ground, members: &[&Facet]) -> f64 {
    /// Width of the ring around the building that shows its ground, metres.
    const RING: f64 = 8.0;
    let corners: Vec<Point2<f64>> = members.iter().flat_map(|f| &f.outer).map(|p| p.xy()).collect();
    let sum = corners.iter().fold(nalgebra::Vector2::zeros(), |s, p| s + p.coords);
    let middle = Point2::from(sum / corners.len().max(1) as f64);
    let radius = corners.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
    ground.z_near(&middle, radius + RING)
}
