//! What the headers state: which camera took a photograph, where, and in which direction.

use nalgebra::{Point3, Rotation3};

use super::options::OrientOptions;
use super::photo::Photo;
use crate::orienting::orientation::{Anchor, geocentric_of, rotation_from_yaw_pitch_roll};
use crate::orienting::structure_from_motion::frame::StatedPose;
use crate::orienting::structure_from_motion::intrinsics::Intrinsics;

/// The cameras that took the photographs.
#[derive(Clone, Debug, Default)]
pub(super) struct Cameras {
    pub intrinsics: Vec<Intrinsics>,
    pub names: Vec<String>,
    /// Whose focal length is not stated?
    pub is_guessed: Vec<bool>,
    pub of_photo: Vec<usize>,
}

impl Cameras {
    /// What the headers state, and guesses where they state nothing.
    pub(super) fn or_guessed(&self, guesses: &[Intrinsics]) -> Vec<Intrinsics> {
        let both = guesses.iter().zip(&self.intrinsics);
        (both.zip(&self.is_guessed))
            .map(|((guess, stated), &is_guessed)| match is_guessed {
                true => guess.clone(),
                false => stated.clone(),
            })
            .collect()
    }

    /// Photographs of one model, size and focal length share a camera.
    pub(super) fn of(photos: &[Photo], options: &OrientOptions) -> Self {
        let mut cameras = Self::default();
        let mut keys: Vec<(&str, [u32; 2], Option<f64>)> = Vec::new();
        for photo in photos {
            let m = &photo.metadata;
            let key = (m.camera.as_str(), photo.size, m.focal_mm);
            let known = keys.iter().position(|k| *k == key);
            cameras.of_photo.push(known.unwrap_or(keys.len()));
            if known.is_none() {
                let focal = options.focal_px.or(m.focal_px);
                let longest = f64::from(photo.size[0].max(photo.size[1]));
                let intrinsics = Intrinsics::new(focal.unwrap_or(longest), photo.size);
                cameras.intrinsics.push(intrinsics);
                cameras.names.push(m.camera.clone());
                cameras.is_guessed.push(focal.is_none());
                keys.push(key);
            }
        }
        cameras
    }
}

/// Stated positions in a frame that touches the Earth, and angles.
pub(super) fn stated_poses(photos: &[Photo]) -> (Vec<StatedPose>, Option<Anchor>) {
    let geocentric = |photo: &Photo| {
        let [lon, lat] = photo.metadata.position?;
        Some(geocentric_of(
            lon,
            lat,
            photo.metadata.height_m.unwrap_or(0.0),
        ))
    };
    let all: Vec<Point3<f64>> = photos.iter().filter_map(geocentric).collect();
    let anchor = (!all.is_empty()).then(|| Anchor::near(&crate::base::geometry::mean_point(&all)));
    let rotation = |photo: &Photo| -> Option<Rotation3<f64>> {
        let [yaw, pitch, roll] = photo.metadata.yaw_pitch_roll?.map(f64::to_radians);
        let from_below = pitch + std::f64::consts::FRAC_PI_2;
        Some(rotation_from_yaw_pitch_roll(yaw, from_below, roll))
    };
    let stated = (photos.iter())
        .map(|photo| StatedPose {
            position: anchor.and_then(|anchor| Some(anchor.local(&geocentric(photo)?))),
            rotation: rotation(photo),
        })
        .collect();
    (stated, anchor)
}
