//! One model of evidence: whether a line or a facet lives is one question, asked once, in nats.
//!
//! Everything measured of a candidate is a feature, and a table says how much likelier its value
//! is on a true candidate than on a false one, as a natural logarithm. The logarithms add:
//!
//! ```text
//! ln odds = prior + f_1(x_1) + f_2(x_2) + ...
//! ```
//!
//! That is an additive logistic model (Hastie and Tibshirani 1986), whose curves are piecewise
//! linear. `make calibrate` fits them to scenes of which the truth is known; the tables beside this
//! file are its output and name their scenes. A candidate lives from `least_nats` of its stage on:
//! even odds, and three to one for the lines of the finished model. The probability that is stated
//! of it follows from the same number.
//!
//! Invariant: no other threshold here or in what calls this; the calibration alone sets
//! `least_nats` so low that every candidate is seen.

mod clutter;
mod corners;
mod hiding;
mod judged;
mod uncertainty;
mod walls;
mod windows;

pub(crate) use clutter::ClutterTable;
pub(crate) use corners::CornerTable;
pub(crate) use hiding::HidingTable;
pub use judged::{
    Candidates, JudgedFacet, JudgedLine, JudgedSurface, WindowCounts, WindowHistogram,
};
pub(crate) use uncertainty::{Inflation, UncertaintyTable};
pub(crate) use walls::WallEvidence;
pub(crate) use windows::WindowEvidenceTable;

use std::sync::OnceLock;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

/// Share of the cost of a border of a roof where a reconstructed line in one of its planes lies on
/// it.
pub(crate) const ON_LINE: f64 = 0.1;

/// What a ratio of likelihoods says, nats, that holds with a probability and is one otherwise.
pub(crate) fn nats_where_it_belongs(belongs: f64, ratio: f64) -> f64 {
    // A certain source keeps odds that are lost beside one.
    crate::base::math::ln(belongs * ratio + (1.0 - belongs))
}

/// What one feature of a candidate says.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct EvidenceTerm {
    /// Name of the feature.
    pub feature: &'static str,
    /// Its value, in the unit that its name tells.
    pub value: f64,
    /// Natural logarithm of its likelihood ratio: positive speaks for the candidate.
    pub nats: f64,
}

/// From bytes the name must be that of a feature of the tables.
impl<'de> Deserialize<'de> for EvidenceTerm {
    fn deserialize<D: Deserializer<'de>>(bytes: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        struct NamedTerm {
            feature: String,
            value: f64,
            nats: f64,
        }
        let NamedTerm {
            feature: name,
            value,
            nats,
        } = NamedTerm::deserialize(bytes)?;
        let feature = EvidenceModel::feature_called(&name)
            .ok_or_else(|| D::Error::custom(format!("no feature is called {name}")))?;
        Ok(Self {
            feature,
            value,
            nats,
        })
    }
}

/// What a register of buildings says of a facet: no feature of the tables, which are fitted to
/// scenes without one.
pub(crate) const INSIDE_FOOTPRINT: &str = "inside_footprint";

/// What a point cloud says of a facet.
pub(crate) const POINT_CLOUD: &str = "on_point_cloud";

/// All that speaks for a candidate and against it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Evidence {
    /// Natural logarithm of the odds before anything was measured.
    pub prior: f64,
    /// One a feature.
    pub terms: Vec<EvidenceTerm>,
}

impl Evidence {
    /// Natural logarithm of the odds that the candidate is true.
    pub fn nats(&self) -> f64 {
        self.prior + self.terms.iter().map(|t| t.nats).sum::<f64>()
    }

    /// The probability that the candidate is true, 0 to 1.
    pub fn probability(&self) -> f64 {
        1.0 / (1.0 + crate::base::math::exp(-self.nats()))
    }

    /// Do the odds of the candidate reach so many nats? At zero it is as likely true as false.
    pub fn accepts(&self, least_nats: f64) -> bool {
        self.nats() >= least_nats
    }
}

/// The fitted tables of one kind of candidate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EvidenceModel {
    /// How the tables came about.
    #[allow(dead_code)] // For those who read the file.
    source: String,
    prior: f64,
    features: Vec<FeatureTable>,
}

/// A piecewise linear function of one feature, level beyond its ends.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct FeatureTable {
    name: String,
    /// Values of the feature, rising.
    knots: Vec<f64>,
    /// What each of them says.
    nats: Vec<f64>,
}

impl EvidenceModel {
    /// The model of facets.
    pub(crate) fn of_facets() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("facets.json")))
    }

    /// The model of lines.
    pub(crate) fn of_lines() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("lines.json")))
    }

    /// The model of lines in a finished roof model.
    pub(crate) fn of_model_lines() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("model_lines.json")))
    }

    /// The model of planes between parallel lines (W96 3.6).
    pub(crate) fn of_rectangles() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("rectangles.json")))
    }

    /// The model of buildings among the surfaces of dense matching.
    pub(crate) fn of_buildings() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("buildings.json")))
    }

    /// The model of vegetation among those surfaces that are no buildings.
    pub(crate) fn of_vegetation() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("vegetation.json")))
    }

    /// The model of roofs among the sites that a first look at a large area shows.
    pub(crate) fn of_sites() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("sites.json")))
    }

    /// The model of what stands on roofs among what hides them.
    pub(crate) fn of_obstructions() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("obstructions.json")))
    }

    /// The model of roofs among the facets that stand on another one.
    pub(crate) fn of_islands() -> &'static Self {
        static MODEL: OnceLock<EvidenceModel> = OnceLock::new();
        MODEL.get_or_init(|| Self::read(include_str!("islands.json")))
    }

    /// The name of a feature as the tables have it.
    fn feature_called(name: &str) -> Option<&'static str> {
        let known = [INSIDE_FOOTPRINT, POINT_CLOUD];
        if let Some(known) = known.into_iter().find(|known| *known == name) {
            return Some(known);
        }
        let models = [
            Self::of_sites(),
            Self::of_lines(),
            Self::of_model_lines(),
            Self::of_facets(),
            Self::of_rectangles(),
            Self::of_buildings(),
            Self::of_vegetation(),
            Self::of_obstructions(),
        ];
        let mut features = models.into_iter().flat_map(|model| &model.features);
        features.find_map(|table| (table.name == name).then_some(&*table.name))
    }

    fn read(json: &str) -> Self {
        serde_json::from_str(json).expect("the tables are part of the program")
    }

    /// The evidence for a candidate of which these features were measured: those of the model, in
    /// its order.
    pub(crate) fn weigh(&self, features: &[(&'static str, f64)]) -> Evidence {
        assert_eq!(
            features.len(),
            self.features.len(),
            "the features of the model"
        );
        let term = |(table, (feature, value)): (&FeatureTable, &(&'static str, f64))| {
            assert_eq!(table.name, *feature, "in the order of the model");
            EvidenceTerm {
                feature,
                value: *value,
                nats: table.at(*value),
            }
        };
        Evidence {
            prior: self.prior,
            terms: self.features.iter().zip(features).map(term).collect(),
        }
    }
}

impl FeatureTable {
    fn at(&self, value: f64) -> f64 {
        let last = self.knots.len() - 1;
        let above = self.knots.partition_point(|knot| *knot <= value);
        match above {
            0 => self.nats[0],
            above if above > last => self.nats[last],
            above => {
                let [from, to] = [self.knots[above - 1], self.knots[above]];
                let t = (value - from) / (to - from);
                (1.0 - t) * self.nats[above - 1] + t * self.nats[above]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planted() -> EvidenceModel {
        EvidenceModel::read(
            r#"{"source": "planted", "prior": -0.5, "features": [
                {"name": "a", "knots": [0, 1, 3], "nats": [-2, 0, 1]},
                {"name": "b", "knots": [0, 1], "nats": [0.5, -0.5]}]}"#,
        )
    }

    #[test]
    fn tables_are_linear_between_knots_and_level_beyond() {
        let model = planted();
        let at = |value| model.features[0].at(value);
        let expected = [
            (-9.0, -2.0),
            (0.0, -2.0),
            (0.25, -1.5),
            (1.0, 0.0),
            (2.0, 0.5),
            (7.0, 1.0),
        ];
        for (value, nats) in expected {
            assert!((at(value) - nats).abs() < 1e-12, "{value}");
        }
    }

    #[test]
    fn terms_add_up_to_the_odds() {
        let evidence = planted().weigh(&[("a", 3.0), ("b", 0.5)]);
        assert!((evidence.nats() - 0.5).abs() < 1e-12);
        let odds = evidence.probability() / (1.0 - evidence.probability());
        assert!((crate::base::math::ln(odds) - 0.5).abs() < 1e-9);
        assert!(evidence.accepts(0.0) && !evidence.accepts(1.0));
        let doubtful = planted().weigh(&[("a", 1.0), ("b", 0.5)]);
        assert!(!doubtful.accepts(0.0) && doubtful.accepts(-1e9));
    }

    #[test]
    #[should_panic(expected = "in the order of the model")]
    fn features_of_another_model_are_refused() {
        planted().weigh(&[("b", 0.5), ("a", 3.0)]);
    }

    #[test]
    fn tables_of_the_program_are_whole() {
        let models = [
            EvidenceModel::of_facets(),
            EvidenceModel::of_lines(),
            EvidenceModel::of_model_lines(),
            EvidenceModel::of_buildings(),
            EvidenceModel::of_vegetation(),
            EvidenceModel::of_obstructions(),
            EvidenceModel::of_islands(),
        ];
        for model in models {
            assert!(model.source.contains("seeds"), "{}", model.source);
            for table in &model.features {
                assert_eq!(table.knots.len(), table.nats.len());
                assert!(
                    table.knots.windows(2).all(|w| w[0] < w[1]),
                    "{}",
                    table.name
                );
                assert!(table.nats.iter().all(|nats| nats.is_finite()));
            }
        }
    }
}
