//! Point clouds of the synthetic scenes, as LAS and LAZ files.
#![allow(dead_code, clippy::unwrap_used)]

use std::io::Cursor;

use laz::laszip::LasZipCompressor;
use laz::{LazItemRecordBuilder, LazVlr, LazVlrBuilder};
use nalgebra::{Point2, Point3};
use ridgeline::base::geometry::{contains, sides};
use ridgeline::orienting::synthetic::SyntheticTruth;

/// Does a ring hold a place?
pub fn is_inside(ring: &[Point2<f64>], p: &Point2<f64>) -> bool {
    contains(sides(ring), p)
}

/// Corners in plan.
pub fn plan(ring: &[Point3<f64>]) -> Vec<Point2<f64>> {
    ring.iter().map(|p| p.xy()).collect()
}

/// Nine points a square metre of roofs and ground, with errors of some centimetres.
pub fn points(truth: &SyntheticTruth) -> Vec<Point3<f64>> {
    let mut state = 1u32;
    let mut next = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1u32 << 24)
    };
    let mut all = Vec::new();
    for (i, j) in (-75..75).flat_map(|i| (-75..75).map(move |j| (i, j))) {
        let x = (f64::from(i) + next()) / 3.0;
        let y = (f64::from(j) + next()) / 3.0;
        let over = |(plane, ring): &(ridgeline::base::geometry::Plane, Vec<Point3<f64>>)| {
            is_inside(&plan(ring), &Point2::new(x, y)).then(|| plane.z_at(x, y))
        };
        let roofs = truth.facets.iter().filter_map(over);
        let z = roofs.fold(truth.ground_z, f64::max);
        all.push(Point3::new(x, y, z + 0.1 * (next() - 0.5)));
    }
    all
}

/// Bytes of the header, and of a record.
const HEADER: u16 = 227;
const RECORD: u16 = 20;

fn header(points: usize, data: usize, format: u8, variables: u32) -> Vec<u8> {
    let mut bytes = vec![0; usize::from(HEADER)];
    let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
    put(0, b"LASF");
    put(24, &[1, 2]);
    put(94, &HEADER.to_le_bytes());
    put(96, &(data as u32).to_le_bytes());
    put(100, &variables.to_le_bytes());
    put(104, &[format]);
    put(105, &RECORD.to_le_bytes());
    put(107, &(points as u32).to_le_bytes());
    for axis in 0..3 {
        put(131 + 8 * axis, &SCALE.to_le_bytes());
    }
    bytes
}

const SCALE: f64 = 0.001;

fn records(points: &[Point3<f64>], is_ground: impl Fn(&Point3<f64>) -> bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    for p in points {
        for v in p.iter() {
            bytes.extend(((v / SCALE).round() as i32).to_le_bytes());
        }
        let class = if is_ground(p) { 2 } else { 1 };
        bytes.extend([0, 0, 0b1001, class, 0, 0, 0, 0]);
    }
    bytes
}

/// A LAS file of point format 0; points of the height of the ground are classified as that.
pub fn las(points: &[Point3<f64>], is_ground: impl Fn(&Point3<f64>) -> bool) -> Vec<u8> {
    let header = header(points.len(), usize::from(HEADER), 0, 0);
    [header, records(points, is_ground)].concat()
}

/// The same points as a LAZ file.
pub fn laz(points: &[Point3<f64>], is_ground: impl Fn(&Point3<f64>) -> bool) -> Vec<u8> {
    let items = LazItemRecordBuilder::default_for_point_format_id(0, 0).unwrap();
    let description = LazVlrBuilder::new(items)
        .with_fixed_chunk_size(5000)
        .build();
    let mut content = Vec::new();
    description.write_to(&mut content).unwrap();
    let mut variable = vec![0; 54];
    variable[2..2 + LazVlr::USER_ID.len()].copy_from_slice(LazVlr::USER_ID.as_bytes());
    variable[18..20].copy_from_slice(&LazVlr::RECORD_ID.to_le_bytes());
    variable[20..22].copy_from_slice(&(content.len() as u16).to_le_bytes());
    variable.extend(content);
    let data = usize::from(HEADER) + variable.len();
    const COMPRESSED: u8 = 1 << 7;
    let mut target = Cursor::new([header(points.len(), data, COMPRESSED, 1), variable].concat());
    target.set_position(data as u64);
    let mut compressor = LasZipCompressor::new(&mut target, description).unwrap();
    for record in records(points, is_ground).chunks(usize::from(RECORD)) {
        compressor.compress_one(record).unwrap();
    }
    compressor.done().unwrap();
    drop(compressor);
    target.into_inner()
}
