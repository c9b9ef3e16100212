//! OpenSfM's reconstruction and ODM's shots.
//!
//! * OpenSfM: axis-angle and translation are `cam_from_world`; image coordinates are divided by the
//!   longer side and counted from the centre of the image.
//! * ODM's shots: the same rotation, but the translation is the projection centre in the projected
//!   frame.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3, Vector3};
use serde::Deserialize;

use super::{parse, refuse};
use crate::camera::Distortion;
use crate::error::Result;
use crate::geometry::rotation_from_axis_angle;
use crate::orientation::geodesy::Anchor;
use crate::orientation::image_orientation::{Orientation, pinhole};

/// Reads the first (largest) reconstruction of OpenSfM's `reconstruction.json`.
pub(crate) fn read(path: &str, text: &str) -> Result<Vec<Orientation>> {
    let reconstructions: Vec<OpenSfm> = parse(path, text)?;
    let largest = reconstructions.iter().max_by_key(|r| r.shots.len());
    let Some(model) = largest else {
        return Err(refuse(path, "it holds no reconstruction"));
    };
    let shot = |(name, shot): (&String, &OpenSfmShot)| {
        let camera = model.cameras.get(&shot.camera).ok_or_else(|| {
            refuse(
                path,
                &format!(
                    "{name} names the camera {:?}, which is missing",
                    shot.camera
                ),
            )
        })?;
        let r = rotation_from_axis_angle(&Vector3::from(shot.rotation)).into_inner();
        Ok(Orientation {
            distortion: camera.distortion(),
            size: Some((camera.width, camera.height)),
            ..pinhole(
                name,
                path,
                camera.k(path)?,
                r,
                Point3::from(-(r.transpose() * Vector3::from(shot.translation))),
            )
        })
    };
    model.shots.iter().map(shot).collect()
}

/// Where OpenSfM's frame touches the Earth: its `reference_lla`.
pub(crate) fn anchor(text: &str) -> Option<Anchor> {
    #[derive(Deserialize)]
    struct Lla {
        latitude: f64,
        longitude: f64,
        altitude: f64,
    }
    #[derive(Deserialize)]
    struct Anchored {
        reference_lla: Lla,
    }
    let models: Vec<Anchored> = serde_json::from_str(text).ok()?;
    let lla = &models.first()?.reference_lla;
    // It is zero where the images have no positions.
    let is_known = (lla.latitude, lla.longitude) != (0.0, 0.0) && lla.latitude.abs() <= 90.0;
    is_known.then_some(Anchor {
        lon_deg: lla.longitude,
        lat_deg: lla.latitude,
        height_m: lla.altitude,
    })
}

/// Reads ODM's `shots.geojson`; `cameras` is `cameras.json`, without which the lens counts as free
/// of distortion.
pub(crate) fn read_shots(
    (path, text): (&str, &str),
    cameras: Option<(&str, &str)>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Orientation>> {
    let shots: OdmShots = parse(path, text)?;
    let cameras: BTreeMap<String, OpenSfmCamera> = match cameras {
        Some((path, text)) => parse(path, text)?,
        None => {
            warnings.push(format!(
                "{path}: there is no cameras.json: the principal point is taken to be in the middle, and the lens free of distortion"
            ));
            BTreeMap::new()
        }
    };
    let shot = |feature: OdmShot| {
        let shot = feature.properties;
        let known = shot.camera.as_ref().and_then(|name| cameras.get(name));
        let camera = known
            .cloned()
            .unwrap_or_else(|| OpenSfmCamera::simple(&shot));
        // Here the translation is the projection centre itself.
        let r = rotation_from_axis_angle(&Vector3::from(shot.rotation)).into_inner();
        Ok(Orientation {
            distortion: camera.distortion(),
            size: Some((shot.width, shot.height)),
            ..pinhole(
                &shot.filename,
                path,
                camera.k(path)?,
                r,
                Point3::from(shot.translation),
            )
        })
    };
    shots.features.into_iter().map(shot).collect()
}

#[derive(Deserialize)]
struct OpenSfm {
    cameras: BTreeMap<String, OpenSfmCamera>,
    shots: BTreeMap<String, OpenSfmShot>,
}

#[derive(Deserialize)]
struct OpenSfmShot {
    rotation: [f64; 3],
    translation: [f64; 3],
    camera: String,
}

#[derive(Deserialize)]
struct OdmShots {
    features: Vec<OdmShot>,
}

#[derive(Deserialize)]
struct OdmShot {
    properties: OdmShotProperties,
}

#[derive(Deserialize)]
struct OdmShotProperties {
    filename: String,
    camera: Option<String>,
    focal: f64,
    width: u32,
    height: u32,
    translation: [f64; 3],
    rotation: [f64; 3],
}

#[derive(Clone, Deserialize)]
struct OpenSfmCamera {
    projection_type: String,
    width: u32,
    height: u32,
    focal: Option<f64>,
    focal_x: Option<f64>,
    focal_y: Option<f64>,
    #[serde(default)]
    c_x: f64,
    #[serde(default)]
    c_y: f64,
    #[serde(default)]
    k1: f64,
    #[serde(default)]
    k2: f64,
    #[serde(default)]
    k3: f64,
    #[serde(default)]
    p1: f64,
    #[serde(default)]
    p2: f64,
}

impl OpenSfmCamera {
    /// The camera of a shot about which nothing more is known.
    fn simple(shot: &OdmShotProperties) -> Self {
        Self {
            projection_type: "perspective".to_owned(),
            width: shot.width,
            height: shot.height,
            focal: Some(shot.focal),
            focal_x: None,
            focal_y: None,
            c_x: 0.0,
            c_y: 0.0,
            k1: 0.0,
            k2: 0.0,
            k3: 0.0,
            p1: 0.0,
            p2: 0.0,
        }
    }

    fn k(&self, path: &str) -> Result<Matrix3<f64>> {
        if !["perspective", "brown", "simple_radial", "radial"].contains(&&*self.projection_type) {
            return Err(refuse(
                path,
                &format!(
                    "the projection type {:?} is not supported",
                    self.projection_type
                ),
            ));
        }
        let longer = f64::from(self.width.max(self.height));
        let fx = self.focal_x.or(self.focal);
        let (Some(fx), Some(fy)) = (fx, self.focal_y.or(fx)) else {
            return Err(refuse(path, "a camera has neither focal nor focal_x"));
        };
        let middle = |size: u32, offset: f64| f64::from(size) / 2.0 + offset * longer;
        let (cx, cy) = (middle(self.width, self.c_x), middle(self.height, self.c_y));
        Ok(Matrix3::new(
            fx * longer,
            0.0,
            cx,
            0.0,
            fy * longer,
            cy,
            0.0,
            0.0,
            1.0,
        ))
    }

    fn distortion(&self) -> Option<Distortion> {
        Distortion::brown([self.k1, self.k2, self.k3], [self.p1, self.p2])
    }
}
