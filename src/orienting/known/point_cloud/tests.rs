//! Planted clouds in LAS and LAZ of all point formats, and what is refused.

use std::io::Cursor;

use laz::laszip::LasZipCompressor;
use laz::{LazItemRecordBuilder, LazVlrBuilder};

use super::*;

/// Origin of the planted clouds.
const ORIGIN: [f64; 3] = [432_100.0, 5_412_300.0, 100.0];
const SCALE: f64 = 0.001;

/// The planted ground: a plane.
fn ground(x: f64, y: f64) -> f64 {
    12.0 + 0.25 * x - 0.1 * y
}

/// A point: position against the origin, class, withheld.
type Point = ([f64; 3], u8, bool);

/// Ground of 40 m by 30 m, two points a metre along each axis, but for a building of 10 m by 8 m;
/// and points on its roof.
fn planted() -> Vec<Point> {
    let steps = (0..80).flat_map(|i| (0..60).map(move |j| (f64::from(i), f64::from(j))));
    let point = |(i, j): (f64, f64)| {
        // Not on a regular grid.
        let (x, y) = (
            -20.0 + 0.5 * i + 0.13 * (j % 3.0),
            -15.0 + 0.5 * j + 0.11 * (i % 4.0),
        );
        match (x - 2.0).abs() < 5.0 && (y + 1.0).abs() < 4.0 {
            true => ([x, y, 25.0], 6, false),
            false => ([x, y, ground(x, y)], 2, false),
        }
    };
    let mut points: Vec<Point> = steps.map(point).collect();
    // What is withheld and what is noise does not count.
    points.push(([0.0, 10.0, -90.0], 2, true));
    points.push(([5.0, 10.0, -90.0], 7, false));
    points
}

fn record(format: u8, length: usize, (position, class, withheld): &Point) -> Vec<u8> {
    let mut record = vec![0; length];
    for (k, v) in position.iter().enumerate() {
        let stored = (v / SCALE).round() as i32;
        record[4 * k..4 * k + 4].copy_from_slice(&stored.to_le_bytes());
    }
    let withheld = u8::from(*withheld);
    match format {
        0..6 => {
            record[14] = 0b1001;
            record[15] = class | withheld << 7;
        }
        _ => {
            record[14] = 0x11;
            record[15] = withheld << 2;
            record[16] = *class;
        }
    }
    record
}

/// A variable record.
fn variable(owner: &str, number: u16, content: &[u8]) -> Vec<u8> {
    let mut all = vec![0; 54];
    all[2..2 + owner.len()].copy_from_slice(owner.as_bytes());
    all[18..20].copy_from_slice(&number.to_le_bytes());
    all[20..22].copy_from_slice(&(content.len() as u16).to_le_bytes());
    all.extend(content);
    all
}

/// A cloud as it is written.
struct Planted {
    format: u8,
    /// Bytes of a record beyond those of its format.
    extra: u16,
    compressed: bool,
    /// Points in a chunk; all that there are if 0.
    chunk: u32,
    variables: Vec<Vec<u8>>,
    points: Vec<Point>,
}

impl Planted {
    fn new(format: u8) -> Self {
        Self {
            format,
            extra: 0,
            compressed: false,
            chunk: 1000,
            variables: Vec::new(),
            points: planted(),
        }
    }

    fn compressed(format: u8) -> Self {
        Self {
            compressed: true,
            ..Self::new(format)
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let shortest = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67][usize::from(self.format)];
        let length = shortest + self.extra;
        let is_1_4 = self.format >= 6;
        let size: u16 = if is_1_4 { 375 } else { 227 };
        let mut variables = self.variables.clone();
        let items = LazItemRecordBuilder::default_for_point_format_id(self.format, self.extra);
        let description = match self.chunk {
            0 => LazVlrBuilder::new(items.unwrap()).with_variable_chunk_size(),
            count => LazVlrBuilder::new(items.unwrap()).with_fixed_chunk_size(count),
        };
        let description = description.build();
        if self.compressed {
            let mut content = Vec::new();
            description.write_to(&mut content).unwrap();
            variables.push(variable("laszip encoded", 22_204, &content));
        }
        let data = usize::from(size) + variables.iter().map(Vec::len).sum::<usize>();
        let mut all = vec![0; usize::from(size)];
        let mut put = |at: usize, bytes: &[u8]| all[at..at + bytes.len()].copy_from_slice(bytes);
        put(0, b"LASF");
        put(24, &[1, if is_1_4 { 4 } else { 2 }]);
        put(94, &size.to_le_bytes());
        put(96, &(data as u32).to_le_bytes());
        put(100, &(variables.len() as u32).to_le_bytes());
        put(104, &[self.format | u8::from(self.compressed) << 7]);
        put(105, &length.to_le_bytes());
        let count = self.points.len() as u64;
        match is_1_4 {
            true => put(247, &count.to_le_bytes()),
            false => put(107, &(count as u32).to_le_bytes()),
        }
        for (k, origin) in ORIGIN.iter().enumerate() {
            put(131 + 8 * k, &SCALE.to_le_bytes());
            put(155 + 8 * k, &origin.to_le_bytes());
        }
        all.extend(variables.concat());
        let record = |p| record(self.format, usize::from(length), p);
        let records: Vec<u8> = self.points.iter().flat_map(record).collect();
        if !self.compressed {
            all.extend(records);
            return all;
        }
        let mut target = Cursor::new(all);
        target.set_position(data as u64);
        let mut compressor = LasZipCompressor::new(&mut target, description).unwrap();
        for (k, record) in records.chunks(usize::from(length)).enumerate() {
            if self.chunk == 0 && k % 700 == 699 {
                compressor.finish_current_chunk().unwrap();
            }
            compressor.compress_one(record).unwrap();
        }
        compressor.done().unwrap();
        drop(compressor);
        target.into_inner()
    }

    fn read(&self) -> Result<HeightGrid> {
        read_bytes(self.bytes())
    }
}

fn read_bytes(bytes: Vec<u8>) -> Result<HeightGrid> {
    let system = WorldSystem {
        epsg: Some(25832),
        anchor: None,
    };
    read(&InputFile::new("cloud.laz", bytes), &system)
}

fn refusal_of(bytes: Vec<u8>) -> String {
    read_bytes(bytes).expect_err("refused").to_string()
}

fn check_planted(grid: &HeightGrid) {
    // In the open, at the border, under the middle and a corner of the building.
    for (x, y) in [(-10.0, 5.0), (-19.4, 14.0), (2.0, -1.0), (6.5, 2.5)] {
        let z = grid.z_at(x + ORIGIN[0], y + ORIGIN[1]).expect("inside");
        let wanted = ground(x, y) + ORIGIN[2];
        assert!((z - wanted).abs() < 0.005, "{z} for {wanted} at {x}, {y}");
    }
    for (x, y) in [(-22.0, 0.0), (22.0, 0.0), (0.0, 17.0), (0.0, -17.0)] {
        assert_eq!(grid.z_at(x + ORIGIN[0], y + ORIGIN[1]), None);
    }
}

#[test]
fn planted_ground_is_recovered_from_every_point_format() {
    for format in 0..=10 {
        for compressed in [false, true] {
            for extra in [0, 3] {
                let cloud = Planted {
                    compressed,
                    extra,
                    ..Planted::new(format)
                };
                let grid = cloud.read();
                check_planted(&grid.unwrap_or_else(|e| panic!("format {format}: {e}")));
            }
        }
    }
}

#[test]
fn chunks_may_have_any_sizes() {
    for (format, chunk) in [(0, 400), (3, 50_000), (6, 170), (7, 0)] {
        let cloud = Planted {
            chunk,
            ..Planted::compressed(format)
        };
        check_planted(&cloud.read().unwrap());
    }
    let various = Planted {
        chunk: 0,
        ..Planted::compressed(1)
    };
    assert!(refusal_of(various.bytes()).contains("chunks have various sizes"));
}

#[test]
fn noisy_ground_is_averaged() {
    let mut cloud = Planted::new(1);
    for (k, (position, ..)) in cloud.points.iter_mut().enumerate() {
        position[2] += if k % 2 == 0 { 0.05 } else { -0.05 };
    }
    let grid = cloud.read().unwrap();
    let places = (-15..15).map(|k| f64::from(k) + 0.3);
    let error = |x: f64| {
        let z = grid.z_at(x + ORIGIN[0], 8.2 + ORIGIN[1]).unwrap();
        (z - ORIGIN[2] - ground(x, 8.2)).abs()
    };
    assert!(places.map(error).sum::<f64>() / 30.0 < 0.02);
}

#[test]
fn a_cloud_without_ground_is_refused_with_what_it_has() {
    let mut cloud = Planted::compressed(3);
    for (_, class, _) in &mut cloud.points {
        *class = if *class == 6 { 6 } else { 1 };
    }
    let message = refusal_of(cloud.bytes());
    assert!(
        message.contains("none of its 4802 points is classified as ground (class 2)"),
        "{message}"
    );
    assert!(message.contains("are unclassified (1)"), "{message}");
    assert!(message.contains("are buildings (6)"), "{message}");
}

#[test]
fn systems_are_those_of_the_orientation_or_refused() {
    let keys = |entries: &[[u16; 2]]| {
        let mut all = vec![1, 1, 0, entries.len() as u16];
        all.extend(entries.iter().flat_map(|[key, value]| [*key, 0, 1, *value]));
        let bytes: Vec<u8> = all.iter().flat_map(|v: &u16| v.to_le_bytes()).collect();
        variable("LASF_Projection", 34_735, &bytes)
    };
    let text = |text: &str| variable("LASF_Projection", 2112, text.as_bytes());
    let own = "PROJCS[\"ETRS89 / UTM zone 32N\",AUTHORITY[\"EPSG\",\"25832\"]]\0";
    for record in [keys(&[[1024, 1], [3072, 25832]]), text(own)] {
        let cloud = Planted {
            variables: vec![record],
            ..Planted::compressed(7)
        };
        check_planted(&cloud.read().unwrap());
    }
    let feet = "PROJCS[\"a\",UNIT[\"US survey foot\",0.3048]]";
    for (record, problem) in [
        (keys(&[[1024, 1], [3072, 28992]]), "EPSG:28992"),
        (keys(&[[1024, 2]]), "longitude and latitude"),
        (keys(&[[3072, 25832], [3076, 9014]]), "not in metres"),
        (text(feet), "in international feet"),
        (text(&own.replace("25832", "31467")), "EPSG:31467"),
    ] {
        let cloud = Planted {
            variables: vec![record],
            ..Planted::new(1)
        };
        let message = refusal_of(cloud.bytes());
        assert!(message.contains(problem), "{message}");
    }
}

#[test]
fn stated_points_that_are_not_there_are_refused_at_once() {
    let count = |bytes: &mut Vec<u8>, count: u64| {
        bytes[247..255].copy_from_slice(&count.to_le_bytes());
    };
    for compressed in [false, true] {
        let whole = Planted {
            compressed,
            ..Planted::new(6)
        }
        .bytes();
        let mut bomb = whole.clone();
        count(&mut bomb, 1_000_000_000_000);
        let message = refusal_of(bomb);
        assert!(
            message.contains("it states 1000000000000 points"),
            "{message}"
        );
        let mut more = whole.clone();
        count(&mut more, 90_000_000);
        let message = refusal_of(more);
        assert!(message.contains("90000000 points"), "{message}");
        let mut cut = whole;
        cut.truncate(cut.len() / 2);
        assert!(refusal_of(cut).contains("of 4802"));
    }
}

#[test]
fn layers_that_reach_beyond_the_file_take_no_memory() {
    let mut bytes = Planted::compressed(6).bytes();
    let data = u32::from_le_bytes(*bytes[96..].first_chunk().unwrap()) as usize;
    // Behind the place of the table, the first record and the number of records.
    let size = data + 8 + 30 + 4;
    bytes[size..size + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(refusal_of(bytes).contains("the file ends"));
}

#[test]
fn damaged_headers_are_refused_by_what_they_state() {
    let whole = Planted::new(3).bytes();
    let damaged = |at: usize, bytes: &[u8]| {
        let mut all = whole.clone();
        all[at..at + bytes.len()].copy_from_slice(bytes);
        refusal_of(all)
    };
    assert!(damaged(25, &[7]).contains("version 1.7"));
    assert!(damaged(94, &[9, 0]).contains("a header of 9 bytes"));
    assert!(damaged(96, &u32::MAX.to_le_bytes()).contains("begin at byte 4294967295"));
    assert!(damaged(104, &[11]).contains("point format 11"));
    assert!(damaged(105, &[9, 0]).contains("records have 9 bytes"));
    assert!(damaged(131, &f64::NAN.to_le_bytes()).contains("is no number"));
    assert!(damaged(131, &1e300_f64.to_le_bytes()).contains("lie within"));
    assert!(damaged(104, &[0x83]).contains("record of LASzip"));
    assert!(refusal_of(whole[..100].to_vec()).contains("ends within its header"));
}
