//! What a colour that differs from that of the other views says of a surface.

use std::sync::OnceLock;

use serde::Deserialize;

use super::FeatureTable;

/// How often colours differ by so much where a surface is seen, and where something hides it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct HidingTable {
    /// How the table came about.
    #[allow(dead_code)] // For those who read the file.
    source: String,
    /// Share of the cells that say something of their own: neighbours share their errors.
    pub independent: f64,
    /// What a difference says, in standard deviations.
    difference: FeatureTable,
}

impl HidingTable {
    /// The table of the program.
    pub(crate) fn fitted() -> &'static Self {
        static TABLE: OnceLock<HidingTable> = OnceLock::new();
        TABLE.get_or_init(|| {
            let fitted = serde_json::from_str(include_str!("hiding.json"));
            fitted.expect("the table is part of the program")
        })
    }

    /// How much likelier something hides a surface of which a view differs so much, nats.
    pub(crate) fn nats(&self, difference: f64) -> f64 {
        self.difference.at(difference)
    }
}
