//! IFC: read back as the STEP file that it is, and by IfcOpenShell where `python3` (or what PYTHON
//! says) has it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Write as _;
use std::process::Command;
use std::sync::LazyLock;

use nalgebra::Point3;
use ridgeline::orienting::scene::Scene;
use ridgeline::roofs::model::{BuildingWalls, Facet, RoofModel, Solid, SolidFace, Surface};
use serde_json::Value;

use crate::planted::{ORIGIN, files_of_walled, planted_models, scene};
use crate::report::known_models;
use crate::walls::walls_at;

/// A model in a scene, with walls or without, and the files that are written of it.
struct Written {
    scene: Scene,
    model: RoofModel,
    walls: Vec<BuildingWalls>,
    files: BTreeMap<String, Vec<u8>>,
}

impl Written {
    /// The solid of the only building.
    fn solid(&self) -> &Solid {
        let walled = self.walls.first().and_then(|walls| walls.solid.as_ref());
        walled.unwrap_or(&self.model.buildings[0].solid)
    }
}

/// Each model in a scene whose system is not known, and is; the last one with walls inside eaves.
static WRITTEN: LazyLock<Vec<Written>> = LazyLock::new(|| {
    let models = known_models().into_iter().enumerate();
    let of = |(i, (name, model, _)): (usize, (&str, RoofModel, _))| {
        let mut scene = scene();
        scene.survey.epsg = (i % 2 == 1).then_some(25832);
        let walls = (name == "courtyard").then(|| walls_at(&model, |_| 0.5));
        let walls: Vec<BuildingWalls> = walls.into_iter().collect();
        let files = files_of_walled(&scene, &model, &walls);
        Written {
            scene,
            model,
            walls,
            files,
        }
    };
    models.map(of).collect()
});

/// The entities of a file: the class and the arguments of each, by number.
fn entities(file: &[u8]) -> BTreeMap<u32, (String, String)> {
    let text = std::str::from_utf8(file).unwrap();
    assert!(text.is_ascii());
    assert!(text.starts_with("ISO-10303-21;\nHEADER;\n") && text.ends_with("END-ISO-10303-21;\n"));
    let (_, data) = text.split_once("DATA;\n").unwrap();
    let (data, _) = data.split_once("ENDSEC;").unwrap();
    let mut found = BTreeMap::new();
    for line in data.lines() {
        let (number, rest) = line[1..].split_once('=').unwrap();
        let (class, arguments) = rest.split_once('(').unwrap();
        let entity = (class.into(), arguments.strip_suffix(");").unwrap().into());
        assert!(found.insert(number.parse().unwrap(), entity).is_none());
    }
    found
}

/// The numbers that arguments refer to.
fn references(arguments: &str) -> impl Iterator<Item = u32> {
    let parts = arguments.split('#').skip(1);
    parts.map(|part| {
        let end = part.find(|c: char| !c.is_ascii_digit());
        part[..end.unwrap_or(part.len())].parse().unwrap()
    })
}

/// Per class that is a root, the identifiers.
fn identifiers(file: &[u8]) -> Vec<(String, String)> {
    let found = entities(file).into_values().filter_map(|(class, of)| {
        let (id, _) = of.strip_prefix('\'')?.split_once("',$,")?;
        (id.len() == 22).then(|| (class, id.to_owned()))
    });
    found.collect()
}

#[test]
fn references_lead_somewhere_and_identifiers_are_unique() {
    for of in &*WRITTEN {
        let file = &of.files["model.ifc"];
        let entities = entities(file);
        for (class, arguments) in entities.values() {
            let known = references(arguments).all(|number| entities.contains_key(&number));
            assert!(known, "{class}({arguments})");
        }
        let identifiers = identifiers(file);
        let rooted = ["IFCREL", "IFCSLAB", "IFCWALL", "IFCROOF", "IFCPROPERTYSET"];
        let rooted = |class: &str| rooted.iter().any(|root| class.starts_with(root));
        let wanted = entities.values().filter(|(class, _)| rooted(class)).count();
        assert!(identifiers.len() > wanted);
        let unique: BTreeSet<&String> = identifiers.iter().map(|(_, id)| id).collect();
        assert_eq!(unique.len(), identifiers.len());
        // 22 digits of 6 bits are 132 of 128.
        assert!(
            unique
                .iter()
                .all(|id| matches!(id.as_bytes()[0], b'0'..=b'3'))
        );
    }
}

#[test]
fn areas_are_those_of_the_model() {
    for of in &*WRITTEN {
        let area = |quantity: &str| -> f64 {
            let found = entities(&of.files["model.ifc"]).into_values();
            let found = found.filter_map(|(class, arguments)| {
                let value = arguments.strip_prefix(&format!("'{quantity}',$,$,"))?;
                assert_eq!(class, "IFCQUANTITYAREA");
                value.strip_suffix(",$")?.parse::<f64>().ok()
            });
            found.sum()
        };
        let near = |quantity: &str, wanted: f64| {
            let found = area(quantity);
            assert!(
                (found - wanted).abs() < 1e-3,
                "{quantity}: {found}, not {wanted}"
            );
        };
        let all = |area: fn(&Facet) -> f64| of.model.facets.iter().map(area).sum::<f64>();
        near("ProjectedArea", all(|facet| facet.plan().signed_area()));
        let faces = of.solid().faces.iter();
        let of_walls = |face: &&SolidFace| face.surface == Surface::Wall;
        let (walls, others): (Vec<_>, Vec<_>) = faces.partition(of_walls);
        let sum = |faces: &[&SolidFace], rings: usize| -> f64 {
            let rings = faces
                .iter()
                .map(|face| &face.rings[..face.rings.len().min(rings)]);
            rings
                .map(|rings| of.solid().vector_area(rings).norm())
                .sum()
        };
        near("NetSideArea", sum(&walls, usize::MAX));
        // What is stated of a slab is stated of its roof too.
        let net = all(|facet| facet.plan().signed_area() / facet.plane.normal.z);
        near("NetArea", sum(&others, usize::MAX) + net);
        near("GrossArea", sum(&others, 1) + all(Facet::sloped_area));
    }
}

#[test]
fn another_run_of_a_scene_gives_the_same_identifiers_and_another_scene_others() {
    let file = |scene: &Scene, model: &RoofModel| {
        identifiers(&files_of_walled(scene, model, &[])["model.ifc"])
    };
    let [first, scene] = [scene(), scene()];
    let (_, model, _) = planted_models().remove(2);
    let mut moved = model.clone();
    moved.facets[0].probability = 0.5;
    moved.buildings[0].solid.vertices[0].z += 0.01;
    assert_eq!(file(&first, &model), file(&scene, &moved));
    let mut elsewhere = scene;
    elsewhere.origin.x += 1.0;
    let ids = |found: Vec<(String, String)>| found.into_iter().map(|(_, id)| id);
    let ours: BTreeSet<String> = ids(file(&first, &model)).collect();
    assert!(ids(file(&elsewhere, &model)).all(|id| !ours.contains(&id)));
}

#[test]
fn names_of_photographs_are_written_in_ascii() {
    let mut scene = scene();
    scene.views[0].name = "D'Äcker\\𝄞.jpg".into();
    let (_, model, _) = planted_models().remove(0);
    let file = &files_of_walled(&scene, &model, &[])["model.ifc"];
    let text = std::str::from_utf8(file).unwrap();
    let name = r"'photographs: D''\X2\00C4\X0\cker\\\X4\0001D11E\X0\.jpg; b.jpg'";
    assert!(text.contains(name), "{text}");
}

/// What IfcOpenShell reads in files; `None`, said aloud, where it, or the pytest by which it asks
/// the rules of the schema, is not there.
fn read(files: &[&[u8]]) -> Option<Vec<Value>> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let is_there = (Command::new(&python)
        .args(["-c", "import ifcopenshell, pytest"])
        .output())
    .is_ok_and(|output| output.status.success());
    if !is_there {
        // Past the harness, which keeps what a passing test prints.
        let words =
            format!("skipped: {python} has no ifcopenshell (pip install ifcopenshell pytest)\n");
        std::io::stderr().write_all(words.as_bytes()).unwrap();
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = |i: usize| folder.path().join(format!("{i}.ifc"));
    for (i, file) in files.iter().enumerate() {
        fs::write(path(i), file).unwrap();
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/export/read_ifc.py");
    let mut command = Command::new(&python);
    let output = command.arg(script).args((0..files.len()).map(path));
    let output = output.output().unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaint}");
    let read: Value = serde_json::from_slice(&output.stdout).unwrap();
    let of = |i| read[path(i).to_str().unwrap()].clone();
    Some((0..files.len()).map(of).collect())
}

fn number(value: &Value, path: &str) -> f64 {
    let found = value.pointer(path).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("{path}: {value}"))
}

fn list<'a>(value: &'a Value, name: &str) -> &'a Vec<Value> {
    value[name].as_array().unwrap()
}

#[test]
fn ifcopenshell_reads_what_the_other_files_have() {
    let files: Vec<&[u8]> = WRITTEN.iter().map(|of| &*of.files["model.ifc"]).collect();
    let Some(all) = read(&files) else {
        return;
    };
    assert_eq!(WRITTEN.last().map(|of| of.walls.len()), Some(1));
    for (read, of) in all.iter().zip(&*WRITTEN) {
        assert_eq!(read["problems"], serde_json::json!([]));
        let counted = ["buildings", "roofs", "grounds", "slabs"].map(|kind| list(read, kind).len());
        let (buildings, faces) = (of.model.buildings.len(), of.model.facets.len());
        assert_eq!(counted, [buildings, buildings, buildings, faces]);
        assert_faces(read, &of.files["model.city.json"]);
        assert_corners(&of.model, list(read, "slabs"));
        assert_roofs(read, &of.files["roofs.json"]);
        assert_walls(read, of.solid());
        let place = of.scene.survey.geographic(&ORIGIN.into());
        assert_eq!(place.is_some(), of.scene.survey.epsg.is_some());
        for (i, degrees) in place.into_iter().flatten().take(2).enumerate() {
            let found = read["place"][i].as_f64().unwrap();
            assert!((found - degrees).abs() < 1e-9, "{found} for {degrees}");
        }
    }
}

/// The faces are those of CityJSON.
fn assert_faces(read: &Value, city: &[u8]) {
    let city: Value = serde_json::from_slice(city).unwrap();
    let surfaces = &city["CityObjects"]["building-1"]["geometry"][0]["semantics"];
    for slab in list(read, "slabs") {
        let mut surfaces = list(surfaces, "surfaces").iter();
        let is_it = |surface: &&Value| slab["name"] == format!("facet-{}", surface["facet"]);
        let surface = surfaces.find(is_it).unwrap();
        let same = |ours: &str, stated: &str, accuracy: f64| {
            let found = (number(slab, ours), number(surface, stated));
            let difference = (found.0 - found.1).abs();
            assert!(difference < accuracy, "{ours}: {found:?}");
        };
        same("/Qto_SlabBaseQuantities/NetArea", "/area", 2e-4);
        same("/area", "/area", 0.01);
        same("/Pset_SlabCommon/PitchAngle", "/slopeDeg", 1e-3);
        same("/Ridgeline/PitchAngleSigma", "/slopeSigmaDeg", 1e-9);
        same("/Ridgeline/NetAreaSigma", "/areaSigma", 1e-9);
        same("/Ridgeline/Probability", "/probability", 1e-9);
        if surface["azimuthDeg"].is_number() {
            same("/Ridgeline/Azimuth", "/azimuthDeg", 1e-3);
            same("/Ridgeline/AzimuthSigma", "/azimuthSigmaDeg", 1e-9);
        }
        assert_eq!(slab["description"], "photographs: a.jpg; b.jpg");
        assert_eq!(slab["parent"], "roof-1");
    }
}

/// The corners of slabs are those of facets in the world.
fn assert_corners(model: &RoofModel, slabs: &[Value]) {
    for slab in slabs {
        let name = slab["name"].as_str().unwrap();
        let facet = &model.facets[name["facet-".len()..].parse::<usize>().unwrap()];
        let wanted: Vec<_> = facet.rings().flatten().map(|p| p + ORIGIN).collect();
        let corners = list(slab, "corners");
        assert!(corners.len() >= wanted.len());
        for corner in corners {
            let corner = Point3::from([0, 1, 2].map(|i| corner[i].as_f64().unwrap()));
            let nearest = wanted.iter().map(|p| (p - corner).norm());
            assert!(nearest.fold(9.0, f64::min) < 1e-3, "{corner}: {wanted:?}");
        }
    }
}

/// The measures of whole roofs are those of `roofs.json`.
fn assert_roofs(read: &Value, roofs: &[u8]) {
    let report: Value = serde_json::from_slice(roofs).unwrap();
    for (roof, building) in list(read, "roofs").iter().zip(list(&report, "buildings")) {
        for (ours, theirs) in [("NetArea", "area"), ("ProjectedArea", "groundArea")] {
            let found = [
                number(roof, &format!("/Qto_RoofBaseQuantities/{ours}")),
                number(building, &format!("/wholeRoofStats/{theirs}Meters2")),
                number(roof, &format!("/Ridgeline/{ours}Sigma")),
                number(building, &format!("/wholeRoofStats/{theirs}SigmaMeters2")),
            ];
            assert!((found[0] - found[1]).abs() < 0.01, "{ours}: {found:?}");
            assert!((found[2] - found[3]).abs() < 1e-3, "{ours}: {found:?}");
        }
    }
}

/// Walls and undersides of eaves are as large as those of the solid.
fn assert_walls(read: &Value, solid: &Solid) {
    for (kind, surface) in [("walls", Surface::Wall), ("ceilings", Surface::Ceiling)] {
        let drawn = list(read, kind).iter();
        let drawn: f64 = drawn.map(|face| number(face, "/area")).sum();
        let faces = solid.faces.iter().filter(|face| face.surface == surface);
        let areas = faces.map(|face| solid.vector_area(&face.rings).norm());
        let wanted: f64 = areas.sum();
        assert!(
            (drawn - wanted).abs() < 0.01,
            "{kind}: {drawn}, not {wanted}"
        );
    }
}
