//! Two models of one place, part by part, for people and for programs.

use std::fmt::Write;

use serde::Serialize;

use super::reported::ReportedModel;
use crate::base::ids::{BuildingId, FacetId};
use crate::base::math::median;
use crate::results::roof_report::{Compared, compare};

/// What two models say of one place.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ComparedModels {
    /// Buildings by their names in the files: of both, of the first alone, of the second alone.
    pub buildings: Vec<Compared<String>>,
    /// The same of facets, by the names of their buildings and their numbers in the reports.
    pub facets: Vec<Compared<String>>,
}

impl ReportedModel {
    /// Compares it with a second model.
    ///
    /// # Errors
    /// Where they are stated in different reference systems.
    pub fn compare(&self, second: &Self) -> Result<ComparedModels, String> {
        if let (Some(own), Some(other)) = (self.survey.epsg, second.survey.epsg)
            && own != other
        {
            return Err(format!(
                "the models are in EPSG:{own} and EPSG:{other}; convert one of them"
            ));
        }
        let here = (second.model.clone()).relative_to(&(self.origin - second.origin));
        let found = compare(&self.model, &here);
        let building = |of: &Self, id: BuildingId| of.names[id.index()].clone();
        let facet = |of: &Self, id: FacetId| {
            let name = &of.names[of.model.facets[id.index()].building.index()];
            format!("{name}, {}", id.name())
        };
        let buildings = found.buildings.into_iter();
        let facets = found.facets.into_iter();
        Ok(ComparedModels {
            buildings: buildings
                .map(|part| part.named(|id| building(self, id), |id| building(second, id)))
                .collect(),
            facets: facets
                .map(|part| part.named(|id| facet(self, id), |id| facet(second, id)))
                .collect(),
        })
    }
}

impl ComparedModels {
    /// As JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a comparison holds only numbers and names")
    }

    /// As text: a sentence, and a row for each building.
    pub fn to_text(&self) -> String {
        let in_both = |part: &&Compared<String>| part.above_m.is_some();
        let alone = |has: fn(&Compared<String>) -> bool| {
            let alone = self.buildings.iter().filter(|part| !in_both(part));
            alone.filter(|part| has(part)).count()
        };
        let areas = self.buildings.iter().fold([0.0, 0.0], |sum, part| {
            [0, 1].map(|k| sum[k] + part.area_m2[k])
        });
        let mut above: Vec<f64> = (self.facets.iter().filter_map(|f| f.above_m)).collect();
        let mut text = format!(
            "buildings: {} in both models, {} in the first alone, {} in the second alone; roofs of \
             {:.1} and {:.1} m2\n",
            self.buildings.iter().filter(in_both).count(),
            alone(|part| part.first.is_some()),
            alone(|part| part.second.is_some()),
            areas[0],
            areas[1],
        );
        if let Some(middle) = median(&mut above) {
            let _ = writeln!(
                text,
                "of the {} facets that both have, the median lies {middle:.2} m above its place in \
                 the second model",
                above.len()
            );
        }
        let width = |pick: fn(&Compared<String>) -> &Option<String>, title: &str| {
            let names = self.buildings.iter().filter_map(|part| pick(part).as_ref());
            let widest = names.map(|name| name.chars().count()).max().unwrap_or(0);
            widest.max(title.len())
        };
        let [first, second] = [
            width(|part| &part.first, "first"),
            width(|part| &part.second, "second"),
        ];
        let _ = writeln!(
            text,
            "{:<first$}  {:<second$}  overlap  roofs (m2)          above (m)  largest (m)",
            "first", "second"
        );
        for part in &self.buildings {
            let name = |name: &Option<String>| name.clone().unwrap_or_else(|| "-".to_owned());
            let height = |h: Option<f64>| h.map_or_else(|| "-".to_owned(), |h| format!("{h:.2}"));
            let _ = writeln!(
                text,
                "{:<first$}  {:<second$}  {:>7.2}{:>10.1}{:>10.1}{:>11}{:>13}",
                name(&part.first),
                name(&part.second),
                part.overlap,
                part.area_m2[0],
                part.area_m2[1],
                height(part.above_m),
                height(part.largest_m)
            );
        }
        text
    }
}
