//! ASCII grid of ESRI: a header of names and numbers, then the heights row by row from the north.
//!
//! ```text
//! ncols 200            nrows 100
//! xllcorner 432000     yllcorner 5412000      or xllcenter, yllcenter
//! cellsize 1           or dx, dy              NODATA_value -9999   (may be missing)
//! 147.1 147.2 ...
//! ```
//!
//! Of numbers "1,5" is one where no number of the file has a point.

use std::iter::Peekable;

use super::height_grid::{HeightGrid, Placement, StoredHeights};
use super::refusal::refusal;
use super::system::Way;
use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;

/// Does a file begin as such a grid does?
pub(super) fn is_ascii_grid(file: &InputFile) -> bool {
    let head = file.start_as_text(64);
    let text = head.unwrap_or_default();
    let text = text.trim_start_matches('\u{feff}').trim_start();
    text.get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case("ncols"))
}

/// What the header states.
#[derive(Default)]
struct Header {
    columns: Option<f64>,
    rows: Option<f64>,
    /// West and south, and whether of the centre of a cell rather than its corner.
    x: Option<(f64, bool)>,
    y: Option<(f64, bool)>,
    cell: [Option<f64>; 2],
    no_data: Option<f64>,
}

impl Header {
    /// Takes an entry; `None` where it is of no header.
    fn take(&mut self, name: &str, value: f64) -> Option<()> {
        match name.to_ascii_lowercase().as_str() {
            "ncols" => self.columns = Some(value),
            "nrows" => self.rows = Some(value),
            "xllcorner" => self.x = Some((value, false)),
            "xllcenter" => self.x = Some((value, true)),
            "yllcorner" => self.y = Some((value, false)),
            "yllcenter" => self.y = Some((value, true)),
            "cellsize" => self.cell = [Some(value); 2],
            "dx" => self.cell[0] = Some(value),
            "dy" => self.cell[1] = Some(value),
            "nodata_value" => self.no_data = Some(value),
            _ => return None,
        }
        Some(())
    }
}

pub(super) fn read(file: &InputFile, way: Way) -> Result<HeightGrid> {
    let text = file.text();
    let text = text.trim_start_matches('\u{feff}');
    let text = match text.contains(',') && !text.contains('.') {
        true => text.replace(',', "."),
        false => text.to_owned(),
    };
    let mut lines = text.lines().enumerate().peekable();
    let header = read_header(file, &mut lines)?;
    let missing = |name: &str| {
        let problem = format!("the header states no {name}");
        refuse(file, 1, problem, "the header of an ASCII grid")
    };
    let count = |stated: Option<f64>, name: &str| {
        let count = stated.ok_or_else(|| missing(name))?;
        let is_count = (2.0..1e6).contains(&count) && count.fract() == 0.0;
        let problem = || format!("{name} is {count}");
        is_count
            .then_some(count as usize)
            .ok_or_else(|| refuse(file, 1, problem(), "a whole number from 2"))
    };
    let (columns, rows) = (
        count(header.columns, "ncols")?,
        count(header.rows, "nrows")?,
    );
    let cell = [
        header.cell[0].ok_or_else(|| missing("cellsize"))?,
        header.cell[1].ok_or_else(|| missing("cellsize"))?,
    ];
    let (x, x_is_center) = header.x.ok_or_else(|| missing("xllcorner"))?;
    let (y, y_is_center) = header.y.ok_or_else(|| missing("yllcorner"))?;
    let heights = read_heights(file, lines, [columns, rows], text.lines().count())?;
    let corner =
        |at: f64, is_center: bool, cell: f64| at + if is_center { 0.0 } else { 0.5 * cell };
    let first = [
        corner(x, x_is_center, cell[0]),
        corner(y, y_is_center, cell[1]) + (rows - 1) as f64 * cell[1],
    ];
    // Heights are read as they are written: the value that stands for none as well.
    let no_data = header.no_data.unwrap_or(-9999.0) as f32;
    let place = Placement {
        first,
        cell,
        columns,
        rows,
    };
    HeightGrid::new(
        place,
        StoredHeights::as_they_are(heights, Some(no_data)),
        way,
    )
    .map_err(|problem| refusal(&file.path, &problem, "give heights of the ground"))
}

fn refuse(file: &InputFile, line: usize, problem: String, expected: &str) -> Error {
    Error::Line {
        file: file.path.clone(),
        line,
        problem,
        expected: expected.to_owned(),
    }
}

/// Takes the lines of the header, and blank ones before and after it.
fn read_header<'a>(
    file: &InputFile,
    lines: &mut Peekable<impl Iterator<Item = (usize, &'a str)>>,
) -> Result<Header> {
    let mut header = Header::default();
    while let Some((i, line)) = lines.peek().copied() {
        let mut words = line.split_whitespace();
        let Some(name) = words.next() else {
            lines.next();
            continue;
        };
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || name.eq_ignore_ascii_case("nan")
        {
            break;
        }
        let value = words.next().and_then(|word| word.parse().ok());
        let value: f64 = value.ok_or_else(|| {
            let problem = format!("'{name}' has no number");
            refuse(file, i + 1, problem, "a name and a number")
        })?;
        header.take(name, value).ok_or_else(|| {
            let problem = format!("'{name}' is no part of the header");
            let expected = "ncols, nrows, xllcorner, yllcorner, cellsize or NODATA_value";
            refuse(file, i + 1, problem, expected)
        })?;
        lines.next();
    }
    Ok(header)
}

/// One height for every cell, of the lines below the header; `last` is the number of the last one.
fn read_heights<'a>(
    file: &InputFile,
    lines: impl Iterator<Item = (usize, &'a str)>,
    [columns, rows]: [usize; 2],
    last: usize,
) -> Result<Vec<f32>> {
    let wanted = columns * rows;
    let expected = "one height for every cell";
    let mut heights: Vec<f32> = Vec::new();
    for (i, line) in lines {
        for word in line.split_whitespace() {
            let z = word.parse().map_err(|_| {
                let problem = format!("'{word}' is no number");
                refuse(file, i + 1, problem, "heights with a decimal point")
            })?;
            if heights.len() == wanted {
                let problem = format!("there are more than {columns} x {rows} heights");
                return Err(refuse(file, i + 1, problem, expected));
            }
            heights.push(z);
        }
    }
    if heights.len() < wanted {
        let problem = format!("the file ends after {} of {wanted} heights", heights.len());
        return Err(refuse(file, last, problem, expected));
    }
    Ok(heights)
}
