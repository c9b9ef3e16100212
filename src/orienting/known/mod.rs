//! What is known of a place before its photographs are looked at: a terrain model, the footprints
//! of a register of buildings, and a point cloud. Evidence with a stated accuracy, never truth.
//!
//! ```text
//! system        the coordinate system that a file states, and the way from it to the scene's
//! height_grid   heights on a grid, interpolated
//!    ascii_grid, geotiff, point_cloud   its readers; point_cloud reads the points of roofs too
//!    geo_keys   the system by the keys of GeoTIFF and LAS
//! footprint     outlines in plan: inside or outside, and how far from the border
//!    geojson, city_json    its readers
//! comparison    what the images say of one of them
//! ```
//!
//! Files are recognised by their content. Invariant: a reader takes any bytes and returns a value
//! or a readable refusal; what it holds is a small multiple of its input, or of the cells that a
//! raster states, of which there are at most a hundred million, as of the points of a cloud.
//!
//! Not read: GeoPackage (a database, whose reader is larger than all of these), which one command
//! of GDAL converts to what is read.

mod ascii_grid;
mod city_json;
mod comparison;
mod footprint;
mod geo_keys;
mod geojson;
mod geotiff;
mod height_grid;
mod point_cloud;
mod refusal;
mod system;
#[cfg(test)]
mod tests;

pub use comparison::{KnownComparison, KnownShift, KnownThing, KnownVerdict};
pub(crate) use comparison::{belongs_here, best_shift};
pub use footprint::Footprint;
pub use height_grid::HeightGrid;
pub use system::WorldSystem;

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use self::refusal::refusal;
use crate::base::error::{Error, Result};
use crate::orienting::orientation::{InputFile, POINT_CLOUD};

/// What is known of a scene; frame and units of the scene.
#[derive(Clone, Debug, Default)]
pub struct Known {
    /// Heights of the ground.
    pub terrain: Option<Terrain>,
    /// Footprints of a register.
    pub footprints: Option<Arc<Register>>,
    /// Points on roofs and on the ground.
    pub point_cloud: Option<Arc<PointCloud>>,
}

/// A point cloud.
#[derive(Clone, Debug)]
pub struct PointCloud {
    /// Name of its file.
    pub file: String,
    /// Its points, but for those of vegetation and noise, thinned to a few on a square metre; local
    /// frame.
    pub points: Vec<Point3<f32>>,
    /// Standard deviation of its heights, metres.
    pub accuracy_m: f64,
}

/// A terrain model.
#[derive(Clone, Debug)]
pub struct Terrain {
    /// Name of its file.
    pub file: String,
    /// Its heights, in the world frame of the input.
    grid: Arc<HeightGrid>,
    /// Origin of the scene.
    origin: Vector3<f64>,
    /// Standard deviation of its heights, metres.
    pub accuracy_m: f64,
}

/// A register of buildings.
#[derive(Clone, Debug)]
pub struct Register {
    /// Name of its file.
    pub file: String,
    /// Outlines, local frame.
    pub footprints: Vec<Footprint>,
    /// Standard deviation of its borders, metres.
    pub accuracy_m: f64,
}

/// Standard deviation of the heights of a terrain model where none is stated, metres. Assumption:
/// surveys promise 0.15 to 0.3 m for models from airborne laser scanning.
pub const TERRAIN_ACCURACY_M: f64 = 0.3;

/// Standard deviation of the borders of a register where none is stated, metres. Assumption: half
/// of that is promised of cadastral surveys, twice of what is digitised from photographs.
pub const FOOTPRINT_ACCURACY_M: f64 = 0.5;

/// Standard deviation of the heights of a point cloud where none is stated, metres. Assumption:
/// surveys promise 0.15 m.
pub const POINT_CLOUD_ACCURACY_M: f64 = 0.15;

impl PointCloud {
    /// Reads a LAS or LAZ file for a scene with this system and origin; `within` is a box in plan,
    /// x0, y0, x1, y1, local frame, outside of which nothing is of use.
    ///
    /// # Errors
    /// A refusal that names the file.
    pub fn read(
        file: &InputFile,
        system: &WorldSystem,
        origin: Vector3<f64>,
        accuracy_m: f64,
        within: Option<[f64; 4]>,
    ) -> Result<Self> {
        if !file.bytes.starts_with(POINT_CLOUD) {
            return Err(refusal(
                &file.path,
                "it is no point cloud that is read",
                "give a LAS or LAZ file; other formats become one with pdal translate",
            ));
        }
        Ok(Self {
            file: file.path.clone(),
            points: point_cloud::read_surface(file, system, origin, within)?,
            accuracy_m,
        })
    }
}

impl Terrain {
    /// Reads a terrain model for a scene with this system and origin.
    ///
    /// # Errors
    /// A refusal that names the file.
    pub fn read(
        file: &InputFile,
        system: &WorldSystem,
        origin: Vector3<f64>,
        accuracy_m: f64,
    ) -> Result<Self> {
        let grid = if crate::photographs::raster::is_tiff(&file.bytes) {
            geotiff::read(file, system)?
        } else if file.bytes.starts_with(POINT_CLOUD) {
            point_cloud::read(file, system)?
        } else if ascii_grid::is_ascii_grid(file) {
            ascii_grid::read(file)?
        } else {
            return Err(refusal(
                &file.path,
                "it is no terrain model that is read",
                "give a GeoTIFF of heights, an ASCII grid of ESRI (.asc), or a point cloud (.las, \
                 .laz) whose ground is classified; lists of points become one with gdal_grid",
            ));
        };
        Ok(Self {
            file: file.path.clone(),
            grid: Arc::new(grid),
            origin,
            accuracy_m,
        })
    }

    /// Height of the ground at a plan position, local frame, metres; `None` where the model has
    /// none.
    pub fn z_at(&self, x: f64, y: f64) -> Option<f64> {
        let z = self.grid.z_at(x + self.origin.x, y + self.origin.y)?;
        Some(z - self.origin.z)
    }
}

impl Register {
    /// Reads footprints for a scene with this system and origin; what is to be said of those that
    /// are left out goes to `warnings`.
    ///
    /// # Errors
    /// A refusal that names the file.
    pub fn read(
        file: &InputFile,
        system: &WorldSystem,
        origin: Vector3<f64>,
        accuracy_m: f64,
        warnings: &mut Vec<String>,
    ) -> Result<Self> {
        let none = || {
            refusal(
                &file.path,
                "it holds no footprints that are read",
                "give polygons as GeoJSON, or buildings as CityJSON; a GeoPackage or a shapefile \
                 becomes GeoJSON with ogr2ogr",
            )
        };
        let text = file.start_as_text(1024).ok_or_else(none)?;
        if !text
            .trim_start_matches('\u{feff}')
            .trim_start()
            .starts_with('{')
        {
            return Err(none());
        }
        let text = file.text();
        let json: serde_json::Value = serde_json::from_str(text.trim_start_matches('\u{feff}'))
            .map_err(|e| Error::Line {
                file: file.path.clone(),
                line: e.line(),
                problem: "it is no JSON".to_owned(),
                expected: "GeoJSON or CityJSON".to_owned(),
            })?;
        let outlines = match json["type"].as_str() {
            Some("CityJSON") => city_json::read(file, &json, system)?,
            Some("FeatureCollection" | "Feature" | "Polygon" | "MultiPolygon") => {
                geojson::read(file, &json, system)?
            }
            _ => return Err(none()),
        };
        let mut footprints = Vec::new();
        for outline in outlines {
            let name = outline.name.clone();
            match Footprint::new(outline, origin) {
                Ok(footprint) => footprints.push(footprint),
                Err(problem) => warnings.push(format!(
                    "{}: footprint {name} is left out: {problem}",
                    file.path
                )),
            }
        }
        if footprints.is_empty() {
            let left_out = warnings.last().map_or("", String::as_str);
            let problem = format!("none of its footprints can be used; {left_out}");
            return Err(refusal(&file.path, &problem, "give polygons of buildings"));
        }
        Ok(Self {
            file: file.path.clone(),
            footprints,
            accuracy_m,
        })
    }
}
