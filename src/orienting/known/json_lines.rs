//! JSON as one value, or as one a line (GeoJSONSeq of RFC 8142 with or without its separators,
//! CityJSONSeq), which becomes the one that it stands for.

use serde_json::{Map, Value, json};

use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;

/// What may stand before a value: byte order mark, record separators, blanks.
fn is_before(c: char) -> bool {
    c == '\u{feff}' || c == '\u{1e}' || c.is_whitespace()
}

/// Does a text begin as an object does?
pub(super) fn begins(text: &str) -> bool {
    text.trim_start_matches(is_before).starts_with('{')
}

/// The value of a file.
pub(super) fn read(file: &InputFile) -> Result<Value> {
    let text = file.text();
    let refuse = |line: usize| Error::Line {
        file: file.path.clone(),
        line,
        problem: "it is no JSON".to_owned(),
        expected: "GeoJSON or CityJSON, or one feature a line".to_owned(),
    };
    let whole = text.trim_start_matches(is_before);
    let skipped = text[..text.len() - whole.len()].matches('\n').count();
    let problem = match serde_json::from_str(whole) {
        Ok(value) => return Ok(value),
        Err(problem) => problem,
    };
    let values: Option<Vec<Value>> = (whole.lines())
        .map(|line| line.trim_matches(is_before))
        .filter(|line| !line.is_empty())
        .map(|line| serde_json::from_str(line).ok())
        .collect();
    // A value that is damaged is so at its own line.
    let values = match values {
        Some(values) => values,
        None => return Err(refuse(skipped + line_of(whole).unwrap_or(problem.line()))),
    };
    Ok(
        match values
            .first()
            .is_some_and(|first| first["type"] == "CityJSON")
        {
            true => city(values),
            false => {
                // What GDAL writes states its system in the first line, if at all.
                let crs = values.iter().find_map(|value| value.get("crs").cloned());
                let mut all = json!({"type": "FeatureCollection", "features": values});
                if let (Some(crs), Some(all)) = (crs, all.as_object_mut()) {
                    all.insert("crs".to_owned(), crs);
                }
                all
            }
        },
    )
}

/// The first line that is no value, where the first one is: else the file is none of lines.
fn line_of(text: &str) -> Option<usize> {
    let is_value = |line: &str| {
        let line = line.trim_matches(is_before);
        line.is_empty() || serde_json::from_str::<serde::de::IgnoredAny>(line).is_ok()
    };
    let bad = text.lines().position(|line| !is_value(line))?;
    (bad > 0 && text.lines().next().is_some_and(is_value)).then_some(bad + 1)
}

/// CityJSONSeq: a head with the transform, then features with vertices of their own.
fn city(values: Vec<Value>) -> Value {
    let mut values = values.into_iter();
    let mut head = values.next().unwrap_or_default();
    let own =
        |value: &mut Value, name: &str| value.get_mut(name).map(Value::take).unwrap_or_default();
    let mut vertices = own(&mut head, "vertices")
        .as_array()
        .cloned()
        .unwrap_or_default();
    let mut objects = own(&mut head, "CityObjects")
        .as_object()
        .cloned()
        .unwrap_or_default();
    for mut feature in values {
        let first = vertices.len() as u64;
        if let Value::Array(more) = own(&mut feature, "vertices") {
            vertices.extend(more);
        }
        if let Value::Object(more) = own(&mut feature, "CityObjects") {
            objects.extend(more.into_iter().map(|(name, mut object)| {
                for geometry in object["geometry"].as_array_mut().into_iter().flatten() {
                    shift(&mut geometry["boundaries"], first);
                }
                (name, object)
            }));
        }
    }
    let mut all = head.as_object().cloned().unwrap_or_else(Map::new);
    all.insert("vertices".to_owned(), Value::Array(vertices));
    all.insert("CityObjects".to_owned(), Value::Object(objects));
    Value::Object(all)
}

/// Counts vertices on from those before, at whatever depth they are named.
fn shift(boundaries: &mut Value, first: u64) {
    match boundaries {
        Value::Array(inner) => inner.iter_mut().for_each(|inner| shift(inner, first)),
        Value::Number(index) => {
            if let Some(sum) = index.as_u64().and_then(|index| index.checked_add(first)) {
                *boundaries = sum.into();
            }
        }
        _ => {}
    }
}
