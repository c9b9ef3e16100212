//! Ground control points as OpenDroneMap's `gcp_list.txt` states them: a first line with the
//! reference system, then lines
//!
//! ```text
//! geo_x geo_y geo_z im_x im_y image_name [gcp_name [role ...] [more]]
//! ```
//!
//! What a point is for ([`Role`]) stands behind its name, where programs that do not know it look
//! for nothing; on one of its lines is enough.
//!
//! `im_x`, `im_y` count in pixels from the upper left corner of the photograph as it is stored.
//! Coordinates count in the unit of the system, and become metres here.

use nalgebra::{Point2, Point3, Vector3};

use super::role::Role;
use super::system::{List, fields, number, read_among};
use crate::base::error::{Result, listed};
use crate::orienting::orientation::{
    Anchor, GCP_LIST, InputFile, LinearUnit, PlanUnit, SystemUnits, TransverseMercator,
    geocentric_of,
};
use crate::orienting::structure_from_motion::similarity_fit::KnownOf;

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
    /// What it is for.
    pub role: Role,
}

/// Points with known coordinates, and their reference system.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundControl {
    /// The reference system as it is stated.
    pub system: String,
    /// Its EPSG code, where it is known and its coordinates are lengths on a map.
    pub epsg: Option<u32>,
    /// What the coordinates count; heights without a unit of their own count as metres, or as the
    /// plan does.
    pub units: SystemUnits,
    /// Where the frame touches the Earth, for geographic coordinates: x east, y north, z up.
    pub anchor: Option<Anchor>,
    /// What was subtracted of coordinates on a map, metres: they keep their digits.
    pub offset: Vector3<f64>,
    /// The points.
    pub points: Vec<ControlPoint>,
    /// Words where a role may stand that are none.
    pub no_roles: Vec<String>,
}

/// The points of a list while it is read.
#[derive(Default)]
struct Points {
    points: Vec<ControlPoint>,
    /// What their lines state of their roles so far.
    roles: Vec<Option<Role>>,
    no_roles: Vec<String>,
}

impl Points {
    /// Adds a line; what is wrong with it, and what was expected.
    fn add(&mut self, line: &str) -> std::result::Result<(), (String, &'static str)> {
        let fields = fields(line);
        let numbers: Vec<f64> = (fields.iter().take(5))
            .map_while(|field| number(field).filter(|v| v.is_finite()))
            .collect();
        let (&[x, y, z, u, v], Some(image)) = (&numbers[..], fields.get(5)) else {
            return Err((format!("'{line}'"), COLUMNS));
        };
        let place = [x, y, z];
        let name = fields.get(6);
        let role = Role::of(fields.get(7..).unwrap_or_default(), &mut self.no_roles);
        if let Some(word) = name.filter(|name| role.is_none() && Role::named(name).is_some()) {
            let problem = format!("'{word}' where the name of the point stands");
            return Err((problem, "the name before the role"));
        }
        let known = self.points.iter().position(|p| match name {
            Some(name) => p.name == *name,
            None => p.stated == place,
        });
        let at = known.unwrap_or(self.points.len());
        if known.is_none() {
            self.points.push(ControlPoint {
                name: name.cloned().unwrap_or_else(|| (at + 1).to_string()),
                stated: place,
                position: Point3::origin(),
                marks: Vec::new(),
                role: Role::default(),
            });
            self.roles.push(None);
        }
        let (point, before) = (&mut self.points[at], &mut self.roles[at]);
        if point.stated != place {
            let problem = format!("point {} has other coordinates above", point.name);
            return Err((problem, "one place for each name"));
        }
        point.marks.push((image.clone(), Point2::new(u, v)));
        match (*before, role) {
            (Some(above), Some(role)) if above != role => {
                let problem = format!("point {} is for {above} above, not {role}", point.name);
                Err((problem, "one role for each name"))
            }
            (above, role) => {
                *before = role.or(above);
                point.role = before.unwrap_or_default();
                Ok(())
            }
        }
    }
}

/// Coordinates on a map are counted from a multiple of this, metres.
const GRID_M: f64 = 100.0;

const COLUMNS: &str = "geo_x geo_y geo_z im_x im_y image_name [gcp_name [role]]";

impl GroundControl {
    /// What a list is called among photographs.
    pub const FILE: &str = GCP_LIST;

    /// The `gcp_list.txt` among the files, where there is one.
    ///
    /// # Errors
    /// Where it cannot be read; the message names the line.
    pub fn among(files: &[InputFile]) -> Result<Option<Self>> {
        read_among(files, Self::FILE, Self::read)
    }

    /// Reads a list; `file` is for messages.
    ///
    /// # Errors
    /// Where a line does not follow the format, or a point has two places.
    pub fn read(file: &str, text: &str) -> Result<Self> {
        let list = List::new(file, text)?;
        let (system, first) = (&list.system, list.first);
        let stated = first.text;
        let mut points = Points::default();
        for line in &list.lines {
            (points.add(line.text)).map_err(|(problem, expected)| line.error(problem, expected))?;
        }
        let Points {
            points, no_roles, ..
        } = points;
        let fit = |[x, y]: [usize; 2]| {
            let mut places = points
                .iter()
                .map(|p| [p.stated[x].abs(), p.stated[y].abs()]);
            places.all(|[lon, lat]| lon <= 180.0 && lat <= 90.0)
        };
        if matches!(system.units.plan, PlanUnit::Angle(_)) && !fit([0, 1]) {
            let problem = match fit([1, 0]) {
                true => "latitude before longitude",
                false => "longitudes and latitudes, but the points have others",
            };
            let expected = "longitude first, then latitude, or the system of the coordinates";
            return Err(first.error(format!("'{stated}': {problem}"), expected));
        }
        if system.is_other_datum() {
            let problem = format!("'{stated}': no way from its datum to WGS84 is known here");
            let expected = "coordinates converted to EPSG:4326 or to a map (cs2cs of PROJ does)";
            return Err(first.error(problem, expected));
        }
        let is_on_map = matches!(system.units.plan, PlanUnit::Length(_));
        let mut control = Self {
            // Well-known text has its name in the first quotation marks.
            system: stated.split('"').nth(1).unwrap_or(stated).to_owned(),
            epsg: system.epsg.filter(|_| is_on_map),
            units: system.units,
            anchor: None,
            offset: Vector3::zeros(),
            points,
            no_roles,
        };
        control.set_frame();
        Ok(control)
    }

    /// What is doubtful of the roles, a sentence.
    pub(super) fn words(&self) -> Option<String> {
        let others = listed(self.no_roles.iter().map(String::as_str));
        (!self.no_roles.is_empty()).then(|| {
            format!(
                "in {} words behind the names of points are no role: {others}; those points count as \
                 if they were not there (roles are {})",
                Self::FILE,
                Role::WORDS
            )
        })
    }

    /// The same points with other coordinates or marks.
    pub(super) fn changed(&self, change: impl Fn(&mut ControlPoint)) -> Self {
        let mut changed = self.clone();
        changed.points.iter_mut().for_each(change);
        changed.set_frame();
        changed
    }

    /// The same points in other units.
    pub(super) fn in_units(&self, units: SystemUnits) -> Self {
        let mut changed = self.clone();
        changed.units = units;
        changed.set_frame();
        changed
    }

    /// Longitude and latitude of a position of the frame, degrees, where its system is known.
    pub(super) fn on_earth(&self, p: &Point3<f64>) -> Option<[f64; 2]> {
        if let Some(anchor) = self.anchor {
            let [lon, lat, _] = anchor.geographic(p);
            return Some([lon, lat]);
        }
        let on_map = p + self.offset;
        let grid = TransverseMercator::of_epsg(self.epsg?)?;
        Some(grid.geographic(on_map.x, on_map.y))
    }

    /// Positions in metres near zero.
    fn set_frame(&mut self) {
        // Where only the height is known the place need not be exact.
        let has_plan = |p: &&ControlPoint| p.role.known != KnownOf::Height;
        let first = (self.points.iter().find(has_plan)).or(self.points.first());
        let Some(first) = first.map(|p| p.stated) else {
            return;
        };
        let metres = |unit: Option<LinearUnit>| unit.map_or(1.0, |u| u.metres);
        let geocentric = |[x, y, z]: [f64; 3]| match self.units.plan {
            PlanUnit::Length(_) => None,
            PlanUnit::Geocentric => Some(Point3::new(x, y, z)),
            PlanUnit::Angle(deg) => Some(geocentric_of(
                x * deg,
                y * deg,
                z * metres(self.units.height),
            )),
        };
        self.anchor = geocentric(first).map(|zero| Anchor::near(&zero));
        let (plan, height) = match self.units.plan {
            PlanUnit::Length(unit) => (unit.metres, metres(self.units.height.or(Some(unit)))),
            _ => (1.0, 1.0),
        };
        let on_map = |[x, y, z]: [f64; 3]| Point3::new(x * plan, y * plan, z * height);
        let round = |v: f64| (v * plan / GRID_M).round() * GRID_M;
        self.offset = match self.anchor {
            Some(_) => Vector3::zeros(),
            None => Vector3::new(round(first[0]), round(first[1]), 0.0),
        };
        let positions: Vec<Point3<f64>> = (self.points.iter())
            .map(|point| match (self.anchor, geocentric(point.stated)) {
                (Some(anchor), Some(place)) => anchor.local(&place),
                _ => on_map(point.stated) - self.offset,
            })
            .collect();
        for (point, position) in self.points.iter_mut().zip(positions) {
            point.position = position;
        }
    }
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
    fn feet_become_metres() {
        let point = "757900.176 2956038.381 1085.956 1 2 a.jpg p\n";
        let us = 1200.0 / 3937.0;
        for (system, plan, height) in [
            ("EPSG:2249", us, us),
            ("EPSG:2249+5703", us, 1.0),
            ("EPSG:2249+6360", us, us),
            ("EPSG:2223", 0.3048, 0.3048),
            ("EPSG:26986", 1.0, 1.0),
            ("+proj=lcc +lat_0=41 +units=us-ft", us, us),
            (
                "+proj=lcc +lat_0=41 +to_meter=0.3048 +vunits=m",
                0.3048,
                1.0,
            ),
            ("PROJCS[\"x\",UNIT[\"Foot_US\",0.3048006096012192]]", us, us),
        ] {
            let control = read(&format!("{system}\n{point}")).unwrap();
            let place = control.points[0].position + control.offset;
            let truth = Point3::new(757_900.176 * plan, 2_956_038.381 * plan, 1085.956 * height);
            assert!((place - truth).norm() < 1e-6, "{system}: {place}");
            assert_eq!(control.points[0].stated[0], 757_900.176);
        }
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
            ("EPSG:6318\n432100 5412300 3 4 5 a.jpg p", "longitudes"),
            ("EPSG:4314\n8.4 49.0 3 4 5 a.jpg p", "its datum"),
            ("EPSG:4326\n-35.3 149.1 3 4 5 a.jpg p", "latitude before"),
            (
                "+proj=lcc +units=cubit\n1 2 3 4 5 a.jpg",
                "a reference system",
            ),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
    }
}
