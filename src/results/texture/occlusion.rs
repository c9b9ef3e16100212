//! What hides a face from a view: the shadows that other faces cast onto its plane from the
//! projection centre.
//!
//! Exact in the plane of the face, unlike a depth buffer, which needs a tolerance where faces are
//! seen at a grazing angle (a wall 10 degrees off the ray falls half a metre within a pixel of 8.5
//! cm).

use nalgebra::Point3;

use super::patch::{FacePlane, TexturePatch};
use crate::base::geometry::{Polygon, clip};
use crate::orienting::scene::Scene;
use crate::photographs::camera::Camera;
use crate::photographs::raster::mark_inside;

/// Parts of a face closer to the plane than this cast no shadow, metres: neighbours start at a
/// common edge and are planar within a few millimetres.
const CLEARANCE_M: f64 = 0.02;

/// The bounding boxes of the images of all faces in a view.
#[derive(Clone, Debug)]
pub(super) struct FaceImages {
    /// Per face the box around its image (x0, y0, x1, y1), pixels; `None` where it looks away from
    /// the camera or is not in front of it.
    boxes: Vec<Option<[f64; 4]>>,
}

impl FaceImages {
    /// Those of all views.
    pub(super) fn of_views(scene: &Scene, faces: &[FacePlane]) -> Vec<Self> {
        let views = scene.views.iter();
        views.map(|v| Self::new(faces, &v.camera)).collect()
    }

    /// The images of all faces that look towards the camera.
    pub(super) fn new(faces: &[FacePlane], camera: &Camera) -> Self {
        let face_image = |face: &FacePlane| {
            if face.height(&camera.center) <= CLEARANCE_M {
                return None;
            }
            let empty = [f64::MAX, f64::MAX, f64::MIN, f64::MIN];
            face.rings[0].iter().try_fold(empty, |b, corner| {
                let p = camera.project(corner)?;
                Some([b[0].min(p.x), b[1].min(p.y), b[2].max(p.x), b[3].max(p.y)])
            })
        };
        Self {
            boxes: faces.iter().map(face_image).collect(),
        }
    }

    /// Could the image of `face` show in an image of this size?
    pub(super) fn shows(&self, face: usize, camera: &Camera) -> bool {
        let frame = [0.0, 0.0, f64::from(camera.width), f64::from(camera.height)];
        self.boxes[face].is_some_and(|b| meet(&b, &frame))
    }

    /// The faces, other than `face`, whose images meet its image.
    fn around(&self, face: usize) -> impl Iterator<Item = usize> + '_ {
        let own = self.boxes[face];
        (0..self.boxes.len()).filter(move |&other| {
            other != face && matches!((own, self.boxes[other]), (Some(a), Some(b)) if meet(&a, &b))
        })
    }
}

/// The texels of a face's patch that other faces hide from a projection centre.
pub(super) fn occluded_texels(
    face: usize,
    patch: &TexturePatch,
    faces: &[FacePlane],
    face_images: &FaceImages,
    center: &Point3<f64>,
) -> Vec<bool> {
    let mut mask = vec![false; patch.width * patch.height];
    let plane = &faces[face];
    // Towards the centre the projection goes to infinity: stop just below its height.
    let ceiling = 0.999 * plane.height(center);
    for other in face_images.around(face) {
        let shadow = faces[other].rings.iter().map(|ring| {
            let above = clip(ring, &|p| plane.height(p) - CLEARANCE_M);
            let between = clip(&above, &|p| ceiling - plane.height(p));
            let texel = |p: &Point3<f64>| patch.texel_of(&plane.cast(center, p));
            between.iter().map(texel).collect()
        });
        let shadow = Polygon {
            rings: shadow.collect(),
        };
        mark_inside(&shadow, patch.width, patch.height, &mut mask);
    }
    mask
}

/// How far the texels of a wall lie below its upper and above its lower end.
///
/// A wall of the model stands below the outline of the roof, the real one some way behind it. A
/// view that meets the model's wall within that way of its upper end saw the roof, and of its
/// lower end the ground before the wall.
pub(super) struct WallMargins {
    /// Per texel: the distance to the nearer end in its column, metres.
    to_end_m: Vec<f64>,
    overhang_m: f64,
}

impl WallMargins {
    /// For a face that is a wall.
    pub(super) fn new(
        plane: &FacePlane,
        patch: &TexturePatch,
        inside: &[bool],
        overhang_m: f64,
    ) -> Option<Self> {
        // Walls are vertical up to rounding; the steepest roofs are far from it.
        let is_wall = plane.normal.z.abs() < 0.01;
        is_wall.then(|| {
            let mut to_end_m = vec![0.0; inside.len()];
            for column in 0..patch.width {
                let rows = (0..patch.height).filter(|row| inside[row * patch.width + column]);
                let (Some(first), Some(last)) = (rows.clone().min(), rows.max()) else {
                    continue;
                };
                for row in first..=last {
                    let texels = (row - first).min(last - row) as f64 + 0.5;
                    to_end_m[row * patch.width + column] = texels * patch.texel_m;
                }
            }
            Self {
                to_end_m,
                overhang_m,
            }
        })
    }

    /// Marks the texels where a view from this centre sees roof or ground in place of the wall.
    pub(super) fn hide(
        &self,
        plane: &FacePlane,
        patch: &TexturePatch,
        center: &Point3<f64>,
        hidden: &mut [bool],
    ) {
        for (i, hidden) in hidden.iter_mut().enumerate() {
            let (x, y) = (
                (i % patch.width) as f64 + 0.5,
                (i / patch.width) as f64 + 0.5,
            );
            let ray = center - plane.lift(&patch.point_of(x, y));
            // The ray passes the overhang while it climbs this far.
            let climb = self.overhang_m * ray.z.max(0.0) / plane.normal.dot(&ray).max(1e-9);
            *hidden |= self.to_end_m[i] < climb;
        }
    }
}

/// Do two boxes overlap?
fn meet(a: &[f64; 4], b: &[f64; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point2, Vector3};

    #[test]
    fn a_steep_view_shows_only_the_middle_of_a_wall() {
        // A wall of 6 m by 6 m that looks south.
        let flat = vec![(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)];
        let flat: Vec<Point2<f64>> = flat.into_iter().map(|(x, y)| Point2::new(x, y)).collect();
        let plane = FacePlane {
            origin: Point3::origin(),
            right: Vector3::x(),
            up: Vector3::z(),
            normal: -Vector3::y(),
            rings: vec![flat.iter().map(|p| Point3::new(p.x, 0.0, p.y)).collect()],
            flat: flat.into(),
        };
        let patch = TexturePatch::new(&plane, 0.1);
        let inside = patch.inside(&plane.flat);
        let margins = WallMargins::new(&plane, &patch, &inside, 0.4).unwrap();
        // Shown rows of the middle column from this far to the south, 1000 m up.
        let shown = |south: f64| {
            let mut hidden = vec![false; inside.len()];
            let center = Point3::new(3.0, -south, 1000.0);
            margins.hide(&plane, &patch, &center, &mut hidden);
            (0..60).filter(|row| !hidden[row * 60 + 30]).count()
        };
        // Obliquely: 0.4 m are lost at both ends; at 76 degrees four times as much; from above all.
        assert_eq!(shown(1000.0), 60 - 2 * 4);
        assert_eq!(shown(250.0), 60 - 2 * 16);
        assert_eq!(shown(0.0), 0);
        let roof = FacePlane {
            normal: Vector3::new(0.0, -0.6, 0.8),
            ..plane
        };
        assert!(WallMargins::new(&roof, &patch, &inside, 0.4).is_none());
    }
}
