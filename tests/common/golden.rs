//! What a run found, as a small text that a reader of a diff understands, and the comparison of two
//! such texts within tolerances.
//!
//! The text is made of the files that every run writes, report.json and model.city.json, natively
//! and in wasm.

use std::fmt::Write as _;

use nalgebra::{Point3, Vector3};
use serde_json::Value;

/// Counts of what there are many of, relative: small changes of a stage move a few of them.
const COUNT_SHARE: f64 = 0.05;

/// Counts that say what the model is made of, which are never near enough.
const EXACT_COUNTS: [&str; 5] = ["views", "facets", "buildings", "faces", "corners"];

/// Slope and azimuth, degrees.
const ANGLE_DEG: f64 = 0.3;

/// Heights and corners, metres: less than any change that is seen in a model.
const LENGTH_M: f64 = 0.03;

/// Areas and volumes, relative.
const SIZE_SHARE: f64 = 0.01;

/// Slopes below have no azimuth, degrees.
const FLAT_DEG: f64 = 2.0;

/// Differences that are told one by one.
const MOST_TOLD: usize = 12;

/// What a golden file says before its first section.
pub fn heading(scene: &str) -> String {
    format!(
        "# What each method finds in the synthetic scene '{scene}'; rewritten by `make golden`.\n\
         # Heights (of a facet: at its middle) and corners x y z in metres, slopes and azimuths of the downward\n\
         # direction, clockwise from north, in degrees, areas in space in square metres, volumes in cubic metres.\n\
         # Compared within {LENGTH_M} m, {ANGLE_DEG} degrees, {} % of areas and volumes; {} % of counts (one at least), but\n\
         # {} exactly.\n",
        SIZE_SHARE * 100.0,
        COUNT_SHARE * 100.0,
        EXACT_COUNTS.join(", "),
    )
}

/// The section of a method: counts of its stages, buildings, facets with their corners.
pub fn section(method: &str, files: &[(String, Vec<u8>)]) -> String {
    let json = |name: &str| -> Value {
        let (_, bytes) = (files.iter().find(|(n, _)| n == name)).expect("every run writes it");
        serde_json::from_slice(bytes).expect("it is JSON")
    };
    let mut text = format!("\nmethod {method}\n");
    for stage in list(&json("report.json")["stages"]) {
        let counts = by_name(&stage["counts"]);
        let counts: Vec<_> = counts.iter().map(|(k, n)| format!("{k} {n}")).collect();
        let name = stage["stage"].as_str().expect("a stage has a name");
        line(&mut text, &format!("stage {name}: {}", counts.join(", ")));
    }
    buildings(&json("model.city.json"), &mut text);
    text
}

/// The section of this method in a golden file.
pub fn section_of<'a>(golden: &'a str, method: &str) -> &'a str {
    let start = golden.find(&format!("\nmethod {method}\n"));
    let rest = &golden[start.expect("the golden file has the method: make golden")..];
    let end = rest[1..]
        .find("\nmethod ")
        .map_or(rest.len(), |end| end + 1);
    &rest[..end]
}

/// What differs by more than the tolerances, a sentence each; numbers are told with what they
/// measure.
pub fn differences(expected: &str, found: &str) -> Vec<String> {
    let lines = |text: &'_ str| -> Vec<String> { text.trim().lines().map(Into::into).collect() };
    let (expected, found) = (lines(expected), lines(found));
    let mut told = Vec::new();
    for i in 0..expected.len().max(found.len()) {
        match (expected.get(i), found.get(i)) {
            (Some(a), Some(b)) => told.extend(
                line_difference(a, b).map(|why| format!("line {}: {why}\n  - {a}\n  + {b}", i + 1)),
            ),
            (Some(a), None) => told.push(format!("line {} is missing\n  - {a}", i + 1)),
            (None, Some(b)) => told.push(format!("line {} is new\n  + {b}", i + 1)),
            (None, None) => {}
        }
    }
    let more = told.len().saturating_sub(MOST_TOLD);
    if more > 0 {
        told.truncate(MOST_TOLD);
        told.push(format!("and {more} more"));
    }
    told
}

fn line_difference(expected: &str, found: &str) -> Option<String> {
    let words = |line: &'_ str| -> Vec<String> {
        let parts = line.split([' ', ',', ':']).filter(|w| !w.is_empty());
        parts.map(Into::into).collect()
    };
    let (a, b) = (words(expected), words(found));
    if a.len() != b.len() {
        return Some("another content".into());
    }
    // A number is of what the last word before it says.
    let mut label = "";
    for (a, b) in a.iter().zip(&b) {
        match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => {
                let (apart, most) = (distance(label, x, y), tolerance(label, x));
                // Both are rounded to what is written.
                if apart > most + 1e-9 {
                    return Some(format!(
                        "{label} differs by {apart:.3}, more than {most:.3}"
                    ));
                }
            }
            _ if a != b => return Some(format!("'{b}' instead of '{a}'")),
            _ => label = a,
        }
    }
    None
}

fn distance(label: &str, a: f64, b: f64) -> f64 {
    let apart = (a - b).abs();
    if label == "azimuth" {
        apart.min(360.0 - apart)
    } else {
        apart
    }
}

fn tolerance(label: &str, expected: f64) -> f64 {
    match label {
        "slope" | "azimuth" => ANGLE_DEG,
        "ground" | "height" | "corner" => LENGTH_M,
        "area" | "volume" => SIZE_SHARE * expected,
        _ if EXACT_COUNTS.contains(&label) => 0.0,
        _ => (COUNT_SHARE * expected).max(1.0),
    }
}

fn buildings(city: &Value, text: &mut String) {
    let steps = &city["transform"];
    let vertices: Vec<Point3<f64>> = list(&city["vertices"])
        .iter()
        .map(|v| {
            let world = |i: usize| {
                number(&v[i]) * number(&steps["scale"][i]) + number(&steps["translate"][i])
            };
            Point3::new(world(0), world(1), world(2))
        })
        .collect();
    for (name, object) in by_name(&city["CityObjects"]) {
        let about = &object["attributes"];
        line(
            text,
            &format!(
                "{name}: ground {:.2}, volume {:.1}",
                number(&about["groundHeight"]),
                number(&about["volume"])
            ),
        );
        let solid = &object["geometry"][0];
        let kinds = list(&solid["semantics"]["surfaces"]);
        let faces = list(&solid["boundaries"][0]).iter().zip(kinds);
        let mut facets: Vec<RoofFacet> = faces
            .filter(|(_, kind)| kind["type"] == "RoofSurface")
            .map(|(rings, _)| RoofFacet::new(rings, &vertices))
            .collect();
        facets.sort_by(|a, b| place(&a.middle).total_cmp(&place(&b.middle)));
        facets.iter().for_each(|facet| facet.write(text));
    }
}

/// Orders points in plan along a direction in which those of a house, which is symmetric, hardly
/// tie.
fn place(p: &Point3<f64>) -> f64 {
    p.x + 0.618 * p.y
}

/// A roof face of a solid.
struct RoofFacet {
    /// Its area along its normal.
    area: Vector3<f64>,
    middle: Point3<f64>,
    /// Outer ring, then holes.
    rings: Vec<Vec<Point3<f64>>>,
}

impl RoofFacet {
    fn new(rings: &Value, vertices: &[Point3<f64>]) -> Self {
        let corner = |v: &Value| vertices[v.as_u64().expect("an index") as usize];
        let mut rings: Vec<Vec<Point3<f64>>> = list(rings)
            .iter()
            .map(|ring| list(ring).iter().map(corner).collect())
            .collect();
        // From the same corner, wherever the solid begins.
        for ring in &mut rings {
            let first =
                (0..ring.len()).min_by(|&i, &j| place(&ring[i]).total_cmp(&place(&ring[j])));
            ring.rotate_left(first.expect("a ring has corners"));
        }
        // Fans around one corner: signed, so that holes and what is not convex count as they
        // should.
        let (mut area, mut moment) = (Vector3::zeros(), Vector3::zeros());
        let mut weight = 0.0;
        for ring in &rings {
            for pair in ring[1..].windows(2) {
                let part = 0.5 * (pair[0] - ring[0]).cross(&(pair[1] - ring[0]));
                area += part;
                weight += part.z;
                moment += part.z * (ring[0].coords + pair[0].coords + pair[1].coords) / 3.0;
            }
        }
        Self {
            area,
            middle: Point3::from(moment / weight),
            rings,
        }
    }

    fn write(&self, text: &mut String) {
        let [x, y, z] = self.area.into();
        let slope = libm::atan2(libm::hypot(x, y), z).to_degrees();
        let azimuth = if slope < FLAT_DEG {
            "none".to_owned()
        } else {
            format!(
                "{:.1}",
                libm::atan2(x, y).to_degrees().rem_euclid(360.0) + 0.0
            )
        };
        let corners: usize = self.rings.iter().map(Vec::len).sum();
        line(
            text,
            &format!(
                "  facet: slope {slope:.1}, azimuth {azimuth}, height {:.2}, area {:.2}, corners {corners}",
                self.middle.z,
                self.area.norm()
            ),
        );
        for p in self.rings.iter().flatten() {
            let [x, y, z] = [p.x, p.y, p.z].map(centimetres);
            line(text, &format!("    corner {x:>7} {y:>7} {z:>7}"));
        }
    }
}

/// Metres to the centimetre, without a negative zero.
fn centimetres(metres: f64) -> String {
    format!("{:.2}", (metres * 100.0).round() / 100.0 + 0.0)
}

/// Sorted: whether a map of serde_json keeps the order of the file depends on what else is
/// compiled.
fn by_name(value: &Value) -> Vec<(&String, &Value)> {
    let mut members: Vec<_> = value.as_object().expect("an object").iter().collect();
    members.sort_by_key(|&(name, _)| name);
    members
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn line(text: &mut String, content: &str) {
    writeln!(text, "{content}").expect("a String takes all that is written");
}
