//! Small text files of matrices: Pix4D's two, Middlebury's `_par.txt` and Strecha's `.camera`.
//!
//! * Pix4D `_calibrated_camera_parameters.txt`: per image name, size, K, radial (3), tangential
//!   (2), t, R with X' = R (X - t).
//! * Pix4D `_pmatrix.txt`: name and the 12 numbers of P of the undistorted image.
//! * The numbers of `_offset.xyz` beside them are added to the world of both.
//! * Middlebury: name, K, R, t of P = K [R, t]; the centre of the top-left pixel is (0, 0).
//! * Strecha: one file `NAME.camera` an image: K, a line of zeros, R (`world_from_cam`), C, size.

use nalgebra::{Matrix3, Point3, Vector3};

use super::projection::decompose;
use super::text::{TextLine, data_lines};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::angles::without_rounding;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
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
            && f[..f.len() - 2].iter().any(|f| f.parse::<f64>().is_err())
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
        let source = format!("{path}, line {}", first.number);
        found.push(Orientation {
            distortion: Distortion::brown(radial, tangential),
            size: Some((
                first.whole(size[0], "the width")?,
                first.whole(size[1], "the height")?,
            )),
            ..pinhole(name, &source, k, r, Point3::from(center) + offset)
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
        let source = format!("{path}, line {}", line.number);
        Ok(pinhole(name, &source, k, r, center + offset))
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
        let source = format!("{path}, line {}", line.number);
        Ok(pinhole(
            name,
            &source,
            k,
            r,
            Point3::from(-(r.transpose() * t)),
        ))
    };
    data_lines(path, text).skip(1).map(one).collect()
}

/// Reads one of Strecha's cameras; the image has the name of the file.
pub(crate) fn read_strecha(path: &str, text: &str) -> Result<Orientation> {
    let mut lines = data_lines(path, text);
    let k = matrix(path, &mut lines)?;
    numbers::<3>(path, lines.next())?;
    let world_from_cam = matrix(path, &mut lines)?;
    let center = numbers::<3>(path, lines.next())?;
    let [width, height] = numbers::<2>(path, lines.next())?;
    let name = path.rsplit('/').next().unwrap_or(path);
    let name = name.strip_suffix(".camera").unwrap_or(name);
    Ok(Orientation {
        size: Some((width as u32, height as u32)),
        ..pinhole(
            name,
            path,
            k,
            world_from_cam.transpose(),
            Point3::from(center),
        )
    })
}

/// The name in front of N fields; it may hold blanks.
fn split_name<'a, const N: usize>(
    line: &TextLine<'a>,
    expected: &str,
) -> Result<(&'a str, [&'a str; N])> {
    let fields = line.fields();
    let wrong = || line.error(format!("{} fields", fields.len()), expected);
    let (before, behind) = fields.split_last_chunk::<N>().ok_or_else(wrong)?;
    let last = before.last().ok_or_else(wrong)?;
    // A number too many is no part of a name.
    if before.len() > 1 && last.parse::<f64>().is_ok() {
        return Err(wrong());
    }
    let end = last.as_ptr() as usize - line.text.as_ptr() as usize + last.len();
    let name = line.text.get(..end).unwrap_or(last);
    Ok((name.trim_matches('"'), *behind))
}

fn matrix<'a>(path: &str, lines: &mut impl Iterator<Item = TextLine<'a>>) -> Result<Matrix3<f64>> {
    let mut m = Matrix3::zeros();
    for i in 0..3 {
        let row = numbers::<3>(path, lines.next())?;
        (0..3).for_each(|j| m[(i, j)] = row[j]);
    }
    Ok(m)
}

/// Exactly N numbers of a line.
fn numbers<const N: usize>(path: &str, line: Option<TextLine>) -> Result<[f64; N]> {
    let line = line.ok_or_else(|| Error::File {
        file: path.to_owned(),
        problem: "it ends in the middle of a camera".to_owned(),
        advice: "copy the whole file: its end is missing".to_owned(),
    })?;
    let fields: Vec<&str> = line
        .text
        .split([' ', '\t', ','])
        .filter(|f| !f.is_empty())
        .collect();
    let wrong = || line.error(format!("{} fields", fields.len()), format!("{N} numbers"));
    line.numbers(&fields, "a number")?
        .try_into()
        .map_err(|_| wrong())
}
