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
    let expected = "GeoJSON or CityJSON, or one feature a line";
    json_of(&file.text()).map_err(|line| Error::line(&file.path, line, "it is no JSON", expected))
}

/// The value of a text; otherwise the line that is damaged.
pub(crate) fn json_of(text: &str) -> std::result::Result<Value, usize> {
    let whole = text.trim_start_matches(is_before);
    let skipped = text[..text.len() - whole.len()].matches('\n').count();
    let problem = match serde_json::from_str(whole) {
        Ok(value) => return Ok(value),
        Err(problem) => problem,
    };
    let mut values: Vec<Value> = Vec::new();
    for (i, line) in whole.lines().enumerate() {
        let line = line.trim_matches(is_before);
        match serde_json::from_str(line) {
            Ok(value) => values.push(value),
            Err(_) if line.is_empty() => {}
            // A value that is damaged is so at its own line.
            Err(_) if values.is_empty() => return Err(skipped + problem.line()),
            Err(_) => return Err(skipped + i + 1),
        }
    }
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
