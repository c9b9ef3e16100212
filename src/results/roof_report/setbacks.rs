//! What is kept clear along the edges of a roof, by what they are: rules that are data.
//!
//! A rule file is JSON: `name`, `title`, `source`, `setbacks_m` (metres on the face, by the name of
//! the kind of edge; none where a kind is not named), `above_slope` (rise per metre up to which
//! faces are exempt; 0 if not given), `obstruction_m` (around what stands on a face; 0 if not
//! given).

use std::collections::BTreeMap;

use serde::Deserialize;

use super::edges::RoofEdgeKind;

const BUILT_IN: [&str; 4] = [
    include_str!("setbacks/none.json"),
    include_str!("setbacks/ifc-1205.json"),
    include_str!("setbacks/ifc-1205-large.json"),
    include_str!("setbacks/mbo-32.json"),
];

/// How far from its edges a face is kept clear.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct SetbackRule {
    /// Its name in files.
    pub name: String,
    /// What it is, in words.
    #[serde(default)]
    pub title: String,
    /// Where its numbers come from.
    #[serde(default)]
    pub source: String,
    /// Faces that rise by no more per metre in plan are exempt.
    #[serde(default)]
    pub above_slope: f64,
    /// Around what stands on a face, metres in plan.
    #[serde(default)]
    pub obstruction_m: f64,
    /// By kind of edge, metres on the face.
    pub setbacks_m: BTreeMap<RoofEdgeKind, f64>,
}

impl SetbackRule {
    /// The rules that come with the program; the first one keeps nothing clear.
    pub fn built_in() -> Vec<Self> {
        let read = |text: &&str| Self::read(text).expect("rules of the program read");
        BUILT_IN.iter().map(read).collect()
    }

    /// These and one's own, which takes the place of one of the same name.
    pub fn with(own: &str) -> Result<Vec<Self>, String> {
        let own = Self::read(own)?;
        let mut rules = Self::built_in();
        rules.retain(|rule| rule.name != own.name);
        rules.push(own);
        Ok(rules)
    }

    /// Reads a rule file; an error says what was expected.
    pub fn read(text: &str) -> Result<Self, String> {
        let rule: Self = crate::base::json::read(text)
            .map_err(|problem| format!("is no rule of setbacks: {problem}"))?;
        let is_setback = |m: &f64| m.is_finite() && *m >= 0.0;
        let others = [rule.above_slope, rule.obstruction_m];
        if !rule.setbacks_m.values().chain(&others).all(is_setback) {
            return Err("is no rule of setbacks: its numbers are 0 or more".into());
        }
        Ok(rule)
    }

    /// The setback of an edge on a face that rises by so much per metre, metres.
    pub(super) fn of(&self, kind: RoofEdgeKind, slope: f64) -> f64 {
        let setback = self.setbacks_m.get(&kind).copied().unwrap_or(0.0);
        self.unless_exempt(setback, slope)
    }

    /// The margin of what stands on a face that rises by so much per metre, metres.
    pub(super) fn around_obstructions(&self, slope: f64) -> f64 {
        self.unless_exempt(self.obstruction_m, slope)
    }

    fn unless_exempt(&self, setback: f64, slope: f64) -> f64 {
        match slope > self.above_slope || self.above_slope == 0.0 {
            true => setback,
            false => 0.0,
        }
    }
}
