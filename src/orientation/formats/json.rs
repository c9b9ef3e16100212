//! Orientations in JSON: OpenSfM's reconstruction, nerfstudio's transforms, and lists of K, R, C.
//!
//! * OpenSfM: axis-angle and translation are `cam_from_world`; image coordinates are divided by the
//!   longer side and counted from the centre of the image.
//! * ODM's shots: the same rotation, but the translation is the projection centre in the projected
//!   frame.
//! * nerfstudio: `transform_matrix` is `world_from_cam` with y up and z backwards (OpenGL);
//!   `applied_transform` rotated the world before and is inverted. Intrinsics are stated once or
//!   per frame.
//! * K, R, C: our own conventions; `origin` is added to C.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Matrix4, Point3, Vector3};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::camera::Distortion;
use crate::error::{Error, Result};
use crate::geometry::rotation_from_axis_angle;
use crate::orientation::geodesy::Anchor;
use crate::orientation::image_orientation::{Orientation, pinhole};

/// Reads the first (largest) reconstruction of OpenSfM's `reconstruction.json`.
pub(crate) fn read_opensfm(path: &str, text: &str) -> Result<Vec<Orientation>> {
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
pub(crate) fn opensfm_anchor(text: &str) -> Option<Anchor> {
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

/// Reads a list of K, R, C.
pub(crate) fn read_krc(path: &str, text: &str) -> Result<Vec<Orientation>> {
    let list: KrcList = parse(path, text)?;
    let origin = Vector3::from(list.origin.unwrap_or_default());
    let view = |v: KrcView| Orientation {
        size: v.width.zip(v.height),
        ..pinhole(
            &v.file,
            path,
            matrix(&v.k),
            matrix(&v.r),
            Point3::from(v.c) + origin,
        )
    };
    Ok(list.views.into_iter().map(view).collect())
}

/// Reads nerfstudio's `transforms.json`.
pub(crate) fn read_nerfstudio(path: &str, text: &str) -> Result<Vec<Orientation>> {
    let file: NerfstudioTransforms = parse(path, text)?;
    let undo = match &file.applied_transform {
        None => Matrix4::identity(),
        Some(rows) => homogeneous(rows)
            .try_inverse()
            .ok_or_else(|| refuse(path, "applied_transform is singular"))?,
    };
    let frame = |frame: &NerfstudioFrame| {
        let lens = frame.lens.or(&file.lens);
        let pose = undo * homogeneous(&frame.transform_matrix);
        let turned = pose.fixed_view::<3, 3>(0, 0).into_owned();
        let scale = turned.column(0).norm();
        let axes = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        let r = axes * (turned / scale).transpose();
        let center = Point3::new(pose[(0, 3)], pose[(1, 3)], pose[(2, 3)]);
        Ok(Orientation {
            distortion: lens.distortion(),
            size: lens.w.zip(lens.h).map(|(w, h)| (w as u32, h as u32)),
            ..pinhole(&frame.file_path, path, lens.k(path)?, r, center)
        })
    };
    file.frames.iter().map(frame).collect()
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

#[derive(Deserialize)]
struct KrcList {
    views: Vec<KrcView>,
    origin: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct KrcView {
    file: String,
    width: Option<u32>,
    height: Option<u32>,
    #[serde(rename = "K")]
    k: [[f64; 3]; 3],
    #[serde(rename = "R")]
    r: [[f64; 3]; 3],
    #[serde(rename = "C")]
    c: [f64; 3],
}

#[derive(Deserialize)]
struct NerfstudioTransforms {
    #[serde(flatten)]
    lens: NerfstudioCamera,
    applied_transform: Option<Vec<[f64; 4]>>,
    frames: Vec<NerfstudioFrame>,
}

#[derive(Deserialize)]
struct NerfstudioFrame {
    file_path: String,
    transform_matrix: Vec<[f64; 4]>,
    #[serde(flatten)]
    lens: NerfstudioCamera,
}

#[derive(Clone, Deserialize)]
struct NerfstudioCamera {
    camera_model: Option<String>,
    camera_angle_x: Option<f64>,
    fl_x: Option<f64>,
    fl_y: Option<f64>,
    cx: Option<f64>,
    cy: Option<f64>,
    w: Option<f64>,
    h: Option<f64>,
    k1: Option<f64>,
    k2: Option<f64>,
    k3: Option<f64>,
    p1: Option<f64>,
    p2: Option<f64>,
}

impl NerfstudioCamera {
    /// What a frame leaves out is stated once for all frames.
    fn or(&self, all: &Self) -> Self {
        Self {
            camera_model: self
                .camera_model
                .clone()
                .or_else(|| all.camera_model.clone()),
            camera_angle_x: self.camera_angle_x.or(all.camera_angle_x),
            fl_x: self.fl_x.or(all.fl_x),
            fl_y: self.fl_y.or(all.fl_y),
            cx: self.cx.or(all.cx),
            cy: self.cy.or(all.cy),
            w: self.w.or(all.w),
            h: self.h.or(all.h),
            k1: self.k1.or(all.k1),
            k2: self.k2.or(all.k2),
            k3: self.k3.or(all.k3),
            p1: self.p1.or(all.p1),
            p2: self.p2.or(all.p2),
        }
    }

    fn k(&self, path: &str) -> Result<Matrix3<f64>> {
        if self
            .camera_model
            .as_ref()
            .is_some_and(|m| m.contains("FISHEYE") || m.contains("EQUIRECT"))
        {
            return Err(refuse(path, "its camera model is not a perspective one"));
        }
        let of_angle = || {
            let (angle, w) = self.camera_angle_x.zip(self.w)?;
            let (s, c) = crate::math::sin_cos(angle / 2.0);
            Some(w / 2.0 * c / s)
        };
        let fx = self.fl_x.or_else(of_angle);
        let middle = |c: Option<f64>, size: Option<f64>| c.or(size.map(|s| s / 2.0));
        let (Some(fx), Some(cx), Some(cy)) = (fx, middle(self.cx, self.w), middle(self.cy, self.h))
        else {
            return Err(refuse(path, "a frame lacks fl_x, cx, cy, or w and h"));
        };
        let fy = self.fl_y.unwrap_or(fx);
        Ok(Matrix3::new(fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0))
    }

    fn distortion(&self) -> Option<Distortion> {
        let or_zero = |v: Option<f64>| v.unwrap_or(0.0);
        Distortion::brown(
            [self.k1, self.k2, self.k3].map(or_zero),
            [self.p1, self.p2].map(or_zero),
        )
    }
}

fn matrix(rows: &[[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j])
}

/// Three rows or four of a 4 x 4 matrix; what is missing is that of the identity.
fn homogeneous(rows: &[[f64; 4]]) -> Matrix4<f64> {
    let identity = Matrix4::identity();
    Matrix4::from_fn(|i, j| {
        if i < 3 {
            rows.get(i).map_or(f64::NAN, |r| r[j])
        } else {
            identity[(i, j)]
        }
    })
}

fn parse<T: DeserializeOwned>(path: &str, text: &str) -> Result<T> {
    serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|e| {
        let message = e.to_string();
        let problem = message.split(" at line ").next().unwrap_or_default();
        Error::Line {
            file: path.to_owned(),
            line: e.line().max(1),
            problem: super::text::quoted_long(problem),
            expected: "the JSON that the program writes; export it again".to_owned(),
        }
    })
}

fn refuse(path: &str, problem: &str) -> Error {
    Error::File {
        file: path.to_owned(),
        problem: super::text::quoted_long(problem),
        advice: "export the model again, with undistorted perspective images".to_owned(),
    }
}
