//! Image lines with their equations, rays and interpretation planes, computed once.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::oris::RegionLine;
use crate::base::geometry::Segment2;
use crate::base::ids::{SegmentId, ViewId};
use crate::orienting::scene::Scene;
use crate::photographs::camera::{Camera, plane_of_image_line};

/// An image line with its rays and its interpretation plane.
#[derive(Clone, Debug)]
pub struct ImageLine<'a> {
    /// The view.
    pub view: ViewId,
    /// Index among the lines of the view.
    pub line: SegmentId,
    /// Its camera.
    pub camera: &'a Camera,
    /// The line, directed by contrast.
    pub segment: Segment2,
    /// Its equation: `equation . (x, y, 1)` is the distance in pixels.
    pub equation: Vector3<f64>,
    /// Unit normal of the plane through the projection centre and the line.
    pub normal: Vector3<f64>,
    /// Unit directions of the rays through its ends.
    pub rays: [Vector3<f64>; 2],
    /// Length, pixels.
    pub length_px: f64,
    /// Contrast, 0 to 1.
    pub contrast: f64,
    /// Grey values left and right, 0 to 1.
    pub sides: [f64; 2],
}

impl ImageLine<'_> {
    /// The points of the rays through the ends at a height.
    pub fn ends_at(&self, z: f64) -> [Point3<f64>; 2] {
        self.rays
            .map(|ray| self.camera.center + ray * ((z - self.camera.center.z) / ray.z))
    }

    /// Distance of the image of a world point from the line, pixels; `None` behind the camera.
    pub fn distance_px(&self, world: &Point3<f64>) -> Option<f64> {
        let p = self.camera.project(world)?;
        Some(self.equation.dot(&Vector3::new(p.x, p.y, 1.0)))
    }

    /// Direction in the image of a world direction at a world point; unit vector.
    pub fn image_direction(
        &self,
        at: &Point3<f64>,
        direction: &Vector3<f64>,
    ) -> Option<Vector2<f64>> {
        let d = self.camera.project_jacobian(at)? * direction;
        let n = d.norm();
        (n > 1e-12).then(|| d / n)
    }
}

/// The lines of all views.
pub(super) fn image_lines<'a>(scene: &'a Scene, lines: &[Vec<RegionLine>]) -> Vec<ImageLine<'a>> {
    let of_view = |view: ViewId| {
        let camera = scene.camera(view);
        lines[view.index()]
            .iter()
            .enumerate()
            .filter_map(move |(k, l)| {
                let segment = l.line.segment;
                let equation = segment.line();
                let ray = |p: &Point2<f64>| camera.ray(p);
                let rays = [ray(&segment.p0), ray(&segment.p1)];
                // Rays that do not go down never meet the ground.
                let down = rays.iter().all(|r| r.z < -0.05);
                down.then_some(())?;
                Some(ImageLine {
                    view,
                    line: SegmentId::from_index(k),
                    camera,
                    segment,
                    equation,
                    normal: plane_of_image_line(camera, &equation)?.normal,
                    rays,
                    length_px: segment.length(),
                    contrast: f64::from(l.line.contrast),
                    sides: l.sides,
                })
            })
    };
    scene.view_ids().flat_map(of_view).collect()
}
