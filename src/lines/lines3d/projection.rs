//! A 3D line as one view sees it: the map between places along the line and image points.

use nalgebra::{Matrix3, Point2, Vector2, Vector3};

use super::track::LineSupport;
use crate::base::geometry::{Segment2, Segment3};
use crate::base::line_linker::LineLinker;
use crate::lines::lines2d::GuidedEdge;
use crate::orienting::scene::Scene;
use crate::photographs::camera::Camera;

/// The image of a directed 3D line, with the exact projective map along it.
///
/// With X(t) = p0 + t d (t in metres from the start of the segment) the homogeneous image point is
/// `a + t b`, where `a = K R (p0 - C)` and `b = K R d`.
#[derive(Clone, Copy, Debug)]
pub struct ProjectedLine {
    m: Matrix3<f64>,
    a: Vector3<f64>,
    b: Vector3<f64>,
    /// Unit direction in the image, that of growing t.
    pub direction: Vector2<f64>,
    /// The image line, `l . (x, y, 1)` = signed distance in pixels.
    pub line: Vector3<f64>,
}

impl ProjectedLine {
    /// The image of the line; `None` where an end of the segment is not in front of the camera or
    /// the camera looks along it.
    pub fn new(camera: &Camera, segment: &Segment3) -> Option<Self> {
        let (x0, x1) = (camera.project(&segment.p0)?, camera.project(&segment.p1)?);
        let image = Segment2::new(x0, x1);
        if image.length() < 1e-6 {
            return None;
        }
        let m = camera.k * camera.r;
        Some(Self {
            m,
            a: m * (segment.p0 - camera.center),
            b: m * segment.direction(),
            direction: image.direction(),
            line: image.line(),
        })
    }

    /// The image of the point at `t` metres; `None` behind the camera.
    pub fn at(&self, t: f64) -> Option<Point2<f64>> {
        let x = self.a + self.b * t;
        (x.z > 1e-9).then(|| Point2::new(x.x / x.z, x.y / x.z))
    }

    /// Metres along the line of the image point nearest to `x`: solves `u . (x(t) - x) = 0`.
    pub fn t_of(&self, x: &Point2<f64>) -> f64 {
        let (u, s) = (self.direction, self.direction.dot(&x.coords));
        -(u.dot(&self.a.xy()) - s * self.a.z) / (u.dot(&self.b.xy()) - s * self.b.z)
    }

    /// Signed distance of an image point from the line, pixels.
    pub fn distance(&self, x: &Point2<f64>) -> f64 {
        self.line.x * x.x + self.line.y * x.y + self.line.z
    }

    /// Standard deviation across the image line, pixels, of the image of the point at `t` metres
    /// with this covariance (m^2). A shift dX of the point moves its image by l . M dX / z off the
    /// line l, where M = K R.
    pub fn sigma_px(&self, t: f64, covariance: &Matrix3<f64>) -> f64 {
        let gradient = self.m.tr_mul(&self.line) / (self.a.z + t * self.b.z);
        gradient.dot(&(covariance * gradient)).max(0.0).sqrt()
    }
}

/// Does the image of a line lie on the edges of another, in two of three views that show one
/// (B99 3.4)? A line is given with the covariance of its point at `t` metres, m^2.
pub(crate) fn reprojects_onto(
    scene: &Scene,
    (line, covariance_at): (&Segment3, impl Fn(f64) -> Matrix3<f64>),
    onto: &[LineSupport],
    linker: &LineLinker,
) -> bool {
    let is_on_edge = |edge: &GuidedEdge| {
        let image = ProjectedLine::new(scene.camera(edge.view), line);
        image.is_some_and(|image| {
            (edge.segment.ends().iter()).all(|x| {
                let t = image.t_of(x);
                let linker = linker.known_to(image.sigma_px(t, &covariance_at(t)));
                linker.distance(image.distance(x)) >= 0.0
            })
        })
    };
    let edges = onto.iter().filter_map(|s| s.edge.as_ref());
    let (on, all) = edges.fold((0, 0), |(on, all), edge| {
        (on + usize::from(is_on_edge(edge)), all + 1)
    });
    3 * on >= 2 * all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photographs::camera::testing::crop_camera;
    use nalgebra::Point3;

    #[test]
    fn t_of_inverts_at() {
        let camera = crop_camera(120.0, 40.0, 0.4);
        let line = Segment3::new(Point3::new(-3.0, 2.0, 8.0), Point3::new(9.0, 6.0, 11.0));
        let image = ProjectedLine::new(&camera, &line).unwrap();
        for t in [-20.0, 0.0, 3.7, 40.0] {
            let x = image.at(t).unwrap();
            assert!((image.t_of(&x) - t).abs() < 1e-7);
            assert!(image.distance(&x).abs() < 1e-6);
            let aside = x + Vector2::new(-image.direction.y, image.direction.x) * 2.5;
            assert!((image.t_of(&aside) - t).abs() < 1e-7);
            assert!((image.distance(&aside) - 2.5).abs() < 1e-6);
        }
    }

    #[test]
    fn an_uncertain_point_is_as_uncertain_in_the_image_as_it_moves_there() {
        let camera = crop_camera(120.0, 40.0, 0.4);
        let line = Segment3::new(Point3::new(-3.0, 2.0, 8.0), Point3::new(9.0, 6.0, 11.0));
        let image = ProjectedLine::new(&camera, &line).unwrap();
        for t in [0.0, 5.0, 20.0] {
            let point = line.p0 + line.direction() * t;
            for by in [Vector3::x(), Vector3::y(), Vector3::new(0.3, -0.4, 1.2)] {
                let step = by * 1e-4;
                let moved = image.distance(&camera.project(&(point + step)).unwrap());
                let sigma = image.sigma_px(t, &(step * step.transpose()));
                assert!((sigma - moved.abs()).abs() < 1e-3 * moved.abs(), "{by}");
            }
        }
    }
}
