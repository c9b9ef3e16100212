//! nerfstudio's `transforms.json`.
//!
//! `transform_matrix` is `world_from_cam` with y up and z backwards (OpenGL); `applied_transform`
//! rotated the world before and is inverted. Intrinsics are stated once or per frame.

use nalgebra::{Matrix3, Matrix4, Point3, Vector3};
use serde::Deserialize;

use super::{parse, refuse};
use crate::camera::Distortion;
use crate::error::Result;
use crate::orientation::image_orientation::{Orientation, pinhole};

/// Reads nerfstudio's `transforms.json`.
pub(crate) fn read(path: &str, text: &str) -> Result<Vec<Orientation>> {
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
