//! What one number of a coordinate counts: metres, feet, degrees, by what a file says of its
//! system: a code of EPSG, well-known text (1 and 2) or a PROJ text.
//!
//! ```text
//! epsg.txt   units of codes; tests/evaluation/epsg_units.py writes it
//! unit       units and their names
//! text       units that a text states itself
//! ```

mod text;
mod unit;

pub use unit::{LinearUnit, PlanUnit, SystemUnits};

use super::epsg_of;

/// Lines of units by codes: which coordinate, the unit, and codes or first and last of a run.
const CODES: &str = include_str!("epsg.txt");

/// The unit that the table has for a code.
fn listed(coordinate: &str, code: u32) -> Option<&'static str> {
    let is_in = |run: &str| {
        let (first, last) = run.split_once('-').unwrap_or((run, run));
        let [first, last] = [first, last].map(|n| n.parse::<u32>().ok());
        first.is_some_and(|n| n <= code) && last.is_some_and(|n| code <= n)
    };
    CODES.lines().find_map(|line| {
        let mut words = line.split(' ');
        let is_of = words.next() == Some(coordinate);
        let unit = words.next()?;
        (is_of && words.any(is_in)).then_some(unit)
    })
}

/// Units of the coordinates of an EPSG code; codes that the table has not are metres on a map.
pub fn units_of_code(code: u32) -> SystemUnits {
    let plan = match listed("plan", code) {
        Some("degree") => PlanUnit::Angle(1.0),
        Some("grad") => PlanUnit::Angle(0.9),
        Some("geocentric") => PlanUnit::Geocentric,
        Some(metres) => PlanUnit::Length(
            metres
                .parse()
                .map_or(LinearUnit::METRE, |metres| LinearUnit { metres }),
        ),
        None => PlanUnit::Length(LinearUnit::METRE),
    };
    SystemUnits {
        plan,
        height: height_unit_of_code(code),
    }
}

/// Unit of the coordinates in plan of an EPSG code; `None` for longitude and latitude.
pub fn linear_unit_of_code(code: u32) -> Option<LinearUnit> {
    match units_of_code(code).plan {
        PlanUnit::Length(unit) => Some(unit),
        PlanUnit::Geocentric => Some(LinearUnit::METRE),
        PlanUnit::Angle(_) => None,
    }
}

/// Unit of the heights of an EPSG code of heights, of a compound system or of one in three
/// dimensions; `None` for others, which state no heights.
pub fn height_unit_of_code(code: u32) -> Option<LinearUnit> {
    let metres = listed("height", code)?.parse().ok()?;
    Some(LinearUnit { metres })
}

/// Units that a text states of a coordinate system; `None` where it names no system. What a text
/// says itself counts before its code.
pub fn units_of(text: &str) -> Option<SystemUnits> {
    let (plan, height) = text::stated(text);
    let of_code = codes_in(text);
    Some(SystemUnits {
        plan: plan.or(of_code.map(|units| units.plan))?,
        height: height.or(of_code.and_then(|units| units.height)),
    })
}

/// Units by the codes in a text: those of a compound "EPSG:2249+6360" may be two.
fn codes_in(text: &str) -> Option<SystemUnits> {
    let mut units = units_of_code(epsg_of(text)?);
    if !text.contains('[') {
        let numbers = text.split(|c: char| !c.is_ascii_digit());
        let of_heights = |number: &str| height_unit_of_code(number.parse().ok()?);
        units.height = numbers.rev().find_map(of_heights);
    }
    Some(units)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metres(text: &str) -> Option<(f64, Option<f64>)> {
        let units = units_of(text)?;
        let PlanUnit::Length(plan) = units.plan else {
            return None;
        };
        Some((plan.metres, units.height.map(|unit| unit.metres)))
    }

    #[test]
    fn codes_have_their_units() {
        let us = LinearUnit::US_FOOT.metres;
        // Plan and height in metres by EPSG; Massachusetts, California, Texas, Arizona, Oregon.
        for (code, plan) in [
            (2249, us),
            (2229, us),
            (2277, us),
            (6588, us),
            (3435, us),
            (2223, 0.3048),
            (2868, 0.3048),
            (2992, 0.3048),
            (6559, 0.3048),
            (25832, 1.0),
            (2056, 1.0),
            (32755, 1.0),
            (26986, 1.0),
        ] {
            let found = linear_unit_of_code(code).expect("a map");
            assert!((found.metres - plan).abs() < 1e-12, "{code}: {found:?}");
        }
        for code in [4326, 4979, 4269, 6318, 7844, 4258, 9754] {
            assert_eq!(linear_unit_of_code(code), None, "{code}");
        }
        assert_eq!(units_of_code(4978).plan, PlanUnit::Geocentric);
        let height = |code| height_unit_of_code(code).map(|unit| unit.metres);
        assert!(height(6360).is_some_and(|m| (m - us).abs() < 1e-12));
        assert_eq!(
            [8228, 5773, 7415, 4979].map(height),
            [Some(0.3048), Some(1.0), Some(1.0), Some(1.0)]
        );
        assert_eq!([2249, 25832, 4326].map(height), [None; 3]);
        assert!(height(8714).is_some_and(|m| (m - us).abs() < 1e-12));
        assert_eq!(LinearUnit::US_FOOT.words(), "US survey feet");
        assert_eq!(
            linear_unit_of_code(2159).map(|u| u.words()).as_deref(),
            Some("units of 0.3047997101815088 m")
        );
    }

    #[test]
    fn units_have_many_names() {
        let us = LinearUnit::US_FOOT;
        for (name, unit) in [
            ("US survey foot", us),
            ("U.S. Survey Feet", us),
            ("Foot_US", us),
            ("us-ft", us),
            ("ftUS", us),
            ("sft", us),
            ("US Foot", us),
            ("survey feet", us),
            ("foot", LinearUnit::FOOT),
            ("Feet (International)", LinearUnit::FOOT),
            ("International Feet", LinearUnit::FOOT),
            ("ft", LinearUnit::FOOT),
            ("Meter", LinearUnit::METRE),
            ("METRES", LinearUnit::METRE),
        ] {
            assert_eq!(LinearUnit::of_name(name), Some(unit), "{name}");
        }
        for other in ["fathom", "Clarke's foot", "Indian foot", "degree", ""] {
            assert_eq!(LinearUnit::of_name(other), None, "{other}");
        }
    }

    #[test]
    fn texts_state_their_units() {
        let us = 0.304_800_609_601_219;
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        let wkt1 = "PROJCS[\"NAD83 / Massachusetts Mainland (ftUS)\",GEOGCS[\"NAD83\",\
            DATUM[\"x\",SPHEROID[\"GRS 1980\",6378137,298.257222101]],PRIMEM[\"Greenwich\",0],\
            UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"y\"],\
            UNIT[\"US survey foot\",0.304800609601219],AXIS[\"X\",EAST]]";
        let heights = "VERT_CS[\"NAVD88 (ftUS)\",VERT_DATUM[\"z\",2005],\
            UNIT[\"US survey foot\",0.304800609601219]]";
        let compound = format!("COMPD_CS[\"c\",{wkt1},{heights}]");
        let wkt2 = "PROJCRS[\"p\",BASEGEOGCRS[\"NAD83\",DATUM[\"d\",ELLIPSOID[\"e\",6378137,298.2,\
            LENGTHUNIT[\"metre\",1]]]],CONVERSION[\"c\",PARAMETER[\"False easting\",200000,\
            LENGTHUNIT[\"metre\",1]]],CS[Cartesian,2],AXIS[\"e\",east,ORDER[1],\
            LENGTHUNIT[\"foot\",0.3048]],AXIS[\"n\",north,ORDER[2],LENGTHUNIT[\"foot\",0.3048]]]";
        let whole = "PROJCRS[\"p\",CS[Cartesian,2],AXIS[\"e\",east],AXIS[\"n\",north],\
            LENGTHUNIT[\"foot\",0.3048],ID[\"EPSG\",2868]]";
        // ESRI puts heights beside the map, ISO inside of a compound.
        let beside = format!(
            "{wkt1},VERTCS[\"NAVD_1988_Foot_US\",VDATUM[\"v\"],PARAMETER[\"Direction\",1.0],UNIT[\"Foot_US\",0.3048006096012192]]"
        );
        let vertical = "COMPOUNDCRS[\"c\",PROJCRS[\"p\",CS[Cartesian,2],AXIS[\"e\",east],\
            AXIS[\"n\",north],LENGTHUNIT[\"metre\",1]],VERTCRS[\"v\",CS[vertical,1],AXIS[\"h\",up,\
            LENGTHUNIT[\"US survey foot\",0.304800609601219]]]]";
        for (text, plan, height) in [
            (wkt1, us, None),
            (&*compound, us, Some(us)),
            (wkt2, 0.3048, None),
            (whole, 0.3048, None),
            ("+proj=lcc +lat_1=42 +units=us-ft", us, None),
            (
                "+proj=lcc +to_meter=0.3048006096012192 +vunits=m",
                us,
                Some(1.0),
            ),
            (
                "+proj=lcc +to_meter=1200/3937 +vto_meter=0.3048",
                us,
                Some(0.3048),
            ),
            ("+proj=utm +zone=32 +units=m", 1.0, None),
            ("EPSG:2249", us, None),
            ("epsg:2249+6360", us, Some(us)),
            ("EPSG:2249+EPSG:5703", us, Some(1.0)),
            (
                "urn:ogc:def:crs,crs:EPSG::2223,crs:EPSG::8228",
                0.3048,
                Some(0.3048),
            ),
            ("EPSG:7415", 1.0, Some(1.0)),
            ("https://www.opengis.net/def/crs/EPSG/0/2263", us, None),
            ("urn:ogc:def:crs:EPSG:9.8.15:2263", us, None),
            ("http://www.opengis.net/gml/srs/epsg.xml#2263", us, None),
            ("EPSG:32610+8228", 1.0, Some(0.3048)),
            ("EPSG:6559+EPSG:6360", 0.3048, Some(us)),
            ("NAD_1983_UTM_Zone_10N", 1.0, None),
            (&*beside, us, Some(us)),
            (vertical, 1.0, Some(us)),
            (
                "+proj=utm +zone=10 +datum=WGS84 +units=ft +vunits=us-ft",
                0.3048,
                Some(us),
            ),
            (
                "+proj=utm +zone=18 +datum=NAD83 +to_meter=0.3048006096012192",
                us,
                None,
            ),
            ("+proj=tmerc +lat_0=0 +units=km", 1000.0, None),
        ] {
            let found = metres(text).unwrap_or_else(|| panic!("{text}: none"));
            let is_same = near(found.0, plan)
                && found
                    .1
                    .zip(height)
                    .map_or(found.1 == height, |(a, b)| near(a, b));
            assert!(is_same, "{text}: {found:?}");
        }
        for degrees in [
            "EPSG:4326",
            "+proj=longlat +datum=WGS84",
            "EPSG:6318",
            "WGS 84",
            "OGC:CRS84",
        ] {
            let plan = units_of(degrees).map(|u| u.plan);
            assert_eq!(plan, Some(PlanUnit::Angle(1.0)), "{degrees}");
        }
        for nothing in [
            "",
            "[",
            "UTM 32N",
            "UNIT[\"x\",",
            "PROJCS[\"a\",UNIT[\"f\",nan]]",
        ] {
            assert_eq!(units_of(nothing), None, "{nothing}");
        }
    }
}
