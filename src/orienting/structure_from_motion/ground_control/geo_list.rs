//! Places of photographs as OpenDroneMap's `geo.txt` states them: a first line with the reference
//! system, then lines
//!
//! ```text
//! image_name geo_x geo_y [geo_z] [yaw pitch roll] [horizontal accuracy] [vertical accuracy]
//! ```
//!
//! Its pitch is 0 where the camera looks down and 90 where it looks ahead; accuracies are metres.

use super::system::{List, fields, number, read_among};
use crate::base::error::Result;
use crate::orienting::orientation::{
    GEO_LIST, InputFile, LinearUnit, PathName, PlanUnit, SystemUnits, TransverseMercator,
    images_called,
};

/// What a list states of a photograph.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct GeoPlace {
    /// Its name as the list has it.
    pub image: String,
    /// Longitude and latitude, degrees.
    pub position: [f64; 2],
    /// Metres.
    pub height_m: Option<f64>,
    /// Degrees, pitch -90 down.
    pub yaw_pitch_roll: Option<[f64; 3]>,
    /// Standard deviation of a component, metres.
    pub sigma_m: Option<f64>,
}

/// Places of photographs beside them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GeoList {
    /// By line.
    pub(in super::super) places: Vec<GeoPlace>,
    /// Why none of them can be used.
    pub(in super::super) problem: Option<String>,
}

const COLUMNS: &str = "image_name geo_x geo_y [geo_z] [yaw pitch roll] [accuracies]";

impl GeoList {
    /// What a list is called among photographs.
    pub const FILE: &str = GEO_LIST;

    /// The `geo.txt` among the files, where there is one.
    ///
    /// # Errors
    /// Where it cannot be read; the message names the line.
    pub fn among(files: &[InputFile]) -> Result<Option<Self>> {
        read_among(files, Self::FILE, Self::read)
    }

    /// Reads a list; `file` is for messages.
    ///
    /// # Errors
    /// Where a line does not follow the format.
    pub fn read(file: &str, text: &str) -> Result<Self> {
        let list = List::new(file, text)?;
        let (system, stated) = (&list.system, list.first.text);
        let grid = system.epsg.and_then(TransverseMercator::of_epsg);
        let is_read = match system.units.plan {
            PlanUnit::Length(_) => grid.is_some(),
            PlanUnit::Angle(_) => !system.is_other_datum(),
            PlanUnit::Geocentric => false,
        };
        if !is_read {
            return Ok(Self {
                places: Vec::new(),
                problem: Some(format!(
                    "{file} is in {stated}, from which no way to WGS84 is known here: it is not \
                     used; convert its places (cs2cs of PROJ does) to EPSG:4326, or to a zone of \
                     UTM that states its datum (WGS84 UTM 32N)"
                )),
            });
        }
        let places = list.lines.iter().map(|line| {
            let place = place_of(line.text, &system.units, grid);
            place.ok_or_else(|| line.error(format!("'{}'", line.text), COLUMNS))
        });
        Ok(Self {
            places: places.collect::<Result<_>>()?,
            problem: None,
        })
    }

    /// What is stated of each photograph, and the names that mean none or several of them.
    pub(in super::super) fn of_photographs(
        &self,
        paths: &[&str],
    ) -> (Vec<Option<&GeoPlace>>, Vec<&str>) {
        let names: Vec<PathName> = paths.iter().map(|path| PathName::new(path)).collect();
        let (mut found, mut unknown) = (vec![None; paths.len()], Vec::new());
        for place in &self.places {
            match images_called(&place.image, &names)[..] {
                [photo] => found[photo] = Some(place),
                _ => unknown.push(&*place.image),
            }
        }
        (found, unknown)
    }
}

/// A line: the name ends where only numbers follow.
fn place_of(line: &str, units: &SystemUnits, grid: Option<TransverseMercator>) -> Option<GeoPlace> {
    let fields = fields(line);
    let numbers_from = |i: usize| fields[i..].iter().map(|f| number(f)).collect::<Option<_>>();
    let (name_end, numbers): (usize, Vec<f64>) =
        (1..fields.len()).find_map(|i| Some((i, numbers_from(i)?)))?;
    let number = |i: usize| numbers.get(i).copied().filter(|v| v.is_finite());
    let [x, y] = [number(0)?, number(1)?];
    let position = match (units.plan, grid) {
        (PlanUnit::Length(unit), Some(grid)) => grid.geographic(x * unit.metres, y * unit.metres),
        (PlanUnit::Angle(deg), _) => [x * deg, y * deg],
        _ => return None,
    };
    let own = match units.plan {
        PlanUnit::Length(unit) => unit,
        _ => LinearUnit::METRE,
    };
    let is_place = position[0].abs() <= 180.0 && position[1].abs() <= 90.0;
    let yaw_pitch_roll = match [number(3), number(4), number(5)] {
        [Some(yaw), Some(pitch), Some(roll)] => Some([yaw, pitch - 90.0, roll]),
        _ => None,
    };
    is_place.then(|| GeoPlace {
        image: fields[..name_end].join(" "),
        position,
        height_m: number(2).map(|z| z * units.height.unwrap_or(own).metres),
        yaw_pitch_roll,
        sigma_m: number(6).filter(|s| *s > 0.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_angles_and_accuracies_are_read() {
        let text = "EPSG:4326\n# a remark\n\n\
                    b a.jpg 8.4 49.0 414.8 3.5 0.5 0.1 0.02 0.03\n\
                    c.jpg 8.41 49.01\nd.jpg 8.4 49.0 nan\n";
        let list = GeoList::read("geo.txt", text).unwrap();
        let [a, c, d] = &list.places[..] else {
            panic!("{list:?}")
        };
        assert_eq!(
            (&*a.image, a.position, a.height_m),
            ("b a.jpg", [8.4, 49.0], Some(414.8))
        );
        assert_eq!(a.yaw_pitch_roll, Some([3.5, -89.5, 0.1]));
        assert_eq!(a.sigma_m, Some(0.02));
        assert_eq!(
            (c.height_m, c.yaw_pitch_roll, c.sigma_m),
            (None, None, None)
        );
        assert_eq!(d.height_m, None);
        let paths = ["x/b a.png", "c.jpg"];
        let (found, unknown) = list.of_photographs(&paths);
        assert!(found.iter().all(Option::is_some));
        assert_eq!(unknown, ["d.jpg"]);
    }

    #[test]
    fn systems_and_units_are_those_of_the_first_line() {
        let of = |text: &str| GeoList::read("geo.txt", text);
        let utm = of("EPSG:32632\na.jpg 456123.0 5427631.0 400\n").unwrap();
        let [lon, lat] = utm.places[0].position;
        assert!(
            (lon - 8.4).abs() < 0.01 && (lat - 49.0).abs() < 0.01,
            "{lon} {lat}"
        );
        // Lambert's projection, another datum, another ellipsoid, geocentric, a zone of any datum.
        for system in [
            "EPSG:2249",
            "EPSG:2154",
            "EPSG:4314",
            "+proj=lcc +lat_1=44 +lat_2=49 +lon_0=3 +units=m",
            "+proj=longlat +ellps=bessel",
            "EPSG:4978",
            "UTM 32N",
        ] {
            let list = of(&format!("{system}\na.jpg 8.4 49.0 400\n")).unwrap();
            let problem = list.problem.unwrap_or_default();
            let is_led = problem.contains(system) && problem.contains("EPSG:4326");
            assert!(list.places.is_empty() && is_led, "{system}: {problem}");
        }
        for (text, words) in [
            ("", "line 1"),
            ("a.jpg 8.4 49.0", "line 1"),
            ("EPSG:4326\na.jpg 8.4", "line 2"),
            ("EPSG:4326\na.jpg 8.4 149.0 100", "line 2"),
        ] {
            let message = of(text).unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
    }
}
