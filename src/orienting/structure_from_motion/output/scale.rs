//! The scale of a block, and curves that belong to its cameras: what is asked of a finished model.

use nalgebra::{Point2, Point3, Vector3};

use super::report::OrientReport;
use super::sparse_model::SparseModel;
use crate::orienting::orientation::FrameSigma;

/// Points of an epipolar curve.
const CURVE_POINTS: usize = 49;

/// Depths of an epipolar curve, as shares of the least and the largest depth of the points that the
/// photograph sees. Assumption: what is marked may be nearer or farther than whatever was matched.
const NEAREST_DEPTH_SHARE: f64 = 0.3;
const FARTHEST_DEPTH_SHARE: f64 = 6.0;

impl SparseModel {
    /// Enlarges the model about a point of its frame.
    pub(in super::super) fn scale(&mut self, factor: f64, fixed: &Point3<f64>) {
        let enlarge = |p: &mut Point3<f64>| *p = fixed + (*p - fixed) * factor;
        for photo in &mut self.photos {
            enlarge(&mut photo.pose.center);
        }
        for point in &mut self.points {
            enlarge(&mut point.position);
        }
    }

    /// The image in photograph `second` of the ray through a pixel of photograph `first`, from
    /// near to far: a straight line but for the lens. Empty where the ray is not seen.
    pub fn epipolar_curve(
        &self,
        first: usize,
        second: usize,
        pixel: &Point2<f64>,
    ) -> Vec<Point2<f64>> {
        let (Some(from), Some(to)) = (self.photos.get(first), self.photos.get(second)) else {
            return Vec::new();
        };
        let depths = (from.rays.iter())
            .filter_map(|(_, point)| self.points.get(*point))
            .map(|point| from.pose.in_camera(&point.position).z)
            .filter(|depth| *depth > 0.0);
        let (near, far) = depths.fold((f64::INFINITY, 0.0f64), |(near, far), depth| {
            (near.min(depth), far.max(depth))
        });
        if far <= 0.0 {
            return Vec::new();
        }
        let ray = self.cameras[from.camera].ray(pixel).push(1.0);
        let direction = from.pose.rotation.inverse() * ray;
        let camera = &self.cameras[to.camera];
        // Even steps of the inverse depth are about even steps along the image.
        let [most, least] = [
            1.0 / (NEAREST_DEPTH_SHARE * near),
            1.0 / (FARTHEST_DEPTH_SHARE * far),
        ];
        (0..CURVE_POINTS)
            .map(|i| most + (least - most) * i as f64 / (CURVE_POINTS - 1) as f64)
            .map(|inverse| from.pose.center + direction / inverse)
            .map(|world| to.pose.in_camera(&world))
            .filter(|p| p.z > 0.0)
            .map(|p| camera.project(&(p.xy() / p.z)))
            .collect()
    }
}

impl OrientReport {
    /// After [`SparseModel::scale`], which has `moved` each photograph: lengths follow, and the
    /// frame says what its scale rests on.
    pub(in super::super) fn scale(&mut self, factor: f64, moved: &[Vector3<f64>], words: &str) {
        for (photo, moved) in self.photos.iter_mut().zip(moved) {
            photo.sigma_m = photo.sigma_m.map(|sigma| sigma.map(|s| s * factor));
            let further = |d: Option<[f64; 3]>| d.map(|d| (Vector3::from(d) + moved).into());
            photo.from_stated_m = further(photo.from_stated_m);
            photo.residual_m = further(photo.residual_m);
        }
        self.frame = match self.frame.split_once("; scale from ") {
            Some((before, _)) => format!("{before}; scale from {words}"),
            None => format!("{}; scale from {words}", self.frame),
        };
        // How well the length is known is not stated; the level stays.
        self.frame_sigma = (self.frame_sigma.as_ref()).map(|sigma| FrameSigma {
            length_of_10_m: None,
            ..*sigma
        });
        self.is_metric = true;
        self.warnings.retain(|w| w != super::ARBITRARY_SCALE);
    }
}
