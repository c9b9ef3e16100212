//! The model for drawing and mapping programs: DXF, footprints as GeoJSON, the 3D lines as CSV.
//!
//! Coordinates are those of the input's world frame, metres. GeoJSON (RFC 7946) wants longitude and
//! latitude: footprints are in these where the frame's place on the Earth is known, else in the
//! input's own coordinates, whose reference system is named in the older way (GeoJSON 2008, `crs`)
//! where the input names it. DXF names it in a comment.

use nalgebra::Point3;
use serde_json::{Value, json};

use super::format::{push_line, rounded, to_bytes, world};
use super::triangulate::triangulate;
use crate::lines3d::Line3d;
use crate::model::{Building, RoofModel, Solid, Surface};
use crate::scene::Scene;

/// DXF of AutoCAD R12, which every program reads: 3DFACE on the layers ROOF, WALL and GROUND, LINE
/// on LINE3D.
pub fn dxf(scene: &Scene, model: &RoofModel, lines: &[Line3d]) -> Vec<u8> {
    let mut text = String::new();
    if let Some(system) = scene.survey.describe() {
        push_line(&mut text, format_args!("999\ncoordinates: {system}"));
    }
    text.push_str("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n");
    // Layers with the colours red, yellow, grey and blue of the AutoCAD index.
    let layers = [("ROOF", 1), ("WALL", 2), ("GROUND", 8), ("LINE3D", 5)];
    text.push_str("0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n4\n");
    for (name, colour) in layers {
        push_line(
            &mut text,
            format_args!("0\nLAYER\n2\n{name}\n70\n0\n62\n{colour}\n6\nCONTINUOUS"),
        );
    }
    text.push_str("0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n");
    for solid in model.buildings.iter().map(|b| &b.solid) {
        for face in &solid.faces {
            let layer = match face.surface {
                Surface::Roof(_) => "ROOF",
                Surface::Wall => "WALL",
                Surface::Ground => "GROUND",
            };
            let corners: Vec<u32> = face.rings.iter().flatten().copied().collect();
            for [a, b, c] in triangulate(solid, face) {
                // The fourth corner of a triangle is its third again.
                let points = [a, b, c, c].map(|i| solid.vertices[corners[i as usize] as usize]);
                entity(&mut text, scene, "3DFACE", layer, &points);
            }
        }
    }
    for (_, l) in Line3d::standing(lines) {
        let segment = &l.segment;
        entity(
            &mut text,
            scene,
            "LINE",
            "LINE3D",
            &[segment.p0, segment.p1],
        );
    }
    text.push_str("0\nENDSEC\n0\nEOF\n");
    text.into_bytes()
}

fn entity(text: &mut String, scene: &Scene, kind: &str, layer: &str, points: &[Point3<f64>]) {
    push_line(text, format_args!("0\n{kind}\n8\n{layer}"));
    for (i, p) in points.iter().enumerate() {
        let [x, y, z] = world(scene, p);
        // Group codes 10, 20, 30 for the first point, 11, 21, 31 for the second...
        push_line(
            text,
            format_args!("{}\n{x}\n{}\n{y}\n{}\n{z}", 10 + i, 20 + i, 30 + i),
        );
    }
}

/// The footprints of the buildings as GeoJSON polygons, with the heights of ground, eaves and
/// ridge.
pub fn footprints(scene: &Scene, model: &RoofModel) -> Vec<u8> {
    let features: Vec<Value> = (model.buildings.iter().enumerate())
        .flat_map(|(i, building)| building_footprints(scene, model, i, building))
        .collect();
    let mut file = json!({ "type": "FeatureCollection", "features": features });
    if let (None, Some(epsg)) = (scene.survey.anchor, scene.survey.epsg) {
        let name = format!("urn:ogc:def:crs:EPSG::{epsg}");
        file["crs"] = json!({ "type": "name", "properties": { "name": name } });
    }
    to_bytes(&file)
}

fn building_footprints(
    scene: &Scene,
    model: &RoofModel,
    id: usize,
    building: &Building,
) -> Vec<Value> {
    let solid = &building.solid;
    let roof = building.facets.iter().map(|f| &model.facets[f.index()]);
    let heights: Vec<f64> = roof.flat_map(|f| &f.outer).map(|p| p.z).collect();
    let height = |z: f64| rounded(z + scene.origin.z, 3);
    let grounds = solid.faces.iter().filter(|f| f.surface == Surface::Ground);
    let feature = |face: &crate::model::SolidFace| {
        let rings: Vec<_> = face
            .rings
            .iter()
            .map(|ring| closed_ring(scene, solid, ring))
            .collect();
        json!({
            "type": "Feature",
            "geometry": { "type": "Polygon", "coordinates": rings },
            "properties": {
                "building": id,
                "facets": building.facets.len(),
                "ground_m": height(building.ground_z),
                "lowest_roof_m": height(heights.iter().copied().fold(f64::INFINITY, f64::min)),
                "highest_roof_m": height(heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
            },
        })
    };
    grounds.map(feature).collect()
}

/// A ring of a ground face from above: the other way round, the first corner again at its end.
fn closed_ring(scene: &Scene, solid: &Solid, ring: &[u32]) -> Vec<[f64; 2]> {
    let corner = |&i: &u32| {
        let p = &solid.vertices[i as usize];
        match &scene.survey.anchor {
            Some(anchor) => {
                let [lon, lat, _] = anchor.geographic(&(p + scene.origin));
                // A tenth of a millimetre.
                [rounded(lon, 9), rounded(lat, 9)]
            }
            None => {
                let [x, y, _] = world(scene, p);
                [x, y]
            }
        }
    };
    ring.iter().rev().chain(ring.last()).map(corner).collect()
}

/// The 3D lines as CSV, one a line of text; columns are named in the first one.
pub fn lines_csv(scene: &Scene, lines: &[Line3d]) -> Vec<u8> {
    let columns = "id,x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,length_m,sigma_m,probability,views,origin\n";
    let mut text = String::from(columns);
    for (id, l) in Line3d::standing(lines) {
        let id = id.index();
        let ([x0, y0, z0], [x1, y1, z1]) =
            (world(scene, &l.segment.p0), world(scene, &l.segment.p1));
        let [length, sigma, probability] =
            [l.segment.length(), l.sigma_m, l.probability].map(|v| rounded(v, 4));
        push_line(
            &mut text,
            format_args!(
                "{id},{x0},{y0},{z0},{x1},{y1},{z1},{length},{sigma},{probability},{},{}",
                l.supports.len(),
                l.origin.name()
            ),
        );
    }
    text.into_bytes()
}
