//! What is known of a place before its photographs are looked at: a terrain model, the footprints
//! of a register of buildings, and a point cloud. Evidence with a stated accuracy, never truth.
//!
//! ```text
//! system        the coordinate system that a file states, and the way from it to the scene's
//! height_grid   heights on a grid, interpolated
//!    holes      cells that hold no ground, though no tag says so
//!    ascii_grid, geotiff, point_cloud   its readers; point_cloud reads the points of roofs too
//!    geo_keys   the system by the keys of GeoTIFF and LAS
//! footprint     outlines in plan: inside or outside, and how far from the border
//!    json_lines            JSON as one value or as one a line
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
mod holes;
mod json_lines;
mod point_cloud;
mod system;
#[cfg(test)]
mod tests;

pub use comparison::{KnownComparison, KnownShift, KnownThing, KnownVerdict};
pub(crate) use comparison::{belongs_here, best_shift};
pub use footprint::Footprint;
pub use height_grid::HeightGrid;
pub use holes::TERRAIN_ACCURACY_M;
pub(crate) use json_lines::json_of;
use system::StatedSystem;
pub use system::WorldSystem;

use std::sync::Arc;

use nalgebra::{Point2, Point3, Vector3};

use crate::base::error::{Error, Result};
use crate::orienting::orientation::{InputFile, POINT_CLOUD, is_ascii_grid};

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
    /// Is it known what the heights of the scene count from?
    is_placed: bool,
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
            return Err(Error::file(
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
    /// Reads a terrain model for a scene with this system and origin; `beside` is the text of its
    /// `.prj`, where it has one.
    ///
    /// # Errors
    /// A refusal that names the file.
    pub fn read(
        file: &InputFile,
        beside: Option<&str>,
        system: &WorldSystem,
        origin: Vector3<f64>,
        accuracy_m: f64,
    ) -> Result<Self> {
        let beside = beside.map(StatedSystem::named);
        let grid = if crate::photographs::raster::is_tiff(&file.bytes) {
            geotiff::read(file, system, beside)?
        } else if file.bytes.starts_with(POINT_CLOUD) {
            point_cloud::read(file, system)?
        } else if (file.start_as_text(64)).is_some_and(|text| is_ascii_grid(&text)) {
            let stated = beside.unwrap_or_else(StatedSystem::unstated);
            let way = system.way_from(&stated).map_err(|problem| {
                Error::file(
                    &file.path,
                    problem,
                    "convert it to the system of the orientation",
                )
            })?;
            ascii_grid::read(file, way)?
        } else {
            return Err(Error::file(
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
            is_placed: system.is_known(),
            accuracy_m,
        })
    }

    /// What is to be said of its holes.
    pub fn notice(&self) -> Option<String> {
        let [holes, known] = self.grid.holes();
        (holes > 0).then(|| {
            format!(
                "{}: {holes} of {} heights are no ground (fillers as 0, spikes and pits), and count \
                 as none",
                self.file,
                holes + known
            )
        })
    }

    /// Is it known what the heights of the scene count from? Then no datum explains a large shift.
    pub fn is_placed(&self) -> bool {
        self.is_placed
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
            Error::file(
                &file.path,
                "it holds no footprints that are read",
                "give polygons as GeoJSON, or buildings as CityJSON; a GeoPackage or a shapefile \
                 becomes GeoJSON with ogr2ogr",
            )
        };
        let start = file.start_as_text(1024);
        if !start.is_some_and(|text| json_lines::begins(&text)) {
            return Err(none());
        }
        let json = json_lines::read(file)?;
        let outlines = match json["type"].as_str() {
            Some("CityJSON") => city_json::read(file, &json, system)?,
            Some(
                "FeatureCollection" | "Feature" | "Polygon" | "MultiPolygon" | "GeometryCollection",
            ) => geojson::read(file, &json, system, warnings)?,
            _ => return Err(none()),
        };
        if outlines.is_empty() {
            let problem = "it holds no polygons of buildings";
            let advice = "give polygons, not lines or points";
            return Err(Error::file(&file.path, problem, advice));
        }
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
            return Err(Error::file(
                &file.path,
                problem,
                "give polygons of buildings",
            ));
        }
        Ok(Self {
            file: file.path.clone(),
            footprints,
            accuracy_m,
        })
    }

    /// Do footprints of GeoJSON reach into a box in plan, x0, y0, x1, y1, local frame, if x and y
    /// are exchanged?
    pub fn reaches_exchanged(
        file: &InputFile,
        system: &WorldSystem,
        origin: Vector3<f64>,
        area: [f64; 4],
    ) -> bool {
        let outlines = json_lines::read(file).and_then(|mut json| {
            geojson::exchange(&mut json);
            geojson::read(file, &json, system, &mut Vec::new())
        });
        let footprints = outlines.into_iter().flatten();
        let footprints = footprints.filter_map(|outline| Footprint::new(outline, origin).ok());
        let register = Self {
            file: file.path.clone(),
            footprints: footprints.collect(),
            accuracy_m: 0.0,
        };
        register.reaches(area)
    }

    /// Does any outline reach into a box in plan, x0, y0, x1, y1, local frame?
    pub fn reaches(&self, [x0, y0, x1, y1]: [f64; 4]) -> bool {
        self.footprints.iter().any(|footprint| {
            let [low, high] = footprint.bounds();
            low.x <= x1 && high.x >= x0 && low.y <= y1 && high.y >= y0
        })
    }

    /// Without the outlines of survey areas: most of the places that three views show, `shown`, lie
    /// inside of one, and it is larger than all of them, `shown_m2`, so that nothing around it is
    /// shown.
    ///
    /// # Errors
    /// A refusal where no other outline is left.
    pub fn without_areas(
        mut self,
        shown: &[Point2<f64>],
        shown_m2: f64,
        warnings: &mut Vec<String>,
    ) -> Result<Self> {
        let holds_most = |footprint: &Footprint| {
            let inside = shown
                .iter()
                .filter(|place| footprint.outline.contains(place));
            footprint.outline.signed_area() > shown_m2 && 2 * inside.count() > shown.len()
        };
        let (areas, footprints): (Vec<Footprint>, _) =
            self.footprints.into_iter().partition(holds_most);
        let problem = |area: &Footprint| {
            format!(
                "its polygon {} of {:.0} m2 holds most of what the photographs show: it is the \
                 outline of a survey area, not of a building",
                area.name,
                area.outline.signed_area()
            )
        };
        if let (Some(area), true) = (areas.first(), footprints.is_empty()) {
            let advice = "give footprints of buildings";
            return Err(Error::file(&self.file, problem(area), advice));
        }
        let said = areas
            .iter()
            .map(|area| format!("{}: {}", self.file, problem(area)));
        warnings.extend(said.map(|said| format!("{said}; it is left out")));
        self.footprints = footprints;
        Ok(self)
    }
}
