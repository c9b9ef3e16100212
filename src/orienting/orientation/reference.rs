//! The coordinate reference system that files name, as its EPSG code; what the scale and the level
//! of a frame are worth.

use serde::{Deserialize, Serialize};

use super::epsg::is_geographic;
use super::geodesy::Anchor;
use super::well_known;

/// What the files of an orientation say about the system of their coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum StatedReference {
    /// Nothing.
    None,
    /// EPSG code of the system.
    System(u32),
    /// East, north, up from a place.
    Place(Anchor),
    /// A frame of their own, for this reason: no system named elsewhere belongs to it.
    Local(String),
}

/// Standard deviations of a frame as a whole: every length is too long by the same share, every
/// slope too steep by the same angle. What measuring adds is independent of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameSigma {
    /// Of a length of 10 m by the scale, metres; `None` where nothing tells.
    pub length_of_10_m: Option<f64>,
    /// Of a difference of height over 10 m of level distance by the level, metres; `None` where
    /// nothing tells.
    pub height_over_10_m: Option<f64>,
}

impl FrameSigma {
    /// From those of the logarithm of the scale and of the worst tilt, radians.
    pub(crate) fn of(scale: Option<f64>, tilt: Option<f64>) -> Self {
        let over_10_m = |sigma: Option<f64>| sigma.map(|s| 10.0 * s).filter(|s| s.is_finite());
        Self {
            length_of_10_m: over_10_m(scale),
            height_over_10_m: over_10_m(tilt),
        }
    }

    /// Of the scale, as a share of it; 0 where nothing tells.
    pub fn scale(&self) -> f64 {
        self.length_of_10_m.unwrap_or(0.0) / 10.0
    }

    /// Of the worst tilt, radians; 0 where nothing tells.
    pub fn tilt(&self) -> f64 {
        self.height_over_10_m.unwrap_or(0.0) / 10.0
    }

    /// In words.
    pub fn words(&self) -> String {
        let scale = match self.length_of_10_m {
            Some(sigma) => format!("a length of 10 m is known to +- {sigma:.3} m by the scale"),
            None => "nothing tells how well the scale is known".to_owned(),
        };
        let level = match self.height_over_10_m {
            Some(sigma) => {
                format!("a height over 10 m of level distance to +- {sigma:.3} m by the level")
            }
            None => "nothing tells how level it is".to_owned(),
        };
        format!("{scale}, {level}")
    }
}

/// The report that `orient` writes beside its model: COLMAP's text has no room for a place.
pub(super) const OF_ORIENT: &str = "orientation.json";

/// What such a report says of the frame of the model.
pub(super) fn of_orient(text: &str) -> StatedReference {
    #[derive(Deserialize)]
    struct Report {
        is_metric: bool,
        anchor: Option<Anchor>,
        epsg: Option<u32>,
    }
    match serde_json::from_str(text) {
        Ok(Report {
            is_metric: false, ..
        }) => StatedReference::Local(format!(
            "{OF_ORIENT} says that its scale is not that of the world"
        )),
        Ok(Report {
            anchor: Some(anchor),
            ..
        }) => StatedReference::Place(anchor),
        Ok(Report {
            epsg: Some(code), ..
        }) => StatedReference::System(code),
        Ok(_) | Err(_) => StatedReference::None,
    }
}

/// What such a report says that the frame's scale and level are worth.
pub(super) fn frame_sigma_of_orient(text: &str) -> Option<FrameSigma> {
    #[derive(Deserialize)]
    struct Report {
        frame_sigma: Option<FrameSigma>,
    }
    serde_json::from_str::<Report>(text).ok()?.frame_sigma
}

/// EPSG code of the system of an INPHO project.
pub(crate) fn of_inpho(text: &str) -> StatedReference {
    let after = text.split("$COORDINATE_SYSTEM").nth(1);
    let part = after.and_then(|after| after.split('$').next());
    // Its coordinates are lengths, though a datum alone may be named.
    let code = part.and_then(epsg_of).filter(|&code| !is_geographic(code));
    code.map_or(StatedReference::None, StatedReference::System)
}

/// EPSG code of a system written as well-known text, as PROJ's string, as "EPSG:25832", in any of
/// OGC's forms, or as the number alone.
///
/// In well-known text only the code of the whole system counts: those of its ellipsoid, its units
/// or its heights name something else. Of a compound system without a code the horizontal part is
/// taken, and where no code is stated that of the same projection. Of several codes in one name
/// the first is that of the plan.
pub fn epsg_of(text: &str) -> Option<u32> {
    if let Ok(number) = text.trim().parse::<u32>() {
        return is_plausible(number).then_some(number);
    }
    if text.contains('[') {
        return well_known::code_of(text).filter(|&code| is_plausible(code));
    }
    let upper = text.to_ascii_uppercase();
    let named = upper.split("EPSG").skip(1).find_map(code_in);
    named.or_else(|| well_known::code_of(text))
}

/// The number that follows "EPSG", perhaps behind the version of the registry.
fn code_in(after: &str) -> Option<u32> {
    let between = after.find(|c: char| !c.is_ascii_digit() && !"\",:/.# XML".contains(c));
    let numbers = after[..between.unwrap_or(after.len())].split(|c: char| !c.is_ascii_digit());
    let mut codes = numbers.filter_map(|digits| digits.parse().ok());
    codes.find(|&code| is_plausible(code))
}

fn is_plausible(number: u32) -> bool {
    (1024..=32_767).contains(&number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_the_whole_system_is_found() {
        let wkt = r#"PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",AUTHORITY["EPSG","4258"]],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AUTHORITY["EPSG","25832"]]"#;
        assert_eq!(epsg_of(wkt), Some(25832));
        assert_eq!(epsg_of(r#"PROJCRS["x",ID["EPSG",2056]]"#), Some(2056));
        assert_eq!(epsg_of("urn:ogc:def:crs:EPSG::5514"), Some(5514));
        assert_eq!(
            epsg_of("https://www.opengis.net/def/crs/EPSG/0/7415"),
            Some(7415)
        );
        assert_eq!(
            (epsg_of("EPSG:25832"), epsg_of(" 25832 ")),
            (Some(25832), Some(25832))
        );
        assert_eq!(
            (
                epsg_of("EPSG:"),
                epsg_of("LOCAL_CS[\"x\"]"),
                epsg_of("EPSG:99999999999")
            ),
            (None, None, None)
        );
        let project =
            format!("$PROJECT 6\n $COORDINATE_SYSTEM :\n {wkt}\n $UNITS : m\n$END\n EPSG:4326");
        assert_eq!(of_inpho(&project), StatedReference::System(25832));
    }

    #[test]
    fn what_orient_found_is_read_in_the_forms_that_editors_leave() {
        let at = |lon_deg: f64, lat_deg: f64, height_m: f64| {
            StatedReference::Place(Anchor {
                lon_deg,
                lat_deg,
                height_m,
            })
        };
        let place = r#""anchor":{"lon_deg":8.4,"lat_deg":49.0,"height_m":0.0}"#;
        let whole = r#""anchor":{"lon_deg":-8,"lat_deg":-49,"height_m":12}"#;
        let code = |code: u32| format!(r#"{{"is_metric":true,"epsg":{code}}}"#);
        for (text, stated) in [
            (
                format!(r#"{{"is_metric":true,{place},"epsg":null}}"#),
                at(8.4, 49.0, 0.0),
            ),
            (
                format!("{{\r\n \"is_metric\": true,\r\n {place},\r\n \"more\": [1]}}\r\n"),
                at(8.4, 49.0, 0.0),
            ),
            (
                format!(r#"{{{whole},"is_metric":true}}"#),
                at(-8.0, -49.0, 12.0),
            ),
            (
                format!(r#"{{"unit_m":1.0,{place},"is_metric":true}}"#),
                at(8.4, 49.0, 0.0),
            ),
            (code(25832), StatedReference::System(25832)),
            (code(2249), StatedReference::System(2249)),
            (
                r#"{"is_metric":true,"anchor":null,"epsg":null}"#.to_owned(),
                StatedReference::None,
            ),
            (r#"{"is_metric":true}"#.to_owned(), StatedReference::None),
            (r#"{"is_metric":true,"#.to_owned(), StatedReference::None),
            (
                r#"{"is_metric":true,"epsg":"25832"}"#.to_owned(),
                StatedReference::None,
            ),
        ] {
            assert_eq!(of_orient(&text), stated, "{text}");
        }
        let without_scale = format!(r#"{{"is_metric":false,{place}}}"#);
        assert!(matches!(
            of_orient(&without_scale),
            StatedReference::Local(_)
        ));
    }

    #[test]
    fn codes_of_parts_are_not_those_of_the_system() {
        let plane = r#"PROJCS["x",GEOGCS["y",AUTHORITY["EPSG","4258"]],UNIT["metre",1,AUTHORITY["EPSG","9001"]]@]"#;
        let with = |own: &str| plane.replace('@', own);
        let height = r#"VERT_CS["h",UNIT["m",1],AUTHORITY["EPSG","7837"]]"#;
        let compound = |own: &str| format!("COMPD_CS[\"z\",{},{height}]", with(own));
        let own = r#",AUTHORITY["EPSG","25832"]"#;
        assert_eq!(epsg_of(&with(own)), Some(25832));
        assert_eq!(epsg_of(&with("")), None, "that of the unit is none");
        assert_eq!(epsg_of(&compound(own)), Some(25832));
        assert_eq!(epsg_of(&compound("")), None, "that of the heights is none");
        assert_eq!(epsg_of("+init=epsg:31467 +units=m"), Some(31467));
        assert_eq!(epsg_of("EPSG:32636+5773"), Some(32636));
        for broken in [
            "[",
            "]",
            "PROJCS[\"",
            "AUTHORITY[\"EPSG\"",
            "\u{e9}[\"EPSG",
            "][[",
        ] {
            assert_eq!(epsg_of(broken), None);
        }
    }

    #[test]
    fn systems_that_are_written_out_have_the_code_of_their_plane() {
        let esri = |datum: &str, meridian: &str, unit: &str, east: &str| {
            format!(
                "PROJCS[\"p\",GEOGCS[\"g\",DATUM[\"{datum}\",SPHEROID[\"s\",6378137.0,298.257]],\
                 PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],\
                 PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",{east}],\
                 PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",{meridian}],\
                 PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],\
                 UNIT[\"u\",{unit}]]"
            )
        };
        let wkt2 = "PROJCRS[\"p\",BASEGEOGCRS[\"b\",DATUM[\"World Geodetic System 1984\",\
                    ELLIPSOID[\"WGS 84\",6378137,298.257223563,LENGTHUNIT[\"metre\",1]]]],\
                    CONVERSION[\"c\",METHOD[\"Transverse Mercator\",ID[\"EPSG\",9807]],\
                    PARAMETER[\"Latitude of natural origin\",0],PARAMETER[\"Longitude of natural \
                    origin\",9],PARAMETER[\"Scale factor at natural origin\",0.9996],\
                    PARAMETER[\"False easting\",500000],PARAMETER[\"False northing\",0]],\
                    CS[Cartesian,2],AXIS[\"e\",east],AXIS[\"n\",north],LENGTHUNIT[\"metre\",1]]";
        for (text, code) in [
            (esri("D_ETRS_1989", "9.0", "1.0", "500000.0"), Some(32632)),
            (esri("D_WGS_1984", "-75", "1", "500000"), Some(32618)),
            (esri("D_North_American_1983", "-75", "0.3048", "1640419.9475065617"), Some(32618)),
            (esri("D_Deutsches_Hauptdreiecksnetz", "9.0", "1.0", "500000.0"), None),
            (wkt2.to_owned(), Some(32632)),
            ("+proj=utm +zone=32 +ellps=GRS80 +units=m +no_defs".to_owned(), Some(32632)),
            ("+proj=utm +zone=23 +south +datum=WGS84".to_owned(), Some(32723)),
            ("+proj=tmerc +lon_0=9 +k=0.9996 +x_0=500000 +ellps=GRS80".to_owned(), Some(32632)),
            ("+proj=utm +zone=32 +ellps=bessel".to_owned(), None),
            ("+proj=utm +zone=32 +ellps=GRS80 +towgs84=598,73,418".to_owned(), None),
            ("+proj=longlat +datum=WGS84".to_owned(), Some(4326)),
            ("GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\"]]".to_owned(), Some(4326)),
            ("COMPD_CS[\"c\",PROJCS[\"p\",AUTHORITY[\"EPSG\",\"25832\"]],VERT_CS[\"v\"],AUTHORITY[\"EPSG\",\"5555\"]]".to_owned(), Some(5555)),
            ("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837".to_owned(), Some(25832)),
            ("urn:ogc:def:crs:EPSG:10.0:2056".to_owned(), Some(2056)),
            ("http://www.opengis.net/gml/srs/epsg.xml#3006".to_owned(), Some(3006)),
            (format!("ESRI PE String = {}", esri("D_North_American_1983", "-75", "1", "500000")), Some(32618)),
            (esri("D_WGS_1984", "9", "1", "500000").to_lowercase(), Some(32632)),
            ("BOUNDCRS[SOURCECRS[PROJCRS[\"d\",ID[\"EPSG\",31467]]],TARGETCRS[GEOGCRS[\"w\",ID[\"EPSG\",4326]]]]".to_owned(), Some(31467)),
            ("COMPOUNDCRS[\"c\",PROJCRS[\"p\",ID[\"EPSG\",25832]],VERTCRS[\"v\",ID[\"EPSG\",7837]]]".to_owned(), Some(25832)),
            ("+proj=utm +zone=33 +datum=WGS84 +units=us-ft".to_owned(), Some(32633)),
            ("+init=epsg:2056 +type=crs".to_owned(), Some(2056)),
            ("WGS 84 / UTM zone 32N".to_owned(), Some(32632)),
            ("UTM Zone 7 S, WGS84".to_owned(), Some(32707)),
            ("PCS Name = NAD_1983_UTM_Zone_10N|".to_owned(), Some(32610)),
            ("ETRS89 / UTM zone 32N + DHHN2016 height".to_owned(), Some(32632)),
            ("SIRGAS 2000 / UTM zone 23S".to_owned(), Some(32723)),
            ("NAD83(2011) / UTM zone 14N".to_owned(), Some(32614)),
            ("WGS84".to_owned(), Some(4326)),
            ("urn:ogc:def:crs:OGC::CRS84".to_owned(), Some(4326)),
            // Other planes: zones before the easting, feet, another datum, no datum.
            ("ETRS89 / UTM zone 32N (zE-N)".to_owned(), None),
            ("NAD83 / UTM zone 14N (ftUS)".to_owned(), None),
            ("NAD27 / UTM zone 14N".to_owned(), None),
            ("ED50 / UTM zone 32N".to_owned(), None),
            ("UTM zone 32N".to_owned(), None),
            ("WGS 84 / UTM zone 61N".to_owned(), None),
            ("IGNF:LAMB93".to_owned(), None),
            ("ESRI:102100".to_owned(), None),
        ] {
            assert_eq!(epsg_of(&text), code, "{text}");
        }
    }

    #[test]
    fn codes_stand_for_planes() {
        use crate::orienting::orientation::plane_of;
        for (a, b) in [
            (25832, 5555),
            (28992, 7415),
            (2154, 5698),
            (27700, 7405),
            (26914, 6343),
            (32118, 2263),
            (2263, 6539),
            (28355, 7855),
            (3006, 32633),
            (25833, 3045),
            (31983, 32723),
            (6677, 2451),
            (3157, 32610),
            (6339, 26910),
            (7856, 28356),
            (3067, 25835),
            (5554, 25831),
            (3044, 25832),
            (6346, 32617),
        ] {
            assert_eq!(plane_of(a), plane_of(b), "{a} {b}");
        }
        for (a, b) in [
            (25832, 25833),
            (31467, 25832),
            (2056, 21781),
            (28992, 31370),
            (5514, 5513),
            (32632, 32732),
            (4647, 25832),
            (3857, 4326),
            (23032, 25832),
            (3035, 25832),
            (26714, 26914),
            (2180, 2177),
            (31984, 32723),
        ] {
            assert_ne!(plane_of(a), plane_of(b), "{a} {b}");
        }
        for degrees in [4326, 4979, 4258, 4269, 6318, 7844, 4674, 9518, 4937] {
            assert!(is_geographic(degrees), "{degrees}");
        }
        for other in [4314, 4277, 4978, 25832, 0, 32_767] {
            assert!(!is_geographic(other), "{other}");
        }
        // What stands for others stands for itself.
        assert!((0..=32_767).all(|code| plane_of(plane_of(code)) == plane_of(code)));
    }
}
