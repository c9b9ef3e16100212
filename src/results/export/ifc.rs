//! IFC4 for building information models, as a STEP file (ISO 16739-1, ISO 10303-21): of each
//! building a roof of one slab a face, walls where they are known to stand, undersides of eaves and
//! the slab on the ground; all are surfaces, with base quantities.
//!
//! Metres and degrees. Coordinates count from the scene's origin, which a map conversion places
//! where the reference system is known, and the placement of the site otherwise. Identifiers are
//! hashes of photographs, cameras and place in the model: another run gives a face the same one.

use std::fmt::Arguments;

use nalgebra::Vector3;

use super::format::{push_line, rounded};
use super::measured::Measured;
use crate::base::ids::{BuildingId, FacetId};
use crate::orienting::scene::Scene;
use crate::results::roof_report::{BuildingReport, Estimate};
use crate::roofs::model::{BuildingWalls, RoofModel, Solid, SolidFace, Surface};

/// What all files begin with: a header of a fixed time, and units, axes and contexts by their
/// numbers below.
const HEAD: &str = include_str!("ifc_head.txt");

/// Digits of identifiers.
const DIGITS: &[u8; 64] = b"0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$";

/// What has no place in the standard's sets of properties.
const OWN_SET: &str = "Ridgeline";

/// Measure, name and value.
type Quantity<'a> = (&'a str, &'a str, Estimate);

/// The model as an IFC file.
pub(super) fn ifc(
    scene: &Scene,
    (model, walls): (&RoofModel, &[BuildingWalls]),
    measured: &Measured,
) -> Vec<u8> {
    let mut file = IfcFile::of(scene);
    let (site, place) = file.site(scene);
    let mut buildings = Vec::new();
    for (i, building) in model.buildings.iter().enumerate() {
        let walled = walls.get(i).and_then(|walls| walls.solid.as_ref());
        let solid = walled.unwrap_or(&building.solid);
        let ground_m = rounded(building.ground_z + scene.origin.z, 4);
        buildings.push(file.building((measured, i), solid, (place, ground_m)));
    }
    if !buildings.is_empty() {
        file.aggregate(site, &buildings);
    }
    file.text.push_str("ENDSEC;\nEND-ISO-10303-21;\n");
    file.text.into_bytes()
}

/// A file that is being written.
struct IfcFile {
    text: String,
    /// Number of the last entity.
    last: u32,
    /// Hash of the scene.
    seed: u128,
    /// What the last identifier belongs to: a building, from 1, and which one of it.
    identified: [u32; 2],
    /// Standard deviations that are in no set yet.
    sigmas: Vec<u32>,
}

impl IfcFile {
    fn of(scene: &Scene) -> Self {
        let names = scene.views.iter().flat_map(|view| view.name.bytes());
        let centers = scene.views.iter().map(|view| view.camera.center.coords);
        let places = centers.chain([scene.origin]).flat_map(<[f64; 3]>::from);
        let bytes = names.chain(places.flat_map(f64::to_le_bytes));
        Self {
            text: HEAD.into(),
            last: HEAD.matches("\n#").count() as u32,
            seed: hashed(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d, bytes),
            identified: [0, 0],
            sigmas: Vec::new(),
        }
    }

    /// Project and site, which is where the scene's origin is; gives the site and its placement.
    fn site(&mut self, scene: &Scene) -> (u32, u32) {
        let project = self.root("PROJECT", format_args!("'Roofs',$,$,$,$,(#11),#8"));
        let origin = coordinates(&scene.origin);
        let axes = match scene.survey.epsg {
            Some(epsg) => {
                let system = self.add(format_args!("PROJECTEDCRS('EPSG:{epsg}',$,$,$,$,$,#1)"));
                self.add(format_args!("MAPCONVERSION(#11,#{system},{origin},$,$,$)"));
                10
            }
            None => {
                let point = self.add(format_args!("CARTESIANPOINT(({origin}))"));
                self.add(format_args!("AXIS2PLACEMENT3D(#{point},$,$)"))
            }
        };
        let place = self.add(format_args!("LOCALPLACEMENT($,#{axes})"));
        let earth = match scene.survey.geographic(&scene.origin.into()) {
            Some([lon, lat, height]) => {
                format!("{},{},{:?}", angle(lat), angle(lon), rounded(height, 4))
            }
            None => "$,$,$".into(),
        };
        let site = format_args!("'Site',$,$,#{place},$,$,.ELEMENT.,{earth},$,$");
        let site = self.root("SITE", site);
        self.aggregate(project, &[site]);
        (site, place)
    }

    /// A building of the faces of a solid; `ground_m` is the height of its ground in the world.
    fn building(
        &mut self,
        (measured, index): (&Measured, usize),
        solid: &Solid,
        (place, ground_m): (u32, f64),
    ) -> u32 {
        self.identified = [index as u32 + 1, 0];
        let place = self.placed_in(place);
        let name = BuildingId::from_index(index).name();
        let of = format_args!("'{name}',$,$,#{place},$,$,.ELEMENT.,$,{ground_m:?},$");
        let building = self.root("BUILDING", of);
        let place = self.placed_in(place);
        let of = format_args!("'roof-{}',$,$,#{place},$,$,.NOTDEFINED.", index + 1);
        let roof = self.root("ROOF", of);
        let places = [place, self.placed_in(place)];
        let points = solid.vertices.iter().map(|p| coordinates(&p.coords));
        let points = points.collect::<Vec<String>>().join("),(");
        let points = self.add(format_args!("CARTESIANPOINTLIST3D((({points})))"));
        let (mut slabs, mut contained, mut gross_m2) = (Vec::new(), vec![roof], 0.0);
        for (i, face) in solid.faces.iter().enumerate() {
            let shape = self.shape(points, face);
            let areas = [&face.rings[..1], &face.rings];
            let areas = areas.map(|rings| certain(solid.vector_area(rings).norm()));
            let words = match face.surface {
                Surface::Roof(id) => {
                    gross_m2 += areas[0].value;
                    slabs.push(self.slab(measured, id, [places[1], shape], areas));
                    continue;
                }
                Surface::Wall => ["Wall", "NOTDEFINED", "wall", "Side"],
                Surface::Ceiling => ["Covering", "CEILING", "ceiling", ""],
                Surface::Ground => ["Slab", "BASESLAB", "ground", ""],
            };
            contained.push(self.element(words, (i, "$"), [places[0], shape], areas));
        }
        self.aggregate(roof, &slabs);
        let of = format_args!("$,$,{},#{building}", references(&contained));
        self.root("RELCONTAINEDINSPATIALSTRUCTURE", of);
        self.measure([building, roof], &measured.buildings[index], gross_m2);
        building
    }

    /// The measures of a building and its roof.
    fn measure(&mut self, [building, roof]: [u32; 2], report: &BuildingReport, gross_m2: f64) {
        let quantities = [
            ("VOLUME", "GrossVolume", report.volume_m3),
            ("LENGTH", "Height", report.highest_m),
            ("LENGTH", "EavesHeight", report.lowest_m),
        ];
        self.describe(building, "Qto_BuildingBaseQuantities", &quantities);
        let probability = certain(report.probability);
        let stated = ("NORMALISEDRATIO", "Probability", probability);
        self.describe(building, OWN_SET, &[stated]);
        let quantities = [
            ("AREA", "GrossArea", certain(gross_m2)),
            ("AREA", "NetArea", report.area_m2),
            ("AREA", "ProjectedArea", report.plan_area_m2),
        ];
        self.describe(roof, "Qto_RoofBaseQuantities", &quantities);
        self.describe(roof, OWN_SET, &[]);
    }

    /// A face of the roof.
    fn slab(
        &mut self,
        measured: &Measured,
        id: FacetId,
        drawn: [u32; 2],
        mut areas: [Estimate; 2],
    ) -> u32 {
        let known = measured.facet(id);
        areas[1].sigma = known.and_then(|facet| facet.area_m2.sigma);
        let views = measured.photographs[id.index()].join("; ");
        let views = quoted(&format!("photographs: {views}"));
        let words = ["Slab", "ROOF", "facet", ""];
        let slab = self.element(words, (id.index(), &views), drawn, areas);
        if let Some(facet) = known {
            let pitch = ("PLANEANGLE", "PitchAngle", facet.slope_deg);
            self.describe(slab, "Pset_SlabCommon", &[pitch]);
            let probability = certain(facet.probability);
            let mut stated = vec![("NORMALISEDRATIO", "Probability", probability)];
            stated.extend(facet.azimuth_deg.map(|deg| ("PLANEANGLE", "Azimuth", deg)));
            self.describe(slab, OWN_SET, &stated);
        }
        slab
    }

    /// A surface with its quantities: its class, kind, name and what its area is called, index and
    /// description, placement and shape, area without and with its holes taken off.
    fn element(
        &mut self,
        [class, kind, name, side]: [&str; 4],
        (index, text): (usize, &str),
        [place, shape]: [u32; 2],
        [gross, net]: [Estimate; 2],
    ) -> u32 {
        let of = format_args!(
            "'{name}-{}',{text},$,#{place},#{shape},$,.{kind}.",
            index + 1
        );
        let element = self.root(&class.to_ascii_uppercase(), of);
        let names = ["Gross", "Net"].map(|of| format!("{of}{side}Area"));
        let areas = [("AREA", &*names[0], gross), ("AREA", &*names[1], net)];
        self.describe(element, &format!("Qto_{class}BaseQuantities"), &areas);
        element
    }

    /// The shape of a face whose corners are in a list.
    fn shape(&mut self, points: u32, face: &SolidFace) -> u32 {
        // Corners count from 1.
        let ring = |ring: &Vec<u32>| listed(&ring.iter().map(|v| v + 1).collect::<Vec<_>>(), "");
        let rings: Vec<String> = face.rings.iter().map(ring).collect();
        let (outer, holes) = (&rings[0], rings[1..].join(","));
        let face = match holes.is_empty() {
            true => self.add(format_args!("INDEXEDPOLYGONALFACE({outer})")),
            false => self.add(format_args!(
                "INDEXEDPOLYGONALFACEWITHVOIDS({outer},({holes}))"
            )),
        };
        let set = self.add(format_args!("POLYGONALFACESET(#{points},.F.,(#{face}),$)"));
        let body = self.add(format_args!(
            "SHAPEREPRESENTATION(#12,'Body','Tessellation',(#{set}))"
        ));
        self.add(format_args!("PRODUCTDEFINITIONSHAPE($,$,(#{body}))"))
    }

    /// A placement at the origin of another one.
    fn placed_in(&mut self, place: u32) -> u32 {
        self.add(format_args!("LOCALPLACEMENT(#{place},#10)"))
    }

    /// States quantities, or properties, of an object as a set of this name, and their standard
    /// deviations in [`OWN_SET`], which comes last.
    fn describe(&mut self, object: u32, name: &str, known: &[Quantity]) {
        let is_quantity = name.starts_with("Qto_");
        let mut members = Vec::new();
        for (measure, name, Estimate { value, sigma }) in known {
            let value = rounded(*value, 4);
            members.push(match is_quantity {
                // The schema has none below zero, which eaves in a slope may be.
                true => {
                    let value = value.max(0.0);
                    self.add(format_args!("QUANTITY{measure}('{name}',$,$,{value:?},$)"))
                }
                false => self.property(measure, name, value),
            });
            if let Some(sigma) = sigma.filter(|sigma| sigma.is_finite()) {
                let sigma = self.property(measure, &format!("{name}Sigma"), rounded(sigma, 4));
                self.sigmas.push(sigma);
            }
        }
        if name == OWN_SET {
            members.append(&mut self.sigmas);
        }
        if members.is_empty() {
            return;
        }
        let members = references(&members);
        let set = match is_quantity {
            true => self.root("ELEMENTQUANTITY", format_args!("'{name}',$,$,{members}")),
            false => self.root("PROPERTYSET", format_args!("'{name}',$,{members}")),
        };
        self.root(
            "RELDEFINESBYPROPERTIES",
            format_args!("$,$,(#{object}),#{set}"),
        );
    }

    fn property(&mut self, measure: &str, name: &str, value: f64) -> u32 {
        self.add(format_args!(
            "PROPERTYSINGLEVALUE('{name}',$,IFC{measure}MEASURE({value:?}),$)"
        ))
    }

    fn aggregate(&mut self, whole: u32, parts: &[u32]) {
        let parts = references(parts);
        self.root("RELAGGREGATES", format_args!("$,$,#{whole},{parts}"));
    }

    /// An entity with an identifier; gives its number.
    fn root(&mut self, class: &str, arguments: Arguments) -> u32 {
        self.identified[1] += 1;
        let key = self.identified.into_iter().flat_map(u32::to_le_bytes);
        let hash = hashed(self.seed, key);
        let digit = |i: u32| char::from(DIGITS[(hash >> (6 * i)) as usize % DIGITS.len()]);
        let id: String = (0..22).rev().map(digit).collect();
        self.add(format_args!("{class}('{id}',$,{arguments})"))
    }

    /// An entity; gives its number. Not inlined: visitors of the page wait for what is large.
    #[inline(never)]
    fn add(&mut self, entity: Arguments) -> u32 {
        self.last += 1;
        push_line(&mut self.text, format_args!("#{}=IFC{entity};", self.last));
        self.last
    }
}

/// The hash FNV-1a of bytes behind those that made `seed`.
fn hashed(seed: u128, bytes: impl Iterator<Item = u8>) -> u128 {
    bytes.fold(seed, |hash, byte| {
        (hash ^ u128::from(byte)).wrapping_mul(0x100_0000_0000_0000_0000_013b)
    })
}

fn certain(value: f64) -> Estimate {
    Estimate { value, sigma: None }
}

fn listed(numbers: &[u32], before: &str) -> String {
    let numbers: Vec<String> = numbers
        .iter()
        .map(|number| format!("{before}{number}"))
        .collect();
    format!("({})", numbers.join(","))
}

fn references(numbers: &[u32]) -> String {
    listed(numbers, "#")
}

#[inline(never)]
fn coordinates(v: &Vector3<f64>) -> String {
    let [x, y, z] = v.map(|c| rounded(c, 4)).into();
    format!("{x:?},{y:?},{z:?}")
}

/// Degrees, minutes, seconds and millionths of them, all of one sign.
fn angle(degrees: f64) -> String {
    let millionths = (degrees * 3.6e9).round() as i64;
    let [minutes, seconds] = [60_000_000, 1_000_000].map(|unit| millionths / unit % 60);
    let (whole, rest) = (millionths / 3_600_000_000, millionths % 1_000_000);
    format!("({whole},{minutes},{seconds},{rest})")
}

/// A string of any characters.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("'");
    for c in text.chars() {
        match c {
            '\'' | '\\' => quoted.extend([c, c]),
            ' '..='~' => quoted.push(c),
            '\u{10000}'.. => quoted += &format!("\\X4\\{:08X}\\X0\\", u32::from(c)),
            _ => quoted += &format!("\\X2\\{:04X}\\X0\\", u32::from(c)),
        }
    }
    quoted + "'"
}
