//! What programs and people leave: values for none, citations, forms of grids and of footprints.

use super::forms::{band, raster_in, with_hole};
use super::*;

/// The planted raster with this value in four cells, which a tag may name.
fn with_none(value: f32, tag: Option<&str>) -> InputFile {
    let tags = tag.map(|text| {
        let bytes = format!("{text}\0").into_bytes();
        (42113, 2, bytes.len() as u32, bytes)
    });
    let place = placed(false).into_iter();
    let mut tiff = PlantedTiff::strip(place.chain(tags).collect());
    let stored = |(k, z): (usize, f32)| {
        if [147, 148, 167, 168].contains(&k) {
            value
        } else {
            z
        }
    };
    let cells = heights()
        .into_iter()
        .map(|z| z + 300.5)
        .enumerate()
        .map(stored);
    tiff.chunks = vec![cells.flat_map(f32::to_le_bytes).collect()];
    tiff.file()
}

#[test]
fn values_for_none_are_none_with_and_without_their_tag() {
    let lowest = f32::MIN;
    for (value, tag) in [
        (-9999.0, "-9999"),
        (-9999.0, "-9999.0 "),
        (-32_767.0, "-32767"),
        (-32_768.0, "-32768"),
        (lowest, "-3.4028234663852886e+38"),
        (lowest, "-3.40282346638528860e+38"),
        (f32::MAX, "3.4028234663852886e+38"),
        (f32::NAN, "nan"),
        (0.0, "0"),
        (1e20, "1e+20"),
        (-99_999.0, "-99999"),
        (255.0, "255"),
        // A tag that names another value, as after a conversion.
        (0.0, "-9999"),
        (-3.4e38, "-9999"),
    ] {
        for tag in [Some(tag), None] {
            let found = terrain(&with_none(value, tag), &UTM).unwrap();
            assert_eq!(found.z_at(-4.0, -0.5), None, "{value} {tag:?}");
            let miss = found.z_at(8.0, 8.0).unwrap() - 300.5 - ground(8.0, 8.0);
            assert!(miss.abs() < 1e-3, "{value} {tag:?}: {miss}");
            let is_told = tag.is_some_and(|tag| tag.trim().parse() == Ok(value));
            let is_said = !is_told && !value.is_nan();
            assert_eq!(found.notice().is_some(), is_said, "{value} {tag:?}");
        }
    }
}

/// The planted raster with a projection of its own, named in the text of a key.
fn cited(key: u16, text: &str, more: &[[u16; 2]]) -> InputFile {
    let mut all = vec![1, 1, 0, 3 + more.len() as u16, 1024, 0, 1, 1];
    all.extend([key, 34_737, text.len() as u16, 0, 3072, 0, 1, 32_767]);
    all.extend(more.iter().flat_map(|[key, value]| [*key, 0, 1, *value]));
    let bytes = all.iter().flat_map(|v: &u16| v.to_le_bytes()).collect();
    let keys: [Tag; 2] = [
        (34_735, 3, all.len() as u32, bytes),
        (34_737, 2, text.len() as u32, text.as_bytes().to_vec()),
    ];
    PlantedTiff::strip(placed(false).into_iter().take(2).chain(keys).collect()).file()
}

#[test]
fn a_system_that_keys_only_cite_is_known_by_its_name() {
    let esri = "ESRI PE String = PROJCS[\"ETRS_1989_UTM_Zone_32N\",GEOGCS[\"g\",DATUM[\"D_ETRS_1989\",\
        SPHEROID[\"s\",6378137.0,298.257]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.017]],\
        PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],\
        PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",9.0],\
        PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]|";
    for (key, text) in [
        (1026, "ETRS89 / UTM zone 32N|"),
        (1026, "WGS 84 / UTM zone 32N|\0"),
        (3073, "PCS Name = WGS_1984_UTM_Zone_32N|"),
        (3073, "ETRS89 / UTM zone 32N + DHHN2016 height|"),
        (1026, "UTM Zone 32, Northern Hemisphere (WGS84)|"),
        (1026, "EPSG:25832|"),
        (3073, esri),
    ] {
        let found = terrain(&cited(key, text, &[[3076, 9001]]), &UTM);
        check_planted(&found.unwrap_or_else(|e| panic!("{text}: {e}")));
    }
    for (text, more, words) in [
        (
            "ETRS89 / UTM zone 33N|",
            [3076, 9001],
            "ETRS89 / UTM zone 33N",
        ),
        (
            "NAD_1983_StatePlane_New_York|",
            [3076, 9003],
            "in US survey feet",
        ),
        ("ED50 / UTM zone 32N|", [3076, 9001], "ED50"),
        ("|", [3076, 9001], "of its own"),
        ("WGS 84 / UTM zone 32N|", [3076, 32_767], "EPSG:32767"),
    ] {
        let refused = terrain(&cited(1026, text, &[more]), &UTM);
        // Another zone of the same datum is followed, and lies elsewhere.
        let said = match refused {
            Ok(found) => found
                .z_at(0.0, 0.0)
                .map_or(words.to_owned(), |z| z.to_string()),
            Err(e) => e.to_string(),
        };
        assert!(said.contains(words), "{text}: {said}");
    }
}

#[test]
fn grids_in_the_forms_of_many_programs_are_read() {
    let cells = heights();
    let lines = |cell: &dyn Fn(f32) -> String, wide: usize, by: &str| {
        let row = |row: &[f32]| row.iter().map(|z| cell(*z)).collect::<Vec<_>>().join(by);
        cells.chunks(wide).map(row).collect::<Vec<_>>().join("\n")
    };
    let plain = |z: f32| z.to_string();
    let comma = |z: f32| z.to_string().replace('.', ",");
    let head = format!("{CORNER}\nNODATA_value -9999\n");
    let ordered = "nrows 15\nncols 20\ncellsize 2\nyllcorner 5412285\nxllcorner 432080\n";
    let centre = "ncols 20\nnrows 15\nxllcenter 432081\nyllcenter 5412286\ncellsize 2.0\n";
    let utf16 = |text: String| -> Vec<u8> {
        "\u{feff}"
            .encode_utf16()
            .chain(text.encode_utf16())
            .flat_map(u16::to_be_bytes)
            .collect()
    };
    for bytes in [
        format!("{head}{}", lines(&plain, 20, " ")).into_bytes(),
        format!("{head}{}", lines(&plain, 7, " ")).into_bytes(),
        format!("{head}{}", lines(&plain, 300, "  ")).into_bytes(),
        format!("{}{}", head.replace(' ', "\t"), lines(&plain, 20, "\t")).into_bytes(),
        format!("{}{}", head.replace(' ', "       "), lines(&plain, 20, " ")).into_bytes(),
        format!("{ordered}{}", lines(&plain, 20, " ")).into_bytes(),
        format!("{centre}{}", lines(&plain, 20, " ")).into_bytes(),
        format!("{CORNER}\nNODATA_value -9999,0\n{}", lines(&comma, 20, " ")).into_bytes(),
        format!("{CORNER}\nnodata_value nan\n{}", lines(&plain, 20, " ")).into_bytes(),
        format!("{head}{}", lines(&|z| format!("{z:e}"), 20, " ")).into_bytes(),
        format!("{head}{}", lines(&plain, 20, " "))
            .replace('\n', "\r")
            .into_bytes(),
        utf16(format!("{head}{}", lines(&plain, 20, " "))),
    ] {
        let shown = String::from_utf8_lossy(&bytes[..120]).into_owned();
        let found = terrain(&InputFile::new("dtm.asc", bytes), &UTM);
        check_planted(&found.unwrap_or_else(|e| panic!("{shown}: {e}")));
    }
    for none in ["nan", "NaN", "-nan", "1.#QNAN", "-1.#IND", "-nan(ind)"] {
        let found = terrain(&with_hole(8..12, 5..9, none), &UTM).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(
            (found.z_at(0.0, 0.0), found.notice()),
            (None, None),
            "{none}"
        );
    }
}

#[test]
fn footprints_in_the_forms_of_many_programs_are_read() {
    let metres = planted_polygon(|p| p);
    let grid = crate::orienting::orientation::TransverseMercator::of_epsg(25832).unwrap();
    let zone_33 = crate::orienting::orientation::TransverseMercator::of_epsg(25833).unwrap();
    let degrees = |p: [f64; 2]| grid.geographic(p[0], p[1]);
    let in_degrees = planted_polygon(degrees);
    let in_33 = planted_polygon(|p| {
        let [lon, lat] = degrees(p);
        zone_33.projected(lon, lat)
    });
    let in_km = planted_polygon(|p| p.map(|v| v / 1000.0));
    let crs = |name: &str| CRS.replace("urn:ogc:def:crs:EPSG::25832", name);
    let projjson = r#""crs":{"type":"ProjectedCRS","id":{"authority":"EPSG","code":25832}},"#;
    let compound = format!(
        r#""crs":{{"type":"CompoundCRS","components":[{{{}}}]}},"#,
        &projjson[7..projjson.len() - 2]
    );
    let collected = format!(
        r#"{{"type":"GeometryCollection","crs":null,"geometries":[{{"type":"Point","coordinates":[1,2]}},{{"type":"Polygon","coordinates":{metres}}}]}}"#
    );
    let with_height = |part: &str| match part.ends_with(|c: char| c.is_ascii_digit()) {
        true => format!("{part},331.5"),
        false => part.to_owned(),
    };
    let high = (metres.split(']').map(with_height).collect::<Vec<_>>()).join("]");
    let bare = format!(r#"{{"type":"Polygon","crs":null,"coordinates":{metres}}}"#);
    let one = format!(
        r#"{{"type":"Feature",{CRS}"id":"h1","properties":null,"geometry":{{"type":"Polygon","coordinates":{metres}}}}}"#
    );
    let with_empty = feature("Polygon", &metres, CRS).replace(
        "\"features\":[",
        "\"features\":[{\"type\":\"Feature\",\"geometry\":null},",
    );
    let utf16: Vec<u8> = "\u{feff}"
        .encode_utf16()
        .chain(one.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    for bytes in [
        feature(
            "Polygon",
            &in_degrees,
            &crs("urn:ogc:def:crs:OGC:1.3:CRS84"),
        )
        .into_bytes(),
        feature("Polygon", &in_degrees, &crs("WGS 84")).into_bytes(),
        feature("Polygon", &in_degrees, &crs("EPSG:4258")).into_bytes(),
        feature("Polygon", &in_33, &crs("EPSG:25833")).into_bytes(),
        feature("Polygon", &in_33, &crs("ETRS89 / UTM zone 33N")).into_bytes(),
        feature(
            "Polygon",
            &in_km,
            &crs("+proj=utm +zone=32 +ellps=GRS80 +units=km"),
        )
        .into_bytes(),
        feature(
            "Polygon",
            &metres,
            &crs("https://www.opengis.net/def/crs/EPSG/0/25832"),
        )
        .into_bytes(),
        feature("Polygon", &metres, projjson).into_bytes(),
        feature("Polygon", &metres, &compound).into_bytes(),
        collected.into_bytes(),
        feature("Polygon", &metres, &crs("WGS 84 / UTM zone 32N")).into_bytes(),
        bare.into_bytes(),
        one.replace(',', ",\r\n").into_bytes(),
        format!("\u{feff}{one}").into_bytes(),
        utf16,
        with_empty.into_bytes(),
        feature("Polygon", &high, CRS).into_bytes(),
    ] {
        let shown = String::from_utf8_lossy(&bytes[..bytes.len().min(160)]).into_owned();
        let file = InputFile::new("houses.geojson", bytes);
        let found = Register::read(&file, &UTM, Vector3::from(ORIGIN), 0.5, &mut Vec::new());
        let found = found.unwrap_or_else(|e| panic!("{shown}: {e}"));
        let depth = found.footprints[0].outline.depth(&Point2::new(3.0, 0.0));
        assert!((depth - 2.0).abs() < 1e-4, "{shown}: {depth}");
    }
    let trailing = feature("Polygon", &metres, CRS).replace("]}", "],}");
    for (json, words) in [
        (trailing, "it is no JSON"),
        (feature("Polygon", &metres, &crs("EPSG:3857")), "EPSG:3857"),
        (
            feature("Polygon", &metres, &crs("ESRI:102003")),
            "ESRI:102003",
        ),
        (
            feature("Polygon", "[[[\"8,4\",\"49,0\"]]]", CRS),
            "no places",
        ),
        (feature("Polygon", "[[[8.4],[8.5],[8.4]]]", ""), "no places"),
    ] {
        let refused = register(&json, &UTM).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

#[test]
fn units_of_files_are_taken_out_in_plan_and_in_height() {
    let us = 1200.0 / 3937.0;
    let own = |epsg| WorldSystem {
        epsg: Some(epsg),
        anchor: None,
    };
    let polygon = |unit_m: f64| planted_polygon(|p| p.map(|v| v / unit_m));
    for (name, unit_m, epsg) in [
        ("EPSG:2263", us, 32_118),
        ("https://www.opengis.net/def/crs/EPSG/0/2263", us, 32_118),
        ("urn:ogc:def:crs:EPSG:9.8.15:2263", us, 32_118),
        ("urn:ogc:def:crs,crs:EPSG::2263,crs:EPSG::6360", us, 32_118),
        ("EPSG:2868", 0.3048, 26_949),
        ("EPSG:6539", us, 32_118),
        ("+proj=utm +zone=32 +datum=WGS84 +units=us-ft", us, 25_832),
        (
            "+proj=utm +zone=32 +datum=WGS84 +to_meter=0.3048",
            0.3048,
            25_832,
        ),
        ("EPSG:25832", 1.0, 25_832),
        ("EPSG:25832+6360", 1.0, 25_832),
    ] {
        let crs = CRS.replace("urn:ogc:def:crs:EPSG::25832", name);
        let found = register(&feature("Polygon", &polygon(unit_m), &crs), &own(epsg));
        let (found, _) = found.unwrap_or_else(|e| panic!("{name}: {e}"));
        let depth = found.footprints[0].outline.depth(&Point2::new(3.0, 0.0));
        assert!((depth - 2.0).abs() < 1e-4, "{name}: {depth}");
    }
    // A band's unit counts before that of keys, and theirs before that of the plan.
    for (keys, name, unit_m) in [
        (vec![[3072, 25_832], [4099, 9003]], Some("m"), 1.0),
        (vec![[3072, 25_832], [4099, 9003]], None, us),
        (vec![[3072, 25_832], [4096, 8228]], None, 0.3048),
        (vec![[3072, 25_832], [4096, 5703]], None, 1.0),
        (vec![[3072, 25_832]], Some("U.S. Survey Feet"), us),
        (vec![[3072, 25_832]], Some("International Feet"), 0.3048),
        (vec![[3072, 25_832]], Some("Meter"), 1.0),
        (vec![[3072, 25_832]], Some("cm"), 0.01),
    ] {
        let more = name
            .map(|name| band(&[("unittype", name)]))
            .into_iter()
            .collect();
        let found = terrain(&raster_in(unit_m, 0.0, &keys, more), &UTM).unwrap();
        let miss = found.z_at(3.7, -4.2).unwrap() - ground(3.7, -4.2);
        assert!(miss.abs() < 1e-3, "{keys:?} {name:?}: {miss} m");
    }
}
