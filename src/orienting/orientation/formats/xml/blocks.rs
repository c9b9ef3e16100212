//! ContextCapture's BlocksExchange.
//!
//! * Rotation world to camera, as matrix or as omega, phi, kappa in degrees, and centre. The axes
//!   of the camera are those of `CameraOrientation` (`XRightYDown` unless it is stated).
//! * The principal point counts from the centre of the top-left pixel, in millimetres from the
//!   middle of the sensor along the camera's axes.
//! * The focal length is in pixels, or in the unit of `PixelSize` or of `SensorSize`, which belongs
//!   to the longer side. `AspectRatio` is fy / fx, `Skew` is in pixels. P1 and P2 are exchanged
//!   against ours, as Metashape's.
//! * A block names its reference system by `SRSId`; without it the coordinates are local.

use nalgebra::{Matrix3, Point3, Vector3};
use roxmltree::{Document, Node};

use super::{Sensor, XmlReader, child, parse, text_of};
use crate::base::error::{Error, Result, listed};
use crate::orienting::orientation::angles::{Y_UP, rotation_from_omega_phi_kappa};
use crate::orienting::orientation::formats::left_out::LeftOut;
use crate::orienting::orientation::formats::of_group;
use crate::orienting::orientation::geodesy::Anchor;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::orienting::orientation::input_file::base_name;
use crate::orienting::orientation::reference::{StatedReference, epsg_of};
use crate::photographs::camera::{Distortion, Projection};

/// Reads the oriented photos of all blocks, those of the last block last.
pub(crate) fn read(path: &str, text: &str, warnings: &mut Vec<String>) -> Result<Vec<Orientation>> {
    let document = parse(path, text)?;
    let file = XmlReader { path };
    let (mut found, mut left_out) = (Vec::new(), LeftOut::default());
    let systems = systems(&document);
    for (group, block) in blocks(&document) {
        if let Some(id) = system_of(block).filter(|id| systems.iter().all(|(of, _)| of != id)) {
            warnings.push(format!(
                "{}: the reference system {id} is not in the file: the results name none",
                file.place(block)
            ));
        }
        let photos = file.block(block, &mut left_out, warnings)?;
        found.extend(photos.into_iter().map(|photo| Orientation {
            group: group.clone(),
            ..photo
        }));
    }
    left_out.finish(found, warnings)
}

/// What a block says about the system of its coordinates: the one of this label, else the last.
pub(crate) fn reference(text: &str, group: Option<&str>) -> StatedReference {
    let Ok(document) = parse("", text) else {
        return StatedReference::None;
    };
    let systems = systems(&document);
    let Some(block) = of_group(blocks(&document), group) else {
        return StatedReference::None;
    };
    let Some(id) = system_of(block) else {
        // The format's description: by default the system is a local one.
        return match systems.is_empty() {
            true => StatedReference::None,
            false => StatedReference::Local("its block names no reference system".to_owned()),
        };
    };
    let known = systems.iter().find(|(of, _)| *of == id);
    let Some((_, definition)) = known else {
        return StatedReference::Local(format!(
            "its block names the reference system {id}, which is not in the file"
        ));
    };
    match (east_north_up(definition), epsg_of(definition)) {
        (Some(anchor), _) => StatedReference::Place(anchor),
        (None, Some(code)) => StatedReference::System(code),
        (None, None) => StatedReference::None,
    }
}

/// Ids and definitions of the reference systems.
fn systems<'a>(document: &'a Document) -> Vec<(&'a str, &'a str)> {
    let nodes = document.descendants().filter(|n| n.has_tag_name("SRS"));
    nodes
        .filter_map(|n| Some((text_of(n, "Id")?, text_of(n, "Definition").unwrap_or(""))))
        .collect()
}

/// `ENU:latitude,longitude` with perhaps a height: east, north, up from that place.
fn east_north_up(definition: &str) -> Option<Anchor> {
    let numbers = definition.trim().strip_prefix("ENU:")?;
    let numbers: Vec<f64> = (numbers.split(','))
        .map(|n| n.trim().parse().ok())
        .collect::<Option<_>>()?;
    let (&lat_deg, &lon_deg) = (numbers.first()?, numbers.get(1)?);
    let height_m = numbers.get(2).copied().unwrap_or(0.0);
    let is_place = lat_deg.abs() <= 90.0 && lon_deg.abs() <= 360.0 && height_m.is_finite();
    is_place.then_some(Anchor {
        lon_deg,
        lat_deg,
        height_m,
    })
}

/// The system of a block's photos: its own, or that of its photogroups.
fn system_of<'a>(block: Node<'a, '_>) -> Option<&'a str> {
    let of_group = || {
        photogroups(block)
            .filter(|g| photos(*g).next().is_some())
            .find_map(|g| text_of(g, "SRSId"))
    };
    of_group().or_else(|| text_of(block, "SRSId"))
}

/// The blocks with oriented photos, with their labels where there are several.
fn blocks<'a, 'b>(document: &'a Document<'b>) -> Vec<(Option<String>, Node<'a, 'b>)> {
    let nodes = document.descendants().filter(|n| n.has_tag_name("Block"));
    let mut nodes: Vec<Node> = nodes.filter(|block| has_photos(*block)).collect();
    if nodes.is_empty() {
        nodes.extend([document.root_element()].iter().filter(|n| has_photos(**n)));
    }
    let mut labels: Vec<String> = Vec::new();
    for (i, block) in nodes.iter().enumerate() {
        let name = text_of(*block, "Name").filter(|name| !name.is_empty());
        let mut label = name.map_or_else(|| format!("block {}", i + 1), str::to_owned);
        if labels.contains(&label) {
            label = format!("{label} ({})", i + 1);
        }
        labels.push(label);
    }
    let several = nodes.len() > 1;
    (labels.into_iter().zip(nodes))
        .map(|(label, block)| (several.then_some(label), block))
        .collect()
}

fn has_photos(block: Node) -> bool {
    photogroups(block).any(|group| photos(group).next().is_some())
}

fn photogroups<'a, 'b>(block: Node<'a, 'b>) -> impl Iterator<Item = Node<'a, 'b>> {
    block.descendants().filter(|n| n.has_tag_name("Photogroup"))
}

/// The photos with a complete pose: photo, rotation and centre.
fn photos<'a, 'b>(
    group: Node<'a, 'b>,
) -> impl Iterator<Item = (Node<'a, 'b>, Node<'a, 'b>, Node<'a, 'b>)> {
    let photos = group.children().filter(|n| n.has_tag_name("Photo"));
    photos.filter_map(|photo| {
        let pose = child(photo, "Pose")?;
        Some((photo, child(pose, "Rotation")?, child(pose, "Center")?))
    })
}

impl XmlReader<'_> {
    fn block(
        &self,
        block: Node,
        left_out: &mut LeftOut,
        warnings: &mut Vec<String>,
    ) -> Result<Vec<Orientation>> {
        // 0 is no component: the pose is what the navigation measured.
        let is_measured = |photo: Node| text_of(photo, "Component") == Some("0");
        let all = || photogroups(block).flat_map(photos);
        let is_mixed = all().any(|(photo, ..)| !is_measured(photo));
        let system = system_of(block);
        let (mut found, mut unadjusted) = (Vec::new(), Vec::new());
        for group in photogroups(block).filter(|g| photos(*g).next().is_some()) {
            let of_group = text_of(group, "SRSId").or_else(|| text_of(block, "SRSId"));
            if of_group != system {
                let problem = "its photos stand in another reference system than those before it";
                return Err(self.refusal(group, problem, "one <SRSId> for a block"));
            }
            let lens = self.photogroup(group);
            for (photo, rotation, center) in photos(group) {
                let image = text_of(photo, "ImagePath").unwrap_or_default();
                let image = base_name(image);
                if is_mixed && is_measured(photo) {
                    unadjusted.push(image);
                    continue;
                }
                let (lens, image_from_camera) = match &lens {
                    Ok(lens) => lens,
                    Err(reason) => {
                        left_out.add(image, reason);
                        continue;
                    }
                };
                let at = |axis: &str| self.number(center, axis);
                let center = Point3::new(at("x")?, at("y")?, at("z")?);
                let r = image_from_camera * self.rotation(rotation)?;
                found.push(Orientation {
                    distortion: lens.distortion,
                    size: Some(lens.size),
                    ..pinhole(image, &self.place(photo), lens.k, r, center)
                });
            }
        }
        if !unadjusted.is_empty() {
            warnings.push(format!(
                "photos that the aerotriangulation left out (component 0) are left out: {} ({})",
                listed(&unadjusted),
                self.path
            ));
        } else if !is_mixed && !found.is_empty() {
            warnings.push(format!(
                "{}: no photo is in a component: the poses are those before an aerotriangulation",
                self.place(block)
            ));
        }
        Ok(found)
    }

    /// The lens of a photogroup, and what leads from the camera's axes to the image's.
    fn photogroup(&self, group: Node) -> Result<(Sensor, Matrix3<f64>)> {
        let model = text_of(group, "CameraModelType").unwrap_or("Perspective");
        if !["Perspective", "Fisheye"].contains(&model) {
            return Err(self.unknown_model(group, model));
        }
        let image_from_camera = self.axes(group)?;
        let dimensions = self.child(group, "ImageDimensions")?;
        let side = |name: &str| self.number(dimensions, name);
        let (width, height) = (side("Width")?, side("Height")?);
        let pixel_mm = || match child(group, "PixelSize") {
            Some(_) => self.number(group, "PixelSize"),
            None if child(group, "SensorSize").is_some() => {
                Ok(self.number(group, "SensorSize")? / width.max(height))
            }
            None => Err(self.error(group, "<SensorSize> or <PixelSize> is missing")),
        };
        let middle = Vector3::new(width / 2.0, height / 2.0, 0.0);
        let principal = match child(group, "PrincipalPoint") {
            Some(p) if child(p, "xmm").is_some() => {
                let mm = Vector3::new(self.number(p, "xmm")?, self.number(p, "ymm")?, 0.0);
                middle + image_from_camera * mm / pixel_mm()?
            }
            Some(p) => Vector3::new(self.number(p, "x")? + 0.5, self.number(p, "y")? + 0.5, 0.0),
            None => middle,
        };
        let size = (width as u32, height as u32);
        if model == "Fisheye" {
            let (mut k, distortion) = self.fisheye(group)?;
            (k[(0, 2)], k[(1, 2)]) = (principal.x, principal.y);
            return Ok((
                Sensor {
                    k,
                    distortion,
                    size,
                },
                image_from_camera,
            ));
        }
        let f = match child(group, "FocalLengthPixels") {
            Some(_) => self.number(group, "FocalLengthPixels")?,
            None => self.number(group, "FocalLength")? / pixel_mm()?,
        };
        let fy = f * self.number_or(group, "AspectRatio", 1.0)?;
        let skew = self.number_or(group, "Skew", 0.0)?;
        let k = Matrix3::new(f, skew, principal.x, 0.0, fy, principal.y, 0.0, 0.0, 1.0);
        let distortion = self.distortion(group)?;
        Ok((
            Sensor {
                k,
                distortion,
                size,
            },
            image_from_camera,
        ))
    }

    fn distortion(&self, group: Node) -> Result<Option<Distortion>> {
        let Some(lens) = child(group, "Distortion") else {
            return Ok(None);
        };
        for term in lens.children().filter(Node::is_element) {
            let name = term.tag_name().name();
            let is_known = ["K1", "K2", "K3", "P1", "P2"].contains(&name);
            if !is_known && self.numbers::<1>(term).ok() != Some([0.0]) {
                let problem = "this term of the distortion is not read";
                return Err(self.refusal(term, problem, "K1, K2, K3, P1, P2"));
            }
        }
        let term = |name: &str| self.number_or(lens, name, 0.0);
        Ok(Distortion::brown(
            [term("K1")?, term("K2")?, term("K3")?],
            [term("P2")?, term("P1")?],
        ))
    }

    /// Pixels from the principal point are M (x, y) / r of the polynomial P0 + P1 t + ... + P4
    /// t^4 of t = 2 theta / pi, with the matrix M.
    fn fisheye(&self, group: Node) -> Result<(Matrix3<f64>, Option<Distortion>)> {
        let matrix = self.child(group, "FisheyeFocalMatrix")?;
        let term = |name: &str| self.number_or(matrix, name, 0.0);
        if term("M_10")? != 0.0 {
            let expected = "M_10 = 0: adjust the fisheye symmetrically";
            return Err(self.refusal(matrix, "a sheared matrix is not read", expected));
        }
        let mut terms = [0.0, 1.0, 0.0, 0.0, 0.0];
        if let Some(lens) = child(group, "FisheyeDistortion") {
            for (i, term) in terms.iter_mut().enumerate() {
                *term = self.number_or(lens, &format!("P{i}"), *term)?;
            }
        }
        // So that the focal length is that of small angles.
        let unit = std::f64::consts::FRAC_PI_2;
        let own = |name: &str| self.number(matrix, name);
        let [m00, m01, m11] = [own("M_00")?, term("M_01")?, own("M_11")?].map(|m| m / unit);
        let of_angle = Projection::OfAngle(terms.map(|p| p * unit));
        Ok((
            Matrix3::new(m00, m01, 0.0, 0.0, m11, 0.0, 0.0, 0.0, 1.0),
            Distortion::lens(of_angle, [], [0.0; 2]),
        ))
    }

    fn unknown_model(&self, group: Node, model: &str) -> Error {
        let problem = format!("cameras of the model \"{model}\" are not read");
        let expected = "Perspective or Fisheye: export undistorted photos with their block";
        self.refusal(group, &problem, expected)
    }

    /// What leads from the camera's axes to x right, y down, z forward.
    fn axes(&self, group: Node) -> Result<Matrix3<f64>> {
        const ALL: &str = "XRightYDown, XRightYUp, XLeftYDown, XLeftYUp, XDownYRight, XDownYLeft, \
                           XUpYRight or XUpYLeft";
        let stated = text_of(group, "CameraOrientation").unwrap_or("XRightYDown");
        let direction = |word: &str| match word {
            "Right" => Some(Vector3::x()),
            "Left" => Some(-Vector3::x()),
            "Down" => Some(Vector3::y()),
            "Up" => Some(-Vector3::y()),
            _ => None,
        };
        let words = stated.strip_prefix('X').and_then(|s| s.split_once('Y'));
        let axes = words.and_then(|(x, y)| Some((direction(x)?, direction(y)?)));
        match axes.filter(|(x, y)| x.dot(y) == 0.0) {
            Some((x, y)) => Ok(Matrix3::from_columns(&[x, y, x.cross(&y)])),
            None => {
                let problem = format!("its CameraOrientation \"{stated}\" is not known");
                Err(self.refusal(group, &problem, ALL))
            }
        }
    }

    /// From the world to the camera.
    fn rotation(&self, node: Node) -> Result<Matrix3<f64>> {
        if child(node, "Omega").is_some() {
            let angle = |name: &str| Ok(self.number(node, name)?.to_radians());
            let r = rotation_from_omega_phi_kappa(angle("Omega")?, angle("Phi")?, angle("Kappa")?);
            // That rotation leads to y down, z forward; the format's to y up, z back.
            return Ok(Y_UP * r.into_inner());
        }
        if let Some(angle) = ["Yaw", "Heading", "Pitch", "Roll"]
            .iter()
            .find_map(|name| child(node, name))
        {
            let expected = "the matrix M_00 to M_22, or Omega, Phi, Kappa: choose one on exporting";
            return Err(self.refusal(angle, "rotations of this kind are not read", expected));
        }
        let mut m = Matrix3::zeros();
        for i in 0..3 {
            for j in 0..3 {
                m[(i, j)] = self.number(node, &format!("M_{i}{j}"))?;
            }
        }
        Ok(m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;
    use nalgebra::Point2;

    fn seen(found: &Orientation, x: f64, y: f64) -> [f64; 2] {
        let put = found.distortion.unwrap().distort(&Point2::new(x, y));
        let pixel = found.k * Vector3::new(put.x, put.y, 1.0);
        [pixel.x, pixel.y]
    }

    fn block(camera: &str) -> Result<Vec<Orientation>> {
        let unit = "<M_00>1</M_00><M_01>0</M_01><M_02>0</M_02><M_10>0</M_10><M_11>1</M_11><M_12>0</M_12>\
                    <M_20>0</M_20><M_21>0</M_21><M_22>1</M_22>";
        read(
            "block.xml",
            &format!(
                "<BlocksExchange><Photogroup><ImageDimensions><Width>1200</Width><Height>900</Height></ImageDimensions>\
                 <PrincipalPoint><x>610</x><y>440</y></PrincipalPoint>{camera}<Photo><ImagePath>a.jpg</ImagePath><Pose>\
                 <Rotation>{unit}</Rotation><Center><x>0</x><y>0</y><z>0</z></Center></Pose></Photo>\
                 </Photogroup></BlocksExchange>"
            ),
            &mut Vec::new(),
        )
    }

    #[test]
    fn the_fisheye_of_blocks_is_a_polynomial_of_the_angle() {
        let terms = [0.001, 1.0, 0.05, -0.2, 0.1];
        let of = |m10: f64| {
            let p: String = (0..5)
                .map(|i| format!("<P{i}>{}</P{i}>", terms[i]))
                .collect();
            block(&format!(
                "<CameraModelType>Fisheye</CameraModelType><FisheyeFocalMatrix><M_00>1100</M_00><M_01>2</M_01>\
                 <M_10>{m10}</M_10><M_11>1090</M_11></FisheyeFocalMatrix><FisheyeDistortion>{p}</FisheyeDistortion>"
            ))
        };
        let found = &of(0.0).unwrap()[0];
        for (x, y) in [(0.31, 0.22), (-1.35, 0.9), (0.05, -1.6)] {
            let r = math::hypot(x, y);
            let t = math::atan(r) * 2.0 / std::f64::consts::PI;
            let radius = terms.iter().rev().fold(0.0, |sum, p| sum * t + p);
            let (u, v) = (x * radius / r, y * radius / r);
            let [column, row] = seen(found, x, y);
            assert!((column - (1100.0 * u + 2.0 * v + 610.5)).abs() < 1e-9);
            assert!((row - (1090.0 * v + 440.5)).abs() < 1e-9);
        }
        assert!(of(3.0).unwrap_err().to_string().contains("M_10"));
    }
}
