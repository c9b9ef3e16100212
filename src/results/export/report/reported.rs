//! A model in numbers, with what its file says of it.

use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

use super::super::format::rounded;
use crate::base::geometry::mean_point;
use crate::base::math::{atan2, cos};
use crate::orienting::scene::{Scene, Survey};
use crate::results::roof_report::{
    BuildingReport, Estimate, FacetReport, SetbackRule, Sunshine, sunshine,
};
use crate::roofs::model::{Building, RoofModel, Solid, SolidFace, Surface};

/// The yield of one kilowatt with the losses that PVGIS proposes, on a building; its documentation
/// is the "API non-interactive service" of the Joint Research Centre.
const PVGIS: &str =
    "https://re.jrc.ec.europa.eu/api/v5_3/PVcalc?peakpower=1&loss=14&mountingplace=building";

/// A model with what its CityJSON file says of it, in numbers.
#[derive(Clone, Debug, Default)]
pub struct ReportedModel {
    pub(super) model: RoofModel,
    /// Names of the buildings in the file.
    pub(super) names: Vec<String>,
    /// Per facet, the photographs that show it.
    pub(super) photographs: Vec<Vec<String>>,
    /// Per building, its walls.
    pub(super) walls: Vec<ReportedWalls>,
    /// Add it to the model's coordinates for those of the world.
    pub(super) origin: Vector3<f64>,
    /// Metres in a step of the file's whole numbers, x y z.
    pub(super) step: Vector3<f64>,
    /// The coordinate system, where the file states it.
    pub(super) system: Option<String>,
    /// The same as far as it leads to a place on the Earth.
    pub(super) survey: Survey,
    pub(super) buildings: Vec<BuildingReport>,
    /// The rules by which usable areas are left.
    pub(super) setbacks: Vec<SetbackRule>,
}

/// What the file says of the walls of a building.
#[derive(Clone, Debug, Default)]
pub(super) struct ReportedWalls {
    /// Their number, and how many of them photographs show.
    pub(super) count: Option<[u64; 2]>,
    /// Volume within them, cubic metres, where they do not stand below the eaves.
    pub(super) volume_m3: Option<f64>,
}

impl ReportedModel {
    /// The model.
    pub fn model(&self) -> &RoofModel {
        &self.model
    }

    /// The sun on its facets; `None` where its place on the Earth is not known, and without facets.
    pub fn sunshine(&self) -> Option<Vec<Sunshine>> {
        let corners: Vec<_> = self
            .model
            .facets
            .iter()
            .map(|f| mean_point(&f.outer))
            .collect();
        let center = mean_point(corners.get(..).filter(|all| !all.is_empty())?);
        let [_, latitude] = self.geographic(&center)?;
        Some(sunshine(
            &self.model,
            latitude,
            self.grid_north_deg(&center),
        ))
    }

    /// The place of the model, without photographs.
    pub fn scene(&self) -> Scene {
        Scene {
            origin: self.origin,
            survey: self.survey.clone(),
            ..Scene::default()
        }
    }

    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    pub(crate) fn origin(&self) -> &Vector3<f64> {
        &self.origin
    }

    pub(crate) fn step(&self) -> &Vector3<f64> {
        &self.step
    }

    /// Adds a building of faces, whose facets are there, on a ground of this height, else at its
    /// lowest corner; false where it has no roof.
    pub(super) fn add_building(
        &mut self,
        faces: Vec<(Surface, Vec<Vec<Point3<f64>>>)>,
        ground_z: Option<f64>,
    ) -> bool {
        let mut solid = Solid::default();
        let mut own = std::collections::BTreeMap::new();
        let mut facets = Vec::new();
        for (surface, rings) in faces {
            if let Surface::Roof(facet) = surface {
                facets.push(facet);
            }
            let mut index = |p: &Point3<f64>| {
                let next = solid.vertices.len() as u32;
                // Bits, because the same vertex has the same ones.
                let index = *own.entry([p.x, p.y, p.z].map(f64::to_bits)).or_insert(next);
                if index == next {
                    solid.vertices.push(*p);
                }
                index
            };
            let rings = rings
                .iter()
                .map(|ring| ring.iter().map(&mut index).collect());
            let rings = rings.collect();
            solid.faces.push(SolidFace { surface, rings });
        }
        if facets.is_empty() {
            return false;
        }
        let lowest = solid.vertices.iter().fold(f64::INFINITY, |z, p| z.min(p.z));
        self.model.buildings.push(Building {
            facets,
            ground_z: ground_z.unwrap_or(lowest),
            solid,
        });
        true
    }

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
