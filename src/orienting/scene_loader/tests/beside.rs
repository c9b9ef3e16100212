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
    // A .prj that states another unit of heights than of the plan.
    let (us, metre) = ("UNIT[\"Foot_US\",0.3048006096012192]", "UNIT[\"metre\",1]");
    for (code, heights, plan_m, height_m) in [
        (2263, us, 1200.0 / 3937.0, 1200.0 / 3937.0),
        (2263, metre, 1200.0 / 3937.0, 1.0),
        (32118, us, 1.0, 1200.0 / 3937.0),
        (32118, metre, 1.0, 1.0),
    ] {
        let mut feet = scene.clone();
        for view in &mut feet.views {
            let [x, y, z] = view.camera.center.into();
            view.camera.center = [x / plan_m, y / plan_m, z / height_m].into();
        }
        let wkt = format!(
            "COMPD_CS[\"c\",PROJCS[\"p\",{},AUTHORITY[\"EPSG\",\"{code}\"]],VERT_CS[\"v\",{heights}]]",
            if plan_m < 1.0 { us } else { metre }
        );
        let mut files = inputs(to_files(&feet));
        files.push(InputFile::new("site.prj", wkt.into_bytes()));
        let found = load_scene(&files, &all()).unwrap_or_else(|e| panic!("{code} {heights}: {e}"));
        assert_eq!(found.survey.epsg, Some(32118), "{heights}");
        for (view, planted) in found.views.iter().zip(&scene.views) {
            let off = view.camera.center - planted.camera.center;
            assert!(off.norm() < 1e-6, "{code} {heights}: {off}");
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
    let sigma = "{\"frame_sigma\":{\"length_of_10_m\":0.03,\"height_over_10_m\":null},";
    let worth = report("null", "null", true).replacen('{', sigma, 1);
    let found = with(&[("colmap/orientation.json", worth.as_bytes())]);
    let sigma = load_scene(&found, &all()).unwrap().survey.frame_sigma;
    let sigma = sigma.map(|s| (s.length_of_10_m, s.height_over_10_m));
    assert_eq!(sigma, Some((Some(0.03), None)));
    // Footprints with latitude before longitude lie there when these are exchanged.
    let [low, high] = [-4e-5, 4e-5].map(|by| format!("[{},{}]", 49.0 + by, 8.4 + by));
    let houses = format!(
        "{{\"type\":\"Polygon\",\"coordinates\":[[{low},[49.00004,8.39996],{high},{low}]]}}"
    );
    let text = report(place, "null", true);
    let files = with(&[
        ("colmap/orientation.json", text.as_bytes()),
        ("houses.geojson", houses.as_bytes()),
    ]);
    let words = "latitude before longitude";
    let scene = load_scene(&files, &all()).unwrap();
    let is_said = scene.warnings.iter().any(|said| said.contains(words));
    assert!(is_said && scene.known.footprints.is_none());
    let options = LoadOptions {
        footprints: Some("houses.geojson".to_owned()),
        ..all()
    };
    refused(&files, &options, &[words, "exchange them"]);
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

/// The images of the gable house in one folder, its orientation in another.
fn laid_out(images: &str, model: &str) -> Vec<InputFile> {
    let files = gable_files().into_iter();
    let path = |file: &InputFile| match file.path.split_once('/') {
        Some(("images", name)) => format!("{images}{name}"),
        Some((_, name)) => format!("{model}{name}"),
        None => file.path.clone(),
    };
    files
        .map(|file| InputFile::new(&path(&file), file.bytes))
        .collect()
}

#[test]
fn folders_as_programs_leave_them_give_the_scene() {
    let image = gable_files().remove(0).bytes;
    let grid = grid();
    let wkt = wkt(25832);
    let area = squares(&[60.0], "");
    let (png, asc, prj, outline) = (&image[..], &grid[..], &wkt[..], &area[..]);
    let json: &[u8] = b"{\"transform\": [[1, 0, 0, 0]], \"scale\": 0.1}";
    let list: &[u8] = b"[{\"id\": 0, \"img_name\": \"s1_01\", \"width\": 48, \"height\": 48, \
        \"position\": [0, 0, 1], \"rotation\": [[1, 0, 0]], \"fy\": 40, \"fx\": 40}]";
    let exif: &[u8] =
        b"{\"make\": \"DJI\", \"width\": 48, \"height\": 48, \"projection_type\": \"brown\"}";
    let models: &[u8] =
        b"{\"v2 dji\": {\"projection_type\": \"brown\", \"width\": 48, \"height\": 48}}";
    let csv: &[u8] = b"label,x,y,z\nm1,1.0,2.0,3.0\nm2,2.0,2.0,3.0\n";
    let gcp: &[u8] = b"EPSG:25832\n1 2 3 4 5 s1_01.png g1\n";
    let coords: &[u8] = b"WGS84 UTM 32N\n432100 5412300\n1.5 2.5 100.0\n2.5 2.5 100.0\n";
    let tfw: &[u8] = b"0.05\n0\n0\n-0.05\n432000\n5412000\n";
    let ply: &[u8] = b"ply\nformat binary_little_endian 1.0\nelement vertex 0\nend_header\n";
    let xml: &[u8] = b"<?xml version=\"1.0\"?><report><images>6</images></report>";
    let depth: &[u8] = b"48&48&1&\0\0\0\0\xff\xff\x80\x3f";
    type Layout<'a> = (&'a str, &'a str, Vec<(&'a str, &'a [u8])>);
    let layouts: Vec<Layout> = vec![
        // OpenDroneMap 2 and 3, and WebODM's all.zip.
        (
            "images/",
            "opensfm/",
            vec![
                ("cameras.json", models),
                (
                    "images.json",
                    b"[{\"filename\": \"s1_01.png\", \"gps_dop\": 10}]",
                ),
                ("log.json", b"{\"stages\": []}"),
                ("benchmark.txt", b"Dataset runtime: 12.0 seconds\n"),
                (
                    "odm_texturing/odm_textured_model_geo_material0000_map_Kd.png",
                    png,
                ),
                ("odm_orthophoto/odm_orthophoto.png", png),
                ("odm_dem/dsm.asc", asc),
                ("odm_georeferencing/coords.txt", coords),
                (
                    "odm_georeferencing/proj.txt",
                    b"+proj=utm +zone=32 +datum=WGS84 +units=m\n",
                ),
                (
                    "odm_georeferencing/odm_georeferenced_model.bounds.geojson",
                    outline,
                ),
                (
                    "odm_georeferencing/ground_control_points.geojson",
                    b"{\"type\": \"FeatureCollection\", \"features\": []}",
                ),
                ("opensfm/exif/s1_01.png.exif", exif),
                ("opensfm/camera_models.json", models),
                (
                    "opensfm/tracks.csv",
                    b"OPENSFM_TRACKS_VERSION_v2\ns1_01.png\t0\t1\t0.1\t0.2\t0.001\t1\t2\t3\n",
                ),
            ],
        ),
        (
            "all/odm/images/",
            "all/odm/opensfm/",
            vec![
                ("all/odm/opensfm/undistorted/images/s1_01.png", png),
                ("all/odm/gcp_list.txt", gcp),
                ("all/odm/odm_report/stats.json", json),
            ],
        ),
        // Pix4D.
        (
            "flight/",
            "1_initial/params/",
            vec![
                ("1_initial/report/p_report.xml", xml),
                ("1_initial/params/p_wkt.prj", prj),
                ("3_dsm_ortho/1_dsm/p_dsm.asc", asc),
                ("3_dsm_ortho/1_dsm/p_dsm.prj", prj),
                ("3_dsm_ortho/2_mosaic/p_transparent_mosaic.png", png),
                ("3_dsm_ortho/2_mosaic/p_transparent_mosaic.tfw", tfw),
                ("p.p4d", xml),
            ],
        ),
        // Metashape.
        (
            "photos/",
            "export/",
            vec![
                ("project.psx", xml),
                ("project.files/0/chunk.xml", xml),
                ("export/markers.csv", csv),
                ("export/model_texture.png", png),
                ("export/orthomosaic.png", png),
                ("export/orthomosaic.tfw", tfw),
                ("export/dem_DSM.asc", asc),
            ],
        ),
        // COLMAP.
        (
            "images/",
            "sparse/0/",
            vec![
                ("project.ini", b"log_to_stderr=false\n"),
                ("database.db", b"SQLite format 3\0"),
            ],
        ),
        (
            "dense/images/",
            "dense/sparse/",
            vec![
                ("dense/stereo/depth_maps/s1_01.png.geometric.bin", depth),
                ("dense/stereo/patch-match.cfg", b"s1_01.png\n__auto__, 20\n"),
                ("dense/fused.ply", ply),
            ],
        ),
        // 3D Gaussian splatting and nerfstudio.
        (
            "images/",
            "sparse/0/",
            vec![
                ("cameras.json", list),
                ("cfg_args", b"Namespace(data_device='cuda')"),
                ("point_cloud/iteration_30000/point_cloud.ply", ply),
                ("train/ours_30000/renders/00000.png", png),
                ("train/ours_30000/gt/00000.png", png),
                ("input/s1_01.png", png),
            ],
        ),
        (
            "images/",
            "colmap/sparse/0/",
            vec![
                ("images_2/s1_01.png", png),
                ("depths/s1_01.png", png),
                ("masks/s1_01.png", png),
                ("outputs/nerfacto/dataparser_transforms.json", json),
                ("sparse_pc.ply", ply),
            ],
        ),
        // A folder of an office.
        (
            "DCIM/100MEDIA/",
            "Orientierung/",
            vec![
                ("DCIM/100MEDIA/_MACOSX.txt", b"x"),
                ("Thumbs.db", b"\xd0\xcf\x11\xe0"),
                ("Bericht.pdf", b"%PDF-1.4"),
                ("Passpunkte.csv", csv),
                ("geo.txt", b"EPSG:25832\ns1_01.png 1 2 3\n"),
                ("Gebiet.kml", xml),
                ("Lage.jgw", tfw),
            ],
        ),
        (
            "",
            "",
            vec![
                ("readme.txt", b"flown in May"),
                ("boundary.geojson", outline),
            ],
        ),
    ];
    let count = gable_scene(48).0.views.len();
    for (images, model, more) in layouts {
        let mut files = laid_out(images, model);
        files.extend(
            more.iter()
                .map(|(path, bytes)| InputFile::new(path, bytes.to_vec())),
        );
        let scene = load_scene(&files, &all()).unwrap_or_else(|e| panic!("{images} {model}: {e}"));
        let names: Vec<&String> = scene.views.iter().map(|view| &view.name).collect();
        assert_eq!(names.len(), count, "{images} {model}: {names:?}");
        let known = &scene.known;
        let is_unused = known.terrain.is_none() && known.footprints.is_none();
        assert!(is_unused, "{images} {model}: {:?}", scene.warnings);
        assert_eq!(scene.survey.anchor, None, "{images} {model}");
    }
}
