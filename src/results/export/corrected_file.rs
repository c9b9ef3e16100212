//! A CityJSON file of anybody, corrected: buildings that a correction changed get another Solid,
//! everything else of the file keeps its bytes.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Point3, Vector3};
use serde_json::value::RawValue;
use serde_json::{Value, json};

use super::cityjson::{OBSTRUCTIONS, OF_ITS_SHAPE, obstruction_of};
use super::format::rounded;
use super::report::ReportedModel;
use crate::base::ids::FacetId;
use crate::roofs::model::{Building, RoofModel, Surface};

/// The CityJSON file with another model in it, each of whose facets was one of the file's
/// (`sources`), or none. A changed building keeps its attributes, its geometries in other levels of
/// detail, and what is said of each roof face that still is one; its walls stand below its eaves. A
/// deleted one keeps its attributes and has no geometry. One that is added is called `added-1` and
/// so on.
///
/// # Errors
/// Where the file cannot be read or holds a building a line, with what was expected and where.
pub fn corrected_file(
    file: &[u8],
    model: &RoofModel,
    sources: &[Option<FacetId>],
) -> Result<Vec<u8>, String> {
    let read = ReportedModel::read(file)?;
    let text = std::str::from_utf8(file).map_err(|_| "is not in UTF-8".to_owned())?;
    let mut rewriting = Rewriting::new(text, &read)?;
    rewriting.rewrite(model, sources)?;
    Ok(rewriting.finished().into_bytes())
}

type Raw<'a> = &'a RawValue;

/// A text and what is to be put in the place of parts of it.
struct Rewriting<'a> {
    text: &'a str,
    read: &'a ReportedModel,
    objects: BTreeMap<String, Raw<'a>>,
    /// Where the members of `CityObjects` and the items of `vertices` end.
    ends: [usize; 2],
    /// Metres in a step of the file's whole numbers.
    step: Vector3<f64>,
    /// Vertices by their whole numbers: those of the file, and new ones.
    vertices: BTreeMap<[i64; 3], usize>,
    new_vertices: Vec<[i64; 3]>,
    vertex_count: usize,
    edits: Vec<(Range<usize>, String)>,
    added: Vec<Value>,
}

impl<'a> Rewriting<'a> {
    fn new(text: &'a str, read: &'a ReportedModel) -> Result<Self, String> {
        let start = text.find('{').unwrap_or(0);
        let members: BTreeMap<String, Raw> = serde_json::from_str(&text[start..])
            .map_err(|_| "is not one JSON object; only such a file can be corrected".to_owned())?;
        let member = |name: &str| {
            let found = members.get(name).copied();
            found.ok_or_else(|| format!("has no \"{name}\""))
        };
        let (objects, listed) = (member("CityObjects")?, member("vertices")?);
        let expected = |_| "has other vertices than it should".to_owned();
        let numbers: Vec<[i64; 3]> = serde_json::from_str(listed.get()).map_err(expected)?;
        let by_place = numbers.iter().enumerate().rev();
        let end = |raw: Raw<'a>| span(text, raw).end - 1;
        Ok(Self {
            text,
            read,
            objects: serde_json::from_str(objects.get())
                .map_err(|_| "\"CityObjects\" is no object".to_owned())?,
            ends: [end(objects), end(listed)],
            step: *read.step(),
            vertices: by_place.map(|(i, v)| (*v, i)).collect(),
            vertex_count: numbers.len(),
            new_vertices: Vec::new(),
            edits: Vec::new(),
            added: Vec::new(),
        })
    }

    /// Notes what differs in a corrected model, each facet of which was one of the file's, or none.
    fn rewrite(&mut self, model: &RoofModel, sources: &[Option<FacetId>]) -> Result<(), String> {
        let before = self.read.model();
        let mut is_kept = vec![false; before.buildings.len()];
        for building in &model.buildings {
            let own = (building.facets.iter()).filter_map(|facet| sources[facet.index()]);
            let was = own.map(|facet| before.facets[facet.index()].building.index());
            // What is divided into several: the first has the object's place.
            match was.min().filter(|&was| !is_kept[was]) {
                Some(was) => {
                    is_kept[was] = true;
                    if !is_same(model, building, before, &before.buildings[was]) {
                        self.replace(was, Some((model, building)), sources)?;
                    }
                }
                None => {
                    let solid = self.solid(model, building, &Value::Null, sources, None);
                    self.added.push(solid);
                }
            }
        }
        for was in (0..is_kept.len()).filter(|&was| !is_kept[was]) {
            self.replace(was, None, sources)?;
        }
        Ok(())
    }

    /// Puts another Solid in the place of a building's, or none.
    fn replace(
        &mut self,
        was: usize,
        building: Option<(&RoofModel, &Building)>,
        sources: &[Option<FacetId>],
    ) -> Result<(), String> {
        let name = &self.read.names()[was];
        let unexpected = || format!("{name}: its geometry is not a list");
        let object = self.objects.get(name).ok_or_else(unexpected)?;
        let members: BTreeMap<String, Raw<'a>> =
            serde_json::from_str(object.get()).map_err(|_| unexpected())?;
        let geometry = *members.get("geometry").ok_or_else(unexpected)?;
        let Some((model, building)) = building else {
            self.edits
                .push((span(self.text, geometry), "[]".to_owned()));
            return Ok(());
        };
        let all: Vec<Raw<'a>> = serde_json::from_str(geometry.get()).map_err(|_| unexpected())?;
        let values: Vec<Value> = (all.iter())
            .map(|raw| serde_json::from_str(raw.get()).unwrap_or_default())
            .collect();
        let place = ReportedModel::solid_among(&values).ok_or_else(unexpected)?;
        if let Some(attributes) = members.get("attributes") {
            self.keep_true(attributes, building.ground_z);
        }
        let solid = self.solid(model, building, &values[place], sources, Some(was));
        self.edits
            .push((span(self.text, all[place]), solid.to_string()));
        Ok(())
    }

    /// Leaves out what attributes say of the former shape of a building that stands on a ground of
    /// this height.
    fn keep_true(&mut self, attributes: Raw<'a>, ground_z: f64) {
        /// The height that a building states of its ground.
        const GROUND: &str = "groundHeight";
        let ground_m = rounded(ground_z + self.read.origin().z, 4);
        let Ok(mut members) = serde_json::from_str::<BTreeMap<String, Raw>>(attributes.get())
        else {
            return;
        };
        let before = members.len();
        members.retain(|name, _| !OF_ITS_SHAPE.contains(&&name[..]));
        let stands_elsewhere = members
            .get(GROUND)
            .is_some_and(|raw| raw.get().parse() != Ok(ground_m));
        if members.len() == before && !stands_elsewhere {
            return;
        }
        let member = |(name, raw): (&String, &Raw)| {
            let name_json = json!(name);
            match name == GROUND && stands_elsewhere {
                true => format!("{name_json}:{}", json!(ground_m)),
                false => format!("{name_json}:{}", raw.get()),
            }
        };
        let kept: Vec<String> = members.iter().map(member).collect();
        let edit = (
            span(self.text, attributes),
            format!("{{{}}}", kept.join(",")),
        );
        self.edits.push(edit);
    }

    /// A building as a Solid; `stated` is the one in whose place it comes.
    fn solid(
        &mut self,
        model: &RoofModel,
        building: &Building,
        stated: &Value,
        sources: &[Option<FacetId>],
        was: Option<usize>,
    ) -> Value {
        let (mut surfaces, mut boundaries, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let vertices: Vec<usize> = (building.solid.vertices.iter())
            .map(|p| self.vertex(p))
            .collect();
        for face in &building.solid.faces {
            let surface = match face.surface {
                Surface::Roof(facet) => {
                    self.roof_surface((model, facet), (stated, was), sources[facet.index()])
                }
                Surface::Wall => json!({ "type": "WallSurface" }),
                Surface::Ceiling => json!({ "type": "OuterCeilingSurface" }),
                Surface::Ground => json!({ "type": "GroundSurface" }),
            };
            // Roof faces are listed one by one, all walls once.
            let is_roof = matches!(face.surface, Surface::Roof(_));
            let known = surfaces.iter().position(|one| !is_roof && *one == surface);
            values.push(known.unwrap_or_else(|| {
                surfaces.push(surface);
                surfaces.len() - 1
            }));
            let ring = |ring: &Vec<u32>| -> Vec<usize> {
                ring.iter().map(|&v| vertices[v as usize]).collect()
            };
            boundaries.push(Vec::from_iter(face.rings.iter().map(ring)));
        }
        let lod = match &stated["lod"] {
            Value::Null => json!("2.2"),
            stated => stated.clone(),
        };
        json!({
            "type": "Solid",
            "lod": lod,
            "boundaries": [boundaries],
            "semantics": { "surfaces": surfaces, "values": [values] },
        })
    }

    /// What is said of a roof face: what the Solid in whose place it comes says of the one that it
    /// was.
    fn roof_surface(
        &self,
        (model, facet): (&RoofModel, FacetId),
        (stated, was): (&Value, Option<usize>),
        source: Option<FacetId>,
    ) -> Value {
        let before = self.read.model();
        let place = source.zip(was).and_then(|(source, was)| {
            let mut faces = before.buildings[was].solid.faces.iter();
            faces.position(|f| f.surface == Surface::Roof(source))
        });
        let of = place.and_then(|place| stated["semantics"]["values"][0][place].as_u64());
        let of = of.map(|surface| stated["semantics"]["surfaces"][surface as usize].clone());
        let now = &model.facets[facet.index()];
        let then = source.map(|source| &before.facets[source.index()]);
        let is_as_before =
            then.is_some_and(|then| now.outer == then.outer && now.holes == then.holes);
        let mut surface = of_shape(of.unwrap_or_default(), is_as_before);
        if then.is_some_and(|then| now.obstructions != then.obstructions) {
            let scene = self.read.scene();
            let left = now
                .obstructions
                .iter()
                .map(|one| obstruction_of(&scene, one));
            surface[OBSTRUCTIONS] = left.collect();
        }
        // Somebody may have confirmed it.
        if let Some(probability) = surface.get_mut("probability") {
            *probability = json!(rounded(now.probability, 4));
        }
        surface
    }

    /// The number of a vertex, in whole steps of the file.
    fn vertex(&mut self, p: &Point3<f64>) -> usize {
        let whole = p.coords.component_div(&self.step);
        let whole = [whole.x, whole.y, whole.z].map(|n| n.round() as i64);
        let next = self.vertex_count + self.new_vertices.len();
        let index = *self.vertices.entry(whole).or_insert(next);
        if index == next {
            self.new_vertices.push(whole);
        }
        index
    }

    fn finished(mut self) -> String {
        let [objects_end, vertices_end] = self.ends;
        let mut insert = |at: usize, is_first: bool, items: Vec<String>| {
            if !items.is_empty() {
                let comma = if is_first { "" } else { "," };
                self.edits
                    .push((at..at, format!("{comma}{}", items.join(","))));
            }
        };
        let new = (1..).map(|i| format!("added-{i}"));
        let mut names = new.filter(|name| !self.objects.contains_key(name));
        let objects = self.added.iter().map(|solid| {
            let object = json!({ "type": "Building", "geometry": [solid] });
            format!(
                "{}:{object}",
                Value::String(names.next().unwrap_or_default())
            )
        });
        insert(objects_end, self.objects.is_empty(), objects.collect());
        let vertices = self.new_vertices.iter().map(|v| json!(v).to_string());
        insert(vertices_end, self.vertex_count == 0, vertices.collect());
        self.edits.sort_by_key(|(range, _)| range.start);
        let (mut text, mut from) = (String::with_capacity(self.text.len()), 0);
        for (range, new) in self.edits {
            text += &self.text[from..range.start];
            text += &new;
            from = range.end;
        }
        text + &self.text[from..]
    }
}

/// What is said of a roof face; without what only its former shape has, where that is another.
fn of_shape(mut stated: Value, is_as_before: bool) -> Value {
    if let Some(members) = stated.as_object_mut() {
        if !is_as_before {
            OF_ITS_SHAPE.iter().for_each(|name| {
                members.remove(*name);
            });
        }
        return stated;
    }
    json!({ "type": "RoofSurface" })
}

/// Are two buildings one, up to the numbers of their facets?
fn is_same(model: &RoofModel, building: &Building, before: &RoofModel, was: &Building) -> bool {
    let facets = |model: &RoofModel, of: &Building| -> Vec<_> {
        let own = of.facets.iter().map(|f| &model.facets[f.index()]);
        own.map(|f| {
            (
                f.plane,
                f.rings().cloned().collect::<Vec<_>>(),
                f.probability,
                f.obstructions.clone(),
            )
        })
        .collect()
    };
    building.solid.vertices == was.solid.vertices
        && building.ground_z == was.ground_z
        && facets(model, building) == facets(before, was)
}

/// Where a part of a text stands in it.
fn span(text: &str, part: Raw) -> Range<usize> {
    let start = part.get().as_ptr() as usize - text.as_ptr() as usize;
    start..start + part.get().len()
}
