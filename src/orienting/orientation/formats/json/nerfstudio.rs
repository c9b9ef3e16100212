//! nerfstudio's `transforms.json`.
//!
//! `transform_matrix` is `world_from_cam` with y up and z backwards (OpenGL); `applied_transform`
//! rotated the world before, and `applied_scale` multiplied the positions then: both are undone.
//! Intrinsics are stated once or per frame; NeRF's and Blender's form states one angle alone and
//! leaves the size to the images.

use nalgebra::{Matrix3, Matrix4, Point3};
use serde::Deserialize;
use serde_json::{Map, Value};

use super::{parse, refuse};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::angles::Y_UP;
use crate::orienting::orientation::formats::left_out::LeftOut;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::photographs::camera::{Distortion, Projection};

/// Reads nerfstudio's `transforms.json`; `size_of` gives the size of the image that a frame names.
pub(crate) fn read(
    path: &str,
    text: &str,
    size_of: &dyn Fn(&str) -> Option<[u32; 2]>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Orientation>> {
    let file: NerfstudioTransforms = parse(path, text)?;
    let undo = match &file.applied_transform {
        None => Matrix4::identity(),
        Some(rows) => homogeneous(rows)
            .try_inverse()
            .ok_or_else(|| refuse(path, "applied_transform is singular"))?,
    };
    let scale = file.applied_scale.unwrap_or(1.0);
    if !(scale > 0.0 && scale.is_finite()) {
        let problem = format!("applied_scale is {scale}, which is no factor of lengths");
        return Err(refuse(path, &problem));
    }
    let (mut found, mut left_out) = (Vec::new(), LeftOut::default());
    for frame in &file.frames {
        let lens = NerfstudioCamera::of(&frame.lens, &file.lens);
        let mut lens = lens.map_err(|e| refuse(path, &format!("{}: {e}", frame.file_path)))?;
        if lens.w.or(lens.fl_x).is_none()
            && let Some([w, h]) = size_of(&frame.file_path)
        {
            (lens.w, lens.h) = (Some(f64::from(w)), Some(f64::from(h)));
        }
        let k = match lens.k(path, &frame.file_path) {
            Ok(k) => k,
            Err(reason) => {
                left_out.add(&frame.file_path, &reason);
                continue;
            }
        };
        let mut pose = homogeneous(&frame.transform_matrix);
        // The positions were turned and moved first, then multiplied.
        for i in 0..3 {
            pose[(i, 3)] /= scale;
        }
        let pose = undo * pose;
        let turned = pose.fixed_view::<3, 3>(0, 0).into_owned();
        let r = Y_UP * (turned / turned.column(0).norm()).transpose();
        let center = Point3::new(pose[(0, 3)], pose[(1, 3)], pose[(2, 3)]);
        found.push(Orientation {
            distortion: lens.distortion(),
            size: lens.w.zip(lens.h).map(|(w, h)| (w as u32, h as u32)),
            ..pinhole(&frame.file_path, path, k, r, center)
        });
    }
    left_out.finish(found, warnings)
}

#[derive(Deserialize)]
struct NerfstudioTransforms {
    #[serde(flatten)]
    lens: Map<String, Value>,
    applied_transform: Option<Vec<[f64; 4]>>,
    applied_scale: Option<f64>,
    frames: Vec<NerfstudioFrame>,
}

#[derive(Deserialize)]
struct NerfstudioFrame {
    file_path: String,
    transform_matrix: Vec<[f64; 4]>,
    #[serde(flatten)]
    lens: Map<String, Value>,
}

#[derive(Deserialize)]
struct NerfstudioCamera {
    camera_model: Option<String>,
    is_fisheye: Option<bool>,
    camera_angle_x: Option<f64>,
    camera_angle_y: Option<f64>,
    fl_x: Option<f64>,
    fl_y: Option<f64>,
    cx: Option<f64>,
    cy: Option<f64>,
    w: Option<f64>,
    h: Option<f64>,
    k1: Option<f64>,
    k2: Option<f64>,
    k3: Option<f64>,
    k4: Option<f64>,
    p1: Option<f64>,
    p2: Option<f64>,
}

impl NerfstudioCamera {
    /// Of a frame: what it leaves out is stated once for all.
    fn of(frame: &Map<String, Value>, all: &Map<String, Value>) -> serde_json::Result<Self> {
        let own = frame.iter().filter(|(_, value)| !value.is_null());
        let both = all
            .iter()
            .chain(own)
            .map(|(key, value)| (key.clone(), value.clone()));
        Self::deserialize(Value::Object(both.collect()))
    }

    fn k(&self, path: &str, image: &str) -> Result<Matrix3<f64>> {
        const PERSPECTIVE: [&str; 6] = [
            "SIMPLE_PINHOLE",
            "PINHOLE",
            "SIMPLE_RADIAL",
            "RADIAL",
            "OPENCV",
            "PERSPECTIVE",
        ];
        let model = self.camera_model.as_deref().unwrap_or("PINHOLE");
        let is_fisheye = self.is_fisheye();
        if !is_fisheye && !PERSPECTIVE.contains(&&*model.to_ascii_uppercase()) {
            return Err(unsupported_model(path, image, model));
        }
        if is_fisheye && [self.p1, self.p2].iter().any(|p| p.unwrap_or(0.0) != 0.0) {
            return Err(unsupported_model(path, image, "fisheye with p1 and p2"));
        }
        let of_angle = |angle: Option<f64>, size: Option<f64>| {
            // The angle of a fisheye says nothing of its focal length.
            let (angle, size) = angle.filter(|_| !is_fisheye).zip(size)?;
            let (s, c) = crate::base::math::sin_cos(angle / 2.0);
            Some(size / 2.0 * c / s)
        };
        let of_angle_x = || of_angle(self.camera_angle_x, self.w);
        let of_angle_y = || of_angle(self.camera_angle_y, self.h);
        let fx = self.fl_x.or_else(of_angle_x);
        let middle = |c: Option<f64>, size: Option<f64>| c.or(size.map(|s| s / 2.0));
        let (Some(fx), Some(cx), Some(cy)) = (fx, middle(self.cx, self.w), middle(self.cy, self.h))
        else {
            let problem = format!(
                "{image} lacks fl_x, cx, cy, or w and h (camera_angle_x alone is enough where the image is among the files)"
            );
            return Err(refuse(path, &problem));
        };
        let fy = self.fl_y.or_else(of_angle_y).unwrap_or(fx);
        Ok(Matrix3::new(fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0))
    }

    /// OpenCV's fisheye, as nerfstudio's model or instant-ngp's key.
    fn is_fisheye(&self) -> bool {
        let model = self.camera_model.as_deref();
        self.is_fisheye == Some(true)
            || model.is_some_and(|m| m.eq_ignore_ascii_case("OPENCV_FISHEYE"))
    }

    fn distortion(&self) -> Option<Distortion> {
        let or_zero = |v: Option<f64>| v.unwrap_or(0.0);
        let projection = match self.is_fisheye() {
            true => Projection::Equidistant,
            false => Projection::Perspective,
        };
        Distortion::lens(
            projection,
            [self.k1, self.k2, self.k3, self.k4].map(or_zero),
            [self.p1, self.p2].map(or_zero),
        )
    }
}

fn unsupported_model(path: &str, image: &str, model: &str) -> Error {
    let problem = format!("{image} has the camera model \"{model}\", which is not read");
    refuse(path, &problem)
}

/// Three rows or four of a 4 x 4 matrix; what is missing is that of the identity.
fn homogeneous(rows: &[[f64; 4]]) -> Matrix4<f64> {
    let identity = Matrix4::identity();
    Matrix4::from_fn(|i, j| match i {
        3 => identity[(i, j)],
        _ => rows.get(i).map_or(f64::NAN, |row| row[j]),
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::base::math;

    #[test]
    fn an_opencv_fisheye_puts_points_where_opencv_does() {
        let k = [-0.03, 0.004, -0.002, 0.0006];
        let file = |model: &str| {
            format!(
                "{{{model}, \"fl_x\": 300, \"fl_y\": 310, \"cx\": 320, \"cy\": 240, \"w\": 640, \"h\": 480, \"k1\": {}, \"k2\": {}, \
                 \"k3\": {}, \"k4\": {}, \"frames\": [{{\"file_path\": \"a.png\", \
                 \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}}]}}",
                k[0], k[1], k[2], k[3]
            )
        };
        for model in [
            "\"camera_model\": \"OPENCV_FISHEYE\"",
            "\"is_fisheye\": true",
            "\"camera_model\": \"OPENCV\", \"is_fisheye\": true",
        ] {
            let found =
                &read("transforms.json", &file(model), &|_| None, &mut Vec::new()).unwrap()[0];
            for (x, y) in [(0.3, -0.2), (1.2, 0.9), (-1.6, 0.4)] {
                let r = math::hypot(x, y);
                let theta = math::atan(r);
                let t2 = theta * theta;
                let g = 1.0 + k.iter().rev().fold(0.0, |sum, k| (sum + k) * t2);
                let d = found.distortion.unwrap().distort(&[x, y].into());
                let p = found.k * Vector3::new(d.x, d.y, 1.0);
                assert!((p.x - (300.0 * x * theta / r * g + 320.0)).abs() < 1e-9);
                assert!((p.y - (310.0 * y * theta / r * g + 240.0)).abs() < 1e-9);
            }
        }
        for model in [
            "\"camera_model\": \"ORTHOPHOTO\"",
            "\"camera_model\": \"OPENCV_FISHEYE\", \"p1\": 0.1",
        ] {
            assert!(read("transforms.json", &file(model), &|_| None, &mut Vec::new()).is_err());
        }
    }
}
