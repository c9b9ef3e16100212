//! GeoTIFF of heights (OGC 19-008): one band of numbers, its place in the tags, and what GDAL
//! writes of the band: unit, scale and offset.

use super::geo_keys::{self, GeoKeys};
use super::height_grid::{HeightGrid, Placement, StoredHeights};
use super::system::{StatedPlan, StatedSystem, WorldSystem};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::{InputFile, LinearUnit};
use crate::photographs::raster::{Directory, NumberRaster, tiff_tags as tags};

/// Reads a GeoTIFF; `beside` is the system that a file of its name states.
pub(super) fn read(
    file: &InputFile,
    system: &WorldSystem,
    beside: Option<StatedSystem>,
) -> Result<HeightGrid> {
    let refuse = |problem: &str, advice: &str| Error::file(&file.path, problem, advice);
    let place = "give a GeoTIFF, whose tags state where it lies, north up";
    // What has a place and heights is never held by its head.
    if file.lacking().is_some() {
        return Err(refuse("it states no place", place));
    }
    let raster = NumberRaster::read(&file.path, file.content())?;
    let reproject = "convert it with gdalwarp to the system of the orientation, in metres";
    let keys = raster.directory.numbers(tags::GEO_KEY_DIRECTORY);
    let keys = GeoKeys {
        directory: &keys.unwrap_or_default(),
        texts: raster.directory.raw(geo_keys::TEXTS).unwrap_or_default(),
    };
    let stated = geo_keys::stated(&keys).map_err(|problem| refuse(&problem, reproject))?;
    let mut stated = match beside {
        Some(beside) if stated.plan == StatedPlan::Unstated => beside,
        _ => stated,
    };
    let band = Band::of(&raster.directory).map_err(|problem| refuse(&problem, reproject))?;
    if let Some(unit) = band.unit {
        stated.height_unit_m = unit.metres;
    }
    let way = system.way_from(&stated);
    let way = way.map_err(|problem| refuse(&problem, reproject))?;
    let (corner, cell) = placed(&raster.directory).map_err(|problem| refuse(problem, place))?;
    // Coordinates are of the corner of a cell, unless the file says that they are of its centre.
    let half = if keys.is_of_centres() { 0.0 } else { 0.5 };
    let no_data = raster.directory.raw(tags::GDAL_NO_DATA);
    let no_data = no_data.and_then(|text| std::str::from_utf8(text).ok());
    let no_data = no_data.and_then(|text| text.trim_matches(['\0', ' ']).parse::<f64>().ok());
    let cells = Placement {
        first: [corner[0] + half * cell[0], corner[1] - half * cell[1]],
        cell,
        columns: raster.width,
        rows: raster.height,
    };
    let heights = StoredHeights {
        values: raster.values,
        no_data: no_data.map(|z| z as f32),
        scale: band.scale,
    };
    HeightGrid::new(cells, heights, way)
        .map_err(|problem| refuse(&problem, "give heights of the ground, in metres"))
}

/// What GDAL writes of the first band.
struct Band {
    unit: Option<LinearUnit>,
    /// Factor and summand of its values.
    scale: [f64; 2],
}

impl Band {
    /// Otherwise why its heights are not known.
    fn of(directory: &Directory) -> std::result::Result<Self, String> {
        let text = directory.raw(tags::GDAL_METADATA).unwrap_or_default();
        let text = String::from_utf8_lossy(text);
        let document = roxmltree::Document::parse(text.trim_matches(['\0', ' ', '\n']));
        let item = |role: &str| {
            let nodes = document.as_ref().ok()?.descendants();
            let of_first =
                |node: &roxmltree::Node| node.attribute("sample").is_none_or(|s| s == "0");
            let mut named = nodes.filter(|node| node.attribute("role") == Some(role));
            named
                .find(of_first)?
                .text()
                .map(|text| text.trim().to_owned())
        };
        let unit = match item("unittype").filter(|name| !name.is_empty()) {
            None => None,
            Some(name) => Some(LinearUnit::of_name(&name).ok_or_else(|| {
                format!("its heights are not in metres, but in the unit {name}, which is not read")
            })?),
        };
        let number = |role: &str, otherwise: f64| match item(role) {
            None => Ok(otherwise),
            Some(text) => text
                .parse::<f64>()
                .ok()
                .filter(|v| v.is_finite())
                .ok_or_else(|| format!("the {role} of its heights is {text}, which is no number")),
        };
        Ok(Self {
            unit,
            scale: [number("scale", 1.0)?, number("offset", 0.0)?],
        })
    }
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
