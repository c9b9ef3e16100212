//! Units that well-known text and PROJ texts state themselves.

use super::unit::{LinearUnit, PlanUnit};
use crate::orienting::orientation::well_known::{proj_value, unit_of_first};

/// Systems of maps and of heights.
const MAPS: [&str; 5] = ["PROJCS", "PROJCRS", "PROJECTEDCRS", "LOCAL_CS", "ENGCRS"];
const VERTICALS: [&str; 4] = ["VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"];

/// Units in plan and of heights that a text of any kind states.
pub(super) fn stated(text: &str) -> (Option<PlanUnit>, Option<LinearUnit>) {
    if text.contains('[') {
        let unit = |systems: &[&str]| LinearUnit::of_metres(unit_of_first(text, systems)?);
        (unit(&MAPS).map(PlanUnit::Length), unit(&VERTICALS))
    } else if text.contains("+proj=") {
        of_proj(text)
    } else {
        (None, None)
    }
}

/// PROJ: `+units=us-ft` or `+to_meter=0.3048`, of heights `+vunits=`, `+vto_meter=`.
fn of_proj(text: &str) -> (Option<PlanUnit>, Option<LinearUnit>) {
    // PROJ allows fractions.
    let factor = |key: &str| {
        let (over, under) = proj_value(text, key).map(|v| v.split_once('/').unwrap_or((v, "1")))?;
        LinearUnit::of_metres(over.parse::<f64>().ok()? / under.parse::<f64>().ok()?)
    };
    let unit = |word: &str, key: &str| {
        factor(key).or_else(|| LinearUnit::of_name(proj_value(text, word)?))
    };
    let is_stated = ["units", "to_meter"]
        .iter()
        .any(|key| proj_value(text, key).is_some());
    let plan = match proj_value(text, "proj") {
        Some("longlat" | "latlong" | "lonlat" | "latlon") => Some(PlanUnit::Angle(1.0)),
        Some("geocent" | "cart") => Some(PlanUnit::Geocentric),
        _ if !is_stated => Some(PlanUnit::Length(LinearUnit::METRE)),
        // A unit that is not known is none.
        _ => unit("units", "to_meter").map(PlanUnit::Length),
    };
    (plan, plan.and(unit("vunits", "vto_meter")))
}
