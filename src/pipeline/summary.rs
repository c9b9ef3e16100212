//! What a stage found, in numbers and warnings that a person reads.

use serde::{Serialize, Serializer};

use super::Stage;

/// The outcome of one stage in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct StageSummary {
    /// The stage.
    #[cfg_attr(target_arch = "wasm32", tsify(type = "string"))]
    pub stage: Stage,
    /// What it counted, by name; the most important first.
    #[serde(serialize_with = "as_map")]
    #[cfg_attr(target_arch = "wasm32", tsify(type = "Record<string, number>"))]
    pub counts: Vec<(&'static str, usize)>,
    /// What the user should know; each says what to do.
    pub warnings: Vec<String>,
}

/// An object whose members keep their order.
fn as_map<S: Serializer>(
    counts: &[(&'static str, usize)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(counts.iter().copied())
}
