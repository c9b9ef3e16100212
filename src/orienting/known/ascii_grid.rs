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
use super::system::Way;
use crate::base::error::{Error, Result};
use crate::orienting::orientation::{InputFile, TextLine, lines};

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
    let refuse = |line: usize, problem: String, expected: &str| {
        Error::line(&file.path, line, problem, expected)
    };
    let mut lines = lines(&file.path, &text).peekable();
    let header = read_header(&mut lines)?;
    let stated = |name: &str| header.get(name).copied();
    let number = |name: &str| {
        stated(name).ok_or_else(|| {
            let problem = format!("the header states no {name}");
            refuse(1, problem, "the header of an ASCII grid")
        })
    };
    let count = |name: &str| {
        let count = number(name)?;
        let is_count = (2.0..1e6).contains(&count) && count.fract() == 0.0;
        let wrong = || refuse(1, format!("{name} is {count}"), "a whole number from 2");
        is_count.then_some(count as usize).ok_or_else(wrong)
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
    let heights = read_heights(lines, [columns, rows])?;
    let wanted = columns * rows;
    if heights.len() < wanted {
        let problem = format!("the file ends after {} of {wanted} heights", heights.len());
        return Err(refuse(text.lines().count(), problem, EVERY_CELL));
    }
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
    .map_err(|problem| Error::file(&file.path, problem, "give heights of the ground"))
}

/// Takes the lines of the header, and blank ones before and after it.
fn read_header<'a>(
    lines: &mut Peekable<impl Iterator<Item = TextLine<'a>>>,
) -> Result<BTreeMap<String, f64>> {
    let mut header = BTreeMap::new();
    while let Some(line) = lines.peek().copied() {
        let mut words = line.text.split_whitespace();
        let Some(name) = words.next() else {
            lines.next();
            continue;
        };
        let known = name.to_ascii_lowercase();
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || known.starts_with("nan") {
            break;
        }
        let value = words.next().and_then(|word| word.parse().ok());
        let value: f64 = value
            .ok_or_else(|| line.error(format!("'{name}' has no number"), "a name and a number"))?;
        if !NAMES.contains(&&*known) {
            let problem = format!("'{name}' is no part of the header");
            let expected = "ncols, nrows, xllcorner, yllcorner, cellsize or NODATA_value";
            return Err(line.error(problem, expected));
        }
        header.insert(known, value);
        lines.next();
    }
    Ok(header)
}

/// What a grid has to hold.
const EVERY_CELL: &str = "one height for every cell";

/// The heights of the lines below the header, no more than there are cells.
fn read_heights<'a>(
    lines: impl Iterator<Item = TextLine<'a>>,
    [columns, rows]: [usize; 2],
) -> Result<Vec<f32>> {
    let mut heights: Vec<f32> = Vec::new();
    for line in lines {
        for word in line.text.split_whitespace() {
            // As the runtime of Microsoft's compilers writes what is no number.
            let is_none = word.contains('#') || word.to_ascii_lowercase().contains("nan");
            let z = if is_none { Ok(f32::NAN) } else { word.parse() };
            let z = z.map_err(|_| {
                let word: String = word.chars().take(20).collect();
                line.error(
                    format!("'{word}' is no number"),
                    "heights with a decimal point",
                )
            })?;
            if heights.len() == columns * rows {
                let problem = format!("there are more than {columns} x {rows} heights");
                return Err(line.error(problem, EVERY_CELL));
            }
            heights.push(z);
        }
    }
    Ok(heights)
}
