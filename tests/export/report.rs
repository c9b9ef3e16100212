//! The roof report: page, tables and maps, and the attributes of CityJSON.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use ridgeline::orienting::orientation::{Anchor, FrameSigma};
use ridgeline::orienting::scene::{Scene, Survey};
use ridgeline::results::export::ReportedModel;
use ridgeline::results::roof_report::SetbackRule;
use ridgeline::roofs::model::{
    CornerUncertainty, Facet, FacetUncertainty, RoofModel, SideSupport, SideUncertainty,
};
use serde_json::Value;

use crate::planted::{ORIGIN, files_of, files_of_walled, planted_models, scene};
use crate::walls::walls_at;

/// The models, with planted standard deviations.
pub fn known_models() -> Vec<(&'static str, RoofModel, f64)> {
    let mut models = planted_models();
    for facet in models
        .iter_mut()
        .flat_map(|(_, model, _)| &mut model.facets)
    {
        let corner = |&at: &nalgebra::Point3<f64>| CornerUncertainty {
            at,
            sigma_m: Vector3::new(0.03, 0.04, 0.05),
        };
        facet.uncertainty = Some(FacetUncertainty {
            height_m: 0.06,
            slope_deg: 0.5,
            corners: facet.outer.iter().map(corner).collect(),
            sides: sides_of(facet),
        });
    }
    models
}

/// The sides of a facet, each resting on something else.
fn sides_of(facet: &Facet) -> Vec<SideUncertainty> {
    let supports = [
        SideSupport::Edges,
        SideSupport::Planes,
        SideSupport::Nothing,
    ];
    let plan = facet.plan();
    (plan.sides().zip(supports.into_iter().cycle()))
        .map(|(ends, support)| SideUncertainty {
            ends,
            sigma_m: 0.02,
            support,
        })
        .collect()
}

fn rows(table: &[u8]) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_reader(table);
    reader.deserialize().map(Result::unwrap).collect()
}

fn number(row: &BTreeMap<String, String>, name: &str) -> f64 {
    row[name]
        .parse()
        .unwrap_or_else(|_| panic!("{name}: {row:?}"))
}

#[test]
fn a_folder_makes_the_same_report_again() {
    let anchor = Anchor {
        lon_deg: 8.123_456_789,
        lat_deg: 48.987_654_321,
        height_m: 312.5,
    };
    let places = [(None, None), (Some(25832), None), (None, Some(anchor))];
    for ((name, mut model, _), (epsg, anchor)) in known_models().into_iter().zip(places) {
        // Numbers of more digits than a file has, and one that it cannot have.
        model.buildings[0].ground_z = 0.123_456;
        let facet = &mut model.facets[0];
        facet.probability = 0.876_543_21;
        let known = facet.uncertainty.as_mut().unwrap();
        (known.slope_deg, known.sides[0].sigma_m) = (0.123_456, f64::NAN);
        model.facets[1].uncertainty.as_mut().unwrap().height_m = f64::INFINITY;
        let mut scene = scene();
        scene.survey.epsg = epsg;
        if anchor.is_some() {
            (scene.survey.anchor, scene.origin) = (anchor, Vector3::zeros());
        }
        let walls = walls_at(&model, |_| 0.5);
        let files = files_of_walled(&scene, &model, &[walls]);
        let again = ReportedModel::read(&files["model.city.json"]).unwrap();
        let again = again.files(&SetbackRule::built_in());
        assert_eq!(again.len(), 5);
        for (file, bytes) in again {
            assert!(files[&file] == bytes, "{name}: {file}");
        }
    }
}

/// The standard deviation of a sum of two independent errors.
fn both_sigmas(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

#[test]
fn what_the_frame_is_worth_is_in_every_standard_deviation_and_only_where_it_is_stated() {
    let frame = FrameSigma {
        length_of_10_m: Some(0.05),
        height_over_10_m: Some(0.02),
    };
    let framed = Scene {
        survey: Survey {
            frame_sigma: Some(frame),
            ..Survey::default()
        },
        ..scene()
    };
    for (name, model, _) in known_models() {
        let [without, with] = [scene(), framed.clone()].map(|s| files_of(&s, &model));
        let stated = |files: &BTreeMap<String, Vec<u8>>, file: &str| {
            String::from_utf8_lossy(&files[file]).contains("frame")
        };
        for file in ["model.city.json", "roofs.json", "roof_report.html"] {
            assert!(
                !stated(&without, file) && stated(&with, file),
                "{name}: {file}"
            );
        }
        let page = String::from_utf8_lossy(&with["roof_report.html"]);
        assert!(page.contains("10 m is known to ± 0.050 m by the scale"));
        let read = ReportedModel::read(&with["model.city.json"]).unwrap();
        let again = read.files(&SetbackRule::built_in());
        assert!(
            again.iter().all(|(file, bytes)| with[file] == *bytes),
            "{name}"
        );
        for (table, value, sigma, dimensions) in [
            ("buildings.csv", "area_m2", "area_sigma_m2", 2.0),
            ("buildings.csv", "volume_m3", "volume_sigma_m3", 3.0),
            ("facets.csv", "plan_area_m2", "plan_area_sigma_m2", 2.0),
            ("facets.csv", "highest_m", "highest_sigma_m", 1.0),
            ("edges.csv", "length_m", "length_sigma_m", 1.0),
        ] {
            for (own, both) in rows(&without[table]).iter().zip(rows(&with[table])) {
                assert_eq!(own[value], both[value]);
                let added = 0.005 * dimensions * number(own, value);
                let expected = both_sigmas(number(own, sigma), added);
                let off = number(&both, sigma) - expected;
                assert!(
                    off.abs() < 2e-3 * expected.max(1.0),
                    "{name}: {sigma}: {off}"
                );
            }
        }
        let slope = |files: &BTreeMap<String, Vec<u8>>| {
            number(&rows(&files["facets.csv"])[0], "slope_sigma_deg")
        };
        let expected = both_sigmas(slope(&without), 0.002f64.to_degrees());
        assert!((slope(&with) - expected).abs() < 2e-3, "{name}");
    }
}

#[test]
fn numbers_count_from_one_and_are_the_same_in_all_files() {
    let (_, model, _) = known_models().remove(1);
    let files = files_of(&scene(), &model);
    let text = |name: &str| String::from_utf8_lossy(&files[name]).into_owned();
    let wanted: Vec<u64> = (1..=model.facets.len() as u64).collect();
    let named = |all: &Value, name: &str| -> Vec<u64> {
        let numbers = all.as_array().unwrap().iter();
        numbers.filter_map(|one| one[name].as_u64()).collect()
    };
    let json = |name: &str| serde_json::from_slice::<Value>(&files[name]).unwrap();
    let city = &json("model.city.json")["CityObjects"]["building-1"]["geometry"][0];
    assert_eq!(named(&city["semantics"]["surfaces"], "facet"), wanted);
    let building = &json("roofs.json")["buildings"][0];
    assert_eq!(building["name"], "building-1");
    assert_eq!(named(&building["roofSegmentStats"], "facet"), wanted);
    let maps = json("facets.geojson")["features"].clone();
    let maps: Value = (maps.as_array().unwrap().iter())
        .map(|feature| feature["properties"].clone())
        .collect();
    assert_eq!(named(&maps, "facet"), wanted);
    assert_eq!(named(&maps, "building"), vec![1; wanted.len()]);
    let of_table: Vec<u64> = (rows(&files["facets.csv"]).iter())
        .map(|row| row["facet"].parse().unwrap())
        .collect();
    assert_eq!(of_table, wanted);
    for (file, marks) in [
        ("model.obj", ["o building-1\n", "g facet-1\n"]),
        ("model.ifc", ["'building-1'", "'facet-1'"]),
        ("model.glb", ["\"building-1\"", "\"facet-1\""]),
    ] {
        let text = text(file);
        for mark in marks {
            assert!(text.contains(mark), "{file}: {mark}");
            assert!(!text.contains(&mark.replace('1', "0")), "{file}: {mark}");
        }
    }
}

#[test]
fn tables_hold_planted_areas_lengths_and_places() {
    let (_, model, volume) = known_models().remove(1);
    let files = files_of(&scene(), &model);
    let building = &rows(&files["buildings.csv"])[0];
    assert_eq!(building["building"], "building-1");
    let near = |name: &str, wanted: f64| {
        let found = number(building, name);
        assert!(
            (found - wanted).abs() < 2e-3,
            "{name}: {found} for {wanted}"
        );
    };
    // The L: two wings of slope 1 : 2.
    near("plan_area_m2", 16.0 * 6.0 + 6.0 * 6.0);
    near("area_m2", 132.0 * 1.25f64.sqrt());
    near("volume_m3", volume);
    near("ridge_m", 22.0);
    near("hip_m", 4.5);
    near("valley_m", 4.5);
    near("eave_m", 44.0);
    near("rake_m", 4.0 * 11.25f64.sqrt());
    near("lowest_m", 5.0);
    near("lowest_sigma_m", 0.05);
    assert_eq!(building["abutment_m"], "");
    let facets = rows(&files["facets.csv"]);
    assert_eq!(facets.len(), 4);
    let south = &facets[0];
    assert!((number(south, "azimuth_deg") - 180.0).abs() < 1e-3);
    assert_eq!(number(south, "slope_sigma_deg"), 0.5);
    // Half a degree of tilt across a slope of 26.57 degrees.
    let turn = (0.5f64.to_radians() * 1.25 / 0.5).to_degrees();
    assert!((number(south, "azimuth_sigma_deg") - turn).abs() < 1e-2);
    assert_eq!(south["photographs"], "a.jpg; b.jpg");
    let edges = rows(&files["edges.csv"]);
    let ridge = edges.iter().find(|e| e["kind"] == "ridge").unwrap();
    assert_eq!(number(ridge, "y0_m"), ORIGIN.y + 3.0);
    // The rakes at both ends by 2 cm.
    assert!((number(ridge, "length_sigma_m") - 0.02 * 2f64.sqrt()).abs() < 1e-3);
    let sum: f64 = (edges.iter().filter(|e| e["kind"] == "eave"))
        .map(|e| number(e, "length_m"))
        .sum();
    assert!((sum - 44.0).abs() < 2e-3);
}

#[test]
fn maps_and_cityjson_say_what_the_tables_say() {
    for (name, model, _) in known_models() {
        let files = files_of(&scene(), &model);
        let parse = |file: &str| -> geojson::FeatureCollection {
            let text = std::str::from_utf8(&files[file]).unwrap();
            let parsed: geojson::GeoJson = text.parse().unwrap();
            parsed.try_into().unwrap()
        };
        let city: Value = serde_json::from_slice(&files["model.city.json"]).unwrap();
        let mut surfaces = Vec::new();
        for object in city["CityObjects"].as_object().unwrap().values() {
            let all = object["geometry"][0]["semantics"]["surfaces"]
                .as_array()
                .unwrap();
            surfaces.extend(all.iter().filter(|s| s["type"] == "RoofSurface"));
            assert!(object["attributes"]["volumeSigma"].as_f64().unwrap() > 0.0);
        }
        let facets = rows(&files["facets.csv"]);
        let features = parse("facets.geojson").features;
        assert_eq!(facets.len(), features.len(), "{name}");
        for (row, feature) in facets.iter().zip(&features) {
            let surface = surfaces
                .iter()
                .find(|s| s["facet"].as_u64() == row["facet"].parse().ok());
            let surface = surface.unwrap();
            let of_map = |name: &str| feature.property(name).unwrap().clone();
            for (of_table, of_city) in [
                ("area_m2", "area"),
                ("area_sigma_m2", "areaSigma"),
                ("plan_area_m2", "planArea"),
                ("slope_deg", "slopeDeg"),
                ("highest_m", "highestHeight"),
            ] {
                let found = number(row, of_table);
                for other in [&of_map(of_table), &surface[of_city]] {
                    let other = other.as_f64().unwrap();
                    assert!(
                        (found - other).abs() < 2e-3,
                        "{name}: {of_table} {found} {other}"
                    );
                }
            }
            assert_eq!(surface["photographs"].as_array().unwrap().len(), 2);
            // Rings are closed, the outer one counter-clockwise.
            let Some(geojson::GeometryValue::Polygon { coordinates }) =
                feature.geometry.as_ref().map(|g| &g.value)
            else {
                panic!("{name}: no polygon");
            };
            assert_eq!(coordinates[0].first(), coordinates[0].last());
        }
        let edges = rows(&files["edges.csv"]);
        let features = parse("edges.geojson").features;
        assert_eq!(edges.len(), features.len());
        for (row, feature) in edges.iter().zip(&features) {
            assert_eq!(feature.property("kind").unwrap(), row["kind"].as_str());
        }
    }
}

#[test]
fn the_page_is_well_formed_needs_nothing_else_and_names_what_there_is() {
    for (name, model, _) in known_models() {
        let files = files_of(&scene(), &model);
        let page = std::str::from_utf8(&files["roof_report.html"]).unwrap();
        for other in ["src=", "href=", "url(", "@import", "<script"] {
            assert!(!page.contains(other), "{name}: {other}");
        }
        // It is XML but for two heads, so that every element is closed.
        let body = &page[page.find("<body>").unwrap()..page.find("</html>").unwrap()];
        let parsed = roxmltree::Document::parse(body).unwrap();
        let count = |tag: &str| parsed.descendants().filter(|n| n.has_tag_name(tag)).count();
        assert_eq!(count("section"), model.buildings.len() + 1);
        for facet in 1..=model.facets.len() {
            let number = facet.to_string();
            let is_number = |n: &roxmltree::Node| {
                n.attribute("class") == Some("number") && n.text() == Some(&number)
            };
            assert!(
                parsed.descendants().any(|n| is_number(&n)),
                "{name}: {facet}"
            );
        }
        assert!(page.contains(" ± ") && page.contains("a.jpg"));
        assert!(!page.contains("NaN") && !page.contains("inf"));
    }
}

#[test]
fn names_cannot_break_the_page_or_a_table() {
    let (_, model, _) = known_models().remove(0);
    let mut scene = scene();
    scene.views[0].name = "a, \"b\" <c>.jpg".into();
    let files = files_of(&scene, &model);
    let page = std::str::from_utf8(&files["roof_report.html"]).unwrap();
    assert!(page.contains("a, &quot;b&quot; &lt;c&gt;.jpg"));
    let facets = rows(&files["facets.csv"]);
    assert_eq!(facets[0]["photographs"], "a, \"b\" <c>.jpg; b.jpg");
}

#[test]
fn a_file_that_is_no_model_is_refused_with_the_reason() {
    let (_, model, _) = known_models().remove(0);
    let good: Value =
        serde_json::from_slice(&files_of(&scene(), &model)["model.city.json"]).unwrap();
    let damaged = |damage: &dyn Fn(&mut Value)| {
        let mut file = good.clone();
        damage(&mut file);
        ReportedModel::read(&serde_json::to_vec(&file).unwrap())
    };
    assert!(damaged(&|_| {}).is_ok());
    for (damage, reason) in [
        (
            (&|f: &mut Value| f["type"] = "FeatureCollection".into()) as &dyn Fn(&mut Value),
            "is no CityJSON",
        ),
        (&|f| f["transform"] = Value::Null, "\"scale\""),
        (
            &|f| f["transform"]["translate"][1] = "x".into(),
            "\"translate\"",
        ),
        (&|f| f["vertices"] = Value::Null, "\"vertices\""),
        (&|f| f["vertices"][2] = 7.into(), "vertex 2"),
        (&|f| f["CityObjects"] = Value::Null, "\"CityObjects\""),
        (
            &|f| f["CityObjects"]["building-1"]["geometry"] = Value::Null,
            "RoofSurface",
        ),
        (
            &|f| f["CityObjects"]["building-1"]["geometry"][0]["boundaries"] = 3.into(),
            "building-1: its Solid has no shell",
        ),
        (
            &|f| {
                f["CityObjects"]["building-1"]["geometry"][0]["boundaries"][0][1][0][0] =
                    99999.into()
            },
            "building-1: face 1",
        ),
        (
            &|f| {
                f["CityObjects"]["building-1"]["geometry"][0]["boundaries"][0][0] =
                    serde_json::json!([])
            },
            "face 0: no ring",
        ),
    ] {
        let found = damaged(damage).unwrap_err();
        assert!(found.contains(reason), "{found} instead of {reason}");
    }
    assert!(ReportedModel::read(b"{").unwrap_err().contains("no JSON"));
    // What others leave out is not needed.
    let bare = damaged(&|f| {
        f["CityObjects"]["building-1"]["attributes"] = Value::Null;
        let surfaces = &mut f["CityObjects"]["building-1"]["geometry"][0]["semantics"]["surfaces"];
        for surface in surfaces.as_array_mut().unwrap() {
            let kind = surface["type"].clone();
            *surface = serde_json::json!({ "type": kind });
        }
    });
    let bare: BTreeMap<_, _> = bare.unwrap().files(&[]).into_iter().collect();
    let facet = &rows(&bare["facets.csv"])[0];
    assert_eq!(
        (&facet["area_sigma_m2"][..], &facet["photographs"][..]),
        ("", "")
    );
}

#[test]
fn a_model_without_buildings_has_a_page_that_says_so() {
    let files = files_of(&scene(), &RoofModel::default());
    let page = std::str::from_utf8(&files["roof_report.html"]).unwrap();
    assert!(page.contains("No building was found"));
    assert_eq!(rows(&files["facets.csv"]).len(), 0);
}
