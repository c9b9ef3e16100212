//! GeoTIFF of heights (OGC 19-008): one band of numbers, its place in the tags.

use super::geo_keys;
use super::height_grid::HeightGrid;
use super::refusal::refusal;
use super::system::WorldSystem;
use crate::base::error::Result;
use crate::orienting::orientation::InputFile;
use crate::photographs::raster::{Directory, NumberRaster, tiff_tags as tags};

/// The key by which coordinates are of the corner or of the centre of a cell.
const RASTER_TYPE: u64 = 1025;

pub(super) fn read(file: &InputFile, system: &WorldSystem) -> Result<HeightGrid> {
    let refuse = |problem: &str, advice: &str| refusal(&file.path, problem, advice);
    let place = "give a GeoTIFF, whose tags state where it lies, north up";
    // What has a place and heights is never held by its head.
    if file.lacking().is_some() {
        return Err(refuse("it states no place", place));
    }
    let raster = NumberRaster::read(&file.path, file.content())?;
    let reproject = "convert it with gdalwarp to the system of the orientation, in metres";
    let keys = raster.directory.numbers(tags::GEO_KEY_DIRECTORY);
    let keys = keys.unwrap_or_default();
    let key = |key: u64| geo_keys::value(&keys, key);
    let stated = geo_keys::stated(key).map_err(|problem| refuse(&problem, reproject))?;
    system
        .is_frame_of(&stated)
        .map_err(|problem| refuse(&problem, reproject))?;
    let (corner, cell) = placed(&raster.directory).map_err(|problem| refuse(problem, place))?;
    // Coordinates are of the corner of a cell, unless the file says that they are of its centre.
    let half = if key(RASTER_TYPE) == Some(2) {
        0.0
    } else {
        0.5
    };
    let first = [corner[0] + half * cell[0], corner[1] - half * cell[1]];
    let no_data = raster.directory.raw(tags::GDAL_NO_DATA);
    let no_data = no_data.and_then(|text| std::str::from_utf8(text).ok());
    let no_data = no_data.and_then(|text| text.trim_matches(['\0', ' ']).parse::<f64>().ok());
    let size = [raster.width, raster.height];
    HeightGrid::new(first, cell, size, raster.values, no_data.map(|z| z as f32))
        .map_err(|problem| refuse(&problem, "give heights of the ground, in metres"))
}

/// Easting and northing of pixel (0, 0) and the size of a cell; else why there is none.
fn placed(directory: &Directory) -> std::result::Result<([f64; 2], [f64; 2]), &'static str> {
    if let Some(m) = directory.doubles(tags::MODEL_TRANSFORMATION)
        && let [a, b, _, x, c, d, _, y, ..] = m[..]
    {
        let is_turned = b != 0.0 || c != 0.0 || a <= 0.0 || d >= 0.0;
        return match is_turned {
            true => Err("its rows do not run from west to east, from the north on"),
            false => Ok(([x, y], [a, -d])),
        };
    }
    let scale = directory
        .doubles(tags::MODEL_PIXEL_SCALE)
        .unwrap_or_default();
    let tie = directory.doubles(tags::MODEL_TIEPOINT).unwrap_or_default();
    let ([sx, sy, ..], [i, j, _, x, y, ..]) = (&scale[..], &tie[..]) else {
        return Err("it does not state where it lies");
    };
    Ok(([x - i * sx, y + j * sy], [*sx, *sy]))
}
