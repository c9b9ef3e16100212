//! A model in numbers, with what its file says of it.

use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

use super::super::format::rounded;
use super::read::ReadWalls;
use crate::base::geometry::mean_point;
use crate::base::math::{atan2, cos};
use crate::orienting::scene::Survey;
use crate::results::roof_report::{BuildingReport, Estimate, FacetReport, SetbackRule};
use crate::roofs::model::RoofModel;

/// The yield of one kilowatt with the losses that PVGIS proposes, on a building; its documentation
/// is the "API non-interactive service" of the Joint Research Centre.
const PVGIS: &str =
    "https://re.jrc.ec.europa.eu/api/v5_3/PVcalc?peakpower=1&loss=14&mountingplace=building";

/// A model with what its file says of it, in numbers.
pub(super) struct ReportedModel {
    pub(super) model: RoofModel,
    /// Names of the buildings in the file.
    pub(super) names: Vec<String>,
    /// Per facet, the photographs that show it.
    pub(super) photographs: Vec<Vec<String>>,
    /// Per building, its walls.
    pub(super) walls: Vec<ReadWalls>,
    /// Add it to the model's coordinates for those of the world.
    pub(super) origin: Vector3<f64>,
    /// The coordinate system, where the file states it.
    pub(super) system: Option<String>,
    /// The same as far as it leads to a place on the Earth.
    pub(super) survey: Survey,
    pub(super) buildings: Vec<BuildingReport>,
    /// The rules by which usable areas are left.
    pub(super) setbacks: Vec<SetbackRule>,
}

impl ReportedModel {
    /// The middle of a facet's corners, on its plane.
    pub(super) fn center(&self, report: &FacetReport) -> Point3<f64> {
        let facet = &self.model.facets[report.facet.index()];
        let middle = mean_point(&facet.outer);
        facet.plane.lift(middle.x, middle.y)
    }

    /// Longitude and latitude of a point of the model, degrees; `None` where the place on the Earth
    /// is not known.
    pub(super) fn geographic(&self, p: &Point3<f64>) -> Option<[f64; 2]> {
        let [lon, lat, _] = self.survey.geographic(&(p + self.origin))?;
        Some([lon, lat])
    }

    /// The same by their names.
    pub(super) fn lat_lon(&self, p: &Point3<f64>) -> Option<Value> {
        self.geographic(p).map(Self::named)
    }

    /// Longitude and latitude by their names, to a centimetre.
    pub(super) fn named([lon, lat]: [f64; 2]) -> Value {
        json!({ "latitude": rounded(lat, 7), "longitude": rounded(lon, 7) })
    }

    /// Where a facet falls to, degrees clockwise from true north, from grid north where the place
    /// on the Earth is not known; `None` for a level one.
    pub(super) fn azimuth_deg(&self, report: &FacetReport) -> Option<Estimate> {
        let convergence = self.grid_north_deg(&self.center(report));
        report.azimuth_deg.map(|azimuth| Estimate {
            value: (azimuth.value + convergence).rem_euclid(360.0),
            ..azimuth
        })
    }

    /// The direction of grid north, degrees clockwise from true north; 0 where it is not known.
    fn grid_north_deg(&self, p: &Point3<f64>) -> f64 {
        let north = self.geographic(&(p + Vector3::y()));
        let ends = self.geographic(p).zip(north);
        ends.map_or(0.0, |([lon, lat], [lon_north, lat_north])| {
            let east = (lon_north - lon) * cos(lat.to_radians());
            atan2(east, lat_north - lat).to_degrees()
        })
    }

    /// An address where PVGIS says what a facet yields. Its aspect is 0 in the south and 90 in the
    /// west.
    pub(super) fn pvgis(&self, report: &FacetReport) -> Option<String> {
        let center = self.center(report);
        let [lon, lat] = self.geographic(&center)?;
        let aspect = self
            .azimuth_deg(report)
            .map_or(0.0, |azimuth| azimuth.value - 180.0);
        let (slope, aspect) = (report.slope_deg.value, rounded(aspect, 1));
        Some(format!(
            "{PVGIS}&lat={lat:.6}&lon={lon:.6}&angle={slope:.1}&aspect={aspect}"
        ))
    }
}
