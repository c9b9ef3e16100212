//! The roof report: a page that prints, and tables for spreadsheets.
//!
//! ```text
//! read         CityJSON -> model, names, photographs
//! reported     these with what was measured
//! page         the page: HTML with its style and pictures inside
//! html         its text and tables
//! plan         a plan with dimensions, SVG
//! axonometric  a building from above and aside, SVG
//! sheet        what a roofer and a planner ask for: lengths by class, waste, usable areas
//! tables       buildings, facets and edges as CSV
//! roofs        all of it as one JSON file
//! svg          numbers, lines and words of the pictures
//! ```
//!
//! All of it is made of `model.city.json` alone: `ridgeline report` makes of a folder what the run
//! wrote into it, byte for byte.

mod axonometric;
mod html;
mod page;
mod plan;
mod read;
mod reported;
mod roofs;
mod sheet;
mod svg;
mod tables;

use self::read::read_model;
use self::reported::ReportedModel;
use super::measured::in_frame;
use crate::results::roof_report::{SetbackRule, roof_report};

/// The files of the roof report, name and bytes, from a CityJSON file, with what rules of setbacks
/// leave of the faces; an error says what is wrong with the file.
pub fn report_files(
    city_json: &[u8],
    setbacks: &[SetbackRule],
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let read = read_model(city_json)?;
    let reported = ReportedModel {
        buildings: in_frame(
            roof_report(&read.model, setbacks),
            read.survey.frame_sigma.as_ref(),
        ),
        setbacks: setbacks.to_vec(),
        model: read.model,
        names: read.names,
        photographs: read.photographs,
        walls: read.walls,
        origin: read.origin,
        system: read.system,
        survey: read.survey,
    };
    let files = [
        ("roof_report.html", page::page(&reported).into_bytes()),
        ("buildings.csv", tables::buildings(&reported).into_bytes()),
        ("facets.csv", tables::facets(&reported).into_bytes()),
        ("edges.csv", tables::edges(&reported).into_bytes()),
        ("roofs.json", roofs::roofs(&reported)),
    ];
    Ok(files.map(|(name, bytes)| (name.to_owned(), bytes)).into())
}
