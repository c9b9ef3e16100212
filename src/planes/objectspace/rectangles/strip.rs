//! The strip of a plane between two parallel lines.

use nalgebra::{Point3, Vector3};

use crate::base::geometry::Plane;
use crate::planes::objectspace::clusters::ClusterAxes;

/// A plane between two parallel lines: u along them, w from the first to the second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaneStrip {
    pub origin: Point3<f64>,
    pub u: Vector3<f64>,
    pub w: Vector3<f64>,
    pub width: f64,
    /// Range along the lines that they and the margin leave.
    pub range: [f64; 2],
    pub plane: Plane,
}

impl PlaneStrip {
    /// Through the places (across, height) of two lines; `None` where they coincide or stand above
    /// each other.
    pub(super) fn new(
        axes: &ClusterAxes,
        first: [f64; 2],
        second: [f64; 2],
        range: [f64; 2],
    ) -> Option<Self> {
        let (a, b) = (
            axes.point(0.0, first[0], first[1]),
            axes.point(0.0, second[0], second[1]),
        );
        let width = (b - a).norm();
        (width > 1e-6).then_some(())?;
        let w = (b - a) / width;
        let plane = Plane::from_point_normal(&a, &axes.u.cross(&w))?.upwards();
        (plane.normal.z > 1e-3).then_some(Self {
            origin: a,
            u: axes.u,
            w,
            width,
            range,
            plane,
        })
    }

    /// The world point at (u, w).
    pub(super) fn point(&self, u: f64, w: f64) -> Point3<f64> {
        self.origin + self.u * u + self.w * w
    }

    /// (u, w) of the point in which a ray meets the plane.
    pub(super) fn cut(&self, center: &Point3<f64>, ray: &Vector3<f64>) -> Option<[f64; 2]> {
        let t = -self.plane.signed_distance(center) / self.plane.normal.dot(ray);
        (t > 0.0).then(|| {
            let d = center + ray * t - self.origin;
            [d.dot(&self.u), d.dot(&self.w)]
        })
    }
}
