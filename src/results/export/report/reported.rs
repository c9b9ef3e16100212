//! A model in numbers, with what its file says of it.

use nalgebra::Vector3;

use super::read::ReadWalls;
use crate::results::roof_report::BuildingReport;
use crate::roofs::model::RoofModel;

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
    pub(super) buildings: Vec<BuildingReport>,
}
