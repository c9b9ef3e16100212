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

/// "1 view", "6 views": the counted things are named by their plural, as in `counts`.
pub fn counted(count: usize, plural: &str) -> String {
    match (count, plural) {
        (1, "pairs of directions") => "1 pair of directions".to_owned(),
        (1, "pairs of lines") => "1 pair of lines".to_owned(),
        (1, "matches") => "1 match".to_owned(),
        (1, _) => format!("1 {}", plural.strip_suffix('s').unwrap_or(plural)),
        _ => format!("{count} {plural}"),
    }
}

/// An object whose members keep their order.
fn as_map<S: Serializer>(
    counts: &[(&'static str, usize)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(counts.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_is_counted_in_the_singular() {
        let one = |plural| counted(1, plural);
        assert_eq!(one("half-planes"), "1 half-plane");
        assert_eq!(one("pairs of directions"), "1 pair of directions");
        assert_eq!(one("matches"), "1 match");
        assert_eq!(counted(0, "lines"), "0 lines");
    }
}
