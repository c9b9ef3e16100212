//! Maps as GeoJSON: footprints, facets and edges of the roofs, and what stands on them.
//!
//! RFC 7946 wants longitude and latitude: positions are in these where the frame's place on the
//! Earth is known, else in the input's own coordinates, whose reference system is named in the
//! older way (GeoJSON 2008, `crs`) where the input names it.

use nalgebra::Point3;
use serde_json::{Value, json};

use super::format::{rounded, to_bytes, world};
use super::measured::Measured;
use crate::base::ids::{BuildingId, FacetId};
use crate::orienting::scene::Scene;
use crate::results::roof_report::{Estimate, RoofEdgeKind};
use crate::roofs::model::{Building, RoofModel, Solid, Surface};

/// The footprints of the buildings as GeoJSON polygons, with the heights of ground, eaves and
/// ridge.
pub(super) fn footprints(scene: &Scene, model: &RoofModel) -> Vec<u8> {
    let features: Vec<Value> = (model.buildings.iter().enumerate())
        .flat_map(|(i, building)| building_footprints(scene, model, i, building))
        .collect();
    collection(scene, features)
}

/// A file of features, with the reference system where longitude and latitude are not known.
fn collection(scene: &Scene, features: Vec<Value>) -> Vec<u8> {
    let mut file = json!({ "type": "FeatureCollection", "features": features });
    if let (None, Some(epsg)) = (scene.survey.anchor, scene.survey.epsg) {
        let name = format!("urn:ogc:def:crs:EPSG::{epsg}");
        file["crs"] = json!({ "type": "name", "properties": { "name": name } });
    }
    to_bytes(&file)
}

fn building_footprints(
    scene: &Scene,
    model: &RoofModel,
    id: usize,
    building: &Building,
) -> Vec<Value> {
    let solid = &building.solid;
    let roof = building.facets.iter().map(|f| &model.facets[f.index()]);
    let heights: Vec<f64> = roof.flat_map(|f| &f.outer).map(|p| p.z).collect();
    let height = |z: f64| rounded(z + scene.origin.z, 3);
    let grounds = solid.faces.iter().filter(|f| f.surface == Surface::Ground);
    let feature = |face: &crate::roofs::model::SolidFace| {
        let rings: Vec<_> = face
            .rings
            .iter()
            .map(|ring| closed_ring(scene, solid, ring))
            .collect();
        json!({
            "type": "Feature",
            "geometry": { "type": "Polygon", "coordinates": rings },
            "properties": {
                "building": BuildingId::from_index(id).number(),
                "facets": building.facets.len(),
                "ground_m": height(building.ground_z),
                "lowest_roof_m": height(heights.iter().copied().fold(f64::INFINITY, f64::min)),
                "highest_roof_m": height(heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
            },
        })
    };
    grounds.map(feature).collect()
}

/// A ring of a ground face from above: the other way round, the first corner again at its end.
fn closed_ring(scene: &Scene, solid: &Solid, ring: &[u32]) -> Vec<[f64; 2]> {
    let corner = |&i: &u32| position(scene, &solid.vertices[i as usize]);
    ring.iter().rev().chain(ring.last()).map(corner).collect()
}

/// A position in plan: longitude and latitude, or as the input has it.
fn position(scene: &Scene, p: &Point3<f64>) -> [f64; 2] {
    match &scene.survey.anchor {
        Some(anchor) => {
            let [lon, lat, _] = anchor.geographic(&(p + scene.origin));
            // A tenth of a millimetre.
            [rounded(lon, 9), rounded(lat, 9)]
        }
        None => {
            let [x, y, _] = world(scene, p);
            [x, y]
        }
    }
}

/// The facets in plan as GeoJSON polygons, with areas, slopes, directions, lengths and the
/// photographs that show them.
pub(super) fn facets(scene: &Scene, model: &RoofModel, measured: &Measured) -> Vec<u8> {
    let mut features = Vec::new();
    for (building, facet) in
        (measured.buildings.iter()).flat_map(|b| b.facets.iter().map(move |f| (b.building, f)))
    {
        let of = &model.facets[facet.facet.index()];
        let closed = |ring: &Vec<Point3<f64>>| -> Vec<[f64; 2]> {
            let corners = ring.iter().chain(ring.first());
            corners.map(|p| position(scene, p)).collect()
        };
        let mut properties = Properties::new(&[
            ("building", json!(building.number())),
            ("facet", json!(facet.facet.number())),
            ("probability", json!(rounded(facet.probability, 4))),
            (
                "photographs",
                json!(measured.photographs[facet.facet.index()].join("; ")),
            ),
        ]);
        properties.add("area_m2", Some(facet.area_m2));
        properties.add("plan_area_m2", Some(facet.plan_area_m2));
        properties.add("slope_deg", Some(facet.slope_deg));
        properties.add("azimuth_deg", facet.azimuth_deg);
        properties.add("lowest_m", Some(facet.lowest_m));
        properties.add("highest_m", Some(facet.highest_m));
        for (kind, length) in RoofEdgeKind::ALL.into_iter().zip(facet.lengths) {
            properties.add(&format!("{}_m", kind.name()), length);
        }
        features.push(json!({
            "type": "Feature",
            "geometry": {
                "type": "Polygon",
                "coordinates": of.rings().map(closed).collect::<Vec<_>>(),
            },
            "properties": properties.0,
        }));
    }
    collection(scene, features)
}

/// What stands on the roofs in plan as GeoJSON polygons, with heights.
pub(super) fn obstructions(scene: &Scene, model: &RoofModel) -> Vec<u8> {
    let mut features = Vec::new();
    for (id, facet) in model.facets.iter().enumerate() {
        for obstruction in &facet.obstructions {
            let height = Estimate {
                value: obstruction.height_m,
                sigma: obstruction.height_sigma_m,
            };
            let mut properties = Properties::new(&[
                ("building", json!(facet.building.number())),
                ("facet", json!(FacetId::from_index(id).number())),
                ("probability", json!(rounded(obstruction.probability, 4))),
            ]);
            properties.add("height_m", Some(height));
            let ring = obstruction
                .outline
                .iter()
                .chain(obstruction.outline.first());
            let ring = ring.map(|p| position(scene, &facet.plane.lift(p.x, p.y)));
            features.push(json!({
                "type": "Feature",
                "geometry": { "type": "Polygon", "coordinates": [ring.collect::<Vec<_>>()] },
                "properties": properties.0,
            }));
        }
    }
    collection(scene, features)
}

/// The edges of the roofs in plan as GeoJSON lines, with their kinds and lengths.
pub(super) fn edges(scene: &Scene, measured: &Measured) -> Vec<u8> {
    let mut features = Vec::new();
    for (building, edge) in
        (measured.buildings.iter()).flat_map(|b| b.edges.iter().map(move |e| (b.building, e)))
    {
        let (length, edge) = (edge.length_m, &edge.edge);
        let ends = [edge.segment.p0, edge.segment.p1];
        let mut properties = Properties::new(&[
            ("building", json!(building.number())),
            ("kind", json!(edge.kind.name())),
            ("facet", json!(edge.facet.number())),
            ("other_facet", json!(edge.other.map(FacetId::number))),
        ]);
        properties.add("length_m", Some(length));
        for (name, p) in ["z0_m", "z1_m"].into_iter().zip(&ends) {
            properties.0[name] = json!(world(scene, p)[2]);
        }
        features.push(json!({
            "type": "Feature",
            "geometry": {
                "type": "LineString",
                "coordinates": ends.map(|p| position(scene, &p)),
            },
            "properties": properties.0,
        }));
    }
    collection(scene, features)
}

/// The properties of a feature.
struct Properties(Value);

impl Properties {
    fn new(properties: &[(&str, Value)]) -> Self {
        let mut object = json!({});
        for (name, value) in properties {
            object[*name] = value.clone();
        }
        Self(object)
    }

    /// Adds a number, and its standard deviation under `QUANTITY_sigma_UNIT`; `null` for none.
    fn add(&mut self, name: &str, estimate: Option<Estimate>) {
        let (quantity, unit) = name.rsplit_once('_').expect("names end with their unit");
        let number = |n: Option<f64>| json!(n.map(|n| rounded(n, 4)));
        self.0[name] = number(estimate.map(|e| e.value));
        self.0[format!("{quantity}_sigma_{unit}")] = number(estimate.and_then(|e| e.sigma));
    }
}
