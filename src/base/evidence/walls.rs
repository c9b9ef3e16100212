//! What windows on a wall, and on the ground before it, say about where the wall stands.

use std::sync::OnceLock;

use serde::Deserialize;

use super::windows::WindowEvidenceTable;

/// Logarithms of likelihood ratios of windows below an eave, and how deep behind it walls stand.
pub(crate) struct WallEvidence {
    /// Of windows that are claimed to show a wall.
    pub wall: WindowEvidenceTable,
    /// Of windows that are claimed to show the ground below the roof.
    pub ground: WindowEvidenceTable,
    /// Share of the windows that count as independent.
    pub independent: f64,
    /// The depths behind the eave that are weighed, metres, rising in equal steps, with the
    /// logarithm of the probability of each before anything is seen.
    pub prior: Vec<(f64, f64)>,
}

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fitted {
    /// How the tables came about.
    #[allow(dead_code)] // For those who read the file.
    source: String,
    independent: f64,
    weights: Vec<f64>,
    correlations: Vec<f64>,
    wall: Vec<Vec<f64>>,
    ground: Vec<Vec<f64>>,
    first_depth: f64,
    depth_step: f64,
    prior: Vec<f64>,
}

impl WallEvidence {
    /// The tables of the program.
    pub(crate) fn fitted() -> &'static Self {
        static TABLES: OnceLock<WallEvidence> = OnceLock::new();
        TABLES.get_or_init(|| {
            let fitted: Fitted = serde_json::from_str(include_str!("walls.json"))
                .expect("the tables are part of the program");
            let knots = (&fitted.weights[..], &fitted.correlations[..]);
            let depth = |i: usize| fitted.first_depth + i as f64 * fitted.depth_step;
            Self {
                wall: WindowEvidenceTable::between(knots, &fitted.wall, 0.0),
                ground: WindowEvidenceTable::between(knots, &fitted.ground, 0.0),
                independent: fitted.independent,
                prior: (fitted.prior.iter().enumerate())
                    .map(|(i, p)| (depth(i), *p))
                    .collect(),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_and_ground_that_correlate_speak_for_their_depth() {
        let fitted = WallEvidence::fitted();
        for table in [&fitted.wall, &fitted.ground] {
            assert!(table.nats_of(0.99, 0.95) > 0.5 && table.nats_of(0.99, 0.2) < -0.5);
            assert_eq!(table.nats_of(0.0, 0.95), 0.0, "no texture");
        }
        let total: f64 = (fitted.prior.iter())
            .map(|(_, ln)| crate::base::math::exp(*ln))
            .sum();
        assert!((total - 1.0).abs() < 0.02, "{total}");
        assert!(fitted.prior.windows(2).all(|d| d[0].0 < d[1].0));
    }
}
