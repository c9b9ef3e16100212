//! A JSON list of K, R, C: our own conventions; `origin` is added to C.

use nalgebra::{Matrix3, Point3, Vector3};
use serde::Deserialize;

use super::parse;
use crate::base::error::Result;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};

/// Reads a list of K, R, C.
pub(crate) fn read(path: &str, text: &str) -> Result<Vec<Orientation>> {
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

fn matrix(rows: &[[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j])
}
