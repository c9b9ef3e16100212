//! INPHO's project file (`.prj`): keys `$KEY : value`, whose further values follow on the lines
//! below.
//!
//! * `$CCD_INTERIOR_ORIENTATION` leads from millimetres in the image plane (x right, y up) to
//!   pixels: an affine map that flips y, and turns the image where the sensor is mounted turned.
//!   `$PIXEL_REFERENCE` states which point of the first pixel is (0, 0).
//! * `$EXT_ORI`: focal length, X, Y, Z, and the matrix Rx(omega) Ry(phi) Rz(kappa), from the image
//!   to the world.
//! * The distortion: `lens`.
//! * Of a camera's `$CALIBRATION_SET`s the one that `$ACTIVE_CALIBRATION` names.
//!
//! `$CAMERA_MOUNT_ROTATION` belongs to the angles of the flight, not to the matrix, and is not
//! read.

mod block;
mod lens;

use nalgebra::{Matrix2, Matrix3, Point2, Point3, Vector2, Vector3};

use self::block::{ProjectBlock, numbers, project_blocks};
use self::lens::InphoLens;
use super::brown_fit::fit;
use super::projection::decompose;
use super::text::TextLine;
use crate::base::error::{Error, Result};
use crate::base::math;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::orienting::orientation::input_file::base_name;
use crate::photographs::camera::Distortion;

/// Reads the photos of a project.
pub(crate) fn read(path: &str, text: &str, warnings: &mut Vec<String>) -> Result<Vec<Orientation>> {
    let blocks = project_blocks(path, text);
    // One that no photo names may be an unknown one.
    let cameras: Vec<(Option<&str>, Result<InteriorOrientation>)> = (blocks.iter())
        .filter(|b| b.is_camera)
        .map(|b| {
            let camera = b.calibrated();
            (
                b.word("ID"),
                camera.and_then(|c| InteriorOrientation::read(&c)),
            )
        })
        .collect();
    let (mut found, mut distorts) = (Vec::new(), false);
    for photo in blocks.iter().filter(|b| !b.is_camera) {
        // Photos without it were not oriented.
        let Some(exterior) = photo.values.get("EXT_ORI") else {
            continue;
        };
        let id = photo.word("CAMERA_ID");
        let same = cameras.iter().find(|(of, _)| *of == id && id.is_some());
        // Older files hold one camera, which has no name.
        let nameless = |(of, _): &&(Option<&str>, _)| id.is_none() || of.is_none();
        let only = cameras.first().filter(|_| cameras.len() == 1);
        let Some((_, interior)) = same.or(only.filter(nameless)) else {
            let problem = format!("its camera {} is missing", id.unwrap_or("(without name)"));
            return Err(photo.start.error(problem, "a $CAMERA block of this $ID"));
        };
        let interior = interior.as_ref().map_err(Error::clone)?;
        distorts |= interior.lens != InphoLens::None;
        found.push(orientation(photo, exterior, interior)?);
    }
    if distorts {
        warnings.push(format!(
            "{path}: the distortion that it states is removed from the images (if they are free of it already, delete it there)"
        ));
    }
    Ok(found)
}

/// InteriorOrientation orientation: pixel = A (mm, y up) + c, first pixel's centre at (0.5, 0.5).
struct InteriorOrientation {
    pixel_from_mm: Matrix2<f64>,
    pixel_of_zero: Vector2<f64>,
    principal_mm: Vector2<f64>,
    focal_mm: f64,
    size: (u32, u32),
    lens: InphoLens,
}

impl InteriorOrientation {
    fn read(camera: &ProjectBlock) -> Result<Self> {
        let [a, b, c, d, e, f] = camera.numbers("CCD_INTERIOR_ORIENTATION")?;
        let side = |key: &str| -> Result<u32> {
            let [value] = camera.numbers::<1>(key)?;
            let whole = value.fract() == 0.0 && (1.0..=4e9).contains(&value);
            let wrong = || (camera.start).error(format!("${key} is {value}"), "whole pixels");
            whole.then_some(value as u32).ok_or_else(wrong)
        };
        let shift = match camera.word("PIXEL_REFERENCE") {
            Some(point) if !point.starts_with("Center") => 0.0,
            _ => 0.5,
        };
        let principal = match camera.values.contains_key("PRINCIPAL_POINT_PPA") {
            true => camera.numbers("PRINCIPAL_POINT_PPA")?,
            false => [0.0; 2],
        };
        Ok(Self {
            pixel_from_mm: Matrix2::new(a, b, d, e),
            pixel_of_zero: Vector2::new(c + shift, f + shift),
            principal_mm: Vector2::from(principal),
            focal_mm: camera.numbers::<1>("FOCAL_LENGTH")?[0],
            size: (side("CCD_COLUMNS")?, side("CCD_ROWS")?),
            lens: InphoLens::read(camera)?,
        })
    }

    /// Pairs of (ideal, measured) positions, pixels.
    fn lens_pairs(&self) -> Option<Vec<(Vector2<f64>, Vector2<f64>)>> {
        // Directions in which the lens is sampled: decentring turns once around, and eight samples
        // a turn show it well. Assumption: twice that.
        const DIRECTIONS: i32 = 16;
        let mm_from_pixel = self.pixel_from_mm.try_inverse()?;
        let (w, h) = (f64::from(self.size.0), f64::from(self.size.1));
        let corners = [[0.0, 0.0], [w, 0.0], [0.0, h], [w, h]].map(Vector2::from);
        let radius = |corner: &Vector2<f64>| {
            (mm_from_pixel * (corner - self.pixel_of_zero) - self.principal_mm).norm()
        };
        let farthest = corners.iter().map(radius).fold(0.0, f64::max);
        let pixel =
            |mm: &Vector2<f64>| self.pixel_from_mm * (mm + self.principal_mm) + self.pixel_of_zero;
        let mut pairs = Vec::new();
        for radius in self.lens.radii(farthest) {
            for i in 0..DIRECTIONS {
                let (s, c) =
                    math::sin_cos(f64::from(i) * std::f64::consts::TAU / f64::from(DIRECTIONS));
                let measured = Vector2::new(c, s) * radius;
                pairs.push((pixel(&self.lens.ideal(&measured)), pixel(&measured)));
            }
        }
        Some(pairs)
    }

    /// From directions (x right, y up, z back) to pixels: x ~ K (x, y, -z).
    fn pixel_from_direction(&self) -> Matrix3<f64> {
        let a = self.pixel_from_mm * self.focal_mm;
        let p = self.pixel_from_mm * self.principal_mm + self.pixel_of_zero;
        let mut pixel = a.to_homogeneous();
        pixel.set_column(2, &Vector3::new(-p.x, -p.y, -1.0));
        pixel
    }
}

fn orientation(
    photo: &ProjectBlock,
    exterior: &[TextLine],
    interior: &InteriorOrientation,
) -> Result<Orientation> {
    let n = numbers::<13>(exterior, "EXT_ORI")?;
    let world_from_image = Matrix3::from_row_slice(&n[4..]);
    let m = interior.pixel_from_direction() * world_from_image.transpose();
    // A turned sensor turns the camera: K is to be upper triangular.
    let parts = (m.determinant() > 0.0)
        .then(|| decompose(&m, &Vector3::zeros()))
        .flatten();
    let (k, r, _) = parts.ok_or_else(|| {
        photo.start.error(
            "interior and exterior orientation give no camera, or a mirrored one",
            "an interior orientation that flips y",
        )
    })?;
    let file = photo
        .word("PHOTO_FILE")
        .or(photo.word("PHOTO_NUM"))
        .unwrap_or_default();
    let source = photo.start.place();
    let (k, distortion) = with_lens(photo, k, interior)?;
    Ok(Orientation {
        size: Some(interior.size),
        distortion,
        ..pinhole(
            base_name(file),
            &source,
            k,
            r,
            Point3::new(n[1], n[2], n[3]),
        )
    })
}

/// Calibration and distortion (Brown) of the lens in the file.
fn with_lens(
    photo: &ProjectBlock,
    mut k: Matrix3<f64>,
    interior: &InteriorOrientation,
) -> Result<(Matrix3<f64>, Option<Distortion>)> {
    // Tables are rounded to a micrometre or a tenth of it.
    let allowed_px = match interior.lens {
        InphoLens::None => return Ok((k, None)),
        InphoLens::Polynomial(..) => 0.05,
        InphoLens::Table(_) => 0.5,
    };
    let refusal = || {
        let problem =
            "its distortion is none that Brown's formula with three coefficients comes near";
        photo
            .start
            .error(problem, "free the images of distortion, and delete it here")
    };
    let inverse = k.try_inverse().ok_or_else(refusal)?;
    let normalised = |p: &Vector2<f64>| Point2::from((inverse * Vector3::new(p.x, p.y, 1.0)).xy());
    let pairs = interior.lens_pairs().ok_or_else(refusal)?;
    let pairs: Vec<_> = pairs
        .iter()
        .map(|(a, b)| (normalised(a), normalised(b)))
        .collect();
    let focal_px = k[(0, 0)].abs();
    let lens = fit(&pairs)
        .filter(|lens| lens.worst * focal_px < allowed_px)
        .ok_or_else(refusal)?;
    for at in [(0, 0), (0, 1), (1, 1)] {
        k[at] *= lens.focal_factor;
    }
    Ok((k, Some(lens.distortion)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photographs::camera::Camera;

    #[test]
    fn a_turned_sensor_puts_points_where_the_affine_map_says() {
        // 90 degrees: columns run along -y, rows along -x of the image plane.
        let text = "$PROJECT 6\n$CAMERA_DEFINITION\n $ID : oblique\n $CCD_INTERIOR_ORIENTATION :\n 0 -250 7000.5\n -250 0 5300\n $CCD_COLUMNS : 14000\n \
                    $CCD_ROWS : 10600\n $PIXEL_REFERENCE : CenterTopLeft\n $FOCAL_LENGTH : 100\n $PRINCIPAL_POINT_PPA : 0.02 -0.01\n$END\n\
                    $PHOTO\n $PHOTO_FILE : D:\\flight\\a.tif\n $CAMERA_ID : oblique\n $EXT_ORI : 12:00:00 01/01/2026\n 100 500000 5400000 1000\n 1 0 0\n 0 1 0\n 0 0 1\n$END\n";
        let found = &read("a.prj", text, &mut Vec::new()).unwrap()[0];
        assert_eq!((&*found.image, found.size), ("a.tif", Some((14000, 10600))));
        let camera = Camera {
            k: found.k,
            r: found.r,
            center: found.center,
            width: 14000,
            height: 10600,
        };
        // 100 m east and 50 m north, 1000 m below: 10 mm and 5 mm in the image plane.
        let p = camera
            .project(&Point3::new(500_100.0, 5_400_050.0, 0.0))
            .unwrap();
        let (x, y) = (10.0 + 0.02, 5.0 - 0.01);
        assert!(
            (p.x - (-250.0 * y + 7001.0)).abs() < 1e-6
                && (p.y - (-250.0 * x + 5300.5)).abs() < 1e-6,
            "{p}"
        );
    }

    #[test]
    fn a_sensor_that_is_mounted_askew_keeps_rows_and_columns_apart() {
        let text = "$PROJECT 6\n$CAMERA\n $CCD_INTERIOR_ORIENTATION :\n 200 4 3000\n 7 -198 2000\n \
                    $CCD_COLUMNS : 6000\n $CCD_ROWS : 4000\n $FOCAL_LENGTH : 50\n$END\n\
                    $PHOTO\n $PHOTO_NUM : a\n $EXT_ORI :\n 50 0 0 1000\n 1 0 0\n 0 1 0\n 0 0 1\n$END\n";
        let found = &read("a.prj", text, &mut Vec::new()).unwrap()[0];
        // 5 mm to the right and 3 mm up in the image plane.
        let seen = found.k * found.r * Vector3::new(5.0, 3.0, -50.0);
        let expected = Vector2::new(
            200.0 * 5.0 + 4.0 * 3.0 + 3000.5,
            7.0 * 5.0 - 198.0 * 3.0 + 2000.5,
        );
        let off = (seen.xy() / seen.z - expected).norm();
        assert!(off < 1e-6, "{off} px");
    }

    /// A camera of 100 mm and 5 micrometres, whose image is rotated if `turned`.
    fn with(lens: &str, turned: bool) -> Result<Orientation> {
        let interior = match turned {
            true => "0 -200 3000\n -200 0 2000",
            false => "200 0 3000\n 0 -200 2000",
        };
        let text = format!(
            "$PROJECT 6\n$CAMERA\n $CCD_INTERIOR_ORIENTATION :\n {interior}\n $CCD_COLUMNS : 6000\n $CCD_ROWS : 4000\n $FOCAL_LENGTH : 50\n \
             $PRINCIPAL_POINT_PPA : 0.1 -0.2\n{lens}$END\n$PHOTO\n $PHOTO_NUM : a\n $EXT_ORI :\n 50 0 0 1000\n 1 0 0\n 0 1 0\n 0 0 1\n$END\n"
        );
        Ok(read("a.prj", &text, &mut Vec::new())?.remove(0))
    }

    /// Image position of the ray whose ideal position in the image plane is this, mm.
    fn pixel(found: &Orientation, ideal_mm: Vector2<f64>) -> Vector2<f64> {
        let ray = found.r * Vector3::new(ideal_mm.x, ideal_mm.y, -50.0);
        let seen = found
            .distortion
            .unwrap()
            .distort(&Point2::new(ray.x / ray.z, ray.y / ray.z));
        (found.k * Vector3::new(seen.x, seen.y, 1.0)).xy()
    }

    #[test]
    fn a_polynomial_and_a_table_put_points_where_the_lens_does() {
        let (k0, k1, k2, p1, p2) = (1e-4, -1.5e-5, 4e-9, 3.4e-6, -4.4e-6);
        let polynomial = format!(
            " $DISTORTION_TYPE : Polynomial\n $RADIAL_COEFFS :\n {k0} {k1} {k2} 0\n 0 0 0 0\n $DECENTRE_COEFFS :\n {p1} {p2} 0 0\n"
        );
        let rows = (0..=20).map(|i| f64::from(i) * 1.0);
        let row = |r: f64| {
            format!(
                "  {r} {:.4}\n",
                1e3 * (k1 * r * r * r + k2 * r * r * r * r * r)
            )
        };
        let table = format!(
            " $RADIAL_DISTORTION :\n{}",
            rows.map(row).collect::<String>()
        );
        for turned in [false, true] {
            for (lens, [k0, p1, p2], bound_px) in
                [(&polynomial, [k0, p1, p2], 0.01), (&table, [0.0; 3], 0.01)]
            {
                let found = with(lens, turned).unwrap();
                for (x, y) in [(12.0, 7.0), (-14.0, 3.0), (5.0, -9.0), (0.5, 0.2)] {
                    let r2: f64 = x * x + y * y;
                    let g = k0 + k1 * r2 + k2 * r2 * r2;
                    let ideal = Vector2::new(
                        x - x * g - p1 * (r2 + 2.0 * x * x) - 2.0 * p2 * x * y,
                        y - y * g - p2 * (r2 + 2.0 * y * y) - 2.0 * p1 * x * y,
                    );
                    let (u, v) = (x + 0.1, y - 0.2);
                    let (column, row) = match turned {
                        true => (-200.0 * v + 3000.5, -200.0 * u + 2000.5),
                        false => (200.0 * u + 3000.5, -200.0 * v + 2000.5),
                    };
                    let error = (pixel(&found, ideal) - Vector2::new(column, row)).norm();
                    assert!(
                        error < bound_px,
                        "{error} px at ({x}, {y}), turned {turned}: {lens}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_lens_that_no_formula_fits_is_refused() {
        let row = |i: i32| format!(" {} {}\n", 2 * i, if i % 2 == 0 { 90 } else { -90 });
        let rows: String = (1..=10).map(row).collect();
        let table = format!(" $RADIAL_DISTORTION :\n{rows}");
        assert!(
            with(&table, false)
                .unwrap_err()
                .to_string()
                .contains("Brown")
        );
        let odd = " $RADIAL_DISTORTION :\n 0 0\n 5 1\n 10 2 3\n 15 4\n";
        assert!(with(odd, false).unwrap_err().to_string().contains("pairs"));
        let zero = " $RADIAL_COEFFS :\n 0 0 0 0\n $DECENTRE_COEFFS :\n 0 0\n";
        assert_eq!(with(zero, false).unwrap().distortion, None);
    }

    #[test]
    fn the_active_calibration_is_taken() {
        let set = |id: u32, focal: f64| {
            format!(
                " $CALIBRATION_SET :\n  $ID : {id}\n  $CCD_INTERIOR_ORIENTATION :\n  200 0 3000\n  0 -200 2000\n  $FOCAL_LENGTH : {focal}\n \
                 $END\n"
            )
        };
        let text = |active: &str, sets: &str| {
            format!(
                "$CAMERA_DEFINITION\n $ID : nadir\n $CCD_COLUMNS : 6000\n $CCD_ROWS : 4000\n{active}{sets}$END\n\
                 $PHOTO\n $PHOTO_NUM : a\n $CAMERA_ID : nadir\n $EXT_ORI :\n 50 0 0 1000\n 1 0 0\n 0 1 0\n 0 0 1\n$END\n"
            )
        };
        let focal_px = |active: &str, sets: &[(u32, f64)]| {
            let sets: String = sets.iter().map(|&(id, focal)| set(id, focal)).collect();
            let found = read("a.prj", &text(active, &sets), &mut Vec::new())?;
            Ok::<_, crate::base::error::Error>(found[0].k[(0, 0)])
        };
        let two = [(1, 50.0), (2, 52.0)];
        assert_eq!(focal_px(" $ACTIVE_CALIBRATION : 2\n", &two), Ok(10400.0));
        assert_eq!(focal_px(" $ACTIVE_CALIBRATION : 1\n", &two), Ok(10000.0));
        assert_eq!(focal_px("", &two[1..]), Ok(10400.0));
        for (active, said) in [
            ("", "$ACTIVE_CALIBRATION is missing"),
            (
                " $ACTIVE_CALIBRATION : 3\n",
                "$ACTIVE_CALIBRATION is \"3\", but",
            ),
        ] {
            let refusal = focal_px(active, &two).unwrap_err().to_string();
            assert!(
                refusal.contains(said) && refusal.contains("\"1, 2\""),
                "{refusal}"
            );
        }
    }

    #[test]
    fn refusals_name_the_line() {
        let message = |text: &str| {
            read("a.prj", text, &mut Vec::new())
                .unwrap_err()
                .to_string()
        };
        assert!(
            message("$PHOTO\n $PHOTO_NUM : 1\n $EXT_ORI :\n 1 2 3 4\n")
                .contains("its camera (without name) is missing")
        );
        let camera = "$CAMERA\n $CCD_INTERIOR_ORIENTATION :\n 100 0 50\n 0 100 50\n $CCD_COLUMNS : 100\n $CCD_ROWS : 100\n $FOCAL_LENGTH : 50\n";
        assert!(
            message(&format!(
                "{camera}$PHOTO\n $EXT_ORI :\n 50 0 0 9\n 1 0 0\n 0 1 0\n"
            ))
            .contains("has 10 numbers")
        );
        assert!(
            message(&format!(
                "{camera}$PHOTO\n $EXT_ORI :\n 50 0 0 9\n 1 0 0\n 0 1 0\n 0 0 1\n"
            ))
            .contains("mirrored")
        );
    }
}
