//! Point clouds: the points that a LAS or LAZ file classifies as ground, on a grid; and those that
//! may lie on roofs.
//!
//! ```text
//! header        what a LAS file states of itself: format, place, number of points, system
//! compressed    records of a LAZ file, decompressed by crate `laz`
//! ground        points of the ground on a grid: a plane through the points around each cell
//! thinned       points of roofs and the ground around a scene, as many as are of use
//! ```
//!
//! LAS 1.0 to 1.4 (ASPRS), point formats 0 to 10. Without points that are classified as ground a
//! cloud is refused as terrain: the lowest points of a cell are those of a roof where it is wider
//! than the cell.

mod compressed;
mod ground;
mod header;
#[cfg(test)]
mod tests;
mod thinned;

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};

use self::compressed::Compressed;
use self::ground::GroundPoints;
use self::header::Header;
use self::thinned::Thinned;
use super::height_grid::HeightGrid;
use super::system::{Way, WorldSystem};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;

/// Most points that are read. Assumption: a tile of a square kilometre with a hundred a square
/// metre.
const MOST_POINTS: u64 = 100_000_000;

/// Most points that a byte may hold. Assumption: LASzip takes two to six bytes for a point, and
/// some hundredths of one where every point is as the one before.
const MOST_A_BYTE: u64 = 32;

/// Classes that lie on the terrain: ground, key points of its model, and water.
const GROUND: u8 = 2;
const KEY_POINT: u8 = 8;
const WATER: u8 = 9;

/// Classes that lie neither on roofs nor on the ground: low, medium and high vegetation, noise,
/// wires and their towers, and high noise.
const NO_SURFACE: [u8; 9] = [3, 4, 5, 7, 13, 14, 15, 16, 18];

/// The points of the ground on a grid.
pub(super) fn read(file: &InputFile, system: &WorldSystem) -> Result<HeightGrid> {
    let refuse = |problem: &str, advice: &str| Error::file(&file.path, problem, advice);
    let mut points = GroundPoints::new();
    let mut others: BTreeMap<u8, u64> = BTreeMap::new();
    let count = each_point(file, system, &mut |header, way, record| {
        let [class, withheld] = header.class_of(record);
        let is_ground = match class {
            GROUND | WATER => true,
            // Formats from 6 on have a flag for key points; 8 is reserved there.
            KEY_POINT => header.format < 6,
            _ => false,
        };
        match is_ground {
            _ if withheld == 1 => {}
            true => {
                if let Some(position) = way.world_in_space(header.position(record)) {
                    points.push(position);
                }
            }
            false => *others.entry(class).or_default() += 1,
        }
    })?;
    if points.is_empty() {
        let problem = format!(
            "none of its {count} points is classified as ground (class 2){}",
            listed(&others)
        );
        let advice = "classify its ground first, as with the filter smrf of pdal, or give a grid";
        return Err(refuse(&problem, advice));
    }
    points
        .grid()
        .map_err(|problem| refuse(&problem, "give points of the ground, in metres"))
}

/// The points that may lie on roofs or on the ground, in the local frame of a scene with this
/// origin, thinned: not those of vegetation and noise, nor those outside of the box in plan.
pub(super) fn read_surface(
    file: &InputFile,
    system: &WorldSystem,
    origin: Vector3<f64>,
    within: Option<[f64; 4]>,
) -> Result<Vec<Point3<f32>>> {
    let mut points = Thinned::new(within);
    each_point(file, system, &mut |header, way, record| {
        let [class, withheld] = header.class_of(record);
        if withheld == 0
            && !NO_SURFACE.contains(&class)
            && let Some(position) = way.world_in_space(header.position(record))
        {
            points.push(Vector3::from(position) - origin);
        }
    })?;
    Ok(points.finished())
}

const COPY_AGAIN: &str = "copy the file again, or export it again";

/// Hands over every record of a file; returns how many there are.
fn each_point(
    file: &InputFile,
    system: &WorldSystem,
    take: &mut dyn FnMut(&Header, &Way, &[u8]),
) -> Result<u64> {
    let damaged = |problem: String| Error::file(&file.path, problem, COPY_AGAIN);
    let bytes = &file.bytes[..];
    let (header, way) = header_of(file, system)?;
    let records = header.records(bytes);
    let mut is_first = true;
    let mut placed = |record: &[u8]| {
        let is_place = !is_first || way.world_in_space(header.position(record)).is_some();
        is_first = false;
        let problem = "its points are no places in longitude and latitude, which it states";
        is_place
            .then_some(())
            .ok_or_else(|| damaged(problem.to_owned()))
    };
    match header.is_compressed {
        false => {
            let length = usize::from(header.record_length);
            let held = (records.len() / length) as u64;
            if held < header.count {
                let problem = format!("the file ends after {held} of {} points", header.count);
                return Err(damaged(problem));
            }
            let all = records.chunks_exact(length);
            for record in all.take(header.count as usize) {
                placed(record)?;
                take(&header, &way, record);
            }
        }
        true => {
            let mut compressed = Compressed::new(&header, bytes).map_err(damaged)?;
            for read in 0..header.count {
                let record = compressed.next().map_err(|problem| {
                    damaged(format!(
                        "point {} of {} cannot be decompressed: {problem}",
                        read + 1,
                        header.count
                    ))
                })?;
                placed(record)?;
                take(&header, &way, record);
            }
        }
    }
    Ok(header.count)
}

/// The header of a file whose points are no more than can be read, and the way from them to the
/// world frame of the scene.
fn header_of(file: &InputFile, system: &WorldSystem) -> Result<(Header, Way)> {
    let refuse = |problem: &str, advice: &str| Error::file(&file.path, problem, advice);
    let damaged = |problem: String| refuse(&problem, COPY_AGAIN);
    let bytes = &file.bytes[..];
    let header = Header::read(bytes).map_err(damaged)?;
    let stated = header.system(bytes).map_err(|problem| {
        refuse(
            &problem,
            "convert it to the system of the orientation, in metres, as with pdal translate",
        )
    })?;
    let way = system.way_from(&stated).map_err(|problem| {
        refuse(
            &problem,
            "convert it to the system of the orientation, as with pdal translate and its filter \
             reprojection",
        )
    })?;
    if header.count > MOST_POINTS {
        return Err(refuse(
            &format!(
                "it states {} points, and at most {MOST_POINTS} are read",
                header.count
            ),
            "cut out what lies around the scene",
        ));
    }
    let records = header.records(bytes);
    if header.count > MOST_A_BYTE * records.len() as u64 {
        let problem = format!(
            "it states {} points, and has {} bytes for them",
            header.count,
            records.len()
        );
        return Err(damaged(problem));
    }
    Ok((header, way))
}

/// The classes that points have instead, the most frequent ones.
fn listed(others: &BTreeMap<u8, u64>) -> String {
    // A refusal names no more. Assumption.
    const MOST_CLASSES_NAMED: usize = 4;
    let mut all: Vec<(u8, u64)> = others
        .iter()
        .map(|(class, count)| (*class, *count))
        .collect();
    all.sort_by_key(|&(class, count)| (std::cmp::Reverse(count), class));
    let names: Vec<String> = (all.iter().take(MOST_CLASSES_NAMED))
        .map(|&(class, count)| match class_name(class) {
            Some(name) => format!("{count} are {name} ({class})"),
            None => format!("{count} are of class {class}"),
        })
        .collect();
    match names.is_empty() {
        true => String::new(),
        false => format!(": {}", names.join(", ")),
    }
}

/// What ASPRS calls a class.
fn class_name(class: u8) -> Option<&'static str> {
    Some(match class {
        0 => "never classified",
        1 => "unclassified",
        3 => "low vegetation",
        4 => "medium vegetation",
        5 => "high vegetation",
        6 => "buildings",
        7 => "low noise",
        17 => "bridge decks",
        18 => "high noise",
        _ => return None,
    })
}
