//! Tables for spreadsheets: RFC 4180, metres and degrees, world frame of the input; what has no
//! standard deviation has an empty field.

use std::fmt::Write;

use super::super::format::rounded;
use super::reported::ReportedModel;
use crate::results::roof_report::{Estimate, Lengths, RoofEdgeKind};

/// The buildings, one a line.
pub(super) fn buildings(reported: &ReportedModel) -> String {
    let mut table = Table::default();
    table.words(&["building", "facets"]);
    table.estimate_names(&[
        "area_m2",
        "plan_area_m2",
        "volume_m3",
        "lowest_m",
        "highest_m",
    ]);
    table.length_names();
    table.words(&["ground_m", "probability"]);
    table.words(&["walls", "walls_seen", "volume_within_walls_m3"]);
    table.end_row();
    let walls = reported.names.iter().zip(&reported.walls);
    for (report, (name, walls)) in reported.buildings.iter().zip(walls) {
        table.words(&[name, &report.facets.len().to_string()]);
        for estimate in [
            report.area_m2,
            report.plan_area_m2,
            report.volume_m3,
            report.lowest_m,
            report.highest_m,
        ] {
            table.estimate(Some(estimate));
        }
        table.lengths(&report.lengths);
        let ground = reported.model.buildings[report.building.index()].ground_z;
        table.number(ground + reported.origin.z);
        table.number(report.probability);
        let counted = |i: usize| walls.count.map_or(String::new(), |c| c[i].to_string());
        let volume = walls.volume_m3.map(|v| rounded(v, 3).to_string());
        table.words(&[&counted(0), &counted(1), &volume.unwrap_or_default()]);
        table.end_row();
    }
    table.text
}

/// The facets, one a line.
pub(super) fn facets(reported: &ReportedModel) -> String {
    let mut table = Table::default();
    table.words(&["building", "facet"]);
    table.estimate_names(&[
        "area_m2",
        "plan_area_m2",
        "slope_deg",
        "azimuth_deg",
        "lowest_m",
        "highest_m",
    ]);
    table.length_names();
    table.words(&["probability", "photographs"]);
    table.end_row();
    for (report, name) in reported.buildings.iter().zip(&reported.names) {
        for facet in &report.facets {
            table.words(&[name, &facet.facet.number().to_string()]);
            for estimate in [
                Some(facet.area_m2),
                Some(facet.plan_area_m2),
                Some(facet.slope_deg),
                facet.azimuth_deg,
                Some(facet.lowest_m),
                Some(facet.highest_m),
            ] {
                table.estimate(estimate);
            }
            table.lengths(&facet.lengths);
            table.number(facet.probability);
            table.word(&reported.photographs[facet.facet.index()].join("; "));
            table.end_row();
        }
    }
    table.text
}

/// The edges, one a line.
pub(super) fn edges(reported: &ReportedModel) -> String {
    let mut table = Table::default();
    table.words(&["building", "kind", "facet", "other_facet"]);
    table.estimate_names(&["length_m"]);
    table.words(&["x0_m", "y0_m", "z0_m", "x1_m", "y1_m", "z1_m"]);
    table.end_row();
    for (report, name) in reported.buildings.iter().zip(&reported.names) {
        for edge in &report.edges {
            let (length, edge) = (edge.length_m, &edge.edge);
            let other = edge
                .other
                .map_or_else(String::new, |id| id.number().to_string());
            table.words(&[
                name,
                edge.kind.name(),
                &edge.facet.number().to_string(),
                &other,
            ]);
            table.estimate(Some(length));
            for p in [edge.segment.p0, edge.segment.p1] {
                for c in (p + reported.origin).coords.iter() {
                    table.number(*c);
                }
            }
            table.end_row();
        }
    }
    table.text
}

/// Text in rows of fields.
#[derive(Default)]
struct Table {
    text: String,
    is_within_row: bool,
}

impl Table {
    fn word(&mut self, word: &str) {
        if std::mem::replace(&mut self.is_within_row, true) {
            self.text.push(',');
        }
        if word.contains([',', '"', '\n', '\r']) {
            let doubled = word.replace('"', "\"\"");
            write!(self.text, "\"{doubled}\"").expect("a String takes all that is written");
        } else {
            self.text.push_str(word);
        }
    }

    fn words(&mut self, words: &[&str]) {
        words.iter().for_each(|word| self.word(word));
    }

    /// A number to 0.1 mm, or as fine in another unit.
    fn number(&mut self, number: f64) {
        self.word(&rounded(number, 4).to_string());
    }

    fn estimate(&mut self, estimate: Option<Estimate>) {
        for number in [estimate.map(|e| e.value), estimate.and_then(|e| e.sigma)] {
            match number {
                Some(number) => self.number(number),
                None => self.word(""),
            }
        }
    }

    fn estimate_names(&mut self, names: &[&str]) {
        for name in names {
            let (quantity, unit) = name.rsplit_once('_').expect("names end with their unit");
            self.words(&[name, &format!("{quantity}_sigma_{unit}")]);
        }
    }

    fn length_names(&mut self) {
        let names = RoofEdgeKind::ALL.map(|kind| format!("{}_m", kind.name()));
        self.estimate_names(&names.each_ref().map(String::as_str));
    }

    fn lengths(&mut self, lengths: &Lengths) {
        lengths.iter().for_each(|length| self.estimate(*length));
    }

    fn end_row(&mut self) {
        self.text.push_str("\r\n");
        self.is_within_row = false;
    }
}
