//! Metashape's and PhotoScan's `cameras.xml`.
//!
//! * 4 x 4 per camera, camera (y down, z forward) to the frame of its component; rotation,
//!   translation and scale of the component (of the chunk before version 2) lead to the world.
//! * `f`: cx, cy count from the middle of the image, b1 = fx - fy, b2 is the skew, and p1 and p2
//!   are exchanged against ours.
//! * `fx`, `fy` (PhotoScan up to 1.1, MeshLab): cx, cy count from the corner, p1 and p2 are ours.
//! * A slave of a rig stands where its master stands, turned and moved by the `rotation` and
//!   `location` of its sensor in the master's frame (metres).

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Matrix4, Point3, Vector3};
use roxmltree::{Document, Node};

use super::{Sensor, XmlReader, child, parse};
use crate::base::error::{Error, Result, listed};
use crate::orienting::orientation::formats::left_out::LeftOut;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::photographs::camera::{Distortion, Projection};

/// Reads the aligned cameras of all chunks, those of the chunk in use last.
pub(crate) fn read(path: &str, text: &str, warnings: &mut Vec<String>) -> Result<Vec<Orientation>> {
    let document = parse(path, text)?;
    let file = XmlReader { path };
    let mut groups = Vec::new();
    let mut left_out = LeftOut::default();
    for (label, node) in chunks(&document) {
        let chunk = Chunk::new(&file, node, &label)?;
        let cameras = chunk.cameras(&mut left_out, warnings)?;
        if !cameras.is_empty() {
            groups.push((label, cameras));
        }
    }
    let several = groups.len() > 1;
    let mut found = Vec::new();
    for (label, cameras) in groups {
        found.extend(cameras.into_iter().map(|camera| Orientation {
            group: several.then(|| label.clone()),
            ..camera
        }));
    }
    left_out.finish(found, warnings)
}

/// The chunks with their labels: disabled ones first, the active one last.
fn chunks<'a, 'b>(document: &'a Document<'b>) -> Vec<(String, Node<'a, 'b>)> {
    let all = || document.descendants();
    let active = all().find_map(|n| {
        n.attribute("active_id")
            .filter(|_| n.has_tag_name("chunks"))
    });
    let nodes = all().filter(|n| n.has_tag_name("chunk"));
    let mut chunks: Vec<(String, Node)> = nodes
        .enumerate()
        .map(|(i, node)| {
            let label = node.attribute("label").filter(|l| !l.trim().is_empty());
            let label = label.map_or_else(|| format!("chunk {}", i + 1), str::to_owned);
            (label, node)
        })
        .collect();
    chunks.sort_by_key(|(_, node)| {
        let is_active = active.is_some() && node.attribute("id") == active;
        (is_active, is_on(*node))
    });
    // Two chunks of one label would be one group.
    for i in 1..chunks.len() {
        if chunks[..i].iter().any(|(label, _)| *label == chunks[i].0) {
            chunks[i].0 = format!("{} ({})", chunks[i].0, i + 1);
        }
    }
    chunks
}

/// Is the chunk or camera enabled?
fn is_on(node: Node) -> bool {
    let value = node.attribute("enabled").map(str::trim);
    !matches!(value, Some("false" | "False" | "0"))
}

/// A chunk while it is read.
struct Chunk<'a, 'b, 'c> {
    file: &'c XmlReader<'c>,
    node: Node<'a, 'b>,
    label: &'c str,
    sensors: BTreeMap<&'a str, (Node<'a, 'b>, Result<Sensor>)>,
    world_from_chunk: Option<Matrix4<f64>>,
    components: Vec<Component<'a>>,
    active_component: Option<&'a str>,
}

struct Component<'a> {
    id: &'a str,
    world_from_component: Option<Matrix4<f64>>,
    cameras: BTreeSet<&'a str>,
}

/// A camera, and the component without transform that it stands in.
type Posed<'a> = (Orientation, Option<&'a str>);

impl<'a, 'b, 'c> Chunk<'a, 'b, 'c> {
    fn new(file: &'c XmlReader<'c>, node: Node<'a, 'b>, label: &'c str) -> Result<Self> {
        let transform = |of: Node| {
            child(of, "transform")
                .map(|t| file.transform(t))
                .transpose()
        };
        let list = child(node, "components");
        let of_list = list.iter().flat_map(|l| l.children());
        let components = of_list
            .filter(|n| n.has_tag_name("component"))
            .map(|of| {
                let ids = of.descendants().filter(|n| n.has_tag_name("camera_ids"));
                Ok(Component {
                    id: of.attribute("id").unwrap_or_default(),
                    world_from_component: transform(of)?,
                    cameras: ids
                        .filter_map(|n| n.text())
                        .flat_map(str::split_whitespace)
                        .collect(),
                })
            })
            .collect::<Result<_>>()?;
        let sensors = node.descendants().filter(|n| n.has_tag_name("sensor"));
        Ok(Self {
            file,
            node,
            label,
            sensors: sensors
                .map(|n| (n.attribute("id").unwrap_or_default(), (n, file.sensor(n))))
                .collect(),
            world_from_chunk: transform(node)?,
            components,
            active_component: list.and_then(|l| l.attribute("active_id")),
        })
    }

    /// The cameras that are aligned and enabled.
    fn cameras(
        &self,
        left_out: &mut LeftOut,
        warnings: &mut Vec<String>,
    ) -> Result<Vec<Orientation>> {
        let nodes: Vec<Node> = (self.node.descendants())
            .filter(|n| n.has_tag_name("camera"))
            // Frames repeat the cameras to name their files.
            .filter(|n| !n.ancestors().any(|a| a.has_tag_name("frames")))
            .collect();
        let by_id: BTreeMap<&str, Node> = (nodes.iter())
            .filter_map(|n| Some((n.attribute("id")?, *n)))
            .collect();
        let (mut posed, mut disabled, mut unknown) = (Vec::new(), Vec::new(), Vec::new());
        let mut slaves = 0;
        for &node in &nodes {
            let label = node.attribute("label").unwrap_or_default();
            let own = child(node, "transform");
            let master = node.attribute("master_id").and_then(|id| by_id.get(id));
            let of_master = master.and_then(|master| child(*master, "transform"));
            // Cameras without a transform were not aligned.
            let Some(transform) = own.or(of_master) else {
                continue;
            };
            if !is_on(node) {
                disabled.push(label);
                continue;
            }
            let (sensor, lens) = self.sensor_of(node)?;
            let lens = match lens {
                Ok(lens) => lens,
                Err(reason) => {
                    left_out.add(label, reason);
                    continue;
                }
            };
            let offset = self.file.rig_offset(*sensor)?;
            if own.is_none() && offset.is_none() {
                unknown.push(label);
                continue;
            }
            let from_master = offset.filter(|_| own.is_none());
            slaves += usize::from(from_master.is_some());
            posed.push(self.posed(node, transform, from_master, lens)?);
        }
        let said = words_of_cameras(&disabled, &unknown, slaves);
        let place = self.place();
        warnings.extend(said.into_iter().map(|what| format!("{what} ({place})")));
        Ok(self.in_one_frame(posed, warnings))
    }

    /// A camera with its transform, or that of its master and the offset from there.
    fn posed(
        &self,
        node: Node<'a, 'b>,
        transform: Node,
        from_master: Option<(Matrix3<f64>, Vector3<f64>)>,
        lens: &Sensor,
    ) -> Result<Posed<'a>> {
        let label = node.attribute("label").unwrap_or_default();
        let (world, unplaced) = self.frame_of(node)?;
        let pose = world * Matrix4::from_row_slice(&self.file.numbers::<16>(transform)?);
        let turned = pose.fixed_view::<3, 3>(0, 0).into_owned();
        let mut r = (turned / turned.column(0).norm()).transpose();
        let mut center = Point3::new(pose[(0, 3)], pose[(1, 3)], pose[(2, 3)]);
        if let Some((master_from_slave, location)) = from_master {
            center += r.transpose() * location;
            r = master_from_slave.transpose() * r;
        }
        let orientation = Orientation {
            distortion: lens.distortion,
            size: Some(lens.size),
            ..pinhole(label, &self.file.place(node), lens.k, r, center)
        };
        Ok((orientation, unplaced))
    }

    fn place(&self) -> String {
        format!("{}, {}", self.file.path, self.label)
    }

    fn sensor_of(&self, camera: Node) -> Result<&(Node<'a, 'b>, Result<Sensor>)> {
        let id = camera.attribute("sensor_id");
        let id = id.ok_or_else(|| self.file.error(camera, "it names no sensor"))?;
        self.sensors.get(id).ok_or_else(|| {
            let problem = format!("its sensor \"{id}\" is not in the file");
            self.file
                .refusal(camera, &problem, "the id of a <sensor> of this chunk")
        })
    }

    /// What leads from the camera's frame to the world; or its component, where nothing does.
    fn frame_of(&self, camera: Node<'a, 'b>) -> Result<(Matrix4<f64>, Option<&'a str>)> {
        let components = &self.components;
        let component = match camera.attribute("component_id") {
            Some(id) => {
                let found = components.iter().find(|c| c.id == id);
                if found.is_none() && !components.is_empty() {
                    let problem = format!("its component \"{id}\" is not in the file");
                    let expected = "the id of a <component> of this chunk";
                    return Err(self.file.refusal(camera, &problem, expected));
                }
                found
            }
            None => {
                let id = camera.attribute("id").unwrap_or_default();
                let listed = components.iter().find(|c| c.cameras.contains(id));
                listed.or(components.first().filter(|_| components.len() == 1))
            }
        };
        let of_component = component.and_then(|c| c.world_from_component);
        Ok(match of_component.or(self.world_from_chunk) {
            Some(world) => (world, None),
            None => (Matrix4::identity(), Some(component.map_or("", |c| c.id))),
        })
    }

    /// The cameras that stand in one frame: the world, or the internal frame of one component.
    fn in_one_frame(&self, posed: Vec<Posed<'a>>, warnings: &mut Vec<String>) -> Vec<Orientation> {
        let count = |id: Option<&str>| posed.iter().filter(|(_, of)| *of == id).count();
        let active = self.active_component;
        let kept = match count(None) {
            0 if active.is_some() && count(active) > 0 => active,
            0 => {
                let ids = self.components.iter().map(|c| c.id).chain([""]);
                let used = ids.map(Some).filter(|id| count(*id) > 0);
                used.max_by_key(|id| count(*id)).flatten()
            }
            _ => None,
        };
        let others = posed.iter().filter(|(_, of)| *of != kept);
        let others: Vec<&str> = others.map(|(o, _)| &*o.image).collect();
        let place = self.place();
        if !others.is_empty() {
            warnings.push(format!(
                "cameras of a component that is not placed together with the others are left out: {} ({place})",
                listed(&others)
            ));
        }
        if kept.is_some() {
            warnings.push(format!(
                "{place} states no transform to a world: the results are in its own units, which need not be metres"
            ));
        }
        let same = posed.into_iter().filter(|(_, of)| *of == kept);
        same.map(|(orientation, _)| orientation).collect()
    }
}

/// What is to be said of cameras that are disabled, of those of a rig whose offset is unknown, and
/// of those of a rig that are placed by it.
fn words_of_cameras(disabled: &[&str], unknown: &[&str], slaves: usize) -> Vec<String> {
    let mut said = Vec::new();
    if !disabled.is_empty() {
        let names = listed(disabled);
        said.push(format!("disabled cameras are left out: {names}"));
    }
    if !unknown.is_empty() {
        let names = listed(unknown);
        said.push(format!(
            "cameras of a rig are left out, since their sensors state no rotation and location towards the master: {names}"
        ));
    }
    if slaves > 0 {
        said.push(format!(
            "{slaves} cameras of a rig stand at their masters, with the offset of their sensors"
        ));
    }
    said
}

impl Sensor {
    /// Of images of this size, where the sensor was calibrated at another resolution.
    fn scale_to(&mut self, size: (u32, u32)) -> std::result::Result<(), String> {
        let cross = |a: u32, b: u32| u64::from(a) * u64::from(b);
        if cross(size.0, self.size.1) != cross(size.1, self.size.0) {
            return Err(format!(
                "its images have {} x {} pixels, but it was calibrated at {} x {}",
                size.0, size.1, self.size.0, self.size.1
            ));
        }
        let scale = f64::from(size.0) / f64::from(self.size.0);
        self.k = Matrix3::from_diagonal(&Vector3::new(scale, scale, 1.0)) * self.k;
        self.size = size;
        Ok(())
    }
}

impl XmlReader<'_> {
    fn sensor(&self, sensor: Node) -> Result<Sensor> {
        let calibrations = || sensor.children().filter(|n| n.has_tag_name("calibration"));
        let adjusted = calibrations().find(|n| n.attribute("class") == Some("adjusted"));
        let calibration = adjusted
            .or_else(|| calibrations().next())
            .ok_or_else(|| self.error(sensor, "it has no calibration"))?;
        let projection = self.projection([sensor, calibration])?;
        let size = |of: Node| {
            child(of, "resolution")
                .map(|n| self.resolution(n))
                .transpose()
        };
        let (of_images, of_lens) = (size(sensor)?, size(calibration)?);
        let lens_size = of_lens
            .or(of_images)
            .ok_or_else(|| self.error(calibration, "the resolution is missing"))?;
        let term = |name: &str| self.number_or(calibration, name, 0.0);
        for name in ["p3", "p4"] {
            if term(name)? != 0.0 {
                let problem = format!("the tangential term {name} is not read");
                let expected = "a calibration with p1 and p2 only: optimise the cameras without it";
                return Err(self.refusal(calibration, &problem, expected));
            }
        }
        let (w, h) = (f64::from(lens_size.0), f64::from(lens_size.1));
        let is_old = child(calibration, "f").is_none() && child(calibration, "fx").is_some();
        let (k, tangential) = if is_old {
            let fx = self.number(calibration, "fx")?;
            let fy = self.number_or(calibration, "fy", fx)?;
            let cx = self.number_or(calibration, "cx", w / 2.0)?;
            let cy = self.number_or(calibration, "cy", h / 2.0)?;
            let k = Matrix3::new(fx, term("skew")?, cx, 0.0, fy, cy, 0.0, 0.0, 1.0);
            (k, [term("p1")?, term("p2")?])
        } else {
            let f = self.number(calibration, "f")?;
            let (cx, cy) = (w / 2.0 + term("cx")?, h / 2.0 + term("cy")?);
            let (b1, b2) = (term("b1")?, term("b2")?);
            let k = Matrix3::new(f + b1, b2, cx, 0.0, f, cy, 0.0, 0.0, 1.0);
            (k, [term("p2")?, term("p1")?])
        };
        let radial = [term("k1")?, term("k2")?, term("k3")?, term("k4")?];
        let mut lens = Sensor {
            k,
            distortion: Distortion::lens(projection, radial, tangential),
            size: lens_size,
        };
        if let Some(size) = of_images.filter(|&size| size != lens_size) {
            lens.scale_to(size)
                .map_err(|problem| self.refusal(sensor, &problem, "one shape of the image"))?;
        }
        Ok(lens)
    }

    /// What the last of these nodes that states one says.
    fn projection(&self, nodes: [Node; 2]) -> Result<Projection> {
        let mut projection = Projection::Perspective;
        for node in nodes {
            projection = match node.attribute("type") {
                None => projection,
                Some("frame") => Projection::Perspective,
                // Metashape's manual: r = theta, from version 2.3 on also r = 2 sin(theta / 2).
                Some("fisheye" | "equidistant_fisheye") => Projection::Equidistant,
                Some("equisolid_fisheye") => Projection::Equisolid,
                Some(model) => return Err(self.unsupported_lens(node, model)),
            };
        }
        Ok(projection)
    }

    fn unsupported_lens(&self, node: Node, model: &str) -> Error {
        let problem = format!("cameras of type \"{model}\" are not read");
        let expected =
            "a frame or fisheye camera: undistort the images there and export their orientation";
        self.refusal(node, &problem, expected)
    }

    fn resolution(&self, node: Node) -> Result<(u32, u32)> {
        let side = |name: &str| {
            let value = node.attribute(name).and_then(|v| v.parse().ok());
            let value = value.filter(|&v: &u32| v > 0);
            value.ok_or_else(|| self.error(node, "width and height are no whole numbers"))
        };
        Ok((side("width")?, side("height")?))
    }

    /// Rotation and location of a sensor in the frame of its rig's master, where either is stated.
    fn rig_offset(&self, sensor: Node) -> Result<Option<(Matrix3<f64>, Vector3<f64>)>> {
        let (rotation, location) = (child(sensor, "rotation"), child(sensor, "location"));
        if rotation.is_none() && location.is_none() {
            return Ok(None);
        }
        let r = match rotation {
            Some(node) => Matrix3::from_row_slice(&self.numbers::<9>(node)?),
            None => Matrix3::identity(),
        };
        let t = match location {
            Some(node) => Vector3::from(self.numbers::<3>(node)?),
            None => Vector3::zeros(),
        };
        Ok(Some((r, t)))
    }

    fn transform(&self, transform: Node) -> Result<Matrix4<f64>> {
        let mut m = Matrix4::identity();
        let scale = self.number_or(transform, "scale", 1.0)?;
        let r = match child(transform, "rotation") {
            Some(node) => Matrix3::from_row_slice(&self.numbers::<9>(node)?),
            None => Matrix3::identity(),
        };
        m.fixed_view_mut::<3, 3>(0, 0).copy_from(&(r * scale));
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
    use crate::base::math;
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
            ), &mut Vec::new(),
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
    fn metashape(kind: &str, terms: &str) -> Result<Vec<Orientation>> {
        read(
            "cameras.xml",
            &format!(
                "<document><chunk><sensors><sensor id=\"0\" type=\"{kind}\"><calibration class=\"adjusted\">\
                 <resolution width=\"1200\" height=\"900\"/>{terms}</calibration></sensor></sensors><cameras>\
                 <camera id=\"0\" sensor_id=\"0\" label=\"a\">\
                 <transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform></camera></cameras></chunk></document>"
            ),
            &mut Vec::new(),
        )
    }

    fn seen(found: &Orientation, x: f64, y: f64) -> [f64; 2] {
        let put = found.distortion.unwrap().distort(&Point2::new(x, y));
        let pixel = found.k * Vector3::new(put.x, put.y, 1.0);
        [pixel.x, pixel.y]
    }

    #[test]
    fn the_fisheyes_of_metashape_put_points_where_its_manual_says() {
        let terms = "<f>700</f><cx>12</cx><cy>-7</cy><b1>0.8</b1><b2>-0.3</b2><k1>-0.06</k1><k2>0.02</k2>\
                     <k3>-0.004</k3><p1>0.0012</p1><p2>-0.0007</p2>";
        for (kind, radius) in [
            ("fisheye", (|theta| theta) as fn(f64) -> f64),
            ("equidistant_fisheye", |theta| theta),
            ("equisolid_fisheye", |theta| 2.0 * math::sin(theta / 2.0)),
        ] {
            let found = &metashape(kind, terms).unwrap()[0];
            for (x0, y0) in [(0.31, 0.22), (-1.35, 0.9), (0.05, -1.6)] {
                let r0 = math::hypot(x0, y0);
                let (x, y) = (
                    x0 * radius(math::atan(r0)) / r0,
                    y0 * radius(math::atan(r0)) / r0,
                );
                let r2: f64 = x * x + y * y;
                let g = 1.0 - 0.06 * r2 + 0.02 * r2 * r2 - 0.004 * r2 * r2 * r2;
                let u = x * g + 0.0012 * (r2 + 2.0 * x * x) - 0.0014 * x * y;
                let v = y * g - 0.0007 * (r2 + 2.0 * y * y) + 0.0024 * x * y;
                let [column, row] = seen(found, x0, y0);
                assert!(
                    (column - (612.0 + u * 700.8 - v * 0.3)).abs() < 1e-9,
                    "{kind}"
                );
                assert!((row - (443.0 + v * 700.0)).abs() < 1e-9, "{kind}");
            }
        }
        let refusal = metashape("spherical", terms).unwrap_err().to_string();
        assert!(refusal.contains("spherical"), "{refusal}");
    }
}
