//! Planes fitted to the points of a cloud that agree with them, before borders are sought.
//!
//! A group has the plane of its lines, as far apart and as certain as these are: a short one errs
//! by degrees, and a flat roof comes in as many planes as it has such lines. Where a cloud tells
//! the heights between them, the plane is fitted to all that speak for it and to the ends of its
//! lines, with Cauchy's loss, for chimneys and dormers are no part of it. What is found competes
//! with the plane that it was found from, which may be that of a smaller face.

use nalgebra::{Matrix1x3, Point2, Point3, Vector1, Vector3};

use super::dominated::{SupportedPlane, columns_apart};
use super::point_cloud::{CloudEvidence, SurfaceHeight};
use crate::base::execution::map;
use crate::base::geometry::Plane;
use crate::base::least_squares::{Loss, NormalEquations, Stop, fit};
use crate::base::math::hypot;
use crate::base::params::RoofParams;
use crate::planes::grouping::{GroupingInput, PlaneGroup};
use crate::planes::half_planes::is_wall;
use crate::planes::photoconsistency::PlanGrid;

/// The groups in the planes that fit the points of a cloud best.
pub(super) fn refitted_groups(
    planes: &[SupportedPlane],
    cloud: &CloudEvidence,
    grid: &PlanGrid,
    input: &GroupingInput,
    params: &RoofParams,
) -> Vec<PlaneGroup> {
    let loss = Loss::Cauchy(params.refine.loss_sigmas);
    let spacing = columns_apart(grid) as f64 * grid.step;
    let refitted = map(planes, |_, supported| {
        let group = &supported.hypothesis.group;
        let places = supported.support.places(grid);
        let points = places.filter_map(|p| cloud.height_at(&p, spacing));
        let ends = line_ends(group, input, params.coplanar_distance_m);
        let heights: Vec<SurfaceHeight> = points.chain(ends).collect();
        let plane = fitted_plane(&heights, &group.plane, loss)?;
        let group = || PlaneGroup {
            plane,
            ..group.clone()
        };
        (!is_wall(&plane)).then(group)
    });
    refitted.into_iter().flatten().collect()
}

/// The ends of a group's lines, with what gutters and caps of ridges add to their covariance,
/// metres.
fn line_ends(
    group: &PlaneGroup,
    input: &GroupingInput,
    beside_m: f64,
) -> impl Iterator<Item = SurfaceHeight> {
    let normal: Vector3<f64> = group.plane.normal / group.plane.normal.z;
    group.lines().into_iter().flat_map(move |id| {
        let line = &input.lines[id.index()];
        let ends = [&line.segment.p0, &line.segment.p1];
        [0, 1].map(|end| SurfaceHeight {
            at: ends[end].xy(),
            z: ends[end].z,
            sigma_m: hypot(
                normal.dot(&(line.covariance[end] * normal)).sqrt(),
                beside_m,
            ),
            independent: 1.0,
        })
    })
}

/// The plane of least cost near another one; `None` where the heights leave it open.
fn fitted_plane(heights: &[SurfaceHeight], start: &Plane, loss: Loss) -> Option<Plane> {
    let sum = (heights.iter()).fold(Point2::origin(), |sum, h| sum + h.at.coords);
    let middle = sum / heights.len() as f64;
    let gradient = -start.normal.xy() / start.normal.z;
    let start = Vector3::new(start.z_at(middle.x, middle.y), gradient.x, gradient.y);
    let linearised = |x: &Vector3<f64>| {
        let mut equations = NormalEquations::default();
        for h in heights {
            let away = h.at - middle;
            let jacobian = Matrix1x3::new(1.0, away.x, away.y);
            let residual = (jacobian * x - Vector1::new(h.z)) / h.sigma_m;
            let square = residual.norm_squared();
            let weight = h.independent * loss.weight(square);
            equations.cost += h.independent * loss.cost(square);
            equations.add_weighted(&residual, &(jacobian / h.sigma_m), weight);
        }
        Some(equations)
    };
    let (x, equations) = fit(start, linearised, |x, step| x + step, Stop::default())?;
    equations.inverse()?;
    let point = Point3::new(middle.x, middle.y, x[0]);
    Plane::from_point_normal(&point, &Vector3::new(-x[1], -x[2], 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOSS: Loss = Loss::Cauchy(2.0);

    /// Heights of a plane every half metre of 8 m by 6 m, a third of them those of a dormer.
    fn heights(planted: &Plane) -> Vec<SurfaceHeight> {
        let of_row = |row: i32| (0..16).map(move |column| (column, row));
        let places = (0..12).flat_map(of_row);
        let height = |(column, row): (i32, i32)| {
            let at = Point2::new(f64::from(column), f64::from(row)) * 0.5;
            let dormer = if (4..10).contains(&column) && row < 8 {
                1.0
            } else {
                0.0
            };
            SurfaceHeight {
                at,
                z: planted.z_at(at.x, at.y) + dormer,
                sigma_m: 0.05,
                independent: 0.25,
            }
        };
        places.map(height).collect()
    }

    fn plane(normal: [f64; 3]) -> Plane {
        let point = Point3::new(4.0, 3.0, 7.0);
        Plane::from_point_normal(&point, &Vector3::from(normal)).unwrap()
    }

    #[test]
    fn a_planted_plane_is_recovered_beside_a_dormer() {
        let planted = plane([0.3, -0.1, 1.0]);
        let found = fitted_plane(&heights(&planted), &plane([0.25, -0.05, 1.0]), LOSS).unwrap();
        for (x, y) in [(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)] {
            let off = found.z_at(x, y) - planted.z_at(x, y);
            assert!(off.abs() < 0.02, "{off} at {x}, {y}");
        }
    }

    #[test]
    fn heights_on_a_line_leave_the_plane_open() {
        let planted = plane([0.3, -0.1, 1.0]);
        let mut heights = heights(&planted);
        heights.retain(|h| h.at.y == 0.0);
        assert!(fitted_plane(&heights, &planted, LOSS).is_none());
        assert!(fitted_plane(&[], &planted, LOSS).is_none());
    }
}
