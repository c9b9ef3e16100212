//! The block before and after its registration: observations with their accuracy, priors of the
//! cameras, and whether the principal point is determined.

use nalgebra::Vector3;

use super::photo::Photo;
use crate::orienting::structure_from_motion::block::{Block, BlockPhoto};
use crate::orienting::structure_from_motion::bundle::{
    BundleOptions, Covariance, adjust, covariance,
};
use crate::orienting::structure_from_motion::features::{FIRST_SIGMA, Keypoint};
use crate::orienting::structure_from_motion::incremental::VerifiedPair;
use crate::orienting::structure_from_motion::intrinsics::{Intrinsics, STATED_FOCAL_PRIOR};
use crate::orienting::structure_from_motion::tracks::{PairMatches, join};
use crate::orienting::structure_from_motion::verification::MatchedPhoto;

/// Prior standard deviations of k1 and k2: weak blocks keep an ordinary lens, strong ones measure
/// any.
const RADIAL_PRIOR: [f64; 2] = [0.05, 0.03];

/// That of f as a share, where it is guessed.
const GUESSED_FOCAL_PRIOR: f64 = 0.5;

/// The principal point is free where the block determines it to this share of the longer side.
const LEAST_CENTER_SIGMA: f64 = 0.001;

/// Photographs whose rows run one way leave it open: longest mean of the directions of their rows.
const LONGEST_MEAN_ROW: f64 = 0.7;

/// Its prior standard deviation, a share of the longer side.
const CENTER_PRIOR: f64 = 0.02;

pub(super) fn prior(is_guessed: &[bool], center_px: f64) -> [f64; 5] {
    let focal = match is_guessed.contains(&true) {
        true => GUESSED_FOCAL_PRIOR,
        false => STATED_FOCAL_PRIOR,
    };
    let [k1, k2] = RADIAL_PRIOR;
    [focal, k1, k2, center_px, center_px]
}

/// Standard deviation of a keypoint as a multiple of that of a fine one: it grows with the scale.
fn factor(keypoint: &Keypoint, pixel: f64) -> f64 {
    (f64::from(keypoint.scale) / pixel / FIRST_SIGMA).max(1.0)
}

pub(super) fn block(
    photos: &[Photo],
    matched: &[MatchedPhoto],
    cameras: &[Intrinsics],
    verified: &[&VerifiedPair],
) -> Block {
    let counts: Vec<usize> = photos.iter().map(|p| p.features.keypoints.len()).collect();
    let pairs: Vec<PairMatches> = (verified.iter())
        .map(|pair| PairMatches {
            photos: pair.photos,
            matches: pair.matches.clone(),
        })
        .collect();
    let photo = |m: &MatchedPhoto| BlockPhoto {
        keypoints: m
            .features
            .keypoints
            .iter()
            .map(|k| k.position.into())
            .collect(),
        camera: m.camera,
        sigma_px: m.sigma_px,
        factors: m
            .features
            .keypoints
            .iter()
            .map(|k| factor(k, m.sigma_px))
            .collect(),
        pose: None,
    };
    Block {
        photos: matched.iter().map(photo).collect(),
        cameras: cameras.to_vec(),
        tracks: join(&counts, &pairs),
    }
}

/// Adjusts the principal point too where the block determines it: photographs that are turned
/// against each other, and a small standard deviation. Where all point one way it follows whatever
/// the camera's model lacks (sheffield: 16 px, and larger differences of the poses). Returned is
/// how the block was adjusted in the end.
pub(super) fn calibrate_center(
    block: &mut Block,
    means: &[Intrinsics],
    is_guessed: &[bool],
    is_held: bool,
) -> Option<BundleOptions> {
    let longest = |c: &Intrinsics| f64::from(c.size[0].max(c.size[1]));
    let most = means.iter().map(longest).fold(0.0, f64::max);
    let options = |center_px: f64| BundleOptions {
        steps: 20,
        least_gain: 1e-8,
        prior: prior(is_guessed, center_px),
    };
    let free = options(CENTER_PRIOR * most);
    let is_determined = |c: &Covariance| {
        c.cameras
            .iter()
            .zip(means)
            .all(|(sigmas, mean)| sigmas[3].max(sigmas[4]) < LEAST_CENTER_SIGMA * longest(mean))
    };
    let rows: Vec<Vector3<f64>> = (block.photos.iter())
        .filter_map(|p| p.pose.as_ref())
        .map(|pose| pose.rotation.inverse() * Vector3::x())
        .collect();
    let mean = rows.iter().fold(Vector3::zeros(), |a, b| a + b) / rows.len() as f64;
    if is_held || mean.norm() > LONGEST_MEAN_ROW {
        return Some(options(0.0));
    }
    if covariance(block, means, &free)
        .as_ref()
        .is_some_and(is_determined)
    {
        adjust(block, means, &free);
        return Some(free);
    }
    Some(options(0.0))
}
