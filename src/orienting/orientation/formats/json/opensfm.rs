//! OpenSfM's reconstruction and ODM's shots.
//!
//! * OpenSfM: axis-angle and translation are `cam_from_world`; image coordinates are divided by the
//!   longer side and counted from the centre of the image.
//! * ODM's shots: the same rotation, but the translation is the projection centre in the projected
//!   frame.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3, Vector3};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use super::{parse, refuse};
use crate::base::error::{Error, Result, listed};
use crate::base::geometry::rotation_from_axis_angle;
use crate::orienting::orientation::formats::left_out::LeftOut;
use crate::orienting::orientation::formats::of_group;
use crate::orienting::orientation::formats::text::quoted_long;
use crate::orienting::orientation::geodesy::Anchor;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::orienting::orientation::reference::StatedReference;
use crate::photographs::camera::{Distortion, Projection};

/// Reads all reconstructions of OpenSfM's `reconstruction.json`, the largest last.
pub(crate) fn read(path: &str, text: &str, warnings: &mut Vec<String>) -> Result<Vec<Orientation>> {
    let models: Vec<OpenSfm> = parse(path, text)?;
    if models.is_empty() {
        return Err(refuse(path, "it holds no reconstruction"));
    }
    let (mut found, mut left_out) = (Vec::new(), LeftOut::default());
    for (group, model) in by_size(models.iter().map(|m| m.shots.len()), &models) {
        for (name, shot) in &model.shots {
            let camera = named_camera(&model.cameras, &shot.camera)
                .ok_or_else(|| unknown_camera(path, name, &shot.camera, &model.cameras))?;
            let r = rotation_from_axis_angle(&Vector3::from(shot.rotation)).into_inner();
            let center = Point3::from(-(r.transpose() * Vector3::from(shot.translation)));
            let read = OpenSfmCamera::read(path, &shot.camera, camera)
                .and_then(|camera| Ok((camera.size(), camera.k(path, camera.size())?, camera)));
            match read {
                Err(reason) => left_out.add(name, &reason),
                Ok((size, k, camera)) => found.push(Orientation {
                    distortion: camera.distortion(),
                    size: Some(size),
                    group: group.clone(),
                    ..pinhole(name, path, k, r, center)
                }),
            }
        }
    }
    left_out.finish(found, warnings)
}

/// Models with the labels that they have where there are several, the largest last.
fn by_size<T>(
    sizes: impl Iterator<Item = usize>,
    models: &[T],
) -> impl Iterator<Item = (Option<String>, &T)> {
    let mut order: Vec<(usize, usize)> = sizes.enumerate().filter(|(_, n)| *n > 0).collect();
    order.sort_by_key(|&(_, n)| n);
    let several = order.len() > 1;
    order.into_iter().map(move |(i, _)| {
        let label = several.then(|| format!("reconstruction {}", i + 1));
        (label, &models[i])
    })
}

/// Where the frame of a reconstruction touches the Earth: its `reference_lla`, or that of the file
/// `reference_lla.json` beside it.
pub(crate) fn reference(text: &str, lla: Option<&str>, group: Option<&str>) -> StatedReference {
    #[derive(Deserialize)]
    struct Anchored {
        reference_lla: Option<Lla>,
        #[serde(default)]
        shots: BTreeMap<String, IgnoredAny>,
    }
    let models: Vec<Anchored> = parse("", text).unwrap_or_default();
    let model = of_group(
        by_size(models.iter().map(|m| m.shots.len()), &models),
        group,
    );
    let own = model.and_then(|model| model.reference_lla.as_ref()?.anchor());
    let beside = || parse::<Lla>("", lla?).ok()?.anchor();
    own.or_else(beside)
        .map_or(StatedReference::None, StatedReference::Place)
}

#[derive(Deserialize)]
struct Lla {
    latitude: f64,
    longitude: f64,
    altitude: f64,
}

impl Lla {
    fn anchor(&self) -> Option<Anchor> {
        // It is zero where the images have no positions.
        let is_known = (self.latitude, self.longitude) != (0.0, 0.0) && self.latitude.abs() <= 90.0;
        is_known.then_some(Anchor {
            lon_deg: self.longitude,
            lat_deg: self.latitude,
            height_m: self.altitude,
        })
    }
}

/// Reads ODM's `shots.geojson`; `cameras` is `cameras.json`, without which the lens counts as free
/// of distortion.
pub(crate) fn read_shots(
    (path, text): (&str, &str),
    cameras: Option<(&str, &str)>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Orientation>> {
    let shots: OdmShots = parse(path, text)?;
    let read = |(path, text)| Ok::<_, Error>((path, parse::<BTreeMap<String, Value>>(path, text)?));
    let of_file = cameras.map(read).transpose()?;
    if of_file.is_none() {
        warnings.push(format!(
            "{path}: there is no cameras.json: the principal point is taken to be in the middle, and the lens free of distortion"
        ));
    }
    let (mut found, mut left_out, mut guessed) = (Vec::new(), LeftOut::default(), BTreeMap::new());
    for OdmShot { properties: shot } in shots.features {
        let read = match &of_file {
            None => OpenSfmCamera::simple(path, &shot),
            Some((file, cameras)) => {
                let (name, camera) = match &shot.camera {
                    Some(name) => (
                        name,
                        named_camera(cameras, name)
                            .ok_or_else(|| unknown_camera(file, &shot.filename, name, cameras))?,
                    ),
                    None => {
                        let (name, camera) = only_fitting(file, &shot, cameras)?;
                        *guessed.entry(name).or_insert(0) += 1;
                        (name, camera)
                    }
                };
                OpenSfmCamera::read(file, name, camera)
            }
        };
        let read = read.and_then(|camera| {
            // Coordinates are relative to the longer side: those of the shot's own size.
            let size = match (shot.width, shot.height) {
                (0, _) | (_, 0) => camera.size(),
                size => size,
            };
            // Here the translation is the projection centre itself.
            let r = rotation_from_axis_angle(&Vector3::from(shot.rotation)).into_inner();
            let center = Point3::from(shot.translation);
            Ok(Orientation {
                distortion: camera.distortion(),
                size: Some(size),
                ..pinhole(&shot.filename, path, camera.k(path, size)?, r, center)
            })
        });
        match read {
            Err(reason) => left_out.add(&shot.filename, &reason),
            Ok(orientation) => found.push(orientation),
        }
    }
    for (name, count) in guessed {
        warnings.push(format!(
            "{path}: {count} shots name no camera: \"{name}\", whose size and focal length fit, was taken"
        ));
    }
    left_out.finish(found, warnings)
}

/// The camera of this name. ODM takes the "v2 " of OpenSfM's names off when it writes its cameras.
fn named_camera<'a>(cameras: &'a BTreeMap<String, Value>, name: &str) -> Option<&'a Value> {
    let bare = name.strip_prefix("v2 ").unwrap_or(name);
    cameras
        .get(name)
        .or_else(|| cameras.get(bare))
        .or_else(|| cameras.get(&format!("v2 {bare}")))
}

fn unknown_camera(
    path: &str,
    image: &str,
    camera: &str,
    cameras: &BTreeMap<String, Value>,
) -> Error {
    let problem = format!("{image} names the camera \"{camera}\", which is not in it");
    let held = match cameras.is_empty() {
        true => "it holds no camera".to_owned(),
        false => format!("it has {}", listed(cameras.keys())),
    };
    let advice = format!("{held}: take the file of the same run");
    Error::file(path, quoted_long(&problem), quoted_long(&advice))
}

/// The camera that a shot without name was taken with: ODM copies size and focal length from it.
fn only_fitting<'a>(
    path: &str,
    shot: &OdmShotProperties,
    cameras: &'a BTreeMap<String, Value>,
) -> Result<(&'a String, &'a Value)> {
    let fits = |camera: &Value| {
        let number = |key: &str| camera.get(key).and_then(Value::as_f64);
        let focal = number("focal").or_else(|| number("focal_x"));
        number("width") == Some(f64::from(shot.width))
            && number("height") == Some(f64::from(shot.height))
            && focal == shot.focal
    };
    let mut fitting = cameras.iter().filter(|(_, camera)| fits(camera));
    let count = match (fitting.next(), fitting.next()) {
        (Some(one), None) => return Ok(one),
        (Some(_), _) => "more than one",
        (None, _) => "none",
    };
    let name = &shot.filename;
    let problem = format!("{name} names no camera, and {count} has its size and focal length");
    let advice = "take the shots and the cameras of the same run";
    Err(Error::file(path, quoted_long(&problem), advice))
}

#[derive(Deserialize)]
struct OpenSfm {
    // Read where a shot names them: others do no harm.
    cameras: BTreeMap<String, Value>,
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
    focal: Option<f64>,
    #[serde(default)]
    width: u32,
    #[serde(default)]
    height: u32,
    translation: [f64; 3],
    rotation: [f64; 3],
}

#[derive(Deserialize)]
struct OpenSfmCamera {
    projection_type: String,
    width: u32,
    height: u32,
    focal: Option<f64>,
    focal_x: Option<f64>,
    focal_y: Option<f64>,
    #[serde(flatten)]
    terms: OpenSfmTerms,
}

/// Principal point and lens: what is missing is zero.
#[derive(Default, Deserialize)]
#[serde(default)]
struct OpenSfmTerms {
    c_x: f64,
    c_y: f64,
    k1: f64,
    k2: f64,
    k3: f64,
    k4: f64,
    k5: f64,
    k6: f64,
    p1: f64,
    p2: f64,
    s0: f64,
    s1: f64,
    s2: f64,
    s3: f64,
}

impl OpenSfmCamera {
    /// The camera of a shot about which nothing more is known.
    fn simple(path: &str, shot: &OdmShotProperties) -> Result<Self> {
        if shot.focal.is_none() || shot.width.min(shot.height) == 0 {
            let problem = format!("{} states no focal length, width and height", shot.filename);
            return Err(refuse(path, &problem));
        }
        Ok(Self {
            projection_type: "perspective".to_owned(),
            width: shot.width,
            height: shot.height,
            focal: shot.focal,
            focal_x: None,
            focal_y: None,
            terms: OpenSfmTerms::default(),
        })
    }

    fn read(path: &str, name: &str, camera: &Value) -> Result<Self> {
        Self::deserialize(camera).map_err(|e| refuse(path, &format!("its camera \"{name}\": {e}")))
    }

    fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn k(&self, path: &str, (width, height): (u32, u32)) -> Result<Matrix3<f64>> {
        // Of the larger fisheye models the terms that all agree on.
        let t = &self.terms;
        let has_further = [t.p1, t.p2, t.s0, t.s1, t.s2, t.s3] != [0.0; 6];
        let is_perspective =
            ["perspective", "brown", "simple_radial", "radial"].contains(&&*self.projection_type);
        if !is_perspective && (!self.is_fisheye() || has_further) {
            let kind = &self.projection_type;
            let problem = format!("the projection type {kind:?} is not supported");
            return Err(refuse(path, &problem));
        }
        let longer = f64::from(width.max(height));
        let fx = self.focal_x.or(self.focal);
        let (Some(fx), Some(fy)) = (fx, self.focal_y.or(fx)) else {
            return Err(refuse(path, "a camera has neither focal nor focal_x"));
        };
        let middle = |size: u32, offset: f64| f64::from(size) / 2.0 + offset * longer;
        let (cx, cy) = (middle(width, t.c_x), middle(height, t.c_y));
        let [fx, fy] = [fx, fy].map(|f| f * longer);
        Ok(Matrix3::new(fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0))
    }

    fn is_fisheye(&self) -> bool {
        ["fisheye", "fisheye_opencv", "fisheye62", "fisheye624"].contains(&&*self.projection_type)
    }

    fn distortion(&self) -> Option<Distortion> {
        let t = &self.terms;
        if self.is_fisheye() {
            let radial = [t.k1, t.k2, t.k3, t.k4, t.k5, t.k6];
            return Distortion::lens(Projection::Equidistant, radial, [0.0; 2]);
        }
        Distortion::brown([t.k1, t.k2, t.k3], [t.p1, t.p2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;

    #[test]
    fn the_fisheyes_of_opensfm_are_polynomials_of_the_angle() {
        let file = |kind: &str, terms: &str| {
            format!(
                "[{{\"cameras\": {{\"c\": {{\"projection_type\": \"{kind}\", \"width\": 640, \"height\": 480, {terms}}}}}, \
                 \"shots\": {{\"a.jpg\": {{\"rotation\": [0,0,0], \"translation\": [0,0,0], \"camera\": \"c\"}}}}}}]"
            )
        };
        let read = |text: &str| read("reconstruction.json", text, &mut Vec::new());
        let k = [-0.03, 0.004, -0.002, 0.0006];
        let two = format!("\"focal\": 0.5, \"k1\": {}, \"k2\": {}", k[0], k[1]);
        let four = format!(
            "\"focal_x\": 0.5, \"focal_y\": 0.5, \"c_x\": 0, \"c_y\": 0, \"k1\": {}, \"k2\": {}, \"k3\": {}, \"k4\": {}",
            k[0], k[1], k[2], k[3]
        );
        for (kind, terms, count) in [("fisheye", &two, 2), ("fisheye_opencv", &four, 4)] {
            let found = &read(&file(kind, terms)).unwrap()[0];
            for (x, y) in [(0.3, -0.2), (1.2, 0.9), (-1.6, 0.4)] {
                let r = math::hypot(x, y);
                let theta = math::atan(r);
                let t2 = theta * theta;
                let g = 1.0 + k[..count].iter().rev().fold(0.0, |sum, k| (sum + k) * t2);
                let d = found.distortion.unwrap().distort(&[x, y].into());
                let p = found.k * Vector3::new(d.x, d.y, 1.0);
                assert!((p.x - (320.0 * x * theta / r * g + 320.0)).abs() < 1e-9);
                assert!((p.y - (320.0 * y * theta / r * g + 240.0)).abs() < 1e-9);
            }
        }
        assert!(read(&file("fisheye62", &format!("{four}, \"p1\": 0.1"))).is_err());
        assert!(read(&file("dual", &two)).is_err());
    }
}
