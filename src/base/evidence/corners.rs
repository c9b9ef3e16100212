//! Corners of roofs: how often an outline turns, and by what angle.

use std::sync::OnceLock;

use serde::Deserialize;

use crate::base::math::normal_density;

/// The corners of outlines in plan.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CornerTable {
    /// How the table came about.
    #[allow(dead_code)] // For those who read the file.
    source: String,
    /// Corners on a metre of outline.
    per_m: f64,
    /// Turns that are frequent.
    turns: Vec<FrequentTurn>,
    /// Share of the corners that turn by any other angle.
    others: f64,
    /// Standard deviation of the turn between two sides that are found, degrees.
    sigma_deg: f64,
    /// How much what outlines look like counts beside the nats of windows and borders.
    weight: f64,
}

/// An angle by which many outlines turn.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrequentTurn {
    degrees: f64,
    /// Share of the corners that turn by it.
    share: f64,
}

impl CornerTable {
    /// The table of the program.
    pub(crate) fn fitted() -> &'static Self {
        static TABLE: OnceLock<CornerTable> = OnceLock::new();
        TABLE.get_or_init(|| {
            let fitted = serde_json::from_str(include_str!("corners.json"));
            fitted.expect("the table is part of the program")
        })
    }

    /// What it costs that an outline turns by an angle (0 to 180 degrees) at a place that can be
    /// told from the next one by `place_m`, nats: 0 where it goes straight on. The density of the
    /// turn is a mixture of outlines that go straight on, of frequent turns, and of any.
    pub(crate) fn cost(&self, degrees: f64, place_m: f64) -> f64 {
        let corner = (self.per_m * place_m).min(0.5);
        let near = |degrees: f64| normal_density(degrees, self.sigma_deg);
        let density = |degrees: f64| {
            let frequent = self
                .turns
                .iter()
                .map(|t| t.share * near(degrees - t.degrees));
            let turns = frequent.sum::<f64>() + self.others / 180.0;
            (1.0 - corner) * near(degrees) + corner * turns
        };
        self.weight * crate::base::math::ln(density(0.0) / density(degrees))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_angles_cost_less_than_others_and_straight_ways_nothing() {
        let table = CornerTable::fitted();
        let cost = |degrees: f64| table.cost(degrees, 0.25);
        assert!(cost(0.0).abs() < 1e-6);
        let [right, hip, other] = [90.0, 45.0, 70.0].map(cost);
        assert!(
            0.0 < right && right < hip && hip < other,
            "{right} {hip} {other}"
        );
        // A right angle that was found some degrees askew is one.
        assert!(cost(93.0) < 0.5 * (right + other));
        // The sharper places are told apart, the less does chance put a corner on one.
        assert!(table.cost(90.0, 0.1) > right);
    }

    #[test]
    fn shares_are_those_of_all_corners() {
        let table = CornerTable::fitted();
        let frequent: f64 = table.turns.iter().map(|t| t.share).sum();
        assert!((frequent + table.others - 1.0).abs() < 0.005);
    }
}
