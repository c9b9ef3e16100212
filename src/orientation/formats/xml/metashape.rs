//! Metashape's `cameras.xml`.
//!
//! 4 x 4 per camera, camera (y down, z forward) to chunk; the chunk's rotation, translation and
//! scale lead to the world. cx, cy count from the middle of the image; p1 and p2 are exchanged
//! against ours.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Matrix4, Point3, Vector3};
use roxmltree::Node;

use super::{Sensor, XmlReader, child, parse};
use crate::camera::Distortion;
use crate::error::Result;
use crate::orientation::image_orientation::{Orientation, pinhole};

/// Reads Metashape's cameras.
pub(crate) fn read(path: &str, text: &str) -> Result<Vec<Orientation>> {
    let document = parse(path, text)?;
    let file = XmlReader { path };
    let mut found = Vec::new();
    for chunk in document.descendants().filter(|n| n.has_tag_name("chunk")) {
        let sensors = file.sensors(chunk)?;
        let world_from_chunk = match child(chunk, "transform") {
            Some(transform) => file.chunk_transform(transform)?,
            None => Matrix4::identity(),
        };
        for camera in chunk.descendants().filter(|n| n.has_tag_name("camera")) {
            // Cameras without a transform were not aligned.
            let Some(transform) = child(camera, "transform") else {
                continue;
            };
            let pose = world_from_chunk * Matrix4::from_row_slice(&file.numbers::<16>(transform)?);
            let lens = camera
                .attribute("sensor_id")
                .and_then(|id| sensors.get(id))
                .ok_or_else(|| file.error(camera, "its sensor has no calibration"))?;
            let turned = pose.fixed_view::<3, 3>(0, 0).into_owned();
            let r = (turned / turned.column(0).norm()).transpose();
            let label = camera.attribute("label").unwrap_or_default();
            found.push(Orientation {
                distortion: lens.distortion,
                size: Some(lens.size),
                ..pinhole(
                    label,
                    &file.place(camera),
                    lens.k,
                    r,
                    Point3::new(pose[(0, 3)], pose[(1, 3)], pose[(2, 3)]),
                )
            });
        }
    }
    Ok(found)
}

impl XmlReader<'_> {
    fn sensors(&self, chunk: Node) -> Result<BTreeMap<String, Sensor>> {
        let mut lenses = BTreeMap::new();
        for sensor in chunk.descendants().filter(|n| n.has_tag_name("sensor")) {
            let calibrations = || sensor.children().filter(|n| n.has_tag_name("calibration"));
            let adjusted = calibrations().find(|n| n.attribute("class") == Some("adjusted"));
            let Some(calibration) = adjusted.or_else(|| calibrations().next()) else {
                continue;
            };
            if sensor.attribute("type").is_some_and(|t| t != "frame") {
                return Err(self.error(sensor, "only frame cameras are supported"));
            }
            let resolution = child(calibration, "resolution")
                .or_else(|| child(sensor, "resolution"))
                .ok_or_else(|| self.error(calibration, "the resolution is missing"))?;
            let side = |name: &str| {
                let value = resolution.attribute(name).and_then(|v| v.parse().ok());
                value.ok_or_else(|| self.error(resolution, "width and height are no whole numbers"))
            };
            let size: (u32, u32) = (side("width")?, side("height")?);
            let f = self.number(calibration, "f")?;
            let or_zero = |name: &str| match child(calibration, name) {
                Some(_) => self.number(calibration, name),
                None => Ok(0.0),
            };
            let (cx, cy) = (or_zero("cx")?, or_zero("cy")?);
            let (b1, b2) = (or_zero("b1")?, or_zero("b2")?);
            let (w, h) = (f64::from(size.0), f64::from(size.1));
            let lens = Sensor {
                k: Matrix3::new(
                    f + b1,
                    b2,
                    w / 2.0 + cx,
                    0.0,
                    f,
                    h / 2.0 + cy,
                    0.0,
                    0.0,
                    1.0,
                ),
                distortion: Distortion::brown(
                    [
                        or_zero("k1")?,
                        or_zero("k2")?,
                        or_zero("k3")?,
                        or_zero("k4")?,
                    ],
                    [or_zero("p2")?, or_zero("p1")?],
                ),
                size,
            };
            lenses.insert(sensor.attribute("id").unwrap_or_default().to_owned(), lens);
        }
        Ok(lenses)
    }

    fn chunk_transform(&self, transform: Node) -> Result<Matrix4<f64>> {
        let mut m = Matrix4::identity();
        let scale = match child(transform, "scale") {
            Some(node) => self.numbers::<1>(node)?[0],
            None => 1.0,
        };
        if let Some(node) = child(transform, "rotation") {
            let r = Matrix3::from_row_slice(&self.numbers::<9>(node)?);
            m.fixed_view_mut::<3, 3>(0, 0).copy_from(&(r * scale));
        }
        if let Some(node) = child(transform, "translation") {
            let t = Vector3::from(self.numbers::<3>(node)?);
            m.fixed_view_mut::<3, 1>(0, 3).copy_from(&t);
        }
        Ok(m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn the_lens_of_metashape_puts_points_where_its_manual_says() {
        let terms = [
            ("f", 1500.0),
            ("cx", 12.0),
            ("cy", -7.0),
            ("b1", 0.8),
            ("b2", -0.3),
            ("k1", -0.06),
            ("k2", 0.02),
            ("k3", -0.004),
            ("k4", 0.03),
            ("p1", 0.0012),
            ("p2", -0.0007),
        ];
        let calibration: String = terms.map(|(n, v)| format!("<{n}>{v}</{n}>")).concat();
        let found = read(
            "cameras.xml",
            &format!(
                "<document><chunk><sensors><sensor id=\"0\" type=\"frame\"><calibration class=\"adjusted\">\
                 <resolution width=\"1200\" height=\"900\"/>{calibration}</calibration></sensor></sensors><cameras>\
                 <camera id=\"0\" sensor_id=\"0\" label=\"a\">\
                 <transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform></camera></cameras></chunk></document>"
            ),
        )
        .unwrap();
        let [f, cx, cy, b1, b2, k1, k2, k3, k4, p1, p2] = terms.map(|t| t.1);
        for (x, y) in [(0.31, 0.22), (-0.35, 0.1), (0.05, -0.28)] {
            let r2: f64 = x * x + y * y;
            let g = 1.0 + k1 * r2 + k2 * r2 * r2 + (k3 + k4 * r2) * r2 * r2 * r2;
            let u = x * g + p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y;
            let v = y * g + p2 * (r2 + 2.0 * y * y) + 2.0 * p1 * x * y;
            let (column, row) = (600.0 + cx + u * (f + b1) + v * b2, 450.0 + cy + v * f);
            let put = found[0].distortion.unwrap().distort(&Point2::new(x, y));
            let pixel = found[0].k * Vector3::new(put.x, put.y, 1.0);
            assert!((pixel.x - column).abs() < 1e-9 && (pixel.y - row).abs() < 1e-9);
        }
    }
}
