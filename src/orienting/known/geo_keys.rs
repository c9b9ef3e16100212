//! Keys of GeoTIFF (OGC 19-008), which LAS files have too: the coordinate system by its code, else
//! by the text that cites it.

use super::system::{StatedPlan, StatedSystem};
use crate::orienting::orientation::{LinearUnit, epsg_of, height_unit_of_code};

/// Numbers of the keys.
#[derive(Clone, Copy)]
enum Key {
    ModelType = 1024,
    RasterType = 1025,
    Citation = 1026,
    GeodeticCrs = 2048,
    ProjectedCrs = 3072,
    ProjectedCitation = 3073,
    ProjectedUnits = 3076,
    VerticalCrs = 4096,
    VerticalUnits = 4099,
}

/// Codes from here on stand for what the file defines by itself.
const USER_DEFINED: u64 = 32_767;

/// The directory of keys, and the texts that it refers to.
pub(super) struct GeoKeys<'a> {
    pub directory: &'a [u64],
    pub texts: &'a [u8],
}

/// The tag, and the number of the record, of these texts.
pub(super) const TEXTS: u16 = 34_737;

impl GeoKeys<'_> {
    fn entry(&self, wanted: Key) -> Option<&[u64]> {
        let mut entries = self.directory.get(4..)?.chunks_exact(4);
        entries.find(|entry| entry[0] == wanted as u64)
    }

    /// The number of a key, where it stands in the directory itself.
    fn value(&self, wanted: Key) -> Option<u64> {
        let entry = self.entry(wanted)?;
        (entry[1] == 0).then_some(entry[3])
    }

    fn text(&self, wanted: Key) -> Option<String> {
        let entry = self.entry(wanted).filter(|e| e[1] == u64::from(TEXTS))?;
        let [first, count] = [entry[3], entry[2]].map(|v| usize::try_from(v).unwrap_or(usize::MAX));
        let text = self.texts.get(first..first.checked_add(count)?)?;
        let text = String::from_utf8_lossy(text);
        let text = text.trim_matches(['|', '\0', ' ']);
        (!text.is_empty()).then(|| text.to_owned())
    }

    /// Are coordinates of the centre of a cell rather than of its corner?
    pub(super) fn is_of_centres(&self) -> bool {
        self.value(Key::RasterType) == Some(2)
    }
}

/// The system that keys state; otherwise why its units are not known.
pub(super) fn stated(keys: &GeoKeys) -> Result<StatedSystem, String> {
    let code = |wanted: Key| {
        let code = keys
            .value(wanted)
            .filter(|code| (1..USER_DEFINED).contains(code))?;
        u32::try_from(code).ok()
    };
    let unit = |wanted: Key, what: &str| match keys.value(wanted) {
        None | Some(0) => Ok(None),
        Some(code) => unit_of(code).map(Some).ok_or_else(|| {
            format!("its {what} are not in metres, but in a unit that is not read (EPSG:{code})")
        }),
    };
    let is_geographic = match keys.value(Key::ModelType) {
        Some(kind) => kind == 2,
        None => keys.value(Key::ProjectedCrs).is_none() && code(Key::GeodeticCrs).is_some(),
    };
    let mut texts = [Key::ProjectedCitation, Key::Citation]
        .into_iter()
        .filter_map(|key| keys.text(key));
    let mut stated = match (code(Key::ProjectedCrs), code(Key::GeodeticCrs)) {
        (Some(code), _) => StatedPlan::Code(code).into(),
        (None, Some(code)) if is_geographic => StatedPlan::Code(code).into(),
        _ if is_geographic => StatedSystem::longitude_latitude(),
        // What the file defines by itself has a name, which may be that of a known system.
        _ if keys.value(Key::ProjectedCrs).is_some() => {
            let known = texts.clone().find(|text| epsg_of(text).is_some());
            let name = known
                .or_else(|| texts.next())
                .unwrap_or_else(|| "of its own".to_owned());
            StatedSystem::named(&name)
        }
        _ => StatedSystem::unstated(),
    };
    if let Some(unit) = unit(Key::ProjectedUnits, "coordinates")? {
        stated.plan_unit_m = unit.metres;
        stated.height_unit_m = unit.metres;
    }
    // NAVD88 in feet often has the code of NAVD88 in metres beside its unit.
    let of_heights = || code(Key::VerticalCrs).and_then(height_unit_of_code);
    if let Some(unit) = unit(Key::VerticalUnits, "heights")?.or_else(of_heights) {
        stated.height_unit_m = unit.metres;
    }
    Ok(stated)
}

/// The unit of lengths of EPSG's code of one.
fn unit_of(code: u64) -> Option<LinearUnit> {
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
