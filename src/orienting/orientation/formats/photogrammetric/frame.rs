//! Interior orientation of a photogrammetric camera: keys and values, millimetres, crops.

use std::collections::BTreeMap;

use nalgebra::Matrix3;

use crate::base::error::{Error, Result};
use crate::orienting::orientation::formats::text::{TextLine, data_lines, quoted};
use crate::orienting::orientation::image_orientation::Crop;
use crate::orienting::orientation::input_file::stem;

/// Part of the frame that a view shows, pixels.
#[derive(Clone, Copy)]
pub(crate) struct FramePart {
    column: f64,
    row: f64,
    pub size: (u32, u32),
}

/// Interior orientation of the full frame.
pub(crate) struct CameraFrame {
    /// Principal distance in pixels along x and y.
    focal_px: [f64; 2],
    /// Principal point in the frame, pixels.
    principal_px: [f64; 2],
    whole: FramePart,
    crops: BTreeMap<String, FramePart>,
}

impl CameraFrame {
    /// The part that an image shows: its name in the camera file may have another extension, or
    /// none.
    pub(crate) fn part_of(&self, image: &str) -> &FramePart {
        let alike = || (self.crops.iter()).find(|(name, _)| stem(name) == stem(image));
        let named = self.crops.get(image);
        named.or_else(|| Some(alike()?.1)).unwrap_or(&self.whole)
    }

    /// Calibration of a part, pixels.
    pub(crate) fn k(&self, part: &FramePart) -> Matrix3<f64> {
        let ([fx, fy], [cx, cy]) = (self.focal_px, self.principal_px);
        let (cx, cy) = (cx - part.column, cy - part.row);
        Matrix3::new(fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0)
    }

    /// Where a part lies in the frame.
    pub(crate) fn crop(&self, part: &FramePart) -> Crop {
        Crop {
            column: part.column,
            row: part.row,
            frame: [self.whole.size.0, self.whole.size.1].map(f64::from),
        }
    }
}

/// The keys of a camera file that occur once, with the number of values that they may have.
const KEYS: [(&str, std::ops::RangeInclusive<usize>); 4] = [
    ("principal_distance_mm", 1..=1),
    ("principal_point_mm", 2..=2),
    ("pixel_size_mm", 1..=2),
    ("image_size_px", 2..=2),
];

pub(crate) fn read_frame(
    file: &str,
    text: &str,
    warnings: &mut Vec<String>,
) -> Result<CameraFrame> {
    let mut values: [Option<(TextLine, Vec<f64>)>; 4] = [const { None }; 4];
    let mut crops = BTreeMap::new();
    for line in data_lines(file, text) {
        let fields = line.fields();
        if fields[0] == "crop" {
            let (name, crop) = read_crop(&line, &fields)?;
            if crops.insert(name, crop).is_some() {
                return Err(line.error("this image has two crop lines", "one crop line per image"));
            }
        } else if let Some(i) = KEYS.iter().position(|(key, _)| *key == fields[0]) {
            values[i] = Some((line, read_values(&line, &fields, &KEYS[i].1)?));
        } else {
            warnings.push(format!(
                "{}: {} is not a known key and was ignored",
                line.place(),
                quoted(fields[0])
            ));
        }
    }
    let require = |i: usize| {
        let key = KEYS[i].0;
        values[i].as_ref().ok_or_else(|| {
            let advice = format!("add a line `{key} ...`");
            Error::file(file, format!("the key {key} is missing"), advice)
        })
    };
    let (distance, pixel, size) = (require(0)?, require(2)?, require(3)?);
    for (line, numbers) in [distance, pixel, size] {
        if numbers.iter().any(|&v| v <= 0.0) {
            return Err(line.error("a value is not positive", "positive lengths"));
        }
    }
    let point = values[1].as_ref().map_or([0.0, 0.0], |(_, v)| [v[0], v[1]]);
    let pixel = [pixel.1[0], *pixel.1.last().expect("one value or two")];
    let (width, height) = (size.1[0], size.1[1]);
    let whole = (whole_px(&size.0, width)?, whole_px(&size.0, height)?);
    Ok(CameraFrame {
        focal_px: [distance.1[0] / pixel[0], distance.1[0] / pixel[1]],
        principal_px: [
            width / 2.0 + point[0] / pixel[0],
            height / 2.0 - point[1] / pixel[1],
        ],
        whole: FramePart {
            column: 0.0,
            row: 0.0,
            size: whole,
        },
        crops,
    })
}

fn read_values(
    line: &TextLine,
    fields: &[&str],
    count: &std::ops::RangeInclusive<usize>,
) -> Result<Vec<f64>> {
    if !count.contains(&(fields.len() - 1)) {
        let problem = format!("{} has {} values", fields[0], fields.len() - 1);
        let values = if *count.end() == 1 { "value" } else { "values" };
        return Err(line.error(problem, format!("{} {values}", count.end())));
    }
    line.numbers(&fields[1..], fields[0])
}

fn whole_px(line: &TextLine, value: f64) -> Result<u32> {
    if value.fract() == 0.0 && (1.0..=4e9).contains(&value) {
        Ok(value as u32)
    } else {
        Err(line.error(format!("a size of {value}"), "whole pixels"))
    }
}

/// The name may hold blanks: the four numbers stand at the end.
fn read_crop(line: &TextLine, fields: &[&str]) -> Result<(String, FramePart)> {
    let [_, first, others @ .., column, row, width, height] = fields else {
        return Err(line.miscounted(fields.len(), "crop NAME column row width height"));
    };
    let name = [&[*first], others].concat().join(" ");
    let crop = FramePart {
        column: line.number(column, "the column")?,
        row: line.number(row, "the row")?,
        size: (
            line.whole(width, "the width")?,
            line.whole(height, "the height")?,
        ),
    };
    Ok((name.trim_matches('"').to_owned(), crop))
}
