//! What the correlation of a window says about a plane.

use std::sync::OnceLock;

use serde::Deserialize;

/// ln p(correlation | on the plane) - ln p(correlation | beside it), by the texture weight of the
/// window, and the odds before the images are compared. Without texture both are alike; the more of
/// it there is, the more a true plane correlates, and the more a moderate correlation speaks
/// against it.
pub(crate) struct WindowEvidenceTable {
    /// Row by row for each weight in steps of 1 / 255, for correlations in steps of 1 / 127 from
    /// -1.
    nats: Vec<f32>,
    /// Logarithm of the odds that a plane covers a position within reach of its lines, before its
    /// images are compared; it counts in proportion to the weight, as they do.
    pub prior: f64,
}

/// The fitted table: linear between its knots, level beyond.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fitted {
    /// How the table came about.
    #[allow(dead_code)] // For those who read the file.
    source: String,
    /// Texture weights, rising.
    weights: Vec<f64>,
    /// Correlations, rising.
    correlations: Vec<f64>,
    /// For each weight, at each correlation.
    nats: Vec<Vec<f64>>,
    prior: f64,
}

/// Number of values of a correlation in a byte.
const CORRELATIONS: usize = 255;

impl WindowEvidenceTable {
    /// The table of the program.
    pub(crate) fn fitted() -> &'static Self {
        static TABLE: OnceLock<WindowEvidenceTable> = OnceLock::new();
        TABLE.get_or_init(|| {
            let fitted: Fitted = serde_json::from_str(include_str!("windows.json"))
                .expect("the table is part of the program");
            let knots = (&fitted.weights[..], &fitted.correlations[..]);
            Self::between(knots, &fitted.nats, fitted.prior)
        })
    }

    /// From the nats at each of some weights (rising) and, for each, of some correlations (rising).
    pub(super) fn between(
        (weights, correlations): (&[f64], &[f64]),
        nats: &[Vec<f64>],
        prior: f64,
    ) -> Self {
        let at = |weight: f64, correlation: f64| {
            let (row, s) = place(weights, weight);
            let (column, t) = place(correlations, correlation);
            let along = |row: &[f64]| (1.0 - t) * row[column] + t * row[column + 1];
            (1.0 - s) * along(&nats[row]) + s * along(&nats[row + 1])
        };
        let bytes = (0..=u8::MAX).map(|w| f64::from(w) / 255.0);
        let steps = || (0..CORRELATIONS).map(|c| c as f64 / 127.0 - 1.0);
        let nats = bytes.flat_map(|w| steps().map(move |c| at(w, c) as f32));
        Self {
            nats: nats.collect(),
            prior,
        }
    }

    /// [`Self::nats`] of a weight from 0 to 1 and a correlation from -1 to 1.
    pub(crate) fn nats_of(&self, weight: f32, correlation: f32) -> f64 {
        self.nats(
            (weight * 255.0).round() as u8,
            (correlation * 127.0).round() as i8,
        )
    }

    /// What the images of a window say, nats: its texture weight in steps of 1 / 255, its
    /// correlation in steps of 1 / 127.
    pub(crate) fn nats(&self, weight: u8, correlation: i8) -> f64 {
        let column = usize::try_from(i32::from(correlation) + 127).unwrap_or(0);
        f64::from(self.nats[usize::from(weight) * CORRELATIONS + column])
    }
}

/// The knot before a value and the share of the way to the next.
fn place(knots: &[f64], value: f64) -> (usize, f64) {
    let last = knots.len() - 2;
    let above = knots.partition_point(|knot| *knot <= value);
    let before = above.saturating_sub(1).min(last);
    let t = (value - knots[before]) / (knots[before + 1] - knots[before]);
    (before, t.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_correlates_more_speaks_more_for_a_plane_and_plain_windows_say_little() {
        let table = WindowEvidenceTable::fitted();
        for weight in [100, 180, 230, 255] {
            let says: Vec<f64> = (20..=120).map(|c| table.nats(weight, c)).collect();
            assert!(says.windows(2).all(|w| w[1] >= w[0]), "{weight}");
        }
        let strength = |weight: u8| table.nats(weight, 100) - table.nats(weight, 20);
        assert!(strength(246) > 2.0 * strength(100));
        assert_eq!(table.nats(0, 100), 0.0, "no texture");
    }

    #[test]
    fn a_planted_table_is_linear_between_its_knots() {
        let nats = [vec![0.0, 0.0], vec![-2.0, 2.0]];
        let table = WindowEvidenceTable::between((&[0.0, 1.0], &[0.0, 1.0]), &nats, 0.5);
        assert!((table.nats(255, 127) - 2.0).abs() < 1e-6);
        assert!((table.nats(255, -50) + 2.0).abs() < 1e-6);
        assert!((table.nats(51, 127) - 0.4).abs() < 1e-6);
        assert!(table.nats(51, -128) < 0.0, "the least of a byte");
    }
}
