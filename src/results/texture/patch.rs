//! The rectified patch of a face: a raster in the face's own plane, rows parallel to the horizon.

use nalgebra::{Point2, Point3, Vector3};

use crate::base::geometry::{Polygon, sides};
use crate::photographs::raster::mark_inside;
use crate::roofs::model::{Solid, SolidFace};

/// Most texels along a side; no atlas holds so many.
const MAX_TEXELS: usize = 1 << 16;

/// A face of a solid with a frame in its plane: `right` is horizontal, `up` climbs, seen from
/// outside.
#[derive(Clone, Debug)]
pub(super) struct FacePlane {
    /// A corner, the origin of the frame.
    pub origin: Point3<f64>,
    /// Unit vector along the rows of the patch.
    pub right: Vector3<f64>,
    /// Unit vector against the columns of the patch.
    pub up: Vector3<f64>,
    /// Outward unit normal.
    pub normal: Vector3<f64>,
    /// Rings in the world, metres.
    pub rings: Vec<Vec<Point3<f64>>>,
    /// Rings in the frame, metres.
    pub flat: Polygon,
}

impl FacePlane {
    /// The frame of a face.
    pub(super) fn new(solid: &Solid, face: &SolidFace) -> Self {
        let rings: Vec<Vec<_>> = face
            .rings
            .iter()
            .map(|ring| ring.iter().map(|&v| solid.vertices[v as usize]).collect())
            .collect();
        let normal = solid
            .vector_area(&face.rings)
            .try_normalize(1e-12)
            .unwrap_or_else(Vector3::z);
        let right = horizontal_in(&normal, &rings[0]);
        let up = normal.cross(&right);
        let origin = rings[0][0];
        let flatten =
            |p: &Point3<f64>| Point2::new((p - origin).dot(&right), (p - origin).dot(&up));
        let flat = Polygon {
            rings: (rings.iter())
                .map(|ring| ring.iter().map(flatten).collect())
                .collect(),
        };
        Self {
            origin,
            right,
            up,
            normal,
            rings,
            flat,
        }
    }

    /// Signed distance from the face's plane, metres, positive outside.
    pub(super) fn height(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&(point - self.origin))
    }

    /// The world point at a position of the frame.
    pub(super) fn lift(&self, p: &Point2<f64>) -> Point3<f64> {
        self.origin + self.right * p.x + self.up * p.y
    }

    /// The position in the frame of the central projection of `point` from `center` onto the plane.
    pub(super) fn cast(&self, center: &Point3<f64>, point: &Point3<f64>) -> Point2<f64> {
        let (from, to) = (self.height(center), self.height(point));
        let hit = center + (point - center) * (from / (from - to)) - self.origin;
        Point2::new(hit.dot(&self.right), hit.dot(&self.up))
    }

    /// Lower left and upper right corner of the box around the face, in the frame.
    pub(super) fn bounds(&self) -> [Point2<f64>; 2] {
        self.flat.bounds()
    }

    /// The middle of the box, in the world.
    pub(super) fn middle(&self) -> Point3<f64> {
        let [low, high] = self.bounds();
        self.lift(&nalgebra::center(&low, &high))
    }
}

/// The horizontal unit vector in a plane, to the right as seen from outside; for a horizontal plane
/// the direction of the longest edge, so that the patch lies close around the face.
fn horizontal_in(normal: &Vector3<f64>, ring: &[Point3<f64>]) -> Vector3<f64> {
    let across = Vector3::z().cross(normal);
    // Below about half a degree of slope the strike direction is noise.
    if across.norm() > 0.01 {
        return across.normalize();
    }
    let longest = sides(ring)
        .map(|[p, q]| q - p)
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))
        .unwrap_or_else(Vector3::x);
    (longest - normal * normal.dot(&longest))
        .try_normalize(1e-12)
        .unwrap_or_else(Vector3::x)
}

/// The raster of a face: texel (column, row) covers a square of `texel_m` in the plane.
#[derive(Clone, Debug)]
pub(super) struct TexturePatch {
    /// Side of a texel, metres.
    pub texel_m: f64,
    /// Texels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Upper left corner, in the frame of the face.
    pub corner: Point2<f64>,
}

impl TexturePatch {
    /// The smallest raster of this texel size around a face.
    pub(super) fn new(plane: &FacePlane, texel_m: f64) -> Self {
        let [low, high] = plane.bounds();
        // The tolerance keeps 3.0000001 texels from becoming four.
        let count = |extent: f64| ((extent / texel_m - 1e-6).ceil() as usize).clamp(1, MAX_TEXELS);
        Self {
            texel_m,
            width: count(high.x - low.x),
            height: count(high.y - low.y),
            corner: Point2::new(low.x, high.y),
        }
    }

    /// Position of a point of the frame in texels from the upper left corner, y down.
    pub(super) fn texel_of(&self, p: &Point2<f64>) -> Point2<f64> {
        Point2::new(
            (p.x - self.corner.x) / self.texel_m,
            (self.corner.y - p.y) / self.texel_m,
        )
    }

    /// The point of the frame at a position in texels.
    pub(super) fn point_of(&self, x: f64, y: f64) -> Point2<f64> {
        Point2::new(
            self.corner.x + x * self.texel_m,
            self.corner.y - y * self.texel_m,
        )
    }

    /// Which texels have their centre inside a polygon, given in the frame of the face.
    pub(super) fn inside(&self, polygon: &Polygon) -> Vec<bool> {
        let mut mask = vec![false; self.width * self.height];
        let texels = polygon.mapped(|p| self.texel_of(p));
        mark_inside(&texels, self.width, self.height, &mut mask);
        mask
    }
}
