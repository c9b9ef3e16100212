//! What OpenDroneMap's lists have in common: a reference system in the first line, then a line for
//! each thing.

use crate::base::error::Result;
use crate::orienting::orientation::{
    InputFile, PlanUnit, SystemUnits, TextLine, data_lines, epsg_of, is_geographic, units_of,
};

/// A list in its lines.
pub(super) struct List<'t> {
    pub first: TextLine<'t>,
    /// What that says.
    pub system: StatedSystem,
    /// The lines below it; comments and empty ones are left out.
    pub lines: Vec<TextLine<'t>>,
}

impl<'t> List<'t> {
    /// Reads the first line; `file` is for messages.
    pub(super) fn new(file: &'t str, text: &'t str) -> Result<Self> {
        let mut lines = data_lines(file, text);
        let first = lines.next().unwrap_or(TextLine {
            file,
            number: 1,
            text: "",
        });
        let system = StatedSystem::of(first.text)
            .ok_or_else(|| first.error(format!("'{}'", first.text), StatedSystem::EXPECTED))?;
        Ok(Self {
            first,
            system,
            lines: lines.collect(),
        })
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
        let small = line.to_ascii_lowercase();
        let is_proj = small.contains("+proj=");
        let line = if is_proj { &small } else { line };
        // A zone without a datum is one of metres.
        let is_zone = !is_proj && small.contains("utm");
        let units = units_of(line).or(is_zone.then_some(SystemUnits::METRES))?;
        let epsg = epsg_of(line);
        Some(Self { epsg, units })
    }

    /// Is it longitude and latitude of a datum from which no way to WGS84 is known here?
    pub(super) fn is_other_datum(&self) -> bool {
        matches!(self.units.plan, PlanUnit::Angle(_)) && !self.epsg.is_some_and(is_geographic)
    }
}

/// The fields of a line, which blanks, tabs, semicolons or commas part. Where something else does,
/// commas between digits are those of numbers.
pub(super) fn fields(line: &str) -> Vec<String> {
    let parted = |by_commas: bool| -> Vec<&str> {
        let is_between = |c: char| c.is_whitespace() || c == ';' || c == ',' && by_commas;
        let fields = line.split(is_between);
        fields.filter(|field| !field.is_empty()).collect()
    };
    let with_point = |field: &str| field.replace(',', ".");
    let is_number = |field: &str| {
        let is_inside = !field.starts_with(',') && !field.ends_with(',');
        is_inside && number(&with_point(field)).is_some()
    };
    let others = parted(false);
    let is_decimal = others.iter().all(|f| !f.contains(',') || is_number(f));
    let fields = match others.len() > 1 && is_decimal {
        true => others,
        false => parted(true),
    };
    fields.into_iter().map(with_point).collect()
}

/// A number, or degrees with minutes and seconds and the letter of their hemisphere: 8°24'0.4"E,
/// N49d0'0.5, 49:00:00S.
pub(super) fn number(field: &str) -> Option<f64> {
    if let Ok(number) = field.parse::<f64>() {
        return Some(number);
    }
    let is_letter = |c: char| "NSEWnsew".contains(c);
    let is_negative = field.starts_with('-') || field.contains(['S', 'W', 's', 'w']);
    let body = field.trim_matches(is_letter).trim_start_matches('-');
    let is_mark = |c: char| "°º:dm'\"’”′″".contains(c);
    let parts = body.split(is_mark).filter(|part| !part.is_empty());
    let parts: Vec<f64> = parts.map(|part| part.parse().ok()).collect::<Option<_>>()?;
    let is_minute = |part: &f64| (0.0..60.0).contains(part);
    let is_angle = (1..=3).contains(&parts.len()) && parts[1..].iter().all(is_minute);
    let degrees = parts.iter().rev().fold(0.0, |sum, part| part + sum / 60.0);
    is_angle.then_some(if is_negative { -degrees } else { degrees })
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
        assert_eq!(of("UTM 32N"), Some((None, false)));
        assert_eq!(of("NAD83 / UTM zone 10N"), Some((Some(32610), false)));
        assert_eq!(of("432150.0 5412300.0 120.0 10 20 a.jpg"), None);
    }

    #[test]
    fn commas_part_fields_or_stand_in_numbers() {
        for (line, expected) in [
            ("1,5 2,25 a.jpg", vec!["1.5", "2.25", "a.jpg"]),
            ("1,5;2,25;a b.jpg", vec!["1.5", "2.25", "a", "b.jpg"]),
            ("1.5,2.25,a.jpg", vec!["1.5", "2.25", "a.jpg"]),
            ("1, 2, a.jpg", vec!["1", "2", "a.jpg"]),
            ("1,2,a b.jpg", vec!["1", "2", "a", "b.jpg"]),
            ("a.jpg,8,49", vec!["a.jpg", "8", "49"]),
            ("1,2", vec!["1", "2"]),
            ("8°24'0,5\"E 49,5", vec!["8°24'0.5\"E", "49.5"]),
        ] {
            assert_eq!(fields(line), expected, "{line}");
        }
    }

    #[test]
    fn angles_in_many_spellings() {
        for (text, degrees) in [
            ("8.4", 8.4),
            ("8.4E", 8.4),
            ("W8.4", -8.4),
            ("8°24'0\"E", 8.4),
            ("8°24′0″W", -8.4),
            ("8d24'0\"S", -8.4),
            ("N8:24:00.0", 8.4),
            ("-8:24:0", -8.4),
            ("8°24'n", 8.4),
            ("8º24.0'N", 8.4),
        ] {
            let found = number(text).unwrap_or_else(|| panic!("{text}"));
            assert!((found - degrees).abs() < 1e-9, "{text}: {found}");
        }
        for none in ["", "E", "a.jpg", "8°61'0\"E", "1:2:3:4", "8,4", "d1.png"] {
            assert_eq!(number(none), None, "{none}");
        }
    }
}
