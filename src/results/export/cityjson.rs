//! CityJSON 2.0, as one file and as a sequence of features: one Building with an LoD 2.2 Solid per
//! building of the model, and with an LoD 2.3 Solid where walls are known to stand elsewhere than
//! below the eaves.
//!
//! Coordinates are those of the input's world frame, as whole numbers of 0.1 mm from the scene
//! origin (coarser steps would bend planar roofs). The texture is the file [`ATLAS_FILE`] beside
//! this one. The reference system is written where the input names one.

use std::collections::BTreeMap;

use nalgebra::{Point2, Point3};
use serde_json::{Map, Value, json};

use super::format::{ATLAS_FILE, rounded, to_bytes};
use super::measured::Measured;
use super::walls::{add_attributes, walled_solid};
use crate::base::geometry::plan_sides;
use crate::base::ids::{BuildingId, FacetId};
use crate::orienting::orientation::FrameSigma;
use crate::orienting::scene::Scene;
use crate::results::roof_report::{Estimate, Lengths, RoofEdgeKind};
use crate::results::texture::{FaceTexture, TexturedModel};
use crate::roofs::model::{
    Building, BuildingWalls, Facet, FacetUncertainty, Obstruction, RoofModel, SideUncertainty,
    Solid, Surface,
};
use crate::roofs::solids::WRITTEN_STEP_M;

/// Name of the appearance theme.
const THEME: &str = "photographs";

/// The attribute of a roof surface that says what stands on it.
pub(super) const OBSTRUCTIONS: &str = "obstructions";
/// What is said of the shape of a building and of a roof surface: untrue of another shape.
pub(super) const OF_ITS_SHAPE: &[&str] = &[
    "area",
    "areaSigma",
    "azimuthDeg",
    "azimuthSigmaDeg",
    "cornerProbability",
    "cornerSigma",
    "heightSigma",
    "highestHeight",
    "highestHeightSigma",
    "highestRoofHeight",
    "highestRoofHeightSigma",
    "lengths",
    "lowestHeight",
    "lowestHeightSigma",
    "lowestRoofHeight",
    "lowestRoofHeightSigma",
    OBSTRUCTIONS,
    "planArea",
    "planAreaSigma",
    "roofArea",
    "roofAreaSigma",
    "roofFacets",
    "sideSigma",
    "sideSupport",
    "slopeDeg",
    "slopeSigmaDeg",
    "volume",
    "volumeSigma",
    "volumeWithinWalls",
    "walls",
    "wallsSeen",
];
/// The attribute of a building that says what scale and level of the frame are worth, and its
/// members.
pub(super) const FRAME_SIGMA: &str = "frameSigma";
pub(super) const LENGTH_OF_10_M: &str = "lengthOf10m";
pub(super) const HEIGHT_OVER_10_M: &str = "heightOver10m";

/// What scale and level of the frame are worth, as the file states it.
pub(super) fn written_frame(scene: &Scene) -> Option<FrameSigma> {
    let frame = scene.survey.frame_sigma.as_ref()?;
    let written = |sigma: Option<f64>| sigma.map(|sigma| rounded(sigma, 6));
    Some(FrameSigma {
        length_of_10_m: written(frame.length_of_10_m),
        height_over_10_m: written(frame.height_over_10_m),
    })
}

/// The model as a CityJSON file.
pub(super) fn city_json(
    scene: &Scene,
    (model, walls): (&RoofModel, &[BuildingWalls]),
    measured: &Measured,
    textured: &TexturedModel,
) -> Vec<u8> {
    let mut shared = Shared::default();
    let mut objects = Map::new();
    for (i, (building, textures)) in model.buildings.iter().zip(&textured.faces).enumerate() {
        let of = (model, measured);
        let first = shared.vertices.len();
        let mut object = building_object(scene, of, (i, building), textures, &mut shared);
        if let Some(walls) = walls.get(i) {
            add_walls(&mut object, walls, &mut shared, first);
        }
        objects.insert(BuildingId::from_index(i).name(), object);
    }
    let mut file = head(scene, &shared.vertices);
    file["CityObjects"] = Value::Object(objects);
    file["vertices"] = json!(shared.vertices);
    if !shared.vertices.is_empty() {
        file["appearance"] = shared.appearance();
    }
    to_bytes(&file)
}

/// The model as a sequence of CityJSON features, one a line: first what they share, then each
/// building with its own corners and texture coordinates. Programs read it building by building.
pub(super) fn city_json_seq(
    scene: &Scene,
    (model, walls): (&RoofModel, &[BuildingWalls]),
    measured: &Measured,
    textured: &TexturedModel,
) -> Vec<u8> {
    let mut vertices = Vec::new();
    let mut features = Vec::new();
    for (i, (building, textures)) in model.buildings.iter().zip(&textured.faces).enumerate() {
        let id = BuildingId::from_index(i).name();
        let mut own = Shared::default();
        let of = (model, measured);
        let mut object = building_object(scene, of, (i, building), textures, &mut own);
        if let Some(walls) = walls.get(i) {
            add_walls(&mut object, walls, &mut own, 0);
        }
        features.push(json!({
            "type": "CityJSONFeature",
            "id": id,
            "CityObjects": { id.as_str(): object },
            "vertices": own.vertices,
            "appearance": own.appearance(),
        }));
        vertices.append(&mut own.vertices);
    }
    let lines = std::iter::once(head(scene, &vertices)).chain(features);
    lines
        .flat_map(|line| [to_bytes(&line), b"\n".to_vec()].concat())
        .collect()
}

/// A file without objects: version, transform and metadata. The vertices are those of all objects.
fn head(scene: &Scene, vertices: &[[i64; 3]]) -> Value {
    let mut file = json!({
        "type": "CityJSON",
        "version": "2.0",
        "transform": {
            "scale": [WRITTEN_STEP_M, WRITTEN_STEP_M, WRITTEN_STEP_M],
            "translate": scene.origin.as_slice(),
        },
        "CityObjects": {},
        "vertices": [],
    });
    let mut metadata = Map::new();
    if !vertices.is_empty() {
        metadata.insert("geographicalExtent".into(), json!(extent(scene, vertices)));
    }
    match scene.survey.epsg {
        Some(epsg) => {
            let system = format!("https://www.opengis.net/def/crs/EPSG/0/{epsg}");
            metadata.insert("referenceSystem".into(), json!(system));
        }
        // A local frame has no number; its place is described in words.
        None => {
            let title = scene
                .survey
                .describe()
                .map(|system| format!("Roofs; coordinates {system}"));
            metadata.extend(title.map(|title| ("title".to_owned(), json!(title))));
        }
    }
    if !metadata.is_empty() {
        file["metadata"] = Value::Object(metadata);
    }
    file
}

/// The lists that all buildings of a file or line share.
#[derive(Default)]
struct Shared {
    vertices: Vec<[i64; 3]>,
    uv: Vec<[f64; 2]>,
}

impl Shared {
    /// Appends the corners of a solid.
    fn add(&mut self, solid: &Solid) {
        self.vertices.extend(whole_corners(solid));
    }

    /// Appends the corners of one more solid of the building whose corners begin at `first`, but
    /// for those that are there; gives the index of each.
    fn add_more(&mut self, solid: &Solid, first: usize) -> Vec<usize> {
        let own = self.vertices.iter().enumerate().skip(first);
        let known: BTreeMap<[i64; 3], usize> = own.rev().map(|(i, v)| (*v, i)).collect();
        let index = |corner: [i64; 3]| {
            known.get(&corner).copied().unwrap_or_else(|| {
                self.vertices.push(corner);
                self.vertices.len() - 1
            })
        };
        whole_corners(solid).map(index).collect()
    }

    fn appearance(&self) -> Value {
        json!({
            "default-theme-texture": THEME,
            "textures": [{ "type": "JPG", "image": ATLAS_FILE, "wrapMode": "none" }],
            "vertices-texture": self.uv,
        })
    }
}

/// The corners in whole steps.
pub(super) fn whole_corners(solid: &Solid) -> impl Iterator<Item = [i64; 3]> {
    let whole = |c: f64| (c / WRITTEN_STEP_M).round() as i64;
    (solid.vertices.iter()).map(move |p| [whole(p.x), whole(p.y), whole(p.z)])
}

fn building_object(
    scene: &Scene,
    (model, measured): (&RoofModel, &Measured),
    (index, building): (usize, &Building),
    textures: &[FaceTexture],
    shared: &mut Shared,
) -> Value {
    let offset = shared.vertices.len();
    shared.add(&building.solid);
    let mut boundaries = Vec::new();
    let mut surfaces = Vec::new();
    let mut texture_values = Vec::new();
    for (face, texture) in building.solid.faces.iter().zip(textures) {
        let rings: Vec<Vec<usize>> = face
            .rings
            .iter()
            .map(|ring| ring.iter().map(|&v| offset + v as usize).collect())
            .collect();
        boundaries.push(rings);
        surfaces.push(semantic_surface(scene, (model, measured), face.surface));
        texture_values.push(texture_of_rings(texture, shared));
    }
    let values: Vec<usize> = (0..surfaces.len()).collect();
    let report = &measured.buildings[index];
    let mut attributes = json!({
        "groundHeight": rounded(building.ground_z + scene.origin.z, 4),
        "roofFacets": building.facets.len(),
        "volume": rounded(building.solid.volume(), 3),
    });
    add_sigma(&mut attributes, "volume", report.volume_m3);
    add(&mut attributes, "roofArea", report.area_m2);
    add(&mut attributes, "planArea", report.plan_area_m2);
    add(&mut attributes, "lowestRoofHeight", report.lowest_m);
    add(&mut attributes, "highestRoofHeight", report.highest_m);
    attributes["lengths"] = lengths(&report.lengths);
    if let Some(frame) = written_frame(scene) {
        attributes[FRAME_SIGMA] = json!({
            LENGTH_OF_10_M: frame.length_of_10_m,
            HEIGHT_OVER_10_M: frame.height_over_10_m,
        });
    }
    json!({
        "type": "Building",
        "attributes": attributes,
        "geometry": [{
            "type": "Solid",
            "lod": "2.2",
            "boundaries": [boundaries],
            "semantics": { "surfaces": surfaces, "values": [values] },
            "texture": { THEME: { "values": [texture_values] } },
        }],
    })
}

/// Adds what is known of the walls, and the solid that has them where they stand.
/// The building's own corners begin at `first`.
fn add_walls(object: &mut Value, walls: &BuildingWalls, shared: &mut Shared, first: usize) {
    add_attributes(&mut object["attributes"], walls);
    if let (Some(solid), Some(all)) = (&walls.solid, object["geometry"].as_array_mut()) {
        let corners = shared.add_more(solid, first);
        all.push(walled_solid(walls, solid, &corners));
    }
}

/// Adds a number and its standard deviation.
fn add(attributes: &mut Value, name: &str, estimate: Estimate) {
    attributes[name] = json!(rounded(estimate.value, 4));
    add_sigma(attributes, name, estimate);
}

fn add_sigma(attributes: &mut Value, name: &str, estimate: Estimate) {
    if let Some(sigma) = estimate.sigma {
        attributes[format!("{name}Sigma")] = json!(rounded(sigma, 4));
    }
}

/// Lengths by kind of edge, with their standard deviations.
fn lengths(lengths: &Lengths) -> Value {
    let mut named = json!({});
    for (kind, length) in RoofEdgeKind::ALL.into_iter().zip(lengths) {
        let name = if kind == RoofEdgeKind::TopEdge {
            "topEdge"
        } else {
            kind.name()
        };
        if let Some(length) = length {
            add(&mut named, name, *length);
        }
    }
    named
}

/// What was measured of a facet.
fn add_measures(surface: &mut Value, measured: &Measured, id: FacetId) {
    surface["photographs"] = json!(measured.photographs[id.index()]);
    if let Some(facet) = measured.facet(id) {
        add(surface, "area", facet.area_m2);
        add(surface, "planArea", facet.plan_area_m2);
        add(surface, "lowestHeight", facet.lowest_m);
        add(surface, "highestHeight", facet.highest_m);
        if let Some(azimuth) = facet.azimuth_deg {
            surface["azimuthDeg"] = json!(rounded(azimuth.value, 3));
            if let Some(sigma) = azimuth.sigma {
                surface["azimuthSigmaDeg"] = json!(rounded(sigma, 4));
            }
        }
        surface["lengths"] = lengths(&facet.lengths);
    }
}

/// What a face is; roof surfaces carry the facet's number, slope and evidence.
fn semantic_surface(
    scene: &Scene,
    (model, measured): (&RoofModel, &Measured),
    surface: Surface,
) -> Value {
    match surface {
        Surface::Wall => json!({ "type": "WallSurface" }),
        Surface::Ceiling => json!({ "type": "OuterCeilingSurface" }),
        Surface::Ground => json!({ "type": "GroundSurface" }),
        Surface::Roof(id) => {
            let facet = &model.facets[id.index()];
            let slope = crate::base::math::acos(facet.plane.normal.z.clamp(-1.0, 1.0));
            let mut surface = json!({
                "type": "RoofSurface",
                "facet": id.number(),
                "slopeDeg": rounded(slope.to_degrees(), 3),
                "similarity": rounded(facet.similarity, 4),
                "realLineRatio": rounded(facet.real_ratio, 4),
                "probability": rounded(facet.probability, 4),
            });
            let of_corner = |p| rounded(model.probability_of_corner(facet.building, p), 4);
            surface["cornerProbability"] = facet.outer.iter().map(of_corner).collect();
            if let Some(known) = &facet.uncertainty {
                let corners = facet.outer.iter().filter_map(|p| known.at(p));
                let corners = corners.map(|sigma| [0, 1, 2].map(|k| rounded(sigma[k], 4)));
                surface["slopeSigmaDeg"] = json!(rounded(known.slope_deg, 4));
                surface["heightSigma"] = json!(rounded(known.height_m, 4));
                surface["cornerSigma"] = corners.collect();
                add_sides(&mut surface, facet, known);
            }
            add_measures(&mut surface, measured, id);
            if !facet.obstructions.is_empty() {
                surface[OBSTRUCTIONS] = (facet.obstructions.iter())
                    .map(|obstruction| obstruction_of(scene, obstruction))
                    .collect();
            }
            surface
        }
    }
}

/// What stands on a facet: its outline in plan, in the world frame, and its height.
pub(super) fn obstruction_of(scene: &Scene, obstruction: &Obstruction) -> Value {
    let outline = (obstruction.outline.iter()).map(|p| [0, 1].map(|k| in_plan(scene, p, k)));
    let mut value = json!({
        "outline": outline.collect::<Value>(),
        "probability": rounded(obstruction.probability, 4),
    });
    let height = Estimate {
        value: obstruction.height_m,
        sigma: obstruction.height_sigma_m,
    };
    add(&mut value, "height", height);
    value
}

/// A coordinate in the world frame as the file has it.
pub(super) fn in_plan(scene: &Scene, p: &Point2<f64>, axis: usize) -> f64 {
    rounded(p[axis] + scene.origin[axis], 4)
}

/// Adds what is known of the sides, a list for each ring; a side begins at the corner of its index.
fn add_sides(surface: &mut Value, facet: &Facet, known: &FacetUncertainty) {
    let of_rings = |value: &dyn Fn(&SideUncertainty) -> Value| -> Value {
        let of_ring = |ring: &Vec<Point3<f64>>| -> Value {
            let middles = plan_sides(ring).map(|[p, q]| nalgebra::center(&p, &q));
            middles
                .map(|middle| known.side(&middle).map_or(Value::Null, value))
                .collect()
        };
        facet.rings().map(of_ring).collect()
    };
    surface["sideSigma"] = of_rings(&|side| json!(rounded(side.sigma_m, 4)));
    surface["sideSupport"] = of_rings(&|side| json!(side.support.name()));
}

/// Per ring `[texture, uv, uv, ...]`; CityJSON's texture coordinates have their origin at the lower
/// left.
fn texture_of_rings(texture: &FaceTexture, shared: &mut Shared) -> Vec<Vec<usize>> {
    let mut rings = Vec::new();
    for ring in &texture.uv {
        let first = shared.uv.len();
        shared.uv.extend(ring.iter().map(|uv| {
            [
                rounded(f64::from(uv[0]), 6),
                rounded(1.0 - f64::from(uv[1]), 6),
            ]
        }));
        rings.push([0].into_iter().chain(first..shared.uv.len()).collect());
    }
    rings
}

/// Lowest and highest coordinates in the world frame.
fn extent(scene: &Scene, vertices: &[[i64; 3]]) -> Vec<f64> {
    let world = |axis: usize, v: i64| rounded(v as f64 * WRITTEN_STEP_M + scene.origin[axis], 4);
    let of = |axis: usize| vertices.iter().map(move |v| v[axis]);
    let low = (0..3).map(|axis| world(axis, of(axis).min().unwrap_or(0)));
    let high = (0..3).map(|axis| world(axis, of(axis).max().unwrap_or(0)));
    low.chain(high).collect()
}
