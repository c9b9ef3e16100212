//! The block: photographs with their keypoints, cameras, poses and tracks.

use nalgebra::{Point2, Point3, Rotation3, Vector2, Vector3};

use super::intrinsics::Intrinsics;

/// Exterior orientation: `x_cam = R (X - C)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// R, `cam_from_world`.
    pub rotation: Rotation3<f64>,
    /// C, in units of the block.
    pub center: Point3<f64>,
}

impl Pose {
    /// A point in the axes of the camera.
    pub(super) fn in_camera(&self, world: &Point3<f64>) -> Vector3<f64> {
        self.rotation * (world - self.center)
    }

    /// Direction in the world of a ray (x, y, 1).
    pub(super) fn direction(&self, ray: &Vector2<f64>) -> Vector3<f64> {
        (self.rotation.inverse() * Vector3::new(ray.x, ray.y, 1.0)).normalize()
    }
}

/// A photograph of the block.
#[derive(Clone, Debug)]
pub(super) struct BlockPhoto {
    /// Keypoints, pixels.
    pub keypoints: Vec<Point2<f64>>,
    /// Which camera took it.
    pub camera: usize,
    /// Standard deviation of a keypoint of factor one, pixels.
    pub sigma_px: f64,
    /// Standard deviations of the keypoints as multiples of it: coarse ones are less exact.
    pub factors: Vec<f64>,
    /// Where it was taken, once known.
    pub pose: Option<Pose>,
}

/// One image of a track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Observation {
    pub photo: usize,
    pub keypoint: usize,
    /// Does it count? Outliers do not.
    pub is_used: bool,
}

/// Keypoints that show one place, at most one in a photograph.
#[derive(Clone, Debug)]
pub(super) struct Track {
    /// By photograph.
    pub observations: Vec<Observation>,
    /// The place, once known.
    pub point: Option<Point3<f64>>,
}

impl Track {
    pub(super) fn used(&self) -> impl Iterator<Item = &Observation> {
        self.observations.iter().filter(|o| o.is_used)
    }
}

/// Photographs, cameras and tracks.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub photos: Vec<BlockPhoto>,
    pub cameras: Vec<Intrinsics>,
    pub tracks: Vec<Track>,
}

impl Block {
    pub(super) fn intrinsics(&self, photo: usize) -> &Intrinsics {
        &self.cameras[self.photos[photo].camera]
    }

    pub(super) fn pixel(&self, o: &Observation) -> Point2<f64> {
        self.photos[o.photo].keypoints[o.keypoint]
    }

    /// Standard deviation of an observation, pixels.
    pub(super) fn sigma_px(&self, o: &Observation) -> f64 {
        let photo = &self.photos[o.photo];
        photo.sigma_px * photo.factors[o.keypoint]
    }

    /// The ray (x, y, 1) of an observation.
    pub(super) fn ray(&self, o: &Observation) -> Vector2<f64> {
        self.intrinsics(o.photo).ray(&self.pixel(o))
    }

    /// Distance of an observation from the image of a point in standard deviations; infinite behind
    /// the camera and without a pose.
    pub(super) fn residual(&self, o: &Observation, point: &Point3<f64>) -> f64 {
        let photo = &self.photos[o.photo];
        let Some(pose) = &photo.pose else {
            return f64::INFINITY;
        };
        let p = pose.in_camera(point);
        if p.z <= 1e-9 {
            return f64::INFINITY;
        }
        let seen = self
            .intrinsics(o.photo)
            .project(&Vector2::new(p.x / p.z, p.y / p.z));
        (seen - self.pixel(o)).norm() / self.sigma_px(o)
    }

    pub(super) fn registered(&self) -> Vec<usize> {
        let photos = self.photos.iter().enumerate();
        photos
            .filter(|(_, p)| p.pose.is_some())
            .map(|(i, _)| i)
            .collect()
    }
}
