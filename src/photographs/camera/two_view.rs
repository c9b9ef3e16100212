//! Epipolar geometry, plane homographies and line transfer (B99 3.1, 3.2, 4.1).

use nalgebra::{Matrix3, Point2, Vector3};

use super::pinhole::Camera;
use crate::base::geometry::Plane;

/// F with `x'^T F x = 0` for corresponding points x of `first` and x' of `second` (B99 3.1).
/// `F x` is the epipolar line in the second image. Scaled to unit Frobenius norm.
pub fn fundamental(first: &Camera, second: &Camera) -> Matrix3<f64> {
    // F = K'^-T R' [C - C']x R^T K^-1: the epipolar plane holds both centres and the ray.
    let b = first.center - second.center;
    let f = second.k_inverse().transpose()
        * second.r
        * b.cross_matrix()
        * first.r.transpose()
        * first.k_inverse();
    f / f.norm()
}

/// A plane-induced map `x' = H x` from one image to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homography(pub Matrix3<f64>);

impl Homography {
    /// The image of a point, pixels; `None` on or beyond the horizon of the plane.
    pub fn apply(&self, x: &Point2<f64>) -> Option<Point2<f64>> {
        let y = self.0 * Vector3::new(x.x, x.y, 1.0);
        (y.z > 1e-12).then(|| Point2::new(y.x / y.z, y.y / y.z))
    }
}

/// The homography that a plane induces from `first` to `second` (B99 4.1: `H = A + a v^T`), with a
/// positive third coordinate for points in front of both cameras. `None` when the plane passes
/// through the first centre.
pub fn homography_of_plane(first: &Camera, second: &Camera, plane: &Plane) -> Option<Homography> {
    // A point on the plane along the ray r of the first camera is C - (h / n.r) r with
    // h = n.C + d; seen from C' it is (C - C') (n.r) - h r up to the factor 1 / (n.r).
    let h = plane.signed_distance(&first.center);
    if h.abs() < 1e-9 {
        return None;
    }
    let b = first.center - second.center;
    let m = Matrix3::identity() * h - b * plane.normal.transpose();
    let h_matrix = second.k * second.r * m * first.r.transpose() * first.k_inverse();
    // m maps a ray r to (C - C')(n.r) - h r times -1; in front of both cameras the scale is h > 0
    // or h < 0 with the side of the plane on which the first camera is.
    Some(Homography(h_matrix / h))
}

/// The plane through the projection centre and an image line `l` (`l . (x, y, 1) = 0`): `P^T l`.
pub fn plane_of_image_line(camera: &Camera, line: &Vector3<f64>) -> Option<Plane> {
    let normal = camera.r.transpose() * (camera.k.transpose() * line);
    Plane::from_point_normal(&camera.center, &normal)
}

/// Trifocal transfer of a line: the image in `third` of the 3D line seen as `l1` in `first` and
/// `l2` in `second` (B99 3.2), scaled so that `l . (x, y, 1)` is a distance in pixels. The
/// trifocal tensor's action is computed through the 3D line in which the two interpretation planes
/// meet, which is the same map and stays in metric units. `None` when the planes are parallel
/// (line near an epipolar plane).
pub fn transfer_line(
    first: &Camera,
    l1: &Vector3<f64>,
    second: &Camera,
    l2: &Vector3<f64>,
    third: &Camera,
    near: &nalgebra::Point3<f64>,
) -> Option<Vector3<f64>> {
    let (p1, p2) = (
        plane_of_image_line(first, l1)?,
        plane_of_image_line(second, l2)?,
    );
    let (point, direction) = p1.intersection(&p2, near)?;
    let (a, b) = (third.project(&point)?, third.project(&(point + direction))?);
    let d = (b - a).normalize();
    let n = nalgebra::Vector2::new(-d.y, d.x);
    Some(Vector3::new(n.x, n.y, -n.dot(&a.coords)))
}

#[cfg(test)]
mod tests {
    use super::super::testing::crop_camera;
    use super::*;
    use nalgebra::Point3;

    fn homogeneous(p: &Point2<f64>) -> Vector3<f64> {
        Vector3::new(p.x, p.y, 1.0)
    }

    #[test]
    fn corresponding_points_satisfy_the_epipolar_constraint() {
        let (a, b) = (crop_camera(0.0, 0.0, 0.0), crop_camera(300.0, 20.0, 3.1));
        let f = fundamental(&a, &b);
        for world in [Point3::new(5.0, 6.0, 7.0), Point3::new(-20.0, 3.0, 1.0)] {
            let (x, y) = (a.project(&world).unwrap(), b.project(&world).unwrap());
            let l = f * homogeneous(&x);
            assert!(
                l.dot(&homogeneous(&y)).abs() / l.xy().norm() < 1e-6,
                "distance to the epipolar line"
            );
        }
    }

    #[test]
    fn homography_maps_points_of_the_plane() {
        let (a, b) = (crop_camera(0.0, 0.0, 0.0), crop_camera(300.0, 20.0, 3.1));
        let plane =
            Plane::from_point_normal(&Point3::new(1.0, 2.0, 9.0), &Vector3::new(0.4, 0.3, 0.8))
                .unwrap();
        for plane in [
            plane,
            Plane {
                normal: -plane.normal,
                d: -plane.d,
            },
        ] {
            let h = homography_of_plane(&a, &b, &plane).unwrap();
            let world = plane.lift(-7.0, 11.0);
            let x = h.apply(&a.project(&world).unwrap()).unwrap();
            assert!((x - b.project(&world).unwrap()).norm() < 1e-6);
        }
    }

    #[test]
    fn transfer_agrees_with_projection() {
        let cameras = [
            crop_camera(0.0, 0.0, 0.0),
            crop_camera(300.0, 20.0, 3.1),
            crop_camera(250.0, 300.0, 1.0),
        ];
        let (p, q) = (Point3::new(0.0, 1.0, 8.0), Point3::new(9.0, 6.0, 11.0));
        let l: Vec<_> = cameras
            .iter()
            .map(|c| {
                crate::base::geometry::Segment2::new(c.project(&p).unwrap(), c.project(&q).unwrap())
                    .line()
            })
            .collect();
        let t = transfer_line(&cameras[0], &l[0], &cameras[1], &l[1], &cameras[2], &p).unwrap();
        for world in [p, q] {
            assert!(
                t.dot(&homogeneous(&cameras[2].project(&world).unwrap()))
                    .abs()
                    < 1e-5
            );
        }
    }
}
