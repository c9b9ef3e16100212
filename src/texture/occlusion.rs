//! What hides a face from a view: the shadows that other faces cast onto its plane from the
//! projection centre.
//!
//! Exact in the plane of the face, unlike a depth buffer, which needs a tolerance where faces are
//! seen at a grazing angle (a wall 10 degrees off the ray falls half a metre within a pixel of 8.5
//! cm).

use nalgebra::{Point2, Point3};

use super::patch::{FacePlane, TexturePatch};
use crate::camera::Camera;
use crate::geometry::clip;
use crate::raster::mark_inside;

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
        let shadow: Vec<Vec<Point2<f64>>> = faces[other]
            .rings
            .iter()
            .map(|ring| {
                let above = clip(ring, |p| plane.height(p) - CLEARANCE_M);
                let between = clip(&above, |p| ceiling - plane.height(p));
                between
                    .iter()
                    .map(|p| patch.texel_of(&plane.cast(center, p)))
                    .collect()
            })
            .collect();
        mark_inside(&shadow, patch.width, patch.height, &mut mask);
    }
    mask
}

/// Do two boxes overlap?
fn meet(a: &[f64; 4], b: &[f64; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}
