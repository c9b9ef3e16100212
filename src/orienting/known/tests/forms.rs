//! Units, systems, holes and forms of what is known, as programs write them.

use super::*;

/// What is known is read by what its coordinates are: `code` is written into the file.
fn in_code(code: &str) -> [String; 2] {
    let metres = planted_polygon(|p| p);
    let named = CRS.replace("urn:ogc:def:crs:EPSG::25832", code);
    let city = format!(r#""referenceSystem":"{code}""#);
    [feature("Polygon", &metres, &named), city_json("", &city)]
}

#[test]
fn names_of_one_plane_are_one_system() {
    let utm = |epsg| WorldSystem {
        epsg: Some(epsg),
        anchor: None,
    };
    for (code, own) in [
        ("EPSG:5555", 25832),
        ("https://www.opengis.net/def/crs/EPSG/0/5555", 25832),
        ("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837", 25832),
        ("urn:ogc:def:crs:EPSG:9.9.1:25832", 25832),
        ("http://www.opengis.net/gml/srs/epsg.xml#25832", 25832),
        (
            "https://www.opengis.net/def/crs-compound?1=http://www.opengis.net/def/crs/EPSG/0/25832\
             &2=http://www.opengis.net/def/crs/EPSG/0/7837",
            25832,
        ),
        ("EPSG:25832+5783", 32632),
        ("EPSG:7415", 28992),
        ("EPSG:28992", 7415),
        ("EPSG:5698", 2154),
        ("EPSG:7405", 27700),
        ("EPSG:6343", 26914),
        ("EPSG:7855", 28355),
        ("EPSG:31983", 32723),
        ("EPSG:5845", 3006),
    ] {
        for json in in_code(code) {
            let found = register(&json, &utm(own));
            assert!(found.is_ok(), "{code} in {own}: {found:?}");
        }
    }
    for (code, own) in [
        ("EPSG:31467", 25832),
        ("EPSG:25833", 28992),
        ("EPSG:2056", 21781),
        ("EPSG:28992", 31370),
        ("EPSG:5514", 5513),
    ] {
        for json in in_code(code) {
            let refused = register(&json, &utm(own)).unwrap_err().to_string();
            assert!(refused.contains(code), "{refused}");
        }
    }
}

#[test]
fn footprints_one_a_line_and_in_old_forms_are_read() {
    let metres = planted_polygon(|p| p);
    let of = |crs: &str| feature("Polygon", &metres, crs).replace('\n', "");
    let line = |json: &str| {
        let feature = json.split_once("\"features\":[").unwrap().1;
        feature.strip_suffix("]}").unwrap().to_owned()
    };
    let bare = line(&of(""));
    let with_crs = bare.replacen('{', &format!("{{{CRS}"), 1);
    let city = city_json("", "").replace('\n', "");
    let (head, objects) = city.split_once("\"CityObjects\":").unwrap();
    let head = format!("{head}\"CityObjects\":{{}},\"vertices\":[]}}");
    let part = |name: &str| {
        format!("{{\"type\":\"CityJSONFeature\",\"CityObjects\":{objects}").replace("b7", name)
    };
    for (text, houses) in [
        (format!("{bare}\n{bare}\n"), 2),
        (format!("\u{1e}{with_crs}\r\n\u{1e}{with_crs}\r\n"), 2),
        (format!("\u{feff}{bare}\n\n{bare}"), 2),
        (format!("{head}\n{}\n{}\n", part("b7"), part("b8")), 2),
        (city.clone(), 1),
        (
            of(r#""crs":{"type":"EPSG","properties":{"code":25832}},"#),
            1,
        ),
        (
            of(r#""crs":{"type":"name","properties":{"name":"EPSG:25832"}},"#),
            1,
        ),
        (of(r#""crs":"EPSG:25832","#), 1),
        // No longitude and latitude: those of the orientation.
        (of(""), 1),
    ] {
        let (found, _) = register(&text, &UTM).unwrap_or_else(|e| panic!("{e}: {text}"));
        assert_eq!(found.footprints.len(), houses, "{text}");
        for footprint in &found.footprints {
            let depth = footprint.outline.depth(&Point2::new(0.0, 3.0));
            assert!((depth - 2.0).abs() < 1e-6, "{text}");
        }
    }
    let damaged = format!("{bare}\n{{\"type\": \n");
    let refused = register(&damaged, &UTM).unwrap_err().to_string();
    assert!(refused.contains("line 2"), "{refused}");
}

#[test]
fn a_building_that_its_parts_draw_counts_once() {
    let part = r#""b7":{"type":"Building","children":["p"],"geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]}]},"p":{"type":"BuildingPart","#;
    let json = city_json("", "").replace(r#""b7":{"type":"Building","#, part);
    assert_eq!(register(&json, &UTM).unwrap().0.footprints.len(), 1);
    let alone = json.replace("BuildingPart", "BuildingInstallation");
    let names: Vec<String> = (register(&alone, &UTM).unwrap().0.footprints.into_iter())
        .map(|footprint| footprint.name)
        .collect();
    assert!(names.contains(&"b7".to_owned()), "{names:?}");
}

#[test]
fn a_survey_area_is_no_building() {
    let places: Vec<Point2<f64>> = (0..100)
        .map(|k| Point2::new(f64::from(k % 10) - 4.5, f64::from(k / 10) - 4.5))
        .collect();
    let around = |half: f64| {
        let corner =
            |x: f64, y: f64| format!("[{},{}]", ORIGIN[0] + x * half, ORIGIN[1] + y * half);
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let ring = corners.map(|(x, y)| corner(x, y)).join(",");
        format!("[[{ring}]]")
    };
    let of = |polygons: String| {
        register(&feature("MultiPolygon", &polygons, CRS), &UTM)
            .unwrap()
            .0
    };
    let alone = of(format!("[{}]", around(30.0)));
    let refused = alone
        .without_areas(&places, 100.0, &mut Vec::new())
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains("survey area") && refused.contains("3600 m2"),
        "{refused}"
    );
    let both = of(format!("[{},{}]", around(30.0), around(3.0)));
    let mut said = Vec::new();
    let left = both.without_areas(&places, 100.0, &mut said).unwrap();
    assert_eq!((left.footprints.len(), said.len()), (1, 1));
    let houses = of(format!("[{},{}]", around(2.0), around(3.0)));
    assert_eq!(
        houses
            .without_areas(&places, 100.0, &mut Vec::new())
            .unwrap()
            .footprints
            .len(),
        2
    );
}

/// Tags of a band as GDAL writes them.
pub(super) fn band(items: &[(&str, &str)]) -> Tag {
    let item = |(role, text): &(&str, &str)| {
        format!("<Item name=\"{role}\" sample=\"0\" role=\"{role}\">{text}</Item>")
    };
    let items: String = items.iter().map(item).collect();
    let text = format!("<GDALMetadata>{items}</GDALMetadata>\n\0");
    (42112, 2, text.len() as u32, text.into_bytes())
}

/// The planted raster with heights in this unit less `offset`, and these keys and tags.
pub(super) fn raster_in(unit_m: f64, offset: f64, keys: &[[u16; 2]], more: Vec<Tag>) -> InputFile {
    let place = placed(false).into_iter().take(2);
    let mut tiff = PlantedTiff::strip(place.chain([geo_keys(keys)]).chain(more).collect());
    let stored = |z: &f32| (((f64::from(*z) - offset) / unit_m) as f32).to_le_bytes();
    tiff.chunks = vec![heights().iter().flat_map(stored).collect()];
    tiff.file()
}

#[test]
fn the_unit_of_heights_is_read_where_a_raster_states_it() {
    let us = 1200.0 / 3937.0;
    let utm = [3072, 25832];
    let unit = |name| vec![band(&[("unittype", name)])];
    for (unit_m, offset, keys, more) in [
        (us, 0.0, vec![utm], unit("US survey foot")),
        (us, 0.0, vec![utm], unit("ftUS")),
        (0.3048, 0.0, vec![utm], unit("foot")),
        (0.3048, 0.0, vec![utm], unit("ft")),
        (1.0, 0.0, vec![utm], unit("metre")),
        (us, 0.0, vec![utm, [4096, 6360]], Vec::new()),
        (0.3048, 0.0, vec![utm, [4096, 8228]], Vec::new()),
        (us, 0.0, vec![utm, [4099, 9003]], Vec::new()),
        (us, 0.0, vec![utm, [4096, 5703], [4099, 9003]], Vec::new()),
        (1.0, 0.0, vec![utm, [4096, 5783], [4099, 9001]], Vec::new()),
        (
            0.1,
            100.0,
            vec![utm],
            vec![band(&[("scale", "0.1"), ("offset", "100")])],
        ),
        (0.01, 0.0, vec![utm], vec![band(&[("scale", "0.01")])]),
    ] {
        let file = raster_in(unit_m, offset, &keys, more);
        let found = terrain(&file, &UTM).unwrap_or_else(|e| panic!("{keys:?}: {e}"));
        let miss = found.z_at(3.7, -4.2).unwrap() - ground(3.7, -4.2);
        assert!(miss.abs() < 1e-3, "{unit_m} {keys:?}: {miss} m");
    }
    for (keys, more, words) in [
        (vec![utm], unit("fathom"), "fathom"),
        (vec![utm, [4099, 9014]], Vec::new(), "EPSG:9014"),
        (vec![utm, [3076, 9035]], Vec::new(), "EPSG:9035"),
        (vec![utm], vec![band(&[("scale", "x")])], "no number"),
    ] {
        let refused = terrain(&raster_in(1.0, 0.0, &keys, more), &UTM)
            .unwrap_err()
            .to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

#[test]
fn terrain_in_other_systems_of_one_datum_is_followed() {
    let grid = crate::orienting::orientation::TransverseMercator::of_epsg(25832).unwrap();
    let [lon, lat] = grid.geographic(ORIGIN[0], ORIGIN[1]);
    let place = WorldSystem {
        epsg: None,
        anchor: Some(Anchor {
            lon_deg: lon,
            lat_deg: lat,
            height_m: 0.0,
        }),
    };
    // Metres of the grid around a place on the Earth, whose frame is not turned by more than the
    // convergence of meridians (0.7 degrees) against it.
    let found = terrain(&ascii(CORNER), &UNKNOWN).unwrap();
    let tiff = PlantedTiff::strip(placed(false)).file();
    let there = Terrain::read(&tiff, None, &place, Vector3::new(0.0, 0.0, 100.0), 0.3).unwrap();
    let miss = there.z_at(0.0, 0.0).unwrap() - found.z_at(0.0, 0.0).unwrap();
    assert!(miss.abs() < 1e-3, "{miss}");
    let turned = there.z_at(10.0, 0.0).unwrap() - ground(10.0, 0.0);
    assert!(turned.abs() < 0.05, "{turned}");
    // The .prj beside an ASCII grid states its system.
    let wrong = Terrain::read(
        &ascii(CORNER),
        Some("EPSG:31467"),
        &UTM,
        Vector3::zeros(),
        0.3,
    );
    assert!(wrong.unwrap_err().to_string().contains("EPSG:31467"));
    let same = Terrain::read(
        &ascii(CORNER),
        Some("EPSG:5555"),
        &UTM,
        Vector3::from(ORIGIN),
        0.3,
    );
    check_planted(&same.unwrap());
    // Feet in plan and in height.
    let us = 1200.0 / 3937.0;
    let feet = |v: f64| v / us;
    let header = format!(
        "ncols 20\nnrows 15\nxllcorner {}\nyllcorner {}\ncellsize {}",
        feet(432_080.0),
        feet(5_412_285.0),
        feet(2.0)
    );
    let rows: String = heights()
        .iter()
        .map(|z| format!("{} ", feet(f64::from(*z))))
        .collect();
    let file = InputFile::new("dtm.asc", format!("{header}\n{rows}\n").into_bytes());
    let wkt = r#"LOCAL["x"],PROJCS["x",GEOGCS["y",DATUM["NAD83",SPHEROID["GRS 1980",6378137,298.257222101]]],PROJECTION["Lambert_Conformal_Conic_2SP"],UNIT["US survey foot",0.3048006096012192],AUTHORITY["EPSG","2263"]]"#;
    let own = WorldSystem {
        epsg: Some(32118),
        anchor: None,
    };
    let found = Terrain::read(&file, Some(wkt), &own, Vector3::from(ORIGIN), 0.3).unwrap();
    let miss = found.z_at(3.7, -4.2).unwrap() - ground(3.7, -4.2);
    assert!(miss.abs() < 1e-3, "{miss}");
}

#[test]
fn ascii_grids_of_other_programs_are_read() {
    let comma = |file: InputFile| String::from_utf8(file.bytes).unwrap().replace('.', ",");
    let plain = String::from_utf8(ascii(CORNER).bytes).unwrap();
    for text in [
        format!("\u{feff}{plain}"),
        comma(ascii(CORNER)),
        plain.replace('\n', "\r\n"),
        format!("\n\n{plain}"),
        plain
            .replace("ncols", "NCOLS")
            .replace("cellsize", "CELLSIZE"),
        format!("\u{feff}{}", comma(ascii(CORNER))),
    ] {
        let file = InputFile::new("dtm.asc", text.into_bytes());
        assert_eq!(
            crate::orienting::orientation::detect(&file),
            crate::orienting::orientation::FileKind::Terrain
        );
        check_planted(&terrain(&file, &UTM).unwrap());
    }
}

/// The planted heights with a hole of these columns and rows.
pub(super) fn with_hole(
    columns: std::ops::Range<usize>,
    rows: std::ops::Range<usize>,
    filler: &str,
) -> InputFile {
    let value = |k: usize, z: f32| match columns.contains(&(k % 20)) && rows.contains(&(k / 20)) {
        true => filler.to_owned(),
        false => format!("{:.3}", z + 300.5),
    };
    let heights = heights();
    let cells: Vec<String> = heights
        .iter()
        .enumerate()
        .map(|(k, z)| value(k, *z))
        .collect();
    InputFile::new(
        "dtm.asc",
        format!("{CORNER}\n{}\n", cells.join(" ")).into_bytes(),
    )
}

#[test]
fn fillers_are_no_ground_and_their_number_is_said() {
    for (columns, rows, filler) in [
        (8..12, 5..9, "0"),
        (8..12, 5..9, "-1"),
        (8..12, 5..9, "-32767"),
        (8..12, 5..9, "1e20"),
        (8..12, 5..9, "255"),
        (8..12, 5..9, "9999"),
        (8..12, 5..9, "32767"),
        (8..12, 5..9, "120.25"),
        (0..12, 0..15, "0"),
        (0..20, 0..9, "0"),
        (10..11, 7..8, "0"),
        (10..11, 7..8, "700.5"),
    ] {
        let hole = columns.len() * rows.len();
        let file = with_hole(columns.clone(), rows, filler);
        let found = terrain(&file, &UTM).unwrap_or_else(|e| panic!("{filler}: {e}"));
        let said = found
            .notice()
            .unwrap_or_else(|| panic!("{filler} in {columns:?}"));
        assert!(
            said.contains(&format!("{hole} of 300 ")),
            "{filler}: {said}"
        );
        let heights = (0..400).filter_map(|k| {
            let (x, y) = (
                f64::from(k % 20) * 2.0 - 19.0,
                f64::from(k / 20) * 1.4 - 14.0,
            );
            Some(found.z_at(x, y)? - 300.5 - ground(x, y))
        });
        let worst = heights.fold(0.0, |worst, miss: f64| miss.abs().max(worst));
        assert!(worst < 1e-2, "{filler}: {worst} m");
    }
    for none in [&ascii(CORNER), &with_hole(0..0, 0..0, "")] {
        assert_eq!(terrain(none, &UTM).unwrap().notice(), None);
    }
    // Near the sea a filler of 0 is within a slope of the ground, and so is a harbour with shores.
    let low = |fill: &dyn Fn(usize, usize, f32) -> f32| {
        let cell =
            |(k, z): (usize, f32)| format!("{} ", fill(k % 20, k / 20, 3.37 + 0.01 * (z % 9.0)));
        let cells: String = heights().into_iter().enumerate().map(cell).collect();
        let text = format!("{CORNER}\n{cells}\n");
        terrain(&InputFile::new("a.asc", text.into_bytes()), &UTM)
            .unwrap()
            .notice()
    };
    let filled = low(&|c, r, z| {
        if (5..9).contains(&c) && (5..9).contains(&r) {
            0.0
        } else {
            z
        }
    });
    assert!(filled.unwrap().contains("16 of 300 "));
    let lake = low(&|c, r, z| match (c, r) {
        (5..9, 5..9) => 3.0,
        (4, _) => 3.4,
        _ => z,
    });
    assert_eq!(lake, None);
    // The border that an interpolation leaves, and the roofs and the bank of a surface model.
    let mut smeared = heights();
    let mut surface = heights();
    for (k, (a, b)) in smeared.iter_mut().zip(&mut surface).enumerate() {
        let (c, r) = (k % 20, k / 20);
        match [c.abs_diff(9), r.abs_diff(7)] {
            [0..=2, 0..=2] => *a = 0.0,
            [0..=3, 0..=3] => *a = 0.5 * (*a + 0.25),
            _ => {}
        }
        *b += if (5..9).contains(&c) && (4..9).contains(&r) {
            14.0
        } else {
            0.0
        };
        *b += if c > 12 { 9.0 } else { 0.0 };
    }
    let of = |heights: &[f32]| {
        let cells: String = heights.iter().map(|z| format!("{z} ")).collect();
        terrain(
            &InputFile::new("a.asc", format!("{CORNER}\n{cells}\n").into_bytes()),
            &UTM,
        )
        .unwrap()
    };
    assert!(of(&smeared).notice().unwrap().contains("49 of 300"));
    assert_eq!(of(&surface).notice(), None);
}

proptest::proptest! {
    #[test]
    fn a_planted_unit_and_offset_are_recovered(
        unit in 0usize..4,
        offset in -50.0..50.0f64,
        x in -15.0..15.0f64,
        y in -12.0..12.0f64,
    ) {
        let (name, unit_m) = [("m", 1.0), ("ft", 0.3048), ("US survey foot", 1200.0 / 3937.0), ("cm", 0.01)][unit];
        let items = [("unittype", name), ("offset", &*format!("{}", offset / unit_m))];
        let file = raster_in(unit_m, offset, &[[3072, 25832]], vec![band(&items)]);
        let z = terrain(&file, &UTM).unwrap().z_at(x, y).unwrap();
        proptest::prop_assert!((z - ground(x, y)).abs() < 2e-3, "{z}");
    }

    #[test]
    fn a_planted_hole_is_taken_out(
        c in 0usize..17, r in 0usize..12, wide in 1usize..6, high in 1usize..6,
        filler in proptest::sample::select(vec!["0", "-1", "1", "255", "9999", "-3.4e38"]),
    ) {
        let (columns, rows) = (c..(c + wide).min(20), r..(r + high).min(15));
        let cells = columns.len() * rows.len();
        let found = terrain(&with_hole(columns, rows, filler), &UTM).unwrap();
        let said = found.notice().unwrap_or_default();
        proptest::prop_assert!(said.contains(&format!("{cells} of 300 ")), "{}", said);
    }
}
