//! Photogrammetric lists: a camera file with keys and values, and `image X0 Y0 Z0 omega phi kappa`.
//!
//! ```text
//! frame    the camera file: millimetres, y up, crops of the frame
//! list     the list in the forms that people have
//! heading  the columns that a heading names
//! unit     the unit of the angles
//! ```
//!
//! Image coordinates are in mm from the centre of the frame, x right, y up. Views are crops of the
//! frame: `crop NAME column row width height`; without a crop line the view is the whole frame. The
//! rotation is that of [`rotation_from_omega_phi_kappa`], or of [`rotation_from_yaw_pitch_roll`]
//! where the heading names these. Where nothing states the unit of the angles, all of them are
//! handed on, and the images decide; that under which the views look at the same point is first.

mod fields;
mod frame;
mod heading;
mod list;
mod unit;

pub(crate) use frame::{CameraFrame, read_frame};
pub(crate) use list::{is_list, nearly_a_list};

use nalgebra::Matrix3;

use self::heading::AngleKind;
use self::list::ListedPose;
use crate::base::error::{Error, Result};
use crate::orienting::orientation::angles::{
    AngleUnit, rotation_from_omega_phi_kappa, rotation_from_yaw_pitch_roll,
};
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};

/// Reads the orientations from (path, text) of both files.
pub(crate) fn read(
    camera: (&str, &str),
    exterior: (&str, &str),
    warnings: &mut Vec<String>,
) -> Result<Vec<Orientation>> {
    let frame = read_frame(camera.0, camera.1, warnings)?;
    let list = list::read(exterior.0, exterior.1)?;
    let poses = &list.poses;
    if poses.is_empty() {
        return Err(Error::file(
            exterior.0,
            "it lists no image with an orientation",
            "add lines `image X0 Y0 Z0 omega phi kappa`",
        ));
    }
    if let Some(heading) = &list.unknown_heading {
        warnings.push(format!(
            "{}: the heading {heading} is not understood; the columns were taken as image X0 Y0 Z0 \
             omega phi kappa",
            exterior.0
        ));
    }
    let stated = unit::stated_unit(&list.words)
        .or(list.is_of_degrees.then_some(AngleUnit::Degrees))
        .or_else(|| unit::stated_unit(&comments(camera.1)));
    if list.kind == AngleKind::YawPitchRoll {
        let unit = stated.unwrap_or(AngleUnit::Degrees).radians();
        warnings.push(format!(
            "{}: yaw, pitch and roll are taken as clockwise from the y axis of the coordinates, 0 for \
             a view straight down, and right side down",
            exterior.0
        ));
        let of_pose = |pose: &ListedPose| {
            let [yaw, pitch, roll] = pose.angles.map(|a| a * unit);
            let r = rotation_from_yaw_pitch_roll(yaw, pitch, roll).into_inner();
            pose.with_rotation(&frame, r)
        };
        return Ok(poses.iter().map(of_pose).collect());
    }
    let unit = stated.unwrap_or_else(|| {
        warnings.push(format!(
            "{}: nothing states the unit of the angles; the images decide between degrees, gon and \
             radians (state it: \"# angles in degrees\")",
            exterior.0
        ));
        unit::guess_unit(&frame, poses)
    });
    let of_pose = |pose: &ListedPose| Orientation {
        readings: match stated {
            Some(_) => Vec::new(),
            None => AngleUnit::ALL
                .map(|u| (u, pose.rotation(u.radians())))
                .to_vec(),
        },
        ..pose.orientation(&frame, unit.radians())
    };
    Ok(poses.iter().map(of_pose).collect())
}

fn comments(text: &str) -> String {
    let comments = text.lines().filter_map(|l| l.trim().strip_prefix('#'));
    comments.collect::<Vec<_>>().join("\n")
}

impl ListedPose {
    /// The rotation with angles of which one is this many radians.
    fn rotation(&self, unit: f64) -> Matrix3<f64> {
        let [omega, phi, kappa] = self.angles.map(|a| a * unit);
        rotation_from_omega_phi_kappa(omega, phi, kappa).into_inner()
    }

    fn orientation(&self, frame: &CameraFrame, unit: f64) -> Orientation {
        Orientation {
            angles: Some(self.angles),
            ..self.with_rotation(frame, self.rotation(unit))
        }
    }

    fn with_rotation(&self, frame: &CameraFrame, r: Matrix3<f64>) -> Orientation {
        let part = frame.part_of(&self.image);
        Orientation {
            size: Some(part.size),
            crop: Some(frame.crop(part)),
            ..pinhole(&self.image, &self.source, frame.k(part), r, self.center)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::orientation::formats::data_lines;
    use crate::orienting::synthetic::{gable_scene, to_photogrammetric};

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
            assert!(warnings[0].contains("the images decide"), "{warnings:?}");
            for (o, view) in found.iter().zip(&scene.views) {
                assert!((o.r - view.camera.r).norm() < 1e-9, "{}", unit.name());
                let readings: Vec<AngleUnit> = o.readings.iter().map(|(u, _)| *u).collect();
                assert_eq!(readings, AngleUnit::ALL);
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
        assert!(message(CAMERA, "a.jpg 1.5 2,5 3 0 0 0\n").contains("\"2,5\""));
    }
}
