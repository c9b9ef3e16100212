//! COLMAP's text model: `cameras.txt` and `images.txt`.
//!
//! Quaternion (w x y z) and t are `cam_from_world`, so C = -R^T t; the corner of the image is (0,
//! 0), which is our convention. Each image takes two lines, of which the second (its points) may be
//! empty; files from other programs leave it out, so every line with a name in its tenth field is
//! an image.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3, Quaternion, UnitQuaternion, Vector3};

use super::text::{TextLine, data_lines, is_number, lines, quoted};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::angles::ROUNDED_DEVIATION;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::photographs::camera::{Distortion, Projection};

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
        return Err(Error::file(
            images.0,
            "it lists no image",
            "export the model with its images",
        ));
    }
    Ok(orientations)
}

/// Interior orientation of one camera.
struct ColmapCamera {
    size: (u32, u32),
    k: Matrix3<f64>,
    distortion: Option<Distortion>,
}

/// Cameras by number, or why they cannot be used.
type Cameras = BTreeMap<u32, Result<ColmapCamera>>;

fn read_cameras(file: &str, text: &str) -> Result<Cameras> {
    let mut lenses = BTreeMap::new();
    for line in data_lines(file, text) {
        let fields = line.fields();
        if fields.len() < 5 {
            return Err(line.miscounted(fields.len(), "CAMERA_ID MODEL WIDTH HEIGHT PARAMS..."));
        }
        let id = line.whole(fields[0], "the camera id")?;
        let size = (
            line.whole(fields[2], "the width")?,
            line.whole(fields[3], "the height")?,
        );
        // The model of a camera that no image uses may be an unknown one.
        let model = read_model(&line, fields[1], &fields[4..]);
        let lens = model.map(|(k, distortion)| ColmapCamera {
            size,
            k,
            distortion,
        });
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
        "SIMPLE_PINHOLE" | "SIMPLE_FISHEYE" => (1, 0),
        "PINHOLE" | "FISHEYE" => (2, 0),
        "SIMPLE_RADIAL" | "SIMPLE_RADIAL_FISHEYE" => (1, 1),
        "RADIAL" | "RADIAL_FISHEYE" => (1, 2),
        "OPENCV" | "OPENCV_FISHEYE" => (2, 4),
        "FULL_OPENCV" | "THIN_PRISM_FISHEYE" => (2, 8),
        "FOV" => (2, 1),
        _ => {
            return Err(line.error(
                format!("the camera model {} is not supported", quoted(model)),
                "PINHOLE, RADIAL, OPENCV, FULL_OPENCV, FOV, or a fisheye of these; colmap \
                 image_undistorter writes images and a model that are PINHOLE",
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
    Ok((k, distortion(model, &c[2..])))
}

/// COLMAP's coefficients as a distortion; none where the camera is a pinhole.
fn distortion(model: &str, c: &[f64]) -> Option<Distortion> {
    let at = |i: usize| c.get(i).copied().unwrap_or(0.0);
    let angle = Projection::Equidistant;
    match model {
        // Without an angle it is a pinhole.
        "FOV" if at(0) != 0.0 => Distortion::lens(Projection::FieldOfView(at(0)), [], [0.0; 2]),
        "FOV" => None,
        // k1 ... k4 of the angle.
        "OPENCV_FISHEYE" => Distortion::lens(angle, [at(0), at(1), at(2), at(3)], [0.0; 2]),
        // k1, k2, p1, p2, k3, k4, sx1, sy1.
        "THIN_PRISM_FISHEYE" => {
            let radial = [at(0), at(1), at(4), at(5)];
            Distortion::lens(angle, radial, [at(2), at(3)]).map(|lens| Distortion {
                thin_prism: [at(6), at(7)],
                ..lens
            })
        }
        _ if model.ends_with("FISHEYE") => Distortion::lens(angle, [at(0), at(1)], [0.0; 2]),
        // k1, k2, p1, p2, k3 ... k6.
        _ => c.iter().any(|&v| v != 0.0).then(|| Distortion {
            radial_below: [at(5), at(6), at(7)],
            ..Distortion::brown([at(0), at(1), at(4)], [at(2), at(3)]).unwrap_or_default()
        }),
    }
}

/// Ten fields or more, of which the tenth is a name: a line of points holds numbers only.
fn is_image_line(line: &TextLine) -> bool {
    let mut fields = line.text.split_whitespace();
    fields.nth(9).is_some_and(|f| !is_number(f))
}

fn read_image(line: &TextLine, lenses: &Cameras, cameras: &str) -> Result<Orientation> {
    let fields = line.fields();
    if fields.len() < 10 {
        let expected = "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME";
        return Err(line.miscounted(fields.len(), expected));
    }
    let q = line.numbers(&fields[1..5], "a quaternion component")?;
    let t = line.numbers(&fields[5..8], "a translation component")?;
    let id = line.whole(fields[8], "the camera id")?;
    let r = rotation_of_quaternion(line, &q)?;
    let lens = lenses.get(&id).ok_or_else(|| {
        line.error(
            format!("camera {id} is missing in {cameras}"),
            "a camera of that list",
        )
    })?;
    let lens = lens.as_ref().map_err(Error::clone)?;
    let center = Point3::from(-(r.transpose() * Vector3::new(t[0], t[1], t[2])));
    Ok(Orientation {
        distortion: lens.distortion,
        size: Some(lens.size),
        ..pinhole(after_fields(line.text, 9), &line.place(), lens.k, r, center)
    })
}

/// The rotation of a quaternion w, x, y, z.
pub(super) fn rotation_of_quaternion(line: &TextLine, wxyz: &[f64]) -> Result<Matrix3<f64>> {
    let quaternion = Quaternion::new(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    // Six printed digits leave 1e-6; a thousandth is no quaternion any more.
    if (quaternion.norm() - 1.0).abs() > ROUNDED_DEVIATION {
        let problem = format!("the quaternion has length {:.4}", quaternion.norm());
        return Err(line.error(problem, "a quaternion w x y z of length 1"));
    }
    let rotation = UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix();
    Ok(rotation.into_inner())
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
    use crate::base::math;

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
        let expected = Distortion::brown([0.1, -0.01], [0.001, 0.002]);
        assert_eq!(found[1].distortion, expected);
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
        check("1 EUCM 6 4 1 1 3 2 0.5 1\n", image, "image_undistorter");
        check(
            "1 PINHOLE 6 4 1 1 3\n",
            image,
            "3 parameters; expected 4 for PINHOLE",
        );
    }
    /// Where a camera sees a direction, pixels.
    fn seen(camera: &str, ideal: [f64; 2]) -> [f64; 2] {
        let found = &read_both(camera, "1 1 0 0 0 0 0 0 1 a.jpg\n").unwrap()[0];
        let d = found.distortion.unwrap().distort(&ideal.into());
        let p = found.k * Vector3::new(d.x, d.y, 1.0);
        [p.x, p.y]
    }

    #[test]
    fn fisheyes_put_points_where_colmap_does() {
        let (k, p, s) = ([-0.03, 0.004, -0.002, 0.0006], [3e-4, -2e-4], [1e-3, -5e-4]);
        for (x, y) in [(0.0, 1e-12), (0.3, -0.2), (1.2, 0.9), (-1.6, 0.4)] {
            let r = math::hypot(x, y);
            let theta = math::atan(r);
            let (u, v) = (x * theta / r, y * theta / r);
            let t2 = theta * theta;
            let radial = |k: &[f64]| 1.0 + k.iter().rev().fold(0.0, |sum, k| (sum + k) * t2);
            let aside = [
                2.0 * p[0] * u * v + p[1] * (t2 + 2.0 * u * u) + s[0] * t2,
                2.0 * p[1] * u * v + p[0] * (t2 + 2.0 * v * v) + s[1] * t2,
            ];
            let w = 0.9_f64;
            let fov = math::atan(2.0 * r * math::sin(w / 2.0) / math::cos(w / 2.0)) / (r * w);
            let pixel = |a: f64, b: f64| [300.0 * a + 320.0, 310.0 * b + 240.0];
            let [k1, k2, k3, k4] = k;
            let [p1, p2] = p;
            let [sx, sy] = s;
            let of = |model: &str, terms: &str| format!("1 {model} 640 480 {terms}\n");
            let two = "300 310 320 240";
            for (camera, expected) in [
                (
                    of("OPENCV_FISHEYE", &format!("{two} {k1} {k2} {k3} {k4}")),
                    pixel(u * radial(&k), v * radial(&k)),
                ),
                (
                    of(
                        "THIN_PRISM_FISHEYE",
                        &format!("{two} {k1} {k2} {p1} {p2} {k3} {k4} {sx} {sy}"),
                    ),
                    pixel(u * radial(&k) + aside[0], v * radial(&k) + aside[1]),
                ),
                (of("FOV", &format!("{two} {w}")), pixel(x * fov, y * fov)),
                (of("FISHEYE", two), pixel(u, v)),
            ] {
                let found = seen(&camera, [x, y]);
                let off = math::hypot(found[0] - expected[0], found[1] - expected[1]);
                assert!(off < 1e-6, "{camera}: {found:?} instead of {expected:?}");
            }
            let one = of("RADIAL_FISHEYE", &format!("310 320 240 {k1} {k2}"));
            let expected = [
                310.0 * u * radial(&k[..2]) + 320.0,
                310.0 * v * radial(&k[..2]) + 240.0,
            ];
            let found = seen(&one, [x, y]);
            assert!(math::hypot(found[0] - expected[0], found[1] - expected[1]) < 1e-6);
        }
    }

    #[test]
    fn the_full_model_of_opencv_divides_two_polynomials() {
        let [k1, k2, p1, p2, k3, k4, k5, k6] = [-0.2, 0.05, 1e-3, -2e-3, 0.02, 0.1, -0.04, 0.03];
        let camera = format!(
            "1 FULL_OPENCV 640 480 300 310 320 240 {k1} {k2} {p1} {p2} {k3} {k4} {k5} {k6}\n"
        );
        for [x, y] in [[0.3, -0.2], [-0.5, 0.4], [0.1, 0.6]] {
            let r2: f64 = x * x + y * y;
            let above = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
            let g = above / (1.0 + k4 * r2 + k5 * r2 * r2 + k6 * r2 * r2 * r2);
            let u = x * g + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
            let v = y * g + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
            let [column, row] = seen(&camera, [x, y]);
            assert!((column - (300.0 * u + 320.0)).abs() < 1e-9, "{column}");
            assert!((row - (310.0 * v + 240.0)).abs() < 1e-9, "{row}");
        }
    }

    #[test]
    fn an_unknown_model_that_no_image_uses_does_no_harm() {
        let cameras = format!("{CAMERAS}9 EUCM 6 4 1 1 3 2 0.5 1\n");
        assert_eq!(
            read_both(&cameras, "1 1 0 0 0 1 2 3 1 a.jpg\n")
                .unwrap()
                .len(),
            1
        );
    }
}
