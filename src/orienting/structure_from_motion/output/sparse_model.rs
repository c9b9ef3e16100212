//! COLMAP's text model of an oriented block: `cameras.txt`, `images.txt`, `points3D.txt`.

use std::fmt::Write;

use nalgebra::{Point3, UnitQuaternion, Vector3};

use crate::orienting::orientation::LinearUnit;
use crate::orienting::structure_from_motion::block::Pose;
use crate::orienting::structure_from_motion::intrinsics::Intrinsics;

/// A photograph with its orientation.
#[derive(Clone, Debug)]
pub struct OrientedPhoto {
    /// Its path.
    pub path: String,
    /// Number of its camera.
    pub camera: usize,
    /// Where it was taken; metres, Z up.
    pub pose: Pose,
    /// Image points (pixels) with the number of the world point that each shows.
    pub rays: Vec<([f64; 2], usize)>,
}

/// A world point.
#[derive(Clone, Debug)]
pub struct SparsePoint {
    /// Where it is; metres, Z up.
    pub position: Point3<f64>,
    /// Its colour.
    pub rgb: [u8; 3],
    /// Root mean square distance of its rays, pixels.
    pub rms_px: f64,
    /// Photographs that show it, with the number of the ray in each.
    pub rays: Vec<(usize, usize)>,
}

/// Cameras, oriented photographs, and the points that they share.
#[derive(Clone, Debug, Default)]
pub struct SparseModel {
    /// Interior orientations.
    pub cameras: Vec<Intrinsics>,
    /// Exterior orientations.
    pub photos: Vec<OrientedPhoto>,
    /// The points.
    pub points: Vec<SparsePoint>,
    /// What the files add to all positions, metres: coordinates on a map keep their digits so.
    pub offset: Vector3<f64>,
    /// The unit of positions in the files: that of the map.
    pub unit: LinearUnit,
}

impl SparseModel {
    /// The three files, by name.
    pub fn colmap_files(&self) -> Vec<(String, Vec<u8>)> {
        [
            ("cameras.txt", self.cameras()),
            ("images.txt", self.images()),
            ("points3D.txt", self.points()),
        ]
        .map(|(name, text)| (name.to_owned(), text.into_bytes()))
        .into()
    }

    fn cameras(&self) -> String {
        let mut text = "# CAMERA_ID MODEL WIDTH HEIGHT F CX CY K1 K2\n".to_owned();
        for (i, camera) in self.cameras.iter().enumerate() {
            let ([w, h], [cx, cy], [k1, k2]) = (camera.size, camera.center, camera.radial);
            let f = camera.focal;
            // Writing to a string does not fail.
            let _ = writeln!(text, "{} RADIAL {w} {h} {f} {cx} {cy} {k1} {k2}", i + 1);
        }
        text
    }

    /// A position in the coordinates of the files.
    fn in_files(&self, position: &Point3<f64>) -> Point3<f64> {
        (position + self.offset) / self.unit.metres
    }

    fn images(&self) -> String {
        let mut text = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME\n\
                        # POINTS2D[] as X Y POINT3D_ID\n"
            .to_owned();
        for (i, photo) in self.photos.iter().enumerate() {
            let q = UnitQuaternion::from_rotation_matrix(&photo.pose.rotation);
            let center = self.in_files(&photo.pose.center);
            let t = -(photo.pose.rotation * center.coords);
            let _ = writeln!(
                text,
                "{} {} {} {} {} {} {} {} {} {}",
                i + 1,
                q.w,
                q.i,
                q.j,
                q.k,
                t.x,
                t.y,
                t.z,
                photo.camera + 1,
                photo.path
            );
            let rays: Vec<String> = (photo.rays.iter())
                .map(|([x, y], point)| format!("{x:.3} {y:.3} {}", point + 1))
                .collect();
            text += &rays.join(" ");
            text.push('\n');
        }
        text
    }

    fn points(&self) -> String {
        let mut text =
            "# POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX\n".to_owned();
        for (i, point) in self.points.iter().enumerate() {
            let (p, [r, g, b]) = (self.in_files(&point.position), point.rgb);
            let _ = write!(
                text,
                "{} {:.5} {:.5} {:.5} {r} {g} {b} {:.4}",
                i + 1,
                p.x,
                p.y,
                p.z,
                point.rms_px
            );
            for (photo, ray) in &point.rays {
                let _ = write!(text, " {} {ray}", photo + 1);
            }
            text.push('\n');
        }
        text
    }
}
