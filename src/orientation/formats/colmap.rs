//! COLMAP's text model: `cameras.txt` and `images.txt`.
//!
//! Quaternion (w x y z) and t are `cam_from_world`, so C = -R^T t; the corner of the image is (0,
//! 0), which is our convention. Each image takes two lines, of which the second (its points) may be
//! empty; files from other programs leave it out, so every line with a name in its tenth field is
//! an image.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3, Quaternion, UnitQuaternion, Vector3};

use super::text::{TextLine, data_lines, lines, quoted};
use crate::camera::Distortion;
use crate::error::{Error, Result};
use crate::orientation::image_orientation::Orientation;

/// Reads the orientations of a model from (path, text) of both files.
pub(crate) fn read(cameras: (&str, &str), images: (&str, &str)) -> Result<Vec<Orientation>> {
    let lenses = read_cameras(cameras.0, cameras.1)?;
    let mut orientations = Vec::new();
    let mut points_follow = false;
    for line in lines(images.0, images.1) {
        if line.text.starts_with('#') {
            continue;
        }
        if is_image_line(&line) || !(points_follow || line.is_empty()) {
            orientations.push(read_image(&line, &lenses, cameras.0)?);
            points_follow = true;
        } else {
            points_follow = false;
        }
    }
    if orientations.is_empty() {
        return Err(Error::File {
            file: images.0.to_owned(),
            problem: "it lists no image".to_owned(),
            advice: "export the model with its images".to_owned(),
        });
    }
    Ok(orientations)
}

/// Interior orientation of one camera.
struct ColmapCamera {
    size: (u32, u32),
    k: Matrix3<f64>,
    distortion: Option<Distortion>,
}

fn read_cameras(file: &str, text: &str) -> Result<BTreeMap<u32, ColmapCamera>> {
    let mut lenses = BTreeMap::new();
    for line in data_lines(file, text) {
        let fields = line.fields();
        if fields.len() < 5 {
            return Err(line.error(
                format!("{} fields", fields.len()),
                "CAMERA_ID MODEL WIDTH HEIGHT PARAMS...",
            ));
        }
        let id = line.whole(fields[0], "the camera id")?;
        let size = (
            line.whole(fields[2], "the width")?,
            line.whole(fields[3], "the height")?,
        );
        let (k, distortion) = read_model(&line, fields[1], &fields[4..])?;
        let lens = ColmapCamera {
            size,
            k,
            distortion,
        };
        if lenses.insert(id, lens).is_some() {
            return Err(line.error(format!("camera {id} stands twice"), "one line per camera"));
        }
    }
    Ok(lenses)
}

/// Calibration and distortion from a camera model and its parameters.
fn read_model(
    line: &TextLine,
    model: &str,
    fields: &[&str],
) -> Result<(Matrix3<f64>, Option<Distortion>)> {
    // One focal length or two; then the principal point; then the names of COLMAP's coefficients.
    let (focals, coefficients) = match model {
        "SIMPLE_PINHOLE" => (1, 0),
        "PINHOLE" => (2, 0),
        "SIMPLE_RADIAL" => (1, 1),
        "RADIAL" => (1, 2),
        "OPENCV" => (2, 4),
        "FULL_OPENCV" => (2, 8),
        _ => {
            return Err(line.error(
                format!("the camera model {} is not supported", quoted(model)),
                "a perspective model (PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV); \
                 undistort the images and export their PINHOLE model",
            ));
        }
    };
    if fields.len() != focals + 2 + coefficients {
        return Err(line.error(
            format!("{} parameters", fields.len()),
            format!("{} for {model}", focals + 2 + coefficients),
        ));
    }
    let p = line.numbers(fields, "a camera parameter")?;
    let (fx, fy, c) = (p[0], p[focals - 1], &p[focals..]);
    if fx <= 0.0 || fy <= 0.0 {
        return Err(line.error(
            "the focal length is not positive",
            "a focal length in pixels",
        ));
    }
    let k = Matrix3::new(fx, 0.0, c[0], 0.0, fy, c[1], 0.0, 0.0, 1.0);
    Ok((k, distortion(&c[2..])))
}

/// COLMAP's coefficients (k1, k2, p1, p2, k3 ... k6) as a distortion; none when all are zero.
fn distortion(c: &[f64]) -> Option<Distortion> {
    let at = |i: usize| c.get(i).copied().unwrap_or(0.0);
    c.iter().any(|&v| v != 0.0).then(|| Distortion {
        radial: [at(0), at(1), at(4), 0.0],
        radial_below: [at(5), at(6), at(7)],
        tangential: [at(2), at(3)],
        center: [0.0; 2],
    })
}

/// Ten fields or more, of which the tenth is a name: a line of points holds numbers only.
fn is_image_line(line: &TextLine) -> bool {
    let mut fields = line.text.split_whitespace();
    fields.nth(9).is_some_and(|f| f.parse::<f64>().is_err())
}

fn read_image(
    line: &TextLine,
    lenses: &BTreeMap<u32, ColmapCamera>,
    cameras: &str,
) -> Result<Orientation> {
    let fields = line.fields();
    if fields.len() < 10 {
        return Err(line.error(
            format!("{} fields", fields.len()),
            "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME",
        ));
    }
    let q = line.numbers(&fields[1..5], "a quaternion component")?;
    let t = line.numbers(&fields[5..8], "a translation component")?;
    let id = line.whole(fields[8], "the camera id")?;
    let quaternion = Quaternion::new(q[0], q[1], q[2], q[3]);
    // Six printed digits leave 1e-6; a thousandth is no quaternion any more.
    if (quaternion.norm() - 1.0).abs() > 1e-3 {
        return Err(line.error(
            format!("the quaternion has length {:.4}", quaternion.norm()),
            "QW QX QY QZ of length 1",
        ));
    }
    let lens = lenses.get(&id).ok_or_else(|| {
        line.error(
            format!("camera {id} is missing in {cameras}"),
            "a camera of that list",
        )
    })?;
    let r = UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix();
    Ok(Orientation {
        image: after_fields(line.text, 9).to_owned(),
        source: format!("{}, line {}", line.file, line.number),
        k: lens.k,
        distortion: lens.distortion,
        center: Point3::from(-(r.inverse() * Vector3::new(t[0], t[1], t[2]))),
        r: r.into_inner(),
        size: Some(lens.size),
        from_middle: false,
        angles: None,
        crop: None,
        group: None,
    })
}

/// What follows the first `count` fields: a name may hold blanks.
fn after_fields(text: &str, count: usize) -> &str {
    (0..count).fold(text.trim_start(), |rest, _| {
        rest.split_once(char::is_whitespace)
            .map_or("", |(_, rest)| rest.trim_start())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERAS: &str = "# comment\n1 PINHOLE 600 400 1000 1100 300 200\n\
                           7 OPENCV 600 400 1000 1100 300 200 0.1 -0.01 0.001 0.002\n";

    fn read_both(cameras: &str, images: &str) -> Result<Vec<Orientation>> {
        read(("cameras.txt", cameras), ("images.txt", images))
    }

    #[test]
    fn points_lines_may_be_full_empty_or_missing() {
        let images = "1 1 0 0 0 1 2 3 1 a b.jpg\n1.5 2.5 -1 3.5 4.5 8\n\
                      2 0 1 0 0 1 2 3 7 sub/b.jpg\n\n3 1 0 0 0 1 2 3 1 c.jpg\n4 1 0 0 0 1 2 3 1 d.jpg\n";
        let found = read_both(CAMERAS, images).unwrap();
        let names: Vec<&str> = found.iter().map(|o| &*o.image).collect();
        assert_eq!(names, ["a b.jpg", "sub/b.jpg", "c.jpg", "d.jpg"]);
        assert_eq!(found[0].center, Point3::new(-1.0, -2.0, -3.0));
        // Half a turn about x: y and z of t keep their sign in -R^T t.
        assert!((found[1].center - Point3::new(-1.0, 2.0, 3.0)).norm() < 1e-12);
        let d = found[1].distortion.unwrap();
        assert_eq!(
            (d.radial, d.tangential),
            ([0.1, -0.01, 0.0, 0.0], [0.001, 0.002])
        );
        assert_eq!(found[1].source, "images.txt, line 3");
    }

    #[test]
    fn refusals_name_the_line() {
        let image = "1 1 0 0 0 1 2 3 1 a.jpg\n";
        let check = |cameras: &str, images: &str, words: &str| {
            let message = read_both(cameras, images).unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        };
        check(
            CAMERAS,
            "1 nan 0 0 0 1 2 3 1 a.jpg",
            "images.txt, line 1: a quaternion component is \"nan\"",
        );
        check(CAMERAS, "1 1 1 0 0 1 2 3 1 a.jpg", "length 1.4142");
        check(
            CAMERAS,
            "1 1 0 0 0 1 2 3 5 a.jpg",
            "camera 5 is missing in cameras.txt",
        );
        check(CAMERAS, "1 1 0 0 0 1 2\n", "7 fields");
        check(CAMERAS, "# none\n", "it lists no image");
        check(
            "\n1 PINHOLE 6 4 0 1 3 2\n",
            image,
            "cameras.txt, line 2: the focal length",
        );
        check("1 OPENCV_FISHEYE 6 4 1 1 3 2 0 0 0 0\n", image, "undistort");
        check(
            "1 PINHOLE 6 4 1 1 3\n",
            image,
            "3 parameters; expected 4 for PINHOLE",
        );
    }
}
