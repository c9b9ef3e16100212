//! What a colour that differs from that of the other views says of a surface.

use std::sync::OnceLock;

use serde::Deserialize;

use super::FeatureTable;
use crate::base::math::hypot;

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
    /// How far heights are off that seem to be known to the millimetre, metres.
    height_floor_m: f64,
    /// By how much more than it seems heights are off.
    height_scale: f64,
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

    /// Standard deviation of a height that seems to be known so well, metres.
    pub(crate) fn inflated(&self, seeming_m: f64) -> f64 {
        hypot(self.height_scale * seeming_m, self.height_floor_m)
    }

    /// How much likelier something hides a surface of which a view differs so much, nats.
    pub(crate) fn nats(&self, difference: f64) -> f64 {
        self.difference.at(difference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_height_is_known_no_better_than_the_floor_and_no_better_than_it_seems() {
        let table = HidingTable::fitted();
        assert_eq!(table.inflated(0.0), table.height_floor_m);
        for seeming_m in [0.05, 0.5, 5.0] {
            let inflated = table.inflated(seeming_m);
            assert!(inflated > table.height_floor_m && inflated > table.height_scale * seeming_m);
        }
    }

    #[test]
    fn what_differs_more_speaks_more_for_something_before_it() {
        let table = HidingTable::fitted();
        assert!(table.nats(0.1) < 0.0 && table.nats(20.0) > 1.0);
    }
}
