//! Small text files of matrices: Pix4D's two, Middlebury's `_par.txt` and Strecha's `.camera`.
//!
//! * Pix4D `_calibrated_camera_parameters.txt`: per image name, size, K, radial (3), tangential
//!   (2), t, R with X' = R (X - t).
//! * Pix4D `_pmatrix.txt`: name and the 12 numbers of P of the undistorted image.
//! * The numbers of `_offset.xyz` beside them are added to the world of both.
//! * Middlebury: name, K, R, t of P = K [R, t]; the centre of the top-left pixel is (0, 0).
//! * Strecha: one file `NAME.camera` an image: K, a line of zeros, R (`world_from_cam`), C, size.

use nalgebra::{Matrix3, Point3, RowVector3, Vector3};

use super::projection::decompose;
use super::text::{TextLine, data_lines, ends_early, is_number};
use crate::base::error::Result;
use crate::orienting::orientation::angles::without_rounding;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::orienting::orientation::input_file::base_name;
use crate::photographs::camera::Distortion;

/// Reads Pix4D's calibrated camera parameters.
pub(crate) fn read_pix4d(
    (path, text): (&str, &str),
    offset: Option<(&str, &str)>,
) -> Result<Vec<Orientation>> {
    let offset = offset_of(offset)?;
    // Eight lines of header describe the content.
    let is_image = |line: &TextLine| {
        let f = line.fields();
        f.len() >= 3
            && f[..f.len() - 2].iter().any(|f| !is_number(f))
            && f[f.len() - 2..].iter().all(|f| f.parse::<u32>().is_ok())
    };
    let mut lines = data_lines(path, text)
        .skip_while(|l| !is_image(l))
        .peekable();
    let mut found = Vec::new();
    while let Some(first) = lines.next() {
        if !is_image(&first) {
            return Err(first.error("no image stands here", "NAME width height"));
        }
        let (name, size) = split_name::<2>(&first, "NAME width height")?;
        let k = matrix(path, &mut lines)?;
        let radial = numbers::<3>(path, lines.next())?;
        let tangential = numbers::<2>(path, lines.next())?;
        let center = numbers::<3>(path, lines.next())?;
        let r = matrix(path, &mut lines)?;
        found.push(Orientation {
            distortion: Distortion::brown(radial, tangential),
            size: Some((
                first.whole(size[0], "the width")?,
                first.whole(size[1], "the height")?,
            )),
            ..pinhole(name, &first.place(), k, r, Point3::from(center) + offset)
        });
    }
    Ok(found)
}

/// Reads Pix4D's projection matrices; `offset` is added to the world.
pub(crate) fn read_pmatrix(
    (path, text): (&str, &str),
    offset: Option<(&str, &str)>,
) -> Result<Vec<Orientation>> {
    let offset = offset_of(offset)?;
    let one = |line: TextLine| {
        let (name, fields) = split_name::<12>(&line, "NAME and 12 numbers")?;
        let v = line.numbers(&fields, "an element")?;
        let m = Matrix3::from_fn(|i, j| v[4 * i + j]);
        let column = Vector3::new(v[3], v[7], v[11]);
        let (k, r, center) = decompose(&m, &column)
            .ok_or_else(|| line.error("its left 3 x 3 part is singular", "P = K [R | -R C]"))?;
        Ok(pinhole(name, &line.place(), k, r, center + offset))
    };
    data_lines(path, text).map(one).collect()
}

/// The zero of Pix4D's local coordinates in its world.
fn offset_of(file: Option<(&str, &str)>) -> Result<Vector3<f64>> {
    Ok(match file {
        Some((path, text)) => Vector3::from(numbers::<3>(path, data_lines(path, text).next())?),
        None => Vector3::zeros(),
    })
}

/// Reads Middlebury's parameters.
pub(crate) fn read_middlebury(path: &str, text: &str) -> Result<Vec<Orientation>> {
    let one = |line: TextLine| {
        let (name, fields) = split_name::<21>(&line, "NAME and 21 numbers of K, R, t")?;
        let v = line.numbers(&fields, "an element")?;
        let mut k = Matrix3::from_row_slice(&v[..9]);
        let r = without_rounding(&Matrix3::from_row_slice(&v[9..18]));
        let t = Vector3::from_row_slice(&v[18..]);
        k[(0, 2)] += 0.5;
        k[(1, 2)] += 0.5;
        let center = Point3::from(-(r.transpose() * t));
        Ok(pinhole(name, &line.place(), k, r, center))
    };
    data_lines(path, text).skip(1).map(one).collect()
}

/// Reads one of Strecha's cameras; the image has the name of the file.
pub(crate) fn read_strecha(path: &str, text: &str) -> Result<Orientation> {
    let mut lines = data_lines(path, text);
    let k = matrix(path, &mut lines)?;
    numbers::<3>(path, lines.next())?;
    let world_from_cam = matrix(path, &mut lines)?;
    let center = Point3::from(numbers::<3>(path, lines.next())?);
    let [width, height] = numbers::<2>(path, lines.next())?;
    let name = base_name(path);
    let name = name.strip_suffix(".camera").unwrap_or(name);
    Ok(Orientation {
        size: Some((width as u32, height as u32)),
        ..pinhole(name, path, k, world_from_cam.transpose(), center)
    })
}

/// The name in front of N fields; it may hold blanks.
fn split_name<'a, const N: usize>(
    line: &TextLine<'a>,
    expected: &str,
) -> Result<(&'a str, [&'a str; N])> {
    let fields = line.fields();
    let wrong = || line.miscounted(fields.len(), expected);
    let (before, behind) = fields.split_last_chunk::<N>().ok_or_else(wrong)?;
    let last = before.last().ok_or_else(wrong)?;
    // A number too many is no part of a name.
    if before.len() > 1 && is_number(last) {
        return Err(wrong());
    }
    Ok((line.up_to(last).trim_matches('"'), *behind))
}

fn matrix<'a>(path: &str, lines: &mut impl Iterator<Item = TextLine<'a>>) -> Result<Matrix3<f64>> {
    let mut row = || Ok(RowVector3::from(numbers::<3>(path, lines.next())?));
    Ok(Matrix3::from_rows(&[row()?, row()?, row()?]))
}

/// Exactly N numbers of a line.
fn numbers<const N: usize>(path: &str, line: Option<TextLine>) -> Result<[f64; N]> {
    let line = line.ok_or_else(|| ends_early(path, "it ends in the middle of a camera"))?;
    let fields = line.text.split([' ', '\t', ',']).filter(|f| !f.is_empty());
    line.exactly(&fields.collect::<Vec<_>>(), format!("{N} numbers"))
}
