//! Which lines lie in a plane, and the plane that fits them (B99 4.2, figure 17).

use nalgebra::Point3;

use super::plane_group::{GroupingInput, Member, PlaneGroup};
use super::proposed_plane::ProposedPlane;
use crate::base::geometry::Plane;
use crate::base::ids::LineId;
use crate::base::math::smaller;
use crate::base::params::RoofParams;
use crate::lines::lines3d::{Line3d, ThetaFrame};

/// Does the line lie in the group's plane as far as the group's plane is known there?
pub(super) fn lies_in_plane(
    input: &GroupingInput,
    group: &PlaneGroup,
    line: LineId,
    params: &RoofParams,
) -> bool {
    let candidate = &input.lines[line.index()];
    let over: Vec<&ProposedPlane> = group.proposed(input).collect();
    [candidate.segment.p0, candidate.segment.p1]
        .iter()
        .all(|p| {
            // The nearest member tells how far the plane has to be extrapolated.
            let reach = group
                .members
                .iter()
                .map(|m| distance_to_segment(p, &input.lines[m.line.index()]))
                .chain(over.iter().map(|r| r.distance(&p.xy())))
                .fold(f64::INFINITY, smaller);
            let sigma_angle = if group.members.len() == 1 {
                group.members[0]
                    .half_plane
                    .map_or(0.0, |h| input.half_planes[h.index()].sigma_theta)
                    .max(MIN_SIGMA_THETA)
            } else {
                MIN_SIGMA_THETA
            };
            let sigma = (candidate.sigma_m * candidate.sigma_m
                + reach * sigma_angle * reach * sigma_angle)
                .sqrt();
            let tolerance =
                (3.0 * sigma).clamp(params.coplanar_distance_m, 3.0 * params.coplanar_distance_m);
            reach <= params.max_facet_depth_m && group.plane.signed_distance(p).abs() <= tolerance
        })
}

/// After the regression every member must still lie in the plane.
pub(super) fn all_lie_in(
    input: &GroupingInput,
    plane: &Plane,
    members: &[Member],
    params: &RoofParams,
) -> bool {
    members.iter().all(|m| {
        let line = &input.lines[m.line.index()];
        let tolerance = (3.0 * line.sigma_m)
            .clamp(params.coplanar_distance_m, 2.0 * params.coplanar_distance_m);
        plane.signed_distance(&line.segment.p0).abs() <= tolerance
            && plane.signed_distance(&line.segment.p1).abs() <= tolerance
            && m.half_plane.is_none_or(|h| {
                input.half_planes[h.index()].plane.angle_to(plane)
                    < 1.5 * params.coplanar_angle_deg.to_radians()
            })
    })
}

/// Least standard deviation of theta that is credible, radians: B99 4.4 reports 2 degrees on
/// textured roofs.
const MIN_SIGMA_THETA: f64 = 1.5 * std::f64::consts::PI / 180.0;
/// Least standard deviation of a line that is credible, metres: edges are blurred, gutters have a
/// width.
const MIN_SIGMA_LINE: f64 = 0.03;
/// Distance from the line at which a half-plane's angle enters the regression, metres.
const ANGLE_ARM: f64 = 2.0;

/// Orthogonal regression to samples of all lines and to the half-planes' angles (figure 17).
pub(super) fn fit_plane(input: &GroupingInput, members: &[Member]) -> Option<Plane> {
    let mut points = Vec::new();
    for member in members {
        let line = &input.lines[member.line.index()];
        let sigma = line.sigma_m.max(MIN_SIGMA_LINE);
        let samples = (line.segment.length() as usize).clamp(2, 50);
        for i in 0..=samples {
            points.push((line.at(i as f64 / samples as f64), 1.0 / (sigma * sigma)));
        }
        if let Some(h) = member.half_plane {
            let half_plane = &input.half_planes[h.index()];
            if let Some(frame) = ThetaFrame::new(&line.segment, half_plane.side) {
                let sigma = ANGLE_ARM * half_plane.sigma_theta.max(MIN_SIGMA_THETA);
                let away = frame.away(half_plane.theta) * ANGLE_ARM;
                points.push((line.at(0.25) + away, 1.0 / (sigma * sigma)));
                points.push((line.at(0.75) + away, 1.0 / (sigma * sigma)));
            }
        }
    }
    Plane::fit(&points).filter(|p| p.normal.z > 0.1)
}

fn distance_to_segment(p: &Point3<f64>, line: &Line3d) -> f64 {
    let (a, b) = (line.segment.p0, line.segment.p1);
    let d = b - a;
    let t = ((p - a).dot(&d) / d.norm_squared().max(1e-12)).clamp(0.0, 1.0);
    (p - (a + d * t)).norm()
}
