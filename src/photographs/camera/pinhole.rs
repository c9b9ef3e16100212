//! A calibrated pinhole camera.

use nalgebra::{Matrix3, Matrix3x4, Point2, Point3, Rotation3, Vector3};
use serde::{Deserialize, Serialize};

/// A calibrated pinhole camera together with the size of its image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Calibration K, pixels; upper triangular, `K[(2, 2)] = 1`.
    pub k: Matrix3<f64>,
    /// Rotation `cam_from_world`, 3 x 3, determinant +1.
    pub r: Matrix3<f64>,
    /// Projection centre C, metres, world frame (scene origin subtracted).
    pub center: Point3<f64>,
    /// Image width, pixels.
    pub width: u32,
    /// Image height, pixels.
    pub height: u32,
}

impl Camera {
    /// A camera from its calibration, its rotation `cam_from_world` and its projection centre.
    pub fn new(
        k: Matrix3<f64>,
        r: Rotation3<f64>,
        center: Point3<f64>,
        width: u32,
        height: u32,
    ) -> Self {
        Self {
            k,
            r: r.into_inner(),
            center,
            width,
            height,
        }
    }

    /// `P = K [R | -R C]`, so that `x ~ P (X, 1)`; pixels.
    pub fn projection_matrix(&self) -> Matrix3x4<f64> {
        let m = self.k * self.r;
        let mut p = Matrix3x4::zeros();
        p.fixed_view_mut::<3, 3>(0, 0).copy_from(&m);
        p.set_column(3, &(-(m * self.center.coords)));
        p
    }

    /// Depth of a world point along the optical axis, metres; negative behind the camera.
    pub fn depth(&self, world: &Point3<f64>) -> f64 {
        self.r.row(2).transpose().dot(&(world - self.center))
    }

    /// Image of a world point, pixels; `None` behind or in the plane of the projection centre.
    pub fn project(&self, world: &Point3<f64>) -> Option<Point2<f64>> {
        let x = self.k * (self.r * (world - self.center));
        (x.z > 1e-9).then(|| Point2::new(x.x / x.z, x.y / x.z))
    }

    /// Derivative of [`Self::project`]: 2 x 3, pixels per metre. `None` behind the camera.
    pub fn project_jacobian(&self, world: &Point3<f64>) -> Option<nalgebra::Matrix2x3<f64>> {
        let m = self.k * self.r;
        let x = m * (world - self.center);
        (x.z > 1e-9).then(|| {
            let (u, v) = (x.x / x.z, x.y / x.z);
            nalgebra::Matrix2x3::from_rows(&[
                (m.row(0) - m.row(2) * u) / x.z,
                (m.row(1) - m.row(2) * v) / x.z,
            ])
        })
    }

    /// Unit direction in the world of the ray through an image point.
    pub fn ray(&self, image: &Point2<f64>) -> Vector3<f64> {
        let d = self.k_inverse() * Vector3::new(image.x, image.y, 1.0);
        (self.r.transpose() * d).normalize()
    }

    /// The world point at height `z` seen at an image point; `None` when the ray does not reach it
    /// in front of the camera.
    pub fn at_height(&self, image: &Point2<f64>, z: f64) -> Option<Point3<f64>> {
        let ray = self.ray(image);
        let t = (z - self.center.z) / ray.z;
        (t.is_finite() && t > 0.0).then(|| self.center + ray * t)
    }

    /// Is the image point inside the image, at least `margin_px` from its border?
    pub fn contains(&self, image: &Point2<f64>, margin_px: f64) -> bool {
        image.x >= margin_px
            && image.y >= margin_px
            && image.x <= f64::from(self.width) - margin_px
            && image.y <= f64::from(self.height) - margin_px
    }

    /// Angle between the optical axis and the farthest corner of the image, degrees.
    pub(crate) fn half_field_deg(&self) -> f64 {
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let axis = self.r.row(2).transpose();
        let corners = [[0.0, 0.0], [w, 0.0], [0.0, h], [w, h]].map(Point2::from);
        let nearest = corners.map(|corner| self.ray(&corner).dot(&axis));
        crate::base::math::acos(nearest.into_iter().fold(1.0, f64::min)).to_degrees()
    }

    /// Size in metres of a pixel at a world point, across the ray.
    pub fn ground_pixel(&self, world: &Point3<f64>) -> f64 {
        (world - self.center).norm() / self.k[(0, 0)].abs()
    }

    /// Inverse of the upper triangular K, in closed form.
    pub fn k_inverse(&self) -> Matrix3<f64> {
        let (fx, s, cx) = (self.k[(0, 0)], self.k[(0, 1)], self.k[(0, 2)]);
        let (fy, cy) = (self.k[(1, 1)], self.k[(1, 2)]);
        Matrix3::new(
            1.0 / fx,
            -s / (fx * fy),
            (s * cy - cx * fy) / (fx * fy),
            0.0,
            1.0 / fy,
            -cy / fy,
            0.0,
            0.0,
            1.0,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::least_squares::worst_derivative;
    use crate::photographs::camera::testing::crop_camera;

    #[test]
    fn projection_matrix_agrees_with_project() {
        let camera = crop_camera(100.0, -50.0, 0.3);
        let world = Point3::new(12.0, 30.0, 8.0);
        let x = camera.projection_matrix() * world.to_homogeneous();
        let p = camera.project(&world).unwrap();
        assert!((Point2::new(x.x / x.z, x.y / x.z) - p).norm() < 1e-7);
    }

    #[test]
    fn ray_returns_to_the_point() {
        let camera = crop_camera(100.0, -50.0, 0.3);
        let world = Point3::new(12.0, 30.0, 8.0);
        let back = camera
            .at_height(&camera.project(&world).unwrap(), 8.0)
            .unwrap();
        assert!((back - world).norm() < 1e-7);
        assert!((camera.k * camera.k_inverse() - Matrix3::identity()).norm() < 1e-9);
    }

    #[test]
    fn jacobian_agrees_with_differences() {
        let camera = crop_camera(100.0, -50.0, 0.3);
        let world = Point3::new(12.0, 30.0, 8.0);
        let j = camera.project_jacobian(&world).unwrap();
        let off = worst_derivative(&j, |step| camera.project(&(world + step)).unwrap().coords);
        assert!(off < 1e-6, "{off}");
    }
}
