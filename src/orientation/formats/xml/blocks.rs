//! ContextCapture's BlocksExchange.
//!
//! Rotation world to camera (`XRightYDown` unless `CameraOrientation` says `XRightYUp`) and centre;
//! the principal point counts from the centre of the top-left pixel; the focal length is in pixels,
//! or in the unit of `SensorSize`, which belongs to the longer side. P1 and P2 are exchanged against
//! ours, as Metashape's.

use nalgebra::{Matrix3, Point3, Vector3};
use roxmltree::Node;

use super::{Sensor, XmlReader, child, parse, text_of};
use crate::camera::Distortion;
use crate::error::Result;
use crate::orientation::image_orientation::{Orientation, pinhole};

/// Reads a block of ContextCapture.
pub(crate) fn read(path: &str, text: &str) -> Result<Vec<Orientation>> {
    let document = parse(path, text)?;
    let file = XmlReader { path };
    let mut found = Vec::new();
    for group in document
        .descendants()
        .filter(|n| n.has_tag_name("Photogroup"))
    {
        let lens = file.photogroup(group)?;
        let y_up = text_of(group, "CameraOrientation").is_some_and(|o| o == "XRightYUp");
        for photo in group.children().filter(|n| n.has_tag_name("Photo")) {
            let Some(pose) = child(photo, "Pose") else {
                continue;
            };
            let (Some(rotation), Some(center)) = (child(pose, "Rotation"), child(pose, "Center"))
            else {
                continue;
            };
            let r = file.rotation(rotation)?;
            let axes = Vector3::new(1.0, -1.0, -1.0);
            let r = if y_up {
                Matrix3::from_diagonal(&axes) * r
            } else {
                r
            };
            let at = |axis: &str| file.number(center, axis);
            let image = text_of(photo, "ImagePath").unwrap_or_default();
            found.push(Orientation {
                distortion: lens.distortion,
                size: Some(lens.size),
                ..pinhole(
                    image.rsplit(['/', '\\']).next().unwrap_or(image),
                    &file.place(photo),
                    lens.k,
                    r,
                    Point3::new(at("x")?, at("y")?, at("z")?),
                )
            });
        }
    }
    Ok(found)
}

impl XmlReader<'_> {
    fn photogroup(&self, group: Node) -> Result<Sensor> {
        let dimensions = child(group, "ImageDimensions")
            .ok_or_else(|| self.error(group, "ImageDimensions are missing"))?;
        let size = (
            self.number(dimensions, "Width")?,
            self.number(dimensions, "Height")?,
        );
        let longer = size.0.max(size.1);
        let f = match child(group, "FocalLengthPixels") {
            Some(_) => self.number(group, "FocalLengthPixels")?,
            None => {
                self.number(group, "FocalLength")? * longer / self.number(group, "SensorSize")?
            }
        };
        let (cx, cy) = match child(group, "PrincipalPoint") {
            Some(p) => (self.number(p, "x")? + 0.5, self.number(p, "y")? + 0.5),
            None => (size.0 / 2.0, size.1 / 2.0),
        };
        let lens = child(group, "Distortion");
        let or_zero = |name: &str| match lens.and_then(|l| child(l, name).map(|_| l)) {
            Some(lens) => self.number(lens, name),
            None => Ok(0.0),
        };
        Ok(Sensor {
            k: Matrix3::new(f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0),
            distortion: Distortion::brown(
                [or_zero("K1")?, or_zero("K2")?, or_zero("K3")?],
                [or_zero("P2")?, or_zero("P1")?],
            ),
            size: (size.0 as u32, size.1 as u32),
        })
    }

    fn rotation(&self, node: Node) -> Result<Matrix3<f64>> {
        let mut m = Matrix3::zeros();
        for i in 0..3 {
            for j in 0..3 {
                m[(i, j)] = self.number(node, &format!("M_{i}{j}"))?;
            }
        }
        Ok(m)
    }
}
