//! The block while it grows, for a picture of it.

use nalgebra::Point3;

use super::cameras::Stated;
use super::photo::Photo;
use crate::orienting::structure_from_motion::block::{Block, Pose};
use crate::orienting::structure_from_motion::frame::to_frame;
use crate::orienting::structure_from_motion::intrinsics::Intrinsics;

/// A photograph of a growing block.
#[derive(Clone, Debug)]
pub struct SnapshotPhoto {
    /// Its path.
    pub path: String,
    /// Its camera.
    pub intrinsics: Intrinsics,
    /// Where it was taken.
    pub pose: Pose,
}

/// What has been found of the block so far, in the frame that it would have if it were finished.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Photographs with a pose.
    pub photos: Vec<SnapshotPhoto>,
    /// World points with their colours.
    pub points: Vec<(Point3<f64>, [u8; 3])>,
}

impl Snapshot {
    pub(super) fn of(block: &Block, photos: &[Photo], stated: &Stated) -> Self {
        let mut block = block.clone();
        let paths: Vec<&str> = photos.iter().map(|p| p.path.as_str()).collect();
        to_frame(&mut block, &stated.poses, stated.anchor, false, &paths);
        let oriented = (block.photos.iter().zip(photos)).filter_map(|(of_block, photo)| {
            Some(SnapshotPhoto {
                path: photo.path.clone(),
                intrinsics: block.cameras[of_block.camera].clone(),
                pose: of_block.pose.clone()?,
            })
        });
        let points = block.tracks.iter().filter_map(|track| {
            let seen = track.used().next()?;
            Some((track.point?, photos[seen.photo].colours[seen.keypoint]))
        });
        Self {
            photos: oriented.collect(),
            points: points.collect(),
        }
    }
}
