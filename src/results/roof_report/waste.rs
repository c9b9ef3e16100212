//! How much more covering is bought than a roof has, by its hips and valleys: a table that is data.

use serde::Deserialize;

/// What is added for cut-offs.
#[derive(Clone, Debug, Deserialize)]
pub struct WasteTable {
    /// Where its numbers come from, and why.
    pub source: String,
    /// Additions that are listed, percent.
    pub percents: Vec<u32>,
    classes: Vec<WasteClass>,
}

/// Roofs with so many hips and valleys.
#[derive(Clone, Debug, Deserialize)]
pub struct WasteClass {
    /// Their length on a square metre of roof at most, metres; `None` for any.
    up_to_m_per_m2: Option<f64>,
    /// What is added to the area, percent; one of those that are listed.
    pub percent: u32,
    /// What the roofs are, in words.
    pub words: String,
}

impl WasteTable {
    /// The table that comes with the program.
    pub fn built_in() -> Self {
        crate::base::json::read(include_str!("waste.json")).expect("the program's table reads")
    }

    /// The class of a roof with so much hip and valley on a square metre, metres.
    pub fn class_of(&self, cut_m_per_m2: f64) -> &WasteClass {
        let holds =
            |class: &&WasteClass| class.up_to_m_per_m2.is_none_or(|most| cut_m_per_m2 <= most);
        (self.classes.iter().find(holds)).expect("the last class holds any roof")
    }
}
