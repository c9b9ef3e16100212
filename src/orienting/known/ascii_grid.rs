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

use std::collections::BTreeMap;
use std::iter::Peekable;

use super::height_grid::{HeightGrid, Placement, StoredHeights};
use super::refusal::refusal;
use super::system::Way;
use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;

/// What a header may state, by its name in small letters.
const NAMES: [&str; 10] = [
    "ncols",
    "nrows",
    "xllcorner",
    "xllcenter",
    "yllcorner",
    "yllcenter",
    "cellsize",
    "dx",
    "dy",
    "nodata_value",
];

pub(super) fn read(file: &InputFile, way: Way) -> Result<HeightGrid> {
    let text = file.text();
    let text = match text.contains(',') && !text.contains('.') {
        true => text.replace(',', "."),
        false => text.into_owned(),
    };
    let mut lines = text.lines().enumerate().peekable();
    let header = read_header(file, &mut lines)?;
    let stated = |name: &str| header.get(name).copied();
    let number = |name: &str| {
        stated(name).ok_or_else(|| {
            let problem = format!("the header states no {name}");
            refuse(file, 1, problem, "the header of an ASCII grid")
        })
    };
    let count = |name: &str| {
        let count = number(name)?;
        let is_count = (2.0..1e6).contains(&count) && count.fract() == 0.0;
        let problem = || format!("{name} is {count}");
        is_count
            .then_some(count as usize)
            .ok_or_else(|| refuse(file, 1, problem(), "a whole number from 2"))
    };
    let (columns, rows) = (count("ncols")?, count("nrows")?);
    let cell = |own: &str| stated(own).map_or_else(|| number("cellsize"), Ok);
    let cell = [cell("dx")?, cell("dy")?];
    let center = |center: &str, corner: &str, cell: f64| match stated(center) {
        Some(at) => Ok(at),
        None => number(corner).map(|at| at + 0.5 * cell),
    };
    let west = center("xllcenter", "xllcorner", cell[0])?;
    let south = center("yllcenter", "yllcorner", cell[1])?;
    let heights = read_heights(file, lines, [columns, rows], text.lines().count())?;
    let first = [west, south + (rows - 1) as f64 * cell[1]];
    // Heights are read as they are written: the value that stands for none as well.
    let no_data = stated("nodata_value").unwrap_or(-9999.0) as f32;
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
) -> Result<BTreeMap<String, f64>> {
    let mut header = BTreeMap::new();
    while let Some((i, line)) = lines.peek().copied() {
        let mut words = line.split_whitespace();
        let Some(name) = words.next() else {
            lines.next();
            continue;
        };
        let known = name.to_ascii_lowercase();
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || known.starts_with("nan") {
            break;
        }
        let value = words.next().and_then(|word| word.parse().ok());
        let value: f64 = value.ok_or_else(|| {
            let problem = format!("'{name}' has no number");
            refuse(file, i + 1, problem, "a name and a number")
        })?;
        if !NAMES.contains(&&*known) {
            let problem = format!("'{name}' is no part of the header");
            let expected = "ncols, nrows, xllcorner, yllcorner, cellsize or NODATA_value";
            return Err(refuse(file, i + 1, problem, expected));
        }
        header.insert(known, value);
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
            // As the runtime of Microsoft's compilers writes what is no number.
            let is_none = word.contains('#') || word.to_ascii_lowercase().contains("nan");
            let z = if is_none { Ok(f32::NAN) } else { word.parse() };
            let z = z.map_err(|_| {
                let word: String = word.chars().take(20).collect();
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
