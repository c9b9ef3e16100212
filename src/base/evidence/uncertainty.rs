//! How well a stated standard deviation tells real errors.

use std::sync::OnceLock;

use serde::Deserialize;

use crate::base::math::hypot;

/// What the covariance of an adjustment leaves out: edges that are not where they seem, and the
/// orientation, by which all of a scene is off alike.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct UncertaintyTable {
    /// How the table came about.
    #[allow(dead_code)] // For those who read the file.
    source: String,
    /// Of a facet's height in its middle.
    pub height: Inflation,
    /// Of a facet's slope; its unit is the angle of a ground pixel over the facet's size.
    pub slope: Inflation,
    /// Of x and y of a corner.
    pub corner_plan: Inflation,
    /// Of the height of a corner.
    pub corner_height: Inflation,
    /// Of the place of a side across it in plan, by what it rests on.
    pub sides: SideInflations,
}

/// Of sides by what their place rests on.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SideInflations {
    /// Image edges in three photographs and more.
    pub edges: Inflation,
    /// Image edges in one or two.
    pub few_edges: Inflation,
    /// The planes of two facets that meet there.
    pub planes: Inflation,
    /// None of these.
    pub nothing: Inflation,
}

/// `sigma'^2 = (scale sigma)^2 + (floor_px u)^2`, u a ground pixel in the unit of sigma.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Inflation {
    scale: f64,
    floor_px: f64,
}

impl UncertaintyTable {
    /// The table of the program.
    pub(crate) fn fitted() -> &'static Self {
        static TABLE: OnceLock<UncertaintyTable> = OnceLock::new();
        TABLE.get_or_init(|| {
            let fitted = serde_json::from_str(include_str!("uncertainty.json"));
            fitted.expect("the table is part of the program")
        })
    }
}

#[cfg(test)]
impl UncertaintyTable {
    /// What an adjustment says is stated as it is.
    pub(crate) fn as_adjusted() -> Self {
        let none = Inflation {
            scale: 1.0,
            floor_px: 0.0,
        };
        Self {
            source: String::new(),
            height: none,
            slope: none,
            corner_plan: none,
            corner_height: none,
            sides: SideInflations {
                edges: none,
                few_edges: none,
                planes: none,
                nothing: none,
            },
        }
    }
}

impl Inflation {
    /// The standard deviation to state for that of an adjustment.
    pub(crate) fn of(&self, sigma: f64, pixel: f64) -> f64 {
        hypot(self.scale * sigma, self.floor_px * pixel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_and_floor_add_as_variances() {
        let inflation = Inflation {
            scale: 2.0,
            floor_px: 0.5,
        };
        assert!((inflation.of(1.5, 8.0) - 5.0).abs() < 1e-12);
        let table = UncertaintyTable::fitted();
        assert!(table.source.contains("seeds"));
        assert!(table.height.of(0.01, 0.1) >= 0.01, "never more certain");
    }
}
