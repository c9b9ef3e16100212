//! The plane across a main direction, and image lines in it.

use nalgebra::{Matrix2, Point3, Vector2, Vector3};

use crate::planes::objectspace::image_lines::ImageLine;

/// An image line within this of a main direction belongs to it, degrees. Assumption.
pub(crate) const PARALLEL_DEG: f64 = 2.5;
/// ... or within what this displacement of an end does to its direction, px. Assumption.
pub(crate) const END_PX: f64 = 1.5;

/// ClusterAxes of a cluster plane: along the main direction, across it and up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClusterAxes {
    /// Along.
    pub u: Vector3<f64>,
    /// Across, horizontal.
    pub v: Vector3<f64>,
}

impl ClusterAxes {
    /// For a horizontal unit direction.
    pub(crate) fn new(direction: &Vector3<f64>) -> Self {
        Self {
            u: *direction,
            v: Vector3::z().cross(direction),
        }
    }

    /// The world point at (u, v, z).
    pub(crate) fn point(&self, u: f64, v: f64, z: f64) -> Point3<f64> {
        Point3::from(self.u * u + self.v * v + Vector3::z() * z)
    }
}

/// An image line in the cluster plane: `normal . (v, z) = offset`.
pub(crate) struct PlaneRay {
    /// Index of the image line.
    pub image_line: usize,
    pub normal: Vector2<f64>,
    pub offset: f64,
    /// Does its direction by contrast agree with the main direction?
    pub forward: bool,
    /// Pixels per metre.
    pub scale: f64,
}

impl PlaneRay {
    /// `None` for an image line of another direction.
    pub(super) fn new(
        k: usize,
        image_line: &ImageLine,
        axes: &ClusterAxes,
        z_range: [f64; 2],
    ) -> Option<Self> {
        let z = 0.5 * (z_range[0] + z_range[1]);
        let [a, b] = image_line.ends_at(z);
        let middle = nalgebra::center(&a, &b);
        let along = image_line.image_direction(&middle, &axes.u)?;
        let d = image_line.segment.direction();
        let cross = (along.x * d.y - along.y * d.x).abs();
        let tolerance = PARALLEL_DEG.to_radians().max(END_PX / image_line.length_px);
        (cross <= tolerance).then_some(())?;
        let n = image_line.normal;
        let normal = Vector2::new(n.dot(&axes.v), n.z);
        let size = normal.norm();
        let offset =
            n.dot(&image_line.camera.center.coords) - n.dot(&axes.u) * axes.u.dot(&middle.coords);
        (size > 0.1).then(|| Self {
            image_line: k,
            normal: normal / size,
            offset: offset / size,
            forward: along.dot(&d) > 0.0,
            scale: 1.0 / image_line.camera.ground_pixel(&middle),
        })
    }

    /// Where two of them cross, (across, height).
    pub(super) fn meet(&self, other: &Self) -> Option<Vector2<f64>> {
        let m = Matrix2::new(self.normal.x, self.normal.y, other.normal.x, other.normal.y);
        // Rays nearer than 3 degrees leave the height open.
        (m.determinant().abs() > 0.05).then_some(())?;
        Some(m.try_inverse()? * Vector2::new(self.offset, other.offset))
    }

    /// Its points at two heights.
    pub(super) fn drawn(&self, z_range: [f64; 2]) -> [[f64; 2]; 2] {
        z_range.map(|z| [(self.offset - self.normal.y * z) / self.normal.x, z])
    }
}

/// Length that two stretches share; negative when they are apart.
pub(crate) fn overlap(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[1].min(b[1]) - a[0].max(b[0])
}
