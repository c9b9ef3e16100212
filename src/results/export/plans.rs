//! The model for drawing programs as DXF, and the 3D lines as CSV.
//!
//! Coordinates are those of the input's world frame, metres; DXF names it in a comment.

use nalgebra::Point3;

use super::format::{push_line, rounded, world};
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::roofs::model::{RoofModel, Surface, triangulate};

/// DXF of AutoCAD R12, which every program reads: 3DFACE on the layers ROOF, WALL and GROUND, LINE
/// on LINE3D.
pub fn dxf(scene: &Scene, model: &RoofModel, lines: &[Line3d]) -> Vec<u8> {
    let mut text = String::new();
    if let Some(system) = scene.survey.describe() {
        push_line(&mut text, format_args!("999\ncoordinates: {system}"));
    }
    text.push_str("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n");
    // Layers with the colours red, yellow, grey, green and blue of the AutoCAD index.
    let layers = [
        ("ROOF", 1),
        ("WALL", 2),
        ("GROUND", 8),
        ("OBSTRUCTION", 3),
        ("LINE3D", 5),
    ];
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
                Surface::Ceiling => "CEILING",
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
    for facet in &model.facets {
        let faces = facet.obstructions.iter().flat_map(|o| facet.faces_of(o));
        for face in faces {
            for k in 2..face.len() {
                let points = [face[0], face[k - 1], face[k], face[k]];
                entity(&mut text, scene, "3DFACE", "OBSTRUCTION", &points);
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

/// The 3D lines as CSV, one a line of text; columns are named in the first one.
pub fn lines_csv(scene: &Scene, lines: &[Line3d]) -> Vec<u8> {
    let columns = "id,x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,length_m,sigma_m,probability,views,origin\n";
    let mut text = String::from(columns);
    for (id, l) in Line3d::standing(lines) {
        let id = id.number();
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
