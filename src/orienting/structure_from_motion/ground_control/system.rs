//! What OpenDroneMap's lists have in common: a reference system in the first line, then a line for
//! each thing.

use crate::base::error::{Error, Result};
use crate::orienting::orientation::{
    InputFile, LinearUnit, PlanUnit, SystemUnits, epsg_of, units_of,
};

/// A list in its lines.
pub(super) struct List<'t> {
    file: &'t str,
    /// The first line, and its place.
    pub first: (usize, &'t str),
    /// What that says.
    pub system: StatedSystem,
    /// The lines below it with their places; comments and empty ones are left out.
    pub lines: Vec<(usize, &'t str)>,
}

impl<'t> List<'t> {
    /// Reads the first line; `file` is for messages.
    pub(super) fn new(file: &'t str, text: &'t str) -> Result<Self> {
        let mut lines = (text.trim_start_matches('\u{feff}').lines().enumerate())
            .map(|(i, line)| (i, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let first = lines.next().unwrap_or((0, ""));
        let system = StatedSystem::of(first.1).ok_or_else(|| {
            let problem = format!("'{}'", first.1);
            refused(file, first.0, problem, StatedSystem::EXPECTED)
        })?;
        Ok(Self {
            file,
            first,
            system,
            lines: lines.collect(),
        })
    }

    /// The refusal of a line.
    pub(super) fn refused(&self, line: usize, problem: String, expected: &str) -> Error {
        refused(self.file, line, problem, expected)
    }
}

fn refused(file: &str, line: usize, problem: String, expected: &str) -> Error {
    Error::Line {
        file: file.to_owned(),
        line: line + 1,
        problem,
        expected: expected.to_owned(),
    }
}

/// The list of a name among files, read by its path and text, where there is one.
pub(super) fn read_among<T>(
    files: &[InputFile],
    name: &str,
    read: impl Fn(&str, &str) -> Result<T>,
) -> Result<Option<T>> {
    let found = files.iter().find(|f| f.name().eq_ignore_ascii_case(name));
    found.map(|f| read(&f.path, &f.text())).transpose()
}

/// What the first line says.
pub(in super::super) struct StatedSystem {
    pub epsg: Option<u32>,
    pub units: SystemUnits,
}

impl StatedSystem {
    /// What a first line has to be.
    pub(in super::super) const EXPECTED: &str = "a reference system in the first line: EPSG:25832, \
        WGS84 UTM 32N, or +proj=... with a unit of PROJ";

    /// What a line says of the reference system; `None` where it is none, or its unit is not known.
    pub(in super::super) fn of(line: &str) -> Option<Self> {
        let upper = line.to_ascii_uppercase();
        let is_named = line.contains('[') || upper.contains("EPSG");
        if upper.contains("+PROJ=") || is_named {
            let units = units_of(line).or_else(|| units_of(&line.to_ascii_lowercase()))?;
            let is_metric = units.plan == PlanUnit::Length(LinearUnit::METRE);
            let of_utm = utm_of_proj(&upper).filter(|_| is_metric);
            let epsg = epsg_of(line).or(of_utm);
            return Some(Self { epsg, units });
        }
        let zone = upper.split("UTM").nth(1)?.trim();
        let zone = zone.strip_prefix("ZONE").unwrap_or(zone).trim();
        let is_south = zone.ends_with('S');
        let number = zone.trim_end_matches(['N', 'S']).trim().parse().ok()?;
        let epsg = utm(number, is_south)?;
        Some(Self {
            epsg: Some(epsg).filter(|_| upper.contains("WGS")),
            units: SystemUnits {
                plan: PlanUnit::Length(LinearUnit::METRE),
                height: None,
            },
        })
    }
}

/// The fields of a line, which blanks, tabs, commas or semicolons part.
pub(super) fn fields(line: &str) -> Vec<&str> {
    let parts = line.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';'));
    parts.filter(|field| !field.is_empty()).collect()
}

/// EPSG code of a PROJ text of UTM on WGS84.
fn utm_of_proj(upper: &str) -> Option<u32> {
    let is_utm = upper.contains("+PROJ=UTM") && upper.contains("=WGS84");
    let mut words = upper.split_whitespace();
    let zone = words.find_map(|w| w.strip_prefix("+ZONE="))?.parse().ok()?;
    utm(zone, upper.contains("+SOUTH")).filter(|_| is_utm)
}

/// EPSG code of a zone of UTM on WGS84.
fn utm(zone: u32, is_south: bool) -> Option<u32> {
    let first = if is_south { 32_700 } else { 32_600 };
    (1..=60).contains(&zone).then_some(first + zone)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_systems_in_all_their_forms() {
        let of = |line: &str| {
            let system = StatedSystem::of(line)?;
            Some((system.epsg, matches!(system.units.plan, PlanUnit::Angle(_))))
        };
        assert_eq!(of("WGS84 UTM 32N"), Some((Some(32632), false)));
        assert_eq!(of("WGS84 UTM 7S"), Some((Some(32707), false)));
        let proj = "+proj=utm +zone=10 +ellps=WGS84 +datum=WGS84 +units=m +no_defs";
        assert_eq!(of(proj), Some((Some(32610), false)));
        assert_eq!(of("+proj=longlat +datum=WGS84"), Some((Some(4326), true)));
        assert_eq!(of("epsg:4326"), Some((Some(4326), true)));
        assert_eq!(of("+proj=tmerc +lat_0=0 +lon_0=9"), Some((None, false)));
        assert_eq!(of("+proj=lcc +units=us-ft"), Some((None, false)));
        assert_eq!(of("+proj=lcc +units=cubit"), None);
        assert_eq!(of("EPSG:6318"), Some((Some(6318), true)));
        assert_eq!(of("432150.0 5412300.0 120.0 10 20 a.jpg"), None);
    }
}
