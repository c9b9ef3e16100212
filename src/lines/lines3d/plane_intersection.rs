//! The line in which the interpretation planes of its segments meet, as the start of the fit.

use nalgebra::{Matrix3, Point2, Point3, Vector3};

use super::observation::Observation;
use crate::base::geometry::{Plane, Segment3, principal_axes};
use crate::photographs::camera::{Camera, plane_of_image_line};

/// The line nearest to all interpretation planes in the least-squares sense: direction across all
/// their normals, position by least squares. A start for [`fit_line`](super::fit_line); its end
/// points are those of the longest observation. `None` when the planes do not fix a line.
pub fn line_of_planes(observations: &[Observation]) -> Option<Segment3> {
    let planes: Vec<_> = observations
        .iter()
        .filter_map(|o| {
            let plane = plane_of_image_line(o.camera, &o.segment.line())?;
            Some((plane, o.segment.length()))
        })
        .collect();
    let longest = observations
        .iter()
        .max_by(|a, b| a.segment.length().total_cmp(&b.segment.length()))?;
    let scatter = planes.iter().fold(Matrix3::zeros(), |s, (p, w)| {
        s + p.normal * p.normal.transpose() * *w
    });
    let ([_, second, largest], [direction, ..]) = principal_axes(scatter);
    // Planes that are nearly one plane (all within about 0.1 degree) fix no line.
    if second < 3e-6 * largest {
        return None;
    }
    let origin = least_squares_point(&planes, &scatter, &direction, longest)?;
    let ends = [longest.segment.p0, longest.segment.p1]
        .map(|x| nearest_on_line(&origin, &direction, longest.camera, &x));
    Some(Segment3::new(ends[0]?, ends[1]?))
}

/// The point on all planes, in the plane through the longest segment's ray across the direction.
fn least_squares_point(
    planes: &[(Plane, f64)],
    scatter: &Matrix3<f64>,
    direction: &Vector3<f64>,
    longest: &Observation,
) -> Option<Point3<f64>> {
    let near = longest.camera.center;
    let rhs = planes.iter().fold(Vector3::zeros(), |s, (p, w)| {
        s - p.normal * (p.signed_distance(&near) * w)
    });
    // The direction is free in the scatter; fixing the step along it to zero makes it regular.
    let full = scatter + direction * direction.transpose() * scatter.trace();
    Some(near + full.cholesky()?.solve(&rhs))
}

/// The point of a line nearest to the ray through an image point.
fn nearest_on_line(
    origin: &Point3<f64>,
    direction: &Vector3<f64>,
    camera: &Camera,
    x: &Point2<f64>,
) -> Option<Point3<f64>> {
    let ray = camera.ray(x);
    let between = camera.center - origin;
    let c = ray.dot(direction);
    let sine2 = 1.0 - c * c;
    (sine2 > 1e-9)
        .then(|| origin + direction * ((between.dot(direction) - between.dot(&ray) * c) / sine2))
}
