//! Codes of EPSG's registry by what they stand for: the plane of a compound system, one plane under
//! several numbers, transverse Mercator projections.
//!
//! The tables are generated (`tests/evaluation/reference_systems.py`). Looked at instead: `proj4rs`
//! with `crs-definitions` (a definition for every code takes 900 kB, one hundred times what these
//! take, and its elementary functions are those of the platform) and `geodesy` (no codes at all).

mod grids;
mod planes;
mod transverse_mercator;

pub(crate) use transverse_mercator::TransverseMercator;

use grids::{GRIDS, Grids};
use planes::{SAME, Same};

/// Longitude and latitude: what stands for them in all realisations of one datum.
pub(super) const GEOGRAPHIC: u32 = 4326;

/// The code that stands for all codes of the same plane: with another axis order, another height
/// beside it, another unit, or a datum that is a metre or two off. A code that stands for itself
/// alone is returned as it is.
pub(crate) fn plane_of(code: u32) -> u32 {
    let before = SAME.partition_point(|same| u32::from(same.0) <= code);
    let row = before.checked_sub(1).map(|i| &SAME[i]);
    match row {
        Some(Same(first, count, to, step)) if code < u32::from(*first) + u32::from(*count) => {
            u32::from(*to) + (code - u32::from(*first)) * u32::from(*step)
        }
        _ => code,
    }
}

/// Is it longitude and latitude, of a datum that counts as WGS84?
pub(crate) fn is_geographic(code: u32) -> bool {
    plane_of(code) == GEOGRAPHIC
}

impl TransverseMercator {
    /// The projection of a code, in metres; `None` for others than transverse Mercator on WGS84,
    /// ETRS89, NAD83 and their like. These count as one datum: they are a metre or two apart, and
    /// all of a scene alike.
    pub(crate) fn of_epsg(code: u32) -> Option<Self> {
        grid_of(code)
    }
}

/// The projection of a code, which returns metres whatever the unit of the code is.
fn grid_of(code: u32) -> Option<TransverseMercator> {
    let code = plane_of(code);
    let before = GRIDS.partition_point(|grids| u32::from(grids.0) <= code);
    let Grids(first, count, values, steps) = &GRIDS[before.checked_sub(1)?];
    let further = code - u32::from(*first);
    (further < u32::from(*count)).then(|| grid(values, steps, further))
}

/// The code that stands for a projection.
pub(super) fn code_of(wanted: &TransverseMercator) -> Option<u32> {
    let all = GRIDS.iter().flat_map(|Grids(first, count, values, steps)| {
        (0..u32::from(*count)).map(move |k| (u32::from(*first) + k, grid(values, steps, k)))
    });
    let fitting = all
        .filter(|(_, grid)| grid.is_near(wanted))
        .map(|(code, _)| code);
    // UTM of WGS84 is what a plane is called where it has several names.
    fitting.min_by_key(|code| (!(32_601..=32_760).contains(code), *code))
}

fn grid(
    &[lon, scale, east, north]: &[f64; 4],
    &[lon_step, east_step]: &[i32; 2],
    k: u32,
) -> TransverseMercator {
    let k = f64::from(k);
    TransverseMercator {
        central_meridian_deg: lon + k * f64::from(lon_step),
        scale,
        false_easting_m: east + k * f64::from(east_step),
        equator_m: north,
    }
}
