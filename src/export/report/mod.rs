//! The roof report: a page that prints, and tables for spreadsheets.
//!
//! ```text
//! read         CityJSON -> model, names, photographs
//! page         the page: HTML with its style and pictures inside
//! plan         a plan with dimensions, SVG
//! axonometric  a building from above and aside, SVG
//! tables       buildings, facets and edges as CSV
//! svg          numbers, lines and words of the pictures
//! ```
//!
//! All of it is made of `model.city.json` alone: `ridgeline report` makes of a folder what the run
//! wrote into it, byte for byte.

mod axonometric;
mod page;
mod plan;
mod read;
mod svg;
mod tables;

use nalgebra::Vector3;

use self::read::read_model;
use crate::model::RoofModel;
use crate::roof_report::{BuildingReport, roof_report};

/// A model with what its file says of it, in numbers.
struct ReportedModel {
    model: RoofModel,
    /// Names of the buildings in the file.
    names: Vec<String>,
    /// Per facet, the photographs that show it.
    photographs: Vec<Vec<String>>,
    /// Add it to the model's coordinates for those of the world.
    origin: Vector3<f64>,
    /// The coordinate system, where the file states it.
    system: Option<String>,
    buildings: Vec<BuildingReport>,
}

/// The files of the roof report, name and bytes, from a CityJSON file; an error says what is wrong
/// with that.
pub fn report_files(city_json: &[u8]) -> Result<Vec<(String, Vec<u8>)>, String> {
    let read = read_model(city_json)?;
    let reported = ReportedModel {
        buildings: roof_report(&read.model),
        model: read.model,
        names: read.names,
        photographs: read.photographs,
        origin: read.origin,
        system: read.system,
    };
    let files = [
        ("roof_report.html", page::page(&reported)),
        ("buildings.csv", tables::buildings(&reported)),
        ("facets.csv", tables::facets(&reported)),
        ("edges.csv", tables::edges(&reported)),
    ];
    Ok(files
        .map(|(name, text)| (name.to_owned(), text.into_bytes()))
        .into())
}
