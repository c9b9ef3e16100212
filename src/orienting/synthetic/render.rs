//! Ray casting: for each of nine samples of a pixel, the nearest face along its ray.

use nalgebra::{Matrix3, Point2, Point3, Vector2, Vector3};

use super::texture::SurfaceTexture;
use crate::base::geometry::{self, Plane, sides};
use crate::photographs::camera::Camera;

/// Direction towards the sun.
const SUN: Vector3<f64> = Vector3::new(0.42, -0.57, 0.71);

/// Samples along one side of a pixel.
const SAMPLES: u32 = 3;

/// A textured planar polygon.
#[derive(Clone, Debug)]
pub(crate) struct RenderedFace {
    /// Its plane; the normal points to the lit side.
    pub plane: Plane,
    /// Corners in the frame (u, v) of the face, metres; any simple polygon.
    pub ring: Vec<Point2<f64>>,
    /// Corners in the world.
    pub corners: Vec<Point3<f64>>,
    /// Axes of the frame, whose origin is the first corner.
    pub axes: [Vector3<f64>; 2],
    /// Colour and texture.
    pub surface: SurfaceTexture,
}

impl RenderedFace {
    /// The polygon through these corners, counter-clockwise seen from its lit side.
    pub(crate) fn new(corners: &[Point3<f64>], surface: SurfaceTexture) -> Self {
        let u = (corners[1] - corners[0]).normalize();
        let normal = geometry::vector_area(corners.iter().copied());
        let plane = Plane::from_point_normal(&corners[0], &normal).expect("a face has an area");
        let axes = [u, plane.normal.cross(&u)];
        let ring = corners
            .iter()
            .map(|p| in_frame(&axes, &(p - corners[0])))
            .collect();
        Self {
            plane,
            ring,
            corners: corners.to_vec(),
            axes,
            surface,
        }
    }

    /// Is the point inside the polygon?
    fn contains(&self, p: &Point2<f64>) -> bool {
        geometry::contains(sides(&self.ring), p)
    }

    /// Diffuse light on the face, 0 to 1.
    fn light(&self) -> f64 {
        0.55 + 0.45 * self.plane.normal.dot(&SUN).max(0.0)
    }
}

fn in_frame(axes: &[Vector3<f64>; 2], d: &Vector3<f64>) -> Point2<f64> {
    Point2::new(axes[0].dot(d), axes[1].dot(d))
}

/// The image of the faces that a camera takes; black where a ray meets none.
pub(crate) fn render(faces: &[RenderedFace], camera: &Camera) -> image::RgbImage {
    let visible: Vec<ProjectedFace> = faces
        .iter()
        .map(|f| ProjectedFace::new(f, camera))
        .collect();
    let world_from_image = camera.r.transpose() * camera.k_inverse();
    image::RgbImage::from_fn(camera.width, camera.height, |x, y| {
        let candidates: Vec<&ProjectedFace> =
            visible.iter().filter(|f| f.near_pixel(x, y)).collect();
        image::Rgb(pixel(&candidates, camera, &world_from_image, x, y))
    })
}

/// Mean over the samples of one pixel.
fn pixel(
    candidates: &[&ProjectedFace],
    camera: &Camera,
    world_from_image: &Matrix3<f64>,
    x: u32,
    y: u32,
) -> [u8; 3] {
    let step = 1.0 / f64::from(SAMPLES);
    let mut sum = [0.0; 3];
    for i in 0..SAMPLES * SAMPLES {
        let sx = f64::from(x) + (f64::from(i % SAMPLES) + 0.5) * step;
        let sy = f64::from(y) + (f64::from(i / SAMPLES) + 0.5) * step;
        let ray = world_from_image * Vector3::new(sx, sy, 1.0);
        let colour = nearest(candidates, &camera.center, &ray);
        (0..3).for_each(|c| sum[c] += colour[c]);
    }
    sum.map(|s| (s * step * step * 255.0).round().clamp(0.0, 255.0) as u8)
}

/// Colour of the first face that a ray meets.
fn nearest(candidates: &[&ProjectedFace], center: &Point3<f64>, ray: &Vector3<f64>) -> [f64; 3] {
    let mut nearest = f64::INFINITY;
    let mut met = None;
    for visible in candidates {
        let t = -visible.height / visible.face.plane.normal.dot(ray);
        if !(t > 0.0 && t < nearest) {
            continue;
        }
        let d = center + ray * t - visible.face.corners[0];
        let uv = in_frame(&visible.face.axes, &d);
        if visible.face.contains(&uv) {
            nearest = t;
            met = Some((visible, uv));
        }
    }
    let colour = |(visible, uv): (&&ProjectedFace, Point2<f64>)| {
        visible.face.surface.colour(uv.x, uv.y, visible.light)
    };
    met.map_or([0.0; 3], colour)
}

/// A face as one camera sees it.
struct ProjectedFace<'a> {
    face: &'a RenderedFace,
    light: f64,
    /// Signed distance of the projection centre from the plane, metres.
    height: f64,
    /// Bounding box in the image, pixels: least and greatest x and y.
    bounds: [Vector2<f64>; 2],
}

impl<'a> ProjectedFace<'a> {
    fn new(face: &'a RenderedFace, camera: &Camera) -> Self {
        let infinite = Vector2::repeat(f64::INFINITY);
        let mut bounds = [infinite, -infinite];
        for corner in &face.corners {
            match camera.project(corner) {
                Some(p) => bounds = [bounds[0].inf(&p.coords), bounds[1].sup(&p.coords)],
                None => bounds = [-infinite, infinite],
            }
        }
        Self {
            face,
            light: face.light(),
            height: face.plane.signed_distance(&camera.center),
            bounds,
        }
    }

    fn near_pixel(&self, x: u32, y: u32) -> bool {
        let (x, y) = (f64::from(x), f64::from(y));
        let [least, greatest] = &self.bounds;
        x + 1.0 >= least.x && x <= greatest.x && y + 1.0 >= least.y && y <= greatest.y
    }
}
