//! The roof report: a page that prints, and tables for spreadsheets.
//!
//! ```text
//! read         CityJSON -> model, names, photographs
//! reported     these with what was measured
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
mod reported;
mod svg;
mod tables;

use self::read::read_model;
use self::reported::ReportedModel;
use crate::results::roof_report::roof_report;

/// The files of the roof report, name and bytes, from a CityJSON file; an error says what is wrong
/// with that.
pub fn report_files(city_json: &[u8]) -> Result<Vec<(String, Vec<u8>)>, String> {
    let read = read_model(city_json)?;
    let reported = ReportedModel {
        buildings: roof_report(&read.model),
        model: read.model,
        names: read.names,
        photographs: read.photographs,
        walls: read.walls,
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
