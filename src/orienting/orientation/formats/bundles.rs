//! Bundler's `bundle.out` with its list of images, and VisualSFM's `.nvm`.
//!
//! Both know one focal length and no principal point: it lies at the centre of the image.
//!
//! * Bundler: R and t are `cam_from_world` of a camera that looks down its -z axis with y up: p =
//!   -P / P.z; the lens takes p to f (1 + k1 |p|^2 + k2 |p|^4) p. Cameras with f = 0 were not
//!   oriented. An extra file of principal points (`image cx cy width height`) is read where it is
//!   there.
//! * NVM: quaternion (w x y z) of `cam_from_world`, y down, and the projection centre; its k leads
//!   from measured to ideal coordinates, so the series of the inverse is used. `FixedK` in its
//!   first line states a principal point and two focal lengths.

use nalgebra::{Matrix3, Point3, Vector3};

use super::colmap::rotation_of_quaternion;
use super::text::{TextLine, data_lines, ends_early, is_number, quoted};
use crate::base::error::{Error, Result, listed};
use crate::orienting::orientation::angles::{Y_UP, without_rounding};
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::photographs::camera::Distortion;

/// Reads Bundler's cameras; `list` names their images, `points` their principal points.
pub(crate) fn read_bundler(
    (path, text): (&str, &str),
    (list_path, list): (&str, &str),
    points: Option<(&str, &str)>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Orientation>> {
    let mut lines = data_lines(path, text);
    let count = header(path, lines.next())?;
    let names: Vec<&str> = data_lines(list_path, list)
        .map(|line| listed_image(line.text).unwrap_or_else(|| line.fields()[0]))
        .collect();
    if names.len() != count {
        return Err(Error::file(
            list_path,
            format!(
                "it names {} images, but {path} has {count} cameras",
                names.len()
            ),
            "use the list that belongs to it",
        ));
    }
    let mut found = Vec::new();
    for name in names {
        let (source, rows) = rows(path, &mut lines)?;
        let [f, k1, k2] = rows[0];
        if f == 0.0 {
            continue;
        }
        let r = without_rounding(&(Y_UP * Matrix3::from_fn(|i, j| rows[i + 1][j])));
        let t = Y_UP * Vector3::from(rows[4]);
        let k = Matrix3::from_diagonal(&Vector3::new(f, f, 1.0));
        found.push(Orientation {
            distortion: Distortion::brown([k1, k2, 0.0], [0.0, 0.0]),
            from_middle: true,
            ..pinhole(name, &source, k, r, Point3::from(-(r.transpose() * t)))
        });
    }
    if let Some((path, text)) = points {
        add_principal_points(path, text, &mut found)?;
        let without: Vec<&str> = (found.iter().filter(|o| o.from_middle))
            .map(|o| &*o.image)
            .collect();
        if !without.is_empty() {
            warnings.push(format!(
                "{path} states no principal point for {}: it is taken to be in the middle",
                listed(&without)
            ));
        }
    }
    Ok(found)
}

/// The image of a line of Bundler's list, whose name may hold blanks; up to two numbers follow it
/// (zero and a focal length). `None` where the line ends otherwise.
pub(crate) fn listed_image(text: &str) -> Option<&str> {
    text.match_indices('.').rev().find_map(|(dot, _)| {
        let behind = &text[dot + 1..];
        let end = behind
            .find(|c: char| !c.is_ascii_alphanumeric())
            .unwrap_or(behind.len());
        let extension = behind[..end].to_ascii_lowercase();
        let numbers = behind[end..].strip_prefix('"').unwrap_or(&behind[end..]);
        let is_image = ["jpg", "jpeg", "png", "tif", "tiff"].contains(&&*extension)
            && numbers.split_whitespace().count() <= 2
            && numbers.split_whitespace().all(is_number)
            && (numbers.is_empty() || numbers.starts_with(char::is_whitespace));
        is_image.then(|| text[..dot + 1 + end].trim_start_matches('"'))
    })
}

/// Reads the first model of an `.nvm` file.
pub(crate) fn read_nvm(path: &str, text: &str) -> Result<Vec<Orientation>> {
    let mut lines = data_lines(path, text).peekable();
    let fixed = match lines.next_if(|l| l.text.starts_with("NVM_V3")) {
        Some(line) => fixed_calibration(&line)?,
        None => None,
    };
    let count = header(path, lines.next())?;
    let camera = |line: TextLine| {
        let fields = line.fields();
        // The name may hold blanks; the final zero is missing in some files.
        let has_zero = fields.len() > 10 && is_zero(fields[fields.len() - 1]);
        let behind = if has_zero && is_number(fields[fields.len() - 10]) {
            10
        } else {
            9
        };
        let Some(first) = fields.len().checked_sub(behind).filter(|&n| n > 0) else {
            return Err(line.miscounted(fields.len(), "name f qw qx qy qz cx cy cz k 0"));
        };
        let name = nvm_name(&line, &fields[..first]);
        let v = line.numbers(&fields[first..first + 9], "a camera's number")?;
        let r = rotation_of_quaternion(&line, &v[1..5])?;
        let k = fixed.unwrap_or_else(|| Matrix3::from_diagonal(&Vector3::new(v[0], v[0], 1.0)));
        Ok(Orientation {
            distortion: inverse_of_cubic(v[8]),
            from_middle: fixed.is_none(),
            ..pinhole(&name, &line.place(), k, r, Point3::new(v[5], v[6], v[7]))
        })
    };
    let found: Vec<Orientation> = lines.take(count).map(camera).collect::<Result<_>>()?;
    if found.len() < count {
        return Err(too_short(path));
    }
    Ok(found)
}

/// The calibration that was fixed for all images, behind the version: `FixedK fx cx fy cy`.
fn fixed_calibration(line: &TextLine) -> Result<Option<Matrix3<f64>>> {
    let fields = line.fields();
    if fields[0] != "NVM_V3" {
        return Err(line.error(
            format!("the version is {}", quoted(fields[0])),
            "NVM_V3, with quaternions",
        ));
    }
    let numbers = match fields[1..] {
        [] => return Ok(None),
        ["FixedK", ref numbers @ ..] if (4..=5).contains(&numbers.len()) => numbers,
        _ => return Err(line.miscounted(fields.len(), "NVM_V3, or NVM_V3 FixedK fx cx fy cy")),
    };
    let v = line.numbers(numbers, "a number of the calibration")?;
    if v.get(4).is_some_and(|&k| k != 0.0) {
        return Err(line.error(
            "the fixed calibration has a distortion of its own",
            "none: undistort the images",
        ));
    }
    Ok(Some(Matrix3::new(
        v[0], 0.0, v[1], 0.0, v[2], v[3], 0.0, 0.0, 1.0,
    )))
}

/// The name in front of the numbers. VisualSFM writes a quotation mark for each blank, other
/// programs set the name between two of them, or leave the blanks.
fn nvm_name(line: &TextLine, fields: &[&str]) -> String {
    let name = line.up_to(fields[fields.len() - 1]);
    let inside = name.strip_prefix('"').and_then(|n| n.strip_suffix('"'));
    inside.unwrap_or(name).replace('"', " ")
}

fn is_zero(field: &str) -> bool {
    field.parse::<f64>() == Ok(0.0)
}

/// The lens for which `ideal = measured (1 + k |measured|^2)`: the series of its inverse.
fn inverse_of_cubic(k: f64) -> Option<Distortion> {
    // C(3 n, n) / (2 n + 1).
    let terms = [
        1.0, 3.0, 12.0, 55.0, 273.0, 1428.0, 7752.0, 43263.0, 246675.0, 1430715.0,
    ];
    let mut power = 1.0;
    let radial = terms.map(|term| {
        power *= -k;
        term * power
    });
    Distortion::brown(radial, [0.0, 0.0])
}

/// The number of cameras, the first field of a line.
fn header(path: &str, line: Option<TextLine>) -> Result<usize> {
    let line = line.ok_or_else(|| too_short(path))?;
    let count = line.whole(line.fields()[0], "the number of cameras")?;
    Ok(count as usize)
}

/// The five lines of a camera: f k1 k2, three rows of R, t; and their line.
fn rows<'a>(
    path: &str,
    lines: &mut impl Iterator<Item = TextLine<'a>>,
) -> Result<(String, [[f64; 3]; 5])> {
    let mut rows = [[0.0; 3]; 5];
    let mut source = String::new();
    for (i, row) in rows.iter_mut().enumerate() {
        let line = lines.next().ok_or_else(|| too_short(path))?;
        let fields = line.fields();
        if fields.len() != 3 {
            return Err(line.miscounted(fields.len(), "three numbers"));
        }
        let v = line.numbers(&fields, "a camera's number")?;
        *row = [v[0], v[1], v[2]];
        if i == 0 {
            source = line.place();
        }
    }
    Ok((source, rows))
}

fn add_principal_points(path: &str, text: &str, found: &mut [Orientation]) -> Result<()> {
    for line in data_lines(path, text) {
        let fields = line.fields();
        // The name may hold blanks: two numbers follow it, or four.
        let last = fields[1..].iter().rev().take(4);
        let numbers = last.take_while(|field| is_number(field));
        let first = fields.len() - if numbers.count() == 4 { 4 } else { 2 }.min(fields.len());
        if first == 0 {
            return Err(line.miscounted(fields.len(), "image cx cy width height"));
        }
        let v = line.numbers(&fields[first..first + 2], "a coordinate")?;
        let name = fields[..first].join(" ");
        let named = |o: &&mut Orientation| o.image.rsplit('/').next() == Some(&name);
        if let Some(o) = found.iter_mut().find(named) {
            (o.k[(0, 2)], o.k[(1, 2)]) = (v[0], v[1]);
            o.from_middle = false;
            if let [w, h] = fields[first + 2..] {
                o.size = Some((line.whole(w, "the width")?, line.whole(h, "the height")?));
            }
        }
    }
    Ok(())
}

fn too_short(path: &str) -> Error {
    ends_early(path, "it ends before its last camera")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nvm(first: &str, k: f64) -> Result<Vec<Orientation>> {
        read_nvm(
            "a.nvm",
            &format!("{first}\n\n1\na.jpg 1000 1 0 0 0 1 2 3 {k} 0\n\n0\n"),
        )
    }

    #[test]
    fn a_fixed_calibration_is_used() {
        let found = &nvm("NVM_V3 FixedK 1000 640.5 1010 470", 0.0).unwrap()[0];
        let k = Matrix3::new(1000.0, 0.0, 640.5, 0.0, 1010.0, 470.0, 0.0, 0.0, 1.0);
        assert_eq!((found.k, found.from_middle), (k, false));
        assert!(nvm("NVM_V3", 0.0).unwrap()[0].from_middle);
        let refusal = nvm("NVM_V3 FixedK 1000 640.5", 0.0)
            .unwrap_err()
            .to_string();
        assert!(refusal.starts_with("a.nvm, line 1: 4 fields"), "{refusal}");
    }

    #[test]
    fn the_lens_of_visual_sfm_is_inverted() {
        for k in [-0.1, 0.08] {
            let lens = nvm("NVM_V3", k).unwrap()[0].distortion.unwrap();
            for measured in [
                nalgebra::Point2::new(0.3, -0.2),
                nalgebra::Point2::new(-0.5, 0.6),
            ] {
                let ideal = measured * (1.0 + k * measured.coords.norm_squared());
                // A hundredth of a pixel at a focal length of 1000 px.
                assert!((lens.distort(&ideal) - measured).norm() < 1e-5);
            }
        }
    }
}
