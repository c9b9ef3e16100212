//! Observations of a 3D line as whitened residuals with their Jacobians.
//!
//! The paper sums the distances of the measured end points from the image of the line. Those two
//! distances are taken here as (offset at the middle, angle) and weighted by the segment's
//! covariance, so that long and well-defined segments count for more.

use nalgebra::{Matrix2, Matrix3, Matrix4x2, Point3, Vector2, Vector3};

use crate::base::geometry::{Plane, Segment2, Segment3};
use crate::base::least_squares::{Loss, whitening};
use crate::base::params::Lines3dParams;
use crate::lines::lines2d::GuidedEdge;
use crate::photographs::camera::Camera;

/// A measured image segment.
#[derive(Clone, Debug)]
pub struct Observation<'a> {
    /// The camera that saw it.
    pub camera: &'a Camera,
    /// Its end points, pixels.
    pub segment: Segment2,
    /// Covariance of (offset along the normal at the middle in px, angle in rad).
    pub covariance: Matrix2<f64>,
}

impl<'a> Observation<'a> {
    /// An edge that a camera shows.
    pub fn of(edge: &GuidedEdge, camera: &'a Camera) -> Self {
        Self {
            camera,
            segment: edge.segment,
            covariance: edge.covariance,
        }
    }

    /// The robust weight of this observation of a line in [`super::fit_line`], 0 to 1.
    pub fn weight(&self, line: &Segment3, params: &Lines3dParams) -> f64 {
        let residual =
            WhitenedObservation::new(self, params).residual(line, &line_frame(&line.direction()));
        let loss = Loss::Cauchy(params.loss_scale);
        residual.map_or(0.0, |(r, _)| loss.weight(r.norm_squared()))
    }
}

/// A known plane in which the line lies.
#[derive(Clone, Copy, Debug)]
pub struct PlaneConstraint {
    /// The plane.
    pub plane: Plane,
    /// Its standard deviation along its normal, metres.
    pub sigma_m: f64,
}

impl PlaneConstraint {
    /// Whitened distances of both ends of a line from the plane and their 4 x 2 transposed
    /// Jacobian.
    pub(super) fn residual(
        &self,
        line: &Segment3,
        across: &[Vector3<f64>; 2],
    ) -> (Vector2<f64>, Matrix4x2<f64>) {
        let distance = |p| self.plane.signed_distance(p) / self.sigma_m;
        let [u, v] = across.map(|a| self.plane.normal.dot(&a) / self.sigma_m);
        (
            Vector2::new(distance(&line.p0), distance(&line.p1)),
            Matrix4x2::new(u, 0.0, v, 0.0, 0.0, u, 0.0, v),
        )
    }
}

/// An observation with its projection matrix and the whitening of its two residuals.
pub(crate) struct WhitenedObservation {
    m: Matrix3<f64>,
    center: Point3<f64>,
    segment: Segment2,
    length: f64,
    whitening: Matrix2<f64>,
}

impl WhitenedObservation {
    pub(crate) fn new(o: &Observation, params: &Lines3dParams) -> Self {
        let length = o.segment.length().max(1.0);
        Self {
            m: o.camera.k * o.camera.r,
            center: o.camera.center,
            segment: o.segment,
            length,
            whitening: edge_whitening(&o.covariance, length, params.position_floor_px),
        }
    }

    /// Whitened (offset, angle) and its 4 x 2 transposed Jacobian; `None` behind the camera.
    pub(crate) fn residual(
        &self,
        line: &Segment3,
        across: &[Vector3<f64>; 2],
    ) -> Option<(Vector2<f64>, Matrix4x2<f64>)> {
        let (x0, x1) = (
            self.m * (line.p0 - self.center),
            self.m * (line.p1 - self.center),
        );
        if x0.z <= 1e-9 || x1.z <= 1e-9 {
            return None;
        }
        let l = x0.cross(&x1);
        let n = l.xy().norm();
        if n < 1e-12 {
            return None;
        }
        let [u, v] = across.map(|a| self.m * a);
        let changes = [u.cross(&x1), v.cross(&x1), x0.cross(&u), x0.cross(&v)];
        // The sense of the normal of l follows p0 -> p1, that of the residual the measured segment.
        let mut e = Vector2::zeros();
        let mut de = Matrix4x2::zeros();
        for (i, p) in [self.segment.p0, self.segment.p1].iter().enumerate() {
            let x = Vector3::new(p.x, p.y, 1.0);
            e[i] = l.dot(&x) / n;
            for (j, dl) in changes.iter().enumerate() {
                de[(j, i)] = dl.dot(&x) / n - e[i] * l.xy().dot(&dl.xy()) / (n * n);
            }
        }
        let to_offset_angle = Matrix2::new(0.5, 0.5, -1.0 / self.length, 1.0 / self.length);
        let w = self.whitening * to_offset_angle;
        Some((w * e, de * w.transpose()))
    }
}

/// Whitens (offset, angle) of an edge of `length` px with an error of `floor` px at both ends that
/// its covariance does not know.
pub(crate) fn edge_whitening(covariance: &Matrix2<f64>, length: f64, floor: f64) -> Matrix2<f64> {
    let mut c = *covariance;
    c[(0, 0)] += floor * floor;
    // The same floor at the two ends, opposite in sign, seen as an angle.
    c[(1, 1)] += 4.0 * floor * floor / (length * length);
    whitening(&c).unwrap_or_else(|| Matrix2::new(1.0 / floor, 0.0, 0.0, 0.5 * length / floor))
}

/// Two unit vectors across a direction, built on the coordinate axis farthest from it.
pub(crate) fn line_frame(direction: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let axis = direction.iamin();
    let mut e = Vector3::zeros();
    e[axis] = 1.0;
    let u = direction.cross(&e).normalize();
    [u, direction.cross(&u)]
}
