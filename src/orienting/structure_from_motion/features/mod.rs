//! Scale- and rotation-invariant keypoints with descriptors: SIFT (Lowe 2004, "Distinctive image
//! features from scale-invariant keypoints"), compared as RootSIFT (Arandjelovic, Zisserman 2012).
//!
//! ```text
//! resample      a photograph at its working size
//! scale_space   Gaussian octaves
//!    -> extrema        extrema of differences of Gaussians, to a fraction of a pixel
//!    -> spread         the strongest, spread over the photograph
//!    -> orientation    dominant directions of the gradient
//!    -> descriptor     4 x 4 histograms of 8 directions, 128 bytes
//! ```
//!
//! Deviation from Lowe: the contrast threshold is lower (0.02 of the grey range, as in most later
//! implementations), because the strongest are chosen afterwards anyway.

mod descriptor;
mod extrema;
mod gradient;
mod orientation;
mod resample;
mod scale_space;
mod spread;

pub(super) use descriptor::{Descriptor, LENGTH};

use serde::{Deserialize, Serialize};

use crate::photographs::raster::Gray;

pub(crate) use self::scale_space::FIRST_SIGMA;
use self::scale_space::ScaleSpace;

/// A keypoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Keypoint {
    /// Column and row in the photograph, pixels (centre of the top-left one at (0.5, 0.5)).
    pub position: [f64; 2],
    /// Standard deviation of the Gaussian at which it is an extremum, pixels of the photograph.
    pub scale: f32,
    /// Dominant direction of the gradient, radians from x towards y.
    pub angle: f32,
    /// Absolute difference of Gaussians, grey range 1.
    pub response: f32,
}

/// Keypoints of a photograph and their descriptors, the strongest first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Features {
    /// Where they are.
    pub keypoints: Vec<Keypoint>,
    /// What they look like, as many.
    #[serde(with = "descriptor::in_a_row")]
    pub descriptors: Vec<Descriptor>,
}

/// How features are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureOptions {
    /// Longest side of the image that is worked on, pixels.
    pub working_px: usize,
    /// Most keypoints of a photograph.
    pub most: usize,
}

impl Default for FeatureOptions {
    /// Working size and number that suffice for blocks of up to a hundred photographs.
    fn default() -> Self {
        Self {
            working_px: 1600,
            most: 4000,
        }
    }
}

/// Images whose longer side is shorter are doubled first (Lowe 2004, section 3.3): larger ones
/// have keypoints enough.
const DOUBLED_BELOW_PX: usize = 1200;

/// The features of a photograph.
pub(super) fn detect_features(photograph: &Gray, options: &FeatureOptions) -> Features {
    let work = resample::to_working_size(photograph, options.working_px);
    let longest = work.width.max(work.height);
    if work.width.min(work.height) < 16 {
        return Features::default();
    }
    let to_photograph = [
        photograph.width as f64 / work.width as f64,
        photograph.height as f64 / work.height as f64,
    ];
    let space = ScaleSpace::new(&work, longest < DOUBLED_BELOW_PX);
    let extrema = extrema::find(&space);
    let size = [work.width as f64, work.height as f64];
    let extrema = spread::strongest(extrema, options.most, size);
    let mut features = Features::default();
    for extremum in &extrema {
        let octave = &space.octaves[extremum.octave];
        for angle in orientation::dominant(octave, extremum) {
            if features.keypoints.len() == options.most {
                return features;
            }
            let [x, y] = extremum.position;
            features.keypoints.push(Keypoint {
                position: [x * to_photograph[0], y * to_photograph[1]],
                scale: (extremum.scale * to_photograph[0]) as f32,
                angle,
                response: extremum.response,
            });
            let descriptor = descriptor::describe(octave, extremum, angle);
            features.descriptors.push(descriptor);
        }
    }
    features
}

#[cfg(test)]
mod tests;
