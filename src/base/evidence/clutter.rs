//! What stands on roofs: parapets, vents, skylights, and why it rises above them.
//!
//! The views of a window inside a roof agree best at the height of what it shows. On most of a roof
//! that is the roof; on a share of it something stands, and never lower. So a roof is not where the
//! views agree best in the mean but where they agree with no more above than stands on roofs, and
//! hardly anything below.

use std::sync::OnceLock;

use serde::Deserialize;

/// How the heights at which the views agree lie about a roof.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ClutterTable {
    /// How the table came about.
    #[allow(dead_code)] // For those who read the file.
    source: String,
    /// Pixels of a window, in one view, whose differences from the others are independent.
    pub pixels: f64,
    /// Share of the windows that show something standing on the roof.
    above: f64,
    /// Share of the windows that show something else.
    elsewhere: f64,
    /// What stands on a roof rises at most so high, metres.
    pub highest_m: f64,
    /// Share of the roofs without a neighbour whose edges are those of a rim above them.
    rims: f64,
}

impl ClutterTable {
    /// The table of the program.
    pub(crate) fn fitted() -> &'static Self {
        static TABLE: OnceLock<ClutterTable> = OnceLock::new();
        TABLE.get_or_init(|| {
            let fitted = serde_json::from_str(include_str!("clutter.json"));
            fitted.expect("the table is part of the program")
        })
    }

    /// What the correlation of a window says of a height, nats: the Gaussian likelihood of two
    /// signals that agree so well, over that of two which do not agree, in so many views.
    pub(crate) fn nats_of_height(&self, correlation: f32, views: usize) -> f64 {
        let alike = f64::from(correlation.clamp(0.0, 0.99));
        -0.5 * self.pixels * views as f64 * crate::base::math::ln(1.0 - alike * alike)
    }

    /// What a window says of a roof, nats, from the likelihoods of the heights relative to their
    /// mean: that of the roof, and the mean of those above it that clutter reaches.
    pub(crate) fn nats_of_roof(&self, at: f64, above: f64) -> f64 {
        let on = 1.0 - self.above - self.elsewhere;
        crate::base::math::ln(on * at + self.above * above + self.elsewhere)
    }

    /// Logarithm of the odds that a roof lies at one of so many heights below its edges, before the
    /// views are compared.
    pub(crate) fn prior_of_rim(&self, heights: usize) -> f64 {
        crate::base::math::ln(self.rims / (1.0 - self.rims) / heights as f64)
    }
}
