//! Parameters of footprints as evidence.

use serde::{Deserialize, Serialize};

/// How often a register of buildings is right, and how it is drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct RegisterParams {
    /// Probability that a register that is given belongs to the place, before the images are
    /// compared with it. Assumption.
    pub belongs: f64,
    /// Share of the roofs that stand in it. Assumption: sheds and new buildings are missing.
    pub completeness: f64,
    /// Share of the ground that it calls built on. Assumption: yards that are drawn over, and
    /// buildings that are gone.
    pub built_in_error: f64,
    /// Share of the false facets that lie outside of its footprints: on trees and ground. Measured:
    /// 20 of 39 that were in doubt in twelve fitting scenes; the others are wrong planes of roofs.
    pub outside_wrong: f64,
    /// Parts of a building are drawn or left out as wholes of this area, square metres. Assumption:
    /// an annex or a garage.
    pub part_m2: f64,
    /// So far roofs reach beyond the walls, metres, and the standard deviation of that. Assumption.
    pub overhang_m: f64,
    /// Standard deviation of the overhang, metres. Assumption.
    pub overhang_sigma_m: f64,
    /// Without a register an outline may lie anywhere within this range, metres. Assumption: half
    /// the width of a building to both sides.
    pub border_range_m: f64,
    /// Sides of a footprint err as wholes of this length, metres. Assumption: half a side.
    pub border_part_m: f64,
}

impl Default for RegisterParams {
    fn default() -> Self {
        Self {
            belongs: 0.95,
            completeness: 0.95,
            built_in_error: 0.02,
            outside_wrong: 0.5,
            part_m2: 25.0,
            overhang_m: 0.3,
            overhang_sigma_m: 0.3,
            border_range_m: 10.0,
            border_part_m: 5.0,
        }
    }
}
