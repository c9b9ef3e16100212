//! Ground control points as OpenDroneMap's `gcp_list.txt` states them: a first line with the
//! reference system, then lines
//!
//! ```text
//! geo_x geo_y geo_z im_x im_y image_name [gcp_name] [more]
//! ```
//!
//! `im_x`, `im_y` count in pixels from the upper left corner of the photograph as it is stored.

use nalgebra::{Point2, Point3, Vector3};

use crate::base::error::{Error, Result};
use crate::orienting::orientation::{Anchor, GCP_LIST, InputFile, epsg_of, geocentric_of};

/// A point with known coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlPoint {
    /// Its name; its number where none is stated.
    pub name: String,
    /// Coordinates as they are stated.
    pub stated: [f64; 3],
    /// Metres in the frame of [`GroundControl`].
    pub position: Point3<f64>,
    /// Names of photographs, and where they show the point: pixels.
    pub marks: Vec<(String, Point2<f64>)>,
}

/// Points with known coordinates, and their reference system.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundControl {
    /// The reference system as it is stated.
    pub system: String,
    /// Its EPSG code, where it is known and its coordinates are metres on a map.
    pub epsg: Option<u32>,
    /// Where the frame touches the Earth, for geographic coordinates: x east, y north, z up.
    pub anchor: Option<Anchor>,
    /// What was subtracted of coordinates on a map, metres: they keep their digits.
    pub offset: Vector3<f64>,
    /// The points.
    pub points: Vec<ControlPoint>,
}

/// Coordinates on a map are counted from a multiple of this, metres.
const GRID_M: f64 = 100.0;

const SYSTEM: &str =
    "a reference system in the first line: EPSG:25832, WGS84 UTM 32N, or +proj=... in metres";
const COLUMNS: &str = "geo_x geo_y geo_z im_x im_y image_name [gcp_name]";

/// What the first line says.
struct System {
    epsg: Option<u32>,
    /// Degrees; with an EPSG code only where the coordinates are possible.
    is_geographic: bool,
}

impl GroundControl {
    /// What a list is called among photographs.
    pub const FILE: &str = GCP_LIST;

    /// The `gcp_list.txt` among the files, where there is one.
    ///
    /// # Errors
    /// Where it cannot be read; the message names the line.
    pub fn among(files: &[InputFile]) -> Result<Option<Self>> {
        let found = files
            .iter()
            .find(|f| f.name().eq_ignore_ascii_case(Self::FILE));
        found.map(|f| Self::read(&f.path, &f.text())).transpose()
    }

    /// Reads a list; `file` is for messages.
    ///
    /// # Errors
    /// Where a line does not follow the format, or a point has two places.
    pub fn read(file: &str, text: &str) -> Result<Self> {
        let refused = |line: usize, problem: String, expected: &str| Error::Line {
            file: file.to_owned(),
            line: line + 1,
            problem,
            expected: expected.to_owned(),
        };
        let mut lines = (text.trim_start_matches('\u{feff}').lines().enumerate())
            .map(|(i, line)| (i, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let (first, stated) = lines.next().unwrap_or((0, ""));
        let system =
            system_of(stated).ok_or_else(|| refused(first, format!("'{stated}'"), SYSTEM))?;
        let mut points: Vec<ControlPoint> = Vec::new();
        for (i, line) in lines {
            let fields: Vec<&str> = line.split_whitespace().collect();
            let numbers: Vec<f64> = (fields.iter().take(5))
                .map_while(|field| field.parse().ok().filter(|v: &f64| v.is_finite()))
                .collect();
            let (&[x, y, z, u, v], Some(image)) = (&numbers[..], fields.get(5)) else {
                return Err(refused(i, format!("'{line}'"), COLUMNS));
            };
            let place = [x, y, z];
            let mark = ((*image).to_owned(), Point2::new(u, v));
            let name = fields.get(6);
            let known = points.iter_mut().find(|p| match name {
                Some(name) => p.name == **name,
                None => p.stated == place,
            });
            match known {
                Some(point) if point.stated != place => {
                    let problem = format!("point {} has other coordinates above", point.name);
                    return Err(refused(i, problem, "one place for each name"));
                }
                Some(point) => point.marks.push(mark),
                None => points.push(ControlPoint {
                    name: name.map_or_else(|| (points.len() + 1).to_string(), |n| (*n).to_owned()),
                    stated: place,
                    position: Point3::origin(),
                    marks: vec![mark],
                }),
            }
        }
        let is_outside = |p: &ControlPoint| p.stated[0].abs() > 180.0 || p.stated[1].abs() > 90.0;
        let on_map = points.iter().any(is_outside);
        let is_geographic = system.is_geographic && !on_map;
        if on_map && matches!(system.epsg, None | Some(4326)) && system.is_geographic {
            let problem = format!("'{stated}' has longitudes and latitudes, the points have not");
            return Err(refused(first, problem, SYSTEM));
        }
        let mut control = Self {
            system: stated.to_owned(),
            epsg: system.epsg.filter(|_| !is_geographic),
            anchor: None,
            offset: Vector3::zeros(),
            points,
        };
        control.set_frame(is_geographic);
        Ok(control)
    }

    /// Positions in metres near zero.
    fn set_frame(&mut self, is_geographic: bool) {
        let Some([x, y, z]) = self.points.first().map(|p| p.stated) else {
            return;
        };
        if is_geographic {
            let anchor = Anchor::near(&geocentric_of(x, y, z));
            self.anchor = Some(anchor);
            for point in &mut self.points {
                let [lon, lat, height] = point.stated;
                point.position = anchor.local(&geocentric_of(lon, lat, height));
            }
        } else {
            let round = |v: f64| (v / GRID_M).round() * GRID_M;
            self.offset = Vector3::new(round(x), round(y), 0.0);
            for point in &mut self.points {
                point.position = Point3::from(point.stated) - self.offset;
            }
        }
    }
}

/// What a line says of the reference system; `None` where it is none, or not in metres.
fn system_of(line: &str) -> Option<System> {
    let upper = line.to_ascii_uppercase();
    let on_map = |epsg| System {
        epsg,
        is_geographic: false,
    };
    if upper.contains("+PROJ=") || upper.contains("+INIT=") {
        let value = |key: &str| {
            let words = upper.split_whitespace();
            words.filter_map(|w| w.strip_prefix(key)).next()
        };
        let is_metric = value("+UNITS=").is_none_or(|unit| unit == "M")
            && value("+TO_METER=").is_none_or(|factor| factor.parse() == Ok(1.0));
        return match value("+PROJ=") {
            Some("LONGLAT" | "LATLONG" | "LONLAT" | "LATLON") => Some(System {
                epsg: None,
                is_geographic: true,
            }),
            Some("UTM") if is_metric => {
                let zone = value("+ZONE=").and_then(|z| z.parse().ok());
                let is_south = upper.split_whitespace().any(|w| w == "+SOUTH");
                let is_wgs = upper.contains("=WGS84");
                Some(on_map(
                    zone.filter(|_| is_wgs).and_then(|z| utm(z, is_south)),
                ))
            }
            _ => is_metric.then(|| on_map(epsg_of(line))),
        };
    }
    if let (true, Some(epsg)) = (upper.contains("EPSG"), epsg_of(line)) {
        // Geographic systems have these numbers, and a few on maps too.
        let is_geographic = matches!(epsg, 4001..=4999);
        return Some(System {
            epsg: Some(epsg),
            is_geographic,
        });
    }
    let zone = upper.split("UTM").nth(1)?.trim();
    let zone = zone.strip_prefix("ZONE").unwrap_or(zone).trim();
    let is_south = zone.ends_with('S');
    let number = zone.trim_end_matches(['N', 'S']).trim().parse().ok()?;
    let epsg = utm(number, is_south)?;
    Some(on_map(Some(epsg).filter(|_| upper.contains("WGS"))))
}

/// EPSG code of a zone of UTM on WGS84.
fn utm(zone: u32, is_south: bool) -> Option<u32> {
    let first = if is_south { 32_700 } else { 32_600 };
    (1..=60).contains(&zone).then_some(first + zone)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<GroundControl> {
        GroundControl::read("gcp_list.txt", text)
    }

    #[test]
    fn marks_of_a_point_are_collected_and_coordinates_keep_their_digits() {
        let text = "EPSG:25832\n\
                    432123.456 5412345.678 121.5 100.5 200.25 a.jpg corner 0.02\n\
                    # a remark\n\n\
                    432150.0\t5412300.0\t120.0\t10\t20\ta.jpg\n\
                    432123.456 5412345.678 121.5 300 400 b.jpg corner\n\
                    432150.0 5412300.0 120.0 30 40 b.jpg\n";
        let control = read(text).unwrap();
        assert_eq!(control.epsg, Some(25832));
        let [corner, other] = &control.points[..] else {
            panic!("{control:?}")
        };
        assert_eq!((&*corner.name, &*other.name), ("corner", "2"));
        assert_eq!((corner.marks.len(), other.marks.len()), (2, 2));
        assert_eq!(
            corner.marks[0],
            ("a.jpg".into(), Point2::new(100.5, 200.25))
        );
        assert_eq!(control.offset, Vector3::new(432_100.0, 5_412_300.0, 0.0));
        assert!((corner.position - Point3::new(23.456, 45.678, 121.5)).norm() < 1e-8);
    }

    #[test]
    fn reference_systems_in_all_their_forms() {
        let of = |line: &str| system_of(line).map(|s| (s.epsg, s.is_geographic));
        assert_eq!(of("WGS84 UTM 32N"), Some((Some(32632), false)));
        assert_eq!(of("WGS84 UTM 7S"), Some((Some(32707), false)));
        let proj = "+proj=utm +zone=10 +ellps=WGS84 +datum=WGS84 +units=m +no_defs";
        assert_eq!(of(proj), Some((Some(32610), false)));
        assert_eq!(of("+proj=longlat +datum=WGS84"), Some((None, true)));
        assert_eq!(of("epsg:4326"), Some((Some(4326), true)));
        assert_eq!(of("+proj=tmerc +lat_0=0 +lon_0=9"), Some((None, false)));
        assert_eq!(of("+proj=lcc +units=us-ft"), None);
        assert_eq!(of("432150.0 5412300.0 120.0 10 20 a.jpg"), None);
    }

    #[test]
    fn geographic_coordinates_become_metres() {
        let text = "EPSG:4326\n8.4 49.0 100 1 2 a.jpg p\n8.4 49.001 110 3 4 a.jpg q\n";
        let control = read(text).unwrap();
        let [p, q] = [0, 1].map(|i| control.points[i].position);
        let along = q - p;
        assert!(
            along.x.abs() < 0.01 && (along.y - 111.2).abs() < 0.3,
            "{along}"
        );
        assert!((along.z - 10.0).abs() < 0.01, "{along}");
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, words) in [
            ("", "a reference system in the first line"),
            ("1 2 3 4 5 a.jpg", "line 1"),
            ("EPSG:25832\n1 2 3 4 5", "line 2"),
            ("EPSG:25832\n1 2 high 4 5 a.jpg", "line 2"),
            ("EPSG:25832\n1 2 3 4 5 a.jpg p\n1 2 4 4 5 b.jpg p", "line 3"),
            ("EPSG:4326\n432100 5412300 3 4 5 a.jpg p", "longitudes"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
    }
}
