//! The roof report: a page that prints, and tables for spreadsheets.
//!
//! ```text
//! read         CityJSON -> model, names, photographs
//! compared     two models of one place
//! written      the same of a model, as its CityJSON file has them
//! reported     these with what was measured, and the files of them
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
//! All of it is made of what `model.city.json` says: `ridgeline report` makes of a folder what the
//! run wrote into it, byte for byte.

mod axonometric;
mod compared;
mod html;
mod page;
mod plan;
mod read;
mod reported;
mod roofs;
mod sheet;
mod svg;
mod tables;
mod written;

pub use self::compared::ComparedModels;
pub use self::reported::ReportedModel;

use super::measured::in_frame;
use crate::results::roof_report::{SetbackRule, roof_report};

impl ReportedModel {
    /// The files of the roof report, name and bytes, with what rules of setbacks leave of faces.
    pub fn files(mut self, setbacks: &[SetbackRule]) -> Vec<(String, Vec<u8>)> {
        let frame = self.survey.frame_sigma.as_ref();
        self.buildings = in_frame(roof_report(&self.model, setbacks), frame);
        self.setbacks = setbacks.to_vec();
        let files = [
            ("roof_report.html", page::page(&self).into_bytes()),
            ("buildings.csv", tables::buildings(&self).into_bytes()),
            ("facets.csv", tables::facets(&self).into_bytes()),
            ("edges.csv", tables::edges(&self).into_bytes()),
            ("roofs.json", roofs::roofs(&self)),
        ];
        files.map(|(name, bytes)| (name.to_owned(), bytes)).into()
    }
}
