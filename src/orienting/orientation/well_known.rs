//! The code of a reference system that is written out: well-known text (of OGC 01-009 as of ISO
//! 19162, also ESRI's, which has no codes), PROJ's strings, and names of systems of a global datum.

use super::epsg;
use super::epsg::TransverseMercator;

/// What stands before brackets, with the texts and numbers directly in them.
struct Node<'a> {
    parent: usize,
    name: &'a str,
    values: Vec<&'a str>,
}

/// Parts of a system that lie in the plan.
const PLANES: [&str; 8] = [
    "PROJCS",
    "PROJCRS",
    "PROJECTEDCRS",
    "GEOGCS",
    "GEOGCRS",
    "GEOGRAPHICCRS",
    "GEODCRS",
    "GEODETICCRS",
];

/// The code that a system states, else that of the same projection of a datum that counts as WGS84.
pub(super) fn code_of(text: &str) -> Option<u32> {
    if text.contains('[') {
        of_text(&nodes(text))
    } else if text.contains("+proj") {
        of_proj(text)
    } else {
        of_name(&plain(text))
    }
}

/// Metres in the unit of lengths of the first part of these names that states one.
pub(super) fn unit_of_first(text: &str, names: &[&str]) -> Option<f64> {
    let nodes = nodes(text);
    let mut parts = (0..nodes.len()).filter(|&i| is_called(&nodes[i], names));
    parts.find_map(|i| unit(&nodes, i))
}

/// The code of a name, plain: "WGS 84 / UTM zone 32N", "NAD_1983_UTM_Zone_10N", "WGS84".
fn of_name(name: &str) -> Option<u32> {
    const DEGREES: [&str; 4] = ["WGS84", "GCSWGS1984", "ETRS89", "NAD83"];
    if DEGREES.contains(&name) || name.contains("CRS84") {
        return Some(epsg::GEOGRAPHIC);
    }
    let (datum, after) = name.split_once("UTM")?;
    let zone = after.strip_prefix("ZONE").unwrap_or(after);
    let end = zone
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(zone.len());
    let (number, side) = zone.split_at(end);
    let first = if side.starts_with('S') {
        32_700
    } else {
        32_600
    };
    // Zones before the easting, northings first or feet are other planes.
    let is_other = ["ZE", "FT"]
        .iter()
        .any(|other| side.get(1..).is_some_and(|s| s.starts_with(other)));
    let zone: u32 = number.parse().ok().filter(|zone| (1..=60).contains(zone))?;
    (!is_other && (is_global(datum) || is_global(side))).then_some(first + zone)
}

/// The brackets of a text in their order, each after that which holds it.
fn nodes(text: &str) -> Vec<Node<'_>> {
    let mut nodes: Vec<Node> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let (mut word, mut is_quoted) = (0, false);
    for (i, c) in text.char_indices() {
        let is_end = !is_quoted && "[](),".contains(c);
        if c == '"' {
            is_quoted = !is_quoted;
        }
        if !is_end {
            continue;
        }
        let said = text[word..i].trim().trim_matches('"');
        word = i + c.len_utf8();
        match (c, open.last()) {
            ('[' | '(', _) => {
                nodes.push(Node {
                    parent: open.last().copied().unwrap_or(usize::MAX),
                    // What stands before a text that is quoted in another file is no name.
                    name: said.split_whitespace().last().unwrap_or_default(),
                    values: Vec::new(),
                });
                open.push(nodes.len() - 1);
                continue;
            }
            (_, Some(&inside)) if !said.is_empty() => nodes[inside].values.push(said),
            _ => {}
        }
        if c == ']' || c == ')' {
            open.pop();
        }
    }
    nodes
}

fn is_called(node: &Node, names: &[&str]) -> bool {
    names
        .iter()
        .any(|name| node.name.eq_ignore_ascii_case(name))
}

fn number(node: &Node, k: usize) -> Option<f64> {
    node.values.get(k)?.parse().ok()
}

/// The nodes of these names directly in another one.
fn inside<'a, 'b>(
    nodes: &'a [Node<'b>],
    parent: usize,
    names: &'a [&str],
) -> impl Iterator<Item = (usize, &'a Node<'b>)> {
    let all = nodes.iter().enumerate();
    all.filter(move |(_, node)| node.parent == parent && is_called(node, names))
}

fn of_text(nodes: &[Node]) -> Option<u32> {
    // A projected system comes before the geographic one that it holds.
    let first = |names: &[&str]| nodes.iter().position(|node| is_called(node, names));
    let plan = first(&PLANES)?;
    let code = |of: usize| {
        let mut own = inside(nodes, of, &["AUTHORITY", "ID"]);
        let is_epsg = |node: &&Node| {
            node.values
                .first()
                .is_some_and(|v| v.eq_ignore_ascii_case("EPSG"))
        };
        let node = own.find(|(_, node)| is_epsg(node))?.1;
        node.values.get(1)?.parse().ok()
    };
    // The system as a whole is named where it has a number, else its part in the plan.
    let outer = nodes[plan].parent;
    let whole = nodes
        .get(outer)
        .filter(|node| node.name.to_ascii_uppercase().starts_with("COMP"));
    let stated: Option<u32> = whole.and_then(|_| code(outer)).or_else(|| code(plan));
    stated.or_else(|| by_parameters(nodes, plan))
}

/// Metres in the unit of lengths of a part; it stands in it, or in its axes.
fn unit(nodes: &[Node], of: usize) -> Option<f64> {
    const UNITS: [&str; 2] = ["UNIT", "LENGTHUNIT"];
    let axes = inside(nodes, of, &["AXIS"]);
    let of_axes = axes.flat_map(|(axis, _)| inside(nodes, axis, &UNITS));
    let own = inside(nodes, of, &UNITS).chain(of_axes).next();
    number(own?.1, 1)
}

/// The code of the projection that parameters describe, of a datum that counts as WGS84.
fn by_parameters(nodes: &[Node], plan: usize) -> Option<u32> {
    let datum = nodes
        .iter()
        .find(|node| is_called(node, &["DATUM", "ENSEMBLE", "TRF"]))?;
    let datum = plain(datum.values.first()?);
    if !is_global(&datum) {
        return None;
    }
    if nodes[plan].name.to_ascii_uppercase().starts_with("GEO") {
        return Some(epsg::GEOGRAPHIC);
    }
    let method = nodes
        .iter()
        .find(|node| is_called(node, &["PROJECTION", "METHOD"]))?;
    if !["TRANSVERSEMERCATOR", "GAUSSKRUGER"].contains(&&*plain(method.values.first()?)) {
        return None;
    }
    let unit_m = unit(nodes, plan).unwrap_or(1.0);
    let parameter = |names: [&str; 2]| {
        let mut all = nodes.iter().filter(|node| is_called(node, &["PARAMETER"]));
        let is_it = |node: &&Node| {
            let name = node
                .values
                .first()
                .map(|name| plain(name))
                .unwrap_or_default();
            names.contains(&&*name)
        };
        number(all.find(is_it)?, 1)
    };
    let grid = TransverseMercator {
        central_meridian_deg: parameter(["CENTRALMERIDIAN", "LONGITUDEOFNATURALORIGIN"])?,
        scale: parameter(["SCALEFACTOR", "SCALEFACTORATNATURALORIGIN"])?,
        false_easting_m: parameter(["FALSEEASTING", "FALSEEASTING"])? * unit_m,
        equator_m: 0.0,
    };
    let lat_deg = parameter(["LATITUDEOFORIGIN", "LATITUDEOFNATURALORIGIN"])?;
    let north_m = parameter(["FALSENORTHING", "FALSENORTHING"])? * unit_m;
    epsg::code_of(&grid.with_origin(lat_deg, north_m))
}

/// A name without what programs write between its words.
fn plain(name: &str) -> String {
    let letters = name.chars().filter(char::is_ascii_alphanumeric);
    letters.collect::<String>().to_ascii_uppercase()
}

/// Is a datum one of those that count as WGS84?
fn is_global(datum: &str) -> bool {
    const GLOBAL: [&str; 14] = [
        "WGS84",
        "WGS1984",
        "WORLDGEODETICSYSTEM1984",
        "ETRS",
        "EUROPEANTERRESTRIAL",
        "NAD83",
        "NAD1983",
        "NORTHAMERICAN1983",
        "NORTHAMERICANDATUM1983",
        "GDA",
        "ITRF",
        "JGD20",
        "SIRGAS",
        "NZGD2000",
    ];
    GLOBAL.iter().any(|name| datum.contains(name))
}

/// What PROJ's string states of a name.
pub(super) fn proj_value<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let mut words = (text.split_whitespace()).filter_map(|word| word.strip_prefix('+'));
    words.find_map(|word| {
        let (key, value) = word.split_once('=').unwrap_or((word, ""));
        (key == name).then_some(value)
    })
}

/// The code of PROJ's string.
fn of_proj(text: &str) -> Option<u32> {
    let value = |name: &str| proj_value(text, name);
    let number = |name: &str| value(name)?.parse::<f64>().ok();
    let datum = plain(value("datum").or(value("ellps"))?);
    let is_shifted = (value("towgs84")).is_some_and(|by| by.contains(|c| ('1'..='9').contains(&c)));
    if !["WGS84", "GRS80", "NAD83"].contains(&&*datum) || is_shifted {
        return None;
    }
    // PROJ's false easting is in metres whatever the unit is.
    let grid = match value("proj")? {
        "longlat" | "latlong" | "latlon" | "lonlat" => return Some(epsg::GEOGRAPHIC),
        "utm" => TransverseMercator {
            central_meridian_deg: 6.0 * number("zone")? - 183.0,
            scale: 0.9996,
            false_easting_m: 500_000.0,
            equator_m: if value("south").is_some() { 1e7 } else { 0.0 },
        },
        "tmerc" => TransverseMercator {
            central_meridian_deg: number("lon_0").unwrap_or(0.0),
            scale: number("k").or(number("k_0")).unwrap_or(1.0),
            false_easting_m: number("x_0").unwrap_or(0.0),
            equator_m: 0.0,
        }
        .with_origin(number("lat_0").unwrap_or(0.0), number("y_0").unwrap_or(0.0)),
        _ => return None,
    };
    epsg::code_of(&grid)
}
