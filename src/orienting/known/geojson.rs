//! Footprints of GeoJSON (RFC 7946): longitude and latitude on WGS84, unless the member `crs` of
//! GeoJSON 2008 names another system. `"crs": null`, which that version has for coordinates of no
//! known system, stands for the frame of the orientation.

use serde_json::Value;

use super::footprint::Outline;
use super::refusal::refusal;
use super::system::{StatedSystem, Way, WorldSystem};
use crate::base::error::Result;
use crate::orienting::orientation::InputFile;

pub(super) fn read(file: &InputFile, json: &Value, system: &WorldSystem) -> Result<Vec<Outline>> {
    let refuse = |problem: &str| {
        let advice = "state the system of the orientation (--crs), or convert the file to it with \
                      ogr2ogr and name it in its crs member";
        refusal(&file.path, problem, advice)
    };
    let stated = match json.get("crs") {
        None => StatedSystem::LongitudeLatitude,
        Some(Value::Null) => StatedSystem::Unstated,
        Some(crs) => match crs["properties"]["name"].as_str() {
            Some(name) => StatedSystem::named(name),
            None => return Err(refuse("its member crs names no system")),
        },
    };
    let way = system
        .way_from(&stated)
        .map_err(|problem| refuse(&problem))?;
    let one = std::slice::from_ref(json);
    let features = match json["type"].as_str() {
        Some("FeatureCollection") => json["features"].as_array().map_or(&[][..], Vec::as_slice),
        _ => one,
    };
    let mut outlines = Vec::new();
    for (i, feature) in features.iter().enumerate() {
        let geometry = match feature["type"].as_str() {
            Some("Feature") => &feature["geometry"],
            _ => feature,
        };
        let coordinates = &geometry["coordinates"];
        let polygons = match geometry["type"].as_str() {
            Some("Polygon") => std::slice::from_ref(coordinates),
            Some("MultiPolygon") => coordinates.as_array().map_or(&[][..], Vec::as_slice),
            // Points and lines are no footprints.
            _ => continue,
        };
        let name = name_of(feature, i);
        for polygon in polygons {
            let rings = rings_of(polygon, &way).ok_or_else(|| {
                refusal(
                    &file.path,
                    &format!("the coordinates of footprint {name} are no places"),
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
