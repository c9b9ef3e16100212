//! Bundler's `bundle.out` with its list of images, and VisualSFM's `.nvm`.
//!
//! Both know one focal length and no principal point: it lies at the centre of the image.
//!
//! * Bundler: R and t are `cam_from_world` of a camera that looks down its -z axis with y up: p =
//!   -P / P.z; the lens takes p to f (1 + k1 |p|^2 + k2 |p|^4) p. Cameras with f = 0 were not
//!   oriented. An extra file of principal points (`image cx cy width height`) is read where it is
//!   there.
//! * NVM: quaternion (w x y z) of `cam_from_world`, y down, and the projection centre; its k leads
//!   from measured to ideal coordinates, so the series of the inverse is used.

use nalgebra::{Matrix3, Point3, Quaternion, UnitQuaternion, Vector3};

use super::left_out::few;
use super::text::{TextLine, data_lines};
use crate::camera::Distortion;
use crate::error::{Error, Result};
use crate::orientation::image_orientation::{Orientation, pinhole};

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
        .map(|l| l.text.split_whitespace().next().unwrap_or_default())
        .collect();
    if names.len() != count {
        return Err(Error::File {
            file: list_path.to_owned(),
            problem: format!(
                "it names {} images, but {path} has {count} cameras",
                names.len()
            ),
            advice: "use the list that belongs to it".to_owned(),
        });
    }
    let mut found = Vec::new();
    for name in names {
        let (source, rows) = rows(path, &mut lines)?;
        let [f, k1, k2] = rows[0];
        if f == 0.0 {
            continue;
        }
        let axes = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        let r = axes * Matrix3::from_fn(|i, j| rows[i + 1][j]);
        let t = axes * Vector3::from(rows[4]);
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
                few(&without)
            ));
        }
    }
    Ok(found)
}

/// Reads the first model of an `.nvm` file.
pub(crate) fn read_nvm(path: &str, text: &str) -> Result<Vec<Orientation>> {
    let mut lines = data_lines(path, text).skip_while(|l| l.text.starts_with("NVM_V3"));
    let count = header(path, lines.next())?;
    let camera = |line: TextLine| {
        let fields = line.fields();
        if fields.len() < 10 {
            return Err(line.error(
                format!("{} fields", fields.len()),
                "name f qw qx qy qz cx cy cz k 0",
            ));
        }
        let v = line.numbers(&fields[1..10], "a camera's number")?;
        let q = Quaternion::new(v[1], v[2], v[3], v[4]);
        if (q.norm() - 1.0).abs() > 1e-3 {
            return Err(line.error(
                format!("the quaternion has length {:.4}", q.norm()),
                "a quaternion of length 1",
            ));
        }
        let r = UnitQuaternion::from_quaternion(q)
            .to_rotation_matrix()
            .into_inner();
        let k = v[8];
        Ok(Orientation {
            distortion: Distortion::brown(
                [-k, 3.0 * k * k, -12.0 * k * k * k, 55.0 * k * k * k * k],
                [0.0, 0.0],
            ),
            from_middle: true,
            ..pinhole(
                fields[0],
                &format!("{path}, line {}", line.number),
                Matrix3::from_diagonal(&Vector3::new(v[0], v[0], 1.0)),
                r,
                Point3::new(v[5], v[6], v[7]),
            )
        })
    };
    let found: Vec<Orientation> = lines.take(count).map(camera).collect::<Result<_>>()?;
    if found.len() < count {
        return Err(too_short(path));
    }
    Ok(found)
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
            return Err(line.error(format!("{} fields", fields.len()), "three numbers"));
        }
        let v = line.numbers(&fields, "a camera's number")?;
        *row = [v[0], v[1], v[2]];
        if i == 0 {
            source = format!("{path}, line {}", line.number);
        }
    }
    Ok((source, rows))
}

fn add_principal_points(path: &str, text: &str, found: &mut [Orientation]) -> Result<()> {
    for line in data_lines(path, text) {
        let fields = line.fields();
        if fields.len() < 3 {
            return Err(line.error(
                format!("{} fields", fields.len()),
                "image cx cy width height",
            ));
        }
        let v = line.numbers(&fields[1..3], "a coordinate")?;
        let named = |o: &&mut Orientation| o.image.rsplit('/').next() == Some(fields[0]);
        if let Some(o) = found.iter_mut().find(named) {
            (o.k[(0, 2)], o.k[(1, 2)]) = (v[0], v[1]);
            o.from_middle = false;
            if let [w, h] = fields[3..] {
                o.size = Some((line.whole(w, "the width")?, line.whole(h, "the height")?));
            }
        }
    }
    Ok(())
}

fn too_short(path: &str) -> Error {
    Error::File {
        file: path.to_owned(),
        problem: "it ends before its last camera".to_owned(),
        advice: "export or copy it again".to_owned(),
    }
}
