//! The model of a CityJSON file, also of features one a line: every object with a Solid whose
//! surfaces have semantics.
//!
//! What `ridgeline` states of a facet (standard deviations, probability, photographs) is taken from
//! the attributes of its surface; files of others have none of it.

use nalgebra::{Point2, Point3, Vector3};
use serde_json::Value;

use super::super::cityjson::{FRAME_SIGMA, HEIGHT_OVER_10_M, LENGTH_OF_10_M, OBSTRUCTIONS};
use super::reported::{ReportedModel, ReportedWalls};
use crate::base::geometry::{Plane, mean_point, plan_sides, vector_area};
use crate::base::ids::{BuildingId, FacetId};
use crate::orienting::known::json_of;
use crate::orienting::orientation::{FrameSigma, PlanUnit, SystemUnits, epsg_of, units_of};
use crate::orienting::scene::Survey;
use crate::roofs::model::{
    CornerUncertainty, Facet, FacetUncertainty, Obstruction, SideSupport, SideUncertainty, Surface,
};

/// Roofs are no steeper than this, as the vertical part of a unit normal; what is called a roof and
/// is steeper (the side of a dormer, say) is a wall here.
const LEAST_NORMAL_Z: f64 = 1e-2;

/// Of a smaller face the rounded corners tell no plane, square metres.
const SLIVER_M2: f64 = 0.02;

impl ReportedModel {
    /// What a CityJSON file says of its model; an error says what was expected and where.
    pub fn read(city_json: &[u8]) -> Result<Self, String> {
        read_model(city_json)
    }

    /// Which of the geometries of an object it is read from: the solid with semantics whose walls
    /// stand below the eaves (LoD 2.2), else the last one, which is the most detailed.
    pub(crate) fn solid_among(geometries: &[Value]) -> Option<usize> {
        let is_solid = |g: &Value| g["type"] == "Solid" && g["semantics"]["surfaces"].is_array();
        let mut solids = (0..geometries.len())
            .rev()
            .filter(|&i| is_solid(&geometries[i]));
        let last = solids.clone().next();
        solids.find(|&i| geometries[i]["lod"] == "2.2").or(last)
    }
}

fn read_model(bytes: &[u8]) -> Result<ReportedModel, String> {
    let text = String::from_utf8_lossy(bytes);
    let file = json_of(&text).map_err(|line| format!("is no JSON: see line {line}"))?;
    if file["type"] != "CityJSON" {
        return Err("is no CityJSON: its \"type\" is not \"CityJSON\"".into());
    }
    let vector = |name: &str| -> Result<Vector3<f64>, String> {
        let numbers = numbers(&file["transform"][name]);
        match numbers.as_deref() {
            Some(&[x, y, z]) => Ok(Vector3::new(x, y, z)),
            _ => Err(format!("\"transform\" has no \"{name}\" of three numbers")),
        }
    };
    let units = units(&file["metadata"])?;
    let [scale, origin] = [vector("scale")?, vector("translate")?].map(|v| v.component_mul(&units));
    let vertices = list(&file["vertices"]).ok_or("has no list \"vertices\"")?;
    let vertices: Vec<Point3<f64>> = (vertices.iter().enumerate())
        .map(|(i, v)| match numbers(v).as_deref() {
            Some(&[x, y, z]) => Ok(Vector3::new(x, y, z).component_mul(&scale).into()),
            _ => Err(format!("vertex {i} is not three numbers")),
        })
        .collect::<Result<_, String>>()?;
    let objects = (file["CityObjects"].as_object()).ok_or("has no \"CityObjects\"")?;
    // Shorter names first: building-2 before building-10.
    let mut objects: Vec<_> = objects.iter().collect();
    objects.sort_by_key(|(name, _)| (name.len(), name.as_str()));
    let mut read = ReportedModel {
        origin,
        step: scale,
        system: system(&file["metadata"]),
        survey: survey(&file["metadata"]),
        ..ReportedModel::default()
    };
    for (name, object) in &objects {
        if let Some(geometry) = solid_of(object) {
            let added = add_building(&mut read, object, geometry, &vertices);
            if added.map_err(|problem| format!("{name}: {problem}"))? {
                read.names.push((*name).clone());
                read.walls.push(walls_of(&object["attributes"]));
                let stated = frame_sigma(&object["attributes"][FRAME_SIGMA]);
                read.survey.frame_sigma = read.survey.frame_sigma.or(stated);
            }
        }
    }
    if read.names.is_empty() && !objects.is_empty() {
        return Err("holds no building as a Solid with a RoofSurface among its semantics".into());
    }
    Ok(read)
}

fn list(value: &Value) -> Option<&Vec<Value>> {
    value.as_array()
}

/// Finite numbers.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    let finite = |v: &Value| v.as_f64().filter(|n| n.is_finite());
    list(value)?.iter().map(finite).collect()
}

/// Metres in a unit of x, y and z: a report states metres whatever its model counts.
fn units(metadata: &Value) -> Result<Vector3<f64>, String> {
    let stated = metadata["referenceSystem"].as_str().and_then(units_of);
    let Some(SystemUnits { plan, height }) = stated else {
        return Ok(Vector3::repeat(1.0));
    };
    match plan {
        PlanUnit::Length(plan) => {
            let height = height.unwrap_or(plan);
            Ok(Vector3::new(plan.metres, plan.metres, height.metres))
        }
        PlanUnit::Angle(_) => Err("is in longitude and latitude; convert it to a map".into()),
        PlanUnit::Geocentric => Ok(Vector3::repeat(1.0)),
    }
}

/// The coordinate system in words.
fn system(metadata: &Value) -> Option<String> {
    if let Some(url) = metadata["referenceSystem"].as_str() {
        let code = url
            .rsplit_once("/EPSG/")
            .and_then(|(_, rest)| rest.rsplit_once('/'));
        let name = code.map_or_else(|| url.to_owned(), |(_, code)| format!("EPSG:{code}"));
        return Some(match units(metadata) {
            Ok(units) if units != Vector3::repeat(1.0) => format!("{name}, counted in metres"),
            _ => name,
        });
    }
    title(metadata).map(str::to_owned)
}

/// What ridgeline says of coordinates that have no code.
fn title(metadata: &Value) -> Option<&str> {
    metadata["title"]
        .as_str()?
        .strip_prefix("Roofs; coordinates ")
}

/// Where on the Earth the model stands, as far as its file says.
fn survey(metadata: &Value) -> Survey {
    Survey {
        epsg: metadata["referenceSystem"].as_str().and_then(epsg_of),
        anchor: title(metadata).and_then(Survey::anchor_described),
        ..Survey::default()
    }
}

/// What the scale and the level of the frame are worth, as a building states it of all.
fn frame_sigma(stated: &Value) -> Option<FrameSigma> {
    let number = |name: &str| stated[name].as_f64().filter(|sigma| *sigma >= 0.0);
    stated.is_object().then(|| FrameSigma {
        length_of_10_m: number(LENGTH_OF_10_M),
        height_over_10_m: number(HEIGHT_OVER_10_M),
    })
}

fn solid_of(object: &Value) -> Option<&Value> {
    let geometries = list(&object["geometry"])?;
    geometries.get(ReportedModel::solid_among(geometries)?)
}

fn walls_of(attributes: &Value) -> ReportedWalls {
    let count = |name: &str| attributes[name].as_u64();
    ReportedWalls {
        count: (count("walls").zip(count("wallsSeen"))).map(|(all, seen)| [all, seen]),
        volume_m3: attributes["volumeWithinWalls"].as_f64(),
    }
}

/// Adds the building of an object; false where it has no roof.
fn add_building(
    read: &mut ReportedModel,
    object: &Value,
    geometry: &Value,
    vertices: &[Point3<f64>],
) -> Result<bool, String> {
    let shell = list(&geometry["boundaries"][0]).ok_or("its Solid has no shell")?;
    let semantics = &geometry["semantics"];
    let id = BuildingId::from_index(read.model.buildings.len());
    let mut faces = Vec::new();
    for (i, face) in shell.iter().enumerate() {
        let of_face = |problem: &str| format!("face {i}: {problem}");
        let rings = list(face).ok_or_else(|| of_face("no list of rings"))?;
        let rings: Vec<Vec<Point3<f64>>> = (rings.iter())
            .map(|ring| {
                ring_of(ring, vertices)
                    .ok_or_else(|| of_face("a ring is not three or more vertices of the file"))
            })
            .collect::<Result<_, _>>()?;
        if rings.is_empty() {
            return Err(of_face("no ring"));
        }
        let surface = (semantics["values"][0][i].as_u64())
            .map_or(&Value::Null, |s| &semantics["surfaces"][s as usize]);
        faces.push((add_surface(read, id, &rings, surface), rings));
    }
    let ground_m = object["attributes"]["groundHeight"].as_f64();
    Ok(read.add_building(faces, ground_m.map(|z| z - read.origin.z)))
}

/// What a face of a building is; a roof becomes a facet.
fn add_surface(
    read: &mut ReportedModel,
    building: BuildingId,
    rings: &[Vec<Point3<f64>>],
    surface: &Value,
) -> Surface {
    match surface["type"].as_str() {
        Some("RoofSurface") => plane_of(rings).map_or(Surface::Wall, |plane| {
            let facet = FacetId::from_index(read.model.facets.len());
            let facet_of = facet_of(&read.origin, (building, plane), rings, surface);
            read.model.facets.push(facet_of);
            read.photographs.push(names(&surface["photographs"]));
            Surface::Roof(facet)
        }),
        Some("GroundSurface") => Surface::Ground,
        _ => Surface::Wall,
    }
}

fn ring_of(ring: &Value, vertices: &[Point3<f64>]) -> Option<Vec<Point3<f64>>> {
    let vertex = |v: &Value| vertices.get(usize::try_from(v.as_u64()?).ok()?).copied();
    let ring: Vec<_> = list(ring)?.iter().map(vertex).collect::<Option<_>>()?;
    (ring.len() >= 3).then_some(ring)
}

/// The plane of a roof, from the vector area of its rings through their middle; `None` where it
/// does not look up.
pub(super) fn plane_of(rings: &[Vec<Point3<f64>>]) -> Option<Plane> {
    let areas = rings.iter().map(|ring| vector_area(ring.iter().copied()));
    let area: Vector3<f64> = areas.sum();
    let looks_up = |plane: &Plane| plane.normal.z > LEAST_NORMAL_Z;
    let middle = mean_point(&rings[0]);
    let plane = Plane::from_point_normal(&middle, &area).filter(looks_up);
    let is_sliver = area.norm() < SLIVER_M2;
    plane.or_else(|| Plane::from_point_normal(&middle, &Vector3::z()).filter(|_| is_sliver))
}

fn facet_of(
    origin: &Vector3<f64>,
    (id, plane): (BuildingId, Plane),
    rings: &[Vec<Point3<f64>>],
    surface: &Value,
) -> Facet {
    let number = |name: &str| surface[name].as_f64();
    Facet {
        building: id,
        plane,
        outer: rings[0].clone(),
        holes: rings[1..].to_vec(),
        similarity: number("similarity").unwrap_or(0.0),
        real_ratio: number("realLineRatio").unwrap_or(0.0),
        probability: number("probability").unwrap_or(1.0),
        uncertainty: uncertainty_of(surface, rings),
        lines: Vec::new(),
        half_planes: Vec::new(),
        proposals: Vec::new(),
        obstructions: obstructions_of(origin, surface),
    }
}

/// What stands on a facet, as far as it is stated whole.
fn obstructions_of(origin: &Vector3<f64>, surface: &Value) -> Vec<Obstruction> {
    let place = |p: &Value| match numbers(p).as_deref() {
        Some(&[x, y]) => Some(Point2::new(x - origin.x, y - origin.y)),
        _ => None,
    };
    let obstruction = |stated: &Value| {
        let outline: Option<Vec<_>> = list(&stated["outline"])?.iter().map(place).collect();
        Some(Obstruction {
            outline: outline.filter(|outline| outline.len() >= 3)?,
            height_m: stated["height"].as_f64()?,
            height_sigma_m: stated["heightSigma"].as_f64(),
            probability: stated["probability"].as_f64().unwrap_or(1.0),
        })
    };
    let stated = list(&surface[OBSTRUCTIONS]).into_iter().flatten();
    stated.filter_map(obstruction).collect()
}

fn uncertainty_of(surface: &Value, rings: &[Vec<Point3<f64>>]) -> Option<FacetUncertainty> {
    let outer = &rings[0];
    let stated = list(&surface["cornerSigma"])?;
    let corner = |(at, sigma): (&Point3<f64>, &Value)| match numbers(sigma).as_deref() {
        Some(&[x, y, z]) => Some(CornerUncertainty {
            at: *at,
            sigma_m: Vector3::new(x, y, z),
        }),
        _ => None,
    };
    let corners: Option<Vec<_>> = outer.iter().zip(stated).map(corner).collect();
    Some(FacetUncertainty {
        height_m: surface["heightSigma"].as_f64()?,
        slope_deg: surface["slopeSigmaDeg"].as_f64()?,
        corners: corners.filter(|corners| corners.len() == outer.len())?,
        sides: sides_of(surface, rings).unwrap_or_default(),
    })
}

/// The sides of all rings but those of which nothing is known; `None` where the file has no sides.
fn sides_of(surface: &Value, rings: &[Vec<Point3<f64>>]) -> Option<Vec<SideUncertainty>> {
    let [sigmas, supports] = ["sideSigma", "sideSupport"].map(|name| list(&surface[name]));
    let (sigmas, supports) = (sigmas?, supports?);
    let mut sides = Vec::new();
    for (i, ring) in rings.iter().enumerate() {
        let [sigmas, supports] = [sigmas, supports].map(|of| of.get(i).and_then(list));
        let (sigmas, supports) = (sigmas?, supports?);
        for (k, ends) in plan_sides(ring).enumerate() {
            let (sigma, support) = (sigmas.get(k)?, supports.get(k)?);
            if !sigma.is_null() {
                sides.push(SideUncertainty {
                    ends,
                    sigma_m: sigma.as_f64()?,
                    support: SideSupport::named(support.as_str()?)?,
                });
            }
        }
    }
    Some(sides)
}

fn names(value: &Value) -> Vec<String> {
    let names = list(value).into_iter().flatten();
    names.filter_map(|n| Some(n.as_str()?.to_owned())).collect()
}
