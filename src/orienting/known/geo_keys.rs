//! Keys of GeoTIFF (OGC 19-008), which LAS files have too: the coordinate system by its code.

use super::system::StatedSystem;

/// Numbers of the keys.
const MODEL_TYPE: u64 = 1024;
const GEODETIC_CRS: u64 = 2048;
const PROJECTED_CRS: u64 = 3072;
const PROJECTED_UNITS: u64 = 3076;
const VERTICAL_UNITS: u64 = 4099;

/// EPSG's number of the metre.
const METRE: u64 = 9001;
/// Codes from here on stand for what the file defines by itself.
const USER_DEFINED: u64 = 32_767;

/// The system that keys state; otherwise why its coordinates are none in metres.
pub(super) fn stated(key: impl Fn(u64) -> Option<u64>) -> Result<StatedSystem, String> {
    for (units, what) in [
        (PROJECTED_UNITS, "coordinates"),
        (VERTICAL_UNITS, "heights"),
    ] {
        if key(units).is_some_and(|unit| unit != METRE && unit < USER_DEFINED) {
            return Err(format!("its {what} are not in metres"));
        }
    }
    let code = |key: Option<u64>| key.filter(|c| *c < USER_DEFINED).map(|c| c as u32);
    let is_geographic = key(MODEL_TYPE) == Some(2);
    Ok(match (code(key(PROJECTED_CRS)), code(key(GEODETIC_CRS))) {
        (Some(code), _) => StatedSystem::Code(code),
        (None, Some(code)) if is_geographic => StatedSystem::Code(code),
        _ if is_geographic => StatedSystem::LongitudeLatitude,
        _ => StatedSystem::Unstated,
    })
}

/// The number of a key, where it stands in the directory of keys itself.
pub(super) fn value(keys: &[u64], wanted: u64) -> Option<u64> {
    let mut entries = keys.get(4..)?.chunks_exact(4);
    let entry = entries.find(|entry| entry[0] == wanted && entry[1] == 0)?;
    Some(entry[3])
}
