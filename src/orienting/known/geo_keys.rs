//! Keys of GeoTIFF (OGC 19-008), which LAS files have too: the coordinate system by its code.

use super::system::{StatedPlan, StatedSystem};
use crate::orienting::orientation::{LinearUnit, height_unit_of_code};

/// Numbers of the keys.
const MODEL_TYPE: u64 = 1024;
const GEODETIC_CRS: u64 = 2048;
const PROJECTED_CRS: u64 = 3072;
const PROJECTED_UNITS: u64 = 3076;
const VERTICAL_CRS: u64 = 4096;
const VERTICAL_UNITS: u64 = 4099;

/// Codes from here on stand for what the file defines by itself.
const USER_DEFINED: u64 = 32_767;

/// The system that keys state; otherwise why its units are not known.
pub(super) fn stated(key: impl Fn(u64) -> Option<u64>) -> Result<StatedSystem, String> {
    let code = |wanted: u64| {
        let code = key(wanted).filter(|code| (1..USER_DEFINED).contains(code))?;
        u32::try_from(code).ok()
    };
    let unit = |wanted: u64, what: &str| match code(wanted) {
        None => Ok(None),
        Some(code) => unit_of(code).map(Some).ok_or_else(|| {
            format!("its {what} are not in metres, but in a unit that is not read (EPSG:{code})")
        }),
    };
    let is_geographic = key(MODEL_TYPE) == Some(2);
    let mut stated = StatedSystem::from(match (code(PROJECTED_CRS), code(GEODETIC_CRS)) {
        (Some(code), _) => StatedPlan::Code(code),
        (None, Some(code)) if is_geographic => StatedPlan::Code(code),
        _ if is_geographic => StatedPlan::LongitudeLatitude,
        _ => StatedPlan::Unstated,
    });
    if let Some(unit) = unit(PROJECTED_UNITS, "coordinates")? {
        stated.plan_unit_m = unit.metres;
        stated.height_unit_m = unit.metres;
    }
    // NAVD88 in feet often has the code of NAVD88 in metres beside its unit.
    let of_heights = || code(VERTICAL_CRS).and_then(height_unit_of_code);
    if let Some(unit) = unit(VERTICAL_UNITS, "heights")?.or_else(of_heights) {
        stated.height_unit_m = unit.metres;
    }
    Ok(stated)
}

/// The unit of lengths of EPSG's code of one.
fn unit_of(code: u32) -> Option<LinearUnit> {
    let metres = match code {
        9001 => 1.0,
        9002 => 0.3048,
        9003 => return Some(LinearUnit::US_FOOT),
        9005 => 0.304_797_265_4,
        9036 => 1000.0,
        1025 => 0.001,
        1033 => 0.01,
        _ => return None,
    };
    LinearUnit::of_metres(metres)
}

/// The number of a key, where it stands in the directory of keys itself.
pub(super) fn value(keys: &[u64], wanted: u64) -> Option<u64> {
    let mut entries = keys.get(4..)?.chunks_exact(4);
    let entry = entries.find(|entry| entry[0] == wanted && entry[1] == 0)?;
    Some(entry[3])
}
