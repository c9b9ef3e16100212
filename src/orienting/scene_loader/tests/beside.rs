//! What lies beside the photographs as programs leave it: used for what it is, or left out and
//! said.

use super::*;

/// Well-known text of a plane.
fn wkt(code: u32) -> Vec<u8> {
    format!("PROJCS[\"x\",AUTHORITY[\"EPSG\",\"{code}\"]]").into_bytes()
}

fn with(more: &[(&str, &[u8])]) -> Vec<InputFile> {
    let mut files = gable_files();
    files.extend(
        more.iter()
            .map(|(path, bytes)| InputFile::new(path, bytes.to_vec())),
    );
    files
}

/// Level ground of the gable house.
fn grid() -> Vec<u8> {
    let header = "ncols 80\nnrows 80\nxllcorner -40\nyllcorner -40\ncellsize 1\n";
    format!("{header}{}", "0.25 ".repeat(6400)).into_bytes()
}

/// Footprints of these halves of squares around the origin.
fn squares(halves: &[f64], crs: &str) -> Vec<u8> {
    let ring = |h: &f64| {
        format!(
            "[[[{0},{0}],[{1},{0}],[{1},{1}],[{0},{1}],[{0},{0}]]]",
            -h, h
        )
    };
    let all: Vec<String> = halves.iter().map(ring).collect();
    let polygons = all.join(",");
    format!("{{\"type\":\"MultiPolygon\",{crs}\"coordinates\":[{polygons}]}}").into_bytes()
}

#[test]
fn a_prj_belongs_to_the_file_of_its_name() {
    let grid = grid();
    let (a, b, none) = (wkt(25832), wkt(31467), Vec::new());
    for (more, expected) in [
        (vec![("site.prj", &a)], Some(25832)),
        (
            vec![("colmap/images.prj", &a), ("site.prj", &b)],
            Some(25832),
        ),
        (vec![("dgm.prj", &a), ("dgm.asc", &grid)], None),
        (
            vec![
                ("houses.prj", &b),
                ("houses.shp", &none),
                ("houses.dbf", &none),
            ],
            None,
        ),
        (vec![("Houses.prj", &b), ("houses.SHP", &none)], None),
        (vec![("ortho.prj", &b), ("ortho.jgw", &none)], None),
        (vec![("cloud.prj", &b), ("cloud.e57", &none)], None),
        (
            vec![
                ("gis/houses.prj", &b),
                ("gis/houses.shp", &none),
                ("site.prj", &a),
            ],
            Some(25832),
        ),
        (
            vec![("site.prj", &a), ("other/site.shp", &none)],
            Some(25832),
        ),
        (vec![("a.prj", &a), ("b.prj", &b)], None),
        (vec![("a.prj", &a), ("b.prj", &wkt(5555))], Some(25832)),
    ] {
        let more: Vec<(&str, &[u8])> = more.iter().map(|(p, b)| (*p, &b[..])).collect();
        let scene = load_scene(&with(&more), &all()).unwrap();
        let paths: Vec<&str> = more.iter().map(|(path, _)| *path).collect();
        assert_eq!(scene.survey.epsg, expected, "{paths:?}");
        let said = scene
            .warnings
            .iter()
            .any(|warning| warning.contains("--crs"));
        assert_eq!(said, expected.is_none(), "{paths:?}: {:?}", scene.warnings);
    }
}

#[test]
fn what_lies_there_by_chance_refuses_nothing() {
    let far = squares(&[5.0], "");
    let elsewhere = String::from_utf8(squares(&[5.0], ""))
        .unwrap()
        .replace("-5", "432005")
        .replace("[5", "[432015")
        .replace(",5", ",432015");
    for (path, bytes, words) in [
        ("odm_dem/dsm.tif", grid(), "surface model"),
        ("pix4d/site_dsm.asc", grid(), "surface model"),
        ("DOM.asc", grid(), "surface model"),
        ("dgm.asc", b"ncols 3\nnrows 9\n".to_vec(), "no cellsize"),
        (
            "dgm.asc",
            b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3".to_vec(),
            "after 3 of 4",
        ),
        ("cloud.laz", b"LASF....".to_vec(), "ends within its header"),
        ("houses.geojson", far, "longitude and latitude"),
        (
            "bounds.geojson",
            elsewhere.into_bytes(),
            "lies where the photographs do",
        ),
        (
            "boundary.geojson",
            squares(&[60.0], "\"crs\":null,"),
            "survey area",
        ),
        (
            "houses.geojson",
            b"{\"type\":\"Polygon\",\"coordinates\":[".to_vec(),
            "no JSON",
        ),
    ] {
        let scene = load_scene(&with(&[(path, &bytes)]), &all());
        let scene = scene.unwrap_or_else(|e| panic!("{path}: {e}"));
        let is_said = |w: &String| {
            w.contains("left out") && w.contains(path) && w.contains(words)
                || w.contains("as terrain it is not used")
        };
        assert!(
            scene.warnings.iter().any(is_said),
            "{path}: {:?}",
            scene.warnings
        );
        let known = &scene.known;
        assert!(
            known.terrain.is_none() && known.footprints.is_none(),
            "{path}"
        );
        // What an option names is refused.
        let options = match path.ends_with("json") {
            true => LoadOptions {
                footprints: Some(path.to_owned()),
                ..all()
            },
            false => LoadOptions {
                terrain: Some(path.to_owned()),
                ..all()
            },
        };
        if !["surface model", "lies where the photographs do"].contains(&words) {
            refused(&with(&[(path, &bytes)]), &options, &[words]);
        }
    }
    // The model of the ground beside that of the surface is the one that is used.
    let both = with(&[("odm_dem/dsm.asc", &grid()), ("odm_dem/dtm.asc", &grid())]);
    let scene = load_scene(&both, &all()).unwrap();
    assert_eq!(scene.known.terrain.unwrap().file, "odm_dem/dtm.asc");
}

#[test]
fn a_survey_area_beside_houses_leaves_the_houses() {
    let both = squares(&[60.0, 1.0], "\"crs\":null,");
    let scene = load_scene(&with(&[("a.geojson", &both)]), &all()).unwrap();
    assert_eq!(scene.known.footprints.unwrap().footprints.len(), 1);
    assert!(
        scene
            .warnings
            .iter()
            .any(|warning| warning.contains("survey area"))
    );
}

#[test]
fn a_scene_in_feet_becomes_metres_in_the_same_plane() {
    let (scene, truth) = gable_scene(48);
    for (code, metric, unit_m) in [
        (2263, Some(32118), 1200.0 / 3937.0),
        (2229, Some(26945), 1200.0 / 3937.0),
        (6539, Some(32118), 1200.0 / 3937.0),
        (2868, Some(26949), 0.3048),
        (25832, Some(25832), 1.0),
        (5555, Some(5555), 1.0),
    ] {
        let mut feet = scene.clone();
        for view in &mut feet.views {
            view.camera.center = (view.camera.center.coords / unit_m).into();
        }
        feet.origin = nalgebra::Vector3::new(984_000.0, 200_000.0, 0.0);
        let options = LoadOptions {
            epsg: Some(code),
            ..all()
        };
        let found = load_scene(&inputs(to_files(&feet)), &options);
        let found = found.unwrap_or_else(|e| panic!("{code}: {e}"));
        assert_eq!(found.survey.epsg, metric, "{code}");
        let is_said = found
            .warnings
            .iter()
            .any(|warning| warning.contains("feet"));
        assert_eq!(is_said, unit_m < 1.0, "{code}: {:?}", found.warnings);
        let places = feet.origin * unit_m - found.origin;
        for (view, planted) in found.views.iter().zip(&scene.views) {
            let off = view.camera.center - planted.camera.center - places;
            assert!(off.norm() < 1e-6, "{code}: {off}");
        }
    }
    assert!(!truth.facets.is_empty());
    // No other code has the plane in metres: refused by the name of the unit.
    let options = LoadOptions {
        epsg: Some(2314),
        ..all()
    };
    refused(
        &gable_files(),
        &options,
        &["EPSG:2314", "no other code has the same plane in metres"],
    );
    // Feet without a code are never called metres.
    let feet =
        b"PROJCS[\"x\",GEOGCS[\"y\"],PROJECTION[\"Lambert\"],UNIT[\"Foot_US\",0.3048006096012192]]";
    refused(
        &with(&[("site.prj", feet)]),
        &all(),
        &["site.prj", "US survey feet", "--crs"],
    );
}

#[test]
fn longitude_and_latitude_that_are_stated_are_no_metres() {
    let options = LoadOptions {
        epsg: Some(4326),
        ..all()
    };
    let far = Scene {
        origin: nalgebra::Vector3::new(432_000.0, 5_412_000.0, 0.0),
        ..gable_scene(48).0
    };
    refused(
        &inputs(to_files(&far)),
        &options,
        &["EPSG:4326", "longitude and latitude"],
    );
}

#[test]
fn the_place_that_orient_finds_is_read_beside_its_model() {
    let report = |anchor: &str, epsg: &str, is_metric: bool| {
        format!(
            "{{\"frame\":\"x\",\"anchor\":{anchor},\"epsg\":{epsg},\"offset\":[0,0,0],\
             \"is_metric\":{is_metric},\"rays_a_point\":3.1,\"left_out\":[]}}"
        )
    };
    let place = "{\"lon_deg\":8.4,\"lat_deg\":49.0,\"height_m\":0.0}";
    for (text, lon, epsg) in [
        (report(place, "null", true), Some(8.4), None),
        (report("null", "25832", true), None, Some(25832)),
        (report("null", "null", true), None, None),
        (report("null", "null", false), None, None),
    ] {
        let scene = load_scene(
            &with(&[("colmap/orientation.json", text.as_bytes())]),
            &all(),
        );
        let survey = scene.unwrap().survey;
        assert_eq!(survey.anchor.map(|anchor| anchor.lon_deg), lon, "{text}");
        assert_eq!(survey.epsg, epsg, "{text}");
    }
    // One of another folder is of another model.
    let text = report(place, "null", true);
    let scene = load_scene(&with(&[("b/orientation.json", text.as_bytes())]), &all()).unwrap();
    assert_eq!(scene.survey.anchor, None);
}

#[test]
fn copies_of_data_sets_lose_against_the_folder_images() {
    for copies in ["input", "images_2", "images_8"] {
        let mut files = gable_files();
        let twins: Vec<InputFile> = (files.iter())
            .filter(|file| file.path.starts_with("images/"))
            .map(|file| InputFile::new(&file.path.replace("images", copies), file.bytes.clone()))
            .collect();
        let count = twins.len();
        files.extend(twins);
        let scene = load_scene(&files, &all()).unwrap_or_else(|e| panic!("{copies}: {e}"));
        assert_eq!(scene.views.len(), count);
        assert!(
            scene
                .warnings
                .iter()
                .any(|w| w.contains(&format!("{copies}/"))),
            "{copies}"
        );
    }
}
