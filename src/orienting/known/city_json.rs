//! Footprints of CityJSON 1 and 2: the ground surfaces of each building, or where it has none, the
//! surface that lies lowest. A building whose parts have outlines of their own (3DBAG) is drawn by
//! those.

use serde_json::Value;

use super::footprint::Outline;
use super::system::{StatedSystem, Way, WorldSystem};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;

pub(super) fn read(file: &InputFile, json: &Value, system: &WorldSystem) -> Result<Vec<Outline>> {
    let refuse = |problem: &str, advice: &str| Error::file(&file.path, problem, advice);
    let stated = match &json["metadata"]["referenceSystem"] {
        Value::String(name) => StatedSystem::named(name),
        _ => StatedSystem::unstated(),
    };
    let way = system.way_from(&stated).map_err(|problem| {
        refuse(
            &problem,
            "convert it to the system of the orientation, or state that (--crs)",
        )
    })?;
    let damaged = "copy or convert it again";
    let vertices = vertices(json).ok_or_else(|| refuse("its vertices are damaged", damaged))?;
    let objects = json["CityObjects"].as_object();
    let objects = objects.ok_or_else(|| refuse("it has no CityObjects", damaged))?;
    let mut outlines = Vec::new();
    for (name, object) in objects {
        let is_building = object["type"]
            .as_str()
            .is_some_and(|t| t.starts_with("Building"));
        let is_drawn_by_parts = parts_with_geometry(objects, object);
        let geometries = object["geometry"].as_array();
        let geometries = geometries.filter(|_| is_building && !is_drawn_by_parts);
        // The last one is the most detailed.
        let Some(geometry) = geometries.and_then(|all| all.last()) else {
            continue;
        };
        let mut surfaces = Vec::new();
        collect(
            &geometry["boundaries"],
            &geometry["semantics"]["values"],
            &mut surfaces,
        );
        let grounds = ground_surfaces(&surfaces, &geometry["semantics"]["surfaces"], &vertices)
            .ok_or_else(|| {
                refuse(
                    &format!("building {name} names vertices that there are not"),
                    damaged,
                )
            })?;
        for rings in grounds {
            let world = |ring: Vec<[f64; 3]>| ring.iter().map(|p| plan(&way, p)).collect();
            let rings: Option<Vec<Vec<[f64; 2]>>> = rings.into_iter().map(world).collect();
            let rings = rings.ok_or_else(|| {
                refuse(
                    &format!("the coordinates of building {name} are no places"),
                    damaged,
                )
            })?;
            let name = name.chars().take(80).collect();
            outlines.push(Outline { name, rings });
        }
    }
    Ok(outlines)
}

/// Has a building parts that hold geometry?
fn parts_with_geometry(objects: &serde_json::Map<String, Value>, object: &Value) -> bool {
    let children = object["children"].as_array().into_iter().flatten();
    let mut parts = children.filter_map(|name| objects.get(name.as_str()?));
    parts.any(|part| {
        let is_part = part["type"].as_str() == Some("BuildingPart");
        is_part
            && part["geometry"]
                .as_array()
                .is_some_and(|all| !all.is_empty())
    })
}

fn plan(way: &Way, p: &[f64; 3]) -> Option<[f64; 2]> {
    way.world([p[0], p[1]])
}

fn vertices(json: &Value) -> Option<Vec<[f64; 3]>> {
    let three = |value: &Value| {
        let number = |i: usize| value.get(i)?.as_f64();
        Some([number(0)?, number(1)?, number(2)?])
    };
    let transform = &json["transform"];
    let scale = three(&transform["scale"]).unwrap_or([1.0; 3]);
    let shift = three(&transform["translate"]).unwrap_or([0.0; 3]);
    let vertex = |value: &Value| {
        let p = three(value)?;
        let p = [0, 1, 2].map(|i| p[i] * scale[i] + shift[i]);
        p.iter().all(|v| v.is_finite()).then_some(p)
    };
    json["vertices"].as_array()?.iter().map(vertex).collect()
}

/// A surface with its number among the semantic ones.
struct SurfaceOf<'a> {
    rings: &'a Value,
    semantic: Option<usize>,
}

/// The surfaces of a solid, of several, or of a multi-surface, at whatever depth they stand.
fn collect<'a>(boundaries: &'a Value, values: &Value, surfaces: &mut Vec<SurfaceOf<'a>>) {
    // Each surface is a list of rings, which are lists of numbers.
    let is_ring = |value: &Value| value.get(0).is_some_and(Value::is_number);
    let is_surface = |value: &Value| value.get(0).is_some_and(is_ring);
    for (i, inner) in boundaries.as_array().into_iter().flatten().enumerate() {
        let value = values.get(i).unwrap_or(&Value::Null);
        if is_surface(inner) {
            let semantic = value.as_u64().and_then(|v| usize::try_from(v).ok());
            surfaces.push(SurfaceOf {
                rings: inner,
                semantic,
            });
        } else if !is_ring(inner) {
            collect(inner, value, surfaces);
        }
    }
}

type Rings = Vec<Vec<[f64; 3]>>;

/// The rings of the ground surfaces, or of the lowest level surface where none is called so; `None`
/// where vertices are missing.
fn ground_surfaces(
    surfaces: &[SurfaceOf],
    semantics: &Value,
    vertices: &[[f64; 3]],
) -> Option<Vec<Rings>> {
    let vertex = |index: &Value| {
        let index = usize::try_from(index.as_u64()?).ok()?;
        vertices.get(index).copied()
    };
    let ring = |ring: &Value| ring.as_array()?.iter().map(vertex).collect();
    let rings = |surface: &SurfaceOf| -> Option<Rings> {
        surface.rings.as_array()?.iter().map(ring).collect()
    };
    let all: Option<Vec<Rings>> = surfaces.iter().map(rings).collect();
    let all = all?;
    let is_ground = |surface: &SurfaceOf| {
        let semantic = surface.semantic.and_then(|i| semantics.get(i));
        semantic.is_some_and(|s| s["type"] == "GroundSurface")
    };
    let grounds: Vec<Rings> = (surfaces.iter().zip(&all))
        .filter(|(surface, _)| is_ground(surface))
        .map(|(_, rings)| rings.clone())
        .collect();
    if !grounds.is_empty() {
        return Some(grounds);
    }
    let highest = |rings: &Rings| {
        let heights = rings.iter().flatten().map(|p| p[2]);
        heights.fold(f64::NEG_INFINITY, f64::max)
    };
    let lowest = all.iter().min_by(|a, b| highest(a).total_cmp(&highest(b)));
    Some(lowest.cloned().into_iter().collect())
}
