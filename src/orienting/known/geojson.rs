//! Footprints of GeoJSON (RFC 7946): longitude and latitude on WGS84, unless the member `crs` of
//! GeoJSON 2008 names another system. `"crs": null`, which that version has for coordinates of no
//! known system, stands for the frame of the orientation, and so do coordinates that are no
//! longitude and latitude, as many programs write them without a word.

use serde_json::Value;

use super::footprint::Outline;
use super::system::{StatedSystem, Way, WorldSystem};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;

/// Reads footprints; what was assumed of them goes to `warnings`.
pub(super) fn read(
    file: &InputFile,
    json: &Value,
    system: &WorldSystem,
    warnings: &mut Vec<String>,
) -> Result<Vec<Outline>> {
    let refuse = |problem: &str| {
        let advice = "state the system of the orientation (--crs), or convert the file to it with \
                      ogr2ogr and name it in its crs member";
        Error::file(&file.path, problem, advice)
    };
    let one = std::slice::from_ref(json);
    let features = match json["type"].as_str() {
        Some("FeatureCollection") => json["features"].as_array().map_or(&[][..], Vec::as_slice),
        _ => one,
    };
    let stated = match json.get("crs") {
        None if has_lengths(features) => {
            let said = "states no system, and its coordinates are no longitude and latitude: they \
                        are taken for those of the orientation";
            warnings.push(format!("{} {said}", file.path));
            StatedSystem::unstated()
        }
        None => StatedSystem::longitude_latitude(),
        Some(Value::Null) => StatedSystem::unstated(),
        Some(crs) => stated_of(crs).ok_or_else(|| refuse("its member crs names no system"))?,
    };
    let way = system.way_from(&stated);
    let way = way.map_err(|problem| refuse(&problem))?;
    let mut outlines = Vec::new();
    for (i, feature) in features.iter().enumerate() {
        let geometry = match feature["type"].as_str() {
            Some("Feature") => &feature["geometry"],
            _ => feature,
        };
        let name = name_of(feature, i);
        for polygon in polygons_of(geometry) {
            let rings = rings_of(polygon, &way).ok_or_else(|| {
                Error::file(
                    &file.path,
                    format!("the coordinates of footprint {name} are no places"),
                    "give rings of positions, each two or three finite numbers in the stated system",
                )
            })?;
            outlines.push(Outline {
                name: name.clone(),
                rings,
            });
        }
    }
    Ok(outlines)
}

/// The polygons of a geometry; points and lines are no footprints.
fn polygons_of(geometry: &Value) -> Vec<&Value> {
    let all = |name: &str| geometry[name].as_array().into_iter().flatten();
    match geometry["type"].as_str() {
        Some("Polygon") => vec![&geometry["coordinates"]],
        Some("MultiPolygon") => all("coordinates").collect(),
        Some("GeometryCollection") => all("geometries").flat_map(polygons_of).collect(),
        _ => Vec::new(),
    }
}

/// Exchanges x and y of all positions.
pub(super) fn exchange(json: &mut Value) {
    match json {
        Value::Array(position) if position.len() > 1 && position[0].is_number() => {
            position.swap(0, 1);
        }
        Value::Array(inner) => inner.iter_mut().for_each(exchange),
        Value::Object(members) => members.values_mut().for_each(exchange),
        _ => {}
    }
}

/// The system of GeoJSON 2008's member, or of the form before that (`"type": "EPSG"`).
fn stated_of(crs: &Value) -> Option<StatedSystem> {
    // PROJJSON has its code in `id`; of a compound system the first part is that of the plan.
    let plan = &crs["components"][0]["id"];
    let properties = [&crs["id"], plan, &crs["properties"]]
        .into_iter()
        .find(|member| !member.is_null())
        .unwrap_or(&Value::Null);
    match (
        crs.as_str().or(properties["name"].as_str()),
        &properties["code"],
    ) {
        (Some(name), _) => Some(StatedSystem::named(name)),
        (None, Value::Number(code)) => Some(StatedSystem::named(&code.to_string())),
        (None, Value::String(code)) => Some(StatedSystem::named(code)),
        _ => None,
    }
}

/// Is the first position of any polygon further from zero than degrees go?
fn has_lengths(features: &[Value]) -> bool {
    let first = |feature: &Value| {
        let geometry = feature.get("geometry").unwrap_or(feature);
        let mut inner = &geometry["coordinates"];
        while inner[0].is_array() {
            inner = &inner[0];
        }
        Some([inner.get(0)?.as_f64()?, inner.get(1)?.as_f64()?])
    };
    let mut positions = features.iter().filter_map(first);
    positions.any(|[x, y]| x.abs() > 360.0 || y.abs() > 90.0)
}

/// The identifier of a feature, or its number from 1.
fn name_of(feature: &Value, index: usize) -> String {
    let properties = &feature["properties"];
    let named = [
        &feature["id"],
        &properties["id"],
        &properties["gml_id"],
        &properties["name"],
    ];
    let text = named.iter().find_map(|value| match value {
        Value::String(text) => Some(text.chars().take(80).collect()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    });
    text.unwrap_or_else(|| (index + 1).to_string())
}

fn rings_of(polygon: &Value, way: &Way) -> Option<Vec<Vec<[f64; 2]>>> {
    let position = |p: &Value| way.world([p.get(0)?.as_f64()?, p.get(1)?.as_f64()?]);
    let ring = |ring: &Value| ring.as_array()?.iter().map(position).collect();
    polygon.as_array()?.iter().map(ring).collect()
}
