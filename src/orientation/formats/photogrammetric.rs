//! Photogrammetric lists: a camera file with keys and values, and `image X0 Y0 Z0 omega phi kappa`.
//!
//! Image coordinates are in mm from the centre of the frame, x right, y up. Views are crops of the
//! frame: `crop NAME column row width height`; without a crop line the view is the whole frame. The
//! rotation is that of [`rotation_from_omega_phi_kappa`]. No key marks the unit of the angles: a
//! comment that names it decides; otherwise the unit is taken under which the views look at the
//! same point.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3, Vector3};

use super::text::{TextLine, data_lines, quoted};
use crate::error::{Error, Result};
use crate::orientation::angles::{AngleUnit, rotation_from_omega_phi_kappa};
use crate::orientation::image_orientation::{Crop, Orientation};

/// Reads the orientations from (path, text) of both files.
pub(crate) fn read(
    camera: (&str, &str),
    exterior: (&str, &str),
    warnings: &mut Vec<String>,
) -> Result<Vec<Orientation>> {
    let frame = read_frame(camera.0, camera.1, warnings)?;
    let mut lines = data_lines(exterior.0, exterior.1).peekable();
    // Some programs (Pix4D) name the columns first.
    lines.next_if(is_heading);
    let poses: Vec<ListedPose> = lines.map(|line| read_pose(&line)).collect::<Result<_>>()?;
    if poses.is_empty() {
        return Err(Error::File {
            file: exterior.0.to_owned(),
            problem: "it lists no image".to_owned(),
            advice: "add lines `image X0 Y0 Z0 omega phi kappa`".to_owned(),
        });
    }
    let stated = stated_unit(exterior.1).or_else(|| stated_unit(camera.1));
    let unit = stated.unwrap_or_else(|| {
        let unit = guess_unit(&frame, &poses);
        warnings.push(format!(
            "{}: no comment states the unit of the angles; {} was taken, under which the views agree \
             best (state it: \"# angles in degrees\")",
            exterior.0,
            unit.name()
        ));
        unit
    });
    Ok(poses
        .iter()
        .map(|pose| pose.orientation(&frame, unit))
        .collect())
}

/// FramePart of the frame that a view shows, pixels.
#[derive(Clone, Copy)]
pub(crate) struct FramePart {
    column: f64,
    row: f64,
    pub size: (u32, u32),
}

/// Interior orientation of the full frame.
pub(crate) struct CameraFrame {
    /// Principal distance in pixels along x and y.
    focal_px: [f64; 2],
    /// Principal point in the frame, pixels.
    principal_px: [f64; 2],
    whole: FramePart,
    crops: BTreeMap<String, FramePart>,
}

impl CameraFrame {
    /// The part that an image shows: its name in the camera file may have another extension, or
    /// none.
    pub(crate) fn part_of(&self, image: &str) -> &FramePart {
        let stem = |name: &str| {
            name.rsplit_once('.')
                .map_or(name, |(stem, _)| stem)
                .to_owned()
        };
        let alike = || {
            self.crops
                .iter()
                .find(|(name, _)| stem(name) == stem(image))
        };
        let found = self
            .crops
            .get(image)
            .or_else(|| alike().map(|(_, part)| part));
        found.unwrap_or(&self.whole)
    }

    /// Calibration of a part, pixels.
    pub(crate) fn k(&self, part: &FramePart) -> Matrix3<f64> {
        let ([fx, fy], [cx, cy]) = (self.focal_px, self.principal_px);
        let (cx, cy) = (cx - part.column, cy - part.row);
        Matrix3::new(fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0)
    }

    /// Where a part lies in the frame.
    pub(crate) fn crop(&self, part: &FramePart) -> Crop {
        Crop {
            column: part.column,
            row: part.row,
            frame: [self.whole.size.0, self.whole.size.1].map(f64::from),
        }
    }
}

/// The keys of a camera file that occur once, with the number of values that they may have.
const KEYS: [(&str, std::ops::RangeInclusive<usize>); 4] = [
    ("principal_distance_mm", 1..=1),
    ("principal_point_mm", 2..=2),
    ("pixel_size_mm", 1..=2),
    ("image_size_px", 2..=2),
];

pub(crate) fn read_frame(
    file: &str,
    text: &str,
    warnings: &mut Vec<String>,
) -> Result<CameraFrame> {
    let mut values: [Option<(TextLine, Vec<f64>)>; 4] = [const { None }; 4];
    let mut crops = BTreeMap::new();
    for line in data_lines(file, text) {
        let fields = line.fields();
        if fields[0] == "crop" {
            let (name, crop) = read_crop(&line, &fields)?;
            if crops.insert(name, crop).is_some() {
                return Err(line.error("this image has two crop lines", "one crop line per image"));
            }
        } else if let Some(i) = KEYS.iter().position(|(key, _)| *key == fields[0]) {
            values[i] = Some((line, read_values(&line, &fields, &KEYS[i].1)?));
        } else {
            warnings.push(format!(
                "{file}, line {}: {} is not a known key and was ignored",
                line.number,
                quoted(fields[0])
            ));
        }
    }
    let require = |i: usize| {
        values[i].as_ref().ok_or_else(|| Error::File {
            file: file.to_owned(),
            problem: format!("the key {} is missing", KEYS[i].0),
            advice: format!("add a line `{} ...`", KEYS[i].0),
        })
    };
    let (distance, pixel, size) = (require(0)?, require(2)?, require(3)?);
    for (line, numbers) in [distance, pixel, size] {
        if numbers.iter().any(|&v| v <= 0.0) {
            return Err(line.error("a value is not positive", "positive lengths"));
        }
    }
    let point = values[1].as_ref().map_or([0.0, 0.0], |(_, v)| [v[0], v[1]]);
    let pixel = [pixel.1[0], *pixel.1.last().expect("one value or two")];
    let (width, height) = (size.1[0], size.1[1]);
    let whole = (whole_px(&size.0, width)?, whole_px(&size.0, height)?);
    Ok(CameraFrame {
        focal_px: [distance.1[0] / pixel[0], distance.1[0] / pixel[1]],
        principal_px: [
            width / 2.0 + point[0] / pixel[0],
            height / 2.0 - point[1] / pixel[1],
        ],
        whole: FramePart {
            column: 0.0,
            row: 0.0,
            size: whole,
        },
        crops,
    })
}

fn read_values(
    line: &TextLine,
    fields: &[&str],
    count: &std::ops::RangeInclusive<usize>,
) -> Result<Vec<f64>> {
    if !count.contains(&(fields.len() - 1)) {
        return Err(line.error(
            format!("{} has {} values", fields[0], fields.len() - 1),
            format!(
                "{} {}",
                count.end(),
                if *count.end() == 1 { "value" } else { "values" }
            ),
        ));
    }
    line.numbers(&fields[1..], fields[0])
}

fn whole_px(line: &TextLine, value: f64) -> Result<u32> {
    if value.fract() == 0.0 && (1.0..=4e9).contains(&value) {
        Ok(value as u32)
    } else {
        Err(line.error(format!("a size of {value}"), "whole pixels"))
    }
}

fn read_crop(line: &TextLine, fields: &[&str]) -> Result<(String, FramePart)> {
    if fields.len() != 6 {
        return Err(line.error(
            format!("{} fields", fields.len()),
            "crop NAME column row width height",
        ));
    }
    let crop = FramePart {
        column: line.number(fields[2], "the column")?,
        row: line.number(fields[3], "the row")?,
        size: (
            line.whole(fields[4], "the width")?,
            line.whole(fields[5], "the height")?,
        ),
    };
    Ok((fields[1].to_owned(), crop))
}

/// Does a line hold words where numbers are expected?
fn is_heading(line: &TextLine) -> bool {
    let fields = line.fields();
    fields.len() > 1
        && fields[1..]
            .iter()
            .all(|f| f.parse::<f64>().is_err() && f.starts_with(char::is_alphabetic))
}

/// One line of the exterior list; angles in the file's unit.
struct ListedPose {
    image: String,
    source: String,
    center: Point3<f64>,
    angles: [f64; 3],
}

fn read_pose(line: &TextLine) -> Result<ListedPose> {
    let fields = line.fields();
    if fields.len() != 7 {
        return Err(line.error(
            format!("{} fields", fields.len()),
            "image X0 Y0 Z0 omega phi kappa",
        ));
    }
    let center = line.numbers(&fields[1..4], "a coordinate")?;
    let angles = line.numbers(&fields[4..7], "an angle")?;
    Ok(ListedPose {
        image: fields[0].to_owned(),
        source: format!("{}, line {}", line.file, line.number),
        center: Point3::new(center[0], center[1], center[2]),
        angles: [angles[0], angles[1], angles[2]],
    })
}

impl ListedPose {
    fn orientation(&self, frame: &CameraFrame, unit: AngleUnit) -> Orientation {
        let part = frame.part_of(&self.image);
        let [omega, phi, kappa] = self.angles.map(|a| a * unit.radians());
        Orientation {
            image: self.image.clone(),
            source: self.source.clone(),
            k: frame.k(part),
            distortion: None,
            r: rotation_from_omega_phi_kappa(omega, phi, kappa).into_inner(),
            center: self.center,
            size: Some(part.size),
            from_middle: false,
            angles: Some(self.angles),
            crop: Some(frame.crop(part)),
            group: None,
        }
    }
}

/// The unit that a comment names, as a word of its own.
fn stated_unit(text: &str) -> Option<AngleUnit> {
    text.lines()
        .filter_map(|line| line.trim().strip_prefix('#'))
        .flat_map(|comment| comment.split(|c: char| !c.is_alphabetic()))
        .find_map(|word| match &*word.to_ascii_lowercase() {
            "degree" | "degrees" | "deg" => Some(AngleUnit::Degrees),
            "gon" | "gons" | "grad" | "grads" | "gradian" | "gradians" => Some(AngleUnit::Gon),
            "radian" | "radians" | "rad" => Some(AngleUnit::Radians),
            _ => None,
        })
}

/// The unit under which the rays through the image centres pass nearest to a common point in front
/// of the cameras, relative to its distance.
fn guess_unit(frame: &CameraFrame, poses: &[ListedPose]) -> AngleUnit {
    let mut best = (f64::INFINITY, AngleUnit::Degrees);
    for unit in AngleUnit::ALL {
        let orientations: Vec<_> = poses.iter().map(|p| p.orientation(frame, unit)).collect();
        let spread = spread_of_rays(&orientations);
        if spread < best.0 {
            best = (spread, unit);
        }
    }
    best.1
}

/// Root mean square angle (radians, small-angle) between the central rays and the directions to the
/// point nearest to all of them; infinite when the point lies behind a camera.
fn spread_of_rays(orientations: &[Orientation]) -> f64 {
    let mean = orientations
        .iter()
        .map(|o| o.center.coords)
        .sum::<Vector3<f64>>()
        / orientations.len() as f64;
    let rays: Vec<(Vector3<f64>, Vector3<f64>)> = orientations
        .iter()
        .filter_map(|o| {
            let (w, h) = o.size?;
            let centre = Vector3::new(f64::from(w) / 2.0, f64::from(h) / 2.0, 1.0);
            let ray = o.r.transpose() * o.k.try_inverse()? * centre;
            Some((o.center.coords - mean, ray.normalize()))
        })
        .collect();
    let across = |ray: &Vector3<f64>| Matrix3::identity() - ray * ray.transpose();
    let normal: Matrix3<f64> = rays.iter().map(|(_, ray)| across(ray)).sum();
    let right: Vector3<f64> = rays.iter().map(|(c, ray)| across(ray) * c).sum();
    let Some(point) = normal.lu().solve(&right) else {
        return f64::INFINITY;
    };
    let squares = rays.iter().map(|(c, ray)| {
        let d = point - c;
        let along = d.dot(ray);
        if along > 0.0 {
            (d.norm_squared() - along * along).max(0.0) / (along * along)
        } else {
            f64::INFINITY
        }
    });
    (squares.sum::<f64>() / rays.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{gable_scene, to_photogrammetric};

    const CAMERA: &str = "principal_distance_mm 100\nprincipal_point_mm 0.1 0.2\n\
                          pixel_size_mm 0.01\nimage_size_px 4000 3000\ncrop a.jpg 100 200 300 400\n";
    const EXTERIOR: &str = "# omega phi kappa in degrees\na.jpg 1 2 3 0 0 90\n";

    fn read_both(camera: &str, exterior: &str) -> Result<Vec<Orientation>> {
        read(
            ("camera.txt", camera),
            ("exterior.txt", exterior),
            &mut Vec::new(),
        )
    }

    #[test]
    fn millimetres_with_y_up_become_pixels_of_the_crop() {
        let found = &read_both(CAMERA, EXTERIOR).unwrap()[0];
        assert_eq!(found.k[(0, 0)], 10000.0);
        assert!((found.k[(0, 2)] - (2000.0 + 10.0 - 100.0)).abs() < 1e-9);
        assert!((found.k[(1, 2)] - (1500.0 - 20.0 - 200.0)).abs() < 1e-9);
        assert_eq!(found.size, Some((300, 400)));
    }

    #[test]
    fn an_unstated_unit_is_found_from_the_geometry() {
        let (scene, _) = gable_scene(32);
        let files = to_photogrammetric(&scene);
        let text = |i: usize| String::from_utf8(files[i].1.clone()).unwrap();
        let camera = text(0).replace("degrees", "");
        for (unit, factor) in [
            (AngleUnit::Degrees, 1.0),
            (AngleUnit::Gon, 200.0 / 180.0),
            (AngleUnit::Radians, 1f64.to_radians()),
        ] {
            let list: String = data_lines("", &text(1))
                .map(|line| {
                    let f = line.fields();
                    let a = |i: usize| f[i].parse::<f64>().unwrap() * factor;
                    format!(
                        "{} {} {} {} {} {} {}\n",
                        f[0],
                        f[1],
                        f[2],
                        f[3],
                        a(4),
                        a(5),
                        a(6)
                    )
                })
                .collect();
            let mut warnings = Vec::new();
            let found = read(("c", &camera), ("e", &list), &mut warnings).unwrap();
            assert!(warnings[0].contains(unit.name()), "{warnings:?}");
            for (o, view) in found.iter().zip(&scene.views) {
                assert!((o.r - view.camera.r).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn a_heading_is_skipped() {
        let list = format!("imageName X Y Z Omega Phi Kappa\n{EXTERIOR}");
        assert_eq!(read_both(CAMERA, &list).unwrap().len(), 1);
        let damaged = read_both(CAMERA, &list.replace("Kappa", "3"));
        assert!(damaged.unwrap_err().to_string().contains("line 1"));
    }

    #[test]
    fn refusals_name_the_line() {
        let message =
            |camera: &str, exterior: &str| read_both(camera, exterior).unwrap_err().to_string();
        assert!(
            message("pixel_size_mm 1\n", EXTERIOR).contains("principal_distance_mm is missing")
        );
        assert!(
            message(&CAMERA.replace("0.01", "-0.01"), EXTERIOR)
                .contains("line 3: a value is not positive")
        );
        assert!(
            message(&CAMERA.replace("4000 ", ""), EXTERIOR)
                .contains("line 4: image_size_px has 1 values")
        );
        assert!(message(&CAMERA.replace(" 400\n", "\n"), EXTERIOR).contains("line 5: 5 fields"));
        assert!(message(CAMERA, "# degrees\na.jpg 1 2 3 0 0\n").contains("line 2: 6 fields"));
        assert!(
            message(CAMERA, "# degrees\na.jpg 1 nan 3 0 0 0\n").contains("a coordinate is \"nan\"")
        );
        assert!(message(CAMERA, "a.jpg 1 2,5 3 0 0 0\n").contains("\"2,5\""));
    }
}
