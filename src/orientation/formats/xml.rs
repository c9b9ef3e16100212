//! Orientations in XML: Metashape's `cameras.xml` and ContextCapture's BlocksExchange.
//!
//! * Metashape: 4 x 4 per camera, camera (y down, z forward) to chunk; the chunk's rotation,
//!   translation and scale lead to the world. cx, cy count from the middle of the image; p1 and p2
//!   are exchanged against ours.
//! * BlocksExchange: rotation world to camera (`XRightYDown` unless `CameraOrientation` says
//!   `XRightYUp`) and centre; the principal point counts from the centre of the top-left pixel; the
//!   focal length is in pixels, or in the unit of `SensorSize`, which belongs to the longer side.
//!   P1, P2 as Metashape's.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Matrix4, Point3, Vector3};
use roxmltree::{Document, Node};

use crate::camera::Distortion;
use crate::error::{Error, Result};
use crate::orientation::image_orientation::{Orientation, pinhole};

/// Reads Metashape's cameras.
pub(crate) fn read_metashape(path: &str, text: &str) -> Result<Vec<Orientation>> {
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

/// Reads a block of ContextCapture.
pub(crate) fn read_blocks(path: &str, text: &str) -> Result<Vec<Orientation>> {
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

struct Sensor {
    k: Matrix3<f64>,
    distortion: Option<Distortion>,
    size: (u32, u32),
}

/// Reads elements of one file; refusals name it and the line.
pub(crate) struct XmlReader<'a> {
    pub path: &'a str,
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

    pub(crate) fn number(&self, parent: Node, name: &str) -> Result<f64> {
        let node = child(parent, name)
            .ok_or_else(|| self.error(parent, &format!("<{name}> is missing")))?;
        Ok(self.numbers::<1>(node)?[0])
    }

    pub(crate) fn numbers<const N: usize>(&self, node: Node) -> Result<[f64; N]> {
        let text = node.text().unwrap_or_default();
        let numbers: Vec<f64> = text
            .split_whitespace()
            .filter_map(|f| f.parse().ok())
            .filter(|v: &f64| v.is_finite())
            .collect();
        let wrong = |_| self.error(node, &format!("it does not hold {N} finite numbers"));
        numbers.try_into().map_err(wrong)
    }

    fn place(&self, node: Node) -> String {
        format!("{}, line {}", self.path, line_of(node))
    }

    pub(crate) fn error(&self, node: Node, problem: &str) -> Error {
        Error::Line {
            file: self.path.to_owned(),
            line: line_of(node),
            problem: format!("<{}>: {problem}", node.tag_name().name()),
            expected: "what the program exports; export it again".to_owned(),
        }
    }
}

fn line_of(node: Node) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

pub(crate) fn child<'a, 'b>(node: Node<'a, 'b>, name: &str) -> Option<Node<'a, 'b>> {
    node.children().find(|n| n.has_tag_name(name))
}

pub(crate) fn text_of<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    child(node, name).and_then(|n| n.text()).map(str::trim)
}

pub(crate) fn parse<'a>(path: &str, text: &'a str) -> Result<Document<'a>> {
    Document::parse(text.trim_start_matches('\u{feff}')).map_err(|e| Error::Line {
        file: path.to_owned(),
        line: e.pos().row as usize,
        problem: super::text::quoted_long(&e.to_string()),
        expected: "well-formed XML; export it again".to_owned(),
    })
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
        let found = read_metashape(
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
