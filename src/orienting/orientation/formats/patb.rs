//! PAT-B's exterior orientation (`.ori`): three Fortran records a photo, without separators.
//!
//! ```text
//! I16, 16X, 3F16.5    photo, (focal length or blanks), X, Y, Z of the projection centre
//! 5F16.12             a11 a12 a13 a21 a22
//! 4F16.12             a23 a31 a32 a33
//! ```
//!
//! The matrix is Rx(omega) Ry(phi) Rz(kappa), from the image (x right, y up) to the world. The
//! interior orientation is in the camera file of the photogrammetric list. Files that were
//! edited separate by blanks: these are taken where the columns hold no numbers.

use nalgebra::{Matrix3, Point3};

use super::photogrammetric::{CameraFrame, read_frame};
use super::text::{TextLine, ends_early, is_number, raw_lines};
use crate::base::error::Result;
use crate::orienting::orientation::angles::Y_UP;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};

/// Columns of a field.
const WIDTH: usize = 16;

/// Reads camera file and exterior orientation, (path, text) each.
pub(crate) fn read(
    camera: (&str, &str),
    exterior: (&str, &str),
    warnings: &mut Vec<String>,
) -> Result<Vec<Orientation>> {
    let frame = read_frame(camera.0, camera.1, warnings)?;
    let lines: Vec<TextLine> = raw_lines(exterior.0, exterior.1)
        .filter(|l| !l.is_empty())
        .collect();
    let photos = lines.chunks(3).map(|records| match records {
        [first, second, third] => photo(&frame, first, second, third),
        _ => Err(ends_early(exterior.0, "it ends in the middle of a photo")),
    });
    photos.collect()
}

/// Are these the first lines of such a file?
pub(crate) fn is_patb(text: &str) -> bool {
    let lines: Vec<TextLine> = raw_lines("", text)
        .filter(|l| !l.is_empty())
        .take(3)
        .collect();
    let [first, second, third] = &lines[..] else {
        return false;
    };
    center(first).is_ok() && elements::<5>(second).is_ok() && elements::<4>(third).is_ok()
}

fn photo(
    frame: &CameraFrame,
    first: &TextLine,
    second: &TextLine,
    third: &TextLine,
) -> Result<Orientation> {
    let (image, center) = center(first)?;
    let (a, b) = (elements::<5>(second)?, elements::<4>(third)?);
    let elements: Vec<f64> = a.into_iter().chain(b).collect();
    let r = Y_UP * Matrix3::from_row_slice(&elements).transpose();
    let part = frame.part_of(&image);
    Ok(Orientation {
        size: Some(part.size),
        crop: Some(frame.crop(part)),
        ..pinhole(&image, &first.place(), frame.k(part), r, center)
    })
}

/// Photo and projection centre.
fn center(line: &TextLine) -> Result<(String, Point3<f64>)> {
    let fields = match columns(line, &[0, 2, 3, 4]).filter(|f| f[1..].iter().all(|f| is_number(f)))
    {
        Some(fields) => fields,
        None => line.fields(),
    };
    let xyz = match fields.len() {
        4 => &fields[1..],
        // The focal length may come between.
        5 => &fields[2..],
        n => return Err(line.miscounted(n, "photo X Y Z in columns of 16 characters")),
    };
    let v = line.numbers(xyz, "a coordinate")?;
    Ok((fields[0].to_owned(), Point3::new(v[0], v[1], v[2])))
}

/// N elements of the matrix.
fn elements<const N: usize>(line: &TextLine) -> Result<[f64; N]> {
    let all: Vec<usize> = (0..N).collect();
    let fields = match columns(line, &all).filter(|f| f.iter().all(|f| is_number(f))) {
        Some(fields) => fields,
        None => line.fields(),
    };
    let expected = format!("{N} numbers in columns of 16 characters");
    line.exactly(&fields, expected)
}

/// The fields in these columns; `None` where the line ends before them.
fn columns<'a>(line: &TextLine<'a>, places: &[usize]) -> Option<Vec<&'a str>> {
    let field = |&i: &usize| {
        let end = ((i + 1) * WIDTH).min(line.text.len());
        line.text.get(i * WIDTH..end).map(str::trim)
    };
    places.iter().map(field).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: &str = "principal_distance_mm 100\npixel_size_mm 0.01\nimage_size_px 4000 3000\n";

    #[test]
    fn columns_and_not_blanks_separate_numbers() {
        // Sixteen characters each: photo, focal length, and coordinates that touch.
        let record =
            "            1042      153.190000-4321000.1234567-5432100.1234567 1234567890.1234\n";
        let matrix = "  1.000000000000  0.000000000000  0.000000000000  0.000000000000  1.000000000000\n  0.000000000000  0.000000000000  0.000000000000  1.000000000000\n";
        let read = |text: &str| read(("c", CAMERA), ("e", text), &mut Vec::new()).unwrap();
        let found = read(&format!("{record}{matrix}"));
        assert_eq!(read(&format!("\u{feff}{record}{matrix}")), found);
        assert_eq!(found[0].image, "1042");
        assert_eq!(
            found[0].center,
            Point3::new(-4321000.1234567, -5432100.1234567, 1234567890.1234)
        );
        assert_eq!(found[0].r, Y_UP);
        assert_eq!(
            (found[0].k[(0, 0)], found[0].k[(0, 2)], found[0].k[(1, 2)]),
            (10000.0, 2000.0, 1500.0)
        );
    }

    #[test]
    fn refusals_name_the_line() {
        let message = |text: &str| {
            read(("c", CAMERA), ("e.ori", text), &mut Vec::new())
                .unwrap_err()
                .to_string()
        };
        assert!(message("1 2 3 4\n1 0 0 0 1\n").contains("ends in the middle"));
        assert!(message("1 2 3 4\n1 0 0 0 1\n0 0 1\n").contains("line 3: 3 fields"));
        assert!(message("1 2 3\n1 0 0 0 1\n0 0 0 1\n").contains("line 1: 3 fields"));
    }
}
