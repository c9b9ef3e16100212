//! Planted grids and footprints, through all readers; and what is refused.

mod forms;
mod further;

use nalgebra::{Point2, Vector3};

use super::*;
use crate::orienting::orientation::Anchor;

const UTM: WorldSystem = WorldSystem {
    epsg: Some(25832),
    anchor: None,
};
const UNKNOWN: WorldSystem = WorldSystem {
    epsg: None,
    anchor: None,
};
/// Origin of the planted scene.
const ORIGIN: [f64; 3] = [432_100.0, 5_412_300.0, 100.0];

/// The planted ground: a plane.
fn ground(x: f64, y: f64) -> f64 {
    12.0 + 0.25 * x - 0.1 * y
}

/// Heights of cells of 2 m, 20 columns and 15 rows, the first centre at (-19, 14) of the scene.
fn heights() -> Vec<f32> {
    let cells = (0..15).flat_map(|r| (0..20).map(move |c| (c, r)));
    let height = |(c, r): (i32, i32)| {
        let (x, y) = (-19.0 + 2.0 * f64::from(c), 14.0 - 2.0 * f64::from(r));
        (ground(x, y) + ORIGIN[2]) as f32
    };
    cells.map(height).collect()
}

fn ascii(header: &str) -> InputFile {
    let rows: Vec<String> = (heights().chunks(20))
        .map(|row| row.iter().map(|z| format!("{z} ")).collect())
        .collect();
    let text = format!("{header}\n{}\n", rows.join("\n"));
    InputFile::new("dtm.asc", text.into_bytes())
}

const CORNER: &str = "ncols 20\nnrows 15\nxllcorner 432080\nyllcorner 5412285\ncellsize 2";

fn terrain(file: &InputFile, system: &WorldSystem) -> Result<Terrain> {
    Terrain::read(file, None, system, Vector3::from(ORIGIN), 0.3)
}

fn check_planted(terrain: &Terrain) {
    for (x, y) in [(0.0, 0.0), (-18.3, 13.1), (18.9, -13.9), (3.7, -4.2)] {
        let z = terrain.z_at(x, y).expect("inside");
        assert!((z - ground(x, y)).abs() < 1e-4, "{z} at {x}, {y}");
    }
    for (x, y) in [(21.0, 0.0), (0.0, 16.0), (0.0, -16.0), (-21.0, 0.0)] {
        assert_eq!(terrain.z_at(x, y), None, "outside at {x}, {y}");
    }
}

/// A tag of a TIFF with its values' bytes, of this type and number.
type Tag = (u16, u16, u32, Vec<u8>);

/// A little-endian TIFF of one strip, or of tiles of 16 x 16.
struct PlantedTiff {
    tags: Vec<Tag>,
    chunks: Vec<Vec<u8>>,
    tiled: bool,
}

fn short(tag: u16, value: u16) -> Tag {
    (tag, 3, 1, value.to_le_bytes().to_vec())
}

fn doubles(tag: u16, values: &[f64]) -> Tag {
    let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    (tag, 12, values.len() as u32, bytes)
}

fn geo_keys(keys: &[[u16; 2]]) -> Tag {
    let mut all = vec![1, 1, 0, keys.len() as u16];
    all.extend(keys.iter().flat_map(|[key, value]| [*key, 0, 1, *value]));
    let bytes = all.iter().flat_map(|v: &u16| v.to_le_bytes()).collect();
    (34735, 3, all.len() as u32, bytes)
}

impl PlantedTiff {
    /// The planted heights as 32-bit floating-point numbers in one strip.
    fn strip(tags: Vec<Tag>) -> Self {
        let bytes = heights().iter().flat_map(|z| z.to_le_bytes()).collect();
        let format = [short(258, 32), short(339, 3)];
        Self {
            tags: [tags, format.to_vec()].concat(),
            chunks: vec![bytes],
            tiled: false,
        }
    }

    /// The same in decimetres, or as whole numbers of this format, in tiles.
    fn tiles(tags: Vec<Tag>, number: impl Fn(f32) -> Vec<u8>) -> Self {
        let heights = heights();
        let tile = |left: usize| -> Vec<u8> {
            let cells = (0..16).flat_map(|r| (0..16).map(move |c| (left + c, r)));
            let height = |(c, r): (usize, usize)| heights[r.min(14) * 20 + c.min(19)];
            cells.flat_map(|cell| number(height(cell))).collect()
        };
        Self {
            tags: [tags, vec![short(322, 16), short(323, 16)]].concat(),
            chunks: vec![tile(0), tile(16)],
            tiled: true,
        }
    }

    fn file(&self) -> InputFile {
        let mut tags = self.tags.clone();
        tags.extend([short(256, 20), short(257, 15), short(277, 1), short(262, 1)]);
        let mut bytes = b"II*\0\0\0\0\0".to_vec();
        let mut places = Vec::new();
        for chunk in &self.chunks {
            places.push((bytes.len() as u32, chunk.len() as u32));
            bytes.extend(chunk);
        }
        let longs = |tag, values: Vec<u32>| {
            let bytes = values.iter().flat_map(|v| v.to_le_bytes()).collect();
            (tag, 4, values.len() as u32, bytes)
        };
        let [offsets, counts] = if self.tiled { [324, 325] } else { [273, 279] };
        tags.push(longs(offsets, places.iter().map(|p| p.0).collect()));
        tags.push(longs(counts, places.iter().map(|p| p.1).collect()));
        tags.sort_by_key(|tag| tag.0);
        let mut entries = Vec::new();
        for (tag, kind, count, values) in tags {
            entries.extend(tag.to_le_bytes());
            entries.extend(kind.to_le_bytes());
            entries.extend(count.to_le_bytes());
            if values.len() <= 4 {
                let mut inline = values.clone();
                inline.resize(4, 0);
                entries.extend(inline);
            } else {
                entries.extend((bytes.len() as u32).to_le_bytes());
                bytes.extend(values);
            }
        }
        let at = bytes.len() as u32;
        bytes[4..8].copy_from_slice(&at.to_le_bytes());
        bytes.extend(((entries.len() / 12) as u16).to_le_bytes());
        bytes.extend(entries);
        bytes.extend([0; 4]);
        InputFile::new("dtm.tif", bytes)
    }
}

/// Place by a tie point at the north-western corner, or at the centre of the first cell.
fn placed(center: bool) -> Vec<Tag> {
    let off = if center { 1.0 } else { 0.0 };
    let tie = [0.0, 0.0, 0.0, 432_080.0 + off, 5_412_315.0 - off, 0.0];
    let raster = [1025, if center { 2 } else { 1 }];
    vec![
        doubles(33550, &[2.0, 2.0, 0.0]),
        doubles(33922, &tie),
        geo_keys(&[[1024, 1], raster, [3072, 25832], [3076, 9001]]),
    ]
}

#[test]
fn a_planted_ascii_grid_is_recovered_by_corner_and_by_center() {
    check_planted(&terrain(&ascii(CORNER), &UTM).unwrap());
    let center =
        "NCOLS 20\nNROWS 15\nXLLCENTER 432081\nYLLCENTER 5412286\nDX 2\nDY 2\nNODATA_value -9999";
    check_planted(&terrain(&ascii(center), &UNKNOWN).unwrap());
}

#[test]
fn cells_without_a_height_have_none_around_them() {
    let mut file = ascii(&format!("{CORNER}\nNODATA_value -1"));
    let text = String::from_utf8(file.bytes).unwrap();
    // The first cell.
    let (header, cells) = text.split_once("-1\n").unwrap();
    let (_, cells) = cells.split_once(' ').unwrap();
    file.bytes = format!("{header}-1\n-1 {cells}").into_bytes();
    let found = terrain(&file, &UTM).unwrap();
    assert_eq!(found.z_at(-18.5, 13.5), None);
    assert!(found.z_at(-16.5, 11.5).is_some());
}

#[test]
fn planted_geotiffs_are_recovered_in_strips_and_tiles_as_fractions_and_whole_numbers() {
    for center in [false, true] {
        check_planted(&terrain(&PlantedTiff::strip(placed(center)).file(), &UTM).unwrap());
    }
    let float = [placed(false), vec![short(258, 64), short(339, 3)]].concat();
    let tiles = PlantedTiff::tiles(float, |z| f64::from(z).to_le_bytes().to_vec());
    check_planted(&terrain(&tiles.file(), &UTM).unwrap());
    let whole = [placed(false), vec![short(258, 16), short(339, 2)]].concat();
    let tiles = PlantedTiff::tiles(whole, |z| (z.round() as i16).to_le_bytes().to_vec());
    let found = terrain(&tiles.file(), &UTM).unwrap();
    assert!((found.z_at(0.0, 0.0).unwrap() - ground(0.0, 0.0)).abs() < 0.51);
    // By a matrix instead.
    let m = [
        2.0,
        0.0,
        0.0,
        432_080.0,
        0.0,
        -2.0,
        0.0,
        5_412_315.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
    ];
    check_planted(&terrain(&PlantedTiff::strip(vec![doubles(34264, &m)]).file(), &UTM).unwrap());
}

/// By Adobe's note: the bytes of a row side by side, and their differences.
#[test]
fn the_predictor_of_floating_point_numbers_is_undone() {
    let mut tiff = PlantedTiff::strip([placed(false), vec![short(259, 8), short(317, 3)]].concat());
    let mut stored = Vec::new();
    for row in heights().chunks(20) {
        let split: Vec<u8> = (0..4)
            .flat_map(|b| row.iter().map(move |z| z.to_be_bytes()[b]))
            .collect();
        stored.push(split[0]);
        stored.extend(split.windows(2).map(|w| w[1].wrapping_sub(w[0])));
    }
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    std::io::Write::write_all(&mut packed, &stored).unwrap();
    tiff.chunks = vec![packed.finish().unwrap()];
    check_planted(&terrain(&tiff.file(), &UTM).unwrap());
}

#[test]
fn terrain_that_cannot_be_used_is_refused_by_name() {
    let refused = |file: &InputFile, words: &str| {
        let error = terrain(file, &UTM).unwrap_err().to_string();
        assert!(
            error.starts_with(&file.path) && error.contains(words),
            "{error}"
        );
    };
    refused(
        &ascii("ncols 20\nnrows 16\nxllcorner 1\nyllcorner 1\ncellsize 2"),
        "after 300 of 320",
    );
    refused(
        &ascii("ncols 20\nnrows 14\nxllcorner 1\nyllcorner 1\ncellsize 2"),
        "more than 20 x 14",
    );
    refused(
        &ascii("ncols 20\nnrows 15\nxllcorner 1\nyllcorner 1"),
        "no cellsize",
    );
    refused(
        &ascii("ncols 20\nnrows 15\nxllcorner 1\nyllcorner 1\ncellsize nan"),
        "no number",
    );
    refused(
        &ascii("ncols 20\nnrows 15\nxllcorner 1.5\nyllcorner 1\ncellsize 2,5"),
        "line 5",
    );
    let all_nan = CORNER.to_owned() + "\n" + &"nan ".repeat(300);
    refused(
        &InputFile::new("dtm.asc", all_nan.into_bytes()),
        "no height at all",
    );
    let mut cut = PlantedTiff::strip(placed(false)).file();
    cut.bytes.truncate(800);
    refused(&cut, "cut off");
    let mut short_strip = PlantedTiff::strip(placed(false));
    short_strip.chunks[0].truncate(800);
    refused(&short_strip.file(), "damaged");
    refused(&PlantedTiff::strip(Vec::new()).file(), "where it lies");
    let with = |keys: &[[u16; 2]]| {
        let place = placed(false).into_iter().take(2);
        PlantedTiff::strip(place.chain([geo_keys(keys)]).collect()).file()
    };
    refused(&with(&[[3072, 2056]]), "EPSG:2056");
    refused(&with(&[[1024, 2], [2048, 4314]]), "EPSG:4314");
    refused(&with(&[[3072, 25832], [4099, 9014]]), "not in metres");
    refused(
        &InputFile::new("a.las", b"LASF....".to_vec()),
        "ends within its header",
    );
    refused(
        &InputFile::new("a.bin", b"FSAL....".to_vec()),
        "no terrain model",
    );
}

fn register(json: &str, system: &WorldSystem) -> Result<(Register, Vec<String>)> {
    let file = InputFile::new("houses.geojson", json.as_bytes().to_vec());
    let mut warnings = Vec::new();
    let found = Register::read(&file, system, Vector3::from(ORIGIN), 0.5, &mut warnings)?;
    Ok((found, warnings))
}

/// A square of 10 m at the planted scene's origin with a hole of 2 m, in these coordinates.
fn planted_polygon(position: impl Fn([f64; 2]) -> [f64; 2]) -> String {
    let ring = |half: f64| {
        let corners = [
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, 1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
        ];
        let place = |c: [f64; 2]| {
            let [x, y] = position([c[0] * half + ORIGIN[0], c[1] * half + ORIGIN[1]]);
            format!("[{x},{y}]")
        };
        format!("[{}]", corners.map(place).join(","))
    };
    format!("[{},{}]", ring(5.0), ring(1.0))
}

fn feature(kind: &str, coordinates: &str, crs: &str) -> String {
    format!(
        r#"{{"type":"FeatureCollection",{crs}"features":[{{"type":"Feature","id":"h1",
        "geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}]}}"#
    )
}

const CRS: &str = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},"#;

#[test]
fn planted_footprints_are_recovered_in_the_systems_of_files() {
    let grid = crate::orienting::orientation::TransverseMercator::of_epsg(25832).unwrap();
    let degrees = planted_polygon(|[e, n]| grid.geographic(e, n));
    let metres = planted_polygon(|p| p);
    let many = format!("[{metres}]");
    let [lon, lat] = grid.geographic(ORIGIN[0], ORIGIN[1]);
    let files = [
        feature("Polygon", &metres, CRS),
        feature("MultiPolygon", &many, CRS),
        feature("Polygon", &metres, "\"crs\":null,"),
        feature("Polygon", &degrees, ""),
    ];
    for json in &files {
        let (found, warnings) = register(json, &UTM).unwrap();
        assert!(warnings.is_empty());
        let [footprint] = &found.footprints[..] else {
            panic!("{}", found.footprints.len());
        };
        assert_eq!(footprint.name, "h1");
        assert!(
            (footprint.outline.signed_area() - 96.0).abs() < 1e-3,
            "{}",
            footprint.outline.signed_area()
        );
        let depth = |x, y| footprint.outline.depth(&Point2::new(x, y));
        assert!((depth(3.0, 0.0) - 2.0).abs() < 1e-4);
        assert!((depth(0.0, 7.0) + 2.0).abs() < 1e-4);
        assert!((depth(0.5, 0.0) + 0.5).abs() < 1e-4, "in the hole");
    }
    // East and north of a place: a plane that touches the Earth, turned by the convergence.
    let anchor = Anchor {
        lon_deg: lon,
        lat_deg: lat,
        height_m: 0.0,
    };
    let place = WorldSystem {
        epsg: None,
        anchor: Some(anchor),
    };
    let file = InputFile::new("a.json", files[3].clone().into_bytes());
    let found = Register::read(&file, &place, Vector3::zeros(), 0.5, &mut Vec::new()).unwrap();
    // The scale of the grid there is 0.99966.
    assert!((found.footprints[0].outline.signed_area() - 96.0 / (0.99966 * 0.99966)).abs() < 0.02);
    assert!((found.footprints[0].outline.depth(&Point2::new(3.0, 0.0)) - 2.0).abs() < 0.05);
}

/// A box whose bottom is called a ground surface, or is only the lowest.
fn city_json(semantics: &str, crs: &str) -> String {
    format!(
        r#"{{"type":"CityJSON","version":"2.0","metadata":{{{crs}}},
        "transform":{{"scale":[0.01,0.01,0.01],"translate":[432100,5412300,100]}},
        "CityObjects":{{"b7":{{"type":"Building","geometry":[{{"type":"Solid","lod":"2",
        "boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]{semantics}}}]}},
        "tree":{{"type":"SolitaryVegetationObject","geometry":[]}}}},
        "vertices":[[-500,-500,0],[500,-500,0],[500,500,0],[-500,500,0],
        [-500,-500,600],[500,-500,600],[500,500,600],[-500,500,600]]}}"#
    )
}

#[test]
fn footprints_of_city_json_are_its_ground_surfaces_or_the_lowest_ones() {
    let ground = r#","semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},
        {"type":"WallSurface"}],"values":[[0,1,2,2,2,2]]}"#;
    let crs = r#""referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/25832""#;
    for json in [city_json(ground, crs), city_json("", "")] {
        let (found, _) = register(&json, &UTM).unwrap();
        assert_eq!(found.footprints.len(), 1);
        assert_eq!(found.footprints[0].name, "b7");
        assert!((found.footprints[0].outline.depth(&Point2::new(0.0, 3.0)) - 2.0).abs() < 1e-6);
    }
}

#[test]
fn footprints_that_cannot_be_used_are_refused_by_name() {
    let refused = |json: &str, system: &WorldSystem, words: &str| {
        let error = register(json, system).unwrap_err().to_string();
        assert!(
            error.starts_with("houses.geojson") && error.contains(words),
            "{error}"
        );
    };
    let metres = planted_polygon(|p| p);
    let degrees = planted_polygon(|[x, y]| [x / 1e5, y / 1e5]);
    refused(
        &feature("Polygon", &degrees, ""),
        &UNKNOWN,
        "longitude and latitude",
    );
    refused(
        &feature("Polygon", &metres, &CRS.replace("25832", "2056")),
        &UTM,
        "EPSG:2056",
    );
    refused(
        &feature("Polygon", &metres, r#""crs":{"type":"link"},"#),
        &UTM,
        "names no system",
    );
    refused(&feature("Polygon", "[[[null,2]]]", CRS), &UTM, "no places");
    refused(
        &feature("Polygon", "[[[1,2],[3,4]]]", CRS),
        &UTM,
        "fewer than three corners",
    );
    for rings in [
        "[[[0,0],[9,1e300],[9,0]]]",
        "[[[0,0],[9,0],[9,9],[0,9]],[[1e200,1],[3,1],[3,3]]]",
    ] {
        refused(
            &feature("Polygon", rings, CRS),
            &UTM,
            "no place on the Earth",
        );
    }
    refused(
        &feature("Polygon", "[[[0,0],[9,9],[9,0],[0,9]]]", CRS),
        &UTM,
        "h1 is left out",
    );
    refused(
        &feature("Point", "[1,2]", CRS),
        &UTM,
        "no polygons of buildings",
    );
    refused("{\n\"type\": ", &UTM, "line 2");
    refused("{\"a\": 1}", &UTM, "no footprints");
    refused(
        &city_json("", "").replace("[4,5,6,7]", "[4,5,6,70]"),
        &UTM,
        "b7 names vertices",
    );
    // One that is broken leaves the others.
    let crossed = "[[[0,0],[9,9],[9,0],[0,9]]]";
    let both = format!("[{metres},{crossed}]");
    let (found, warnings) = register(&feature("MultiPolygon", &both, CRS), &UTM).unwrap();
    assert_eq!(found.footprints.len(), 1);
    assert!(warnings[0].contains("crosses itself"), "{warnings:?}");
}
