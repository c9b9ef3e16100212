//! VGG's projection matrices: one file `NAME.P` an image, three lines of four numbers.
//!
//! The centre of the top-left pixel is (0, 0), so both coordinates grow by half a pixel here. The
//! matrix is known up to scale and sign: with P = K [R | -R C] = [M | m] the sign with det(M) > 0
//! is the one that a rotation and a K with positive diagonal have.

use nalgebra::{Matrix3, Point3, RowVector3, Vector3};

use super::text::data_lines;
use crate::base::error::{Error, Result};
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::orienting::orientation::input_file::stem;

/// Reads a matrix; the image has the name of the file.
pub(crate) fn read(path: &str, text: &str) -> Result<Orientation> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for line in data_lines(path, text) {
        let fields = line.fields();
        if fields.len() != 4 || rows.len() == 3 {
            let problem = format!("{} fields in data line {}", fields.len(), rows.len() + 1);
            return Err(line.error(problem, "three lines of four numbers"));
        }
        rows.push(line.numbers(&fields, "an element")?);
    }
    let refuse = |problem: &str| {
        Error::file(
            path,
            problem,
            "write the 3 x 4 matrix P = K [R | -R C] on three lines",
        )
    };
    if rows.len() != 3 {
        return Err(refuse(&format!("{} lines of numbers", rows.len())));
    }
    let m = Matrix3::from_fn(|i, j| rows[i][j]);
    let column = Vector3::from_fn(|i, _| rows[i][3]);
    let (mut k, r, center) =
        decompose(&m, &column).ok_or_else(|| refuse("its left 3 x 3 part is singular"))?;
    k[(0, 2)] += 0.5;
    k[(1, 2)] += 0.5;
    Ok(pinhole(stem(path), path, k, r, center))
}

/// `[M | m] ~ K [R | -R C]` with K upper triangular of positive diagonal and `K[(2, 2)] = 1`:
/// Gram-Schmidt on the rows of M from the last to the first. `None` for a singular M.
pub(crate) fn decompose(
    m: &Matrix3<f64>,
    column: &Vector3<f64>,
) -> Option<(Matrix3<f64>, Matrix3<f64>, Point3<f64>)> {
    // The size of P is arbitrary: take it out before numbers are compared or multiplied.
    let scale = m.amax();
    if scale == 0.0 {
        return None;
    }
    let (m, column) = (m / scale, column / scale);
    let center = m.lu().solve(&-column)?;
    let m = if m.determinant() < 0.0 { -m } else { m };

    let (m1, m2, m3) = (m.row(0), m.row(1), m.row(2));
    let (k33, r3) = unit(&m3.into_owned())?;
    let k23 = m2.dot(&r3);
    let (k22, r2) = unit(&(m2 - r3 * k23))?;
    let (k12, k13) = (m1.dot(&r2), m1.dot(&r3));
    let (k11, r1) = unit(&(m1 - r3 * k13 - r2 * k12))?;
    let k = Matrix3::new(k11, k12, k13, 0.0, k22, k23, 0.0, 0.0, k33) / k33;
    let r = Matrix3::from_rows(&[r1, r2, r3]);
    let finite = k
        .iter()
        .chain(r.iter())
        .chain(center.iter())
        .all(|v| v.is_finite());
    // Rows of M that depend on each other within rounding leave a K of rounding noise.
    let regular = k11.min(k22) > 1e-10 && k33 > 1e-14;
    (finite && regular).then(|| (k, r, Point3::from(center)))
}

fn unit(row: &RowVector3<f64>) -> Option<(f64, RowVector3<f64>)> {
    let norm = row.norm();
    (norm > 0.0).then(|| (norm, row / norm))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;
    use crate::photographs::camera::Camera;
    use nalgebra::Vector3;

    fn planted() -> Camera {
        let k = Matrix3::new(15294.0, 0.4, -2869.75, 0.0, 15290.0, 2482.25, 0.0, 0.0, 1.0);
        let r = rotation_from_axis_angle(&Vector3::new(3.1, 0.03, 2.2));
        Camera::new(k, r, Point3::new(431_820.7, 5_412_100.1, 1375.7), 600, 600)
    }

    fn text(camera: &Camera, scale: f64) -> String {
        let p = camera.projection_matrix() * scale;
        p.row_iter()
            .map(|r| format!("{} {} {} {}\n", r[0], r[1], r[2], r[3]))
            .collect()
    }

    #[test]
    fn scale_and_sign_do_not_matter() {
        let camera = planted();
        for scale in [1.0, -1.0, 3e-7, -250.0] {
            let found = read("P/a.P", &text(&camera, scale)).unwrap();
            assert_eq!(found.image, "a");
            let mut k = camera.k;
            k[(0, 2)] += 0.5;
            k[(1, 2)] += 0.5;
            assert!((found.k - k).norm() < 1e-5, "{}", found.k);
            assert!((found.r - camera.r).norm() < 1e-9);
            assert!((found.center - camera.center).norm() < 1e-3);
        }
    }

    #[test]
    fn what_is_no_matrix_is_refused() {
        let message = |text: &str| read("a.P", text).unwrap_err().to_string();
        assert!(message("1 0 0 0\n0 1 0 0\n").contains("2 lines"));
        assert!(message("1 0 0 0\n0 1 0\n0 0 1 0").contains("line 2: 3 fields"));
        assert!(message("1 0 0 0\n0 1 0 NaN\n0 0 1 0").contains("line 2: an element is \"NaN\""));
        assert!(message("1 0 0 0\n2 0 0 1\n0 0 1 0").contains("singular"));
        assert!(message("1 2 3 0\n4 5 6 1\n7 8 9 0").contains("singular"));
        assert!(message("0 0 0 0\n0 0 0 0\n0 0 0 0").contains("singular"));
    }
}
